"""Frames that come late, twice or not at all are told from new ones."""

import numpy as np
import pytest

from course_lib.beyond.guarded_frames import CLOCK_WAS_SET, MOST_MISSED, FrameOrder


def orders(order, frames):
    return [order.look((image,), time).order for image, time in frames]


@pytest.fixture
def images(rng):
    made = rng.random((10, 4, 6)).astype(np.float32)
    made[:, 0, 0] = np.nan
    return made


def test_new_images_at_later_times_are_in_order(images):
    assert orders(FrameOrder(0.1), zip(images, 0.1 * np.arange(10), strict=True)) == ["in order"] * 10


@pytest.mark.parametrize("time", [0.1, 0.05, -1.0])
def test_a_time_that_is_not_later_is_out_of_order_and_changes_nothing(images, time):
    order = FrameOrder(0.1)
    frames = [(images[0], 0.0), (images[1], 0.1), (images[2], time), (images[3], 0.2)]
    assert orders(order, frames) == ["in order", "in order", "out of order", "in order"]


def test_the_same_values_are_a_repetition_with_or_without_a_new_time(images):
    assert orders(FrameOrder(), [(images[0], 0.0), (images[0].copy(), 0.1)]) == ["in order", "repeated"]
    assert orders(FrameOrder(), [(images[0], None), (images[0].copy(), None)]) == ["in order", "repeated"]


def test_one_other_value_makes_it_another_image(images):
    other = images[0].copy()
    other[2, 2] += 1e-3
    assert orders(FrameOrder(), [(images[0], 0.0), (other, 0.1)]) == ["in order", "in order"]


def test_an_image_that_is_written_over_in_place_is_remembered_as_it_was(images):
    memory = images[0].copy()
    order = FrameOrder()
    order.look((memory,), 0.0)
    memory[:] = images[1]
    assert order.look((memory,), 0.1).order == "in order"


def test_of_two_cameras_both_must_stand_still(images):
    order = FrameOrder()
    order.look((images[0], images[1]), 0.0)
    assert order.look((images[0], images[2]), 1.0).order == "in order"
    assert order.look((images[0], images[2]), 2.0).order == "repeated"


@pytest.mark.parametrize(("gap", "missed"), [(0.1, 0), (0.14, 0), (0.2, 1), (0.29, 2), (1.1, 10), (1e6, MOST_MISSED)])
def test_a_gap_is_counted_in_frames(images, gap, missed):
    order = FrameOrder(0.1)
    order.look((images[0],), 5.0)
    assert order.look((images[1],), 5.0 + gap).missed == missed


def test_without_a_period_no_gap_is_told(images):
    order = FrameOrder()
    order.look((images[0],), 0.0)
    assert order.look((images[1],), 9.0).missed == 0


def test_a_clock_that_was_set_back_is_believed_after_some_frames(images):
    order = FrameOrder(0.1)
    order.look((images[0],), 100.0)
    later = [(image, 0.1 * k) for k, image in enumerate(images[1:], start=1)]
    told = orders(order, later)
    assert told == ["out of order"] * (CLOCK_WAS_SET - 1) + ["in order"] * (10 - CLOCK_WAS_SET)
    assert order.look((images[0],), 1.0).missed == 0


@pytest.mark.parametrize("time", [float("nan"), float("inf")])
def test_a_time_that_is_none_is_refused(images, time):
    with pytest.raises(ValueError, match="must be a finite number of seconds"):
        FrameOrder().look((images[0],), time)


@pytest.mark.parametrize("period", [0.0, -0.1, float("nan")])
def test_a_period_that_is_none_is_refused(period):
    with pytest.raises(ValueError, match="period must be a positive number"):
        FrameOrder(period)
