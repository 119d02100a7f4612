"""Run paper 2's room experiment: 20 poses at each of two heights, from images to poses; print tables 1 to 5.

The stereo panoramas are those of data/room; another seed renders the same room again. "images" is the whole method.
"exact boxes" starts after a perfect detector and a perfect stereo matching: it tells how much of the error is the
method's own.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from course_lib.beyond.look_alikes.matchers import matcher
from course_lib.experiments.room_evaluation import (
    INCORRECT,
    NO_OBJECT,
    PoseOutcome,
    identify_detections,
    outcome,
    summary,
    true_landmarks_of,
    wrong_pairs,
)
from course_lib.experiments.runner import Outcome, Runner
from course_lib.paths import data_path
from course_lib.simulation.room import data as room_data
from course_lib.spherical_stereo.detection.colour import mean_hue_saturation
from course_lib.spherical_stereo.detection.detected_object import Detection, box_centre
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.panorama import pixel_to_direction
from course_lib.spherical_stereo.pose.localization import Localization
from course_lib.spherical_stereo.ranging.object_positions import disparity_distance
from course_lib.spherical_stereo.ranging.triangulation import OK, object_position, triangulation_outcome
from course_lib.spherical_stereo.recording import StereoPair, StereoRecording, TrueObject, read_stereo_recording
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

SHIPPED_SEED = 4  # of data/room
SOURCES = ("images", "exact_boxes")
LEAST_VISIBLE = 0.5  # share of an object's pixels that must be seen for it to count; chosen
LEAST_HEIGHT = 30.0  # pixels at a width of 1280 that its visible box must be high to count; chosen
MAX_RANGE = 4.0  # m, horizontal: distances are judged below it; chosen


class PairResult(NamedTuple):
    """What the method made of one pair of panoramas, and what it should have made of it."""

    pair: StereoPair
    localization: Localization
    outcome: PoseOutcome
    true_landmarks: tuple[int, ...]  # For every observation the landmark it shows; `NO_OBJECT` for none
    upper_identity: tuple[int, ...]
    """For every detection of the upper image the number of the object it shows; `NO_OBJECT` for none."""
    lower_identity: tuple[int, ...]  # The same for the lower image
    size: tuple[int, int]  # (width, height) of the panoramas, pixels
    seconds: float  # From two images in memory to the pose


class Record(NamedTuple):
    """Both experiments, for figures."""

    semantic_map: SemanticMap
    results: dict[str, dict[str, list[PairResult]]]  # By experiment ("experiment_1") and source


def run(
    runner: Runner,
    *,
    seed: int | None,
    poses: int | None,
    data: Path | None,
    detector: object,
    association: str,
    views: int,
    roll: list[int],
) -> Outcome:
    """Run `demo room`: both experiments, from images and from exact boxes. detector: `YoloDetector`."""
    from course_lib.experiments import look_alikes, room_tables, turned_rig  # they import this module

    if seed is not None and data is not None:
        raise ValueError(f"--seed {seed} takes new photographs, and --data {data} holds others: give one of the two")
    if 0 in roll:
        raise ValueError("--roll must not be 0: images that are not rolled are the experiment itself")
    matched_by = matcher(association)
    if views > 1 and association != "consistent":
        raise ValueError(f"--views {views} needs --association consistent; got {association}")
    folder = data or data_path("room")
    if seed not in (None, SHIPPED_SEED):
        folder = runner.temporary
        room_data.make_room_data(folder, seed, progress=runner.bar("photographs", "pair"))
    semantic_map = SemanticMap.load(folder / "semantic_map.json")
    record, summaries, rolled = Record(semantic_map, {}), {}, {"alike": [], "by_covariance": []}
    for number in (1, 2):
        recording = read_stereo_recording(folder / f"experiment_{number}")
        recording = replace(recording, pairs=recording.pairs[:poses])
        localizer = SemanticLocalizer(
            recording.rig,
            semantic_map,
            detector,
            association=matched_by,
            image_size=(recording.width, recording.height),
            reject_implausible=False,  # the paper's method
        )
        results = {}
        for source in SOURCES:
            bar = runner.bar(f"experiment {number}, {source.replace('_', ' ')}", "pose")
            results[source] = run_experiment(recording, localizer, source, bar)
        if roll:
            bar = runner.bar(f"experiment {number}, rolled images", "pose")
            pairs = turned_rig.turn_the_rig(results["images"], localizer, roll, bar)
            rolled["alike"] += pairs
            rolled["by_covariance"] += turned_rig.weigh_by_covariance(pairs, localizer)
        record.results[f"experiment_{number}"] = results
        summaries[f"experiment_{number}"] = {
            association: experiment_summary(results["images"]),
            f"{association}_weighted": weighted_summary(results["images"], localizer),
            f"{association}_exact_boxes": experiment_summary(results["exact_boxes"]),
            f"{association}_weighted_exact_boxes": weighted_summary(results["exact_boxes"], localizer),
        }
    summary = {"seed": recording.seed, **_summarize(record, summaries, recording.rig.baseline)}
    if roll:
        summary["rolled_images"] = {name: turned_rig.turn_summary(pairs) for name, pairs in rolled.items()}
    if views > 1:
        answers = []
        for number, results in enumerate(record.results.values(), start=1):
            answers += look_alikes.answers_of_places(results["images"], semantic_map, number)
        summary |= {"n_views": views, "several_views": look_alikes.tables_by_method(answers)}
    text = room_tables.tables(summary) + ("\n\n" + look_alikes.views_table(summary) if views > 1 else "")
    return Outcome(summary, text, {"room.json": (summary, _rows(record))}, "room", record)


def _summarize(record: Record, summaries: dict, baseline: float) -> dict:
    """Tables 3 to 5 by experiment and association method, stereo matching and distances over all poses."""
    from_images, from_boxes = ([one for by in record.results.values() for one in by[source]] for source in SOURCES)
    ranges = {
        "exact_boxes": range_errors(from_boxes, record.semantic_map, baseline, "box_centre"),
        "detected_box_centres": range_errors(from_images, record.semantic_map, baseline, "box_centre"),
        "akaze_disparities": range_errors(from_images, record.semantic_map, baseline, "disparity"),
    }
    incorrect = [result for result in from_images if result.outcome.kind == INCORRECT]
    wrong = [len(wrong_pairs(result.localization, result.true_landmarks)) for result in incorrect]
    used = [len(result.localization.used_pairs) for result in incorrect]
    return {
        "poses": len(from_images) // 2,
        **summaries,
        "stereo_matching": matching_rates(from_images),
        "median_relative_range_error_percent": {
            key: 100.0 * float(np.median(errors)) if len(errors) else None for key, errors in ranges.items()
        },
        "objects_below_4_m": {key: len(errors) for key, errors in ranges.items()},
        "incorrect_poses": {
            "median_wrong_pairs": float(np.median(wrong)) if wrong else None,
            "median_used_pairs": float(np.median(used)) if used else None,
        },
        "seconds_per_pose": float(np.median([result.seconds for result in from_images])),
    }


def _rows(record: Record) -> list[dict]:
    """A row a pose for a CSV file."""
    return [
        {
            "experiment": experiment,
            "source": source,
            "place": result.pair.name,
            **pose_columns(result.pair.pose, result.localization, result.outcome),
            "seconds": round(result.seconds, 3),
        }
        for experiment, by_source in record.results.items()
        for source, many in by_source.items()
        for result in many
    ]


def pose_columns(true_pose: Sequence[float], found: Localization, judged: PoseOutcome) -> dict:
    """Columns of a CSV file: the true pose, the estimated one, and what became of it."""
    names, digits = ("x", "y", "theta"), (4, 4, 5)
    pose = found.pose
    return {
        **{f"true_{name}": round(float(v), d) for name, v, d in zip(names, true_pose, digits, strict=True)},
        **{name: "" if pose is None else round(float(getattr(pose, name)), 4) for name in names},
        "outcome": judged.kind,
        "reason": found.reason or "",
        "used_pairs": len(found.used_pairs),
    }


def counts_as_object(thing: TrueObject, width: int) -> bool:
    """Whether an object is one to be found: half of it visible, its visible box 30 pixels high at a width of 1280."""
    _, v_min, _, v_max = thing.visible_box
    return thing.visible_fraction >= LEAST_VISIBLE and (v_max - v_min) * 1280 / width >= LEAST_HEIGHT


def exact_detections(objects: Sequence[TrueObject], image: np.ndarray) -> tuple[list[Detection], list[int]]:
    """Return what a perfect detector would report of an image `(H, W, 3)` BGR, and the object each detection shows."""
    chosen = [thing for thing in objects if counts_as_object(thing, image.shape[1])]
    detections = [
        Detection(thing.label, 1.0, thing.visible_box, *mean_hue_saturation(image, thing.visible_box))
        for thing in chosen
    ]
    return detections, [thing.number for thing in chosen]


def localize_pair(pair: StereoPair, localizer: SemanticLocalizer, source: str = "images") -> PairResult:
    """Localize one pair from a source ("images" or "exact_boxes") and judge the result by table 2.

    Landmark k of the map is object k of the recording. Source: paper 2, section 3.
    """
    upper_image, lower_image = pair.images()
    width, height = upper_image.shape[1], upper_image.shape[0]
    start = time.perf_counter()
    if source == "images":
        found = localizer.localize(upper_image, lower_image)
        seconds = time.perf_counter() - start
        identities = [
            _identities(found.upper_detections, pair.upper_objects, width),
            _identities(found.lower_detections, pair.lower_objects, width),
        ]
    else:
        upper, upper_numbers = exact_detections(pair.upper_objects, upper_image)
        lower, lower_numbers = exact_detections(pair.lower_objects, lower_image)
        matches = [(i, lower_numbers.index(n)) for i, n in enumerate(upper_numbers) if n in lower_numbers]
        found = localizer.localize_detections(upper, lower, matches, (width, height))
        seconds = time.perf_counter() - start
        identities = [tuple(upper_numbers), tuple(lower_numbers)]
    landmarks = true_landmarks_of(found, identities[0], range(len(localizer.semantic_map)), identities[1])
    return PairResult(
        pair, found, outcome(found, pair.pose, landmarks), landmarks, *identities, (width, height), seconds
    )


def run_experiment(
    recording: StereoRecording, localizer: SemanticLocalizer, source: str = "images", progress: Callable = iter
) -> list[PairResult]:
    """Localize every pair of a recording. Source: paper 2, section 3."""
    return [localize_pair(pair, localizer, source) for pair in progress(recording.pairs)]


def experiment_summary(results: Sequence[PairResult]) -> dict:
    """Return tables 3 to 5 of one experiment (`room_evaluation.summary`)."""
    return summary([result.outcome for result in results])


def fitted_by_covariance(found: Localization, localizer: SemanticLocalizer) -> Localization:
    """Return a localization fitted anew (2.6): each observation weighted by its covariance, not counted alike."""
    if not found.observations:
        return found
    weighted = SemanticLocalizer(
        localizer.rig,
        localizer.semantic_map,
        association=localizer.association,
        weights=localizer.weights,
        distance_term=localizer.distance_term,
        weighted_fit=True,
        reject_implausible=localizer.reject_implausible,
    )
    return weighted.localize_observations(found.observations)


def weighted_summary(results: Sequence[PairResult], localizer: SemanticLocalizer) -> dict:
    """`experiment_summary` of the same observations and associations, with pairs weighted by their covariances."""
    fitted = [fitted_by_covariance(one.localization, localizer) for one in results]
    return summary([outcome(a, one.pair.pose, one.true_landmarks) for a, one in zip(fitted, results, strict=True)])


def matching_rates(results: Sequence[PairResult]) -> dict[str, float]:
    """Return how often stereo matching was right about the objects detected in both images, over all pairs.

    A detection that shows no object has no right partner, and is not counted. Source: paper 2, section 2.3.
    """
    matched = right = both = unmatched = 0
    for result in results:
        seen = (set(result.upper_identity) & set(result.lower_identity)) - {NO_OBJECT}
        joined = [(result.upper_identity[m.upper], result.lower_identity[m.lower]) for m in result.localization.objects]
        judged = [(a, b) for a, b in joined if a in seen or b in seen]
        matched += len(judged)
        right += sum(a == b for a, b in judged)
        both += len(seen)
        unmatched += len(seen - {a for a, _ in judged})
    return {
        "matched": matched,
        "right_percent": 100.0 * right / max(1, matched),
        "seen_in_both": both,
        "unmatched_percent": 100.0 * unmatched / max(1, both),
    }


def range_errors(
    results: Sequence[PairResult], semantic_map: SemanticMap, baseline: float, distance: str
) -> np.ndarray:
    """Return relative errors `(n,)` of the horizontal distances to the objects' centroids on the map, below 4 m.

    |rho - rho_true| / rho_true for every right match; infinite without a distance. distance: "box_centre", "disparity".
    Source: paper 2, section 2.4.
    """
    errors = []
    for result in results:
        found = result.localization
        for match, placed in zip(found.matches, found.objects, strict=True):
            number = result.upper_identity[placed.upper]
            if number == NO_OBJECT or result.lower_identity[placed.lower] != number:
                continue
            true = float(np.linalg.norm(semantic_map.positions[number] - result.pair.pose[:2]))
            if true < MAX_RANGE:
                errors.append(abs(_range(result, match, placed, baseline, distance) - true) / true)
    return np.array(errors)


def failures(result: PairResult, semantic_map: SemanticMap) -> list[str]:
    """What went wrong with one pose, a line each: which observation was taken for which landmark."""
    if result.localization.pose is None:
        return [f"{result.localization.reason}: {result.localization.explanation}"]
    lines = []
    for observation, landmark, shown in wrong_pairs(result.localization, result.true_landmarks):
        label = result.localization.observations[observation].label
        x, y = semantic_map.positions[landmark]
        at = "the {} at ({:.1f}, {:.1f})".format(semantic_map.labels[shown], *semantic_map.positions[shown])
        truth = "nothing" if shown == NO_OBJECT else at
        lines.append(f"the {label} that shows {truth} was taken for the one at ({x:.1f}, {y:.1f})")
    return lines


def _identities(detections: Sequence[Detection], objects: Sequence[TrueObject], width: int) -> tuple[int, ...]:
    """Numbers of the objects that detections show."""
    known = [(thing.label, thing.visible_box, thing.unoccluded_box) for thing in objects]
    shown = identify_detections(detections, known, width)
    return tuple(NO_OBJECT if index == NO_OBJECT else objects[index].number for index in shown)


def _range(result: PairResult, match, placed, baseline: float, distance: str) -> float:
    """Horizontal range of a match, metres; infinite when it has none."""
    found, (width, height) = result.localization, result.size
    if distance == "disparity":
        measured = disparity_distance(match, width, height, baseline)
        return measured.horizontal_range if measured.outcome == OK else np.inf
    upper, lower = (
        pixel_to_direction(box_centre(detections[index].box), width, height)
        for detections, index in ((found.upper_detections, placed.upper), (found.lower_detections, placed.lower))
    )
    if triangulation_outcome(upper, lower) != OK:
        return np.inf
    return float(np.linalg.norm(object_position(upper, lower, baseline)[:2]))
