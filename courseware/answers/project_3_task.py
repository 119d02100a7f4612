"""Project P3: a matcher that survives look-alikes; scored by right, wrong and withheld poses in hidden rooms."""

from collections.abc import Callable

import numpy as np

from course_lib.beyond.look_alikes.matchers import associate_hungarian
from course_lib.spherical_stereo.pose.rigid_fit import RigidFitError, fit_rigid_2d
from course_lib.spherical_stereo.semantic_map.association import associate_greedy
from courseware.answers.project_2_task import HIDDEN_SEEDS, room_of
from courseware.answers.project_3 import assign, confidence, hypotheses, refit, squared_distances
from courseware.experiments.look_alikes import MAX_ERROR_M, is_right, pose_errors
from courseware.lessons.kit.projects import AnswerError, Project, Result, Rival, Task
from courseware.lessons.project_3.tasks import task_of

WRONG_POINTS = -400.0  # of a pose that is given and is not within half a metre and 10 degrees

# The numbers of our matcher. All are chosen on the four practice rooms. The covariances are too small by the factor.
COVARIANCE_FACTOR = 2.5
TOLERANCE = 0.8  # metres by which the lengths of two matches may disagree
REWARD, NOTHING = 6.5, 3.0  # nats of each match that fits exactly, and of each observation for "none of these poses"
MIN_MATCHES, MIN_CONFIDENCE, KEPT = 3, 0.75, 30


def prepare(seed: int) -> Task:
    """Return the task of a room of the score, or of a practice room."""
    return task_of(room_of(seed))


def checked_pairs(answer: object, sizes: tuple[int, int]) -> list[tuple[int, int]]:
    """Return an answer's pairs of indices below `sizes`. Raises `AnswerError` if they are none, or not one-to-one."""
    try:
        pairs = [(int(i), int(j)) for i, j in answer]
    except (TypeError, ValueError):
        raise AnswerError("returns for one view neither None nor a list of pairs (observation, landmark)") from None
    for side, name, size in zip((0, 1), ("an observation", "a landmark"), sizes, strict=True):
        named = [pair[side] for pair in pairs]
        if len(set(named)) < len(named):
            raise AnswerError(f"names one {name.split()[1]} twice: pairs are one-to-one")
        if wrong := [index for index in named if not 0 <= index < size]:
            raise AnswerError(f"names {name} that there is not: {wrong[0]}, of {size} counted from 0")
    return pairs


def points_of(answer: object, observations: tuple, semantic_map, true_pose: np.ndarray) -> float:
    """Return the points of the pose that is fitted to an answer's pairs, each weighed by its observation's covariance.

    100 for the true pose, falling to 50 at half a metre; `WRONG_POINTS` beyond that, beyond 10 degrees, and if no pose
    fits; 0 for None and for fewer than two pairs.
    """
    pairs = [] if answer is None else checked_pairs(answer, (len(observations), len(semantic_map)))
    if len(pairs) < 2:
        return 0.0
    places = np.array([[observations[i].x, observations[i].y] for i, _ in pairs])
    covariances = np.array([observations[i].covariance for i, _ in pairs])
    try:
        pose = fit_rigid_2d(places, semantic_map.positions[[j for _, j in pairs]], covariances=covariances)
    except RigidFitError:
        return WRONG_POINTS
    errors = pose_errors(pose, true_pose)
    return 100.0 - 50.0 * float(np.hypot(*errors[:2])) / MAX_ERROR_M if is_right(errors) else WRONG_POINTS


def measure(task: Task, answers: list) -> Result:
    """Return the mean points of a room's tasks."""
    points = [points_of(a, *given, pose) for a, given, pose in zip(answers, task.arguments, task.truth, strict=True)]
    given, wrong = np.count_nonzero(points), points.count(WRONG_POINTS)
    return Result(float(np.mean(points)), f"{given} of {len(points)} answered, {wrong} of them wrong")


def by_the_library(associate: Callable) -> Callable:
    """Return `match` by one of the library's matchers."""
    return lambda seen, semantic_map: associate(seen, semantic_map).usable_pairs if seen else None


def match(observations, semantic_map) -> list[tuple[int, int]] | None:
    """Ours: the five stages. Return the pairs (observation, landmark) of the best pose, or None if it is not sure."""
    if len(observations) < MIN_MATCHES:
        return None
    places = np.array([[one.x, one.y] for one in observations])
    covariances = COVARIANCE_FACTOR * np.array([one.covariance for one in observations])
    labels, landmarks = np.array([one.label for one in observations]), semantic_map.positions
    like = labels[:, None] == np.array(semantic_map.labels)

    def judged(pose):
        return pose, *assign(squared_distances(pose, places, covariances, landmarks), like, REWARD)

    proposed = map(judged, hypotheses(places, labels, landmarks, semantic_map.labels, TOLERANCE))
    proposed = [one for one in proposed if np.count_nonzero(one[1] >= 0) >= MIN_MATCHES]
    answers = []
    for pose, landmark, _ in sorted(proposed, key=lambda one: -one[2])[:KEPT]:
        used = landmark >= 0
        answers.append(judged(refit(pose, places[used], covariances[used], landmarks[landmark[used]])))
    poses, scores = np.array([pose for pose, *_ in answers]), np.array([score for *_, score in answers])
    if confidence(poses, scores, NOTHING * len(places)) < MIN_CONFIDENCE:
        return None
    return [(i, int(j)) for i, j in enumerate(answers[int(scores.argmax())][1]) if j >= 0]


PROJECT = Project(
    name="P3",
    title="mean points of a room's views (up to 100 for a right pose, 0 for none, -400 for a wrong one)",
    unit="points",
    better="higher",
    digits=1,
    function="match",
    seeds=HIDDEN_SEEDS,
    prepare=prepare,
    measure=measure,
    rivals=(
        Rival("paper", "the paper's greedy matching", by_the_library(associate_greedy)),
        Rival("other", "least total penalty (Hungarian)", by_the_library(associate_hungarian)),
        Rival("ours", "ours, the five stages calibrated on the practice rooms", match),
    ),
    seconds=20.0,
    many=True,
    forbidden=("course_lib.spherical_stereo.pose", "course_lib.beyond", "courseware.lessons"),
)
