"""Project P2: from the boxes of two images to a pose; scored by how far the rig's poses are off in hidden rooms."""

from typing import NamedTuple

import numpy as np

from course_lib.beyond.look_alikes.matchers import matcher
from course_lib.lessons.kit.projects import AnswerError, Project, Result, Rival, Task
from course_lib.lessons.project_2.exercises import angles_of, pair_boxes, rotation
from course_lib.lessons.project_2.rooms import ProjectRoom, RoomSet, project_rooms
from course_lib.paths import data_path
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.panorama import StereoRig
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D

MAX_COST = 2.0
"""Metres: a pose that is farther off than this costs no more."""
NO_ANSWER = 1.0
"""Metres: what no answer costs."""
CORRECT = 0.5
"""Metres: an answer that costs no more is called correct."""
MAX_GAP = 0.1  # radians between the azimuths of two boxes of one object, as the library's triangulation asks


class Rig(NamedTuple):
    """Two spherical cameras, one above the other, and their images."""

    baseline: float
    """Metres, from the lower camera up to the upper one."""
    width: int
    """Of each image, pixels."""
    height: int


def rooms_of(name: RoomSet) -> tuple[ProjectRoom, ...]:
    """The practice rooms, or the hidden ones."""
    return project_rooms(data_path(f"projects/rooms_{name}.json"))


def room_of(seed: int) -> ProjectRoom:
    """A room by its seed. Raises `ValueError`, which names the practice rooms, where there is none."""
    for room in (*rooms_of("practice"), *rooms_of("hidden")):
        if room.seed == seed:
            return room
    known = ", ".join(str(room.seed) for room in rooms_of("practice"))
    raise ValueError(f"there is no room of seed {seed}; the practice rooms are {known}")


def prepare(seed: int) -> Task:
    """Every view of a room: the arguments of `locate`; the truth: the poses `(n, 3)`."""
    room = room_of(seed)
    calls = tuple(
        (list(view.upper), list(view.lower), room.semantic_map, Rig(view.rig.baseline, *view.size))
        for view in room.views
    )
    return Task(calls, np.array([view.pose for view in room.views]))


def pose_cost(answer: object, true_pose: np.ndarray) -> float:
    """How far a pose is off, metres: the mean of what the rig and a point one metre ahead of it are off.

    At most `MAX_COST`; `NO_ANSWER` for None. Raises `AnswerError` for what is neither None nor three numbers.
    """
    if answer is None:
        return NO_ANSWER
    try:
        pose = np.asarray(answer, dtype=np.float64)
    except (TypeError, ValueError):
        pose = np.empty(0)
    if pose.shape != (3,) or not np.isfinite(pose).all():
        raise AnswerError("returns for one view neither None nor three finite numbers (x, y, theta)")
    off = [
        np.hypot(*(pose[:2] + rotation(pose[2]) @ point - true_pose[:2] - rotation(true_pose[2]) @ point))
        for point in np.array([[0.0, 0.0], [1.0, 0.0]])
    ]
    return min(float(np.mean(off)), MAX_COST)


def measure(task: Task, answers: list) -> Result:
    """The mean cost of a room's views."""
    costs = np.array([pose_cost(answer, pose) for answer, pose in zip(answers, task.truth, strict=True)])
    given = np.array([answer is not None for answer in answers])
    right, wrong = int((given & (costs <= CORRECT)).sum()), int((given & (costs > CORRECT)).sum())
    return Result(float(costs.mean()), f"{right} correct, {wrong} wrong, {int((~given).sum())} unable")


def pairs_of_boxes(upper: list, lower: list, rig: Rig) -> list[tuple[int, int]]:
    """(upper, lower) indices of the boxes that show one object: class and azimuth, no photograph."""
    labels = [np.array([one.label for one in side], dtype=str) for side in (upper, lower)]
    angles = [
        np.array([angles_of(np.array(one.box), rig.width) for one in side]).reshape(-1, 2) for side in (upper, lower)
    ]
    partner = pair_boxes(labels[0], angles[0], labels[1], angles[1], MAX_GAP)
    return [(i, int(j)) for i, j in enumerate(partner) if j >= 0]


def by_the_library(association: str):
    """`locate` by the library's localizer with one of its matchers."""

    def locate(upper, lower, semantic_map, rig) -> Pose2D | None:
        localizer = SemanticLocalizer(
            StereoRig(rig.baseline),
            semantic_map,
            association=matcher(association),
            image_size=(rig.width, rig.height),
            reject_implausible=False,
        )
        return localizer.localize_detections(upper, lower, pairs_of_boxes(upper, lower, rig)).pose

    return locate


PROJECT = Project(
    name="P2",
    title="mean error of the poses of a room (at most 2 m each, 1 m for no answer)",
    unit="m",
    better="lower",
    digits=3,
    function="locate",
    seeds=tuple(range(6101, 6113)),
    prepare=prepare,
    measure=measure,
    rivals=(
        Rival("paper", "the paper's greedy matching", by_the_library("greedy")),
        Rival("ours", "ours, poses that all objects agree on", by_the_library("consistent")),
    ),
    seconds=20.0,
    many=True,
    forbidden=("course_lib.spherical_stereo", "course_lib.beyond", "course_lib.lessons"),
)
