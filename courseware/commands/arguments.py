"""Options that several commands share, and checks of their values before any work is done."""

import argparse
import math
import re
import warnings
from pathlib import Path

from course_lib.files import require_writable

MAX_PARTICLES = 1_000_000  # 5,000 times the paper's; chosen: a set of these takes 50 MB
STRIDE = 32  # pixels of the input that one cell of a YOLOv4's coarsest grid covers
MAX_SEEDS = 100_000  # chosen: a month of the quickest experiment


def add_number(parser: argparse.ArgumentParser, option: str, told: str, default: int | None = None) -> None:
    parser.add_argument(option, type=int, default=default, metavar="N", help=told)


def add_folder(parser: argparse.ArgumentParser, option: str, told: str, default: Path | None = None) -> None:
    parser.add_argument(option, type=Path, default=default, metavar="FOLDER", help=told)


def add_text(parser: argparse.ArgumentParser, option: str, metavar: str, told: str, default: str | None = None) -> None:
    parser.add_argument(option, default=default, metavar=metavar, help=told)


def add_flag(parser: argparse.ArgumentParser, option: str, told: str, **more: str) -> None:
    parser.add_argument(option, action="store_true", help=told, **more)


def add_results(parser: argparse.ArgumentParser, told: str, default: Path | None = None, text: str = "table") -> None:
    """Declare --out and --json, which end the options of a command that computes."""
    add_folder(parser, "--out", told, default)
    add_flag(parser, "--json", f"print one JSON object instead of the {text}")


def add_mesh_recording(parser: argparse.ArgumentParser, sequence: str) -> None:
    """Declare --map, a mesh, and --sequence, a depth recording."""
    told = "mesh in metres (PLY, OBJ, STL, GLB)"
    parser.add_argument("--map", required=True, type=Path, metavar="MESH", help=told)
    parser.add_argument("--sequence", required=True, type=Path, metavar="FOLDER", help=sequence)


def add_semantic_map(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--map", required=True, type=Path, metavar="MAP", help="semantic map, .json or .csv")


def add_backend_argument(parser: argparse.ArgumentParser) -> None:
    """Declare --backend and --exact: how depth images are rendered (`DepthRenderer`)."""

    def chosen(name: str) -> str:
        from course_lib.rendering.renderer import chosen_backend

        return chosen_backend(name)  # results say what drew, not "auto"

    told = "OpenGL's z-buffer (vtk), a compiled z-buffer on the processors (raster), or ray casting (ray); default: "
    told += "vtk on a graphics card, else raster"
    choices = ["auto", "vtk", "raster", "ray"]
    parser.add_argument("--backend", choices=choices, default="auto", type=chosen, help=told)
    told = "draw every triangle of the map; else a large one is drawn with fewer, within centimetres of it"
    add_flag(parser, "--exact", told)


def add_detector_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare --detector, --input-size and --score-threshold."""
    told = "a detector of your own: one .cfg, .weights and .names (default: the course's, data/detector)"
    add_folder(parser, "--detector", told)
    told = "the network's input in pixels, multiples of 32, for a cfg made for other images: YOLOv4's own is square, "
    told += "and a panorama fills two fifths of it; 1280 512 fits one (default: the cfg's)"
    parser.add_argument("--input-size", type=int, nargs=2, metavar=("W", "H"), help=told)
    told = "leave out detections with a score below T, 0 to 1, for a detector whose scores mean something else "
    told += "(default: the one in training.json beside the weights, else 0.5)"
    parser.add_argument("--score-threshold", type=float, metavar="T", help=told)


def chosen_detector(arguments: argparse.Namespace):
    """Load the `YoloDetector` that the options name. Raises `ValueError`, and what `YoloDetector.load` raises."""
    from course_lib.spherical_stereo.detection.detector import YoloDetector
    from courseware.paths import data_path

    options: dict = {}
    if arguments.input_size is not None:
        width, height = options["input_size"] = tuple(arguments.input_size)
        if min(width, height) < STRIDE or width % STRIDE or height % STRIDE:
            raise ValueError(f"--input-size must be two multiples of {STRIDE} above 0; got {width} {height}")
    if arguments.score_threshold is not None:
        options["score_threshold"] = arguments.score_threshold
        if not 0 <= arguments.score_threshold <= 1:
            raise ValueError(f"--score-threshold must be between 0 and 1; got {arguments.score_threshold}")
    return YoloDetector.load(arguments.detector or data_path("detector"), **options)


def check_options(arguments: argparse.Namespace) -> None:
    """Raise `ValueError` for values of --seed, --particles, --frames and the like, and --out, that cannot be."""
    given = vars(arguments)
    if given.get("seed") is not None:
        require_seed(given["seed"])
    for option in ("frames", "poses", "places", "draws"):
        require_count(f"--{option}", given.get(option))
    require_count("--particles", given.get("particles"), MAX_PARTICLES)
    if given.get("out"):
        require_output_folder(given["out"])


def require_seed(seed: int) -> None:
    if seed < 0:
        raise ValueError(f"--seed must be 0 or more; got {seed}")


def require_positive(option: str, value: float, unit: str) -> None:
    """Raise `ValueError` unless a value is positive and finite."""
    if not (math.isfinite(value) and value > 0):
        raise ValueError(f"{option} must be a positive number of {unit}; got {value:g}")


def require_count(option: str, value: int | None, limit: int | None = None) -> None:
    """Raise `ValueError` for a number of things below 1, or above `limit`; None stands for a default."""
    value = 1 if value is None else value
    if value < 1:
        raise ValueError(f"{option} must be at least 1; got {value}")
    if limit is not None and value > limit:
        raise ValueError(f"{option} must be at most {limit:,}; got {value:,}")


def require_processes(option: str, value: int | None) -> None:
    """Raise `ValueError` for less than one process, or for so many that this machine would stand still."""
    from joblib import cpu_count

    require_count(option, value, max(16, 4 * cpu_count()))


def warn_of_fewer(option: str, asked: int | None, there: int, where: str) -> None:
    """Warn where more was asked for than there is: all of it is taken."""
    if asked is not None and asked > there:
        warnings.warn(f"{option} {asked}: {where} {there}, and all are taken", stacklevel=2)


def parse_seeds(text: str) -> list[int]:
    """Return the seeds that "4", "1-20" or "1-5,8" name, each once, in order. Raises `ValueError` for other text."""
    seeds: list[int] = []
    for part in text.split(","):
        match = re.fullmatch(r"\s*(\d+)(?:-(\d+))?\s*", part)
        first, last = (int(match[1]), int(match[2] or match[1])) if match else (1, 0)
        if last - first >= MAX_SEEDS:
            raise ValueError(f"--seeds must be at most {MAX_SEEDS:,} seeds; got {text!r}")
        if last < first:
            raise ValueError(f"--seeds must be numbers or ranges such as 1-20 or 1-5,8; got {text!r}")
        seeds += range(first, last + 1)
    return list(dict.fromkeys(seeds))


def parse_numbers(option: str, text: str) -> list[int]:
    """Return whole numbers, at least 1, that stand between commas. Raises `ValueError` for anything else."""
    try:
        numbers = [int(part) for part in text.split(",")]
    except ValueError:
        numbers = [0]
    if min(numbers) < 1:
        raise ValueError(f"{option} must be whole numbers, at least 1, with commas, such as 1,2,4,8; got {text!r}")
    return numbers


def require_output_folder(folder: Path, option: str = "--out") -> None:
    """Raise `ValueError` unless `folder` is a folder that can be written, or one can be made there."""
    if folder.exists() and not folder.is_dir():
        raise ValueError(f"{option} {folder} is a file: give a folder")
    try:
        require_writable(folder)
    except OSError as error:
        raise ValueError(f"{option} {folder} cannot be written to: {error.strerror}. Give another folder") from error
