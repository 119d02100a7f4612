"""Rooms from a seed: a rectangle, 9 to 16 pieces of furniture, a shell with windows and lamps.

The detector is trained on these rooms. The hand-made room (experiment_room.py) is another, but some limits of the
pieces were moved towards it; the rooms for reporting (look_alike_room.py) are made of the same pieces.
"""

from __future__ import annotations

import numpy as np
from numpy.random import Generator

from course_lib.simulation.furniture import RANDOM_PIECES
from course_lib.simulation.room.furnishing import add_piece, add_television, empty_room, furnished_room
from course_lib.simulation.room.scene import Room

FEWEST, MOST = 9, 16  # pieces of furniture
# How likely each class is to be drawn, and how many of it a room has at most.
SHARES = {
    "sofa": (0.13, 3),
    "chair": (0.24, 5),
    "table": (0.13, 3),
    "television": (0.1, 2),
    "potted plant": (0.17, 4),
    "refrigerator": (0.09, 2),
    "cabinet": (0.14, 3),
}
# Large pieces come first, while there is space for them.
ORDER = ("television", "refrigerator", "sofa", "cabinet", "table", "potted plant", "chair")


def _draw_labels(rng: Generator, n: int) -> list[str]:
    """The classes of n pieces; at least five different ones, so that no room teaches only chairs."""
    names = list(SHARES)
    share = np.array([SHARES[name][0] for name in names])
    labels = [names[index] for index in rng.permutation(len(names))[: int(rng.integers(5, 8))]]
    while len(labels) < n:
        name = names[int(rng.choice(len(names), p=share / share.sum()))]
        if labels.count(name) < SHARES[name][1]:
            labels.append(name)
    return sorted(labels, key=ORDER.index)


def make_room(seed: int | Generator) -> Room:
    """A furnished rectangular room, 4.5 to 7.5 m a side, its south-west corner at the origin.

    seed: the same seed gives the same room, byte for byte.
    """
    rng = np.random.default_rng(seed)
    low, high = np.zeros(2), rng.uniform(4.5, 7.5, 2)
    height = float(rng.uniform(2.4, 3.0))
    shell, plan = empty_room(rng, low, high, height)
    n = int(np.clip(round(rng.normal(6 + high.prod() / 6.0, 1.5)), FEWEST, MOST - 2))
    for label in _draw_labels(rng, n):
        if label == "television":
            add_television(rng, plan, shell)
        else:
            add_piece(rng, plan, RANDOM_PIECES[label](rng))
    for _ in range(60):
        # What found no space is made up for with small pieces.
        if len(plan.objects) >= FEWEST:
            break
        add_piece(rng, plan, RANDOM_PIECES[str(rng.choice(["chair", "potted plant"]))](rng))
    return furnished_room(shell, plan, height)
