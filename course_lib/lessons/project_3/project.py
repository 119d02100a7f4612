"""Project P3: a matcher that survives look-alikes; scored by right, wrong and withheld poses in hidden rooms."""

from collections.abc import Callable, Sequence

import numpy as np

from course_lib.beyond.look_alikes.matchers import associate_hungarian
from course_lib.experiments.look_alikes import MAX_ERROR_M, is_right, pose_errors
from course_lib.lessons.kit.projects import AnswerError, Project, Result, Rival, Task
from course_lib.lessons.project_2.project import room_of
from course_lib.lessons.project_2.rooms import ProjectView
from course_lib.lessons.project_3.rivals import match
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D, RigidFitError, fit_rigid_2d
from course_lib.spherical_stereo.semantic_map.association import Association, Observation, associate_greedy
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

WRONG_POINTS = -400.0  # of a pose that is given and is not within half a metre and 10 degrees
SEEN = 0.5  # share of the observations that a task keeps, each drawn by itself: people stand before the others
DRAWS = 3  # tasks of each view
THINNING_STREAM = 0x7313  # joins a room's seed


def thinned(view: ProjectView, rng: np.random.Generator) -> tuple[Observation, ...]:
    """Half of a view's observations."""
    return tuple(one for one in view.observations if rng.random() < SEEN)


def prepare(seed: int) -> Task:
    """Every view of a room, each thinned three times: the arguments of `match`; the truth: poses `(n, 3)`."""
    room, rng = room_of(seed), np.random.default_rng([THINNING_STREAM, seed])
    calls = [(view, (thinned(view, rng), room.semantic_map)) for view in room.views for _ in range(DRAWS)]
    return Task(tuple(call for _, call in calls), np.array([view.pose for view, _ in calls]))


def checked_pairs(answer: object, n_observations: int, n_landmarks: int) -> list[tuple[int, int]] | None:
    """The pairs of an answer; None for None and for fewer than two pairs, which fix no pose.

    Raises `AnswerError` for what is no list of pairs of indices, or not one-to-one.
    """
    if answer is None:
        return None
    try:
        pairs = [(int(i), int(j)) for i, j in answer]
    except (TypeError, ValueError):
        raise AnswerError("returns for one view neither None nor a list of pairs (observation, landmark)") from None
    for side, size in ((0, n_observations), (1, n_landmarks)):
        named = [pair[side] for pair in pairs]
        if len(set(named)) < len(named):
            raise AnswerError(f"names one {('observation', 'landmark')[side]} twice: pairs are one-to-one")
        for index in named:
            if not 0 <= index < size:
                what = ("an observation", "a landmark")[side]
                raise AnswerError(f"names {what} that there is not: {index}, of {size} counted from 0")
    return pairs if len(pairs) >= 2 else None


def pose_of(
    pairs: Sequence[tuple[int, int]], observations: Sequence[Observation], semantic_map: SemanticMap
) -> Pose2D | None:
    """The pose fitted to pairs, each weighed by its observation's covariance; None where no pose fits them."""
    chosen = [observations[i] for i, _ in pairs]
    try:
        return fit_rigid_2d(
            np.array([[one.x, one.y] for one in chosen]),
            semantic_map.positions[[j for _, j in pairs]],
            covariances=np.array([one.covariance for one in chosen]),
        )
    except RigidFitError:
        return None


def points_of(pose: Pose2D | None, true_pose: np.ndarray) -> float:
    """100 for the true pose, falling to 50 at half a metre; `WRONG_POINTS` beyond that, beyond 10 degrees, for None."""
    errors = pose_errors(pose, true_pose)
    return 100.0 - 50.0 * float(np.hypot(*errors[:2])) / MAX_ERROR_M if is_right(errors) else WRONG_POINTS


def measure(task: Task, answers: list) -> Result:
    """Mean points of a room's tasks: none for what is withheld."""
    points = []
    for answer, (observations, semantic_map), true_pose in zip(answers, task.arguments, task.truth, strict=True):
        pairs = checked_pairs(answer, len(observations), len(semantic_map))
        points.append(0.0 if pairs is None else points_of(pose_of(pairs, observations, semantic_map), true_pose))
    given, wrong = np.count_nonzero(points), points.count(WRONG_POINTS)
    return Result(float(np.mean(points)), f"{given} of {len(points)} answered, {wrong} of them wrong")


def by_the_library(associate: Callable[..., Association]) -> Callable:
    """`match` by one of the library's matchers."""
    return lambda observations, semantic_map: (
        associate(observations, semantic_map).usable_pairs if observations else None
    )


PROJECT = Project(
    name="P3",
    title="mean points of a room's views (up to 100 for a right pose, 0 for none, -400 for a wrong one)",
    unit="points",
    better="higher",
    digits=1,
    function="match",
    seeds=tuple(range(6101, 6113)),
    prepare=prepare,
    measure=measure,
    rivals=(
        Rival("paper", "the paper's greedy matching", by_the_library(associate_greedy)),
        Rival("other", "least total penalty (Hungarian)", by_the_library(associate_hungarian)),
        Rival("ours", "ours, the five stages calibrated on the practice rooms", match),
    ),
    seconds=20.0,
    many=True,
    forbidden=("course_lib.spherical_stereo.pose", "course_lib.beyond", "course_lib.lessons"),
)
