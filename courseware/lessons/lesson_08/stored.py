"""Stored results of the corridor experiment, `demo corridor --seed N --recording shipped`, read back.

data/corridor/results/ holds seed_N.json (the summary) and seed_N.csv (one row a frame) of every reporting seed.
"""

import json
from typing import NamedTuple

import numpy as np

from course_lib.depth_mcl.evaluation import PAPER_TABLE_1
from courseware.paths import data_path


class StoredRun(NamedTuple):
    """One seed of the experiment, all methods: the summary, and columns `(T,)` such as "proposed_nearest_m"."""

    seed: int
    summary: dict
    columns: np.ndarray

    def positions(self, method: str) -> np.ndarray:
        """Return the estimated positions `(T, 2)` [m] of a method, such as "proposed" or "fallon"."""
        return np.column_stack([self.columns[f"{method}_x_m"], self.columns[f"{method}_y_m"]])


def stored_runs() -> list[StoredRun]:
    """Return all stored seeds in their order."""
    runs = []
    for path in data_path("corridor/results").glob("seed_*.json"):
        summary = json.loads(path.read_text(encoding="utf-8"))
        columns = np.genfromtxt(path.with_suffix(".csv"), delimiter=",", names=True)
        runs.append(StoredRun(summary["seed"], summary, columns))
    return sorted(runs, key=lambda run: run.seed)


def over_seeds(runs: list[StoredRun], method: str, key: str) -> np.ndarray:
    """Return one number of the summary, such as "median_m", for every seed `(S,)`."""
    return np.array([run.summary["methods"][method][key] for run in runs])


def spread_over_seeds(runs: list[StoredRun], method: str, key: str) -> str:
    """Return a number's median over the seeds, its smallest and its largest value: "0.016 (0.014 to 0.017)"."""
    values = over_seeds(runs, method, key)
    return f"{np.median(values):.3f} ({values.min():.3f} to {values.max():.3f})"


def table_1(runs: list[StoredRun]) -> str:
    """Return the paper's table 1: its two rows, then ours and the Fallon-style ones, medians over the seeds."""
    lines = [
        f"{'':36} {'nearest point of the path':^29} {'same frame':>12}",
        f"{'':36} {'median [m]':>10} {'sigma [m]':>9} {'<= 0.30 m':>9} {'median [m]':>11}",
    ]
    for name, (median, sigma, within) in PAPER_TABLE_1.items():
        sigma_text = "n/a" if sigma is None else f"{sigma:.2f}"
        lines.append(f"{'paper: ' + name:36} {median:>10.2f} {sigma_text:>9} {within:>7.0f} % {'-':>11}")
    for method, row in runs[0].summary["methods"].items():
        keys = ("median_m", "sigma_m", "within_3sigma_percent", "median_timed_m")
        median, sigma, within, timed = (np.median(over_seeds(runs, method, key)) for key in keys)
        lines.append(f"{row['name']:36} {median:>10.2f} {sigma:>9.2f} {within:>7.0f} % {timed:>11.2f}")
    return "\n".join(lines)
