"""Turning the rig: when do two poses agree, how far apart are they, and what is said about many of them."""

import numpy as np
import pytest

from course_lib.experiments.room import RolledPair, compare, turn_summary
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.panorama import StereoRig
from course_lib.spherical_stereo.pose.localization import UNABLE, Localization
from course_lib.spherical_stereo.semantic_map.association import Observation
from course_lib.spherical_stereo.semantic_map.semantic_map import Landmark, SemanticMap

WIDTH, COLUMNS = 1280, 97
ANGLE = 2 * np.pi * COLUMNS / WIDTH
MAP = SemanticMap(
    (
        Landmark("sofa", 4.0, 0.0, 20.0, 60.0),
        Landmark("table", 1.0, 3.0, 120.0, 60.0),
        Landmark("chair", -2.0, 1.0, 240.0, 60.0),
    )
)


def localized(turn=0.0, shift=(0.0, 0.0), labels=("sofa", "table", "chair")):
    """The pose from the map's objects as a rig at the map's origin, turned by `turn` to the left, would see them."""
    cosine, sine = np.cos(turn), np.sin(turn)
    seen = [
        Observation(
            one.label,
            cosine * (one.x - shift[0]) + sine * (one.y - shift[1]),
            -sine * (one.x - shift[0]) + cosine * (one.y - shift[1]),
            one.hue,
            one.saturation,
        )
        for one in MAP.landmarks
        if one.label in labels
    ]
    return SemanticLocalizer(StereoRig(0.3, 1.4), MAP).localize_observations(seen)


def pair(rolled, straight=None):
    return RolledPair(COLUMNS, WIDTH, straight or localized(), rolled)


def test_what_moves_and_turns_besides_is_measured():
    for off, shift, moved in ((0.0, (0.0, 0.0), 0.0), (0.02, (0.03, 0.04), 0.05)):
        assert compare(pair(localized(ANGLE - off, shift))) == pytest.approx((True, moved, off), abs=1e-9)


@pytest.mark.parametrize(
    "rolled",
    [localized(-ANGLE), localized(ANGLE, labels=("sofa", "table")), Localization(None, UNABLE)],
    ids=["turned the other way", "an object less", "no pose"],
)
def test_what_does_not_agree(rolled):
    assert not compare(pair(rolled))[0]


def test_the_summary_is_of_those_that_agree():
    found = turn_summary(
        [
            pair(localized(ANGLE - 0.01, (0.0, 0.02))),
            pair(localized(ANGLE, (0.105, 0.0))),
            pair(localized(-ANGLE, (3.0, 0.0))),
        ]
    )
    assert (found["n"], found["associations_agree"], found["within_0.10_m"]) == (3, 2, 1)
    assert found["columns"] == [COLUMNS]
    assert found["greatest_moved_m"] == pytest.approx(0.105)
    assert found["greatest_turned_deg"] == pytest.approx(np.rad2deg(0.01))
