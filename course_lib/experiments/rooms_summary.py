"""What the rooms say: map matching and fit on stored observations, judged by table 2, with 95 % intervals.

Poses of one room are not independent, for all of them see the same look-alikes. So beside the 95 % interval of a share
of independent poses (Wilson's) stands one that draws whole rooms (bootstrap): where the second is wider, believe it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.stats import binomtest

from course_lib.experiments.room import SOURCES
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
from course_lib.experiments.rooms import stored_map, stored_observations
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.panorama import StereoRig
from course_lib.spherical_stereo.pose.localization import Localization

KINDS = (CORRECT, INCORRECT, UNABLE)
BOOTSTRAP_DRAWS, BOOTSTRAP_SEED = 10_000, 0
# What is done with the observations: options of SemanticLocalizer. The first is the paper's method.
METHODS: dict[str, dict] = {
    "paper": {"reject_implausible": False},
    "weighted_fit": {"weighted_fit": True, "reject_implausible": False},
    "library": {"reject_implausible": True},
    "as_printed": {"distance_term": "as_printed", "reject_implausible": False},
}


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
                    judged.append(
                        JudgedPose(
                            room["seed"],
                            pose["experiment"],
                            pose["name"],
                            source,
                            method,
                            tuple(pose["pose"]),
                            found,
                            outcome(found, pose["pose"], truth),
                            truth,
                        )
                    )
    return judged


def rooms_summary(rooms: Sequence[dict], judged: Sequence[JudgedPose]) -> dict:
    """Tables of many rooms: by experiment (1, 2: the heights; both), source and method; and what lies behind them."""
    tables = {}
    for experiment, numbers in (("experiment_1", (1,)), ("experiment_2", (2,)), ("both", (1, 2))):
        tables[experiment] = {
            source: {
                method: rates_and_errors([one for one in judged if _is(one, numbers, source, method)])
                for method in METHODS
            }
            for source in SOURCES
        }
    poses = [pose for room in rooms for pose in room["poses"]]
    counts = {key: sum(pose[key] for pose in poses) for key in ("objects", "found", "detections")}
    return {
        "seeds": [room["seed"] for room in rooms],
        "rooms": len(rooms),
        "poses_a_room_and_height": len(rooms[0]["poses"]) // 2,
        "look_alikes": {
            label: [room["look_alike"]["n"] for room in rooms if room["look_alike"]["label"] == label]
            for label in sorted({room["look_alike"]["label"] for room in rooms})
        },
        "objects_a_room": {
            "least": min(len(room["map"]) for room in rooms),
            "median": float(np.median([len(room["map"]) for room in rooms])),
            "most": max(len(room["map"]) for room in rooms),
        },
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
        hits = np.array([one.outcome.kind == kind for one in judged])
        found[f"{kind}_wilson_percent"] = wilson_percent(int(hits.sum()), len(hits))
        by_room = np.array([hits[seeds == seed].mean() for seed in np.unique(seeds)])
        found[f"{kind}_rooms_percent"] = bootstrap_percent(by_room)
    return found


def wilson_percent(hits: int, n: int) -> list[float]:
    """Wilson's 95 % interval of a share, in percent: [low, high]."""
    interval = binomtest(hits, n).proportion_ci(confidence_level=0.95, method="wilson")
    return [100.0 * interval.low, 100.0 * interval.high]


def bootstrap_percent(shares: np.ndarray) -> list[float] | None:
    """95 % interval, in percent, of the mean of one share a room, drawing rooms with replacement; None for one room.

    All rooms have the same number of poses, so that the mean over rooms is the share of all poses.
    """
    if len(shares) < 2:
        return None
    rng = np.random.default_rng(BOOTSTRAP_SEED)
    means = rng.choice(shares, (BOOTSTRAP_DRAWS, len(shares))).mean(axis=1)
    return [100.0 * float(value) for value in np.percentile(means, (2.5, 97.5))]


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
            if not _is(one, (1, 2), source, next(iter(METHODS))):
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
            "true_x": round(one.pose[0], 4),
            "true_y": round(one.pose[1], 4),
            "true_theta": round(one.pose[2], 5),
            **{
                key: "" if one.localization.pose is None else round(float(getattr(one.localization.pose, key)), 4)
                for key in ("x", "y", "theta")
            },
            "outcome": one.outcome.kind,
            "reason": one.localization.reason or "",
            "used_pairs": len(one.localization.used_pairs),
        }
        for one in judged
    ]


def _is(one: JudgedPose, experiments: tuple[int, ...], source: str, method: str) -> bool:
    return one.experiment in experiments and (one.source, one.method) == (source, method)
