"""Objects in a panorama (paper 2, 2.2): a YOLOv4-family network, the seam, and each object's hue and saturation.

The order: extend the panorama past its seam (`seam`), fit it into the network's input (`letterbox`), run the network
(`darknet_network`, `onnx_network`), suppress repeated boxes (`suppression`), count every object once on the circle
(`seam`), and measure its colour (`colour`).
"""

from __future__ import annotations

from pathlib import Path
from typing import Protocol

import cv2
import numpy as np

from course_lib.files import is_given, read_json
from course_lib.spherical_stereo.detection.colour import mean_hue_saturation
from course_lib.spherical_stereo.detection.darknet import DetectorError, read_names
from course_lib.spherical_stereo.detection.darknet_network import DarknetNetwork
from course_lib.spherical_stereo.detection.detected_object import Detection, DetectionError
from course_lib.spherical_stereo.detection.labels import canonical_label
from course_lib.spherical_stereo.detection.letterbox import boxes_to_image, letterbox_image
from course_lib.spherical_stereo.detection.onnx_network import OnnxNetwork
from course_lib.spherical_stereo.detection.seam import extend_seam, select_on_circle
from course_lib.spherical_stereo.detection.suppression import VOTE_SCORE, suppress_in_image, vote_on_boxes
from course_lib.spherical_stereo.panorama import View, open_view

__all__ = ["Detection", "DetectionError", "DetectorError", "YoloDetector"]

MOST_CANDIDATES = 1000
"""Boxes kept before suppression, the best by score: a bound on time when the threshold is very low."""


class Network(Protocol):
    """What `YoloDetector` needs of a network: `DarknetNetwork` and `OnnxNetwork` are two."""

    input_size: tuple[int, int]
    n_classes: int

    def infer(self, blob: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Boxes (n, 4) in input pixels and scores (n, classes) for a blob (1, 3, H, W), RGB, 0 to 1."""


def find_objects(view: View, detector) -> View:
    """The panorama with what a detector finds in it: section 2.2 of the walk.

    detector: a `YoloDetector`, or anything else with `detect(image_bgr)` giving detections. Source: paper 2, section
    2.2.
    """
    found = detector.find(view) if isinstance(detector, YoloDetector) else detector.detect(view.image)
    return view.having(detections=found)


class YoloDetector:
    """Objects in panoramas by a Darknet network of the YOLOv4 family (`from_onnx`: by an ONNX one). Loaded once."""

    def __init__(
        self,
        cfg: str | Path,
        weights: str | Path,
        names: str | Path,
        *,
        score_threshold: float = 0.5,
        iou_threshold: float = 0.45,
        input_size: tuple[int, int] | None = None,
        use_seam_extension: bool = True,
    ) -> None:
        """Check the three files against each other and load the network.

        score_threshold: detections below it are left out. iou_threshold: suppression within a class (Darknet's value).
        input_size: (width, height) in pixels, multiples of 32, instead of the cfg's: YOLOv4 as published has a square
        input, in which a panorama fills two fifths; (1280, 512) suits better. use_seam_extension=False shows what
        happens at the seam without it.
        Raises DetectorError: a file that is missing, malformed or does not fit, a threshold outside [0, 1].
        Source: paper 2, section 2.2.
        """
        class_names = read_names(names)
        network = DarknetNetwork(cfg, weights, input_size)
        if len(class_names) != network.n_classes:
            raise DetectorError(
                f"{cfg} has {network.n_classes} classes, {names} {len(class_names)} names: give that network's names"
            )
        self._set_up(network, class_names, score_threshold, iou_threshold, use_seam_extension)

    @classmethod
    def from_onnx(
        cls,
        path: str | Path,
        names: str | Path,
        *,
        layout: str,
        input_size: tuple[int, int],
        score_threshold: float = 0.5,
        iou_threshold: float = 0.45,
        use_seam_extension: bool = True,
    ) -> YoloDetector:
        """A detector from an ONNX file; layout "yolov5", "yolov8" or "yolov4" (`onnx_network`).

        Raises DetectorError. Source: paper 2, section 2.2.
        """
        class_names = read_names(names)
        detector = cls.__new__(cls)
        network = OnnxNetwork(path, layout, len(class_names), input_size)
        detector._set_up(network, class_names, score_threshold, iou_threshold, use_seam_extension)
        return detector

    @classmethod
    def load(cls, folder: str | Path, **options) -> YoloDetector:
        """A detector from a folder with one `.cfg`, one `.weights` and one `.names`; options as in the constructor.

        The score threshold is the one that training chose on its validation images, `score_threshold` of a
        `training.json` beside them; a network that came without gets the constructor's, unless `options` say another.
        Raises DetectorError: no folder, not exactly one of each, or a `training.json` without a threshold from 0 to 1;
        and the constructor's errors.
        """
        folder = Path(folder)
        if not folder.is_dir():
            raise DetectorError(f"there is no detector folder {folder}")
        paths = []
        for ending in (".cfg", ".weights", ".names"):
            found = sorted(path for path in folder.iterdir() if path.suffix == ending)
            if len(found) != 1:
                listed = ", ".join(path.name for path in found) or "none"
                raise DetectorError(f"{folder} must hold exactly one {ending} file; found {listed}")
            paths += found
        if "score_threshold" not in options:
            options |= _trained_options(folder / "training.json")
        return cls(*paths, **options)

    def _set_up(
        self,
        network: Network,
        class_names: list[str],
        score_threshold: float,
        iou_threshold: float,
        use_seam_extension: bool,
    ) -> None:
        for name, value in (("score_threshold", score_threshold), ("iou_threshold", iou_threshold)):
            if not 0 <= value <= 1:
                raise DetectorError(f"{name} must be between 0 and 1; got {value}")
        self.labels = sorted({canonical_label(name) for name in class_names})
        self.score_threshold, self.iou_threshold = float(score_threshold), float(iou_threshold)
        self.use_seam_extension = use_seam_extension
        self._network = network
        self._label_of_class = np.array([self.labels.index(canonical_label(name)) for name in class_names])

    @property
    def input_size(self) -> tuple[int, int]:
        """(width, height) of the network's input, pixels."""
        return self._network.input_size

    def detect(self, image_bgr: np.ndarray) -> list[Detection]:
        """Every object of a panorama once, the greatest score first.

        image_bgr: (H, 2 H, 3) uint8 of any size. Boxes have 0 <= u_min < W, and u_max > W across the seam.
        Raises PanoramaError as `open_view` does. Source: paper 2, section 2.2.
        """
        return self.find(open_view(image_bgr))

    def find(self, view: View) -> list[Detection]:
        """`detect` on a panorama that came through the door already. Source: paper 2, section 2.2."""
        image_bgr, width = view.image, view.width
        if self.use_seam_extension:
            boxes, scores, classes = self.detect_in_plane(extend_seam(image_bgr))
            boxes, scores, classes = select_on_circle(boxes, scores, classes, width, self.iou_threshold)
        else:
            boxes, scores, classes = self.detect_in_plane(image_bgr)
        detections = []
        for box, score, index in zip(boxes.tolist(), scores.tolist(), classes, strict=True):
            hue, saturation = mean_hue_saturation(image_bgr, tuple(box))
            detections.append(Detection(self.labels[index], min(score, 1.0), tuple(box), hue, saturation))
        return detections

    def detect_in_plane(self, image_bgr: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """What the network sees in an image taken as flat, repeated boxes suppressed, whatever its shape.

        image_bgr: (H, W, 3) uint8. Returns boxes (n, 4) in edge coordinates, clipped to the image, scores (n,), and
        indices (n,) into `labels`, the greatest score first. A box is the mean of those that it suppresses
        (`vote_on_boxes`). Source: paper 2, section 2.2.
        """
        padded, letterbox = letterbox_image(image_bgr, self._network.input_size)
        boxes, scores = self._network.infer(cv2.dnn.blobFromImage(padded, 1 / 255, swapRB=True))
        classes = scores.argmax(axis=1)
        scores = scores[np.arange(len(scores)), classes].astype(np.float64)
        # Boxes below the threshold are no detections of their own, but they vote on where the others are.
        best = np.flatnonzero(scores >= min(self.score_threshold, VOTE_SCORE))
        best = best[np.argsort(-scores[best], kind="stable")][:MOST_CANDIDATES]
        limits = (image_bgr.shape[1], image_bgr.shape[0])
        boxes = np.clip(boxes_to_image(boxes[best], letterbox), 0, np.tile(limits, 2))
        scores, classes = scores[best], self._label_of_class[classes[best]]
        whole = (boxes[:, 2] - boxes[:, 0] >= 1) & (boxes[:, 3] - boxes[:, 1] >= 1)  # under a pixel: all in the padding
        boxes, scores, classes = boxes[whole], scores[whole], classes[whole]
        sure = np.flatnonzero(scores >= self.score_threshold)
        kept = sure[suppress_in_image(boxes[sure], scores[sure], classes[sure], self.iou_threshold)]
        return vote_on_boxes(boxes, scores, classes, kept), scores[kept], classes[kept]


def _trained_options(path: Path) -> dict[str, float]:
    """The constructor's options that a training wrote down."""
    if not is_given(path):
        return {}
    expected = "must be JSON with a number score_threshold; mend or remove it, or give score_threshold yourself"
    try:
        report = read_json(path, "training report", DetectorError)
    except DetectorError as error:
        raise DetectorError(f"{path} {expected} ({error})") from None
    threshold = report.get("score_threshold") if isinstance(report, dict) else None
    if isinstance(threshold, bool) or not isinstance(threshold, (int, float)):
        raise DetectorError(f"{path} {expected} (found {str(threshold)[:40]!r})")
    if not 0 <= threshold <= 1:
        raise DetectorError(f"{path}: score_threshold must be between 0 and 1; got {threshold}")
    return {"score_threshold": float(threshold)}
