"""Each trouble of a pair of panoramas does what its name says; the method names every pair."""

import numpy as np
import pytest

from course_lib.beyond.look_alikes.consistent import associate_consistent
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.panorama import StereoRig
from courseware.experiments.stereo_trouble import GATE, LENGTHS, PERIOD, SPOILS, STOPS, walk_trouble
from courseware.experiments.troubled_frames import summary, troubled_frames, troubled_recording
from tests.spherical_stereo.stereo_scene import BASELINE, TRUE_POSE, KnowingDetector, mapped_scene, pair_from

SEED = 10_008  # for tuning: the tests' own
N = 40


@pytest.fixture(scope="module")
def pairs():
    images = np.random.default_rng(1).integers(20, 250, (N, 2, 8, 16, 3), dtype=np.uint8)
    return [(upper, lower) for upper, lower in images]


def arrivals(trouble, pairs, seed):
    return troubled_recording(trouble, SPOILS, pairs, PERIOD * np.arange(N), 0.2, np.random.default_rng(seed))


def bad_pairs(trouble, pairs):
    came, runs = arrivals(trouble, pairs, 2)
    return [(k, came[k].image, came[k - 1].image) for k in np.flatnonzero(troubled_frames(runs, N))]


@pytest.mark.parametrize("trouble", LENGTHS)
def test_pairs_that_were_not_drawn_are_the_same_arrays(pairs, trouble):
    came, runs = arrivals(trouble, pairs, 2)
    for k in np.flatnonzero(~troubled_frames(runs, N)):
        assert came[k].image is pairs[k]
        assert came[k].time == k


def test_a_dark_camera_shows_noise_and_the_other_what_it_saw(pairs):
    which = set()
    for k, (upper, lower), _ in bad_pairs("one camera dark", pairs):
        dark, other, at = (upper, lower, 0) if upper.mean() < 10 else (lower, upper, 1)
        assert np.median(dark) <= 4
        assert other is pairs[k][1 - at]
        which.add(at)
    assert which == {0, 1}


def test_an_exposure_that_jumps_multiplies_one_image_and_clips_it(pairs):
    factors = set()
    for k, came, _ in bad_pairs("exposure jump", pairs):
        changed = [i for i in (0, 1) if came[i] is not pairs[k][i]]
        assert len(changed) == 1
        image, good = came[changed[0]], pairs[k][changed[0]].astype(float)
        factor = 2**STOPS if image.mean() > good.mean() else 2**-STOPS
        assert np.array_equal(image, np.clip(np.rint(good * factor), 0, 255))
        factors.add((changed[0], factor))
    assert len(factors) >= 3


def test_the_stereo_method_names_every_pair():
    """A rig that goes to and fro between four places; what it moved is in its own axes, turned on the map."""
    places = [(0.0, 0.0), (0.35, 0.1), (0.1, -0.3), (-0.3, 0.1)]
    pairs = [pair_from(*place) for place in places]
    rig, detector = StereoRig(BASELINE), KnowingDetector(*pairs)
    localizer = SemanticLocalizer(rig, mapped_scene()[2], detector, association=associate_consistent)
    poses = [[*moved, TRUE_POSE.theta] for moved in TRUE_POSE.apply(places)]
    troubled_walk = walk_trouble(localizer, [pair[:2] for pair in pairs] * 5, np.array(poses * 5), SEED, [0.1])
    told = summary([troubled_walk], GATE)
    assert told["undisturbed"] == {"frames": 20, "good_frames": {"ok": 20}, "false_alarms": 0, "confident_wrong": 0}
    names = {row["trouble"]: row["outcomes"] for row in told["rows"]}
    assert names["dropped"] == {"no image": 2}
    assert names["repeated"] == {"repeated": 2}
    assert names["one camera dark"] == {"blank image": 2}
    assert names["cameras exchanged"] == {"images seem swapped": 2}
    assert names["different moments"] == {"images of different moments": 2}
    assert sum(names["exposure jump"].values()) == 2
    assert all(row["confident_wrong"] == 0 and row["recovered"] == row["undisturbed"] for row in told["rows"])
