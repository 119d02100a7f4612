"""Letterboxing: nothing is distorted or cut off, and boxes come back exactly."""

import numpy as np
import pytest

from course_lib.spherical_stereo.detection.detector import PADDING_GREY, boxes_to_image, letterbox_image


@pytest.mark.parametrize(
    ("image_size", "input_size"),
    [((160, 64), (128, 51)), ((160, 64), (60, 60)), ((33, 77), (42, 42)), ((50, 20), (416, 416)), ((200, 3), (42, 42))],
)
def test_the_whole_image_lies_inside_the_input_and_its_box_comes_back_exactly(image_size, input_size):
    padded, letterbox = letterbox_image(np.full((*image_size[::-1], 3), 255, dtype=np.uint8), input_size)
    rows, columns = np.nonzero((padded != PADDING_GREY).any(axis=-1))
    inside = [columns.min(), rows.min(), columns.max() + 1, rows.max() + 1]
    assert boxes_to_image(inside, letterbox) == pytest.approx([0, 0, *image_size], abs=1e-10)
    assert (inside[2] - inside[0] == input_size[0]) or (inside[3] - inside[1] == input_size[1])
