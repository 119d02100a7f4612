"""Run paper 1's experiment on the simulated corridor: estimate x, y and yaw, print table 1, save figures 5 and 6.

Every seed makes two recordings: another day in the building of the map, and one pushed by hand, with the usual errors.
"""

from collections.abc import Callable, Collection, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from course_lib.depth_mcl.evaluation import PAPER_TABLE_1, PositionError, nearest_path_error, timed_error
from course_lib.depth_mcl.fallon import fallon_weighting
from course_lib.depth_mcl.likelihood import Weighting
from course_lib.depth_mcl.localizer import SIGMA_XY_YAW
from course_lib.depth_mcl.sequence import DepthSequence, read_sequence
from course_lib.files import temporary_folder
from course_lib.recordings import Run, run_sequence
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.scene_map import SceneMap
from courseware.experiments import six_degrees
from courseware.experiments.intervals import spread
from courseware.experiments.runner import Outcome, Runner, no_bar
from courseware.paths import data_path
from courseware.simulation.corridor.seeded_recording import HARDSHIPS, Hardship, building_of_data, record_seed

IDEALIZATION_SEEDS = [10001, 10002, 10003]
IDEALIZATION_SIZE = (44, 36)  # pixels: a quarter of the SR4000's each way, so that 21 runs take minutes
BY_HAND = "_by_hand"  # ends the names of the rows on the recording that is pushed by hand
BY_HAND_TITLE = "with calibration and mount errors, pushed by hand:"
# The numbers of a row that are told over seeds.
TOLD = ("median_m", "sigma_m", "within_3sigma_percent", "median_timed_m", "median_effective_sample_size")


class Method(NamedTuple):
    """One row of table 1: which map, how many pixels, which weighting (None: the paper's)."""

    name: str
    planar: bool
    coarse: bool
    weighting: Weighting | None


METHODS = {
    "proposed": Method("proposed method, ours", False, False, None),
    "fallon": Method("Fallon-style, depth, 20 x 15", True, True, fallon_weighting("depth")),
    "fallon_full": Method("Fallon-style, depth, full size", True, False, fallon_weighting("depth")),
    "fallon_disparity": Method("Fallon-style, disparity, 20 x 15", True, True, fallon_weighting("disparity")),
    "fallon_disparity_full": Method("Fallon-style, disparity, full size", True, False, fallon_weighting("disparity")),
}
# Methods that also run on the recording that is pushed by hand: the paper's, and the comparison as it was published.
METHODS_BY_HAND = ("proposed", "fallon")


class Maps(NamedTuple):
    """All that a method may know of the building."""

    detailed: SceneMap
    planar: SceneMap

    @classmethod
    def load(cls, data: str | Path) -> "Maps":
        return cls(*(SceneMap.load(Path(data) / name) for name in ("map.ply", "planar_map.ply")))


class Row(NamedTuple):
    """One row of table 1: a method on a recording."""

    run: Run
    nearest: PositionError
    timed: PositionError


def run(
    runner: Runner,
    *,
    seed: int,
    seeds: list[int] | None,
    idealizations: bool,
    dof: str,
    methods: str | None,
    data: Path | None,
    **options: object,
) -> Outcome:
    """Run `demo corridor`: one seed with its figures, several seeds, what idealizations are worth, or `--dof 6`.

    options: recording, particles, frames, backend, exact.
    """
    data = (data or data_path("corridor")).absolute()
    if dof == "6":
        usual = {"recording": "own", "particles": 200, "backend": "raster", "idealizations": False}
        given = options | {"idealizations": idealizations}
        if unusual := [name for name, value in usual.items() if given[name] != value]:
            raise ValueError(f"--{unusual[0]} does not go with --dof 6")
        return six_degrees.run_corridor(runner, seeds or [seed], data, options["frames"], methods)
    names = six_degrees.require_methods(methods or "all", METHODS)
    if methods and seeds is None:
        raise ValueError("--methods goes with --seeds: a single seed runs every row of the table")
    if not set(METHODS_BY_HAND) <= set(names):
        raise ValueError(f"--methods must name {' and '.join(METHODS_BY_HAND)}, others of {', '.join(METHODS)}")
    recording = options.pop("recording")
    if idealizations:
        return _run_idealizations(runner, seeds or IDEALIZATION_SEEDS, data, **options)
    settings = {"data": str(data), **options, "recording": recording, "methods": names}
    if seeds is not None:
        return _run_seeds(runner, seeds, settings)
    maps, sequence, rows = record_of_seed(seed, runner.temporary, **settings, bar=runner.bar)
    summary = summarize(rows, {"seed": seed, **settings})
    files = {"corridor.json": (summary, rows_of_frames(rows))}
    return Outcome(summary, table_1(summary), files, "corridor", (maps, sequence, rows, options["backend"]))


def _run_seeds(runner: Runner, seeds: list[int], settings: dict) -> Outcome:
    """Return table 1 over the recordings of several seeds."""
    rows = runner.rows(table_1_of_seed, [{"seed": seed, **settings} for seed in seeds], "corridor")
    summaries = [row["summary"] for row in rows]
    result = {
        "seeds": seeds,
        **{key: summaries[0][key] for key in ("n_particles", "frames", "sigma_noise", "settings")},
        "over_recordings": over_recordings(summaries),
        "recordings": summaries,
    }
    each = {f"seed_{one['seed']}.json": (one, row["frames"]) for one, row in zip(summaries, rows, strict=True)}
    return Outcome(result, table_over_recordings(result), {"recordings.json": (result, None), **each})


def _run_idealizations(runner: Runner, seeds: list[int], data: Path, particles: int, **options: object) -> Outcome:
    """Run the paper's method on recordings with no hardship, with each alone, and with all."""
    every = {"none": (), **{name: (name,) for name in HARDSHIPS}, "all": HARDSHIPS}
    common = {"data": str(data), "n_particles": particles, **options}
    points = [{"seed": seed, "hardships": list(own), **common} for own in every.values() for seed in seeds]
    errors = iter(runner.rows(hardship_errors, points, "idealizations", "run"))
    result = {"seeds": seeds, "image": list(IDEALIZATION_SIZE), "n_particles": particles, **options, "hardships": {}}
    for name in every:
        own = [next(errors) for _ in seeds]
        result["hardships"][name] = {key: spread([one[key] for one in own]) for key in own[0]}
    return Outcome(result, table_of_idealizations(result), {"idealizations.json": (result, None)})


def record_of_seed(
    seed: int,
    folder: Path,
    data: str,
    particles: int,
    recording: str,
    methods: Collection[str],
    bar: Callable = no_bar,
    **options: object,
) -> tuple[Maps, DepthSequence, dict[str, Row]]:
    """Return table 1 of a seed, whose recordings are made in `folder`. options: frames, backend, exact."""
    maps = Maps.load(data)
    if recording == "shipped":
        even, by_hand = read_sequence(Path(data) / "wagon"), None
    else:
        even, by_hand = own_recordings(data, folder, seed, options["frames"], bar)
    return maps, even, run_rows(maps, even, by_hand, methods, bar, n_particles=particles, seed=seed, **options)


def table_1_of_seed(seed: int, **settings: object) -> dict:
    """Return table 1 of a seed as JSON holds it: the summary, and a row a frame."""
    with temporary_folder() as folder:
        rows = record_of_seed(seed, folder, **settings)[-1]
    return {"summary": summarize(rows, {"seed": seed, **settings}), "frames": rows_of_frames(rows)}


def own_recordings(
    data: str | Path, folder: Path, seed: int, frames: int | None = None, bar: Callable = no_bar
) -> list[DepthSequence]:
    """Make the two recordings of a seed, even and by hand, in the building whose map lies in `data`."""
    building, hardships_of = building_of_data(Path(data)), {"even": (), "by hand": HARDSHIPS}
    for name, hardships in hardships_of.items():
        progress = bar(f"recording seed {seed}, {name}", "frame")
        record_seed(folder / name, building, seed, hardships, frames=frames, progress=progress)
    return [read_sequence(folder / name) for name in hardships_of]


def run_rows(
    maps: Maps,
    even: DepthSequence,
    by_hand: DepthSequence | None,
    methods: Collection[str] = tuple(METHODS),
    bar: Callable = no_bar,
    **options: object,
) -> dict[str, Row]:
    """Return every row of table 1. options: `run_sequence`'s."""
    rows = {}
    for sequence, keys, end in ((even, METHODS, ""), (by_hand, METHODS_BY_HAND, BY_HAND)):
        for key in (key for key in keys if key in methods and sequence is not None):
            progress = bar(METHODS[key].name + (", by hand" if end else ""), "frame")
            rows[key + end] = run_row(METHODS[key], maps, sequence, progress=progress, **options)
    return rows


def run_row(method: Method, maps: Maps, sequence: DepthSequence, **options: object) -> Row:
    """Localize a recording, which holds its path on the floor, in x, y and yaw by the method of one row of table 1."""
    used_map = maps.planar if method.planar else maps.detailed
    run = run_sequence(used_map, sequence, weighting=method.weighting, coarse=method.coarse, **options)
    if sequence.path_on_floor is None:
        raise ValueError(f"{sequence.folder} holds no path_on_floor.txt, which the paper's error needs")
    estimated, true = run.camera_to_world[:, :3, 3], sequence.camera_to_world[: len(run.frames), :3, 3]
    return Row(run, nearest_path_error(estimated, sequence.path_on_floor), timed_error(estimated, true))


def hardship_errors(
    seed: int, data: str, hardships: Sequence[Hardship], frames: int | None = None, **options: object
) -> dict[str, float]:
    """Return the median errors [m] of the paper's method on a seed's small recording with only these hardships."""
    camera = DepthCamera.sr4000().resized(*IDEALIZATION_SIZE)
    with temporary_folder() as folder:
        record_seed(folder / "run", building_of_data(data), seed, tuple(hardships), camera=camera, frames=frames)
        sequence = read_sequence(folder / "run")
        row = run_row(METHODS["proposed"], Maps.load(data), sequence, seed=seed, frames=frames, **options)
    return {"median_m": row.nearest.median, "median_timed_m": row.timed.median}


def summarize(rows: dict[str, Row], settings: dict) -> dict:
    """Return the numbers of table 1: the paper's at the top, every method's in `methods` and `methods_by_hand`."""
    parts: dict[str, dict[str, dict]] = {}
    for key, row in rows.items():
        method = key.removesuffix(BY_HAND)
        parts.setdefault("methods" + key[len(method) :], {})[method] = {
            "name": METHODS[method].name,
            "median_m": row.nearest.median,
            "sigma_m": row.nearest.sigma,
            "within_3sigma_percent": 100 * row.nearest.within_3sigma,
            "median_timed_m": row.timed.median,
            "median_effective_sample_size": float(np.median(row.run.ess)),
            "ms_per_frame": row.run.ms_per_frame,
        }
    left_out = ("name", "median_effective_sample_size")
    proposed = {key: value for key, value in parts["methods"]["proposed"].items() if key not in left_out}
    return {
        "seed": settings["seed"],
        "n_particles": settings["particles"],
        "frames": len(rows["proposed"].run.frames),
        "sigma_noise": [float(s) for s in SIGMA_XY_YAW],
        "settings": settings,
        **proposed,
        "fallon_median_m": parts["methods"]["fallon"]["median_m"],
        **parts,
    }


def rows_of_frames(rows: dict[str, Row]) -> list[dict]:
    """Return a row a frame for a CSV file: errors, positions and scores of every method."""
    frames, columns = rows["proposed"].run.frames, {}
    columns |= {f"{key}_nearest_m": (row.nearest.errors, 5) for key, row in rows.items()}
    columns |= {f"{key}_timed_m": (row.timed.errors, 5) for key, row in rows.items()}
    for key, row in rows.items():
        columns |= {f"{key}_{axis}_m": (row.run.camera_to_world[:, j, 3], 4) for j, axis in enumerate("xy")}
    columns |= {f"{key}_score": (row.run.scores, 5) for key, row in rows.items()}
    numbers = [[round(float(value), digits) for value in values] for values, digits in columns.values()]
    return [dict(zip(["frame", *columns], row, strict=True)) for row in zip(frames, *numbers, strict=True)]


def over_recordings(summaries: Sequence[dict], tell: Callable = spread) -> dict[str, dict[str, dict]]:
    """Return what `tell` makes of every number of every row over seeds, for "methods" and "methods_by_hand"."""
    result: dict[str, dict[str, dict]] = {}
    for part in (part for part in ("methods", "methods_by_hand") if part in summaries[0]):
        own = [summary[part] for summary in summaries]
        for key, row in own[0].items():
            told = {name: tell([one[key][name] for one in own]) for name in TOLD}
            result.setdefault(part, {})[key] = {"name": row["name"], **told}
    return result


def table_1(summary: dict) -> str:
    """Return the paper's table 1 with its two rows and ours, the timed error beside the nearest-path error."""
    lines = [
        f"Table 1, {summary['frames']} frames, {summary['n_particles']} particles, seed {summary['seed']}",
        "",
        f"{'':36} {'nearest point of the path':^33}  {'same frame':>10}  {'particles':>9}",
        f"{'':36} {'median [m]':>10} {'sigma [m]':>10} {'<= 0.30 m':>11}  {'median [m]':>10}  {'effective':>9}",
    ]
    line = (
        "{name:36} {median_m:>10.3f} {sigma_m:>10.3f} {within_3sigma_percent:>9.1f} %  {median_timed_m:>10.3f}  "
        "{median_effective_sample_size:>9.1f}"
    )
    for name, (median, sigma, within) in PAPER_TABLE_1.items():
        sigma_text = "n/a" if sigma is None else f"{sigma:.2f}"
        lines.append(f"{'paper: ' + name:36} {median:>10.2f} {sigma_text:>10} {within:>9.0f} %  {'-':>10}  {'-':>9}")
    for part in ("methods", "methods_by_hand"):
        lines += ["", BY_HAND_TITLE] if part == "methods_by_hand" and part in summary else []
        lines += [line.format(**row) for row in summary.get(part, {}).values()]
    lines += [
        "",
        "sigma is the root mean square about zero. Fallon-style rows use a planar simplification of the map. At full",
        "size their sum over 25,344 pixels collapses onto few particles, at 20 x 15 it hardly tells them apart (last",
        "column: median effective sample size). Their published system also had visual odometry; here no row has any.",
        f"{summary['ms_per_frame']:.0f} ms a frame (paper: 125 ms, on a graphics card)",
    ]
    return "\n".join(lines)


def table_over_recordings(result: dict, told: str = "least to greatest") -> str:
    """Return table 1 over several seeds: medians and, in brackets, what is `told` of each."""
    seeds = result["seeds"]
    lines = [
        f"Table 1 over {len(seeds)} recordings, seeds {seeds[0]} to {seeds[-1]}, {result['frames']} frames, "
        f"{result['n_particles']} particles: median ({told})",
        "",
        f"{'':36} {'nearest median [m]':>22} {'sigma [m]':>22} {'<= 0.30 m [%]':>22} {'same frame median [m]':>22}",
    ]
    columns = {"median_m": 3, "sigma_m": 3, "within_3sigma_percent": 1, "median_timed_m": 3}
    for part, rows in result["over_recordings"].items():
        lines += ["", BY_HAND_TITLE] if part == "methods_by_hand" else []
        lines += [f"{row['name']:36} {_spreads(row, columns)}" for row in rows.values()]
    if any("?" in line for line in lines):
        lines += ["", "?: so few recordings leave the interval unknown; six are enough."]
    return "\n".join(lines)


def table_of_idealizations(result: dict) -> str:
    """Return median errors of the paper's method with each hardship alone: median over seeds (least to greatest)."""
    seeds, (width, height), columns = result["seeds"], result["image"], {"median_m": 3, "median_timed_m": 3}
    lines = [
        f"What idealizations are worth: {len(seeds)} recordings, seeds {seeds[0]} to {seeds[-1]}, "
        f"{width} x {height} pixels, {result['n_particles']} particles",
        "",
        f"{'hardship':18} {'nearest median [m]':>22} {'same frame median [m]':>22}",
    ]
    return "\n".join([*lines, *(f"{name:18} {_spreads(row, columns)}" for name, row in result["hardships"].items())])


def _spreads(row: dict, columns: dict[str, int]) -> str:
    """Return some spreads of a row, with so many digits: "median (least to greatest)" each."""
    told = []
    for key, digits in columns.items():
        middle, low, high = ("?" if value is None else f"{value:.{digits}f}" for value in row[key].values())
        told.append(f"{f'{middle} ({low} to {high})':>22}")
    return " ".join(told)
