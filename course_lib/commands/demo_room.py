"""Run paper 2's room experiment: 20 poses at each of two heights, from images to poses; print tables 1 to 5.

The stereo panoramas are those of data/room. Another seed renders the same room again with other rig tilts, exposures
and noise, which takes some minutes more.
"""

from __future__ import annotations

import argparse
import json
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from course_lib.commands.detector_options import add_detector_arguments, chosen_detector
from course_lib.commands.room_tables import EXACT, FITS, WEIGHTED, tables
from course_lib.files import run_folder, temporary_folder
from tools.make_room import SEED

if TYPE_CHECKING:  # imported where they are used, so that --help does not wait for OpenCV
    from matplotlib.figure import Figure

    from course_lib.experiments.turned_rig import RolledPair
    from course_lib.spherical_stereo.detection.detector import YoloDetector
    from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declares the options of `demo room`."""
    parser.add_argument(
        "--seed",
        type=int,
        metavar="N",
        help=f"of the photographs; another than {SEED} takes them anew (default: {SEED}, the shipped ones)",
    )
    parser.add_argument(
        "--poses", type=int, metavar="N", help="only the first N poses of each experiment (default: all)"
    )
    parser.add_argument("--data", type=Path, metavar="FOLDER", help="made by make-data room (default: data/room)")
    add_detector_arguments(parser)
    parser.add_argument(
        "--association",
        default="greedy",
        metavar="NAME",
        help="how objects are matched to the map: greedy (the paper's), hungarian, consistent (default: greedy)",
    )
    parser.add_argument(
        "--views",
        type=int,
        default=1,
        choices=(1, 2),
        help="2: with --association consistent, also follow the two views of every place as the rig turns there, with "
        "and without odometry (default: 1)",
    )
    parser.add_argument(
        "--out",
        type=Path,
        default=Path("results/room"),
        metavar="FOLDER",
        help="where results, figures and scenes to be turned in a browser go (default: results/room)",
    )
    parser.add_argument(
        "--roll",
        type=int,
        nargs="+",
        metavar="K",
        default=[],
        help="also localize from the images rolled by K columns, as if the rig had turned, and print how far the pose "
        "moves (default: not)",
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of the tables")


def run(arguments: argparse.Namespace) -> int:
    """Runs both experiments, from images and from exact boxes; returns the exit code."""
    from course_lib.beyond.look_alikes.matchers import matcher
    from course_lib.commands.arguments import require_count, require_output_folder, require_seed
    from course_lib.paths import data_path

    if arguments.seed is not None and arguments.data is not None:
        raise ValueError(
            f"--seed {arguments.seed} takes new photographs, and --data {arguments.data} holds some that were taken "
            "already, with a seed of their own: give one of the two"
        )
    seed = SEED if arguments.seed is None else arguments.seed
    require_seed(seed)
    require_output_folder(arguments.out)
    require_count("--poses", arguments.poses)
    if 0 in arguments.roll:
        raise ValueError("--roll must not be 0: images that are not rolled are the experiment itself")
    matcher(arguments.association)  # a wrong name costs no minutes
    if arguments.views > 1 and arguments.association != "consistent":
        raise ValueError(f"--views {arguments.views} needs --association consistent; got {arguments.association}")
    if seed == SEED:
        return _run_on(arguments.data or data_path("room"), arguments)
    detector = chosen_detector(arguments)  # before the photographs: an error then costs no minutes
    with temporary_folder() as folder:
        _photograph(folder, seed)
        return _run_on(folder, arguments, detector)


def _photograph(folder: Path, seed: int) -> None:
    from course_lib.commands.progress import progress_bar
    from course_lib.simulation.room.data import make_room_data

    make_room_data(folder, seed, progress=progress_bar("photographs", "pair"))


def _run_on(folder: Path, arguments: argparse.Namespace, detector: YoloDetector | None = None) -> int:
    from course_lib.beyond.look_alikes.matchers import matcher
    from course_lib.commands.arguments import warn_of_fewer
    from course_lib.commands.look_alike_tables import views_table
    from course_lib.commands.progress import progress_bar
    from course_lib.experiments.look_alikes import answers_of_places, tables_by_method
    from course_lib.experiments.room import SOURCES, run_experiment, weighted_summary
    from course_lib.experiments.turned_rig import turn_summary, turn_the_rig, weigh_by_covariance
    from course_lib.spherical_stereo.localizer import SemanticLocalizer
    from course_lib.spherical_stereo.recording import read_stereo_recording
    from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

    semantic_map = SemanticMap.load(folder / "semantic_map.json")
    detector = detector or chosen_detector(arguments)
    results: dict[str, dict[str, list]] = {}
    weighted: dict[tuple[str, str], dict] = {}
    rolled: dict[str, list[RolledPair]] = {name: [] for name in FITS}
    for number in (1, 2):
        recording = read_stereo_recording(folder / f"experiment_{number}")
        warn_of_fewer("--poses", arguments.poses, len(recording.pairs), f"experiment {number} has")
        recording = replace(recording, pairs=recording.pairs[: arguments.poses])
        localizer = SemanticLocalizer(
            recording.rig,
            semantic_map,
            detector,
            association=matcher(arguments.association),
            image_size=(recording.width, recording.height),
            reject_implausible=False,  # the paper's method
        )
        results[f"experiment_{number}"] = {
            source: run_experiment(
                recording, localizer, source, progress_bar(f"experiment {number}, {source.replace('_', ' ')}", "pose")
            )
            for source in SOURCES
        }
        if arguments.roll:
            bar = progress_bar(f"experiment {number}, rolled images", "pose")
            pairs = turn_the_rig(results[f"experiment_{number}"]["images"], localizer, arguments.roll, bar)
            rolled["alike"] += pairs
            rolled["by_covariance"] += weigh_by_covariance(pairs, localizer)
        for source in SOURCES:
            found = results[f"experiment_{number}"][source]
            weighted[f"experiment_{number}", source] = weighted_summary(found, localizer)
    summary = summarize(arguments, recording, results, weighted, semantic_map, recording.rig.baseline)
    if arguments.roll:
        summary["rolled_images"] = {name: turn_summary(pairs) for name, pairs in rolled.items()}
    if arguments.views > 1:
        summary["n_views"] = arguments.views
        summary["several_views"] = tables_by_method(
            [
                answer
                for number in (1, 2)
                for answer in answers_of_places(results[f"experiment_{number}"]["images"], semantic_map, number)
            ]
        )
    text = tables(summary) + ("\n\n" + views_table(summary) if arguments.views > 1 else "")
    print(json.dumps(summary) if arguments.json else text, flush=True)
    with run_folder(arguments.out, "demo room") as out:
        written = write(out, summary, results, draw(semantic_map, results))
        written += _write_scenes(out, semantic_map, results)
    if not arguments.json:
        print(f"\nWritten to {arguments.out}: " + ", ".join(written))
    return 0


def summarize(arguments, recording, results: dict, weighted: dict, semantic_map: SemanticMap, baseline: float) -> dict:
    """Tables 3 to 5 by experiment and association method, stereo matching and distances over all poses."""
    import numpy as np

    from course_lib.experiments.room import experiment_summary, matching_counts, range_errors

    name = arguments.association
    from_images = [result for experiment in results.values() for result in experiment["images"]]
    from_boxes = [result for experiment in results.values() for result in experiment["exact_boxes"]]
    counts = matching_counts(from_images)
    ranges = {
        "exact_boxes": range_errors(from_boxes, semantic_map, baseline, "box_centre"),
        "detected_box_centres": range_errors(from_images, semantic_map, baseline, "box_centre"),
        "akaze_disparities": range_errors(from_images, semantic_map, baseline, "disparity"),
    }
    return {
        "seed": recording.seed,
        "poses": len(from_images) // 2,
        **{
            experiment: {
                name: experiment_summary(by_source["images"]),
                f"{name}{WEIGHTED}": weighted[experiment, "images"],
                f"{name}{EXACT}": experiment_summary(by_source["exact_boxes"]),
                f"{name}{WEIGHTED}{EXACT}": weighted[experiment, "exact_boxes"],
            }
            for experiment, by_source in results.items()
        },
        "stereo_matching": {
            "matched": counts.matched,
            "right_percent": 100.0 * counts.right / max(1, counts.matched),
            "seen_in_both": counts.seen_in_both,
            "unmatched_percent": 100.0 * counts.unmatched / max(1, counts.seen_in_both),
        },
        "median_relative_range_error_percent": {
            key: 100.0 * float(np.median(errors)) if len(errors) else None for key, errors in ranges.items()
        },
        "objects_below_4_m": {key: len(errors) for key, errors in ranges.items()},
        "incorrect_poses": _pairs_of_incorrect(from_images),
        "seconds_per_pose": float(np.median([result.seconds for result in from_images])),
    }


def _pairs_of_incorrect(results: list) -> dict:
    """How many pairs of an incorrect pose are wrong, of how many used; None where no pose is incorrect."""
    import numpy as np

    from course_lib.experiments.room_evaluation import INCORRECT, wrong_pairs

    incorrect = [result for result in results if result.outcome.kind == INCORRECT]
    wrong = [len(wrong_pairs(result.localization, result.true_landmarks)) for result in incorrect]
    used = [len(result.localization.used_pairs) for result in incorrect]
    return {
        "median_wrong_pairs": float(np.median(wrong)) if wrong else None,
        "median_used_pairs": float(np.median(used)) if used else None,
    }


def draw(semantic_map: SemanticMap, results: dict) -> dict[str, Figure]:
    """The figures, by file name: of one pose that is right, of one that is wrong, and of all poses from above."""
    from course_lib.experiments.room_evaluation import CORRECT, INCORRECT
    from course_lib.plots import room_figures as figures

    drawn: dict[str, Figure] = {}
    for experiment, by_source in results.items():
        title = f"{experiment.replace('_', ' ').capitalize()}: true and estimated poses, from images"
        drawn[f"{experiment}.png"] = figures.experiment_figure(semantic_map, by_source["images"], title)
    for kind in (CORRECT, INCORRECT):
        result = _first_of(results, kind)
        if result is not None:
            title = f"Place {result.pair.name}: {kind}"
            drawn[f"pose_{kind}.png"] = figures.pose_figure(semantic_map, result, title)
    shown = _first_of(results, CORRECT) or results["experiment_1"]["images"][0]
    upper, lower = shown.pair.images()
    drawn["detections.png"] = figures.detections_figure(upper, shown.localization.upper_detections)
    if shown.localization.matches:
        drawn["matched_pairs.png"] = figures.matches_figure(upper, lower, shown.localization)
    return drawn


def _write_scenes(out: Path, semantic_map: SemanticMap, results: dict) -> list[str]:
    """Writes one pose that is right and one that is wrong in three dimensions; what was written, in words."""
    from functools import partial

    from course_lib.commands.scene_output import write_scene
    from course_lib.experiments.room_evaluation import CORRECT, INCORRECT
    from course_lib.plots.location_scene import location_scene

    written = []
    for kind in (CORRECT, INCORRECT):
        result = _first_of(results, kind)
        if result is not None:
            make = partial(location_scene, semantic_map, result.localization, result.pair.pose)
            written.append(write_scene(out / f"pose_{kind}.html", f"Place {result.pair.name}: {kind}", make))
    return written


def _first_of(results: dict, kind: str):
    """The first pose from images of that outcome, or None."""
    return next((one for by in results.values() for one in by["images"] if one.outcome.kind == kind), None)


def write(out: Path, summary: dict, results: dict, figures: dict[str, Figure]) -> list[str]:
    """Writes numbers (JSON, CSV a row a pose) and figures; returns the names of the files."""
    from course_lib.experiments.results import write_results

    rows = [
        {
            "experiment": experiment,
            "source": source,
            "place": result.pair.name,
            "true_x": round(float(result.pair.pose[0]), 4),
            "true_y": round(float(result.pair.pose[1]), 4),
            "true_theta": round(float(result.pair.pose[2]), 5),
            **{
                key: "" if result.localization.pose is None else round(float(getattr(result.localization.pose, key)), 4)
                for key in ("x", "y", "theta")
            },
            "outcome": result.outcome.kind,
            "reason": result.localization.reason or "",
            "used_pairs": len(result.localization.used_pairs),
            "seconds": round(result.seconds, 3),
        }
        for experiment, by_source in results.items()
        for source, many in by_source.items()
        for result in many
    ]
    write_results(out / "room.json", summary, rows)
    for name, figure in figures.items():
        figure.savefig(out / name, dpi=110)
    return [*figures, "room.json", "room.csv"]
