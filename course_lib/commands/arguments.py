"""What several commands ask of their arguments, told before any work is done."""

from __future__ import annotations

import argparse
import math
import re
import warnings
from pathlib import Path

from course_lib.files import require_writable
from course_lib.processors import processors

MOST_PARTICLES = 1_000_000
"""5,000 times the paper's; chosen: a set of these takes 50 MB, and a thousand times as many no machine has room for."""
MOST_SEEDS = 100_000
"""Chosen: a month of the quickest experiment; a slip such as 1-1000000000 fills the memory before the first is run."""
PROCESSES_EACH, LEAST_PROCESSES = 4, 16
"""Processes a processor that may be asked for, and that may be asked for anywhere; chosen."""


def add_backend_argument(parser: argparse.ArgumentParser) -> None:
    """Declares `--backend` and `--exact`: how depth images are rendered (`DepthRenderer`)."""

    def chosen(name: str) -> str:
        from course_lib.rendering.renderer import chosen_backend

        return chosen_backend(name)  # results say what drew, not "auto"

    parser.add_argument(
        "--backend",
        choices=["auto", "vtk", "raster", "ray"],
        default="auto",
        type=chosen,
        help="OpenGL's z-buffer (vtk), a compiled z-buffer on the processors (raster), or ray casting (ray); default: "
        "vtk on a graphics card, else raster",
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


def require_count(option: str, value: int | None, most: int | None = None) -> None:
    """Raises `ValueError` for a number of things that is below 1, or above `most`; None stands for a default."""
    if value is not None and value < 1:
        raise ValueError(f"{option} must be at least 1; got {value}")
    if value is not None and most is not None and value > most:
        raise ValueError(f"{option} must be at most {most:,}; got {value:,}")


def require_processes(option: str, value: int | None) -> None:
    """Raises `ValueError` for less than one process, or for so many that this machine would stand still."""
    require_count(option, value, max(LEAST_PROCESSES, PROCESSES_EACH * processors()))


def warn_of_fewer(option: str, asked: int | None, there: int, where: str) -> None:
    """Warns where more was asked for than there is: all of it is taken, and who asked may have meant another one."""
    if asked is not None and asked > there:
        warnings.warn(f"{option} {asked}: {where} {there}, and all are taken", stacklevel=2)


def parse_seeds(text: str) -> list[int]:
    """The seeds that "4", "1-20" or "1-5,8" name, each once, in their order. Raises `ValueError` for anything else."""
    seeds: list[int] = []
    for part in text.split(","):
        match = re.fullmatch(r"\s*(\d+)(?:-(\d+))?\s*", part)
        first, last = (int(match[1]), int(match[2] or match[1])) if match else (1, 0)
        if last - first >= MOST_SEEDS:
            raise ValueError(f"--seeds must be at most {MOST_SEEDS:,} seeds; got {text!r}")
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


def require_output_folder(folder: Path, option: str = "--out") -> None:
    """Raises `ValueError` unless `folder` is a folder that can be written, or one can be made there."""
    if folder.exists() and not folder.is_dir():
        raise ValueError(f"{option} {folder} is a file: give a folder")
    try:
        require_writable(folder)
    except OSError as error:
        raise ValueError(f"{option} {folder} cannot be written to: {error.strerror}. Give another folder") from error
