"""Pairs in a stream: each has an outcome by name, and a pair at fault changes nothing for the others."""

import numpy as np
import pytest

from course_lib.beyond.guarded_stereo import GuardedRig
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.panorama import StereoRig
from course_lib.spherical_stereo.pose import localization as outcomes
from tests.spherical_stereo.stereo_scene import BASELINE, KnowingDetector, mapped_scene, pair_from

MAP = mapped_scene()[2]
HERE, THERE = pair_from(0.0, 0.0), pair_from(0.35, 0.1)


@pytest.fixture
def rig():
    return GuardedRig(SemanticLocalizer(StereoRig(BASELINE), MAP, KnowingDetector(HERE, THERE)), period=1.0)


def test_a_good_pair_is_what_the_localizer_says(rig):
    alone = rig.localizer.localize(*HERE[:2])
    seen = rig.localize(*HERE[:2], 0.0)
    assert (seen.outcome, seen.missed) == ("ok", 0)
    assert seen.localization.pose == alone.pose
    assert np.array_equal(seen.localization.covariance, alone.covariance)


def test_a_pair_that_is_not_new_is_named_and_not_looked_into(rig):
    rig.localize(*HERE[:2], 0.0)
    again = rig.localize(HERE[0].copy(), HERE[1].copy(), 1.0)
    assert (again.outcome, again.localization) == ("repeated", None)
    late = rig.localize(*THERE[:2], 0.5)
    assert (late.outcome, late.localization) == ("out of order", None)
    assert rig.localize(*THERE[:2], 4.0).missed == 2


def test_exchanged_images_are_named(rig):
    assert rig.localize(HERE[1], HERE[0], 0.0).outcome == outcomes.SWAPPED
    assert rig.localize(*HERE[:2], 1.0).outcome == "ok"


@pytest.mark.parametrize(("upper", "lower"), [(HERE, THERE), (THERE, HERE)])
def test_images_of_different_moments_are_named(rig, upper, lower):
    seen = rig.localize(upper[0], lower[1], 0.0)
    assert seen.outcome == outcomes.MOMENTS
    assert seen.localization.pose is None
    assert "were they taken at one moment" in seen.localization.explanation
