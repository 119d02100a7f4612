"""A detector in an ONNX file, run by OpenCV. Three layouts of its outputs are read.

    "yolov5"   one output (1, n, 5 + classes): cx, cy, w, h in input pixels, objectness, class probabilities
               (also YOLOv7 and Scaled-YOLOv4 exports); score = objectness * class probability
    "yolov8"   one output (1, 4 + classes, n): cx, cy, w, h in input pixels, class scores; no objectness
    "yolov4"   two outputs: boxes (1, n, 1, 4) as x1, y1, x2, y2 in shares of the input, and class scores
               (1, n, classes) with the objectness in them, as PyTorch ports of YOLOv4 export them

The input is (1, 3, H, W), RGB, 0 to 1. Export with a fixed input size and without suppression inside.
"""

import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np

from course_lib.files import require_file
from course_lib.spherical_stereo.detection.darknet import DetectorError, Network, corners

LAYOUTS = ("yolov5", "yolov8", "yolov4")
_PROBE = """
import sys, cv2, numpy
net = cv2.dnn.readNetFromONNX(sys.argv[1])
shape = (1, 3, int(sys.argv[3]), int(sys.argv[2]))
for image in (numpy.zeros(shape, "f4"), numpy.linspace(0, 1, numpy.prod(shape), dtype="f4").reshape(shape)):
    net.setInput(image)
    net.forward(net.getUnconnectedOutLayersNames())
"""


def decode_onnx(
    outputs: list[np.ndarray], layout: str, n_classes: int, input_size: tuple[int, int]
) -> tuple[np.ndarray, np.ndarray]:
    """Return boxes `(n, 4)` in edge coordinates of the input and scores `(n, classes)` from a network's outputs."""
    if layout not in LAYOUTS:
        raise DetectorError(f"layout {layout!r} is not known; known are {', '.join(LAYOUTS)}")
    shapes = [output.shape for output in outputs]
    if layout == "yolov4":
        boxes = [output for output in outputs if output.ndim == 4 and output.shape[2:] == (1, 4)]
        scores = [output for output in outputs if output.ndim == 3 and output.shape[2] == n_classes]
        if len(outputs) != 2 or not boxes or not scores or boxes[0].shape[1] != scores[0].shape[1]:
            raise DetectorError(
                f"layout yolov4 needs outputs (1, n, 1, 4) and (1, n, {n_classes}); the file gives {shapes}"
            )
        return boxes[0].reshape(-1, 4) * np.tile(input_size, 2), scores[0].reshape(-1, n_classes)
    has_objectness = layout == "yolov5"
    columns = n_classes + (5 if has_objectness else 4)
    is_table = len(outputs) == 1 and outputs[0].ndim == 3 and len(outputs[0]) == 1
    rows = outputs[0][0] if is_table else np.empty((0, 0))
    rows = rows if has_objectness else rows.T
    if rows.shape[1] != columns:
        raise DetectorError(
            f"layout {layout} with {n_classes} names needs {columns} numbers a box; the file gives {shapes}. Is it "
            "another layout, or are these the names of another network?"
        )
    return corners(rows), rows[:, 4:5] * rows[:, 5:] if has_objectness else rows[:, 4:]


class OnnxNetwork(Network):
    """A loaded network of an ONNX file."""

    def __init__(self, path: str | Path, layout: str, n_classes: int, input_size: tuple[int, int]) -> None:
        """Load a network and run it once. input_size: (width, height) in pixels that it was exported for."""
        path = Path(path).absolute()
        require_file(path, "ONNX file", DetectorError)
        size = (int(input_size[0]), int(input_size[1]))
        self.n_classes, self._layout = n_classes, layout
        # OpenCV's reader trusts the file. Of 496 files with one changed byte, four ended the process.
        words = [sys.executable, "-I", "-c", _PROBE, str(path), *map(str, size)]
        if subprocess.run(words, capture_output=True, check=False).returncode not in (0, 1):
            raise DetectorError(f"reading and running the ONNX file {path} ends the process. Is it damaged?")
        try:
            net = cv2.dnn.readNetFromONNX(str(path))
        except cv2.error as error:
            raise DetectorError(f"OpenCV cannot read {path} as an ONNX network: {error.err}") from error
        super().__init__(net, str(path), size, path, layout, n_classes, size)

    def _decode(self, outputs: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
        return decode_onnx(outputs, self._layout, self.n_classes, self.input_size)
