"""The worlds on which a project's last function is graded: drawn by a secret seed, as hard as the hidden ones.

P1 and P4: recordings and cameras of other seeds. P2 and P3: the hidden rooms, each drawn on a map that is turned and
shifted, and seen by a rig that is turned. Distances and angles between things stay, so that every method reaches there
nearly what it reaches in the hidden rooms; a pose learned by heart is wrong.

Points: all where the median is better than the project's line, half where it is better than the paper's
method, a quarter where the function runs in every world. Source of the lines: the rubrics in notebooks/projects.
"""

import dataclasses
from collections.abc import Sequence
from typing import Literal, NamedTuple

import numpy as np

from course_lib.classroom.points import SCORE_POINTS
from course_lib.lessons.kit.projects import Project, Task, find_project, is_better, stored_rivals
from course_lib.spherical_stereo.detection.detected_object import Detection
from course_lib.spherical_stereo.semantic_map.association import Observation
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

WORLDS = 8
"""Recordings or cameras that are drawn; rooms are all taken."""


class Line(NamedTuple):
    """What a project's function must reach for all points, and where the rubric says so."""

    value: float
    words: str


LINES = {
    "P1": Line(70.0, "below 70 mm"),
    "P2": Line(0.154, "better than half of the paper's 0.309 m"),
    "P3": Line(0.0, "above 0 points"),
    "P4": Line(20.0, "below 20 mm"),
}
ROOMS = {"P2": "boxes", "P3": "observations"}


def graded_project(name: str, seed: int) -> Project:
    """The project with the worlds of a secret seed in place of its hidden ones."""
    project = find_project(name)
    if name not in ROOMS:
        drawn = np.random.default_rng(seed).integers(1_000_000, 2**31, WORLDS)
        return dataclasses.replace(project, seeds=tuple(int(one) for one in drawn))
    return dataclasses.replace(
        project, prepare=lambda room: moved(project.prepare(room), ROOMS[name], np.random.default_rng([seed, room]))
    )


def paper_value(project: Project) -> float:
    """The median that the paper's method reaches on the hidden seeds."""
    return float(np.median(stored_rivals(find_project(project.name))["paper"][1]))


def score_points(project: Project, values: Sequence[float]) -> float:
    """Points of a project's function that reached these values."""
    middle, line = float(np.median(values)), LINES[project.name].value
    if np.isfinite(middle) and is_better(project, middle, line):
        return float(SCORE_POINTS)
    if np.isfinite(middle) and is_better(project, middle, paper_value(project)):
        return SCORE_POINTS / 2
    return SCORE_POINTS / 4 if np.isfinite(values).all() else 0.0


def score_sentence(project: Project, values: Sequence[float], failed: int) -> str:
    """What the feedback of a project's score says: its median, how many worlds it failed in, and the line."""
    lost = f"; it failed in {failed} of {len(values)} worlds" if failed else ""
    middle = float(np.median(values))
    reached = f"median {project.told(middle)}" if np.isfinite(middle) else "no median"
    line = (
        f"all points: {LINES[project.name].words}; half: better than the paper's {project.told(paper_value(project))}"
    )
    return f"{reached} over {len(values)} other worlds{lost} ({line})."


def moved(task: Task, seen: Literal["boxes", "observations"], rng: np.random.Generator) -> Task:
    """The calls of one room, on a map that is turned and shifted, by a rig that is turned otherwise in every view.

    seen: what a call holds, boxes of two panoramas or observations in the body frame. The truth is moved with them.
    """
    turn, shift = rng.uniform(-np.pi, np.pi), rng.uniform(-20, 20, 2)
    calls, poses, maps = [], [], {}
    for arguments, pose in zip(task.arguments, task.truth, strict=True):
        semantic_map = arguments[2] if seen == "boxes" else arguments[1]
        there = maps.setdefault(id(semantic_map), moved_map(semantic_map, turn, shift))
        if seen == "boxes":
            upper, lower, _, rig = arguments
            columns = int(rng.integers(0, rig.width))
            heading = 2 * np.pi * columns / rig.width
            sides = ([rolled(one, columns, rig.width) for one in side] for side in (upper, lower))
            calls.append((*sides, there, rig))
        else:
            heading = rng.uniform(-np.pi, np.pi)
            calls.append((tuple(turned(one, -heading) for one in arguments[0]), there))
        x, y = rotation(turn) @ pose[:2] + shift
        poses.append((x, y, wrapped(pose[2] + turn + heading)))
    return Task(tuple(calls), np.array(poses))


def moved_map(semantic_map: SemanticMap, turn: float, shift: np.ndarray) -> SemanticMap:
    """The map turned by `turn` about the origin, then shifted, metres."""

    def there(points: np.ndarray) -> np.ndarray:
        return points @ rotation(turn).T + shift

    landmarks = [
        dataclasses.replace(one, x=float(x), y=float(y))
        for one, (x, y) in zip(semantic_map.landmarks, there(semantic_map.positions), strict=True)
    ]
    walls = None if semantic_map.walls is None else there(np.asarray(semantic_map.walls))
    return SemanticMap(landmarks, walls, semantic_map.name)


def rolled(detection: Detection, columns: int, width: int) -> Detection:
    """A box on a panorama that is rolled by `columns` to the right: the rig's heading grows by 2 pi columns / width."""
    u_min, v_min, u_max, v_max = detection.box
    start = (u_min + columns) % width
    return dataclasses.replace(detection, box=(start, v_min, start + u_max - u_min, v_max))


def turned(observation: Observation, angle: float) -> Observation:
    """An observation turned about the body's upward axis, its covariance too."""
    r = rotation(angle)
    x, y = r @ (observation.x, observation.y)
    covariance = None if observation.covariance is None else r @ observation.covariance @ r.T
    return observation._replace(x=float(x), y=float(y), covariance=covariance)


def rotation(angle: float) -> np.ndarray:
    """(2, 2), counterclockwise."""
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.array([[cosine, -sine], [sine, cosine]])


def wrapped(angle: float) -> float:
    return float((angle + np.pi) % (2 * np.pi) - np.pi)
