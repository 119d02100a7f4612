"""The poses of both experiments: those from exact boxes, the stored ones with their tables, and why poses fail."""

import csv
import functools
import json
from collections import Counter
from typing import NamedTuple

import numpy as np

from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.semantic_map.association import Observation, penalty
from courseware.experiments import room_evaluation
from courseware.experiments.room import PairResult, run_experiment
from courseware.lessons.kit.room_data import in_body_frame, room_map, room_recording
from courseware.paths import data_path

NAMES = {"images": "ours, from images", "exact_boxes": "ours, exact boxes"}
CURES = ("true places", "true colours", "true centroid")
"""What a failing pose is given in place of its measurement, one at a time."""


@functools.cache
def exact_results(experiment: int) -> list[PairResult]:
    """Return all 20 poses from exact boxes."""
    recorded = room_recording(experiment)
    localizer = SemanticLocalizer(recorded.rig, room_map(), reject_implausible=False)
    return run_experiment(recorded, localizer, "exact_boxes")


class StoredRoom(NamedTuple):
    """One seed of the experiment, as `demo room --seed N` wrote it: tables 3 to 5, and a row for every pose."""

    seed: int
    summary: dict
    rows: list[dict]

    def outcomes(self, experiment: int, source: str) -> dict[str, str]:
        """Return name of the pose, such as "06_a" -> "correct", "incorrect" or "unable"."""
        wanted = (f"experiment_{experiment}", source)
        return {row["place"]: row["outcome"] for row in self.rows if (row["experiment"], row["source"]) == wanted}


def stored_rooms() -> list[StoredRoom]:
    """Return all seeds of data/room/results."""
    found = []
    for path in sorted(data_path("room/results").glob("seed_*.json")):
        rows = list(csv.DictReader(path.with_suffix(".csv").read_text("utf-8").splitlines()))
        found.append(StoredRoom(int(path.stem[5:]), json.loads(path.read_text("utf-8")), rows))
    return found


def failing_places(runs: list[StoredRoom], experiment: int) -> dict[str, int]:
    """Return pose -> in how many seeds it was not correct from images, the most frequent first."""
    found = [one for run in runs for one in run.outcomes(experiment, "images").items()]
    counts = Counter(place for place, kind in found if kind != "correct")
    return dict(sorted(counts.items(), key=lambda item: (-item[1], item[0])))


def tables(runs: list[StoredRoom], experiment: int, source: str) -> list[dict]:
    """Return the rates, and the errors of "all", "correct" and "incorrect" poses, of every seed."""
    key = {"images": "greedy", "exact_boxes": "greedy_exact_boxes"}[source]
    return [run.summary[f"experiment_{experiment}"][key] for run in runs]


def rates(runs: list[StoredRoom], experiment: int, source: str) -> np.ndarray:
    """Return correct, incorrect and unable of every seed, percent `(S, 3)`."""
    found = tables(runs, experiment, source)
    return np.array([[table[f"{kind}_percent"] for kind in room_evaluation.KINDS] for table in found])


def errors(runs: list[StoredRoom], experiment: int, source: str, kind: str) -> np.ndarray:
    """Return a row of table 3 or 4 `(6,)`: the median over the seeds that have poses of this kind."""
    found = [table[kind] for table in tables(runs, experiment, source)]
    return np.median([[one[key] for key in room_evaluation.ERRORS] for one in found if one["n"]], axis=0)


def table_5(runs: list[StoredRoom]) -> str:
    """Return the paper's table 5 and ours: percent of the poses, the median over the seeds and their range."""
    lines = [("% of the poses", room_evaluation.KINDS)]
    for experiment, paper in room_evaluation.PAPER_TABLE_5.items():
        lines.append((f"experiment {experiment}, paper", [f"{value:.0f}" for value in paper.values()]))
        for source, name in NAMES.items():
            found = rates(runs, experiment, source).T
            cells = [f"{np.median(values):.0f} ({values.min():.0f}-{values.max():.0f})" for values in found]
            lines.append((f"experiment {experiment}, {name}", cells))
    return "\n".join(f"{name:36}" + "".join(f"{cell:>15}" for cell in cells) for name, cells in lines)


def table_3_or_4(runs: list[StoredRoom], experiment: int) -> str:
    """Return table 3 (experiment 1) or 4 (experiment 2): the paper's rows, and ours as medians over the seeds."""
    line = "{:31}{:>8} {:>8} {:>12} {:>7} {:>7} {:>10}"
    lines = [line.format("", "mean dx", "mean dy", "mean dtheta", "std x", "std y", "std theta")]
    lines.append(line.format("", "[m]", "[m]", "[deg]", "[m]", "[m]", "[deg]"))
    paper = (room_evaluation.PAPER_TABLE_3, room_evaluation.PAPER_TABLE_4)[experiment - 1]
    for kind in ("all", "correct", "incorrect"):
        ours = {name: errors(runs, experiment, source, kind) for source, name in NAMES.items()}
        for name, values in {"paper": paper[kind].values(), **ours}.items():
            cells = [f"{value:.{digits}f}" for value, digits in zip(values, (2, 2, 1, 2, 2, 1), strict=True)]
            lines.append(line.format(f"{name}: {kind}", *cells))
    return "\n".join(lines)


def thinned(result: PairResult, keep: np.ndarray, localizer: SemanticLocalizer) -> PairResult:
    """Return the pose from the observations `keep` alone, judged by table 2."""
    found = localizer.localize_observations([result.localization.observations[index] for index in keep])
    landmarks = tuple(result.true_landmarks[index] for index in keep)
    judged = room_evaluation.outcome(found, result.pair.pose, landmarks)
    return result._replace(localization=found, true_landmarks=landmarks, outcome=judged)


def randomly_thinned(results: list[PairResult], localizer: SemanticLocalizer, share_seen: float) -> list[PairResult]:
    """Return every pose four times, each of its objects seen with probability `share_seen`, by itself."""
    rng = np.random.default_rng(1)
    four = ((one, rng.random(len(one.true_landmarks))) for one in results for _ in range(4))
    return [thinned(one, np.flatnonzero(drawn < share_seen), localizer) for one, drawn in four]


def is_matched_rightly(result: PairResult, cure: str | None = None) -> bool:
    """Return whether eq. (1) and the greedy search give every pair of like classes rightly, with one of `CURES`.

    Every observation must show a landmark, as exact boxes do. "true places": each object where the map has it. "true
    colours": the map's own. "true centroid": the map's, as if every object had been seen.
    """
    room, shown, pose = room_map(), list(result.true_landmarks), result.pair.pose
    seen = zip(*(one[:5] for one in result.localization.observations), strict=True)
    labels, x, y, hues, saturations = (np.array(column) for column in seen)
    places = in_body_frame(room.positions[shown], pose) if cure == "true places" else np.column_stack([x, y])
    if cure == "true colours":
        hues, saturations = room.hues[shown], room.saturations[shown]
    centroid = in_body_frame(room.centroid, pose) if cure == "true centroid" else places.mean(axis=0)
    rows = Observation(*(column[:, None] for column in (labels, *places.T, hues, saturations)))
    columns = Observation(np.array(room.labels), *room.positions.T, room.hues, room.saturations)
    cost, is_right = penalty(rows, columns, centroid, room.centroid).total, True
    for _ in range(min(cost.shape)):  # the greedy search: the cheapest open pair, until a side is used up
        i, j = np.unravel_index(np.argmin(cost), cost.shape)
        is_right &= shown[i] == j or labels[i] != room.labels[j]
        cost[i], cost[:, j] = np.inf, np.inf
    return bool(is_right)


def failures(result: PairResult) -> list[str]:
    """Return what went wrong with one pose, a line each: which observation was taken for which landmark."""
    room, lines = room_map(), []
    for observation, landmark, shown in room_evaluation.wrong_pairs(result.localization, result.true_landmarks):
        label, (x, y) = result.localization.observations[observation].label, room.positions[landmark]
        truth = "the {} at ({:.1f}, {:.1f})".format(room.labels[shown], *room.positions[shown])
        truth = "nothing" if shown == room_evaluation.NO_OBJECT else truth
        lines.append(f"the {label} that shows {truth} was taken for the one at ({x:.1f}, {y:.1f})")
    return lines
