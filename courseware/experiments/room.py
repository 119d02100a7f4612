"""Run paper 2's room experiment: 20 poses at each of two heights, from images to poses; print tables 1 to 5.

"exact boxes" starts after a perfect detector and a perfect stereo matching, to tell which error is the method's own.
"""

import time
from collections.abc import Callable, Sequence
from copy import copy
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from course_lib.beyond.look_alikes.matchers import matcher
from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.detection.colour import mean_hue_saturation
from course_lib.spherical_stereo.detection.detected_object import Detection, box_centre
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.outcomes import ObjectOutcome
from course_lib.spherical_stereo.panorama import pixel_to_direction
from course_lib.spherical_stereo.pose.localization import Localization
from course_lib.spherical_stereo.ranging.object_positions import disparity_distance
from course_lib.spherical_stereo.ranging.triangulation import object_position, triangulation_outcome
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap
from courseware.experiments import bearing_only as directions
from courseware.experiments import room_evaluation
from courseware.experiments.room_evaluation import INCORRECT, NO_OBJECT, PoseOutcome, median, outcome, summary
from courseware.experiments.room_tables import tables
from courseware.experiments.runner import Outcome, Runner
from courseware.paths import data_path
from courseware.simulation.room.data import make_room_data
from courseware.simulation.room.stereo_recording import StereoPair, StereoRecording, TrueObject, read_stereo_recording

SHIPPED_SEED = 4  # of data/room
SOURCES = ("images", "exact_boxes")
MAX_RANGE = 4.0  # m, horizontal: distances are judged below it; chosen
SAME_DIRECTION = np.deg2rad(3.0)  # azimuth within which two observations are of one object; chosen


class PairResult(NamedTuple):
    """The method's result for one pair of panoramas, and the right one."""

    pair: StereoPair
    localization: Localization
    outcome: PoseOutcome
    true_landmarks: tuple[int, ...]  # For every observation the landmark it shows; `NO_OBJECT` for none
    upper_identity: tuple[int, ...]  # For every detection of the upper image the object it shows, likewise
    lower_identity: tuple[int, ...]  # The same for the lower image
    size: tuple[int, int]  # (width, height) of the panoramas, pixels
    seconds: float  # From two images in memory to the pose


def run(
    runner: Runner,
    *,
    seed: int | None,
    poses: int | None,
    data: Path | None,
    detector,
    association: str,
    roll: list[int],
    bearing_only: bool,
) -> Outcome:
    """Run `demo room`: both experiments, from images and from exact boxes. detector: `YoloDetector`."""
    if seed is not None and data is not None:
        raise ValueError(f"--seed {seed} takes new photographs, and --data {data} holds others: give one of the two")
    if 0 in roll:
        raise ValueError("--roll must not be 0: images that are not rolled are the experiment itself")
    matched_by, folder = matcher(association), data or data_path("room")
    if seed not in (None, SHIPPED_SEED):
        folder = runner.temporary
        make_room_data(folder, seed, progress=runner.bar("photographs", "pair"))
    semantic_map = SemanticMap.load(folder / "semantic_map.json")
    experiments, summaries, rolled = {}, {}, {"alike": [], "by_covariance": []}
    for name in ("experiment_1", "experiment_2"):
        recording = read_stereo_recording(folder / name)
        recording, title = replace(recording, pairs=recording.pairs[:poses]), name.replace("_", " ")
        # The paper's method rejects nothing.
        options = {"association": matched_by, "reject_implausible": False}
        localizer = SemanticLocalizer(recording.rig, semantic_map, detector, **options)
        experiments[name], summaries[name] = {}, {}
        for source, ending in zip(SOURCES, ("", "_exact_boxes"), strict=True):
            bar = runner.bar(f"{title}, {source.replace('_', ' ')}", "pose")
            results = experiments[name][source] = run_experiment(recording, localizer, source, bar)
            summaries[name][f"{association}{ending}"] = experiment_summary(results)
            summaries[name][f"{association}_weighted{ending}"] = weighted_summary(results, localizer)
        if roll:
            bar = runner.bar(f"{title}, rolled images", "pose")
            pairs = turn_the_rig(experiments[name]["images"], localizer, roll, bar)
            rolled["alike"] += pairs
            rolled["by_covariance"] += weigh_by_covariance(pairs, localizer)
    result = {"seed": recording.seed, **_summarize(experiments, summaries, semantic_map, recording.rig.baseline)}
    if roll:
        result["rolled_images"] = {name: turn_summary(pairs) for name, pairs in rolled.items()}
    text = tables(result)
    if bearing_only:
        results = [one for by in experiments.values() for one in by["images"]]
        result["bearing_only"] = directions.compared(
            # A pose at both heights is one unit.
            (one.pair.name, one.localization, one.true_landmarks, one.pair.pose, semantic_map.positions)
            for one in results
        )
        text += "\n\n" + directions.bearing_table(result["bearing_only"])
    files = {"room.json": (result, _rows(experiments))}
    return Outcome(result, text, files, "room", (semantic_map, experiments))


def _summarize(experiments: dict, summaries: dict, semantic_map: SemanticMap, baseline: float) -> dict:
    """Return tables 3 to 5 by experiment and association method, and stereo matching and distances over all poses."""
    from_images, from_boxes = ([one for by in experiments.values() for one in by[source]] for source in SOURCES)
    ranges = {
        "exact_boxes": range_errors(from_boxes, semantic_map, baseline, "box_centre"),
        "detected_box_centres": range_errors(from_images, semantic_map, baseline, "box_centre"),
        "akaze_disparities": range_errors(from_images, semantic_map, baseline, "disparity"),
    }
    incorrect = [one for one in from_images if one.outcome.kind == INCORRECT]
    wrong = [len(room_evaluation.wrong_pairs(one.localization, one.true_landmarks)) for one in incorrect]
    used = [len(one.localization.used_pairs) for one in incorrect]
    return {
        "poses": len(from_images) // 2,
        **summaries,
        "stereo_matching": matching_rates(from_images),
        "median_relative_range_error_percent": {
            key: 100.0 * median(errors) if len(errors) else None for key, errors in ranges.items()
        },
        "objects_below_4_m": {key: len(errors) for key, errors in ranges.items()},
        "incorrect_poses": {"median_wrong_pairs": median(wrong), "median_used_pairs": median(used)},
        "seconds_per_pose": median([one.seconds for one in from_images]),
    }


def _rows(experiments: dict[str, dict[str, list[PairResult]]]) -> list[dict]:
    """Return a row for each pose, for a CSV file."""
    return [
        {"experiment": experiment, "source": source, "place": one.pair.name}
        | pose_columns(one.pair.pose, one.localization, one.outcome)
        | {"seconds": round(one.seconds, 3)}
        for experiment, by_source in experiments.items()
        for source, results in by_source.items()
        for one in results
    ]


def pose_columns(true_pose: Sequence[float], found: Localization, judged: PoseOutcome) -> dict:
    """Return columns of a CSV file: the true pose, the estimated one, and its outcome."""
    x, y, theta = map(float, true_pose)
    pose = ("", "", "") if found.pose is None else (round(float(value), 4) for value in found.pose[:3])
    return {
        **{"true_x": round(x, 4), "true_y": round(y, 4), "true_theta": round(theta, 5)},
        **dict(zip(("x", "y", "theta"), pose, strict=True)),
        "outcome": judged.kind,
        "reason": found.reason or "",
        "used_pairs": len(found.used_pairs),
    }


def exact_detections(objects: Sequence[TrueObject], image: np.ndarray) -> tuple[list[Detection], list[int]]:
    """Return what a perfect detector would report of an image `(H, W, 3)` BGR, and the object each detection shows."""
    chosen = [one for one in objects if room_evaluation.counts_as_object(one, image.shape[1])]
    colours = [mean_hue_saturation(image, one.visible_box) for one in chosen]
    detections = [Detection(a.label, 1.0, a.visible_box, *colour) for a, colour in zip(chosen, colours, strict=True)]
    return detections, [one.number for one in chosen]


def localize_pair(pair: StereoPair, localizer: SemanticLocalizer, source: str = "images") -> PairResult:
    """Localize one pair from a source ("images" or "exact_boxes") and judge the result. Source: paper 2, section 3."""
    images = pair.images()
    height, width = images[0].shape[:2]
    start = time.perf_counter()
    if source == "images":
        found = localizer.localize(*images)
        seconds = time.perf_counter() - start
        seen = (found.upper_detections, pair.upper_objects), (found.lower_detections, pair.lower_objects)
        upper, lower = (room_evaluation.identify_detections(*one, width) for one in seen)
    else:
        exact = [exact_detections(*one) for one in zip((pair.upper_objects, pair.lower_objects), images, strict=True)]
        upper, lower = (tuple(numbers) for _, numbers in exact)
        matches = [(i, lower.index(number)) for i, number in enumerate(upper) if number in lower]
        found = localizer.localize_detections(exact[0][0], exact[1][0], matches, (width, height))
        seconds = time.perf_counter() - start
    landmarks = room_evaluation.true_landmarks_of(found, upper, lower, len(localizer.semantic_map))
    judged = outcome(found, pair.pose, landmarks)
    return PairResult(pair, found, judged, landmarks, upper, lower, (width, height), seconds)


def run_experiment(
    recording: StereoRecording, localizer: SemanticLocalizer, source: str = "images", progress: Callable = iter
) -> list[PairResult]:
    """Localize every pair of a recording. Source: paper 2, section 3."""
    return [localize_pair(pair, localizer, source) for pair in progress(recording.pairs)]


def experiment_summary(results: Sequence[PairResult]) -> dict:
    """Return tables 3 to 5 of one experiment (`room_evaluation.summary`)."""
    return summary([result.outcome for result in results])


def fitted_by_covariance(found: Localization, localizer: SemanticLocalizer) -> Localization:
    """Return a localization fitted again (2.6), with each observation weighted by its covariance."""
    weighted = copy(localizer)
    weighted.weighted_fit = True
    return weighted.localize_observations(found.observations) if found.observations else found


def weighted_summary(results: Sequence[PairResult], localizer: SemanticLocalizer) -> dict:
    """Return the `experiment_summary` of the same observations and associations, `fitted_by_covariance`."""
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
    for one in results:
        found = one.localization
        for match, placed in zip(found.matches, found.objects, strict=True):
            number = one.upper_identity[placed.upper]
            if number == NO_OBJECT or one.lower_identity[placed.lower] != number:
                continue
            true, measured = float(np.linalg.norm(semantic_map.positions[number] - one.pair.pose[:2])), np.inf
            boxes = found.upper_detections[placed.upper].box, found.lower_detections[placed.lower].box
            rays = [pixel_to_direction(box_centre(box), *one.size) for box in boxes]
            if distance == "disparity":
                measured = np.nan_to_num(disparity_distance(match, *one.size, baseline).horizontal_range, nan=np.inf)
            elif triangulation_outcome(*rays) == ObjectOutcome.OK:
                measured = float(np.linalg.norm(object_position(*rays, baseline)[:2]))
            if true < MAX_RANGE:
                errors.append(abs(measured - true) / true)
    return np.array(errors)


class RolledPair(NamedTuple):
    """The localizations of one pair as it was, and of the same images, `width` pixels wide, rolled by `columns` k.

    That is the view of a rig turned by 2 pi k / W to the left. The pose moves all the same: a detector shifted by less
    than its stride draws boxes a pixel or two elsewhere, half a metre for an object at 6 m (2.4).
    """

    columns: int
    width: int
    straight: Localization
    rolled: Localization


def turn_the_rig(
    results: Sequence[PairResult], localizer: SemanticLocalizer, columns: Sequence[int], progress: Callable = iter
) -> list[RolledPair]:
    """Localize every pair of an experiment again, with its images rolled by each number of columns."""
    pairs = []
    for result in progress(results):
        images = result.pair.images()
        for k in columns:
            rolled = localizer.localize(*(np.roll(image, k, axis=1) for image in images))
            pairs.append(RolledPair(k, result.size[0], result.localization, rolled))
    return pairs


def weigh_by_covariance(pairs: Sequence[RolledPair], localizer: SemanticLocalizer) -> list[RolledPair]:
    """Return the same pairs, both poses `fitted_by_covariance`."""
    return [RolledPair(*pair[:2], *(fitted_by_covariance(one, localizer) for one in pair[2:])) for pair in pairs]


def compare(pair: RolledPair) -> tuple[bool, float, float]:
    """Return how far rolling the images moved the pose: (agree, metres, radians), NaN without both poses.

    agree: the same objects, recognized by their directions, were taken for the same landmarks.
    """
    columns, width, straight, rolled = pair
    angle = 2 * np.pi * columns / width
    if straight.pose is None or rolled.pose is None:
        return False, np.nan, np.nan
    before, after = (
        {landmark: np.arctan2(one.observations[i].y, one.observations[i].x) for i, landmark in one.used_pairs}
        for one in (straight, rolled)
    )
    turns = [wrap_angle(after.get(landmark, np.nan) - before[landmark] + angle) for landmark in before]
    agree = before.keys() == after.keys() and all(abs(turn) < SAME_DIRECTION for turn in turns)
    moved = float(np.hypot(rolled.pose.x - straight.pose.x, rolled.pose.y - straight.pose.y))
    return agree, moved, float(abs(wrap_angle(rolled.pose.theta - straight.pose.theta - angle)))


def turn_summary(pairs: Sequence[RolledPair]) -> dict:
    """Return how many of many pairs agree, and how far the pose of those moved and turned."""
    agreeing = np.array([(metres, radians) for agree, metres, radians in map(compare, pairs) if agree]).reshape(-1, 2)
    moved, turned = agreeing[:, 0], np.rad2deg(agreeing[:, 1])
    return {
        "columns": sorted({pair.columns for pair in pairs}),
        "n": len(pairs),
        "associations_agree": len(agreeing),
        "median_moved_m": median(moved),
        "greatest_moved_m": float(moved.max()) if len(moved) else None,
        "within_0.10_m": int((moved <= 0.10).sum()),
        "median_turned_deg": median(turned),
        "greatest_turned_deg": float(turned.max()) if len(turned) else None,
    }
