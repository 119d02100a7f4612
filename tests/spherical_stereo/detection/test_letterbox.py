"""Letterboxing: nothing is distorted or cut off, and boxes come back exactly."""

import numpy as np
import pytest

from course_lib.spherical_stereo.detection.detector import (
    PADDING_GREY,
    boxes_to_image,
    boxes_to_input,
    fit_letterbox,
    letterbox_image,
)

SHAPES = [
    ((1600, 640), (1280, 512)),
    ((1600, 640), (608, 608)),
    ((320, 128), (320, 128)),
    ((333, 777), (416, 416)),
    ((50, 20), (416, 416)),
    ((1025, 410), (640, 256)),
    ((2000, 3), (416, 416)),
]


@pytest.mark.parametrize(("image_size", "input_size"), SHAPES)
def test_boxes_come_back_exactly(image_size, input_size, rng):
    letterbox = fit_letterbox(image_size, input_size)
    boxes = rng.uniform(0, 1, (20, 4)) * np.tile(image_size, 2)
    assert np.allclose(boxes_to_image(boxes_to_input(boxes, letterbox), letterbox), boxes, rtol=1e-13, atol=1e-10)


@pytest.mark.parametrize(("image_size", "input_size"), SHAPES)
def test_the_whole_image_lies_inside_the_input_and_touches_two_sides(image_size, input_size):
    letterbox = fit_letterbox(image_size, input_size)
    corners = boxes_to_input([0, 0, *image_size], letterbox)
    assert np.allclose(corners, [*letterbox.offset, *(np.array(letterbox.offset) + letterbox.inner_size)])
    assert (np.array(letterbox.inner_size) <= input_size).all()
    assert (np.array(letterbox.inner_size) == input_size).any()


@pytest.mark.parametrize(("image_size", "input_size"), SHAPES[:-1])
def test_the_scales_across_and_down_agree_to_a_pixel(image_size, input_size):
    letterbox = fit_letterbox(image_size, input_size)
    across, down = letterbox.scale
    assert abs(across - down) * min(image_size) <= 1


def test_an_extended_panorama_fills_the_shipped_input_without_padding():
    letterbox = fit_letterbox((1600, 640), (1280, 512))
    assert not letterbox.has_padding
    assert letterbox.scale.tolist() == [0.8, 0.8]


@pytest.mark.parametrize(("width", "height"), [(160, 40), (40, 160), (100, 100), (33, 47)])
def test_a_bright_rectangle_lies_where_the_box_says(width, height):
    image = np.zeros((height, width, 3), dtype=np.uint8)
    box = np.array([width // 4, height // 4, width // 2, height // 2])
    image[box[1] : box[3], box[0] : box[2]] = 255
    padded, letterbox = letterbox_image(image, (256, 192))
    assert padded.shape == (192, 256, 3)
    rows, columns = np.nonzero(padded[..., 0] > 200)
    found = [columns.min(), rows.min(), columns.max() + 1, rows.max() + 1]
    assert np.abs(boxes_to_input(box, letterbox) - found).max() <= 1 + letterbox.scale.max() / 2


def test_the_padding_is_grey_on_both_sides():
    padded, letterbox = letterbox_image(np.full((10, 40, 3), 255, dtype=np.uint8), (40, 21))
    assert letterbox.offset == (0, 5)
    outside = np.concatenate([padded[:5], padded[15:]])
    assert (outside == PADDING_GREY).all()
    assert (padded[5:15] == 255).all()


@pytest.mark.parametrize(("image_size", "input_size"), [((0, 5), (5, 5)), ((5, 5), (5, -1)), ((5, 5), (2.5, 5))])
def test_a_size_that_is_none_is_refused(image_size, input_size):
    with pytest.raises(ValueError, match="whole pixels"):
        fit_letterbox(image_size, input_size)
