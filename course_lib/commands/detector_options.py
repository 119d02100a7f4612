"""The options that choose a command's detector, and the detector that they choose."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # imported where it is used, so that --help does not wait for OpenCV
    from course_lib.spherical_stereo.detection.detector import YoloDetector

STRIDE = 32  # pixels of the input that one cell of a YOLOv4's coarsest grid covers


def add_detector_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare --detector, --input-size and --score-threshold."""
    parser.add_argument(
        "--detector",
        type=Path,
        metavar="FOLDER",
        help="a detector of your own: one .cfg, .weights and .names (default: the course's, data/detector)",
    )
    parser.add_argument(
        "--input-size",
        type=int,
        nargs=2,
        metavar=("W", "H"),
        help="the network's input in pixels, multiples of 32, for a cfg made for other images: YOLOv4's own is square, "
        "and a panorama fills two fifths of it; 1280 512 fits one (default: the cfg's)",
    )
    parser.add_argument(
        "--score-threshold",
        type=float,
        metavar="T",
        help="leave out detections with a score below T, 0 to 1, for a detector whose scores mean something else "
        "(default: the one in training.json beside the weights, else 0.5)",
    )


def chosen_detector(arguments: argparse.Namespace) -> YoloDetector:
    """Load the detector that the options name. Raises `ValueError`, and what `YoloDetector.load` raises."""
    from course_lib.paths import data_path
    from course_lib.spherical_stereo.detection.detector import YoloDetector

    options: dict = {}
    if arguments.input_size is not None:
        width, height = arguments.input_size
        if min(width, height) < STRIDE or width % STRIDE or height % STRIDE:
            raise ValueError(f"--input-size must be two multiples of {STRIDE} above 0; got {width} {height}")
        options["input_size"] = (width, height)
    if arguments.score_threshold is not None:
        if not 0 <= arguments.score_threshold <= 1:
            raise ValueError(f"--score-threshold must be between 0 and 1; got {arguments.score_threshold}")
        options["score_threshold"] = arguments.score_threshold
    return YoloDetector.load(arguments.detector or data_path("detector"), **options)
