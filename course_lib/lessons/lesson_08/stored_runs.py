"""Stored results of the corridor experiment, `demo corridor --seed N --recording shipped`, read back for lessons.

data/corridor/results/ holds seed_N.json (the summary) and seed_N.csv (one row a frame) of every reporting seed.
"""

import csv
import json
import re
from pathlib import Path
from typing import NamedTuple

import numpy as np

from course_lib.depth_mcl.evaluation import PAPER_TABLE_1
from course_lib.paths import data_path


class StoredRun(NamedTuple):
    """One seed of the experiment, all methods."""

    seed: int
    summary: dict
    columns: dict[str, np.ndarray]
    """Column name, such as "proposed_nearest_m", -> `(T,)`."""

    def positions(self, method: str) -> np.ndarray:
        """Estimated positions `(T, 2)` [m] of a method, such as "proposed" or "fallon"."""
        return np.column_stack([self.columns[f"{method}_x_m"], self.columns[f"{method}_y_m"]])


def stored_runs(folder: Path | None = None) -> list[StoredRun]:
    """All seeds found in `folder` (default: data/corridor/results), in order of their seeds.

    Raises `FileNotFoundError` where there is none, `ValueError` for seeds of different length or particle number.
    """
    folder = data_path("corridor/results") if folder is None else folder
    paths = [path for path in Path(folder).glob("seed_*.json") if re.fullmatch(r"seed_\d+", path.stem)]
    if not paths:
        raise FileNotFoundError(
            f"no seed_N.json in {folder}: make them with `python3 course.py demo corridor --seed N --recording shipped`"
        )
    runs = sorted((_read(path) for path in paths), key=lambda run: run.seed)
    sizes = {(run.summary["frames"], run.summary["n_particles"]) for run in runs}
    if len(sizes) > 1:
        raise ValueError(f"the seeds in {folder} differ in (frames, particles): {sorted(sizes)}; make them alike")
    return runs


def _read(path: Path) -> StoredRun:
    summary = json.loads(path.read_text(encoding="utf-8"))
    with path.with_suffix(".csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    columns = {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}
    return StoredRun(summary["seed"], summary, columns)


def over_seeds(runs: list[StoredRun], method: str, key: str) -> np.ndarray:
    """One number of the summary, such as "median_m", for every seed `(S,)`."""
    return np.array([run.summary["methods"][method][key] for run in runs])


def table_1(runs: list[StoredRun]) -> str:
    """The paper's table 1: its two rows, then ours and the Fallon-style ones, each the median over the seeds."""
    lines = [
        f"{'':36} {'nearest point of the path':^29} {'same frame':>12}",
        f"{'':36} {'median [m]':>10} {'sigma [m]':>9} {'<= 0.30 m':>9} {'median [m]':>11}",
    ]
    for name, (median, sigma, within) in PAPER_TABLE_1.items():
        sigma_text = "n/a" if sigma is None else f"{sigma:.2f}"
        lines.append(f"{'paper: ' + name:36} {median:>10.2f} {sigma_text:>9} {within:>7.0f} % {'-':>11}")
    for method, row in runs[0].summary["methods"].items():
        keys = ("median_m", "sigma_m", "within_3sigma_percent", "median_timed_m")
        median, sigma, within, timed = (float(np.median(over_seeds(runs, method, key))) for key in keys)
        lines.append(f"{row['name']:36} {median:>10.2f} {sigma:>9.2f} {within:>7.0f} % {timed:>11.2f}")
    return "\n".join(lines)


def spread_over_seeds(runs: list[StoredRun], method: str, key: str, digits: int = 3) -> str:
    """A number of the summary as its median over the seeds, least and greatest: "0.016 (0.014 to 0.017)"."""
    values = over_seeds(runs, method, key)
    return f"{np.median(values):.{digits}f} ({values.min():.{digits}f} to {values.max():.{digits}f})"


def neighbours_correlation(values: np.ndarray) -> float:
    """How alike successive values `(T,)` of a series are: their correlation at a distance of one, -1 to 1."""
    return float(np.corrcoef(values[:-1], values[1:])[0, 1])
