"""Exercises of lesson 17: table 2 as a rule, the row "All", how likely a pose is unable, and a flattering table."""

import numpy as np

from course_lib.geometry import wrap_angle
from course_lib.lessons.kit.exercises import Exercise

# 17.1: table 2


def judge_poses(dx, dy, n_used, n_wrong):
    """1 (correct), 0 (incorrect) or -1 (unable) for each pose (n,)."""
    # Unable comes first; correct needs all three conditions.
    is_correct = (n_wrong == 0) & (dx <= 2) & (dy <= 2)
    return np.where(n_used <= 1, -1, is_correct)


def poses_of_every_kind(rng: np.random.Generator) -> tuple:
    """In another order each time, close calls among them; an unable pose has no errors."""
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


def close_calls(rng: np.random.Generator) -> tuple:
    """Wrong *and* unable; all pairs wrong, one, most of them; both errors large; one of them, with a wrong pair."""
    dx = np.array([np.nan, np.nan, 0.1, 0.1, 0.1, 3.0, 3.0, 0.1, 2.0])
    dy = np.array([np.nan, np.nan, 0.1, 0.1, 0.1, 3.0, 0.1, 3.0, 2.0])
    return dx, dy, np.array([1, 0, 4, 9, 9, 9, 9, 9, 2]), np.array([1, 0, 4, 1, 6, 0, 1, 0, 0])


# 17.2: "All" from "correct" and "incorrect"


def combined(n_a, mean_a, std_a, n_b, mean_b, std_b):
    """Mean and standard deviation of two groups taken together."""
    # Variance within the groups plus variance between their means.
    mean = (n_a * mean_a + n_b * mean_b) / (n_a + n_b)
    squares = n_a * (std_a**2 + (mean_a - mean) ** 2) + n_b * (std_b**2 + (mean_b - mean) ** 2)
    return mean, np.sqrt(squares / (n_a + n_b))


def two_groups(rng: np.random.Generator) -> tuple:
    n_a, n_b = int(rng.integers(8, 16)), int(rng.integers(2, 7))
    return n_a, rng.uniform(0.1, 0.5), rng.uniform(0.05, 0.4), n_b, rng.uniform(0.8, 2.0), rng.uniform(0.3, 1.2)


def headings_of_table_3(rng: np.random.Generator) -> tuple:
    return 13, 11.94, 25.42, 5, 69.70, 47.09


def equal_means(rng: np.random.Generator) -> tuple:
    return 8, 0.5, 0.2, 8, 0.5, 0.4


def one_pose_each(rng: np.random.Generator) -> tuple:
    return 1, 0.2, 0.0, 1, 0.6, 0.0


# 17.3: how likely is "unable"?


def unable_probability(q):
    """Probability that at most one object is seen, of which each is with its own probability q (n,)."""
    # None, or exactly one, whichever it is.
    none = np.prod(1 - q)
    return none + sum(q[k] * np.prod(1 - np.delete(q, k)) for k in range(len(q)))


def unequal_chances(rng: np.random.Generator) -> tuple:
    return (rng.uniform(0.05, 0.8, int(rng.integers(3, 15))),)


def an_object_always_seen(rng: np.random.Generator) -> tuple:
    return (np.array([1.0, 0.3, 0.5]),)


def objects_never_seen(rng: np.random.Generator) -> tuple:
    return (np.array([0.0, 0.0, 0.4]),)


def one_object(rng: np.random.Generator) -> tuple:
    return (np.array([0.7]),)


def an_empty_room(rng: np.random.Generator) -> tuple:
    return (np.empty(0),)


def equal_chances(rng: np.random.Generator) -> tuple:
    return (np.full(14, 0.25),)


# 17.4: a table that is too good


def row_of_table(found, true):
    """Means (3), then standard deviations (3), of |dx|, |dy| [m] and |dtheta| [degrees]; found (n, 3), NaN: unable."""
    # Unable poses leave first; headings differ on the circle; absolute values come before the mean.
    able = ~np.isnan(found).any(axis=1)
    error = (found - true)[able]
    error[:, 2] = np.degrees(np.arctan2(np.sin(error[:, 2]), np.cos(error[:, 2])))
    error = np.abs(error)
    return np.concatenate([error.mean(axis=0), error.std(axis=0)])


def poses_with_errors(rng: np.random.Generator) -> tuple:
    """Poses with their errors, some of them unable, one turned round, one near half a turn."""
    n = int(rng.integers(8, 20))
    true = np.column_stack([rng.uniform(0, 6, (n, 2)), np.radians(90.0 * rng.integers(-1, 3, n))])
    found = true + rng.normal(0, [0.4, 0.4, 0.3], (n, 3))
    found[0, 2] = true[0, 2] + np.pi + 0.1
    found[:, 2] = wrap_angle(found[:, 2])
    found[rng.permutation(n)[: int(rng.integers(0, 4))]] = np.nan
    return found, true


def headings_of_half_a_turn(rng: np.random.Generator) -> tuple:
    """Found a little to the other side of it: errors of two degrees, not of 358."""
    true = np.array([[1.0, 1.0, np.pi], [2.0, 1.0, np.pi], [3.0, 4.0, 0.0]])
    return true + np.array([[0.1, -0.1, 0.0], [-0.1, 0.1, -2 * np.pi + 0.03], [0.2, 0.2, -0.02]]), true


def flattering_row(found, true, mended=""):
    """The code of the task; mended: what no longer flatters in it, of "unable", "headings" and "means"."""
    difference = (found - true)[~np.isnan(found).any(axis=1)] if "unable" in mended else np.nan_to_num(found - true)
    turn = difference[:, 2]
    difference[:, 2] = np.degrees(np.abs(wrap_angle(turn)) if "headings" in mended else turn % np.pi)
    mean = np.abs(difference).mean(axis=0) if "means" in mended else np.abs(difference.mean(axis=0))
    return np.concatenate([mean, np.abs(difference).std(axis=0)])


# fmt: off
EXERCISES = [
    Exercise("17.1", judge_poses, poses_of_every_kind, "warm-up", cases=[close_calls], mistakes="""
        np.where(n_used <= 1, -1, is_correct) => np.where(n_wrong > 0, 0, np.where(n_used <= 1, -1, is_correct))
        One used pair, and wrong: unable all the same. Ask for unable before you ask for wrong pairs.
        (dx <= 2) & (dy <= 2) => ((dx <= 2) | (dy <= 2))
        Both errors must be within 2 m; with your | one of them is enough.
        (n_wrong == 0) & (dx <= 2) & (dy <= 2) => (n_wrong == 0) | (dx <= 2) | (dy <= 2)
        (n_wrong == 0) & (dx <= 2) & (dy <= 2) => (n_wrong == 0) | (dx <= 2) & (dy <= 2)
        Correct needs three things at once: no wrong pair, x *and* y. Your | lets any one of them suffice.
        n_wrong == 0 => n_wrong < n_used / 2
        n_wrong == 0 => n_wrong < n_used
        You allow some wrong pairs, such as a minority. A single one makes a pose incorrect.
        n_used <= 1 => n_used < 0
        n_used <= 1 => n_used < 1
        One pair is not enough, and with none there is no pose to judge: table 2 calls one or fewer unable.
        n_used <= 1 => n_used <= 2
        Two pairs are enough for a pose: only one or fewer is unable.
        (n_wrong == 0) & =>
        You never ask for wrong pairs. One wrong pair makes a pose incorrect, however small its error.
        & (dx <= 2) & (dy <= 2) =>
        You do not look at the errors: more than 2 m is incorrect, even if every pair is right.
        & (dx <= 2) & (dy <= 2) => & (np.hypot(dx, dy) <= 2)
        & (dx <= 2) & (dy <= 2) => & (dx + dy <= 2)
        Not the distance, nor the sum: table 2 limits the errors in x and in y, each by itself.
        & (dx <= 2) =>
        & (dy <= 2) =>
        You limit one of the two errors alone: x and y both count.
        (dx <= 2) & (dy <= 2) => (dx < 2) & (dy < 2)
        Exactly 2 m is within 2 m here: the table gives it to both kinds, and we call it correct.
        n_used <= 1 => n_used - n_wrong <= 1
        You count the right pairs. A pose is unable by the number of pairs *used*, right or wrong.
        -1, is_correct => -1, ~is_correct
        Correct and incorrect are exchanged: 1 is correct, 0 is incorrect.
    """),
    Exercise("17.2", combined, two_groups, cases=[headings_of_table_3, equal_means, one_pose_each], tolerance=1e-9,
             mistakes="""
        std_a**2 + => and also std_b**2 + =>
        Only the distance of the two means is in your deviation; each group's own scatter is missing.
        squares / => (n_a * std_a**2 + n_b * std_b**2) / and also n_b)) => n_b) + (mean_a-mean)**2 + (mean_b-mean)**2)
        squares / => (n_a * std_a**2 + n_b * std_b**2) / and also n_b)) => n_b) + (mean_a - mean_b) ** 2)
        How far each mean lies from the common one counts for all poses of its group: average that, too.
        return mean => return (mean_a + mean_b) / 2
        mean = (n_a * mean_a + n_b * mean_b) / (n_a + n_b) => mean = (mean_a + mean_b) / 2
        ... => return combined(1, mean_a, std_a, 1, mean_b, std_b)
        You count both groups alike. The larger group must count for more: weigh with n.
        + (mean_a - mean) ** 2 => and also + (mean_b - mean) ** 2 =>
        squares / (n_a + n_b) => ((n_a - 1) * std_a**2 + (n_b - 1) * std_b**2) / max(n_a + n_b - 2, 1)
        You left out how far the two means lie apart. All together scatter about the common mean: add (mean_a - mean)².
        np.sqrt(squares / (n_a + n_b)) => (n_a * std_a + n_b * std_b) / (n_a + n_b)
        Standard deviations cannot be averaged; squares can. Work with variances, take the root at the end.
        np.sqrt(squares / (n_a + n_b)) => np.hypot(std_a, std_b)
        You add the squares. The groups lie one beside the other: average with n, then add the means' part.
        squares / (n_a + n_b) => squares / (n_a + n_b - 1)
        squares / (n_a + n_b) => (squares - std_a**2 - std_b**2) / (n_a + n_b - 1)
        You divide by n - 1. The paper's rows fit the divisor n.
        (mean_a - mean) => mean_a and also (mean_b - mean) => mean_b
        Your second number is a root mean square about zero. Subtract the common mean from each group's.
        squares / (n_a + n_b) => squares
        The sum of squares is not divided by the number of poses, n_a + n_b.
        np.sqrt(squares / (n_a + n_b)) => np.sqrt(squares) / (n_a + n_b)
        That is the standard error of the mean. Asked is how much single poses scatter.
    """),
    Exercise("17.3", unable_probability, unequal_chances, tolerance=1e-9, cases=[
        an_object_always_seen, objects_never_seen, one_object, an_empty_room, equal_chances,
    ], mistakes="""
        ... => with np.errstate(all="ignore"): return np.prod(1 - q) * (1 + np.sum(q / (1 - q)))
        Right, until an object is always seen: then you divide by 1 - q = 0. Multiply the others instead.
        ... => return unable_probability(np.full(len(q), q.mean() if len(q) else 0.0))
        The mean of q is not enough: one object that is always seen and one never are not two of 50 %.
        ... => return np.prod(1 - q)
        That is the probability of seeing none. Seeing exactly one is unable, too: add it.
        none + sum => sum
        That is the probability of exactly one. Seeing none is unable, too: add it.
        q[k] * np.prod(1 - np.delete(q, k)) => q[k]
        Exactly one means that all the others are not seen: multiply by their probabilities.
        np.delete(q, k) => q
        Beside the one that is seen stand the others alone: leave its own 1 - q out of the product.
        none + sum => 1 - none - sum
        Yours is the probability that a pose is *not* unable.
        ... => return unable_probability(1 - q)
        You took q for the probability of missing an object; it is that of seeing it.
        ... => return 1 - np.prod(1 - q)
        That is the probability that at least one is seen. At most one: add none and exactly one.
        none + sum => none * sum
        None and exactly one exclude each other: add their probabilities, do not multiply.
        ... => return np.exp(-np.sum(q)) * (1 + np.sum(q))
        Poisson's formula holds for many objects that are rarely seen. These are few, and q is not small.
    """),
    Exercise("17.4", row_of_table, poses_with_errors, "challenge", cases=[headings_of_half_a_turn], mistakes="""
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
        One fault is left: an unable pose has no error, and so none of 0 m either.
        ... => return flattering_row(found, true, "unable, headings")
        error = np.abs(error) => m, error = error.mean(axis=0), np.abs(error) and also [error.mean(axis=0) => [np.abs(m)
        One fault is left: errors of +1 m and -1 m are no mean error of 0 m.
        np.arctan2(np.sin(error[:, 2]), np.cos(error[:, 2])) => error[:, 2]
        np.arctan2(np.sin(error[:, 2]), np.cos(error[:, 2])) => error[:, 2] % (2 * np.pi)
        Headings of +179 and -179 degrees are 2 degrees apart: take the shorter way on the circle.
        np.degrees(np.arctan2 => (np.arctan2
        Your heading errors are radians; the table has degrees.
        error = np.abs(error) => std, error = error.std(axis=0), np.abs(error) and also error.std(axis=0)] => std]
        Your deviations are of the signed errors. The table has those of the absolute ones.
        np.concatenate => np.column_stack and also std(axis=0)]) => std(axis=0)]).ravel()
        First the three means, then the three deviations: yours alternate.
    """),
]
