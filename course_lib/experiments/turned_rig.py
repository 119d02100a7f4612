"""What happens when the rig turns on the spot: a pair of panoramas rolled by columns against the pair as it was.

    np.roll(image, k, axis=1)  is the view of a rig turned by 2 pi k / W to the left

So x and y should stay and the heading should grow by that angle. The pose moves all the same, because a detector that
is shifted by less than its stride draws boxes a pixel or two elsewhere: half a metre for an object at 6 m (2.4).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from course_lib.experiments.room import PairResult, fitted_by_covariance
from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.pose.localization import Localization

SAME_DIRECTION = np.deg2rad(3.0)
"""Two observations within this azimuth are of one object (chosen: far less than between two objects of a room)."""


class RolledPair(NamedTuple):
    """What the method made of one pair as it was, and of the same images rolled by `columns`."""

    columns: int
    width: int  # of the images, pixels
    straight: Localization
    rolled: Localization


def turn_the_rig(
    results: Sequence[PairResult], localizer: SemanticLocalizer, columns: Sequence[int], progress: Callable = iter
) -> list[RolledPair]:
    """Localize every pair of an experiment again, with its images rolled by each number of columns."""
    pairs = []
    for result in progress(results):
        images = result.pair.images()
        for k in columns:
            rolled = localizer.localize(*(np.roll(image, k, axis=1) for image in images))
            pairs.append(RolledPair(k, result.size[0], result.localization, rolled))
    return pairs


def weigh_by_covariance(pairs: Sequence[RolledPair], localizer: SemanticLocalizer) -> list[RolledPair]:
    """Return the same pairs with poses fitted anew: each observation weighted by its covariance, not counted alike."""
    return [
        pair._replace(
            straight=fitted_by_covariance(pair.straight, localizer), rolled=fitted_by_covariance(pair.rolled, localizer)
        )
        for pair in pairs
    ]


def compare(pair: RolledPair) -> tuple[bool, float, float]:
    """Return how far rolling the images moved the pose: (agree, metres, radians), NaN without both poses.

    agree: the same objects, told by their directions, were taken for the same landmarks.
    """
    columns, width, straight, rolled = pair
    angle = 2 * np.pi * columns / width
    if straight.pose is None or rolled.pose is None:
        return False, np.nan, np.nan
    before, after = _directions(straight), _directions(rolled)
    agree = before.keys() == after.keys() and all(
        abs(wrap_angle(after[landmark] - before[landmark] + angle)) < SAME_DIRECTION for landmark in before
    )
    moved = float(np.hypot(rolled.pose.x - straight.pose.x, rolled.pose.y - straight.pose.y))
    return agree, moved, float(abs(wrap_angle(rolled.pose.theta - straight.pose.theta - angle)))


def turn_summary(pairs: Sequence[RolledPair]) -> dict:
    """Return how many of many pairs agree, and how far the pose of those moved and turned."""
    turns = [compare(pair) for pair in pairs]
    moved = np.array([metres for agree, metres, _ in turns if agree])
    turned = np.rad2deg([radians for agree, _, radians in turns if agree])
    return {
        "columns": sorted({pair.columns for pair in pairs}),
        "n": len(turns),
        "associations_agree": len(moved),
        "median_moved_m": float(np.median(moved)) if len(moved) else None,
        "greatest_moved_m": float(moved.max()) if len(moved) else None,
        "within_0.10_m": int((moved <= 0.10).sum()),
        "median_turned_deg": float(np.median(turned)) if len(turned) else None,
        "greatest_turned_deg": float(turned.max()) if len(turned) else None,
    }


def _directions(found: Localization) -> dict[int, float]:
    """Azimuth, radians, of the observation that was taken for each landmark."""
    return {
        landmark: float(np.arctan2(found.observations[i].y, found.observations[i].x))
        for i, landmark in found.used_pairs
    }
