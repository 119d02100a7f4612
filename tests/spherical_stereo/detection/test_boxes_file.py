"""Boxes drawn by hand: what the file says comes out as detections, and what does not fit is named."""

import json

import numpy as np
import pytest

from course_lib.spherical_stereo.detection.boxes_file import read_stereo_boxes
from course_lib.spherical_stereo.detection.detected_object import DetectionError
from course_lib.spherical_stereo.panorama import PanoramaError

GOOD = {
    "version": 1,
    "width": 256,
    "height": 128,
    "upper": [
        {"label": "chair", "box": [30, 20, 70, 60], "name": "left chair"},
        {"label": "tv", "box": [240, 30, 280, 50], "name": "screen"},
        {"label": "chair", "box": [100, 20, 140, 60]},
    ],
    "lower": [
        {"label": "television", "box": [241, 20, 281, 40], "name": "screen"},
        {"label": "chair", "box": [11, 10, 49, 50], "name": "left chair"},
    ],
}


def write(path, content):
    path.write_text(content if isinstance(content, str) else json.dumps(content))
    return path


def images():
    upper = np.full((128, 256, 3), 128, dtype=np.uint8)
    upper[20:60, 30:70] = (0, 0, 200)
    lower = np.full((128, 256, 3), 128, dtype=np.uint8)
    lower[20:40, 241:] = lower[20:40, :25] = (0, 200, 0)
    return upper, lower


def test_boxes_become_detections_with_the_colours_of_their_images(tmp_path):
    upper, lower = (view.detections for view in read_stereo_boxes(write(tmp_path / "boxes.json", GOOD)).on(*images()))
    assert [d.label for d in upper] == ["chair", "television", "chair"]
    assert [d.label for d in lower] == ["television", "chair"]
    assert upper[1].box == (240, 30, 280, 50)
    assert upper[0].hue == pytest.approx(0, abs=1e-6)
    assert upper[0].saturation == pytest.approx(100, abs=1e-3)
    assert upper[1].is_grey
    assert lower[0].hue == pytest.approx(120, abs=1e-3)
    assert {d.score for d in upper + lower} == {1.0}


def test_names_pair_the_objects_of_both_images(tmp_path):
    boxes = read_stereo_boxes(write(tmp_path / "boxes.json", GOOD))
    assert boxes.named_pairs() == [("left chair", 0, 1), ("screen", 1, 0)]


def test_a_box_a_turn_too_far_is_moved_back(tmp_path):
    content = GOOD | {"upper": [{"label": "chair", "box": [-10, 20, 30, 60]}]}
    assert read_stereo_boxes(write(tmp_path / "boxes.json", content)).upper[0].box == (246, 20, 286, 60)


def test_images_of_another_size_are_refused(tmp_path):
    boxes = read_stereo_boxes(write(tmp_path / "boxes.json", GOOD))
    small = images()[0][:64, :128]
    with pytest.raises(DetectionError, match="drawn on images of 256 x 128, these are 128 x 64"):
        boxes.on(small, small)
    with pytest.raises(PanoramaError, match="one size"):
        boxes.on(images()[0], small)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(DetectionError, match=r"boxes file .* is missing"):
        read_stereo_boxes(tmp_path / "none.json")


def side(**change):
    return {"upper": [{"label": "chair", "box": [10, 20, 50, 60]} | change]}


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("{", "is not JSON"),
        ("[]", "version 1; got version None"),
        (GOOD | {"version": 2}, "version 1; got version 2"),
        (GOOD | {"width": 250}, "width = 2 height"),
        (GOOD | {"height": "128"}, "width = 2 height"),
        (GOOD | {"lower": None}, 'list "lower"'),
        (GOOD | {"upper": [3]}, r"upper\[0\] must be an object"),
        (GOOD | {"upper": [{"label": "chair"}]}, r"upper\[0\] must be an object with label and box"),
        (GOOD | side(label=""), "label is a text"),
        (GOOD | side(box=[1, 2, 3]), "shape"),
        (GOOD | side(box=5), "shape"),
        (GOOD | side(box={}), r"upper\[0\]"),
        ("[" * 100_000, "levels"),
        (GOOD | side(box=[[1, 2, 3, 4]]), "box must be"),
        (GOOD | side(box=[1, 2, "x", 4]), r"upper\[0\]"),
        (GOOD | side(box=[1, 2, None, 4]), "finite|float"),
        (GOOD | side(box=[50, 20, 10, 60]), "u_min < u_max"),
        (GOOD | side(box=[10, 20, 300, 60]), "wider than the panorama"),
        (GOOD | side(box=[10, -1, 50, 60]), "leaves the image"),
        (GOOD | side(box=[10, 20, 50, 129]), "leaves the image"),
        (GOOD | side(name=""), "name must be a text"),
        (GOOD | side(name="screen"), "'screen' is a chair above and a television below"),
        (GOOD | {"upper": 2 * side(name="one")["upper"]}, "twice: one"),
    ],
)
def test_a_file_that_does_not_fit_is_refused(tmp_path, content, message):
    with pytest.raises(DetectionError, match=message):
        read_stereo_boxes(write(tmp_path / "boxes.json", content))


def test_a_box_that_is_a_number_is_named(tmp_path):
    with pytest.raises(DetectionError, match=r"boxes\.json, upper\[0\]: box must be of the shape .*; got 5"):
        read_stereo_boxes(write(tmp_path / "boxes.json", GOOD | side(box=5)))
