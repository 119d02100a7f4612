"""Project P2: from the boxes of two images to a pose; scored by how far the rig's poses are off in hidden rooms."""

from functools import cache
from importlib import resources

import numpy as np

from course_lib.beyond.look_alikes.matchers import matcher
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.panorama import StereoRig
from courseware.answers.project_2 import angles_of, pair_boxes, rotation
from courseware.lessons.kit.projects import AnswerError, Project, Result, Rival, Task
from courseware.lessons.kit.values import as_numbers
from courseware.lessons.project_2 import rooms

HIDDEN_SEEDS = tuple(range(6101, 6113))  # neither tuning nor reporting uses them

MAX_COST = 2.0  # metres: a pose that is farther off costs no more
NO_ANSWER = 1.0  # metres: the cost of no answer
CORRECT = 0.5  # metres: an answer that costs no more is called correct
MAX_GAP = 0.1  # radians between the azimuths of two boxes of one object, as the library's triangulation asks


@cache
def hidden_rooms() -> dict[int, rooms.ProjectRoom]:
    """Return the rooms of the score by their seeds."""
    text = (resources.files(__package__) / "rooms_hidden.json").read_text(encoding="utf-8")
    return {room.seed: room for room in rooms.read_rooms(text)}


def room_of(seed: int) -> rooms.ProjectRoom:
    """Return a room of the score, or a practice room. Raises `ValueError` if there is none of this seed."""
    return hidden_rooms().get(seed) or rooms.room_of(seed)


def prepare(seed: int) -> Task:
    """Return the arguments of `locate` for every view of a room. The truth: the poses `(n, 3)`."""
    room = room_of(seed)
    calls = tuple(
        (list(view.upper), list(view.lower), room.semantic_map, rooms.Rig(view.rig.baseline, *view.size))
        for view in room.views
    )
    return Task(calls, np.array([view.pose for view in room.views]))


def pose_cost(answer: object, true_pose: np.ndarray) -> float:
    """Return the mean error [m] of the rig's place and of the place of a point one metre ahead of it.

    It is `MAX_COST` at most, and `NO_ANSWER` for None. Raises `AnswerError` if the answer is no pose.
    """
    if answer is None:
        return NO_ANSWER
    pose = as_numbers(answer)
    if pose is None or pose.shape != (3,) or not np.isfinite(pose).all():
        raise AnswerError("returns for one view neither None nor three finite numbers (x, y, theta)")
    off = pose[:2] - true_pose[:2]
    ahead = off + rotation(pose[2])[:, 0] - rotation(true_pose[2])[:, 0]
    return min(float(np.hypot(*off) + np.hypot(*ahead)) / 2, MAX_COST)


def measure(task: Task, answers: list) -> Result:
    """Return the mean cost of a room's views."""
    costs = np.array([pose_cost(answer, pose) for answer, pose in zip(answers, task.truth, strict=True)])
    given = np.array([answer is not None for answer in answers])
    right, wrong = (np.count_nonzero(given & kind) for kind in (costs <= CORRECT, costs > CORRECT))
    return Result(float(costs.mean()), f"{right} correct, {wrong} wrong, {np.count_nonzero(~given)} unable")


def by_the_library(association: str):
    """Return `locate` by the library's localizer with one of its matchers. Stage 2 pairs the boxes."""

    def locate(upper, lower, semantic_map, rig):
        given = []
        for side in (upper, lower):
            angles = np.array([angles_of(one.box, rig.width) for one in side]).reshape(-1, 2)
            given += [np.array([one.label for one in side], dtype=str), angles]
        pairs = [(i, int(j)) for i, j in enumerate(pair_boxes(*given, MAX_GAP)) if j >= 0]
        options = {"association": matcher(association), "image_size": rig[1:], "reject_implausible": False}
        localizer = SemanticLocalizer(StereoRig(rig.baseline), semantic_map, **options)
        return localizer.localize_detections(upper, lower, pairs).pose

    return locate


PROJECT = Project(
    name="P2",
    title="mean error of the poses of a room (at most 2 m each, 1 m for no answer)",
    unit="m",
    better="lower",
    digits=3,
    function="locate",
    seeds=HIDDEN_SEEDS,
    prepare=prepare,
    measure=measure,
    rivals=(
        Rival("paper", "the paper's greedy matching", by_the_library("greedy")),
        Rival("ours", "ours, poses that all objects agree on", by_the_library("consistent")),
    ),
    seconds=20.0,
    many=True,
    forbidden=("course_lib.spherical_stereo", "course_lib.beyond", "courseware.lessons"),
)
