"""Exercises of lesson 17: table 2 as a rule, the row "All" from its two parts, how likely a pose is unable."""

from __future__ import annotations

import math

import numpy as np

from course_lib.lessons.kit.exercises import Exercise, Mistake

# 17.1: table 2


def judge_poses(dx: np.ndarray, dy: np.ndarray, n_used: np.ndarray, n_wrong: np.ndarray) -> np.ndarray:
    """1 (correct), 0 (incorrect) or -1 (unable) for each pose `(n,)`: errors in metres, used and wrong pairs."""
    return _judged(dx, dy, n_used, n_wrong)


def _judged(dx, dy, n_used, n_wrong, fewest: int = 2, limit: float = 2.0) -> np.ndarray:
    is_correct = (n_wrong == 0) & (dx <= limit) & (dy <= limit)
    return np.where(n_used < fewest, -1, is_correct)


def _poses(rng: np.random.Generator) -> tuple:
    """Poses of every kind, in another order each time, close calls among them; an unable pose has no errors."""
    dx, dy = rng.uniform(0, 1.9, size=(2, 10))
    n_used, n_wrong = rng.integers(2, 13, size=10), np.zeros(10, int)
    n_used[:3] = 0, 1, 2
    dx[:2] = dy[:2] = np.nan
    dx[3], dy[4], dx[5] = rng.uniform(2.1, 4.0), rng.uniform(2.1, 4.0), 2.0
    dx[6] = dy[6] = 1.6  # farther off than 2 m in all, but neither in x nor in y
    n_wrong[7], n_wrong[8], dy[8] = 1, 2, 3.0
    n_used[7:9] = 9, 2
    order = rng.permutation(10)
    return dx[order], dy[order], n_used[order], n_wrong[order]


# 17.2: "All" from "correct" and "incorrect"


def combined(n_a: int, mean_a: float, std_a: float, n_b: int, mean_b: float, std_b: float) -> tuple[float, float]:
    """Mean and standard deviation (divisor n) of two groups taken together."""
    mean = (n_a * mean_a + n_b * mean_b) / (n_a + n_b)
    variance = (n_a * (std_a**2 + (mean_a - mean) ** 2) + n_b * (std_b**2 + (mean_b - mean) ** 2)) / (n_a + n_b)
    return mean, math.sqrt(variance)


def _two_groups(rng: np.random.Generator) -> tuple:
    n_a, n_b = int(rng.integers(8, 16)), int(rng.integers(2, 7))
    return n_a, rng.uniform(0.1, 0.5), rng.uniform(0.05, 0.4), n_b, rng.uniform(0.8, 2.0), rng.uniform(0.3, 1.2)


def _weighted(n_a: int, a: float, n_b: int, b: float) -> float:
    return (n_a * a + n_b * b) / (n_a + n_b)


def _without_between(n_a, mean_a, std_a, n_b, mean_b, std_b):
    return _weighted(n_a, mean_a, n_b, mean_b), math.sqrt(_weighted(n_a, std_a**2, n_b, std_b**2))


def _variance(n_a, mean_a, std_a, n_b, mean_b, std_b):
    mean, std = combined(n_a, mean_a, std_a, n_b, mean_b, std_b)
    return mean, std**2


def _divisor_less_one(n_a, mean_a, std_a, n_b, mean_b, std_b):
    mean, std = combined(n_a, mean_a, std_a, n_b, mean_b, std_b)
    return mean, std * math.sqrt((n_a + n_b) / (n_a + n_b - 1))


def _plain_mean(n_a, mean_a, std_a, n_b, mean_b, std_b):
    return (mean_a + mean_b) / 2, combined(n_a, mean_a, std_a, n_b, mean_b, std_b)[1]


def _plain_mean_everywhere(n_a, mean_a, std_a, n_b, mean_b, std_b):
    return combined(1, mean_a, std_a, 1, mean_b, std_b)


def _about_zero(n_a, mean_a, std_a, n_b, mean_b, std_b):
    mean = _weighted(n_a, mean_a, n_b, mean_b)
    return mean, math.sqrt(_weighted(n_a, std_a**2 + mean_a**2, n_b, std_b**2 + mean_b**2))


# 17.3: how likely is "unable"?


def unable_probability(n: int, q: float) -> float:
    """Probability that of n objects, each seen with probability q by itself, at most one is seen."""
    return (1 - q) ** n + n * q * (1 - q) ** (n - 1)


def _objects_and_share(rng: np.random.Generator) -> tuple:
    return int(rng.integers(3, 15)), float(rng.uniform(0.1, 0.8))


EXERCISES = [
    Exercise(
        number="17.1",
        reference=judge_poses,
        inputs=_poses,
        mistakes=(
            Mistake(
                lambda dx, dy, n_used, n_wrong: _judged(dx, dy, n_used, n_wrong, fewest=0),
                "Yours never says unable. With one pair or fewer there is no pose to judge: ask that first.",
            ),
            Mistake(
                lambda dx, dy, n_used, n_wrong: _judged(dx, dy, n_used, n_wrong, fewest=1),
                "One pair is not enough: table 2 calls one or fewer unable.",
            ),
            Mistake(
                lambda dx, dy, n_used, n_wrong: _judged(dx, dy, n_used, n_wrong, fewest=3),
                "Two pairs are enough for a pose: only one or fewer is unable.",
            ),
            Mistake(
                lambda dx, dy, n_used, n_wrong: _judged(dx, dy, n_used, 0),
                "You never ask for wrong pairs. One wrong pair makes a pose incorrect, however small its error.",
            ),
            Mistake(
                lambda dx, dy, n_used, n_wrong: _judged(0, 0, n_used, n_wrong),
                "You do not look at the errors: 2 m or more is incorrect, even if every pair is right.",
            ),
            Mistake(
                lambda dx, dy, n_used, n_wrong: _judged(np.hypot(dx, dy), 0, n_used, n_wrong),
                "You limit the distance. Table 2 limits the errors in x and in y, each by itself.",
            ),
            Mistake(
                lambda dx, dy, n_used, n_wrong: _judged(dx, 0, n_used, n_wrong),
                "You limit the error in x alone; y counts as well.",
            ),
            Mistake(
                lambda dx, dy, n_used, n_wrong: _judged(0, dy, n_used, n_wrong),
                "You limit the error in y alone; x counts as well.",
            ),
            Mistake(
                lambda dx, dy, n_used, n_wrong: _judged(dx, dy, n_used, n_wrong, limit=np.nextafter(2, 0)),
                "Exactly 2 m is within 2 m here: the table gives it to both kinds, and we call it correct.",
            ),
            Mistake(
                lambda dx, dy, n_used, n_wrong: np.where(n_used < 2, -1, (n_wrong == 0) | ((dx <= 2) & (dy <= 2))),
                "Correct needs both: no wrong pair, and small errors. You let one of the two suffice.",
            ),
            Mistake(
                lambda dx, dy, n_used, n_wrong: np.where(
                    n_used - n_wrong < 2, -1, judge_poses(dx, dy, n_used, n_wrong)
                ),
                "You count the right pairs. A pose is unable by the number of pairs *used*, right or wrong.",
            ),
            Mistake(
                lambda dx, dy, n_used, n_wrong: _judged(dx + dy, 0, n_used, n_wrong),
                "You limit the sum of the errors. Table 2 limits the errors in x and in y, each by itself.",
            ),
            Mistake(
                lambda dx, dy, n_used, n_wrong: np.where(n_used < 2, -1, 1 - judge_poses(dx, dy, n_used, n_wrong)),
                "Correct and incorrect are exchanged: 1 is correct, 0 is incorrect.",
            ),
        ),
    ),
    Exercise(
        number="17.2",
        reference=combined,
        inputs=_two_groups,
        mistakes=(
            Mistake(_plain_mean, "Your mean counts both groups alike. The larger group must count for more: use n."),
            Mistake(
                _plain_mean_everywhere, "You count both groups alike, in the mean and in the deviation: weigh with n."
            ),
            Mistake(
                _without_between,
                "You left out how far the two means lie apart. That spreads the whole, too: add (mean_a - mean)².",
            ),
            Mistake(
                lambda n_a, mean_a, std_a, n_b, mean_b, std_b: (
                    _weighted(n_a, mean_a, n_b, mean_b),
                    _weighted(n_a, std_a, n_b, std_b),
                ),
                "Standard deviations cannot be averaged; squares can. Work with variances, take the root at the end.",
            ),
            Mistake(
                lambda n_a, mean_a, std_a, n_b, mean_b, std_b: (
                    _weighted(n_a, mean_a, n_b, mean_b),
                    math.hypot(std_a, std_b),
                ),
                "You add the squares. The groups lie one beside the other: average with n, then add the means' part.",
            ),
            Mistake(_variance, "Your second number is a variance: its root is missing."),
            Mistake(_divisor_less_one, "You divide by n - 1. The paper's rows fit the divisor n."),
            Mistake(
                _about_zero,
                "Your second number is a root mean square about zero. Subtract the common mean from each group's.",
            ),
            Mistake(
                lambda n_a, mean_a, std_a, n_b, mean_b, std_b: (
                    _weighted(n_a, mean_a, n_b, mean_b),
                    math.sqrt(((n_a - 1) * std_a**2 + (n_b - 1) * std_b**2) / (n_a + n_b - 2)),
                ),
                "That is the pooled deviation about each group's own mean. All together scatter about the common mean.",
            ),
            Mistake(
                lambda n_a, mean_a, std_a, n_b, mean_b, std_b: (
                    _weighted(n_a, mean_a, n_b, mean_b),
                    math.sqrt(_weighted(n_a, std_a**2, n_b, std_b**2) + (mean_a - mean_b) ** 2),
                ),
                "You take how far the means are from each other. Each one's distance from the common mean counts.",
            ),
            Mistake(
                lambda n_a, mean_a, std_a, n_b, mean_b, std_b: (
                    _weighted(n_a, mean_a, n_b, mean_b),
                    combined(n_a, mean_a, std_a, n_b, mean_b, std_b)[1] * math.sqrt(n_a + n_b),
                ),
                "The sum of squares is not divided by the number of poses, n_a + n_b.",
            ),
            Mistake(
                lambda n_a, mean_a, std_a, n_b, mean_b, std_b: combined(n_b, mean_a, std_a, n_a, mean_b, std_b),
                "You weigh each group with the other one's number.",
            ),
        ),
        tolerance=1e-9,
    ),
    Exercise(
        number="17.3",
        reference=unable_probability,
        inputs=_objects_and_share,
        mistakes=(
            Mistake(
                lambda n, q: (1 - q) ** n,
                "That is the probability of seeing none. Seeing exactly one is unable, too: add it.",
            ),
            Mistake(
                lambda n, q: n * q * (1 - q) ** (n - 1),
                "That is the probability of exactly one. Seeing none is unable, too: add it.",
            ),
            Mistake(
                lambda n, q: unable_probability(n, q) + math.comb(n, 2) * q**2 * (1 - q) ** (n - 2),
                "Two objects give a pose. Count only none and exactly one.",
            ),
            Mistake(
                lambda n, q: (1 - q) ** n + q * (1 - q) ** (n - 1),
                "The one that is seen may be any of the n objects: count all n ways.",
            ),
            Mistake(
                lambda n, q: (1 - q) ** n + n * q,
                "Exactly one means that the other n - 1 are not seen: multiply by their probability.",
            ),
            Mistake(
                lambda n, q: (1 - q) ** n + n * q * (1 - q) ** n,
                "Beside the one that is seen, n - 1 are left, not n.",
            ),
            Mistake(
                lambda n, q: 1 - unable_probability(n, q),
                "Yours is the probability that a pose is *not* unable.",
            ),
            Mistake(
                lambda n, q: unable_probability(n, 1 - q),
                "You took q for the probability of missing an object; it is that of seeing it.",
            ),
            Mistake(lambda n, q: 100 * unable_probability(n, q), "Yours is in percent; a probability is 0 to 1."),
            Mistake(
                lambda n, q: (1 - q) ** n + (1 - q) ** (n - 1),
                "Exactly one is seen: its own probability q belongs there, and any of the n may be the one.",
            ),
            Mistake(
                lambda n, q: 1 - (1 - q) ** n,
                "That is the probability that at least one is seen. At most one: add none and exactly one.",
            ),
            Mistake(
                lambda n, q: (1 - q) ** n * n * q * (1 - q) ** (n - 1),
                "None and exactly one exclude each other: add their probabilities, do not multiply.",
            ),
        ),
        tolerance=1e-9,
    ),
]
