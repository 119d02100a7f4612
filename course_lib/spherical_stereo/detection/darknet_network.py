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
    input_size,
    read_cfg,
    render_cfg,
)


class DarknetNetwork:
    """A loaded network. `infer` takes one blob at a time, from one thread."""

    def __init__(self, cfg: str | Path, weights: str | Path, size: tuple[int, int] | None = None) -> None:
        """Check and load a network.

        size: (width, height) of the input in pixels instead of the cfg's; YOLOv4 takes any multiples of 32.
        Raises DetectorError: what `read_cfg`, `class_count` and `check_weights` refuse, or a size that does not suit.
        Source: paper 2, section 2.2.
        """
        sections = read_cfg(cfg)
        self.n_classes = class_count(sections)
        check_weights(sections, weights)
        self.input_size: tuple[int, int] = input_size(sections) if size is None else (int(size[0]), int(size[1]))
        text = render_cfg(for_opencv(sections, self.input_size))
        try:
            self._net = cv2.dnn.readNetFromDarknet(
                np.frombuffer(text.encode(), dtype=np.uint8), np.fromfile(weights, dtype=np.uint8)
            )
            self._outputs = self._net.getUnconnectedOutLayersNames()
            # One run now: sizes that do not fit are found here, and the first image is as fast as the second.
            self.infer(np.zeros((1, 3, self.input_size[1], self.input_size[0]), dtype=np.float32))
        except cv2.error as error:
            raise DetectorError(
                f"OpenCV cannot run {cfg} at an input of {self.input_size[0]} x {self.input_size[1]}: {error.err}. "
                "Width and height must be multiples of the network's stride (32 for YOLOv4)"
            ) from error

    def infer(self, blob: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Boxes (n, 4) in edge coordinates of the input and scores (n, classes) for a blob (1, 3, H, W), RGB, 0 to 1.

        OpenCV's rows are cx, cy, w, h as shares of the input, objectness, and the classes' scores, which are already
        multiplied by the objectness. Nothing is thresholded or suppressed. Source: paper 2, section 2.2.
        """
        self._net.setInput(blob)
        rows = np.concatenate([output.reshape(-1, 5 + self.n_classes) for output in self._net.forward(self._outputs)])
        centre, half = rows[:, 0:2], rows[:, 2:4] / 2
        boxes = np.concatenate([centre - half, centre + half], axis=1) * np.tile(self.input_size, 2)
        return boxes, rows[:, 5:]


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
