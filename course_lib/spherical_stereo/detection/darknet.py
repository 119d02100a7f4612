"""A Darknet detector of the YOLOv4 family, run by OpenCV (paper 2, section 2.2), and its three files.

A `.cfg` is text, sections of options in the order of the layers. A `.weights` file is a header (major, minor, revision
as int32; images seen as int64, or int32 before version 0.2) and then float32, for every convolution

    filters biases [+ filters scales, means, variances]  and  filters * channels / groups * size^2 kernel values

with the bracket if `batch_normalize=1`. OpenCV takes a truncated file without an error, so the floats are counted here.
"""

import struct
import threading
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from course_lib.files import read_text, require_file

DETECTION_KINDS = ("yolo", "region")
LAYER_KINDS = ("convolutional", "route", "reorg", "scale_channels", "maxpool", "avgpool", "upsample", "dropout",
               "softmax", "shortcut", "sam", *DETECTION_KINDS)  # fmt: skip
"""Layers whose channels are known. An unknown one would make the count of weights wrong."""
MAX_INPUT_PIXELS = 1 << 24  # 4096 x 4096; YOLOv4 has 608 x 608


class DetectorError(ValueError):
    """A detector that cannot be set up: a file that is missing, malformed or does not fit the others, or an option."""


@dataclass(frozen=True)
class Section:
    """One `[kind]` block of a cfg: its options as text, and the line of its bracket, from 1, for messages."""

    kind: str
    options: dict[str, str]
    line: int

    def integer(self, key: str, default: int | str = "none") -> int:
        """Return the option as a whole number."""
        return self.integers(key, default)[0]

    def integers(self, key: str, default: int | str = "none") -> list[int]:
        """Return the option as whole numbers, separated by commas."""
        text = self.options.get(key, str(default))
        try:
            return [int(part) for part in text.split(",")]
        except ValueError:
            raise self.error(f"{key} must be whole numbers; got {text}") from None

    def error(self, problem: str) -> DetectorError:
        """Return an error that names this section and its line."""
        return DetectorError(f"[{self.kind}] at line {self.line}: {problem}")


def read_cfg(path: str | Path) -> list[Section]:
    """Read a Darknet cfg: the `[net]` section first, then one section for each layer."""
    return parse_cfg(read_text(path, "cfg file", DetectorError), str(path))


def parse_cfg(text: str, name: str = "cfg") -> list[Section]:
    """Return the sections of a cfg given as text."""
    sections: list[Section] = []
    for number, raw in enumerate(text.splitlines(), start=1):
        line = raw.split("#", 1)[0].split(";", 1)[0].strip()
        key, _, value = (part.strip() for part in line.partition("="))
        if line.startswith("[") and line.endswith("]"):
            kind = line[1:-1].strip().lower()
            if kind not in (LAYER_KINDS if sections else ("net", "network")):
                expected = ", ".join(LAYER_KINDS) if sections else "[net] at the start"
                raise DetectorError(f"{name}, line {number}: unknown section [{kind}], expected {expected}")
            sections.append(Section(kind, {}, number))
        elif line and not (sections and key and value):
            raise DetectorError(f"{name}, line {number}: '{line}' is neither [section] nor key=value in a section")
        elif line:
            sections[-1].options[key] = value
    if len(sections) < 2:
        raise DetectorError(f"{name} must have a [net] section and layers; it has {len(sections)} sections")
    return sections


def render_cfg(sections: list[Section]) -> str:
    """Return the text of a cfg with these sections, without comments."""
    blocks = ["\n".join([f"[{s.kind}]", *(f"{key}={value}" for key, value in s.options.items())]) for s in sections]
    return "\n\n".join(blocks) + "\n"


def layer_channels(sections: list[Section]) -> list[tuple[int, int]]:
    """Return (channels in, channels out) of every layer, that is of every section after `[net]`."""
    channels: list[tuple[int, int]] = []

    def source(section: Section, number: int) -> int:
        # A layer is counted from the start, or backwards from this one if the number is negative.
        if not -len(channels) <= number < len(channels):
            raise section.error(f"layer {len(channels)} points to layer {number}, expected one before it")
        return channels[number][1]

    previous = sections[0].integer("channels", 3)
    for section in sections[1:]:
        incoming, outgoing = previous, previous
        if section.kind == "convolutional":
            outgoing = section.integer("filters")
        elif section.kind == "reorg":
            outgoing = previous * section.integer("stride", 1) ** 2
        elif section.kind == "route":
            incoming = sum(source(section, number) for number in section.integers("layers"))
            outgoing = _share(section, incoming)
        elif section.kind in ("shortcut", "sam", "scale_channels"):
            other = source(section, section.integer("from"))
            outgoing = other if section.kind == "scale_channels" else previous
        channels.append((incoming, outgoing))
        previous = outgoing
    return channels


def _share(section: Section, channels: int) -> int:
    """Return the channels of one group."""
    groups = section.integer("groups", 1)
    if groups < 1 or channels % groups:
        raise section.error(f"groups={groups} does not divide {channels} channels")
    return channels // groups


def expected_weight_floats(sections: list[Section]) -> int:
    """Return how many float32 values the `.weights` file of this cfg holds after its header."""
    floats = 0
    for section, (incoming, filters) in zip(sections[1:], layer_channels(sections), strict=True):
        if section.kind == "convolutional":
            vectors = 4 if section.integer("batch_normalize", 0) else 1
            floats += filters * (vectors + _share(section, incoming) * section.integer("size", 1) ** 2)
    return floats


def check_weights(sections: list[Section], weights: str | Path) -> None:
    """Check that a `.weights` file holds exactly the floats that its cfg implies, and only finite numbers."""
    expected = expected_weight_floats(sections)
    require_file(Path(weights), "weights file", DetectorError)
    data = Path(weights).read_bytes()
    header = header_bytes(data[:12]) if len(data) >= 12 else 20
    if len(data) != header + 4 * expected:
        raise DetectorError(
            f"weights file {weights} holds {max(len(data) - header, 0) / 4:.10g} floats, the cfg needs {expected}. Was "
            "the copy cut off, or are these the weights of another network?"
        )
    if not np.isfinite(np.frombuffer(data, "<f4", offset=header)).all():
        raise DetectorError(f"weights file {weights} holds numbers that are NaN or infinite")


def header_bytes(start: bytes) -> int:
    """Return the length of the header that begins with these 12 bytes: 20, or 16 before version 0.2."""
    major, minor, _ = struct.unpack("<3i", start)
    return 20 if major * 10 + minor >= 2 else 16


def class_count(sections: list[Section]) -> int:
    """Return the number of classes of the detection layers."""
    counts = {section.integer("classes") for section in sections if section.kind in DETECTION_KINDS}
    if len(counts) != 1:
        raise DetectorError(f"the cfg's [yolo] or [region] sections must agree on classes; they have {sorted(counts)}")
    return counts.pop()


def read_names(path: str | Path) -> list[str]:
    """Return the class names of a `.names` file, one a line. Empty lines at the end do not count."""
    names = [line.strip() for line in read_text(path, "names file", DetectorError).rstrip().splitlines()]
    if not names or not all(names):
        raise DetectorError(f"names file {path} has an empty line: every line names one class")
    return names


def check_names(n_classes: int, names: list[str], path: str | Path) -> None:
    """Raise `DetectorError` if the class names are not as many as the network's classes. path: of the names."""
    if len(names) != n_classes:
        raise DetectorError(f"the network has {n_classes} classes, names file {path} has {len(names)}")


def corners(rows: np.ndarray) -> np.ndarray:
    """Return boxes `(n, 4)` [u_min, v_min, u_max, v_max] of rows that begin with cx, cy, w, h."""
    centre, half = rows[:, 0:2], rows[:, 2:4] / 2
    return np.concatenate([centre - half, centre + half], axis=1)


class Network:
    """A network of OpenCV that runs one blob at a time. It is pickled as its arguments."""

    def __init__(self, net: cv2.dnn.Net, files: str, input_size: tuple[int, int], *arguments: object) -> None:
        """Run the network once, so that a misfit is found now. files: their names, for messages."""
        self._net, self._files, self.input_size, self._arguments = net, files, input_size, arguments
        self._turn = threading.Lock()
        self.infer(np.zeros((1, 3, input_size[1], input_size[0]), dtype=np.float32))

    def __reduce__(self) -> tuple:
        return type(self), self._arguments

    def infer(self, blob: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return boxes `(n, 4)` in edge coordinates of the blob `(1, 3, H, W)`, RGB, 0 to 1; scores `(n, classes)`."""
        try:
            with self._turn:
                self._net.setInput(blob)
                # Copied, because the next run writes over what OpenCV gives.
                outputs = [np.array(out) for out in self._net.forward(self._net.getUnconnectedOutLayersNames())]
        except cv2.error as error:
            raise DetectorError(
                f"OpenCV cannot run {self._files} at an input of {blob.shape[3]} x {blob.shape[2]} ({error.err}). "
                "YOLOv4 takes multiples of 32"
            ) from error
        boxes, scores = self._decode(outputs)
        # A box may be infinitely wide, as an untrained network's are: it is cut at the image's edges.
        if np.isnan(boxes).any() or not np.isfinite(scores).all():
            raise DetectorError(f"the network {self._files} gives boxes or scores that are NaN: is its file damaged?")
        return boxes, scores


class DarknetNetwork(Network):
    """A loaded network of a `.cfg` and its `.weights`."""

    def __init__(self, cfg: str | Path, weights: str | Path, size: tuple[int, int] | None = None) -> None:
        """Check and load a network. size: (width, height) of the input in pixels instead of the cfg's."""
        cfg, weights = Path(cfg).absolute(), Path(weights).absolute()
        sections = read_cfg(cfg)
        try:
            self.n_classes = class_count(sections)
            given = sections[0].integer("width"), sections[0].integer("height")
            width, height = given if size is None else (int(size[0]), int(size[1]))
            if min(width, height) < 1 or width * height > MAX_INPUT_PIXELS:
                raise DetectorError(f"an input of 1 to {MAX_INPUT_PIXELS:,} pixels is expected; got {width} x {height}")
            check_weights(sections, weights)
            # OpenCV reads options that Darknet does not have: `thresh` (0.2 if absent) sets smaller scores to zero, and
            # `nms_threshold` (0.4) suppresses boxes inside one scale. Both would decide before this library's own do.
            sections[0].options.update(width=str(width), height=str(height))
            for section in sections:
                if section.kind in DETECTION_KINDS:
                    section.options.update(thresh="0", nms_threshold="0")
            text = np.frombuffer(render_cfg(sections).encode(), dtype=np.uint8)
            net = cv2.dnn.readNetFromDarknet(text, np.fromfile(weights, dtype=np.uint8))
        except (DetectorError, cv2.error) as error:
            raise DetectorError(f"cfg file {cfg}: {getattr(error, 'err', error)}") from None
        super().__init__(net, f"{cfg} with {weights}", (width, height), cfg, weights, size)

    def _decode(self, outputs: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
        """Return boxes and scores of rows [cx, cy, w, h as shares of the input, objectness, class scores times it]."""
        for output in outputs:
            if output.shape[1:] != (5 + self.n_classes,):  # OpenCV makes an output of what no later layer takes
                shape = output.shape
                raise DetectorError(
                    f"the network {self._files} has an output of shape {shape} that no [yolo] layer gives"
                )
        rows = np.concatenate(outputs)
        return corners(rows) * np.tile(self.input_size, 2), rows[:, 5:]
