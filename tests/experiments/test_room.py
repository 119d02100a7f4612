"""The room experiment's functions on results made by hand: weighted by covariances, and of a rig that turns."""

from types import SimpleNamespace

import numpy as np
import pytest

from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.panorama import StereoRig
from course_lib.spherical_stereo.pose.localization import Localization
from course_lib.spherical_stereo.semantic_map.association import Observation
from course_lib.spherical_stereo.semantic_map.semantic_map import Landmark, SemanticMap
from courseware.experiments.room import RolledPair, compare, experiment_summary, turn_summary, weighted_summary
from courseware.experiments.room_evaluation import outcome

WIDTH, COLUMNS = 1280, 97
ANGLE = 2 * np.pi * COLUMNS / WIDTH
THINGS = ("sofa", 4.0, 0.0, 20.0), ("table", 1.0, 3.0, 120.0), ("chair", -2.0, 1.0, 240.0)
MAP = SemanticMap([Landmark(*thing, 60.0) for thing in THINGS])
LOCALIZER = SemanticLocalizer(StereoRig(0.3, 1.4), MAP)


def result(found):
    """What the experiment makes of a rig at the map's origin that sees the landmarks in their order."""
    pose, truth = np.zeros(3), tuple(range(len(found.observations)))
    judged = outcome(found, pose, truth)
    return SimpleNamespace(localization=found, pair=SimpleNamespace(pose=pose), true_landmarks=truth, outcome=judged)


def test_an_object_told_to_be_uncertain_moves_the_weighted_pose_less():
    """The sofa is seen half a metre too far away, and its covariance says so."""
    seen = [
        Observation(one.label, one.x + off, one.y, one.hue, one.saturation, variance * np.eye(2))
        for one, off, variance in zip(MAP.landmarks, (0.5, 0.0, 0.0), (4.0, 0.01, 0.01), strict=True)
    ]
    results = [result(LOCALIZER.localize_observations(seen)), result(Localization())]
    alike, weighted = experiment_summary(results), weighted_summary(results, LOCALIZER)
    assert alike["correct_percent"] == weighted["correct_percent"] == 50.0
    assert alike["unable_percent"] == weighted["unable_percent"] == 50.0
    assert alike["correct"]["mean_dx_m"] == pytest.approx(0.5 / 3, abs=0.05)
    assert weighted["correct"]["mean_dx_m"] < 0.2 * alike["correct"]["mean_dx_m"]


def localized(turn=0.0, shift=(0.0, 0.0), labels=("sofa", "table", "chair")):
    """The pose from the map's objects as a rig at the map's origin, turned by `turn` to the left, would see them."""
    turned = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    places = (MAP.positions - shift) @ turned
    seen = zip(MAP.landmarks, places, strict=True)
    return LOCALIZER.localize_observations(
        [Observation(one.label, *place, one.hue, one.saturation) for one, place in seen if one.label in labels]
    )


def pair(rolled):
    return RolledPair(COLUMNS, WIDTH, localized(), rolled)


def test_what_moves_and_turns_besides_is_measured():
    for off, shift, moved in ((0.0, (0.0, 0.0), 0.0), (0.02, (0.03, 0.04), 0.05)):
        assert compare(pair(localized(ANGLE - off, shift))) == pytest.approx((True, moved, off), abs=1e-9)


@pytest.mark.parametrize(
    "rolled",
    [localized(-ANGLE), localized(ANGLE, labels=("sofa", "table")), Localization()],
    ids=["turned the other way", "an object less", "no pose"],
)
def test_what_does_not_agree(rolled):
    assert not compare(pair(rolled))[0]


def test_the_summary_is_of_those_that_agree():
    rolled = localized(ANGLE - 0.01, (0.0, 0.02)), localized(ANGLE, (0.105, 0.0)), localized(-ANGLE, (3.0, 0.0))
    found = turn_summary([pair(one) for one in rolled])
    assert (found["n"], found["associations_agree"], found["within_0.10_m"]) == (3, 2, 1)
    assert found["columns"] == [COLUMNS]
    assert found["greatest_moved_m"] == pytest.approx(0.105)
    assert found["greatest_turned_deg"] == pytest.approx(np.rad2deg(0.01))
