"""Exercises of lesson 07: a mean of angles, residual resampling mended, who survives, what stratified draws cost."""

import numpy as np

from course_lib.geometry import wrap_angle
from courseware.lessons.kit.exercise import Exercise


def mean_angle(angles, w):
    """Mean direction in radians, from -pi to pi, and length R of the mean point, of angles (N,) with weights w (N,)."""
    # Add up the points on the circle; direction and length of the sum.
    s, c = np.sum(w * np.sin(angles)), np.sum(w * np.cos(angles))
    return np.arctan2(s, c), np.hypot(s, c)


def weighted_headings(rng: np.random.Generator) -> tuple:
    """Make headings about one direction, often one near the wrap or near zero, and weights that sum to one."""
    n = int(rng.integers(4, 9))
    centre = rng.choice([rng.uniform(-np.pi, np.pi), np.pi, 0.0]) + rng.uniform(-0.1, 0.1)
    w = rng.uniform(0.1, 1, n)
    return wrap_angle(centre + rng.normal(0, 0.4, n)), w / w.sum()


def residual_parts(w):
    """Certain copies (N,) and the probabilities (N,) of the remaining draws, for weights w (N,)."""
    # Filterpy's second line lacks the N. What is owed is N w, and N w - copies is left over.
    copies = np.floor(len(w) * w)
    rest = len(w) * w - copies
    return copies, rest / rest.sum()


def uneven_weights(rng: np.random.Generator) -> tuple:
    """Make two or three heavy weights, which are copied for certain, and light ones."""
    n = int(rng.integers(6, 13))
    light = rng.uniform(0.2, 0.9, n - int(rng.integers(2, 4))) / n
    heavy = rng.uniform(0.8, 1.2, n - len(light))
    return (rng.permutation(np.concatenate([light, heavy / heavy.sum() * (1 - light.sum())])),)


def expected_survivors(w):
    """Expected number of different particles after multinomial resampling with weights w (N,)."""
    # Each particle survives unless it is missed N times; the expectations add up.
    return np.sum(1 - (1 - w) ** len(w))


def stratified_error(w, x):
    """Standard deviation of the mean of x (N,) after stratified resampling with weights w (N,)."""
    # The variances of the parts add up; the mean divides by N.
    n, right, variance = len(w), np.cumsum(w), 0.0
    for k in range(n):
        overlap = np.minimum(right, (k + 1) / n) - np.maximum(right - w, k / n)
        p = n * np.clip(overlap, 0, None)
        variance += np.sum(p * (x - p @ x) ** 2)
    return np.sqrt(variance) / n


def spread(w, x):
    """Return the standard deviation of x in one draw with probabilities w."""
    return np.sqrt(w @ (x - w @ x) ** 2)


# fmt: off
WHOLE_NUMBERS = {"whole numbers": lambda rng: (np.array([0.5, 0.25, 0.125, 0.125]),)}  # two are owed nothing more
EXERCISES = [
    Exercise("07.1", mean_angle, weighted_headings, "warm-up", cases={
        "about the wrap": lambda rng: (np.deg2rad([170, 175, -175, -165]), np.arange(1, 5) / 10),
        "about zero": lambda rng: (np.deg2rad([-20, 5, 10]), np.arange(1, 4) / 6),
        "all around": lambda rng: (np.deg2rad([0, 90, 170, -90]), np.arange(1, 5) / 10),
        "all the same way": lambda rng: (np.deg2rad([30, 30, 30]), np.arange(1, 4) / 6),
    }, example=(([3.0, -3.0], [0.75, 0.25]), (3.07, 0.9925))),
    Exercise("07.2", residual_parts, uneven_weights, cases=WHOLE_NUMBERS,
             example=(([0.5, 0.3, 0.2],), ([1, 0, 0], [0.25, 0.45, 0.3]))),
    Exercise("07.3", expected_survivors, uneven_weights, cases=WHOLE_NUMBERS | {
        "all equal": lambda rng: (np.full(n := int(rng.integers(3, 9)), 1 / n),),
        "one has all": lambda rng: (rng.permutation(np.eye(int(rng.integers(3, 9)))[0]),),
    }, example=(([0.5, 0.5],), 1.5)),
    Exercise("07.4", stratified_error, lambda rng: (
        w := uneven_weights(rng)[0], rng.normal(rng.uniform(-3, 3), 1.0, len(w)),
    ), "challenge", cases={
        "three particles": lambda rng: (np.array([0.5, 0.3, 0.2]), rng.permutation(np.arange(3.0))),
        "light ones last": lambda rng: (np.array([0.22] * 2 + [0.07] * 8), rng.normal(size=10)),
    }, example=(([0.5, 0.3, 0.2], [0, 1, 2]), 0.2333)),
]
