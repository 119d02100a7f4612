"""Exercises of lesson 17: table 2 as a rule, the row "All", how likely a pose is unable, and a flattering table."""

import numpy as np

from course_lib.geometry import wrap_angle
from courseware.lessons.kit.exercises import Exercise


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
    }, mistakes="""
        np.where(n_used <= 1, -1, is_correct) => np.where(n_wrong > 0, 0, np.where(n_used <= 1, -1, is_correct))
        One used pair, and wrong: that is unable all the same. Ask for unable before you ask for wrong pairs.
        (dx <= 2) & (dy <= 2) => ((dx <= 2) | (dy <= 2))
        Both errors must be within 2 m. With your | one of them is enough.
        n_wrong == 0 => n_wrong < n_used / 2
        You allow some wrong pairs, such as a minority. A single one makes a pose incorrect.
        n_used <= 1 => n_used < 1
        One pair is not enough, and with none there is no pose to judge: table 2 calls one or fewer unable.
        (n_wrong == 0) & =>
        You never ask for wrong pairs. One wrong pair makes a pose incorrect, however small its error.
        & (dx <= 2) & (dy <= 2) =>
        You do not look at the errors: more than 2 m is incorrect, even if every pair is right.
        & (dx <= 2) & (dy <= 2) => & (np.hypot(dx, dy) <= 2)
        Table 2 limits the errors in x and in y, each by itself. It does not limit the distance or the sum.
        (dx <= 2) & (dy <= 2) => (dx < 2) & (dy < 2)
        Exactly 2 m is within 2 m here: the table gives it to both kinds, and we call it correct.
        n_used <= 1 => n_used - n_wrong <= 1
        You count the right pairs. A pose is unable by the number of pairs *used*, right or wrong.
        -1, is_correct => -1, ~is_correct
        Correct and incorrect are exchanged: 1 is correct, 0 is incorrect.
    """),
    Exercise("17.2", combined, two_groups, tolerance=1e-9, cases={
        "headings of table 3": lambda rng: (13, 11.94, 25.42, 5, 69.70, 47.09),
        "equal means": lambda rng: (8, 0.5, 0.2, 8, 0.5, 0.4), "one pose each": lambda rng: (1, 0.2, 0.0, 1, 0.6, 0.0),
    }, mistakes="""
        std_a**2 + => and also std_b**2 + =>
        Only the distance of the two means is in your deviation. Each group's own scatter is missing.
        mean = (n_a * mean_a + n_b * mean_b) / (n_a + n_b) => mean = (mean_a + mean_b) / 2
        ... => return combined(1, mean_a, std_a, 1, mean_b, std_b)
        You count both groups alike. The larger group must count for more: weigh with n.
        + (mean_a - mean) ** 2 => and also + (mean_b - mean) ** 2 =>
        You left out how far the two means lie apart. All together scatter about the common mean: add (mean_a - mean)².
        np.sqrt(squares / (n_a + n_b)) => (n_a * std_a + n_b * std_b) / (n_a + n_b)
        Standard deviations cannot be averaged, but squares can. Work with variances, take the root at the end.
        np.sqrt(squares / (n_a + n_b)) => np.hypot(std_a, std_b)
        You add the squares. The groups lie one beside the other: average with n, then add the means' part.
        squares / (n_a + n_b) => squares / (n_a + n_b - 1)
        You divide by n - 1. The paper's rows fit the divisor n.
        np.sqrt(squares / (n_a + n_b)) => np.sqrt(squares) / (n_a + n_b)
        That is the standard error of the mean. The task asks how much single poses scatter.
    """),
    Exercise("17.3", unable_probability, lambda rng: (rng.uniform(0.05, 0.8, int(rng.integers(3, 15))),), cases={
        "an object always seen": lambda rng: (np.array([1.0, 0.3, 0.5]),),
        "objects never seen": lambda rng: (np.array([0.0, 0.0, 0.4]),), "one object": lambda rng: (np.array([0.7]),),
        "an empty room": lambda rng: (np.empty(0),), "equal chances": lambda rng: (np.full(14, 0.25),),
    }, tolerance=1e-9, mistakes="""
        ... => with np.errstate(all="ignore"): return np.prod(1 - q) * (1 + np.sum(q / (1 - q)))
        This is right until an object is always seen: then you divide by 1 - q = 0. Multiply the others instead.
        ... => return unable_probability(np.full(len(q), q.mean() if len(q) else 0.0))
        The mean of q is not enough: one object that is always seen and one never are not two of 50 %.
        ... => return np.prod(1 - q)
        That is the probability of seeing none. Seeing exactly one is unable, too: add it.
        none + sum => sum
        That is the probability of exactly one. Seeing none is unable, too: add it.
        q[k] * np.prod(1 - np.delete(q, k)) => q[k]
        Exactly one means that all the others are not seen: multiply by their probabilities.
        np.delete(q, k) => q
        You count the one that is seen among the unseen, too. Leave its own 1 - q out of the product.
        ... => return unable_probability(1 - q)
        You took q for the probability of missing an object. It is the probability of seeing it.
        ... => return 1 - np.prod(1 - q)
        That is the probability that at least one is seen. At most one: add none and exactly one.
    """),
    Exercise("17.4", row_of_table, poses_with_errors, "challenge", cases={
        "headings of half a turn": lambda rng: (  # found a little to the other side: off by 2 degrees, not by 358
            np.array([[1.1, 0.9, np.pi], [1.9, 1.1, 0.03 - np.pi], [3.2, 4.2, -0.02]]),
            np.array([[1.0, 1.0, np.pi], [2.0, 1.0, np.pi], [3.0, 4.0, 0.0]])),
    }, mistakes="""
        ... => return flattering_row(found, true)
        That is the code as it was given. What does it say of a robot that looks exactly backwards?
        ... => return flattering_row(found, true, "means")
        The means are mended. Two faults are left: who is averaged, and what becomes of a robot turned round?
        ... => return flattering_row(found, true, "unable")
        Unable poses are out. Two faults are left: errors of +1 m and -1 m, and a robot turned round.
        ... => return flattering_row(found, true, "headings")
        Headings are mended. Two faults are left: errors of +1 m and -1 m, and what an unable pose counts.
        ... => return flattering_row(found, true, "unable, means")
        np.arctan2(np.sin(error[:, 2]), np.cos(error[:, 2])) => np.abs(error[:, 2]) % np.pi
        A fault is left: a robot that looks exactly backwards has no error of 0 degrees, as a remainder of 180 says.
        ... => return flattering_row(found, true, "headings, means")
        One fault is left: an unable pose has no error, so it does not count as an error of 0 m.
        ... => return flattering_row(found, true, "unable, headings")
        One fault is left: errors of +1 m and -1 m are no mean error of 0 m.
        np.arctan2(np.sin(error[:, 2]), np.cos(error[:, 2])) => error[:, 2]
        Headings of +179 and -179 degrees are 2 degrees apart: take the shorter way on the circle.
        np.degrees(np.arctan2 => (np.arctan2
        Your heading errors are radians; the table has degrees.
        error = np.abs(error) => std, error = error.std(axis=0), np.abs(error) and also error.std(axis=0)] => std]
        Your deviations are of the signed errors. The table has the deviations of the absolute ones.
    """),
]
