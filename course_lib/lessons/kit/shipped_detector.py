"""The detector that comes with the course, with the score threshold that its training chose on validation rooms."""

from __future__ import annotations

import json
from pathlib import Path

from course_lib.paths import data_path
from course_lib.spherical_stereo.detection.detector import YoloDetector


def load_detector(folder: str | Path | None = None, **options) -> YoloDetector:
    """The detector of a folder with one .cfg, .weights and .names; None: the course's own, `data/detector`.

    Its score threshold is that of training.json in the folder, if there is one and none is given in `options`.
    Raises what `YoloDetector.load` raises.
    """
    folder = data_path("detector") if folder is None else Path(folder)
    chosen = folder / "training.json"
    if chosen.is_file():
        options = {"score_threshold": float(json.loads(chosen.read_text())["score_threshold"])} | options
    return YoloDetector.load(folder, **options)
