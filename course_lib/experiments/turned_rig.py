"""What happens when the rig turns on the spot: a pair of panoramas rolled by columns against the pair as it was.

    np.roll(image, k, axis=1)  is the view of a rig turned by 2 pi k / W to the left

Nothing else about the world changes, so x and y should stay and the heading should grow by that angle. What moves the
pose all the same is the detector: shifted by less than its stride it draws boxes a pixel or two elsewhere, and a pixel
moves an object at 6 m by half a metre (2.4). The paper's fit counts far and near objects alike; with the covariances as
weights, far ones count for little.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
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
    width: int
    """of the images, pixels"""
    straight: Localization
    rolled: Localization


class Turn(NamedTuple):
    """How far a pose was moved by rolling the images."""

    columns: int
    """by which both images were rolled, to the right"""
    agree: bool
    """whether the same objects, told by their directions, were taken for the same landmarks"""
    moved: float
    """how far the position moved, metres; NaN without both poses"""
    turned: float
    """how much more or less than 2 pi k / W the heading changed, radians, 0 to pi; NaN without both poses"""


def turn_the_rig(
    results: Sequence[PairResult],
    localizer: SemanticLocalizer,
    columns: Iterable[int],
    progress: Callable = iter,
) -> list[RolledPair]:
    """Every pair of an experiment localized again with its images rolled by each number of columns.

    results: from images (`run_experiment`). progress: wraps the results (tqdm). Source: paper 2, section 3, whose rig
    was turned at every place.
    """
    columns = [int(k) for k in columns]
    pairs = []
    for result in progress(results):
        images = result.pair.images()
        for k in columns:
            rolled = localizer.localize(*(np.roll(image, k, axis=1) for image in images))
            pairs.append(RolledPair(k, result.size[0], result.localization, rolled))
    return pairs


def weigh_by_covariance(pairs: Sequence[RolledPair], localizer: SemanticLocalizer) -> list[RolledPair]:
    """The same pairs with poses fitted anew: each observation weighted by its covariance, not counted alike.

    localizer: the one that localized them; its map and its association stay.
    """
    return [
        pair._replace(
            straight=fitted_by_covariance(pair.straight, localizer), rolled=fitted_by_covariance(pair.rolled, localizer)
        )
        for pair in pairs
    ]


def compare(pair: RolledPair) -> Turn:
    """How far rolling the images moved the pose, and whether the associations agree."""
    columns, width, straight, rolled = pair
    angle = 2 * np.pi * columns / width
    if straight.pose is None or rolled.pose is None:
        return Turn(columns, False, np.nan, np.nan)
    before, after = _directions(straight), _directions(rolled)
    agree = before.keys() == after.keys() and all(
        abs(wrap_angle(after[landmark] - before[landmark] + angle)) < SAME_DIRECTION for landmark in before
    )
    moved = float(np.hypot(rolled.pose.x - straight.pose.x, rolled.pose.y - straight.pose.y))
    turned = float(abs(wrap_angle(rolled.pose.theta - straight.pose.theta - angle)))
    return Turn(columns, agree, moved, turned)


def turn_summary(pairs: Sequence[RolledPair]) -> dict:
    """Numbers over many pairs: how many agree, and how far the pose of those moved and turned."""
    turns = [compare(pair) for pair in pairs]
    agreeing = [turn for turn in turns if turn.agree]
    moved = np.array([turn.moved for turn in agreeing])
    turned = np.rad2deg([turn.turned for turn in agreeing])
    return {
        "columns": sorted({turn.columns for turn in turns}),
        "n": len(turns),
        "associations_agree": len(agreeing),
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
