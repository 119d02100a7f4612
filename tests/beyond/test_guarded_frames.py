"""A frame that is late, repeated, or no image of the world is named; one that is new and good is let through."""

import numpy as np
import pytest

from course_lib.beyond.guarded_frames import CLOCK_WAS_SET, MAX_MISSED, PATIENCE, FrameCheck, FrameOrder
from course_lib.depth_mcl.sequence import read_sequence
from tests.rendering.shapes import SMALL, room_depth

NEAR, FAR = 0.1, 11.0


@pytest.fixture
def images(rng):
    made = rng.random((10, 4, 6)).astype(np.float32)
    made[:, 0, 0] = np.nan
    return made


def faults(period, *frames):
    order = FrameOrder(period)
    return [order.look((image,), time).fault for image, time in frames]


@pytest.mark.parametrize(("gap", "missed"), [(0.1, 0), (0.14, 0), (0.2, 1), (0.29, 2), (1.1, 10), (9e3, MAX_MISSED)])
def test_a_gap_is_counted_in_frames(images, gap, missed):
    for period, expected in ((0.1, missed), (None, 0)):
        order = FrameOrder(period)
        order.look((images[0],), 5.0)
        assert order.look((images[1],), 5.0 + gap).missed == expected


@pytest.mark.parametrize("unit", [1e6, 1e9])
def test_times_in_another_unit_are_refused_and_change_nothing(images, unit):
    order = FrameOrder(1 / 15)
    order.look((images[0],), 5.0 * unit)
    with pytest.raises(ValueError, match="Seconds are expected: divide nanoseconds by 1e9"):
        order.look((images[1],), (5.0 + 1.5 / 15) * unit)
    assert order.look((images[1],), 5.0 * unit + 1 / 15) == (None, 0)


def test_times_that_are_not_later_are_out_of_order_until_the_clock_is_believed_and_same_values_are_a_repetition(images):
    later = [(image, 0.1 * k) for k, image in enumerate(images[1:], start=1)]
    expected = [None] + ["out of order"] * (CLOCK_WAS_SET - 1) + [None] * (10 - CLOCK_WAS_SET)
    assert faults(0.1, (images[0], 100.0), *later) == expected
    other = images[0].copy()
    other[2, 2] += 1e-3
    assert faults(None, (images[0], 0.0), (images[0].copy(), 0.1), (other, 0.2)) == [None, "repeated", None]
    assert faults(None, (images[0], None), (images[0].copy(), None)) == [None, "repeated"]
    for time in (0.1, 0.05, -1.0):
        frames = [(images[0], 0.0), (images[1], 0.1), (images[2], time), (images[3], 0.2)]
        assert faults(0.1, *frames) == [None, None, "out of order", None]


def image(rng, noise=0.01):
    depth = room_depth(SMALL, np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.3]))[0] + noise * rng.standard_normal(SMALL.shape)
    depth[rng.random(SMALL.shape) < 0.1] = np.nan
    return depth.astype(np.float32)


@pytest.fixture
def check(rng):
    made = FrameCheck(NEAR, FAR, period=0.1)
    assert [made.look(image(rng), 0.1 * k).fault for k in range(6)] == [None] * 6
    return made


def without(rng, part):
    depth = image(rng)
    depth[part] = np.nan
    return depth


HALVES = (np.s_[:24], np.s_[24:], np.s_[:, :32], np.s_[:, 32:])
BAD = {
    "no return": [lambda _, empty=empty: np.full(SMALL.shape, empty) for empty in (np.nan, 0.0, np.inf, 50.0)],
    "saturated": [lambda _: np.full(SMALL.shape, 9.99)],
    "noise": [lambda rng: rng.uniform(0.2, 10, SMALL.shape)],
    "half covered": [lambda rng, part=part: without(rng, part) for part in HALVES],
    "few returns": [lambda rng: without(rng, rng.random(SMALL.shape) < 0.75)],
    "exposure jump": [lambda rng: image(rng, noise=0.15)],
}


@pytest.mark.parametrize("fault", BAD)
def test_a_fault_is_named_and_a_good_frame_after_it_is_good(check, rng, fault):
    for k, bad in enumerate(BAD[fault]):
        assert check.look(bad(rng), 0.6 + 0.2 * k).fault == fault
        assert check.look(image(rng), 0.7 + 0.2 * k) == (None, 0)


def test_what_lasts_is_the_world_but_never_darkness(check, rng):
    told = [check.look(BAD["half covered"][2](rng), 0.6 + 0.1 * k).fault for k in range(PATIENCE + 5)]
    assert told == ["half covered"] * PATIENCE + [None] * 5
    told = [check.look(np.full(SMALL.shape, np.nan), 9.0 + 0.1 * k).fault for k in range(5 * PATIENCE)]
    assert set(told) == {"no return"}


def test_no_frame_of_the_shipped_recordings_or_of_a_real_camera_is_refused(corridor_folder, kitchen_folder):
    for folder in (corridor_folder / "wagon", corridor_folder / "hand", kitchen_folder):
        recording = read_sequence(folder)
        timed = recording.times is not None
        check = FrameCheck(NEAR, FAR, float(np.median(np.diff(recording.times))) if timed else None)
        seen = [check.look(recording.depth(k), recording.times[k] if timed else None) for k in range(60)]
        assert set(seen) == {(None, 0)}
