"""A frame that is no image of the world is named; one that is, is let through."""

import numpy as np
import pytest

from course_lib.beyond.guarded_frames import PATIENCE, FrameCheck, looks_of
from course_lib.depth_mcl.sequence import read_sequence
from tests.rendering.shapes import SMALL, room_depth

NEAR, FAR = 0.1, 11.0


def image(rng, yaw=0.3, noise=0.01):
    """A corner of a room, a tenth of its pixels without a return."""
    depth = room_depth(SMALL, np.array([0.0, 0.0, 0.0, 0.0, 0.0, yaw]))[0] + noise * rng.standard_normal(SMALL.shape)
    depth[rng.random(SMALL.shape) < 0.1] = np.nan
    return depth.astype(np.float32)


@pytest.fixture
def check(rng):
    """A check that has seen six good frames."""
    made = FrameCheck(NEAR, FAR, period=0.1)
    assert [made.look(image(rng), 0.1 * k).fault for k in range(6)] == [None] * 6
    return made


def half(depth, part):
    covered = depth.copy()
    covered[part] = np.nan
    return covered


HALVES = {"upper": np.s_[:24], "lower": np.s_[24:], "left": np.s_[:, :32], "right": np.s_[:, 32:]}


@pytest.mark.parametrize("empty", [np.nan, 0.0, np.inf, 50.0])
def test_a_frame_without_a_return_is_named(check, empty):
    assert check.look(np.full(SMALL.shape, empty), 0.6).fault == "no return"


def test_one_distance_everywhere_is_saturated(check):
    assert check.look(np.full(SMALL.shape, 9.99), 0.6).fault == "saturated"


def test_independent_values_are_noise(check, rng):
    assert check.look(rng.uniform(0.2, 10, SMALL.shape), 0.6).fault == "noise"


@pytest.mark.parametrize("part", HALVES)
def test_a_half_that_is_gone_is_named(check, rng, part):
    assert check.look(half(image(rng), HALVES[part]), 0.6).fault == "half covered"


def test_returns_that_are_gone_everywhere_are_few(check, rng):
    depth = image(rng)
    depth[rng.random(SMALL.shape) < 0.75] = np.nan
    assert check.look(depth, 0.6).fault == "few returns"


def test_noise_that_jumps_is_an_exposure_jump(check, rng):
    assert check.look(image(rng, noise=0.15), 0.6).fault == "exposure jump"


def test_the_same_image_is_repeated_and_an_old_time_out_of_order(check, rng):
    depth = image(rng)
    assert check.look(depth, 0.6).fault is None
    assert check.look(depth, 0.7).fault == "repeated"
    assert check.look(image(rng), 0.65).fault == "out of order"
    assert check.look(image(rng), 1.0).missed == 2


def test_after_any_fault_a_good_frame_is_good(check, rng):
    for k, bad in enumerate((np.full(SMALL.shape, np.nan), half(image(rng), HALVES["left"]), image(rng, noise=0.15))):
        assert check.look(bad, 0.6 + 0.2 * k).fault is not None
        assert check.look(image(rng), 0.7 + 0.2 * k).fault is None


def test_what_lasts_is_the_world(check, rng):
    faults = [check.look(half(image(rng), HALVES["left"]), 0.6 + 0.1 * k).fault for k in range(PATIENCE + 5)]
    assert faults == ["half covered"] * PATIENCE + [None] * 5


def test_darkness_is_never_taken_for_the_world(check):
    faults = {check.look(np.full(SMALL.shape, np.nan), 0.6 + 0.1 * k).fault for k in range(5 * PATIENCE)}
    assert faults == {"no return"}


def test_depths_rounded_as_by_a_kinect_are_no_jump(rng):
    """Neighbours are often equal, so that the usual roughness is 0 and anything is many times as much."""
    check = FrameCheck(NEAR, FAR)
    coarse = [np.round(image(rng, noise=0.001) / 0.05) * 0.05 for _ in range(5)]
    finer = [np.round(image(rng) / 0.02) * 0.02 for _ in range(5)]
    assert looks_of(coarse[0], NEAR, FAR).roughness == 0 < looks_of(finer[0], NEAR, FAR).roughness
    rounded = coarse + finer
    assert [check.look(depth).fault for depth in rounded] == [None] * 10


@pytest.mark.parametrize("carried", ["wagon", "hand"])
def test_no_frame_of_the_shipped_recordings_is_refused(corridor_folder, carried):
    recording = read_sequence(corridor_folder / carried)
    check = FrameCheck(NEAR, FAR, float(np.median(np.diff(recording.times))))
    seen = [check.look(recording.depth(k), recording.times[k]) for k in range(0, 60)]
    assert {one.fault for one in seen} == {None}
    assert sum(one.missed for one in seen) == 0


def test_no_frame_of_a_real_camera_is_refused(kitchen_folder):
    recording = read_sequence(kitchen_folder)
    check = FrameCheck(NEAR, FAR)
    assert {check.look(recording.depth(k)).fault for k in range(len(recording))} == {None}
