"""The worlds on which a project's last function is graded: drawn by a secret seed, as hard as the hidden ones.

P1 and P4: recordings and cameras of other seeds. P2 and P3: the hidden rooms, each drawn on a map that is turned and
shifted, and seen by a rig that is turned. Distances and angles between things stay, so that every method reaches there
nearly what it reaches in the hidden rooms; a pose learned by heart is wrong.

Points: all where the median is better than the project's line, half where it is better than the paper's
method, a quarter where the function runs in every world. Source of the lines: the rubrics in notebooks/projects.
"""

import dataclasses
from collections.abc import Sequence
from typing import Literal

import numpy as np

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.detection.detected_object import Detection, wrapped_box
from course_lib.spherical_stereo.pose.rigid_fit import rotation_2d
from course_lib.spherical_stereo.semantic_map.association import Observation
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap
from courseware.classroom.points import SCORE_POINTS, secret
from courseware.lessons.kit.projects import Project, Task, find_project, is_better, stored_rivals

WORLDS = 8
"""Recordings or cameras that are drawn; rooms are all taken."""
LINES = {
    "P1": (70.0, "below 70 mm"),
    "P2": (0.154, "better than half of the paper's 0.309 m"),
    "P3": (0.0, "above 0 points"),
    "P4": (20.0, "below 20 mm"),
}
"""What a median must be better than for all points, and the rubric's words for it."""
ROOMS = {"P2": "boxes", "P3": "observations"}


def graded_project(name: str, seed: int) -> Project:
    """Return the project with the worlds of a secret seed in place of its hidden ones."""
    project = find_project(name)
    if name in ROOMS:
        return dataclasses.replace(
            project, prepare=lambda room: moved(project.prepare(room), ROOMS[name], np.random.default_rng([seed, room]))
        )

    def prepare(world: int) -> Task:
        task = project.prepare(world)
        # From the task's own generator a function could read the world's seed, and so compute the truth.
        other = np.random.default_rng(secret(seed, f"rng of {world}"))
        given = (other if isinstance(one, np.random.Generator) else one for one in task.arguments)
        return task._replace(arguments=tuple(given))

    # There are too many seeds to find a world's seed by trial.
    seeds = tuple(np.random.default_rng(seed).integers(1 << 62, (1 << 63) - 1, WORLDS).tolist())
    return dataclasses.replace(project, seeds=seeds, prepare=prepare)


def paper_value(project: Project) -> float:
    """Return the median that the paper's method reaches on the hidden seeds."""
    return float(np.median(stored_rivals(find_project(project.name))["paper"][1]))


def score_points(project: Project, values: Sequence[float]) -> float:
    """Return the points of a project's function that reached these values."""
    middle = float(np.median(values))
    for line, share in ((LINES[project.name][0], 1), (paper_value(project), 2)):
        if np.isfinite(middle) and is_better(project, middle, line):
            return SCORE_POINTS / share
    return SCORE_POINTS / 4 if np.isfinite(values).all() else 0.0


def score_sentence(project: Project, values: Sequence[float], failed: int) -> str:
    """Return the feedback on a project's score: its median, the number of worlds in which it failed, and the lines."""
    lost = f"; it failed in {failed} of {len(values)} worlds" if failed else ""
    middle = float(np.median(values))
    reached = f"median {project.told(middle)}" if np.isfinite(middle) else "no median"
    line = f"all points: {LINES[project.name][1]}; half: better than the paper's {project.told(paper_value(project))}"
    return f"{reached} over {len(values)} other worlds{lost} ({line})."


def moved(task: Task, seen: Literal["boxes", "observations"], rng: np.random.Generator) -> Task:
    """Turn and shift a room's map, and turn the rig in each view by another angle. Return the calls of the room.

    seen: a call holds boxes of two panoramas, or observations in the body frame. The truth is moved with them.
    """
    turn, shift = rng.uniform(-np.pi, np.pi), rng.uniform(-20, 20, 2)
    there = moved_map(task.arguments[0][-2 if seen == "boxes" else -1], turn, shift)
    calls, poses = [], []
    for arguments, pose in zip(task.arguments, task.truth, strict=True):
        if seen == "boxes":
            upper, lower, _, rig = arguments
            columns = int(rng.integers(0, rig.width))
            heading = 2 * np.pi * columns / rig.width
            sides = ([rolled(one, columns, rig.width) for one in side] for side in (upper, lower))
            calls.append((*sides, there, rig))
        else:
            heading = rng.uniform(-np.pi, np.pi)
            calls.append((tuple(turned(one, -heading) for one in arguments[0]), there))
        poses.append((*(rotation_2d(turn) @ pose[:2] + shift), wrap_angle(pose[2] + turn + heading)))
    return Task(tuple(calls), np.array(poses))


def moved_map(semantic_map: SemanticMap, turn: float, shift: np.ndarray) -> SemanticMap:
    """Return the map turned by `turn` [rad] about the origin, then shifted [m]."""

    def there(places: np.ndarray) -> np.ndarray:
        return places @ rotation_2d(turn).T + shift

    places = zip(semantic_map.landmarks, there(semantic_map.positions), strict=True)
    landmarks = [dataclasses.replace(one, x=x, y=y) for one, (x, y) in places]
    walls = None if semantic_map.walls is None else there(semantic_map.walls)
    return SemanticMap(landmarks, walls, semantic_map.name)


def rolled(detection: Detection, columns: int, width: int) -> Detection:
    """Roll a box by `columns` to the right, as on a panorama whose rig has turned left by 2 pi columns / width."""
    box = np.add(detection.box, [columns, 0, columns, 0])
    return dataclasses.replace(detection, box=tuple(wrapped_box(box, width).tolist()))


def turned(observation: Observation, angle: float) -> Observation:
    """Turn an observation and its covariance about the body's upward axis."""
    r = rotation_2d(angle)
    x, y = (r @ (observation.x, observation.y)).tolist()
    return observation._replace(x=x, y=y, covariance=r @ observation.covariance @ r.T)
