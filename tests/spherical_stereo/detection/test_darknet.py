"""Darknet files: the floats a cfg implies, and every way in which the three files can fail to fit."""

import struct

import numpy as np
import pytest

from course_lib.spherical_stereo.detection import darknet

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


def section(kind, **options):
    return "\n".join([f"[{kind}]", *(f"{name}={value}" for name, value in options.items())]) + "\n"


def conv(filters, size, stride=1):
    return section("convolutional", batch_normalize=1, filters=filters, size=size, stride=stride, pad=1)


def yolov4_tiny():
    """What decides its number of weights, written from the architecture. Source: Bochkovskiy, Wang, Liao 2020."""
    head = section("convolutional", filters=255) + section("yolo", classes=80)
    parts = [section("net"), conv(32, 3, 2), conv(64, 3, 2)]
    for n in (64, 128, 256):
        parts += [conv(n, 3), section("route", layers=-1, groups=2, group_id=1), conv(n // 2, 3), conv(n // 2, 3)]
        parts += [section("route", layers="-1,-2"), conv(n, 1), section("route", layers="-6,-1"), section("maxpool")]
    parts += [conv(512, 3), conv(256, 1), conv(512, 3), head, section("route", layers=-4), conv(128, 1)]
    return "".join([*parts, section("upsample"), section("route", layers="-1,23"), conv(256, 3), head])


def test_a_cfg_implies_the_number_of_floats():
    assert 20 + 4 * darknet.expected_weight_floats(darknet.parse_cfg(yolov4_tiny())) == 24_251_276  # as published
    assert darknet.expected_weight_floats(darknet.parse_cfg(SMALL)) == SMALL_FLOATS
    # Channels follow routes, groups and reorganisation.
    text = section("net", channels=1) + section("convolutional", filters=6)
    text += section("route", layers=-1, groups=2, group_id=1) + section("reorg", stride=2)
    text += section("route", layers="-1,0") + section("shortcut", **{"from": -1})
    assert darknet.layer_channels(darknet.parse_cfg(text)) == [(1, 6), (6, 3), (3, 12), (18, 18), (18, 18)]


def test_a_cfg_keeps_its_order_options_and_lines_and_comes_back_from_its_text(tmp_path):
    (tmp_path / "small.cfg").write_text(SMALL)
    sections = darknet.read_cfg(tmp_path / "small.cfg")
    assert [(s.kind[:4], s.line) for s in sections] == [("net", 2), ("conv", 6), ("conv", 12), ("yolo", 17)]
    assert sections[3].options["anchors"] == "10,20, 40,80"
    assert darknet.class_count(sections) == 2
    with pytest.raises(darknet.DetectorError, match=r"\[yolo\] or \[region\]"):
        darknet.class_count(sections[:-1])
    other = darknet.Section("yolo", {"classes": "3"}, 20)
    with pytest.raises(darknet.DetectorError, match=r"must agree on classes; they have \[2, 3\]"):
        darknet.class_count([*sections, other])
    again = darknet.parse_cfg(darknet.render_cfg(sections))
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
    with pytest.raises(darknet.DetectorError, match=says):
        darknet.expected_weight_floats(darknet.parse_cfg(text))


@pytest.mark.parametrize("header", [struct.pack("<3iq", 0, 2, 5, 0), struct.pack("<3ii", 0, 1, 0, 0)])
def test_weights_must_have_exactly_the_length_that_the_cfg_implies(tmp_path, header):
    path, sections = tmp_path / "some.weights", darknet.parse_cfg(SMALL)
    whole = header + np.zeros(SMALL_FLOATS, "<f4").tobytes()
    path.write_bytes(whole)
    darknet.check_weights(sections, path)
    short = [(whole[:n], f"floats, the cfg needs {SMALL_FLOATS}") for n in (len(whole) - 4, len(whole) - 2, 19, 5, 0)]
    infinite = header + np.full(SMALL_FLOATS, np.inf, "<f4").tobytes()
    for content, says in (*short, (whole + bytes(4), f"{SMALL_FLOATS + 1} floats"), (infinite, "NaN or infinite")):
        path.write_bytes(content)
        with pytest.raises(darknet.DetectorError, match=rf"some\.weights holds .*{says}"):
            darknet.check_weights(sections, path)


def test_names_are_one_a_line_without_gaps_and_as_many_as_the_classes(tmp_path):
    path = tmp_path / "some.names"
    path.write_text("sofa\npotted plant\n\n\n")
    assert darknet.read_names(path) == ["sofa", "potted plant"]
    darknet.check_names(2, darknet.read_names(path), path)
    with pytest.raises(darknet.DetectorError, match=r"3 classes, names file .*names has 2"):
        darknet.check_names(3, darknet.read_names(path), path)
    for text in ("sofa\n\nchair\n", "\n"):
        path.write_text(text)
        with pytest.raises(darknet.DetectorError, match="empty line"):
            darknet.read_names(path)
