"""Boxes drawn by hand: what the file says comes out as detections, and what does not fit is named."""

import json

import numpy as np
import pytest

from course_lib.spherical_stereo.detection.boxes_file import read_stereo_boxes
from course_lib.spherical_stereo.detection.detected_object import DetectionError

GOOD = {
    "version": 1,
    "width": 256,
    "height": 128,
    "upper": [
        {"label": "chair", "box": [30, 20, 70, 60], "name": "left chair"},
        {"label": "tv", "box": [-16, 30, 24, 50], "name": "screen"},
        {"label": "chair", "box": [100, 20, 140, 60]},
    ],
    "lower": [
        {"label": "television", "box": [241, 20, 281, 40], "name": "screen"},
        {"label": "chair", "box": [11, 10, 49, 50], "name": "left chair"},
    ],
}


def read(folder, content):
    path = folder / "boxes.json"
    path.write_text(json.dumps(content))
    return read_stereo_boxes(path)


def images():
    upper = np.full((128, 256, 3), 128, dtype=np.uint8)
    upper[20:60, 30:70] = (0, 0, 200)
    lower = np.full((128, 256, 3), 128, dtype=np.uint8)
    lower[20:40, 241:] = lower[20:40, :25] = (0, 200, 0)
    return upper, lower


def test_boxes_become_detections_with_the_colours_of_their_images(tmp_path):
    boxes = read(tmp_path, GOOD)
    upper, lower = (view.detections for view in boxes.on(*images()))
    assert [d.label for d in upper] == ["chair", "television", "chair"]
    assert [d.label for d in lower] == ["television", "chair"]
    assert upper[1].box == (240, 30, 280, 50), "a turn too far is moved back"
    assert (upper[0].hue, upper[0].saturation) == (pytest.approx(0, abs=1e-6), pytest.approx(100, abs=1e-3))
    assert upper[1].is_grey
    assert lower[0].hue == pytest.approx(120, abs=1e-3)
    assert {d.score for d in upper + lower} == {1.0}
    assert [one.name for one in boxes.upper] == ["left chair", "screen", None]


def test_images_of_another_size_are_refused(tmp_path):
    small = images()[0][:64, :128]
    with pytest.raises(DetectionError, match="scale the images"):
        read(tmp_path, GOOD).on(small, small)


def side(**change):
    return {"upper": [{"label": "chair", "box": [10, 20, 50, 60]} | change]}


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"version": 2}, "version"),
        ({"width": 250}, "twice as wide"),
        ({"lower": None}, "lower does not"),
        ({"upper": [3]}, r"upper\[0\]"),
        (side(label=""), r"upper\[0\].*label"),
        (side(box=[1, 2, 3]), r"upper\[0\]"),
        (side(box=[1, 2, None, 4]), "finite"),
        (side(box=[10, 20, 50, 129]), "leaves the image"),
        (side(box=[10, -1, 50, 120]), "leaves the image"),
        (side(name=""), "name must be a text"),
    ],
)
def test_a_file_that_does_not_fit_is_refused(tmp_path, change, says):
    with pytest.raises(DetectionError, match=rf"boxes\.json: .*{says}"):
        read(tmp_path, GOOD | change)
