"""Boxes on a panorama: overlap knows that the right edge touches the left one."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from course_lib.spherical_stereo.detection.detected_object import DetectionError, box_centre, box_iou, wrapped_box

WIDTH = 1280.0


def box(u, v, across, down):
    return np.array([u, v, u + across, v + down])


def test_a_box_overlaps_itself_fully():
    assert box_iou([box(10, 20, 30, 40)], [box(10, 20, 30, 40)], WIDTH) == pytest.approx(1.0)


def test_boxes_side_by_side_do_not_overlap():
    assert box_iou([box(10, 20, 30, 40)], [box(40, 20, 30, 40)], WIDTH) == 0.0


def test_half_shifted_boxes_share_a_third():
    assert box_iou([box(0, 0, 20, 10)], [box(10, 0, 20, 10)], WIDTH) == pytest.approx(1 / 3)


def test_a_box_past_the_seam_is_the_same_box_one_turn_earlier():
    assert box_iou([box(1270, 0, 40, 10)], [box(-10, 0, 40, 10)], WIDTH) == pytest.approx(1.0)


def test_a_box_over_the_seam_overlaps_its_part_on_the_left():
    assert box_iou([box(1270, 0, 20, 10)], [box(0, 0, 10, 10)], WIDTH) == pytest.approx(0.5)


def test_two_wide_boxes_meet_at_both_ends():
    assert box_iou([box(0, 0, 700, 1)], [box(640, 0, 700, 1)], WIDTH) == pytest.approx((60 + 60) / (1400 - 120))


def test_every_pair_has_its_place_in_the_table():
    a, b = np.array([box(0, 0, 10, 10), box(50, 0, 10, 10)]), np.array([box(50, 0, 10, 10)] * 3)
    assert box_iou(a, b, WIDTH).tolist() == [[0, 0, 0], [1, 1, 1]]
    assert box_iou(a, [], WIDTH).shape == (2, 0)


@given(
    st.floats(0, 1279), st.floats(1, 1280), st.floats(0, 1279), st.floats(1, 1280), st.integers(-3000, 3000)
)  # fmt: skip
def test_turning_both_boxes_keeps_their_overlap(u_a, across_a, u_b, across_b, columns):
    a, b = box(u_a, 100, across_a, 50), box(u_b, 120, across_b, 60)
    turn = np.array([columns, 0, columns, 0])
    assert box_iou([a + turn], [b + turn], WIDTH) == pytest.approx(box_iou([a], [b], WIDTH), abs=1e-9)
    assert 0 <= box_iou([a], [b], WIDTH)[0, 0] <= 1 + 1e-12


@given(st.floats(-1e4, 1e4), st.floats(1, 1280))
def test_a_wrapped_box_starts_on_the_image_and_keeps_its_size(u, across):
    wrapped = wrapped_box(box(u, 5, across, 10), WIDTH)
    assert 0 <= wrapped[0] < WIDTH
    assert wrapped[2] - wrapped[0] == pytest.approx(across, abs=1e-8)


def test_the_centre_of_a_box_across_the_seam_lies_past_the_width():
    assert box_centre([1260, 10, 1320, 30]).tolist() == [1290, 20]


@pytest.mark.parametrize(
    ("bad", "says"),
    [
        ([[1, 2, 3]], "shape"),
        ([[np.nan, 0, 1, 1]], "finite"),
        ([[10, 0, 5, 1]], "above the width"),
        ([[0, 5, 5, 5]], "v_min < v_max"),
        ([[0, 0, 1281, 1]], "wider than the panorama"),
    ],
)
def test_what_is_no_box_is_named(bad, says):
    with pytest.raises(DetectionError, match=says):
        box_iou(bad, [[0, 0, 1, 1]], WIDTH)


def test_a_width_of_zero_is_refused():
    with pytest.raises(DetectionError, match="width"):
        wrapped_box([0, 0, 1, 1], 0)
