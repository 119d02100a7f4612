"""Run paper 2's room experiment in randomly generated rooms of look-alikes; print rates and errors with intervals.

Poses of one room are not independent, because all of them see the same look-alikes. So beside the 95 % interval of a
share of independent poses (Wilson's) stands one that draws whole rooms (bootstrap). Where it is wider, believe it.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby, product
from typing import NamedTuple

import numpy as np

from course_lib.experiments.intervals import share_intervals, wilson_percent
from course_lib.experiments.look_alikes import answer_tables, answers_summary
from course_lib.experiments.observed_rooms import Network, room_record, stored_map, stored_observations, views_record
from course_lib.experiments.paper_tables import PAPER_TABLE_3, PAPER_TABLE_4, PAPER_TABLE_5
from course_lib.experiments.room import SOURCES, pose_columns
from course_lib.experiments.room_evaluation import (
    CORRECT,
    INCORRECT,
    NO_OBJECT,
    UNABLE,
    PoseOutcome,
    outcome,
    summary,
    wrong_pairs,
)
from course_lib.experiments.runner import Outcome, Runner
from course_lib.simulation.room.measurement_places import CAMERA_HEIGHTS
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.panorama import StereoRig
from course_lib.spherical_stereo.pose.localization import Localization

MAX_TILT_DEG = 10.0  # of the lower camera: beyond it no pair of images matches
KINDS = (CORRECT, INCORRECT, UNABLE)
# What is done with the observations: options of SemanticLocalizer. The first is the paper's method.
METHODS: dict[str, dict] = {
    "paper": {"reject_implausible": False},
    "weighted_fit": {"weighted_fit": True, "reject_implausible": False},
    "library": {"reject_implausible": True},
    "as_printed": {"distance_term": "as_printed", "reject_implausible": False},
}
PAPER = {1: PAPER_TABLE_3, 2: PAPER_TABLE_4}
PAPER_POSES = 20
WORDS = {
    "images": "images",
    "exact_boxes": "exact boxes",
    "paper": "the paper's fit",
    "as_printed": "eq. (1) as printed",
    "weighted_fit": "weighted_fit",
    "library": "implausible rejected",
}
ERRORS, WIDTHS = ("dx_m", "dy_m", "dtheta_deg"), (16, 16, 18)
ERRORS_HEAD = f"{'n':>5}{'dx [m]':>16}{'dy [m]':>16}{'dtheta [deg]':>18}"


class JudgedPose(NamedTuple):
    """One pose of one room, localized and judged."""

    seed: int
    experiment: int
    name: str
    source: str
    method: str
    pose: tuple[float, float, float]
    localization: Localization
    outcome: PoseOutcome
    true_landmarks: tuple[int, ...]


def run(
    runner: Runner,
    *,
    seeds: list[int],
    poses: int,
    tilts: list[float],
    association: list[str],
    views: int,
    view_poses: int | None,
    ablation: bool,
    network: Network,
) -> Outcome:
    """Run `demo rooms`: the rooms that are missing, also tilted and with further views where asked, then tables."""
    for tilt in tilts:
        if not 0 <= tilt <= MAX_TILT_DEG:
            raise ValueError(f"--tilts must be between 0 and {MAX_TILT_DEG:g} degrees; got {tilt:g}")
    view_poses = poses if view_poses is None else view_poses
    if views < 1 or not 1 <= view_poses <= poses:
        raise ValueError(
            f"--views must be at least 1, and --view-poses between 1 and --poses ({poses}); "
            f"got {views} and {view_poses}"
        )
    if "consistent" not in association and (views > 1 or ablation):
        raise ValueError("--views above 1 and --ablation are of the consistent matcher: name it with --association")

    def rooms_of(tilt: float | None, name: str) -> list[dict]:
        common = {"poses": poses, "network": list(network), "tilt_deg": tilt}
        return runner.rows(room_record, [{"seed": seed, **common} for seed in seeds], name, "room")

    rooms, further = rooms_of(None, "rooms"), None
    judged = judge_rooms(rooms)
    result = rooms_summary(rooms, judged)
    if views > 1:
        common = {"poses": view_poses, "network": list(network), "views": views}
        further = runner.rows(views_record, [{"seed": seed, **common} for seed in seeds], "views", "room")
    bar = runner.bar("matching", "room")
    result["answers"] = answers_summary(rooms, association, further, ablation, bar)
    for tilt in tilts:
        tilted = rooms_of(tilt, "rooms_tilted")
        result.setdefault("tilts", {})[f"{tilt:g}"] = rooms_summary(tilted, judge_rooms(tilted))["both"]
    text = f"{tables(result)}\n\n{answer_tables(result['answers'])}"
    text += "\n\n" + tilt_table(result["tilts"]) if tilts else ""
    files, curve = {"rooms.json": (result, pose_rows(judged))}, result["answers"].get("risk_coverage")
    return Outcome(result, text, files, "risk_coverage" if curve else "", curve)


def judge_rooms(rooms: Sequence[dict]) -> list[JudgedPose]:
    """Every pose of every room, from both sources, by every method. Source: paper 2, sections 2.5, 2.6 and table 2."""
    judged = []
    for room in rooms:
        semantic_map = stored_map(room)
        # The observations are made: of the rig nothing is asked any more.
        localizers = {
            name: SemanticLocalizer(StereoRig(0.3), semantic_map, **options) for name, options in METHODS.items()
        }
        for pose in room["poses"]:
            for source in SOURCES:
                observations = stored_observations(pose["sources"][source])
                truth = tuple(pose["sources"][source]["true_landmarks"])
                for method, localizer in localizers.items():
                    found = localizer.localize_observations(observations)
                    where = (room["seed"], pose["experiment"], pose["name"], source, method, tuple(pose["pose"]))
                    judged.append(JudgedPose(*where, found, outcome(found, pose["pose"], truth), truth))
    return judged


def rooms_summary(rooms: Sequence[dict], judged: Sequence[JudgedPose]) -> dict:
    """Tables of many rooms: by experiment (1, 2: the heights; both), source and method; and what lies behind them."""
    tables: dict = {"experiment_1": {}, "experiment_2": {}, "both": {}}
    for experiment, source, method in product(tables, SOURCES, METHODS):
        numbers = (1, 2) if experiment == "both" else (int(experiment[-1]),)
        own = [one for one in judged if _belongs(one, numbers, source, method)]
        tables[experiment].setdefault(source, {})[method] = rates_and_errors(own)
    poses = [pose for room in rooms for pose in room["poses"]]
    sizes, alike = [len(room["map"]) for room in rooms], {}
    for room in sorted(rooms, key=lambda room: room["look_alike"]["label"]):
        alike.setdefault(room["look_alike"]["label"], []).append(room["look_alike"]["n"])
    counts = {key: sum(pose[key] for pose in poses) for key in ("objects", "found", "detections")}
    return {
        "seeds": [room["seed"] for room in rooms],
        "rooms": len(rooms),
        "poses_a_room_and_height": len(rooms[0]["poses"]) // 2,
        "look_alikes": alike,
        "objects_a_room": {"least": min(sizes), "median": float(np.median(sizes)), "most": max(sizes)},
        "detector": counts
        | {
            "precision": counts["found"] / counts["detections"] if counts["detections"] else None,
            "recall": counts["found"] / counts["objects"] if counts["objects"] else None,
        },
        "wrong_pairs": wrong_pair_causes(rooms, judged),
        "seconds_per_pose": float(np.median([pose["seconds"] for pose in poses])),
        **tables,
    }


def rates_and_errors(judged: Sequence[JudgedPose]) -> dict:
    """`room_evaluation.summary` with 95 % intervals of the three shares, over poses and over rooms, in percent."""
    found = summary([one.outcome for one in judged])
    seeds = np.array([one.seed for one in judged])
    for kind in KINDS:
        found |= share_intervals(kind, np.array([one.outcome.kind == kind for one in judged]), seeds)
    return found


def wrong_pair_causes(rooms: Sequence[dict], judged: Sequence[JudgedPose]) -> dict:
    """The wrong pairs of the paper's method by source: how many poses have one, and between what they confuse.

    look_alikes: an object of the look-alike class was taken for another of them. others: two other objects of one
    class. nothing: a detection of nothing, or of two objects at once.
    """
    alike = {room["seed"]: room["look_alike"]["label"] for room in rooms}
    causes = {}
    for source in SOURCES:
        found = {"poses": 0, "look_alikes": 0, "others": 0, "nothing": 0}
        for one in judged:
            if not _belongs(one, (1, 2), source, next(iter(METHODS))):
                continue
            wrong = wrong_pairs(one.localization, one.true_landmarks)
            found["poses"] += bool(wrong)
            for observation, _, shown in wrong:
                label = one.localization.observations[observation].label
                cause = "nothing" if shown == NO_OBJECT else "look_alikes" if label == alike[one.seed] else "others"
                found[cause] += 1
        causes[source] = found
    return causes


def pose_rows(judged: Sequence[JudgedPose]) -> list[dict]:
    """A row for the CSV for every judged pose."""
    return [
        {
            "seed": one.seed,
            "experiment": one.experiment,
            "pose": one.name,
            "source": one.source,
            "method": one.method,
            **pose_columns(one.pose, one.localization, one.outcome),
        }
        for one in judged
    ]


def _belongs(one: JudgedPose, experiments: tuple[int, ...], source: str, method: str) -> bool:
    return one.experiment in experiments and (one.source, one.method) == (source, method)


def tables(summary: dict) -> str:
    """Everything about the rooms, the paper's numbers beside ours."""
    seeds, alike, objects = summary["seeds"], summary["look_alikes"], summary["objects_a_room"]
    kinds = ", ".join(f"{min(counts)} to {max(counts)} {label}s in {len(counts)}" for label, counts in alike.items())
    lines = [
        f"{summary['rooms']} rooms (seeds {_ranges(seeds)}), {summary['poses_a_room_and_height']} poses at each height",
        f"Objects a room: {objects['least']} to {objects['most']}, median {objects['median']:g}",
        f"Look-alikes: {kinds}",
        "",
        "Share of poses [%], with 95 % intervals: (over poses, as if independent; over rooms, by bootstrap)",
        f"{'':42}{'correct':>31}{'incorrect':>31}{'unable':>31}",
    ]
    for number, (upper, lower) in CAMERA_HEIGHTS.items():
        lines.append(f"Cameras at {upper:.2f} and {lower:.2f} m")
        lines.append(f"  {f'paper, {PAPER_POSES} poses':40}" + "".join(_paper_share(number, kind) for kind in KINDS))
        lines += [f"  {name:40}{_shares(values)}" for name, values in _rows(summary[f"experiment_{number}"])]
    lines.append("Both heights")
    lines += [f"  {name:40}{_shares(values)}" for name, values in _rows(summary["both"])]
    lines += ["", "Absolute errors: median (mean)".ljust(42) + ERRORS_HEAD]
    for number, (upper, lower) in CAMERA_HEIGHTS.items():
        for kind in ("correct", "all"):
            lines.append(f"Cameras at {upper:.2f} and {lower:.2f} m, {kind} poses")
            paper = PAPER[number][kind]
            means = [f"({paper[f'mean_{error}']:.2f})" for error in ERRORS]
            lines.append(f"  {'paper':45}" + "".join(f"{mean:>{w}}" for mean, w in zip(means, WIDTHS, strict=True)))
            lines += [f"  {name:40}{_errors(v[kind])}" for name, v in _rows(summary[f"experiment_{number}"])]
    return "\n".join([*lines, "", *_behind(summary)])


def tilt_table(tilts: dict) -> str:
    """Rates and errors over the relative tilt of the two cameras; both heights together."""
    lines = [
        "Lower camera tilted against the upper one, both heights",
        f"{'':42}{'correct [%]':>12}{'incorrect':>11}{'unable':>8}",
    ]
    for tilt, by_source in tilts.items():
        lines.append(f"{tilt} degrees")
        for name, values in _rows(by_source):
            shares = zip(KINDS, (12, 11, 8), strict=True)
            lines.append(f"  {name:40}" + "".join(f"{values[f'{kind}_percent']:{width}.1f}" for kind, width in shares))
    for kind in ("correct", "all"):
        lines.append(f"Absolute errors of {kind} poses: median (mean)".ljust(42) + ERRORS_HEAD)
        for tilt, by_source in tilts.items():
            lines.append(f"{tilt} degrees")
            lines += [f"  {name:40}{_errors(values[kind])}" for name, values in _rows(by_source)]
    return "\n".join(lines)


def _behind(summary: dict) -> list[str]:
    detector = summary["detector"]
    lines = []
    if detector["precision"] is not None and detector["recall"] is not None:
        lines.append(
            f"Detector on these photographs: precision {detector['precision']:.3f}, recall {detector['recall']:.3f} "
            f"({detector['objects']} objects)"
        )
    for source, found in summary["wrong_pairs"].items():
        lines.append(
            f"Wrong pairs from {WORDS[source]}, in {found['poses']} poses: {found['look_alikes']} between look-alikes, "
            f"{found['others']} between other objects of one class, {found['nothing']} with a detection of no object"
        )
    return [*lines, f"{summary['seconds_per_pose']:.2f} s a pose (median), from two images in memory"]


def _rows(by_source: dict) -> list[tuple[str, dict]]:
    return [
        (f"{WORDS[source]}, {WORDS.get(method, method)}", values)
        for source, by_method in by_source.items()
        for method, values in by_method.items()
    ]


def _shares(values: dict) -> str:
    return "".join(
        _share(values[f"{kind}_percent"], values[f"{kind}_wilson_percent"], values[f"{kind}_rooms_percent"])
        for kind in KINDS
    )


def _paper_share(number: int, kind: str) -> str:
    share = PAPER_TABLE_5[number][f"{kind}_percent"]
    return _share(share, wilson_percent(round(share * PAPER_POSES / 100), PAPER_POSES), None)


def _share(share: float, over_poses: list[float], over_rooms: list[float] | None) -> str:
    rooms = f"; {over_rooms[0]:.0f} to {over_rooms[1]:.0f}" if over_rooms else ""
    text = f"{share:.1f} ({over_poses[0]:.0f} to {over_poses[1]:.0f}{rooms})"
    return f"{text:>31}"


def _errors(group: dict) -> str:
    head = f"{group['n']:5d}"
    if not group["n"]:
        return head + f"{'none':>{WIDTHS[0]}}"
    pairs = [f"{group[f'median_{error}']:.3f} ({group[f'mean_{error}']:.3f})" for error in ERRORS]
    return head + "".join(f"{pair:>{width}}" for pair, width in zip(pairs, WIDTHS, strict=True))


def _ranges(seeds: list[int]) -> str:
    """Seeds with their runs joined: 1-5, 8."""
    runs = [[seed for _, seed in run] for _, run in groupby(enumerate(seeds), key=lambda one: one[1] - one[0])]
    return ", ".join(f"{run[0]}-{run[-1]}" if len(run) > 1 else str(run[0]) for run in runs)
