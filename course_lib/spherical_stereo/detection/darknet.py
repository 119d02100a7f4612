"""Darknet files, read before OpenCV does: the layers of a `.cfg`, the size that its `.weights` must have, the `.names`.

OpenCV takes a truncated `.weights` file without a word and then detects nonsense. The number of floats follows from the
cfg alone, so it is counted here first.

A `.weights` file is a header (major, minor, revision as int32; images seen so far as int64, or int32 before version
0.2) and then float32 only, layer by layer. A convolution has

    filters biases [+ filters scales, means, variances]  and  filters * channels / groups * size^2 kernel values

with the bracket where `batch_normalize=1`. Nothing else in the YOLOv4 family has weights.
Source: paper 2, section 2.2 (its detector is YOLOv4).
"""

import struct
from pathlib import Path

from course_lib.files import read_text, require_file
from course_lib.spherical_stereo.detection.darknet_cfg import (
    DETECTION_KINDS,
    DetectorError,
    Section,
    parse_cfg,
    read_cfg,
    render_cfg,
)

__all__ = [
    "DETECTION_KINDS",
    "DetectorError",
    "Section",
    "check_names",
    "check_weights",
    "class_count",
    "expected_weight_floats",
    "header_bytes",
    "input_size",
    "layer_channels",
    "parse_cfg",
    "read_cfg",
    "read_names",
    "render_cfg",
]


def layer_channels(sections: list[Section]) -> list[tuple[int, int]]:
    """(channels in, channels out) of every layer, that is of every section after `[net]`.

    Raises DetectorError: a route or shortcut to a layer that does not come before it, or groups that do not divide.
    """
    channels: list[tuple[int, int]] = []
    previous = sections[0].integer("channels", 3)
    for index, section in enumerate(sections[1:]):
        incoming, outgoing = previous, previous
        if section.kind == "convolutional":
            outgoing = section.integer("filters")
        elif section.kind == "reorg":
            outgoing = previous * section.integer("stride", 1) ** 2
        elif section.kind == "route":
            sources = [channels[_layer_index(section, source, index)][1] for source in section.integers("layers")]
            incoming = sum(sources)
            outgoing = _divide(section, incoming, section.integer("groups", 1))
            if not 0 <= section.integer("group_id", 0) < section.integer("groups", 1):
                raise DetectorError(f"[route] at line {section.line}: group_id is not one of its groups, from 0")
        elif section.kind in ("shortcut", "sam", "scale_channels"):
            sources = [channels[_layer_index(section, source, index)][1] for source in section.integers("from")]
            outgoing = sources[0] if section.kind == "scale_channels" else previous
        if outgoing < 1:
            raise DetectorError(
                f"[{section.kind}] at line {section.line} has {outgoing} output channels, expected 1 or more"
            )
        channels.append((incoming, outgoing))
        previous = outgoing
    return channels


def _layer_index(section: Section, source: int, index: int) -> int:
    """A layer counted from the start, or backwards from this one when negative, as an index from 0."""
    absolute = source if source >= 0 else index + source
    if not 0 <= absolute < index:
        raise DetectorError(
            f"[{section.kind}] at line {section.line}, layer {index}: points to layer {source}, expected one before it"
        )
    return absolute


def _divide(section: Section, channels: int, groups: int) -> int:
    if groups < 1 or channels % groups:
        raise DetectorError(
            f"[{section.kind}] at line {section.line}: groups={groups} does not divide {channels} channels"
        )
    return channels // groups


def expected_weight_floats(sections: list[Section]) -> int:
    """How many float32 values the `.weights` file of this cfg holds after its header.

        sum over convolutions of  filters * (4 if batch_normalize else 1) + filters * channels / groups * size^2

    Raises DetectorError as `layer_channels` does. Source: paper 2, section 2.2 (YOLOv4).
    """
    floats = 0
    for section, (incoming, filters) in zip(sections[1:], layer_channels(sections), strict=True):
        if section.kind == "convolutional":
            per_filter = _divide(section, incoming, section.integer("groups", 1)) * section.integer("size", 1) ** 2
            _divide(section, filters, section.integer("groups", 1))
            vectors = 4 if section.integer("batch_normalize", 0) else 1
            floats += filters * (vectors + per_filter)
    return floats


def check_weights(cfg: str | Path | list[Section], weights: str | Path) -> None:
    """Refuse a `.weights` file that does not hold exactly the floats its cfg implies.

    `cfg` is a path or the sections of one. Raises DetectorError: a file is missing, the header is incomplete, or the
    number of floats differs (the message has both counts). Source: paper 2, section 2.2 (YOLOv4).
    """
    sections = cfg if isinstance(cfg, list) else read_cfg(cfg)
    told = "the cfg" if isinstance(cfg, list) else f"cfg {cfg}"
    weights = Path(weights)
    require_file(weights, "weights file", DetectorError)
    with weights.open("rb") as file:
        start = file.read(12)
    size = weights.stat().st_size
    header = header_bytes(start) if len(start) == 12 else 20
    if size < header:
        raise DetectorError(f"weights file {weights} has {size} bytes, less than its header of {header}: it is cut off")
    expected = expected_weight_floats(sections)
    if size != header + 4 * expected:
        problem = "is too short: was the download or copy cut off?" if size < header + 4 * expected else "is too long"
        raise DetectorError(
            f"weights file {weights} {problem} It holds {(size - header) / 4:.10g} floats, {told} needs {expected}; "
            "give the cfg and the weights of the same network"
        )


def header_bytes(start: bytes) -> int:
    """Length of the header whose first 12 bytes these are: 20, or 16 before version 0.2 (`seen` was int32 then)."""
    major, minor, _ = struct.unpack("<3i", start)
    return 20 if major * 10 + minor >= 2 else 16


def class_count(sections: list[Section]) -> int:
    """The number of classes of the detection layers (`[yolo]` or `[region]`).

    Raises DetectorError: no such layer, layers that disagree, or a layer whose input does not have
    anchors * (5 + classes) channels.
    """
    layers = [
        (section, incoming)
        for section, (incoming, _) in zip(sections[1:], layer_channels(sections), strict=True)
        if section.kind in DETECTION_KINDS
    ]
    if not layers:
        raise DetectorError("the cfg has no [yolo] or [region] section: it is not a detector")
    counts = {section.integer("classes") for section, _ in layers}
    if len(counts) > 1:
        raise DetectorError(f"the cfg's detection layers disagree about the number of classes: {sorted(counts)}")
    (classes,) = counts
    for section, incoming in layers:
        anchors = len(section.integers("mask")) if "mask" in section.options else section.integer("num")
        if incoming != anchors * (5 + classes):
            raise DetectorError(
                f"[{section.kind}] at line {section.line} gets {incoming} channels, "
                f"expected {anchors} anchors * (5 + {classes} classes) = {anchors * (5 + classes)}"
            )
    return classes


MOST_INPUT_PIXELS = 1 << 24
"""Pixels of a network's input, 4096 x 4096: YOLOv4 has 608 x 608, and needs a hundred times as many numbers inside."""


def input_size(sections: list[Section]) -> tuple[int, int]:
    """(width, height) of the network's input in pixels. Raises DetectorError: missing, not positive or too large."""
    width, height = sections[0].integer("width"), sections[0].integer("height")
    if width < 1 or height < 1:
        raise DetectorError(
            f"[{sections[0].kind}] at line {sections[0].line}: input {width} x {height} is not positive"
        )
    if width * height > MOST_INPUT_PIXELS:
        raise DetectorError(
            f"[{sections[0].kind}] at line {sections[0].line}: input {width} x {height} is more than "
            f"{MOST_INPUT_PIXELS:,} pixels"
        )
    return width, height


def read_names(path: str | Path) -> list[str]:
    """The class names of a `.names` file, one a line; empty lines at the end do not count.

    Raises DetectorError: the file is missing or not text, or an empty line stands between names.
    """
    names = [line.strip() for line in read_text(path, "names file", DetectorError).rstrip().splitlines()]
    for number, name in enumerate(names, start=1):
        if not name:
            raise DetectorError(f"names file {path}, line {number} is empty: every line names one class")
    if not names:
        raise DetectorError(f"names file {path} is empty: it has one class name a line")
    return names


def check_names(sections: list[Section], names: list[str]) -> None:
    """Refuse class names whose number is not the cfg's. Raises DetectorError with both counts."""
    classes = class_count(sections)
    if len(names) != classes:
        raise DetectorError(
            f"the cfg has {classes} classes, the names file {len(names)}: give the names of that network"
        )
