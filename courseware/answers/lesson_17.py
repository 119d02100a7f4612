"""Exercises of lesson 17: table 2 as a rule, the row "All", how likely a pose is unable, and a flattering table."""

import numpy as np

from course_lib.geometry import wrap_angle
from courseware.lessons.kit.exercise import Exercise


def judge_poses(dx, dy, n_used, n_wrong):
    """1 (correct), 0 (incorrect) or -1 (unable) for each pose (n,)."""
    # Unable comes first; correct needs all three conditions.
    is_correct = (n_wrong == 0) & (dx <= 2) & (dy <= 2)
    return np.where(n_used <= 1, -1, is_correct)


def poses_of_every_kind(rng: np.random.Generator) -> tuple:
    """Return poses in random order, with close calls among them. An unable pose has no errors."""
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


def combined(n_a, mean_a, std_a, n_b, mean_b, std_b):
    """Mean and standard deviation of two groups taken together."""
    # Variance within the groups plus variance between their means.
    mean = (n_a * mean_a + n_b * mean_b) / (n_a + n_b)
    squares = n_a * (std_a**2 + (mean_a - mean) ** 2) + n_b * (std_b**2 + (mean_b - mean) ** 2)
    return mean, np.sqrt(squares / (n_a + n_b))


def two_groups(rng: np.random.Generator) -> tuple:
    n_a, n_b = int(rng.integers(8, 16)), int(rng.integers(2, 7))
    return n_a, rng.uniform(0.1, 0.5), rng.uniform(0.05, 0.4), n_b, rng.uniform(0.8, 2.0), rng.uniform(0.3, 1.2)


def unable_probability(q):
    """Probability that at most one object is seen, of which each is with its own probability q (n,)."""
    # None, or exactly one, whichever it is.
    none = np.prod(1 - q)
    return none + sum(q[k] * np.prod(1 - np.delete(q, k)) for k in range(len(q)))


def row_of_table(found, true):
    """Means (3), then standard deviations (3), of |dx|, |dy| [m] and |dtheta| [degrees]; found (n, 3), NaN: unable."""
    # Unable poses leave first; headings differ on the circle; absolute values come before the mean.
    able = ~np.isnan(found).any(axis=1)
    error = (found - true)[able]
    error[:, 2] = np.degrees(np.arctan2(np.sin(error[:, 2]), np.cos(error[:, 2])))
    error = np.abs(error)
    return np.concatenate([error.mean(axis=0), error.std(axis=0)])


def poses_with_errors(rng: np.random.Generator) -> tuple:
    """Return found and true poses, some of them unable, one turned round, one near half a turn."""
    n = int(rng.integers(8, 20))
    true = np.column_stack([rng.uniform(0, 6, (n, 2)), np.radians(90.0 * rng.integers(-1, 3, n))])
    found = true + rng.normal(0, [0.4, 0.4, 0.3], (n, 3))
    found[0, 2] = true[0, 2] + np.pi + 0.1
    found[:, 2] = wrap_angle(found[:, 2])
    found[rng.permutation(n)[: int(rng.integers(0, 4))]] = np.nan
    return found, true


def flattering_row(found, true, mended=""):
    """The code of the task; mended: what no longer flatters in it, of "unable", "headings" and "means"."""
    difference = (found - true)[~np.isnan(found).any(axis=1)] if "unable" in mended else np.nan_to_num(found - true)
    turn = difference[:, 2]
    difference[:, 2] = np.degrees(np.abs(wrap_angle(turn)) if "headings" in mended else turn % np.pi)
    mean = np.abs(difference).mean(axis=0) if "means" in mended else np.abs(difference.mean(axis=0))
    return np.concatenate([mean, np.abs(difference).std(axis=0)])


# fmt: off
EXERCISES = [
    Exercise("17.1", judge_poses, poses_of_every_kind, "warm-up", cases={
        "close calls": lambda rng: (  # wrong *and* unable; all, one or most pairs wrong; one or both errors large
            *np.array([[np.nan, np.nan, 0.1, 0.1, 0.1, 3, 3, 0.1, 2], [np.nan, np.nan, 0.1, 0.1, 0.1, 3, 0.1, 3, 2]]),
            *np.array([[1, 0, 4, 9, 9, 9, 9, 9, 2], [1, 0, 4, 1, 6, 0, 1, 0, 0]])),
    }, example=(([0.1, 0.1, np.nan], [0.2, 2.5, np.nan], [9, 9, 1], [0, 0, 0]), [1, 0, -1])),
    Exercise("17.2", combined, two_groups, tolerance=1e-9, cases={
        "headings of table 3": lambda rng: (13, 11.94, 25.42, 5, 69.70, 47.09),
        "equal means": lambda rng: (8, 0.5, 0.2, 8, 0.5, 0.4), "one pose each": lambda rng: (1, 0.2, 0.0, 1, 0.6, 0.0),
    }),
    Exercise("17.3", unable_probability, lambda rng: (rng.uniform(0.05, 0.8, int(rng.integers(3, 15))),), cases={
        "an object always seen": lambda rng: (np.array([1.0, 0.3, 0.5]),),
        "objects never seen": lambda rng: (np.array([0.0, 0.0, 0.4]),), "one object": lambda rng: (np.array([0.7]),),
        "an empty room": lambda rng: (np.empty(0),), "equal chances": lambda rng: (np.full(14, 0.25),),
    }, tolerance=1e-9, example=(([0.9, 0.5, 0.1],), 0.5)),
    Exercise("17.4", row_of_table, poses_with_errors, "challenge", cases={
        "headings of half a turn": lambda rng: (  # found a little to the other side: off by 2 degrees, not by 358
            np.array([[1.1, 0.9, np.pi], [1.9, 1.1, 0.03 - np.pi], [3.2, 4.2, -0.02]]),
            np.array([[1.0, 1.0, np.pi], [2.0, 1.0, np.pi], [3.0, 4.0, 0.0]])),
    }),
]
