"""Draw the figures and scenes of the demos: each function draws into a folder, and returns the names of its files."""

from functools import partial
from pathlib import Path

import numpy as np

from course_lib.depth_mcl.sequence import FAR, NEAR
from course_lib.depth_mcl.sequence_files import write_tum
from courseware.commands.output import write_scene
from courseware.experiments.room_evaluation import CORRECT, INCORRECT
from courseware.plots import corridor_figures, room_figures
from courseware.plots.experiment_figures import covariance_figure, risk_coverage_figure, trouble_figure
from courseware.plots.location_scene import location_scene
from courseware.plots.track_scene import track_scene


def corridor(out: Path, record) -> list[str]:
    """Draw figures 5 and 6, the overview, the paper's method as trajectory (TUM) and scene."""
    maps, sequence, rows, backend = record
    ours = rows["proposed"]
    shown = {"ours": ours, "Fallon-style, 20 x 15": rows["fallon"]}
    walls = corridor_figures.floor_plan(maps.detailed.vertices, height=sequence.camera_to_world[0, 2, 3])
    positions = {name: row.run.states[:, :2] for name, row in shown.items()}
    lines = {f"{name}, nearest path": row.nearest.errors for name, row in shown.items()}
    lines["ours, timed"] = ours.timed.errors
    frames = np.asarray(ours.run.frames)
    times = frames.astype(float) if sequence.times is None else sequence.times[: len(frames)]
    write_tum(out / "trajectory.txt", times, ours.run.camera_to_world)
    figures = {
        "figure_5.png": corridor_figures.figure_5(sequence.path_on_floor, positions, walls),
        "figure_6.png": corridor_figures.figure_6(frames, lines),
        "overview.png": corridor_figures.overview_figure(maps.detailed, sequence, ours.run, backend),
    }
    make = partial(track_scene, maps.detailed, ours.run, sequence, "z", NEAR, FAR)
    scene = write_scene(out / "corridor.html", "The paper's filter in the corridor", make)
    return [*_save(out, figures, 130), "trajectory.txt (TUM)", scene]


def room(out: Path, record) -> list[str]:
    """Draw all poses of both experiments from above, and a figure and a scene of a right and of a wrong one."""
    semantic_map, results = record
    figures, scenes = {}, []
    for experiment, by_source in results.items():
        title = f"{experiment.replace('_', ' ').capitalize()}: true and estimated poses, from images"
        figures[f"{experiment}.png"] = room_figures.experiment_figure(semantic_map, by_source["images"], title)
    from_images = [one for by_source in results.values() for one in by_source["images"]]
    first = {one.outcome.kind: one for one in reversed(from_images)}
    for kind in (CORRECT, INCORRECT):
        if kind in first:
            one, title = first[kind], f"Place {first[kind].pair.name}: {kind}"
            figures[f"pose_{kind}.png"] = room_figures.pose_figure(semantic_map, one, title)
            make = partial(location_scene, semantic_map, one.localization, one.pair.pose)
            scenes.append(write_scene(out / f"pose_{kind}.html", title, make))
    shown = first.get(CORRECT, from_images[0])
    upper, lower = shown.pair.images()
    figures["detections.png"] = room_figures.detections_figure(upper, shown.localization.upper_detections)
    if shown.localization.matches:
        figures["matched_pairs.png"] = room_figures.matches_figure(upper, lower, shown.localization)
    return _save(out, figures) + scenes


def _save(out: Path, figures: dict, dots_per_inch: int = 110) -> list[str]:
    for name, figure in figures.items():
        figure.savefig(out / name, dpi=dots_per_inch)
    return list(figures)


def risk_coverage(out: Path, curve: dict) -> list[str]:
    """Draw errors over the share of places that a threshold on the confidence leaves."""
    return _save(out, {"risk_coverage.png": risk_coverage_figure({"consistent, one view": curve})})


FIGURES = {
    "corridor": corridor,
    "room": room,
    "risk_coverage": risk_coverage,
    "covariance": lambda out, runs: _save(out, {"covariance.png": covariance_figure(runs)}),
    "trouble": lambda out, results: _save(out, {"trouble.png": trouble_figure(results)}),
}
