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
    input_size,
    layer_channels,
    parse_cfg,
    read_cfg,
    read_names,
    render_cfg,
)
from tests.spherical_stereo.detection.published_cfgs import yolov4, yolov4_tiny

SMALL = """
[net]  # a comment
width=64
height=32

[convolutional]
batch_normalize=1
filters=8
size=3
stride=2
pad=1
activation=leaky

[convolutional]
groups=2
filters=14
size=1
activation=linear

[yolo]
mask=0,1
anchors=10,20, 40,80
classes=2
num=2
"""
SMALL_FLOATS = 4 * 8 + 8 * 3 * 9 + 14 + 14 * 4


NEW_HEADER = struct.pack("<3iq", 0, 2, 5, 0)


def write_weights(path, floats, header=NEW_HEADER):
    path.write_bytes(header + np.zeros(floats, "<f4").tobytes())
    return path


def test_a_published_yolov4_weights_file_has_the_size_that_its_cfg_implies():
    assert 20 + 4 * expected_weight_floats(parse_cfg(yolov4())) == 257_717_640


def test_a_published_yolov4_tiny_weights_file_has_the_size_that_its_cfg_implies():
    assert 20 + 4 * expected_weight_floats(parse_cfg(yolov4_tiny())) == 24_251_276


def test_a_convolution_counts_its_biases_its_statistics_and_its_kernels_by_group():
    assert expected_weight_floats(parse_cfg(SMALL)) == SMALL_FLOATS


def test_channels_follow_routes_groups_and_reorganisation():
    text = """[net]
width=32
height=32
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


def test_a_cfg_read_from_a_file_keeps_its_order_options_and_lines(tmp_path):
    (tmp_path / "small.cfg").write_text(SMALL)
    sections = read_cfg(tmp_path / "small.cfg")
    assert [(section.kind, section.line) for section in sections] == [
        ("net", 2),
        ("convolutional", 6),
        ("convolutional", 14),
        ("yolo", 20),
    ]
    assert sections[3].options["anchors"] == "10,20, 40,80"
    assert (input_size(sections), class_count(sections)) == ((64, 32), 2)


def test_a_cfg_written_and_read_again_is_the_same():
    sections = parse_cfg(yolov4_tiny())
    again = parse_cfg(render_cfg(sections))
    assert [(s.kind, s.options) for s in again] == [(s.kind, s.options) for s in sections]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "no \\[section\\]"),
        ("width=3\n[net]\n", "line 1: 'width=3' comes before any"),
        ("[convolutional]\nfilters=3\n", "line 1: starts with \\[convolutional\\]"),
        ("[net]\nwidth=3\n", "no layer"),
        ("[net]\nwidth=3\n[convolutional]\n\n[yolo]\nnum=1\n", "line 3: section \\[convolutional\\] is empty"),
        ("[net]\nwidth=3\n[lstm]\nsize=1\n", "line 3: unknown section \\[lstm\\]"),
        ("[net]\nwidth 3\n", "line 2: 'width 3' is neither"),
        ("[net]\nwidth=\n", "line 2: 'width=' is neither"),
        ("[net\nwidth=3\n", "line 1: '\\[net' is neither"),
    ],
)
def test_a_malformed_cfg_is_refused_with_its_line(text, message):
    with pytest.raises(DetectorError, match=message):
        parse_cfg(text)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("filters=8", "filters=many", "line 6: filters=many is not a whole number"),
        ("filters=8\n", "", "line 6 has no filters"),
        ("groups=2", "groups=3", "line 14: groups=3 does not divide 8"),
        ("filters=8", "filters=0", "line 6 has 0 output channels"),
        ("[yolo]", "[route]\nlayers=5\n[yolo]", "line 20, layer 2: points to layer 5"),
        ("[yolo]", "[route]\nlayers=-3\n[yolo]", "layer 2: points to layer -3"),
        ("[yolo]", "[route]\nlayers=-1\ngroups=2\ngroup_id=2\n[yolo]", "group_id"),
        ("[yolo]", "[route]\nlayers=last\n[yolo]", "layers=last is not a list"),
    ],
)
def test_a_layer_that_cannot_be_built_is_named(old, new, message):
    with pytest.raises(DetectorError, match=message):
        expected_weight_floats(parse_cfg(SMALL.replace(old, new)))


def test_a_missing_cfg_and_one_that_is_no_text_are_named(tmp_path):
    with pytest.raises(DetectorError, match=r"nothing\.cfg is missing"):
        read_cfg(tmp_path / "nothing.cfg")
    (tmp_path / "weights.cfg").write_bytes(bytes([0xFF, 0xFE, 0x80]))
    with pytest.raises(DetectorError, match="not UTF-8 text: byte 0xff in line 1"):
        read_cfg(tmp_path / "weights.cfg")


def test_weights_of_the_right_length_pass_with_both_headers(tmp_path):
    sections = parse_cfg(SMALL)
    check_weights(sections, write_weights(tmp_path / "new.weights", SMALL_FLOATS))
    old_header = struct.pack("<3ii", 0, 1, 0, 0)
    check_weights(sections, write_weights(tmp_path / "old.weights", SMALL_FLOATS, old_header))


@pytest.mark.parametrize(("change", "message"), [(-1, "too short"), (1, "too long")])
def test_weights_of_another_length_are_refused_with_both_counts(tmp_path, change, message):
    path = write_weights(tmp_path / "some.weights", SMALL_FLOATS + change)
    with pytest.raises(DetectorError, match=f"{message}.*{SMALL_FLOATS + change} floats.*{SMALL_FLOATS}"):
        check_weights(parse_cfg(SMALL), path)


def test_weights_cut_inside_a_float_or_inside_the_header_are_refused(tmp_path):
    path = tmp_path / "cut.weights"
    whole = write_weights(path, SMALL_FLOATS).read_bytes()
    for length in (len(whole) - 2, 19, 5, 0):
        path.write_bytes(whole[:length])
        with pytest.raises(DetectorError, match=r"too short|cut off"):
            check_weights(parse_cfg(SMALL), path)


def test_missing_weights_are_named(tmp_path):
    with pytest.raises(DetectorError, match=r"none\.weights is missing"):
        check_weights(parse_cfg(SMALL), tmp_path / "none.weights")


def test_detection_layers_must_agree_with_their_input():
    with pytest.raises(DetectorError, match=r"gets 14 channels, expected 2 anchors \* \(5 \+ 3 classes\) = 16"):
        class_count(parse_cfg(SMALL.replace("classes=2", "classes=3")))
    with pytest.raises(DetectorError, match=r"no \[yolo\] or \[region\]"):
        class_count(parse_cfg(SMALL.split("[yolo]")[0]))


def test_names_are_as_many_as_the_classes():
    check_names(parse_cfg(SMALL), ["sofa", "chair"])
    with pytest.raises(DetectorError, match="2 classes, the names file 3"):
        check_names(parse_cfg(SMALL), ["sofa", "chair", "table"])


def test_names_end_at_the_last_name_and_have_no_gaps(tmp_path):
    path = tmp_path / "some.names"
    path.write_text("sofa\npotted plant\n\n\n")
    assert read_names(path) == ["sofa", "potted plant"]
    path.write_text("sofa\n\nchair\n")
    with pytest.raises(DetectorError, match="line 2 is empty"):
        read_names(path)
    path.write_text("\n")
    with pytest.raises(DetectorError, match="is empty"):
        read_names(path)
