"""Stored results of the room experiment: what `demo room --seed N` wrote, read back for lessons.

data/room/results/ holds seed_N.json (the summary: tables 3 to 5) and seed_N.csv (one row a pose) of every seed.
"""

import csv
import json
import re
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from course_lib.experiments.room_evaluation import CORRECT, PAPER_TABLE_3, PAPER_TABLE_4, PAPER_TABLE_5
from course_lib.paths import data_path

METHODS = {"images": "greedy", "exact_boxes": "greedy_exact_boxes"}
"""Source of the detections -> its key in a summary."""
NAMES = {"images": "ours, from images", "exact_boxes": "ours, exact boxes"}
RATES = ("correct_percent", "incorrect_percent", "unable_percent")
ERRORS = ("mean_dx_m", "mean_dy_m", "mean_dtheta_deg", "std_dx_m", "std_dy_m", "std_dtheta_deg")
_PAPER_ERRORS = {1: PAPER_TABLE_3, 2: PAPER_TABLE_4}


class StoredRoom(NamedTuple):
    """One seed of the experiment: both heights, from images and from exact boxes."""

    seed: int
    summary: dict
    rows: list[dict]
    """One a pose: experiment, source, place, outcome, used_pairs (text, as in the file) and more."""

    def outcomes(self, experiment: int, source: str) -> dict[str, str]:
        """Name of the pose, such as "06_a" -> "correct", "incorrect" or "unable"."""
        wanted = (f"experiment_{experiment}", source)
        return {row["place"]: row["outcome"] for row in self.rows if (row["experiment"], row["source"]) == wanted}


def stored_rooms(folder: Path | None = None) -> list[StoredRoom]:
    """All seeds found in `folder` (default: data/room/results), in order. Raises `FileNotFoundError` for none."""
    folder = data_path("room/results") if folder is None else Path(folder)
    paths = [path for path in folder.glob("seed_*.json") if re.fullmatch(r"seed_\d+", path.stem)]
    if not paths:
        raise FileNotFoundError(f"no seed_N.json in {folder}: `python3 course.py demo room --seed N --out X` makes one")
    return sorted((_read(path) for path in paths), key=lambda run: run.seed)


def _read(path: Path) -> StoredRoom:
    summary = json.loads(path.read_text(encoding="utf-8"))
    with path.with_suffix(".csv").open(newline="", encoding="utf-8") as file:
        return StoredRoom(int(path.stem.removeprefix("seed_")), summary, list(csv.DictReader(file)))


def rates(runs: Sequence[StoredRoom], experiment: int, source: str) -> np.ndarray:
    """Correct, incorrect and unable of every seed, percent `(S, 3)`."""
    found = [run.summary[f"experiment_{experiment}"][METHODS[source]] for run in runs]
    return np.array([[one[key] for key in RATES] for one in found])


class TwoHeights(NamedTuple):
    """The same poses with the lower rig (experiment 1) and the higher one (experiment 2), over all seeds."""

    poses: int
    lower: int
    """Correct with the lower rig."""
    higher: int
    lost: int
    """Correct with the lower rig alone."""
    gained: int
    """Correct with the higher rig alone."""


def two_heights(runs: Sequence[StoredRoom], source: str) -> TwoHeights:
    """How many poses are correct at either height, and how many change."""
    correct = np.array(
        [
            [found == CORRECT for found in (run.outcomes(1, source)[place], run.outcomes(2, source)[place])]
            for run in runs
            for place in run.outcomes(1, source)
        ]
    )
    lower, higher = correct.T
    lost, gained = int((lower & ~higher).sum()), int((higher & ~lower).sum())
    return TwoHeights(len(correct), int(lower.sum()), int(higher.sum()), lost, gained)


def errors(runs: Sequence[StoredRoom], experiment: int, source: str, kind: str) -> np.ndarray:
    """A row of table 3 or 4 `(6,)`: the median over the seeds that have such poses; NaN where none has."""
    found = [run.summary[f"experiment_{experiment}"][METHODS[source]][kind] for run in runs]
    values = [[one[key] for key in ERRORS] for one in found if one["n"]]
    return np.median(values, axis=0) if values else np.full(len(ERRORS), np.nan)


def used_pairs(runs: Sequence[StoredRoom], source: str) -> np.ndarray:
    """How many pairs each pose of every seed and both experiments used `(n,)`."""
    return np.array([int(row["used_pairs"]) for run in runs for row in run.rows if row["source"] == source])


def table_5(runs: Sequence[StoredRoom]) -> str:
    """The paper's table 5 and ours: percent of the poses, the median over the seeds and their range."""
    lines = [f"{'% of the poses':36} {'correct':>14} {'incorrect':>14} {'unable':>14}"]
    for experiment in (1, 2):
        paper = "".join(f"{PAPER_TABLE_5[experiment][key]:>15.0f}" for key in RATES)
        lines.append(f"{f'experiment {experiment}, paper':36}{paper}")
        for source, name in NAMES.items():
            found = rates(runs, experiment, source)
            cells = [f"{np.median(v):.0f} ({v.min():.0f}-{v.max():.0f})" for v in found.T]
            lines.append(f"{f'experiment {experiment}, {name}':36}" + "".join(f"{cell:>15}" for cell in cells))
    return "\n".join(lines)


def table_3_or_4(runs: Sequence[StoredRoom], experiment: int) -> str:
    """Table 3 (experiment 1) or 4 (experiment 2): the paper's rows, and ours as medians over the seeds."""
    lines = [
        f"{'':31}{'mean dx':>8} {'mean dy':>8} {'mean dtheta':>12} {'std x':>7} {'std y':>7} {'std theta':>10}",
        f"{'':31}{'[m]':>8} {'[m]':>8} {'[deg]':>12} {'[m]':>7} {'[m]':>7} {'[deg]':>10}",
    ]
    for kind in ("all", "correct", "incorrect"):
        paper = [_PAPER_ERRORS[experiment][kind][key] for key in ERRORS]
        lines.append(_error_line(f"paper: {kind}", paper))
        lines += [
            _error_line(f"{name}: {kind}", errors(runs, experiment, source, kind)) for source, name in NAMES.items()
        ]
    return "\n".join(lines)


def _error_line(name: str, values: Sequence[float]) -> str:
    if not np.isfinite(values).all():
        return f"{name:31}{'no such pose':>14}"
    dx, dy, dtheta, sx, sy, stheta = values
    return f"{name:31}{dx:8.2f} {dy:8.2f} {dtheta:12.1f} {sx:7.2f} {sy:7.2f} {stheta:10.1f}"
