"""Darknet files: the floats a cfg implies, and every way in which the three files can fail to fit."""

import struct

import numpy as np
import pytest

from course_lib.spherical_stereo.detection.darknet import (
    DetectorError,
    check_names,
    check_weights,
    class_count,
    expected_weight_floats,
    layer_channels,
    parse_cfg,
    read_cfg,
    read_names,
    render_cfg,
)
from tests.spherical_stereo.detection.published_cfgs import yolov4_tiny

SMALL = """
[net]  # a comment
width=64
height=32

[convolutional]
batch_normalize=1
filters=8
size=3
stride=2

[convolutional]
groups=2
filters=14
size=1

[yolo]
mask=0,1
anchors=10,20, 40,80
classes=2
"""
SMALL_FLOATS = 4 * 8 + 8 * 3 * 9 + 14 + 14 * 4


def test_the_published_yolov4_tiny_weights_file_has_the_size_that_its_cfg_implies():
    assert 20 + 4 * expected_weight_floats(parse_cfg(yolov4_tiny())) == 24_251_276


def test_a_convolution_counts_its_biases_its_statistics_and_its_kernels_by_group():
    assert expected_weight_floats(parse_cfg(SMALL)) == SMALL_FLOATS


def test_channels_follow_routes_groups_and_reorganisation():
    text = """[net]
channels=1
[convolutional]
filters=6
[route]
layers=-1
groups=2
group_id=1
[reorg]
stride=2
[route]
layers=-1,0
[shortcut]
from=-1
"""
    assert layer_channels(parse_cfg(text)) == [(1, 6), (6, 3), (3, 12), (18, 18), (18, 18)]


def test_a_cfg_keeps_its_order_options_and_lines_and_comes_back_from_its_text(tmp_path):
    (tmp_path / "small.cfg").write_text(SMALL)
    sections = read_cfg(tmp_path / "small.cfg")
    assert [(s.kind[:4], s.line) for s in sections] == [("net", 2), ("conv", 6), ("conv", 12), ("yolo", 17)]
    assert sections[3].options["anchors"] == "10,20, 40,80"
    assert class_count(sections) == 2
    again = parse_cfg(render_cfg(sections))
    assert [(s.kind, s.options) for s in again] == [(s.kind, s.options) for s in sections]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "has 0 sections"),
        ("[convolutional]\nfilters=3\n", r"line 1: unknown section \[convolutional\], expected \[net\]"),
        ("[net]\nwidth=3\n[lstm]\nsize=1\n", r"line 3: unknown section \[lstm\]"),
        ("[net]\nwidth 3\n", "line 2: 'width 3' is neither"),
        (SMALL.replace("filters=8", "filters=many"), "line 6: filters must be whole numbers; got many"),
        (SMALL.replace("groups=2", "groups=3"), "line 12: groups=3 does not divide 8"),
        (SMALL.replace("[yolo]", "[route]\nlayers=2\n[yolo]"), "line 17: layer 2 points to layer 2"),
        (SMALL.replace("[yolo]", "[route]\nlayers=-3\n[yolo]"), "layer 2 points to layer -3"),
    ],
)
def test_a_malformed_cfg_is_refused_with_its_line(text, says):
    with pytest.raises(DetectorError, match=says):
        expected_weight_floats(parse_cfg(text))


@pytest.mark.parametrize("header", [struct.pack("<3iq", 0, 2, 5, 0), struct.pack("<3ii", 0, 1, 0, 0)])
def test_weights_must_have_exactly_the_length_that_the_cfg_implies(tmp_path, header):
    path, sections = tmp_path / "some.weights", parse_cfg(SMALL)
    whole = header + np.zeros(SMALL_FLOATS, "<f4").tobytes()
    path.write_bytes(whole)
    check_weights(sections, path)
    for length in (len(whole) - 4, len(whole) - 2, 19, 5, 0):
        path.write_bytes(whole[:length])
        with pytest.raises(DetectorError, match=f"floats, the cfg needs {SMALL_FLOATS}"):
            check_weights(sections, path)
    path.write_bytes(whole + bytes(4))
    with pytest.raises(DetectorError, match=f"{SMALL_FLOATS + 1} floats"):
        check_weights(sections, path)


def test_weights_that_are_no_numbers_and_a_cfg_without_a_detection_layer_are_named(tmp_path):
    path = tmp_path / "some.weights"
    path.write_bytes(struct.pack("<3iq", 0, 2, 5, 0) + np.full(SMALL_FLOATS, np.inf, "<f4").tobytes())
    with pytest.raises(DetectorError, match=r"some\.weights holds numbers that are NaN or infinite"):
        check_weights(parse_cfg(SMALL), path)
    with pytest.raises(DetectorError, match=r"\[yolo\] or \[region\]"):
        class_count(parse_cfg(SMALL.split("[yolo]")[0]))


def test_names_are_one_a_line_without_gaps_and_as_many_as_the_classes(tmp_path):
    path = tmp_path / "some.names"
    path.write_text("sofa\npotted plant\n\n\n")
    assert read_names(path) == ["sofa", "potted plant"]
    check_names(2, read_names(path), path)
    with pytest.raises(DetectorError, match=r"3 classes, names file .*names has 2"):
        check_names(3, read_names(path), path)
    for text in ("sofa\n\nchair\n", "\n"):
        path.write_text(text)
        with pytest.raises(DetectorError, match="empty line"):
            read_names(path)
