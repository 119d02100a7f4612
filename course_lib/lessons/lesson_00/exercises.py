"""Exercises of lesson 00: how exercises work, on the term of equation (8), and a search for the top of its hill."""

import functools

import numpy as np

from course_lib.geometry import wrap_angle
from course_lib.lessons.kit.box_world import Box, BoxWorld
from course_lib.lessons.kit.exercises import Exercise
from course_lib.lessons.kit.values import as_numbers

# 00.1: by how much do two depth images differ?


def depth_difference(measured, simulated):
    """Absolute difference, in metres, of two depth images of the same size."""
    # Subtract, then drop the sign; nan and inf stay what they are.
    return np.abs(measured - simulated)


def two_images(rng: np.random.Generator) -> tuple:
    measured = rng.uniform(1.0, 9.0, rng.integers(2, 5, size=2))
    simulated = measured + rng.normal(0, 0.5, measured.shape)
    if rng.random() < 0.5:  # a wall seen through an open door: nothing in the task caps a difference
        simulated.flat[rng.integers(simulated.size)] += rng.uniform(12.0, 20.0)
    return measured, simulated


def a_gap_and_a_hole(rng: np.random.Generator) -> tuple:
    """One pixel that the camera did not measure, and one where the map has a hole."""
    measured, simulated = two_images(rng)
    gap, hole = rng.choice(measured.size, size=2, replace=False)
    measured.flat[gap], simulated.flat[hole] = np.nan, np.inf
    return measured, simulated


def equal_images(rng: np.random.Generator) -> tuple:
    measured = two_images(rng)[0]
    return measured, measured.copy()


# 00.2: from the vote back to the difference


def difference_of_vote(vote, alpha):
    """Difference in metres of pixels whose term of equation (8) is `vote`."""
    # v (alpha + d) = alpha, solved for d; a vote of 0 divides by zero, which NumPy makes inf.
    with np.errstate(divide="ignore"):
        return alpha / vote - alpha


def votes(rng: np.random.Generator) -> tuple:
    return rng.uniform(0.05, 0.95, rng.integers(2, 5, size=2)), rng.uniform(0.05, 0.5)


def votes_of_0_and_1(rng: np.random.Generator) -> tuple:
    """A hole in the map and no difference at all, among others, with the paper's alpha."""
    return np.array([*rng.uniform(0.05, 0.95, 4), 1.0, 0.0, 0.5]), 0.1


# 00.3: find the camera


BUDGET = 400
"""How many poses a search may ask for."""
RAYS = np.deg2rad(np.arange(-180, 180, 8))
ALPHA = 0.3  # m, wider than the paper's, because so few rays make a rough hill
START_WITHIN = np.array([0.4, 0.3, np.deg2rad(10)])
NEAR_ENOUGH = 0.03, 1.0  # m and degrees from the top; a good search comes far closer


@functools.cache
def small_room() -> BoxWorld:
    """A room of 5 x 4 m with a pillar and a cupboard, 3 m high."""
    walls = ((-0.2, -0.2), (0.0, 4.2)), ((5.0, -0.2), (5.2, 4.2)), ((-0.2, -0.2), (5.2, 0.0)), ((-0.2, 4.0), (5.2, 4.2))
    things = ((3.6, 1.0), (3.9, 1.3)), ((4.2, 3.2), (5.0, 4.0))
    return BoxWorld([Box((*low, 0.0), (*high, 3.0), 0.5) for low, high in (*walls, *things)])


def distances(poses: np.ndarray) -> np.ndarray:
    """Distances (N, 45) [m] that a scanner at poses (N, 3), each x, y [m] and yaw [rad], measures all around."""
    angles = poses[:, 2:] + RAYS
    directions = np.stack([np.cos(angles), np.sin(angles), np.zeros_like(angles)], axis=-1)
    origins = np.column_stack([poses[:, :2], np.full(len(poses), 1.2)])[:, None]
    return small_room().cast(origins, directions).distance


class Score:
    """`score(poses)` is l / m, eq. (8), of poses (N, 3) or of one pose (3,). It answers `BUDGET` poses in all."""

    def __init__(self, truth: np.ndarray, blocked: np.ndarray) -> None:
        self.truth, self.blocked, self.asked = truth, blocked, 0
        self.measured = distances(truth[None])[0]
        self.measured[blocked] = 0.7  # m, a person in front of the scanner

    def __call__(self, poses: np.ndarray) -> np.ndarray | float:
        given = np.asarray(poses, dtype=np.float64)
        if given.shape[-1:] != (3,) or given.ndim > 2:
            raise ValueError(f"score takes poses (N, 3), each x, y, yaw; got an array of shape {given.shape}")
        self.asked += given.size // 3
        if self.asked > BUDGET:
            raise RuntimeError(f"your search asked for more than {BUDGET} poses")
        share = np.mean(ALPHA / (ALPHA + np.abs(self.measured - distances(given.reshape(-1, 3)))), axis=1)
        return share if given.ndim == 2 else float(share[0])

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Score) and np.array_equal(self.truth, other.truth)

    def __deepcopy__(self, memo: dict) -> "Score":
        return Score(self.truth, self.blocked)  # for another search, which has asked nothing yet


def find_the_camera(score, start):
    """Pose [x, y, yaw] near `start` at which `score` is greatest, found with at most 400 poses."""
    # Ten clouds of 40 poses, each about the best pose so far and two thirds as wide as the one before.
    rng = np.random.default_rng(0)
    best, spread = start, np.array([0.28, 0.21, np.deg2rad(7)])
    for _ in range(10):
        cloud = best + spread * rng.normal(size=(40, 3))
        cloud[0] = best
        best, spread = cloud[np.argmax(score(cloud))], 0.65 * spread
    return best


def a_search(rng: np.random.Generator, off=None) -> tuple:
    """A score and a start, `off` times the greatest distance away from the top (default: anywhere within it)."""
    truth, first = rng.uniform([1.2, 1.2, -0.5], [2.8, 2.8, 0.5]), int(rng.integers(40))
    off = rng.uniform(-1, 1, 3) if off is None else off
    return Score(truth, np.arange(first, first + 5)), truth + START_WITHIN * off


def a_far_start(rng: np.random.Generator) -> tuple:
    return a_search(rng, rng.choice([-1, 1], 3))


def start_at_the_top(rng: np.random.Generator) -> tuple:
    return a_search(rng, 0)


def off_the_top(arguments: tuple, answer: object) -> str | None:
    """Say what is wrong with the end of a search, or return None."""
    (score, start), found = arguments, as_numbers(answer)
    if found is None or found.size != 3 or not np.isfinite(found).all():
        return "Return one pose: three finite numbers, x, y and yaw."
    x, y, yaw = found.reshape(3) - score.truth
    away, turned = np.hypot(x, y), np.rad2deg(abs(wrap_angle(yaw)))
    if away <= NEAR_ENOUGH[0] and turned <= NEAR_ENOUGH[1]:
        return None
    ends = f"One of your searches ends {away:.2f} m and {turned:.1f} degrees from the top"
    if away > np.hypot(*(start - score.truth)[:2]) + NEAR_ENOUGH[0]:
        return f"{ends}, farther away than it began. Does it keep the *greatest* score, in radians?"
    return (
        f"{ends}. Each cloud should lie about the best pose so far and be narrower than the one before, "
        "but not by so much that the top is left outside."
    )


def each_number_once(score, start):
    best = start
    for k, reach in enumerate(START_WITHIN):
        tried = best + np.linspace(-reach, reach, BUDGET // 3)[:, None] * np.eye(3)[k]
        best = tried[np.argmax(score(tried))]
    return best


# fmt: off
EXERCISES = [
    Exercise("00.1", depth_difference, two_images, "warm-up", cases=[a_gap_and_a_hole, equal_images], mistakes="""
        np.abs(measured - simulated) => measured - simulated
        np.abs(measured - simulated) => simulated - measured
        Too near is as wrong as too far, and no difference is less than zero: which function drops the sign?
        np.abs(measured - simulated) => np.abs(measured - simulated).sum()
        np.abs(measured - simulated) => np.abs(measured - simulated).mean()
        np.abs(measured - simulated) => np.nansum(np.abs(measured - simulated))
        np.abs(measured - simulated) => np.nanmean(np.abs(measured - simulated))
        That is one number for the whole image; here every pixel keeps its own.
        np.abs(measured - simulated) => np.nan_to_num(np.abs(measured - simulated))
        np.abs(measured - simulated) => np.nan_to_num(np.abs(measured - simulated), posinf=np.inf)
        np.abs(measured - simulated) => np.abs(np.nan_to_num(measured) - np.nan_to_num(simulated))
        Where the camera measured nothing (nan) yours gives a number, as if it were known. Leave nan and inf alone.
        np.abs(measured - simulated) => np.minimum(np.abs(measured - simulated), 10.0)
        Yours stops at 10 m. Nothing in the task caps a difference: through an open door it is larger.
        np.abs(measured - simulated) => 0.1 / (0.1 + np.abs(measured - simulated))
        That is the pixel's vote. The task asks one step earlier: for the difference in metres.
        np.abs(measured - simulated) => np.where(np.isinf(simulated), np.nan, np.abs(measured - simulated))
        Where the map has a hole yours is nan. Only what was *not measured* is nan; at a hole it is inf.
    """),
    Exercise("00.2", difference_of_vote, votes, cases=[votes_of_0_and_1], mistakes="""
        alpha / vote - alpha => alpha * vote / (1 - vote)
        At vote 1 yours is inf, and there the two images agree. Numerator and denominator changed places.
        - alpha =>
        At vote 1 the difference must be 0; yours is alpha. What is left to take away?
        alpha / vote - alpha => (1 - vote) / vote
        Yours has no unit: a vote is a pure number. What turns it into metres?
        alpha / vote - alpha => alpha * (1 - vote)
        Half of the votes is a difference of alpha; yours gives half of it. The term is not a straight line.
        alpha / vote - alpha => alpha / (alpha + vote)
        That is the term again, with the vote put in as if it were a difference. Solve it for d.
        alpha / vote - alpha => 0.1 / vote - 0.1
        Right for the paper's alpha alone: yours is always 0.1. Take the one that is given.
        alpha / vote - alpha => np.where(vote > 0, alpha / vote - alpha, np.nan)
        alpha / vote - alpha => np.where(vote > 0, alpha / vote - alpha, 0)
        A vote of 0 is neither nan nor no difference at all: only an infinite difference earns nothing.
        alpha / vote - alpha => 1 / vote - alpha
        You have 1 where alpha belongs: vote times (alpha + d) is alpha, not 1.
    """),
    Exercise("00.3", find_the_camera, a_search, "challenge", cases=[a_far_start, start_at_the_top], verify=off_the_top,
             mistakes="""
        ... => return start
        That is the pose that you were given: ask `score` about others, and keep the best.
        argmax => argmin
        You keep the worst pose: the true one has the *greatest* score.
        range(10) => range(1) and also (40, 3) => (400, 3)
        One wide cloud never comes close enough. Where would you draw the next one, and how wide?
        cloud = best + => cloud = start +
        Every cloud of yours lies about the start. Draw the next one about the best pose so far.
        0.65 * spread => spread
        Your clouds stay as wide as the first. Let each be narrower than the one before.
        0.65 * spread => 0.2 * spread
        Your clouds become narrow too soon: the top is left outside. Let each be about two thirds as wide.
        np.deg2rad(7) => 7
        Your yaw spreads over 7 radians. Poses are in radians: convert the degrees.
    """, functions={
        each_number_once: "You set each number once. Then the first is no longer the best: go round again.",
    }),
]
