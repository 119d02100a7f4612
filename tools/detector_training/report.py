"""What a training reached: the finished detector, run by OpenCV as the method runs it, on the validation images."""

from __future__ import annotations

import json
import platform
from dataclasses import asdict
from hashlib import sha256
from pathlib import Path

import cv2
import numpy as np
import torch
from tqdm import tqdm

from course_lib.experiments.detection_scores import Boxes
from course_lib.files import atomic_write
from course_lib.spherical_stereo.detection.darknet import read_names
from course_lib.spherical_stereo.detection.detector import YoloDetector
from tools.detector_training.images import LabelledPanorama, PanoramaFolders
from tools.detector_training.train import TrainingPlan, TrainingResult
from tools.detector_training.validation import LEAST_SCORE, Validation, validate

# Width of the recorded panoramas; the detector sees them as they are, not scaled as the training keeps them.
PANORAMA_WIDTH = 1280


def measure_detector(cfg: Path, weights: Path, names_file: Path, images: list[Path]) -> Validation:
    """Precision and recall of the detector over all validation images, at the threshold with the best F1 there.

    Raises what `PanoramaFolders`, `YoloDetector` and `validate` raise.
    """
    names = read_names(names_file)
    detector = YoloDetector(cfg, weights, names_file, score_threshold=LEAST_SCORE)

    def detect(panorama: LabelledPanorama) -> Boxes:
        found = detector.detect(panorama.image)
        boxes = np.array([item.box for item in found], dtype=np.float64).reshape(-1, 4)
        return Boxes([item.label for item in found], boxes, np.array([item.score for item in found]))

    folder = PanoramaFolders(images, names, PANORAMA_WIDTH)
    panoramas = (folder[index] for index in range(len(folder)))
    return validate(detect, tqdm(panoramas, total=len(folder), desc="validation", unit="image", disable=None), names)


def write_report(
    path: Path,
    plan: TrainingPlan,
    result: TrainingResult,
    validation: Validation,
    initial_weights: Path | None = None,
) -> Path:
    """Writes the numbers, the seed and the versions as JSON; returns the path.

    initial_weights: the file that the training started from, of which the SHA-256 sum is written (None: random).
    """
    content = {
        "version": 1,
        "score_threshold": round(validation.threshold, 3),
        "validation": {**asdict(validation), "by_class": {k: list(v) for k, v in validation.by_class.items()}},
        "plan": asdict(plan),
        "started_from_sha256": sha256(initial_weights.read_bytes()).hexdigest() if initial_weights else None,
        "position": asdict(result.position),
        "images_per_second": round(result.images_per_second, 2),
        "versions": {
            "python": platform.python_version(),
            "torch": torch.__version__,
            "opencv": cv2.__version__,
            "numpy": np.__version__,
        },
    }
    atomic_write(path, json.dumps(content, indent=1) + "\n")
    return path
