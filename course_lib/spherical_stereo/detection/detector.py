"""Objects in panoramas (paper 2, section 2.2): a YOLOv4-family network, the seam, and the colour of each object."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple, Protocol, runtime_checkable

import cv2
import numpy as np

from course_lib.files import is_given, read_json
from course_lib.spherical_stereo.detection import seam
from course_lib.spherical_stereo.detection.colour import coloured
from course_lib.spherical_stereo.detection.darknet import DarknetNetwork, DetectorError, check_names, read_names
from course_lib.spherical_stereo.detection.detected_object import Detection, DetectionError, canonical_label
from course_lib.spherical_stereo.detection.onnx_network import OnnxNetwork
from course_lib.spherical_stereo.panorama import View, open_view

MAX_CANDIDATES = 1000  # Boxes kept before suppression, the best by score: a bound on time if the threshold is very low.
PADDING_GREY = 127  # Grey level of the letterbox's padding. Darknet fills with 0.5.


@runtime_checkable
class Detector(Protocol):
    """What a localizer needs of a detector: `YoloDetector` is one, your own may be another."""

    def detect(self, image_bgr: np.ndarray) -> Sequence[Detection]:
        """Return the objects of a panorama, uint8 BGR `(H, 2 H, 3)`: `Detection(label, score, box)`, colour or not."""


def find_objects(view: View, detector: Detector) -> View:
    """Return the panorama with what a detector finds in it, in colour."""
    found = detector.detect(view.image)
    if not (isinstance(found, Sequence) and all(isinstance(one, Detection) for one in found)):
        raise DetectionError(f"detect must return a list of Detection(label, score, box); got {found!r}"[:300])
    return coloured(view.replace(detections=found))


class YoloDetector:
    """Objects in panoramas by a Darknet network of the YOLOv4 family (`from_onnx`: by an ONNX one). Loaded once."""

    def __init__(
        self,
        cfg: str | Path,
        weights: str | Path,
        names: str | Path,
        *,
        input_size: tuple[int, int] | None = None,
        **thresholds,
    ) -> None:
        """Check the three files against each other and load the network.

        input_size: (width, height) in pixels, multiples of 32, instead of the cfg's; (1280, 512) suits a panorama.
        thresholds: score_threshold (0.5); iou_threshold (0.45, Darknet's) for suppression within a class. Raises
        `DetectorError` for a file that is missing or does not fit, and a threshold outside [0, 1].
        Source: paper 2, section 2.2.
        """
        class_names = read_names(names)
        network = DarknetNetwork(cfg, weights, input_size)
        check_names(network.n_classes, class_names, names)
        self._set_up(network, class_names, **thresholds)

    @classmethod
    def from_onnx(
        cls, path: str | Path, names: str | Path, *, layout: str, input_size: tuple[int, int], **thresholds
    ) -> YoloDetector:
        """Return a detector from an ONNX file; layout "yolov5", "yolov8" or "yolov4" (`onnx_network`).

        thresholds: as in the constructor. Raises `DetectorError`. Source: paper 2, section 2.2.
        """
        class_names = read_names(names)
        detector = cls.__new__(cls)
        detector._set_up(OnnxNetwork(path, layout, len(class_names), input_size), class_names, **thresholds)
        return detector

    @classmethod
    def load(cls, folder: str | Path, **options) -> YoloDetector:
        """Return a detector from a folder with one `.cfg`, one `.weights` and one `.names`.

        options: as in the constructor. The score threshold is that of a `training.json` beside them, if there is one.
        """
        folder, paths = Path(folder), []
        for ending in (".cfg", ".weights", ".names"):
            found = sorted(folder.glob(f"*{ending}"))
            if len(found) != 1:
                listed = ", ".join(path.name for path in found) or "none"
                raise DetectorError(f"folder {folder} must hold exactly one {ending} file; found {listed}")
            paths += found
        report = folder / "training.json"
        if "score_threshold" not in options and is_given(report):
            trained = read_json(report, "training report", DetectorError)
            threshold = trained.get("score_threshold") if isinstance(trained, dict) else None
            if type(threshold) not in (int, float) or not 0 <= threshold <= 1:
                raise DetectorError(f"{report} must have a score_threshold between 0 and 1; got {threshold!r}")
            options["score_threshold"] = threshold
        return cls(*paths, **options)

    def _set_up(self, network, class_names, score_threshold: float = 0.5, iou_threshold: float = 0.45) -> None:
        for name, value in (("score_threshold", score_threshold), ("iou_threshold", iou_threshold)):
            if not 0 <= value <= 1:
                raise DetectorError(f"{name} must be between 0 and 1; got {value}")
        self.labels = sorted({canonical_label(name) for name in class_names})
        self.score_threshold, self.iou_threshold = float(score_threshold), float(iou_threshold)
        self._network = network
        self._label_of_class = np.array([self.labels.index(canonical_label(name)) for name in class_names])

    @property
    def input_size(self) -> tuple[int, int]:
        """Return (width, height) of the network's input, pixels."""
        return self._network.input_size

    def detect(self, image_bgr: np.ndarray) -> list[Detection]:
        """Return every object of a panorama once, the greatest score first.

        image_bgr: (H, 2 H, 3) uint8 of any size. Boxes have 0 <= u_min < W, and u_max > W across the seam.
        Raises `PanoramaError` as `open_view` does. Source: paper 2, section 2.2.
        """
        view = open_view(image_bgr)
        found = self.detect_in_plane(seam.extend_seam(view.image))
        boxes, scores, classes = seam.select_on_circle(*found, view.width, self.iou_threshold)
        rows = zip(classes, scores.tolist(), boxes.tolist(), strict=True)
        found = [Detection(self.labels[index], min(score, 1.0), tuple(box)) for index, score, box in rows]
        return list(coloured(view.replace(detections=found)).detections)

    def detect_in_plane(self, image_bgr: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return boxes (n, 4), scores and indices (n,) into `labels` in a flat image `(H, W, 3)`, the surest first."""
        padded, letterbox = letterbox_image(image_bgr, self._network.input_size)
        boxes, scores = self._network.infer(cv2.dnn.blobFromImage(padded, 1 / 255, swapRB=True))
        classes = scores.argmax(axis=1)
        scores = scores[np.arange(len(scores)), classes].astype(np.float64)
        # Boxes below the threshold are no detections of their own, but they vote on where the others are.
        best = np.flatnonzero(scores >= min(self.score_threshold, seam.VOTE_SCORE))
        best = best[np.argsort(-scores[best], kind="stable")][:MAX_CANDIDATES]
        limits = (image_bgr.shape[1], image_bgr.shape[0])
        boxes = np.clip(boxes_to_image(boxes[best], letterbox), 0, np.tile(limits, 2))
        scores, classes = scores[best], self._label_of_class[classes[best]]
        whole = (boxes[:, 2] - boxes[:, 0] >= 1) & (boxes[:, 3] - boxes[:, 1] >= 1)  # under a pixel: all in the padding
        boxes, scores, classes = boxes[whole], scores[whole], classes[whole]
        sure = np.flatnonzero(scores >= self.score_threshold)
        kept = sure[seam.suppress_in_image(boxes[sure], scores[sure], classes[sure], self.iou_threshold)]
        return seam.vote_on_boxes(boxes, scores, classes, kept), scores[kept], classes[kept]


class Letterbox(NamedTuple):
    """Where an image lies inside a network's input."""

    scale: np.ndarray  # (2,) input pixels per image pixel, across and down
    offset: tuple[int, int]  # of the image's corner, input pixels


def letterbox_image(image: np.ndarray, input_size: tuple[int, int]) -> tuple[np.ndarray, Letterbox]:
    """Return the image (H, W, 3) uint8 scaled and padded to `input_size` (width, height), and where it lies."""
    size = (image.shape[1], image.shape[0])
    scale = min(input_size[0] / size[0], input_size[1] / size[1])
    inner = tuple(max(1, min(round(pixels * scale), limit)) for pixels, limit in zip(size, input_size, strict=True))
    left, top = ((limit - pixels) // 2 for limit, pixels in zip(input_size, inner, strict=True))
    scales = np.array(inner) / np.array(size)
    if inner != size:
        image = cv2.resize(image, inner, interpolation=cv2.INTER_AREA if scales.max() < 1 else cv2.INTER_LINEAR)
    padded = np.full((input_size[1], input_size[0], 3), PADDING_GREY, dtype=np.uint8)
    padded[top : top + inner[1], left : left + inner[0]] = image
    return padded, Letterbox(scales, (left, top))


def boxes_to_image(boxes: np.ndarray, letterbox: Letterbox) -> np.ndarray:
    """Return boxes (..., 4) in edge coordinates of the image, u = (u' - offset) / scale, from those of the input."""
    return (np.asarray(boxes, dtype=np.float64) - np.tile(letterbox.offset, 2)) / np.tile(letterbox.scale, 2)
