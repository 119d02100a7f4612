"""Exercises of lesson 00: how exercises work, on the term of equation (8), and a search for the top of its hill."""

from __future__ import annotations

import functools

import numpy as np

from course_lib.geometry import wrap_angle
from course_lib.lessons.kit.box_world import Box, BoxWorld
from course_lib.lessons.kit.exercises import Exercise, Mistake

# 00.1: by how much do two depth images differ?


def depth_difference(measured: np.ndarray, simulated: np.ndarray) -> np.ndarray:
    """Absolute difference (H, W) in metres of two depth images; nan where nothing was measured."""
    return np.abs(measured - simulated)


def _two_images(rng: np.random.Generator) -> tuple:
    measured = rng.uniform(1.0, 9.0, size=(rng.integers(2, 5), rng.integers(2, 5)))
    simulated = measured + rng.normal(0, 0.5, size=measured.shape)
    if rng.random() < 0.5:
        # A wall seen through an open door: nothing in the task caps a difference.
        simulated.flat[rng.integers(simulated.size)] += rng.uniform(12.0, 20.0)
    return measured, simulated


def _with_a_gap_and_a_hole(rng: np.random.Generator) -> tuple:
    """Some pixels that the camera did not measure (nan), one where the map has a hole (inf)."""
    measured, simulated = _two_images(rng)
    gap, hole = rng.choice(measured.size, size=2, replace=False)
    measured.flat[gap], simulated.flat[hole] = np.nan, np.inf
    return measured, simulated


def _equal(rng: np.random.Generator) -> tuple:
    measured = rng.uniform(1.0, 9.0, size=(3, 4))
    return measured, measured.copy()


# 00.2: from the vote back to the difference


def difference_of_vote(vote: np.ndarray, alpha: float) -> np.ndarray:
    """Difference in metres of pixels whose term of eq. (8) is `vote`, 0 to 1; inf where it is 0."""
    with np.errstate(divide="ignore"):
        return alpha / vote - alpha


def _votes(rng: np.random.Generator) -> tuple:
    return rng.uniform(0.05, 0.95, size=(rng.integers(2, 5), rng.integers(2, 5))), rng.uniform(0.05, 0.5)


def _min_and_max_votes(rng: np.random.Generator) -> tuple:
    """A vote of 1 (no difference) and one of 0 (a hole in the map) among others, with the paper's alpha."""
    votes = rng.uniform(0.05, 0.95, size=8)
    votes[[2, 5]] = 1.0, 0.0
    return votes, 0.1


def _nan_for_no_vote(vote: np.ndarray, alpha: float) -> np.ndarray:
    return np.where(vote > 0, difference_of_vote(vote, alpha), np.nan)


def _zero_for_no_vote(vote: np.ndarray, alpha: float) -> np.ndarray:
    return np.where(vote > 0, difference_of_vote(vote, alpha), 0.0)


def _upside_down(vote: np.ndarray, alpha: float) -> np.ndarray:
    with np.errstate(divide="ignore"):
        return alpha * vote / (1 - vote)


def _alpha_left_over(vote: np.ndarray, alpha: float) -> np.ndarray:
    with np.errstate(divide="ignore"):
        return alpha / vote


def _one_for_alpha(vote: np.ndarray, alpha: float) -> np.ndarray:
    with np.errstate(divide="ignore"):
        return 1 / vote - alpha


def _one_minus_vote(vote: np.ndarray, alpha: float) -> np.ndarray:
    with np.errstate(divide="ignore"):
        return (1 - vote) / vote


# 00.3, the challenge: find the camera

BUDGET = 400
"""How many poses a search may ask for."""
_RAYS = np.deg2rad(np.arange(-180, 180, 8))
_ALPHA = 0.3  # m, wider than the paper's: so few rays make a rough hill
_NEAR_ENOUGH = (0.03, np.deg2rad(1.0))
"""From the true place [m] and heading [rad] (chosen): what a good search keeps by far."""
_START_WITHIN = np.array([0.4, 0.3, np.deg2rad(10.0)])


@functools.cache
def _room() -> BoxWorld:
    """A room of 5 x 4 m with a pillar and a cupboard, 3 m high."""
    walls = ((-0.2, -0.2), (0.0, 4.2)), ((5.0, -0.2), (5.2, 4.2)), ((-0.2, -0.2), (5.2, 0.0)), ((-0.2, 4.0), (5.2, 4.2))
    things = ((3.6, 1.0), (3.9, 1.3)), ((4.2, 3.2), (5.0, 4.0))
    return BoxWorld([Box((*low, 0.0), (*high, 3.0), 0.5) for low, high in (*walls, *things)])


def _distances(poses: np.ndarray) -> np.ndarray:
    """What 45 rays all around measure [m] from poses `(N, 3)`: x, y [m], yaw [rad]."""
    angles = poses[:, 2:] + _RAYS
    directions = np.stack([np.cos(angles), np.sin(angles), np.zeros_like(angles)], axis=-1)
    origins = np.column_stack([poses[:, :2], np.full(len(poses), 1.2)])[:, None]
    return _room().cast(origins, directions).distance


class Score:
    """`score(poses)` gives l / m, eq. (8), of poses `(N, 3)`, or of one pose `(3,)`; at most `BUDGET` poses in all."""

    def __init__(self, truth: np.ndarray, blocked: np.ndarray) -> None:
        self.truth = truth
        self.measured = _distances(truth[None])[0]
        self.measured[blocked] = 0.7  # a person stands before the camera
        self.asked = 0

    def __call__(self, poses: np.ndarray) -> np.ndarray | float:
        given = np.asarray(poses, dtype=np.float64)
        if given.shape[-1:] != (3,) or given.ndim > 2:
            raise ValueError(f"score takes poses (N, 3), each x, y, yaw; got an array of shape {given.shape}")
        self.asked += given.size // 3
        if self.asked > BUDGET:
            raise RuntimeError(f"your search asked for more than {BUDGET} poses")
        votes = _ALPHA / (_ALPHA + np.abs(self.measured - _distances(given.reshape(-1, 3))))
        return votes.mean(axis=1) if given.ndim == 2 else float(votes.mean())

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Score) and np.array_equal(self.truth, other.truth)

    __hash__ = None

    def __deepcopy__(self, memo: dict) -> Score:
        """A search by somebody else: nothing asked for yet."""
        fresh = object.__new__(Score)
        fresh.truth, fresh.measured, fresh.asked = self.truth, self.measured, 0
        return fresh


def find_the_camera(score: Score, start: np.ndarray) -> np.ndarray:
    """Pose [x, y, yaw] at which `score` is greatest, from one near it: ever smaller clouds about the best so far."""
    rng = np.random.default_rng(0)
    best, spread = start, _START_WITHIN * 0.7
    for _ in range(10):
        cloud = best + spread * rng.normal(size=(BUDGET // 10, 3))
        cloud[0] = best
        best, spread = cloud[np.argmax(score(cloud))], 0.65 * spread
    return best


def _search(rng: np.random.Generator, off: np.ndarray) -> tuple:
    truth = rng.uniform([1.2, 1.2, -0.5], [2.8, 2.8, 0.5])
    first = int(rng.integers(0, 40))
    return Score(truth, np.arange(first, first + 5)), truth + off


def _a_search(rng: np.random.Generator) -> tuple:
    return _search(rng, _START_WITHIN * rng.uniform(-1, 1, 3))


def _a_far_start(rng: np.random.Generator) -> tuple:
    return _search(rng, _START_WITHIN * rng.choice([-1, 1], 3))


def _start_at_the_top(rng: np.random.Generator) -> tuple:
    return _search(rng, np.zeros(3))


def off_the_top(arguments: tuple, answer: object) -> str | None:
    """What is wrong with the end of a search, or None."""
    score, start = arguments
    try:
        found = np.asarray(answer, dtype=np.float64)
    except (TypeError, ValueError):
        return "Return one pose: three numbers, x, y and yaw."
    if found.size != 3 or not np.isfinite(found).all():
        return "Return one pose: three finite numbers, x, y and yaw."
    found = found.reshape(3)
    away = float(np.hypot(*(found - score.truth)[:2]))
    turned = float(np.abs(wrap_angle(found[2] - score.truth[2])))
    if away <= _NEAR_ENOUGH[0] and turned <= _NEAR_ENOUGH[1]:
        return None
    ends = f"One of your searches ends {away:.2f} m and {np.rad2deg(turned):.1f} degrees from the top"
    began = float(np.hypot(*(start - score.truth)[:2]))
    if away > began + _NEAR_ENOUGH[0]:
        return f"{ends}, farther away than it began. Does it keep the *greatest* score, in radians?"
    return (
        f"{ends}. Each cloud should lie about the best pose so far and be narrower than the one before, "
        "but not by so much that the top is left outside."
    )


def _one_wide_cloud(score: Score, start: np.ndarray) -> np.ndarray:
    cloud = start + _START_WITHIN * np.random.default_rng(0).uniform(-1, 1, (BUDGET, 3))
    return cloud[np.argmax(score(cloud))]


def _each_number_once(score: Score, start: np.ndarray) -> np.ndarray:
    best = start.copy()
    for k in range(3):
        tried = np.tile(best, (BUDGET // 3, 1))
        tried[:, k] += np.linspace(-1, 1, len(tried)) * _START_WITHIN[k]
        best = tried[np.argmax(score(tried))]
    return best


def _downhill(score: Score, start: np.ndarray) -> np.ndarray:
    cloud = start + _START_WITHIN * np.random.default_rng(0).uniform(-1, 1, (BUDGET, 3))
    return cloud[np.argmin(score(cloud))]


EXERCISES = [
    Exercise(
        number="00.1",
        level="warm-up",
        solution=depth_difference,
        inputs=_two_images,
        cases=(_with_a_gap_and_a_hole, _equal),
        mistakes=(
            Mistake(
                lambda measured, simulated: measured - simulated,
                "Some of yours are negative. Too near is as wrong as too far: which function drops the sign?",
            ),
            Mistake(
                lambda measured, simulated: simulated - measured,
                "The order does not matter, but the sign must go: no difference is less than zero.",
            ),
            Mistake(
                lambda measured, simulated: (measured - simulated) ** 2,
                "Yours is squared: its unit would be square metres. Equation (8) takes the absolute value.",
            ),
            Mistake(
                lambda measured, simulated: np.abs(measured - simulated).sum(),
                "That is one number for the whole image; here every pixel keeps its own.",
            ),
            Mistake(
                lambda measured, simulated: np.abs(measured - simulated) / measured,
                "Yours is a share of the depth, without a unit. Equation (8) counts metres.",
            ),
            Mistake(
                lambda measured, simulated: np.nan_to_num(np.abs(measured - simulated)),
                "Yours makes 0 of nan: full agreement where nothing was measured. Leave nan and inf as they are.",
            ),
            Mistake(
                lambda measured, simulated: np.nan_to_num(np.abs(measured - simulated), posinf=np.inf),
                "Where the camera measured nothing (nan) yours says 0: full agreement. It must stay nan.",
            ),
            Mistake(
                lambda measured, simulated: np.abs(np.nan_to_num(measured) - np.nan_to_num(simulated)),
                "You replace nan and inf before you subtract. What was not measured has no difference: leave it nan.",
            ),
            Mistake(
                lambda measured, simulated: np.minimum(np.abs(measured - simulated), 10.0),
                "Yours stops at 10 m. Nothing in the task caps a difference: through an open door it is larger.",
            ),
            Mistake(
                lambda measured, simulated: 0.1 / (0.1 + np.abs(measured - simulated)),
                "That is the pixel's vote. The task asks one step earlier: for the difference in metres.",
            ),
            Mistake(
                lambda measured, simulated: np.where(np.isinf(simulated), np.nan, np.abs(measured - simulated)),
                "Where the map has a hole yours is nan. Only what was *not measured* is nan; at a hole it is inf.",
            ),
        ),
    ),
    Exercise(
        number="00.2",
        solution=difference_of_vote,
        inputs=_votes,
        cases=(_min_and_max_votes,),
        mistakes=(
            Mistake(
                _upside_down,
                "At vote 1 yours is inf, and there the two images agree. Numerator and denominator changed places.",
            ),
            Mistake(
                _alpha_left_over,
                "At vote 1 the difference must be 0; yours is alpha. What is left to take away?",
            ),
            Mistake(
                _one_minus_vote,
                "Yours has no unit: a vote is a pure number. What turns it into metres?",
            ),
            Mistake(
                lambda vote, alpha: alpha * (1 - vote),
                "Half of the votes is a difference of alpha; yours gives half of it. The term is not a straight line.",
            ),
            Mistake(
                lambda vote, alpha: alpha / (alpha + vote),
                "That is the term again, with the vote put in as if it were a difference. Solve it for d.",
            ),
            Mistake(
                lambda vote, alpha: difference_of_vote(vote, 0.1),
                "Right for the paper's alpha alone: yours is always 0.1. Take the one that is given.",
            ),
            Mistake(
                _nan_for_no_vote,
                "Right, except where the vote is 0: only an infinite difference earns nothing, and yours is nan.",
            ),
            Mistake(
                _zero_for_no_vote,
                "Where the vote is 0 yours says no difference at all. It is the other way: an infinite one.",
            ),
            Mistake(
                lambda vote, alpha: -difference_of_vote(vote, alpha),
                "Yours is negative; a difference is not. Look at the order of the subtraction.",
            ),
            Mistake(
                lambda vote, alpha: 1000 * difference_of_vote(vote, alpha),
                "Yours is 1000 times too large: millimetres? alpha is in metres, and so is the result.",
            ),
            Mistake(
                lambda vote, alpha: -alpha * np.log(np.maximum(vote, 1e-300)),
                "A logarithm undoes an exponential. Equation (8) has a fraction.",
            ),
            Mistake(
                _one_for_alpha,
                "You have 1 where alpha belongs: vote times (alpha + d) is alpha, not 1.",
            ),
        ),
    ),
    Exercise(
        number="00.3",
        level="challenge",
        solution=find_the_camera,
        inputs=_a_search,
        cases=(_a_far_start, _start_at_the_top),
        verify=off_the_top,
        mistakes=(
            Mistake(
                lambda score, start: start,
                "That is the pose that you were given: ask `score` about others, and keep the best.",
            ),
            Mistake(
                _downhill,
                "You keep the worst pose: the true one has the *greatest* score.",
            ),
            Mistake(
                _one_wide_cloud,
                "One wide cloud never comes close enough. Where would you draw the next one, and how wide?",
            ),
            Mistake(
                _each_number_once,
                "You set each number once. After the last one the first is no longer the best: go round again.",
            ),
        ),
    ),
]
