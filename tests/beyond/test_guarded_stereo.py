"""Pairs in a stream: each has an outcome by name, and a pair at fault changes nothing for the others."""

import numpy as np

from course_lib.beyond.guarded_stereo import GuardedRig
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.outcomes import Reason
from course_lib.spherical_stereo.panorama import StereoRig
from tests.spherical_stereo.stereo_scene import BASELINE, KnowingDetector, mapped_scene, pair_from

MAP = mapped_scene()[2]
HERE, THERE = pair_from(0.0, 0.0), pair_from(0.35, 0.1)


def test_a_good_pair_is_what_the_localizer_says_and_one_exchanged_not_new_or_of_two_moments_is_named():
    rig = GuardedRig(SemanticLocalizer(StereoRig(BASELINE), MAP, KnowingDetector(HERE, THERE)), period=1.0)
    alone = rig.localizer.localize(*HERE[:2])
    seen = rig.localize(*HERE[:2], 0.0)
    assert (seen.outcome, seen.missed) == ("ok", 0)
    assert seen.localization.pose == alone.pose
    assert np.array_equal(seen.localization.covariance, alone.covariance)
    assert rig.localize(HERE[1], HERE[0], 1.0).outcome == Reason.SWAPPED
    assert rig.localize(*HERE[:2], 2.0).outcome == "ok"
    again = rig.localize(HERE[0].copy(), HERE[1].copy(), 3.0)
    assert (again.outcome, again.localization) == ("repeated", None)
    late = rig.localize(*THERE[:2], 0.5)
    assert (late.outcome, late.localization) == ("out of order", None)
    assert rig.localize(*THERE[:2], 6.0).missed == 2
    for time, upper, lower in ((7.0, HERE, THERE), (8.0, THERE, HERE)):
        seen = rig.localize(upper[0], lower[1], time)
        assert seen.outcome == Reason.MOMENTS
        assert seen.localization.pose is None
        assert "were they taken at one moment" in seen.localization.explanation
