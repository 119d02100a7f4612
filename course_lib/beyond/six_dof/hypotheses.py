"""Of many poses the best that differ: how far apart two hypotheses are, and how good a rival of the best must be."""

from __future__ import annotations

import numpy as np

from course_lib.beyond.six_dof.twists import lengths, motion_between

# All chosen on development recordings: the kitchen and the shipped corridor, with every frame to every 12th; what
# concerns rivals on walks through rooms, seeds 10,041 to 10,066.
APART = 0.2  # of the prediction's spread: particles nearer to each other are one hypothesis
DISTINCT = np.array([0.02, np.deg2rad(1.0)])  # metres, radians: the same between two refined poses
RIVAL_WITHIN = 0.06  # of raw score: what fits less is no rival
RIVAL_APART = np.array([0.15, np.deg2rad(10.0)])  # metres, radians


def distinct(poses: np.ndarray, scores: np.ndarray, count: int, apart: np.ndarray) -> np.ndarray:
    """Indices of the best `count` poses `(N, 4, 4)` of which no two are alike: nearer than `apart`, metres and radians.

    scores: `(N,)`. Best first; fewer than `count` where there are no more that differ.
    """
    kept: list[int] = []
    for index in np.argsort(-scores, kind="stable"):
        differences = lengths(motion_between(poses[index], poses[kept]))
        if (differences >= apart).any(axis=-1).all():
            kept.append(int(index))
        if len(kept) == count:
            break
    return np.array(kept)
