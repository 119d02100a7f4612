"""A detector in an ONNX file, run by OpenCV. Exporters agree on the file, not on what comes out; three layouts
are read.

    "yolov5"   one output (1, n, 5 + classes): cx, cy, w, h in input pixels, objectness, class probabilities
               (also YOLOv7 and Scaled-YOLOv4 exports); score = objectness * class probability
    "yolov8"   one output (1, 4 + classes, n): cx, cy, w, h in input pixels, class scores; no objectness
    "yolov4"   two outputs: boxes (1, n, 1, 4) as x1, y1, x2, y2 in shares of the input, and class scores
               (1, n, classes) with the objectness in them, as PyTorch ports of YOLOv4 export them

The input is (1, 3, H, W), RGB, 0 to 1. Export with a fixed input size and without suppression inside.
"""

from pathlib import Path

import cv2
import numpy as np

from course_lib.child import ChildError, ChildStopped, run_apart
from course_lib.files import MEGABYTE, require_file
from course_lib.spherical_stereo.detection.darknet_cfg import DetectorError
from course_lib.spherical_stereo.detection.darknet_network import require_numbers
from course_lib.spherical_stereo.detection.shared_network import SharedNetwork

MEMORY = 1_500 * MEGABYTE
"""What a small network may take, of which most is for its intermediate results."""

LAYOUTS = ("yolov5", "yolov8", "yolov4")


def decode_onnx(
    outputs: list[np.ndarray], layout: str, n_classes: int, input_size: tuple[int, int]
) -> tuple[np.ndarray, np.ndarray]:
    """Boxes (n, 4) in edge coordinates of the input and scores (n, classes) from a network's outputs.

    layout: see the module. input_size: (width, height) in pixels. Raises DetectorError: an unknown layout, or outputs
    whose number or shapes do not fit it; the message has them. Source: paper 2, section 2.2.
    """
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
    columns = n_classes + (5 if layout == "yolov5" else 4)
    axis = 2 if layout == "yolov5" else 1
    if len(outputs) != 1 or outputs[0].ndim != 3 or outputs[0].shape[0] != 1 or outputs[0].shape[axis] != columns:
        expected = f"(1, n, {columns})" if layout == "yolov5" else f"(1, {columns}, n)"
        raise DetectorError(
            f"layout {layout} with {n_classes} names needs one output {expected}; the file gives {shapes}. "
            "Is it another layout, or are these the names of another network?"
        )
    rows = outputs[0][0] if layout == "yolov5" else outputs[0][0].T
    centre, half = rows[:, 0:2], rows[:, 2:4] / 2
    scores = rows[:, 4:5] * rows[:, 5:] if layout == "yolov5" else rows[:, 4:]
    return np.concatenate([centre - half, centre + half], axis=1), scores


# OpenCV's reader follows what a file says without looking: of 496 files with a changed byte four ended the process.
_PROBE = """
import sys
import cv2
import numpy as np
net = cv2.dnn.readNetFromONNX(sys.argv[1])
for image in (np.zeros((1, 3, {1}, {0}), np.float32), np.linspace(0, 1, 3 * {1} * {0}, dtype=np.float32)):
    net.setInput(image.reshape(1, 3, {1}, {0}))  # a black image and a ramp: an index may be made of what is seen
    net.forward(net.getUnconnectedOutLayersNames())
"""


def _require_no_crash(path: Path, input_size: tuple[int, int]) -> None:
    """Raises DetectorError where reading the file and running it once crashes, hangs or takes all memory elsewhere."""
    try:
        run_apart(_PROBE.format(*input_size), str(path.resolve()), MEMORY + 20 * path.stat().st_size)
    except ChildStopped:  # an error that OpenCV itself tells below
        return
    except ChildError as reason:
        raise DetectorError(
            f"ONNX file {path} cannot be used: reading and running it {reason}. Is it damaged?"
        ) from None


class OnnxNetwork(SharedNetwork):
    """A loaded network. Threads may share it, and processes."""

    def __init__(self, path: str | Path, layout: str, n_classes: int, input_size: tuple[int, int]) -> None:
        """Load a network and run it once, so that what does not fit is found now.

        input_size: (width, height) in pixels that it was exported for. Raises DetectorError: a missing or unreadable
        file, an input size that the file does not take, or what `decode_onnx` refuses. Source: paper 2, section 2.2.
        """
        path = Path(path)
        require_file(path, "ONNX file", DetectorError)
        self.input_size: tuple[int, int] = (int(input_size[0]), int(input_size[1]))
        _require_no_crash(path, self.input_size)
        self.n_classes = n_classes
        self._layout = layout
        self._told = str(path)
        self._path = path.absolute()
        super().__init__()
        try:
            self._decoded(np.zeros((1, 3, self.input_size[1], self.input_size[0]), dtype=np.float32))
        except cv2.error as error:
            width, height = self.input_size
            raise DetectorError(
                f"OpenCV cannot run {path} at an input of {width} x {height}: {error.err}. "
                "Give the input_size (width, height) that the file was exported for"
            ) from error

    def _opened(self) -> cv2.dnn.Net:
        require_file(self._path, "ONNX file", DetectorError)
        try:
            return cv2.dnn.readNetFromONNX(str(self._path))
        except cv2.error as error:
            raise DetectorError(f"OpenCV cannot read {self._told} as an ONNX network: {error.err}") from error

    def infer(self, blob: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Boxes (n, 4) in edge coordinates of the input, scores (n, classes), for a blob (1, 3, H, W), RGB, 0 to 1.

        Raises DetectorError for results that are NaN, or that do not fit the layout, and where OpenCV fails: what a
        file does with an image may depend on the image.
        """
        try:
            return self._decoded(blob)
        except cv2.error as error:
            raise DetectorError(f"OpenCV cannot run {self._told} on this image: {error.err}") from error

    def _decoded(self, blob: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """`infer`, with OpenCV's errors as they are."""
        boxes, scores = decode_onnx(self._results(blob), self._layout, self.n_classes, self.input_size)
        require_numbers(boxes, scores, self._told)
        return boxes, scores
