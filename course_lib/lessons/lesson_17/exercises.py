"""Exercises of lesson 17: table 2 as a rule, the row "All", how likely a pose is unable, and a flattering table."""

import math
from collections.abc import Callable

import numpy as np

from course_lib.geometry import wrap_angle
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


def _close_calls(rng: np.random.Generator) -> tuple:
    """Wrong *and* unable; all pairs wrong, one, most of them; both errors large; one of them, with a wrong pair."""
    dx = np.array([np.nan, np.nan, 0.1, 0.1, 0.1, 3.0, 3.0, 0.1, 2.0])
    dy = np.array([np.nan, np.nan, 0.1, 0.1, 0.1, 3.0, 0.1, 3.0, 2.0])
    return dx, dy, np.array([1, 0, 4, 9, 9, 9, 9, 9, 2]), np.array([1, 0, 4, 1, 6, 0, 1, 0, 0])


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


def _only_between(n_a, mean_a, std_a, n_b, mean_b, std_b):
    return combined(n_a, mean_a, 0.0, n_b, mean_b, 0.0)


def _between_not_weighed(n_a, mean_a, std_a, n_b, mean_b, std_b):
    mean, within = _weighted(n_a, mean_a, n_b, mean_b), _weighted(n_a, std_a**2, n_b, std_b**2)
    return mean, math.sqrt(within + (mean_a - mean) ** 2 + (mean_b - mean) ** 2)


def _divisors_less_one(n_a, mean_a, std_a, n_b, mean_b, std_b):
    mean = _weighted(n_a, mean_a, n_b, mean_b)
    within = (n_a - 1) * std_a**2 + (n_b - 1) * std_b**2
    between = n_a * (mean_a - mean) ** 2 + n_b * (mean_b - mean) ** 2
    return mean, math.sqrt((within + between) / (n_a + n_b - 1))


# 17.3: how likely is "unable"?


def unable_probability(q: np.ndarray) -> float:
    """Probability that at most one object is seen, of which each is with its own probability q `(n,)`, by itself."""
    return _none(q) + _exactly_one(q)


def _none(q: np.ndarray) -> float:
    return float(np.prod(1 - np.asarray(q)))


def _exactly_one(q: np.ndarray) -> float:
    return float(sum(q[k] * np.prod(1 - np.delete(q, k)) for k in range(len(q))))


def _shares(rng: np.random.Generator) -> tuple:
    return (rng.uniform(0.05, 0.8, int(rng.integers(3, 15))),)


def _by_division(q: np.ndarray) -> float:
    """Right but for an object that is always seen, which divides by zero."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return float(np.prod(1 - q) * (1 + np.sum(q / (1 - q))))


def _equal(q: np.ndarray, share: float) -> float:
    n = len(q)
    return (1 - share) ** n + n * share * (1 - share) ** (n - 1) if n else 1.0


def _from_mean(q: np.ndarray) -> float:
    return _equal(q, float(np.mean(q)) if len(q) else 0.0)


# 17.4: a table that is too good


def row_of_table(found: np.ndarray, true: np.ndarray) -> np.ndarray:
    """Mean and standard deviation `(6,)` of |dx|, |dy| [m] and |dtheta| [deg] of poses `(n, 3)`; NaN rows: unable.

    found, true: [x, y, theta], metres and radians. What table 3 holds in one row.
    """
    return _row(found, true)


def _on_the_circle(radians: np.ndarray) -> np.ndarray:
    return np.degrees(np.abs(wrap_angle(radians)))


def _by_remainder(radians: np.ndarray) -> np.ndarray:
    return np.degrees(radians) % 180


def _row(
    found: np.ndarray,
    true: np.ndarray,
    turned: Callable = _on_the_circle,
    unable_count: bool = False,
    signed: bool = False,
    divisor_less: int = 0,
) -> np.ndarray:
    """The row, right by default; every argument is a fault of the code that the task shows, or of a repair."""
    able = ~np.isnan(found).any(axis=1)
    difference = np.nan_to_num(found - true) if unable_count else (found - true)[able]
    difference[:, 2] = turned(difference[:, 2])
    mean = np.abs(difference.mean(axis=0)) if signed else np.abs(difference).mean(axis=0)
    return np.concatenate([mean, np.abs(difference).std(axis=0, ddof=divisor_less)])


def _poses_found(rng: np.random.Generator) -> tuple:
    """Poses with their errors, some of them unable, one turned round, one near half a turn."""
    n = int(rng.integers(8, 20))
    true = np.column_stack([rng.uniform(0, 6, (n, 2)), np.radians(90.0 * rng.integers(-1, 3, n))])
    found = true + rng.normal(0, [0.4, 0.4, 0.3], (n, 3))
    found[0, 2] = true[0, 2] + np.pi + 0.1
    found[:, 2] = wrap_angle(found[:, 2])
    found[rng.permutation(n)[: int(rng.integers(0, 4))]] = np.nan
    return found, true


def _round_the_wrap(rng: np.random.Generator) -> tuple:
    """Headings of half a turn, found a little to the other side of it: errors of two degrees, not of 358."""
    true = np.array([[1.0, 1.0, np.pi], [2.0, 1.0, np.pi], [3.0, 4.0, 0.0]])
    return true + np.array([[0.1, -0.1, 0.0], [-0.1, 0.1, -2 * np.pi + 0.03], [0.2, 0.2, -0.02]]), true


def _fault(**left: object) -> Callable:
    return lambda found, true: _row(found, true, **left)


def _deviations_signed(found: np.ndarray, true: np.ndarray) -> np.ndarray:
    difference = (found - true)[~np.isnan(found).any(axis=1)]
    difference[:, 2] = np.degrees(wrap_angle(difference[:, 2]))
    return np.concatenate([np.abs(difference).mean(axis=0), difference.std(axis=0)])


EXERCISES = [
    Exercise(
        number="17.1",
        solution=judge_poses,
        inputs=_poses,
        level="warm-up",
        cases=(_close_calls,),
        mistakes=(
            Mistake(
                lambda dx, dy, n_used, n_wrong: np.where(n_wrong > 0, 0, judge_poses(dx, dy, n_used, n_wrong)),
                "One used pair, and wrong: unable all the same. Ask for unable before you ask for wrong pairs.",
            ),
            Mistake(
                lambda dx, dy, n_used, n_wrong: np.where(n_used < 2, -1, (n_wrong == 0) & ((dx <= 2) | (dy <= 2))),
                "Both errors must be within 2 m; with your | one of them is enough.",
            ),
            Mistake(
                lambda dx, dy, n_used, n_wrong: np.where(n_used < 2, -1, (n_wrong == 0) | (dx <= 2) | (dy <= 2)),
                "Correct needs three things at once: no wrong pair, x *and* y. Your | lets any one of them suffice.",
            ),
            Mistake(
                lambda dx, dy, n_used, n_wrong: np.where(
                    n_used < 2, -1, (n_wrong < n_used / 2) & (dx <= 2) & (dy <= 2)
                ),
                "You allow a minority of wrong pairs. A single one makes a pose incorrect.",
            ),
            Mistake(
                lambda dx, dy, n_used, n_wrong: np.where(n_used < 2, -1, (n_wrong < n_used) & (dx <= 2) & (dy <= 2)),
                "You call it incorrect only where all pairs are wrong. A single one is enough.",
            ),
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
        solution=combined,
        inputs=_two_groups,
        cases=(
            lambda rng: (13, 11.94, 25.42, 5, 69.70, 47.09),
            lambda rng: (8, 0.5, 0.2, 8, 0.5, 0.4),
            lambda rng: (1, 0.2, 0.0, 1, 0.6, 0.0),
        ),
        mistakes=(
            Mistake(
                _only_between,
                "Only the distance of the two means is in your deviation; each group's own scatter is missing.",
            ),
            Mistake(
                _between_not_weighed,
                "How far each mean lies from the common one counts for all poses of its group: average that, too.",
            ),
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
                    math.sqrt(((n_a - 1) * std_a**2 + (n_b - 1) * std_b**2) / max(n_a + n_b - 2, 1)),
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
            Mistake(
                lambda n_a, mean_a, std_a, n_b, mean_b, std_b: (
                    combined(n_a, mean_a, std_a, n_b, mean_b, std_b)[0],
                    combined(n_a, mean_a, std_a, n_b, mean_b, std_b)[1] / math.sqrt(n_a + n_b),
                ),
                "That is the standard error of the mean. Asked is how much single poses scatter.",
            ),
        ),
        tolerance=1e-9,
    ),
    Exercise(
        number="17.3",
        solution=unable_probability,
        inputs=_shares,
        cases=(
            lambda rng: (np.array([1.0, 0.3, 0.5]),),
            lambda rng: (np.array([0.0, 0.0, 0.4]),),
            lambda rng: (np.array([0.7]),),
            lambda rng: (np.empty(0),),
            lambda rng: (np.full(14, 0.25),),
        ),
        mistakes=(
            Mistake(
                _by_division,
                "Right, until an object is always seen: then you divide by 1 - q = 0. Multiply the others instead.",
            ),
            Mistake(
                _from_mean,
                "The mean of q is not enough: one object that is always seen and one never are not two of 50 %.",
            ),
            Mistake(_none, "That is the probability of seeing none. Seeing exactly one is unable, too: add it."),
            Mistake(_exactly_one, "That is the probability of exactly one. Seeing none is unable, too: add it."),
            Mistake(
                lambda q: _none(q) + float(np.sum(q)),
                "Exactly one means that all the others are not seen: multiply by their probabilities.",
            ),
            Mistake(
                lambda q: _none(q) * (1 + float(np.sum(q))),
                "Beside the one that is seen stand the others alone: leave its own 1 - q out of the product.",
            ),
            Mistake(lambda q: 1 - unable_probability(q), "Yours is the probability that a pose is *not* unable."),
            Mistake(
                lambda q: unable_probability(1 - q),
                "You took q for the probability of missing an object; it is that of seeing it.",
            ),
            Mistake(lambda q: 100 * unable_probability(q), "Yours is in percent; a probability is 0 to 1."),
            Mistake(
                lambda q: 1 - _none(q),
                "That is the probability that at least one is seen. At most one: add none and exactly one.",
            ),
            Mistake(
                lambda q: _none(q) * _exactly_one(q),
                "None and exactly one exclude each other: add their probabilities, do not multiply.",
            ),
            Mistake(
                lambda q: float(np.exp(-np.sum(q)) * (1 + np.sum(q))),
                "Poisson's formula holds for many objects that are rarely seen. These are few, and q is not small.",
            ),
        ),
        tolerance=1e-9,
    ),
    Exercise(
        number="17.4",
        solution=row_of_table,
        inputs=_poses_found,
        level="challenge",
        cases=(_round_the_wrap,),
        mistakes=(
            Mistake(
                _fault(turned=_by_remainder, unable_count=True, signed=True),
                "That is the code as it was given. What does it say of a robot that looks exactly backwards?",
            ),
            Mistake(
                _fault(turned=_by_remainder, unable_count=True),
                "The means are mended. Two faults are left: who is averaged, and what becomes of a robot turned round?",
            ),
            Mistake(
                _fault(turned=_by_remainder, signed=True),
                "Unable poses are out. Two faults are left: errors of +1 m and -1 m, and a robot turned round.",
            ),
            Mistake(
                _fault(unable_count=True, signed=True),
                "Headings are mended. Two faults are left: errors of +1 m and -1 m, and what an unable pose counts.",
            ),
            Mistake(
                _fault(turned=_by_remainder),
                "One fault is left: a robot that looks exactly backwards has no error of 0 degrees.",
            ),
            Mistake(
                _fault(unable_count=True),
                "One fault is left: an unable pose has no error, and so none of 0 m either.",
            ),
            Mistake(
                _fault(signed=True),
                "One fault is left: errors of +1 m and -1 m are no mean error of 0 m.",
            ),
            Mistake(
                _fault(turned=lambda radians: np.degrees(np.abs(radians))),
                "Headings of +179 and -179 degrees are 2 degrees apart: take the difference on the circle.",
            ),
            Mistake(
                _fault(turned=lambda radians: np.abs(wrap_angle(radians))),
                "Your heading errors are radians; the table has degrees.",
            ),
            Mistake(_fault(divisor_less=1), "The divisor n was no fault: the paper's rows fit it (see 17.2)."),
            Mistake(
                _fault(turned=lambda radians: np.degrees(wrap_angle(radians)), signed=True),
                "Two faults are mended, one is left: errors of +1 m and -1 m still cancel in your mean.",
            ),
            Mistake(
                _fault(turned=lambda radians: np.degrees(radians) % 360),
                "Half of the circle is still missing: an error of -2 degrees becomes 358. Take the shorter way.",
            ),
            Mistake(
                _fault(turned=lambda radians: np.abs(np.degrees(radians)) % 180),
                "A remainder of 180 calls a robot that looks backwards perfect. Take the difference on the circle.",
            ),
            Mistake(
                _deviations_signed,
                "Your deviations are of the signed errors. The table has those of the absolute ones.",
            ),
            Mistake(
                lambda found, true: row_of_table(found, true).reshape(2, 3).T.ravel(),
                "First the three means, then the three deviations: yours alternate.",
            ),
        ),
    ),
]
