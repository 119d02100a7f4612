"""A Darknet detector of the YOLOv4 family, run by OpenCV.

OpenCV reads two options of a `[yolo]` layer that Darknet does not have: `thresh` (0.2 when absent) sets smaller scores
to zero, and `nms_threshold` (0.4 when absent) suppresses boxes inside one scale. Both would decide, unseen, before this
library's own thresholds do. So the cfg is checked, both are switched off in it, and it is handed over as text.
"""

from pathlib import Path

import cv2
import numpy as np

from course_lib.spherical_stereo.detection.darknet import (
    DETECTION_KINDS,
    DetectorError,
    Section,
    check_weights,
    class_count,
    expected_weight_floats,
    header_bytes,
    input_size,
    read_cfg,
    render_cfg,
)
from course_lib.spherical_stereo.detection.shared_network import SharedNetwork


class DarknetNetwork(SharedNetwork):
    """A loaded network. Threads may share it, and processes."""

    def __init__(self, cfg: str | Path, weights: str | Path, size: tuple[int, int] | None = None) -> None:
        """Check and load a network.

        size: (width, height) of the input in pixels instead of the cfg's; YOLOv4 takes any multiples of 32.
        Raises DetectorError: what `read_cfg`, `class_count` and `check_weights` refuse, weights that are not
        finite, results that are NaN, or a size that does not suit.
        Source: paper 2, section 2.2.
        """
        sections = read_cfg(cfg)
        try:
            self.n_classes = class_count(sections)
            given = input_size(sections)
            expected_weight_floats(sections)
        except DetectorError as error:
            raise DetectorError(f"cfg file {cfg}: {error}") from None
        self.input_size: tuple[int, int] = given if size is None else (int(size[0]), int(size[1]))
        self._cfg, self._weights = Path(cfg).absolute(), Path(weights).absolute()
        self._told = f"{cfg} with {weights}"
        self._text = render_cfg(for_opencv(sections, self.input_size))
        try:
            super().__init__()
            # One run now: sizes that do not fit are found here, and the first image is as fast as the second.
            self._decoded(np.zeros((1, 3, self.input_size[1], self.input_size[0]), dtype=np.float32))
        except cv2.error as error:
            width, height = self.input_size
            raise DetectorError(
                f"OpenCV cannot run {self._told} at an input of {width} x {height}: {error.err}. "
                "Width and height must be multiples of the network's stride (32 for YOLOv4)"
            ) from error

    def _opened(self) -> cv2.dnn.Net:
        check_weights(self._cfg, self._weights)
        require_finite_weights(self._weights)
        return cv2.dnn.readNetFromDarknet(
            np.frombuffer(self._text.encode(), dtype=np.uint8), np.fromfile(self._weights, dtype=np.uint8)
        )

    def infer(self, blob: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Boxes (n, 4) in edge coordinates of the input and scores (n, classes) for a blob (1, 3, H, W), RGB, 0 to 1.

        OpenCV's rows are cx, cy, w, h as shares of the input, objectness, and the classes' scores, which are already
        multiplied by the objectness. Nothing is thresholded or suppressed. Raises DetectorError for results that are
        NaN, or of a layer that detects nothing, and where OpenCV fails. Source: paper 2, section 2.2.
        """
        try:
            return self._decoded(blob)
        except cv2.error as error:
            raise DetectorError(f"OpenCV cannot run {self._told} on this image: {error.err}") from error

    def _decoded(self, blob: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """`infer`, with OpenCV's errors as they are."""
        outputs = self._results(blob)
        for output in outputs:
            if output.shape[1:] != (5 + self.n_classes,):  # what no later layer takes is an output to OpenCV
                raise DetectorError(
                    f"the network {self._told} has an output of shape {output.shape} that no [yolo] layer gives; "
                    f"expected (n, {5 + self.n_classes}). Does a [route] pass over a layer?"
                )
        rows = np.concatenate(outputs)
        centre, half = rows[:, 0:2], rows[:, 2:4] / 2
        boxes = np.concatenate([centre - half, centre + half], axis=1) * np.tile(self.input_size, 2)
        require_numbers(boxes, rows[:, 5:], self._told)
        return boxes, rows[:, 5:]


def require_numbers(boxes: np.ndarray, scores: np.ndarray, told: str) -> None:
    """Raises DetectorError where a network, `told` by its files, gives boxes or scores that are no numbers.

    A box may be infinitely wide, as an untrained network's are: it is cut at the image's edges as any other.
    """
    if np.isnan(boxes).any() or not np.isfinite(scores).all():
        raise DetectorError(f"the network {told} gives boxes or scores that are NaN: are its numbers damaged?")


def require_finite_weights(weights: str | Path) -> None:
    """Raises DetectorError for a `.weights` file with NaN or infinite numbers in it; its length is right already."""
    with Path(weights).open("rb") as file:
        start = header_bytes(file.read(12))
    floats = np.memmap(weights, dtype="<f4", mode="r", offset=start)
    bad = int(len(floats) - np.isfinite(floats).sum())
    if bad:
        raise DetectorError(f"weights file {weights}: {bad} of its {len(floats)} numbers are NaN or infinite")


def for_opencv(sections: list[Section], size: tuple[int, int]) -> list[Section]:
    """The sections with the input size set and OpenCV's own thresholds in the detection layers switched off."""
    changed = []
    for section in sections:
        options = dict(section.options)
        if section is sections[0]:
            options |= {"width": str(size[0]), "height": str(size[1]), "channels": options.get("channels", "3")}
        elif section.kind in DETECTION_KINDS:
            options |= {"thresh": "0", "nms_threshold": "0"}
        changed.append(Section(section.kind, options, section.line))
    return changed
