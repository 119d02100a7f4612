"""Boxes drawn by hand become detections, and a file that cannot be used is named."""

import json

import numpy as np
import pytest

from course_lib.spherical_stereo.detection.detected_object import DetectionError
from course_lib.spherical_stereo.drawn_boxes import read_stereo_boxes

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


def read_boxes(folder, content):
    (folder / "boxes.json").write_text(json.dumps(content))
    return read_stereo_boxes(folder / "boxes.json")


def test_boxes_become_detections_with_the_colours_of_their_images(tmp_path):
    images = np.full((2, 128, 256, 3), 128, dtype=np.uint8)
    images[0, 20:60, 30:70] = (0, 0, 200)
    images[1, 20:40, 241:] = images[1, 20:40, :25] = (0, 200, 0)
    boxes = read_boxes(tmp_path, GOOD)
    upper, lower = (view.detections for view in boxes.on(*images))
    assert [d.label for d in upper] == ["chair", "television", "chair"]
    assert [d.label for d in lower] == ["television", "chair"]
    assert upper[1].box == (240, 30, 280, 50), "a turn too far is moved back"
    assert (upper[0].hue, upper[0].saturation) == (pytest.approx(0, abs=1e-6), pytest.approx(100, abs=1e-3))
    assert upper[1].is_grey
    assert lower[0].hue == pytest.approx(120, abs=1e-3)
    assert {d.score for d in upper + lower} == {1.0}
    assert [one.name for one in boxes.upper] == ["left chair", "screen", None]
    with pytest.raises(DetectionError, match="scale the images"):
        boxes.on(*images[:, :64, :128])


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
        (side(box=[1, 2, None, 4]), "found None"),
        (side(box=[10, 20, 50, 129]), "leaves the image"),
        (side(box=[10, -1, 50, 120]), "leaves the image"),
        (side(name=""), "name must be a text"),
    ],
)
def test_a_file_that_does_not_fit_is_refused(tmp_path, change, says):
    with pytest.raises(DetectionError, match=rf"boxes\.json: .*{says}"):
        read_boxes(tmp_path, GOOD | change)
