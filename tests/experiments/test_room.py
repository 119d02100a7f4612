"""The room experiment's functions on results made by hand: the same associations, weighted by their covariances."""

from types import SimpleNamespace

import numpy as np
import pytest

from course_lib.experiments.room import experiment_summary, weighted_summary
from course_lib.experiments.room_evaluation import outcome
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.panorama import StereoRig
from course_lib.spherical_stereo.pose.localization import UNABLE, Localization
from course_lib.spherical_stereo.semantic_map.association import Observation
from course_lib.spherical_stereo.semantic_map.semantic_map import Landmark, SemanticMap

MAP = SemanticMap(
    (
        Landmark("sofa", 4.0, 0.0, 20.0, 60.0),
        Landmark("table", 1.0, 3.0, 120.0, 60.0),
        Landmark("chair", -2.0, 1.0, 240.0, 60.0),
    )
)
POSE = np.zeros(3)


def result(found):
    truth = tuple(range(len(found.observations)))
    pair = SimpleNamespace(pose=POSE)
    return SimpleNamespace(localization=found, pair=pair, true_landmarks=truth, outcome=outcome(found, POSE, truth))


def test_an_object_told_to_be_uncertain_moves_the_weighted_pose_less():
    """The sofa is seen half a metre too far away, and its covariance says so."""
    localizer = SemanticLocalizer(StereoRig(0.3, 1.4), MAP)
    seen = [
        Observation(
            one.label, one.x + 0.5 * unsure, one.y, one.hue, one.saturation, (4.0 if unsure else 0.01) * np.eye(2)
        )
        for one, unsure in zip(MAP.landmarks, (True, False, False), strict=True)
    ]
    results = [result(localizer.localize_observations(seen)), result(Localization(None, UNABLE))]
    alike, weighted = experiment_summary(results), weighted_summary(results, localizer)
    assert alike["correct_percent"] == weighted["correct_percent"] == 50.0
    assert alike["unable_percent"] == weighted["unable_percent"] == 50.0
    assert alike["correct"]["mean_dx_m"] == pytest.approx(0.5 / 3, abs=0.05)
    assert weighted["correct"]["mean_dx_m"] < 0.2 * alike["correct"]["mean_dx_m"]
