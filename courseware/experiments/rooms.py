"""Run paper 2's room experiment in randomly generated rooms of look-alikes; print rates and errors with intervals.

Poses of one room see the same look-alikes. So each share has two 95 %
intervals: Wilson's, for independent poses, and a bootstrap over whole rooms. If the second is wider, believe it.
"""

from collections.abc import Iterator, Sequence
from itertools import groupby, product

import numpy as np

from courseware.experiments import bearing_only as directions
from courseware.experiments import room_evaluation
from courseware.experiments.intervals import share_intervals, wilson_percent
from courseware.experiments.look_alikes import answer_tables, answers_summary
from courseware.experiments.observed_rooms import JudgedPose, judged_poses, observe_room, observe_views, stored_map
from courseware.experiments.room import SOURCES, pose_columns
from courseware.experiments.room_evaluation import KINDS, NO_OBJECT, summary
from courseware.experiments.runner import Outcome, Runner
from courseware.simulation.room.measurement_places import CAMERA_HEIGHTS

MAX_TILT_DEG = 10.0  # of the lower camera: beyond it no pair of images matches
# What is done with the observations: options of SemanticLocalizer. The first is the paper's method.
METHODS: dict[str, dict] = {
    "paper": {"reject_implausible": False},
    "weighted_fit": {"weighted_fit": True, "reject_implausible": False},
    "library": {"reject_implausible": True},
    "as_printed": {"distance_term": "as_printed", "reject_implausible": False},
}
PAPER = {1: room_evaluation.PAPER_TABLE_3, 2: room_evaluation.PAPER_TABLE_4}
PAPER_POSES = 20
WORDS = {
    "images": "images",
    "exact_boxes": "exact boxes",
    "paper": "the paper's fit",
    "as_printed": "eq. (1) as printed",
    "weighted_fit": "weighted_fit",
    "library": "implausible rejected",
}
ERRORS = ("dx_m", "dy_m", "dtheta_deg")
ERRORS_HEAD = f"{'n':>5}{'dx [m]':>16}{'dy [m]':>16}{'dtheta [deg]':>18}"


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
    bearing_only: bool,
    network: list,
) -> Outcome:
    """Run `demo rooms`: the rooms that are missing, also tilted and with further views where asked, then tables."""
    for tilt in tilts:
        if not 0 <= tilt <= MAX_TILT_DEG:
            raise ValueError(f"--tilts must be between 0 and {MAX_TILT_DEG:g} degrees; got {tilt:g}")
    view_poses = poses if view_poses is None else view_poses
    if views < 1 or not 1 <= view_poses <= poses:
        told = f"--views must be at least 1, and --view-poses between 1 and --poses ({poses})"
        raise ValueError(f"{told}; got {views} and {view_poses}")
    if "consistent" not in association and (views > 1 or ablation):
        raise ValueError("--views above 1 and --ablation are of the consistent matcher: name it with --association")

    def kept(function, name: str, **common) -> list:
        return runner.rows(function, [{"seed": seed, "network": network, **common} for seed in seeds], name, "room")

    rooms = kept(observe_room, "rooms", poses=poses, tilt_deg=None)
    judged = list(judged_poses(rooms, rooms, METHODS))
    result = rooms_summary(rooms, judged)
    further = kept(observe_views, "views", poses=view_poses, views=views) if views > 1 else None
    result["answers"] = answers_summary(rooms, association, further, ablation, runner.bar("matching", "room"))
    for tilt in tilts:
        tilted = kept(observe_room, "rooms_tilted", poses=poses, tilt_deg=tilt)
        both = rooms_summary(tilted, list(judged_poses(tilted, tilted, METHODS)))["both"]
        result.setdefault("tilts", {})[f"{tilt:g}"] = both
    text = f"{tables(result)}\n\n{answer_tables(result['answers'])}"
    text += "\n\n" + tilt_table(result["tilts"]) if tilts else ""
    if bearing_only:
        result["bearing_only"] = directions.compared(_poses_from_images(rooms, judged))
        text += "\n\n" + directions.bearing_table(result["bearing_only"])
    names, curve = ("seed", "experiment", "pose", "source", "method"), result["answers"].get("risk_coverage")
    rows = [
        dict(zip(names, one[:5], strict=True)) | pose_columns(one.pose, one.localization, one.outcome) for one in judged
    ]
    return Outcome(result, text, {"rooms.json": (result, rows)}, "risk_coverage" if curve else "", curve)


def _poses_from_images(rooms: Sequence[dict], judged: Sequence[JudgedPose]) -> Iterator[tuple]:
    """Yield what `bearing_only.compared` asks of every pose; a room is a unit."""
    positions = {room["seed"]: stored_map(room).positions for room in rooms}
    for one in judged:
        if (one.source, one.method) == ("images", "paper"):
            yield one.seed, one.localization, one.true_landmarks, one.pose, positions[one.seed]


def rooms_summary(rooms: Sequence[dict], judged: Sequence[JudgedPose]) -> dict:
    """Return tables of many rooms by experiment (1, 2: the heights; both), source and method, and their background."""
    tables: dict = {"experiment_1": {}, "experiment_2": {}, "both": {}}
    for experiment, source, method in product(tables, SOURCES, METHODS):
        own = [one for one in judged if (one.source, one.method) == (source, method)]
        own = [one for one in own if experiment in ("both", f"experiment_{one.experiment}")]
        tables[experiment].setdefault(source, {})[method] = rates_and_errors(own)
    poses = [pose for room in rooms for pose in room["poses"]]
    sizes, alike = [len(room["map"]) for room in rooms], {}
    for room in sorted(rooms, key=lambda room: room["look_alike"]["label"]):
        alike.setdefault(room["look_alike"]["label"], []).append(room["look_alike"]["n"])
    counts = {key: sum(pose[key] for pose in poses) for key in ("objects", "found", "detections")}
    shares = {"precision": "detections", "recall": "objects"}
    shares = {name: counts["found"] / counts[of] if counts[of] else None for name, of in shares.items()}
    return {
        "seeds": [room["seed"] for room in rooms],
        "rooms": len(rooms),
        "poses_a_room_and_height": len(rooms[0]["poses"]) // 2,
        "look_alikes": alike,
        "objects_a_room": {"least": min(sizes), "median": float(np.median(sizes)), "most": max(sizes)},
        "detector": counts | shares,
        "wrong_pairs": wrong_pair_causes(rooms, judged),
        "seconds_per_pose": float(np.median([pose["seconds"] for pose in poses])),
        **tables,
    }


def rates_and_errors(judged: Sequence[JudgedPose]) -> dict:
    """Return `room_evaluation.summary` with 95 % intervals of the three shares, over poses and over rooms, percent."""
    found = summary([one.outcome for one in judged])
    seeds = np.array([one.seed for one in judged])
    for kind in KINDS:
        found |= share_intervals(kind, np.array([one.outcome.kind == kind for one in judged]), seeds)
    return found


def wrong_pair_causes(rooms: Sequence[dict], judged: Sequence[JudgedPose]) -> dict:
    """Count the paper's wrong pairs: poses that have one, and what was mixed up (nothing: no object, or two)."""
    alike = {room["seed"]: room["look_alike"]["label"] for room in rooms}
    causes = {source: {"poses": 0, "look_alikes": 0, "others": 0, "nothing": 0} for source in SOURCES}
    for one in (one for one in judged if one.method == "paper"):
        wrong, found = room_evaluation.wrong_pairs(one.localization, one.true_landmarks), causes[one.source]
        found["poses"] += bool(wrong)
        for observation, _, shown in wrong:
            label = one.localization.observations[observation].label
            found["nothing" if shown == NO_OBJECT else "look_alikes" if label == alike[one.seed] else "others"] += 1
    return causes


def tables(summary: dict) -> str:
    """Return the text about the rooms, with the paper's numbers next to ours."""
    alike, objects, heights = summary["look_alikes"], summary["objects_a_room"], CAMERA_HEIGHTS.items()
    by_run = groupby(enumerate(summary["seeds"]), key=lambda one: one[1] - one[0])
    runs = [[seed for _, seed in run] for _, run in by_run]  # Seeds with their runs joined: 1-5, 8.
    seeds = ", ".join(f"{run[0]}-{run[-1]}" if len(run) > 1 else str(run[0]) for run in runs)
    kinds = ", ".join(f"{min(counts)} to {max(counts)} {label}s in {len(counts)}" for label, counts in alike.items())
    lines = [
        f"{summary['rooms']} rooms (seeds {seeds}), {summary['poses_a_room_and_height']} poses at each height",
        f"Objects a room: {objects['least']} to {objects['most']}, median {objects['median']:g}",
        f"Look-alikes: {kinds}",
        "",
        "Share of poses [%], with 95 % intervals: (over poses, as if independent; over rooms, by bootstrap)",
        f"{'':42}{'correct':>31}{'incorrect':>31}{'unable':>31}",
    ]
    for number, (upper, lower) in heights:
        lines += [
            f"Cameras at {upper:.2f} and {lower:.2f} m",
            _row(f"paper, {PAPER_POSES} poses", _paper_shares(number)),
        ]
        lines += _rows(summary[f"experiment_{number}"], _shares)
    lines += ["Both heights", *_rows(summary["both"], _shares)]
    lines += ["", "Absolute errors: median (mean)".ljust(42) + ERRORS_HEAD]
    for (number, (upper, lower)), kind in product(heights, ("correct", "all")):
        means = [f"({PAPER[number][kind][f'mean_{error}']:.2f})" for error in ERRORS]
        lines += [f"Cameras at {upper:.2f} and {lower:.2f} m, {kind} poses", _row("paper", " " * 5 + _errors(means))]
        lines += _rows(summary[f"experiment_{number}"], _group, kind)
    precision, recall, n = (summary["detector"][name] for name in ("precision", "recall", "objects"))
    lines.append("")
    if precision is not None and recall is not None:
        lines.append(f"Detector on these photographs: precision {precision:.3f}, recall {recall:.3f} ({n} objects)")
    lines += [
        f"Wrong pairs from {WORDS[source]}, in {found['poses']} poses: {found['look_alikes']} between look-alikes, "
        f"{found['others']} between other objects of one class, {found['nothing']} with a detection of no object"
        for source, found in summary["wrong_pairs"].items()
    ]
    return "\n".join([*lines, f"{summary['seconds_per_pose']:.2f} s a pose (median), from two images in memory"])


def tilt_table(tilts: dict) -> str:
    """Return a table of rates and errors over the relative tilt of the two cameras, both heights together."""
    lines = [
        "Lower camera tilted against the upper one, both heights",
        f"{'':42}{'correct [%]':>12}{'incorrect':>11}{'unable':>8}",
    ]
    for tilt, by_source in tilts.items():
        lines += [f"{tilt} degrees", *_rows(by_source, _rates)]
    for kind in ("correct", "all"):
        lines.append(f"Absolute errors of {kind} poses: median (mean)".ljust(42) + ERRORS_HEAD)
        for tilt, by_source in tilts.items():
            lines += [f"{tilt} degrees", *_rows(by_source, _group, kind)]
    return "\n".join(lines)


def _row(name: str, cells: str) -> str:
    return f"  {name:40}{cells}"


def _rows(by_source: dict, cells_of, *which: str) -> list[str]:
    """Return one row for each source and method: its name and its formatted numbers."""
    return [
        _row(f"{WORDS[source]}, {WORDS[method]}", cells_of(values, *which))
        for source, by_method in by_source.items()
        for method, values in by_method.items()
    ]


def _rates(values: dict) -> str:
    return "{:12.1f}{:11.1f}{:8.1f}".format(*(values[f"{kind}_percent"] for kind in KINDS))


def _shares(values: dict) -> str:
    """Return every kind's share with its intervals over poses and, if there are several rooms, over rooms."""
    texts = []
    for kind in KINDS:
        both = values[f"{kind}_wilson_percent"], values[f"{kind}_rooms_percent"]
        intervals = "; ".join(f"{low:.0f} to {high:.0f}" for low, high in filter(None, both))
        texts.append(f"{values[f'{kind}_percent']:.1f} ({intervals})")
    return "".join(f"{text:>31}" for text in texts)


def _paper_shares(number: int) -> str:
    values = dict(room_evaluation.PAPER_TABLE_5[number])
    for kind in KINDS:
        hits = round(values[f"{kind}_percent"] * PAPER_POSES / 100)
        values |= {f"{kind}_wilson_percent": wilson_percent(hits, PAPER_POSES), f"{kind}_rooms_percent": None}
    return _shares(values)


def _group(values: dict, kind: str) -> str:
    """Return the number of poses of a kind, and their errors."""
    group = values[kind]
    if not group["n"]:
        return f"{0:5d}{'none':>16}"
    texts = [f"{group[f'median_{error}']:.3f} ({group[f'mean_{error}']:.3f})" for error in ERRORS]
    return f"{group['n']:5d}" + _errors(texts)


def _errors(texts: Sequence[str]) -> str:
    return "{:>16}{:>16}{:>18}".format(*texts)
