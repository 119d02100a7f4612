"""Exercises of lesson 00: how exercises work, on the term of equation (8), and a search for the top of its hill."""

import numpy as np

from course_lib.geometry import wrap_angle
from courseware.lessons.kit.exercise import Exercise
from courseware.lessons.kit.values import as_numbers
from courseware.lessons.lesson_00.search import Score


def depth_difference(measured, simulated):
    """Absolute difference, in metres, of two depth images of the same size."""
    # Subtract, then drop the sign; nan and inf stay what they are.
    return np.abs(measured - simulated)


def two_images(rng: np.random.Generator) -> tuple:
    measured = rng.uniform(1.0, 9.0, (3, 4))
    # Some pixels see a wall through an open door, because nothing in the task caps a difference.
    return measured, measured + rng.normal(0, 0.5, (3, 4)) + np.where(rng.random((3, 4)) < 0.1, 15.0, 0.0)


def difference_of_vote(vote, alpha):
    """Difference in metres of pixels whose term of equation (8) is `vote`."""
    # v (alpha + d) = alpha, solved for d; a vote of 0 divides by zero, which NumPy makes inf.
    with np.errstate(divide="ignore"):
        return alpha / vote - alpha


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
    """Return a score and a start, `off` times the greatest distance away from the top (default: at random)."""
    truth, first_blocked = rng.uniform([1.2, 1.2, -0.5], [2.8, 2.8, 0.5]), int(rng.integers(40))
    away = np.array([0.4, 0.3, np.deg2rad(10)]) * (rng.uniform(-1, 1, 3) if off is None else off)
    return Score(truth, first_blocked), truth + away


def off_the_top(arguments: tuple, answer: object) -> str | None:
    """Say what is wrong with the end of a search, or return None."""
    (score, start), found = arguments, as_numbers(answer)
    if found is None or found.size != 3 or not np.isfinite(found).all():
        return "Return one pose: three finite numbers, x, y and yaw."
    x, y, yaw = found.reshape(3) - score.truth
    away, turned = np.hypot(x, y), np.rad2deg(abs(wrap_angle(yaw)))
    if away <= 0.03 and turned <= 1.0:  # a good search comes far closer
        return None
    ends = f"One of your searches ends {away:.2f} m and {turned:.1f} degrees from the top"
    if away > np.hypot(*(start - score.truth)[:2]) + 0.03:
        return f"{ends}, farther away than it began. Does it keep the *greatest* score, in radians?"
    return (
        f"{ends}. Draw each cloud about the best pose so far, and narrower, but not by so much that it misses the top."
    )


# fmt: off
EXERCISES = [
    Exercise("00.1", depth_difference, two_images, "warm-up", cases={
        "a gap and a hole": lambda rng: (np.array([[np.nan, 2.0, 3.0]]), np.array([[2.0, 2.5, np.inf]])),
        "equal images": lambda rng: (np.full((2, 3), 4.0), np.full((2, 3), 4.0)),
    }, example=(([2.0, 3.0, np.nan], [2.5, 2.9, 4.0]), [0.5, 0.1, np.nan])),
    Exercise("00.2", difference_of_vote,
             lambda rng: (rng.uniform(0.05, 0.95, (3, 4)), rng.uniform(0.05, 0.5)),
             cases={"votes of 0 and 1": lambda rng: (np.array([0.1, 0.6, 1.0, 0.0, 0.5]), 0.1)},
             example=(([1, 0.5, 0.25, 0], 0.1), [0, 0.1, 0.3, np.inf])),
    Exercise("00.3", find_the_camera, a_search, "challenge", verify=off_the_top, cases={
        "a far start": lambda rng: a_search(rng, rng.choice([-1, 1], 3)),
        "start at the top": lambda rng: a_search(rng, 0),
    }),
]
