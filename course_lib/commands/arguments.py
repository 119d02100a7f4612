"""What several commands ask of their arguments, told before any work is done."""

from __future__ import annotations

import argparse
import math
import re
from pathlib import Path

from course_lib.output_folder import require_writable
from course_lib.writing import WriteError


def add_backend_argument(parser: argparse.ArgumentParser) -> None:
    """Declares `--backend` and `--exact`: how depth images are rendered (`DepthRenderer`)."""
    parser.add_argument(
        "--backend",
        choices=["raster", "vtk", "ray"],
        default="raster",
        help="z-buffer on the processors (default), OpenGL's z-buffer (for a graphics card), or ray casting",
    )
    parser.add_argument(
        "--exact",
        action="store_true",
        help="draw every triangle of the map; else a large one is drawn with fewer, within centimetres of it",
    )


def require_seed(seed: int) -> None:
    """Raises `ValueError` for a negative seed."""
    if seed < 0:
        raise ValueError(f"--seed must be 0 or more; got {seed}")


def require_positive(option: str, value: float, unit: str) -> None:
    """Raises `ValueError` for a value that is not positive and finite."""
    if not (math.isfinite(value) and value > 0):
        raise ValueError(f"{option} must be a positive number of {unit}; got {value:g}")


def parse_seeds(text: str) -> list[int]:
    """The seeds that "4", "1-20" or "1-5,8" name, each once, in their order. Raises `ValueError` for anything else."""
    seeds: list[int] = []
    for part in text.split(","):
        match = re.fullmatch(r"\s*(\d+)(?:-(\d+))?\s*", part)
        first, last = (int(match[1]), int(match[2] or match[1])) if match else (1, 0)
        if last < first:
            raise ValueError(f"--seeds must be numbers or ranges such as 1-20 or 1-5,8; got {text!r}")
        seeds += range(first, last + 1)
    return list(dict.fromkeys(seeds))


def parse_numbers(option: str, text: str) -> list[int]:
    """Whole numbers, at least 1, with commas. Raises `ValueError` for anything else."""
    try:
        numbers = [int(part) for part in text.split(",")]
    except ValueError:
        numbers = [0]
    if min(numbers) < 1:
        raise ValueError(f"{option} must be whole numbers, at least 1, with commas, such as 1,2,4,8; got {text!r}")
    return numbers


def require_output_folder(folder: Path) -> None:
    """Raises `ValueError` unless `folder` is a folder that can be written, or one can be made there."""
    if folder.exists() and not folder.is_dir():
        raise ValueError(f"--out {folder} is a file: give a folder")
    try:
        require_writable(folder)
    except WriteError as error:
        raise ValueError(f"--out {error}") from error
