"""Table 1 over recordings: a seed makes one of its own, in the building of the map, and every method runs on it.

A second recording of each seed is less kind: calibration and mount are wrong by what is usual, lens distortion is left
over, and a person pushes the wagon. The filter is told the nominal values both times.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.stats import quantile_test

from course_lib.depth_mcl.evaluation import PositionError
from course_lib.depth_mcl.sequence import DepthSequence, read_sequence
from course_lib.experiments.corridor import METHODS, path_errors, run_method
from course_lib.experiments.recordings import Run
from course_lib.files import temporary_folder
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.scene_map import SceneMap
from course_lib.simulation.corridor.seeded_recording import HARDSHIPS, Hardship, building_of_data, record_seed

# Methods of table 1 that also run on the less kind recording: the paper's, and the comparison as it was published.
METHODS_BY_HAND = ("proposed", "fallon")
BY_HAND = "_by_hand"
"""Ends the names of their rows."""
# The numbers of a row that are told over seeds.
TOLD = ("median_m", "sigma_m", "within_3sigma_percent", "median_timed_m", "median_effective_sample_size")
INTERVAL_PERCENT = 95

Bar = Callable[[str], Callable[[Iterable], Iterable]]
"""Makes, from a few words, what wraps a loop in a progress bar."""


def no_bar(text: str) -> Callable[[Iterable], Iterable]:
    """No progress bar."""
    return iter


class Maps(NamedTuple):
    """All that a method may know of the building."""

    detailed: SceneMap
    planar: SceneMap

    @classmethod
    def load(cls, data: Path) -> Maps:
        """The two maps in a folder that `make-data corridor` made."""
        return cls(SceneMap.load(data / "map.ply"), SceneMap.load(data / "planar_map.ply"))


class Row(NamedTuple):
    """One row of table 1: a method on a recording."""

    run: Run
    nearest: PositionError
    timed: PositionError


def own_recordings(
    data: Path, folder: Path, seed: int, frames: int | None = None, bar: Bar = no_bar
) -> tuple[DepthSequence, DepthSequence]:
    """The two recordings of a seed, even and by hand, made below `folder` in the building whose map lies in `data`."""
    building = building_of_data(data)
    for name, hardships in (("even", ()), ("by hand", HARDSHIPS)):
        progress = bar(f"recording seed {seed}, {name}")
        record_seed(folder / name, building, seed, hardships, frames=frames, progress=progress)
    return read_sequence(folder / "even"), read_sequence(folder / "by hand")


def run_rows(
    maps: Maps,
    even: DepthSequence,
    by_hand: DepthSequence | None,
    methods: Collection[str] = tuple(METHODS),
    bar: Bar = no_bar,
    **options: object,
) -> dict[str, Row]:
    """Every row of table 1; names of those on the less kind recording end in BY_HAND. options: `run_method`'s."""
    rows = {key: _row(key, maps, even, bar(METHODS[key].name), **options) for key in METHODS if key in methods}
    if by_hand is not None:
        for key in [key for key in METHODS_BY_HAND if key in methods]:
            rows[key + BY_HAND] = _row(key, maps, by_hand, bar(f"{METHODS[key].name}, by hand"), **options)
    return rows


def _row(key: str, maps: Maps, sequence: DepthSequence, progress: Callable, **options: object) -> Row:
    run = run_method(METHODS[key], *maps, sequence, progress=progress, **options)
    return Row(run, *path_errors(run, sequence))


def row_numbers(key: str, row: Row) -> dict[str, object]:
    """What table 1 tells of a row."""
    return {
        "name": METHODS[key.removesuffix(BY_HAND)].name,
        "median_m": row.nearest.median,
        "sigma_m": row.nearest.sigma,
        "within_3sigma_percent": 100 * row.nearest.within_3sigma,
        "median_timed_m": row.timed.median,
        "median_effective_sample_size": float(np.median(row.run.ess)),
        "ms_per_frame": row.run.ms_per_frame,
    }


def rows_by_part(rows: dict[str, Row]) -> dict[str, dict[str, dict]]:
    """What table 1 tells of every row, those on the even recording below "methods", the others "methods_by_hand"."""
    numbers = {key: row_numbers(key, row) for key, row in rows.items()}
    by_hand = {key.removesuffix(BY_HAND): row for key, row in numbers.items() if key.endswith(BY_HAND)}
    even = {key: row for key, row in numbers.items() if not key.endswith(BY_HAND)}
    return {"methods": even, **({"methods_by_hand": by_hand} if by_hand else {})}


def spread(values: Sequence[float]) -> dict[str, float]:
    """Median, least and greatest of one number over seeds."""
    return {"median": float(np.median(values)), "least": float(min(values)), "greatest": float(max(values))}


def median_interval(values: Sequence[float]) -> dict[str, float | None]:
    """Median of one number over seeds and its 95 % confidence interval; no interval from fewer than six seeds.

    From order statistics: at most half of all recordings lie below the median, whatever their distribution.
    """
    low, high = quantile_test(values, q=0, p=0.5).confidence_interval(confidence_level=INTERVAL_PERCENT / 100)
    known = np.isfinite([low, high]).all()
    ends = {"low": float(low), "high": float(high)} if known else {"low": None, "high": None}
    return {"median": float(np.median(values)), **ends}


def over_recordings(
    summaries: Sequence[dict], tell: Callable[[Sequence[float]], dict] = spread
) -> dict[str, dict[str, dict]]:
    """For "methods" and "methods_by_hand", what `tell` makes of every number of every row over seeds (`spread`)."""
    return {
        part: {
            key: {
                "name": summaries[0][part][key]["name"],
                **{name: tell([summary[part][key][name] for summary in summaries]) for name in TOLD},
            }
            for key in summaries[0][part]
        }
        for part in ("methods", "methods_by_hand")
        if all(part in summary for summary in summaries)
    }


def hardship_errors(
    data: Path,
    seed: int,
    hardships: Collection[Hardship],
    camera: DepthCamera,
    frames: int | None = None,
    bar: Bar = no_bar,
    **options: object,
) -> dict[str, float]:
    """Median errors of the paper's method on a seed's recording with these hardships and no others, metres."""
    name = ", ".join(hardships) or "none"
    building, maps = building_of_data(data), Maps.load(data)
    with temporary_folder() as temporary:
        folder = temporary / "run"
        record_seed(folder, building, seed, hardships, camera=camera, frames=frames, progress=bar(f"recording, {name}"))
        row = _row("proposed", maps, read_sequence(folder), bar(f"seed {seed}, {name}"), seed=seed, **options)
    return {"median_m": row.nearest.median, "median_timed_m": row.timed.median}
