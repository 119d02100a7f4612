"""Exercises of lesson 13: the row in the lower image, a rig of any direction, pairs and ties, a turned camera."""

import numpy as np

from course_lib.geometry import wrap_angle
from courseware.lessons.kit.exercise import Exercise


def row_below(v, horizontal_range, baseline, height):
    """Rows (n,) in the lower image of points at rows v of the upper image, pixels."""
    # To the elevation, add B / range to its tangent, and back to a row.
    e_u = (0.5 - v / height) * np.pi
    e_l = np.arctan(np.tan(e_u) + baseline / horizontal_range)
    return (0.5 - e_l / np.pi) * height


def rows(rng: np.random.Generator) -> tuple:
    height = int(rng.choice([320, 640, 960]))
    return rng.uniform(0.3, 0.9, 5) * height, rng.uniform(0.6, 5.0), rng.uniform(0.1, 0.6), height


def miss(x_upper, x_lower, baseline):
    """Angles (n,) [rad] from directions x_lower (n, 3) to the epipolar half-circles of x_upper (n, 3)."""
    # The middle of the half-circle, the plane's normal, and the poles for what lies behind.
    ahead = x_upper - np.outer(x_upper @ baseline, baseline)
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    normal = np.cross(baseline, ahead)
    to_plane = np.arcsin(np.clip(np.abs(np.sum(normal * x_lower, axis=1)), 0, 1))
    to_pole = np.arccos(np.clip(np.abs(x_lower @ baseline), 0, 1))
    return np.where(np.sum(ahead * x_lower, axis=1) >= 0, to_plane, to_pole)


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def across(directions, baseline):
    """Return the part of each direction at a right angle to the baseline, with length 1."""
    return unit(directions - np.outer(directions @ baseline, baseline))


def two_cameras(rng: np.random.Generator, baseline=None) -> tuple:
    """Return nine pairs: six near the half-circle, three on the other half."""
    baseline = unit(rng.normal(size=3)) if baseline is None else baseline
    first = across(rng.normal(size=(9, 3)), baseline)
    ahead = first * np.where(np.arange(9) < 6, 1, -1)[:, None]
    second = ahead + np.outer(rng.uniform(-1.5, 1.5, 9), baseline) + rng.normal(0, 0.3, (9, 3))
    return unit(first + np.outer(rng.uniform(-1.5, 1.5, 9), baseline)), unit(second), baseline


def exact_pairs_and_poles(rng: np.random.Generator) -> tuple:
    first, _, baseline = two_cameras(rng)
    second = unit(across(first, baseline) + np.outer(np.linspace(-2, 2, 9), baseline))
    second[:2] = unit(np.stack([baseline, -baseline]) + rng.normal(0, 1e-3, (2, 3)))
    return first, second, baseline


def partners(counts):
    """Column of each row's partner (n,), -1 for none or a tie."""
    # All places of the largest count at once; those alone in row and column are pairs, and all leave.
    table, result = np.array(counts), np.full(len(counts), -1)
    while table.max() > 0:
        largest = table == table.max()
        alone = largest & (largest.sum(axis=1, keepdims=True) == 1) & (largest.sum(axis=0) == 1)
        rows, columns = np.nonzero(alone)
        result[rows] = columns
        table[largest.any(axis=1)] = 0
        table[:, largest.any(axis=0)] = 0
    return result


def tables(rng: np.random.Generator) -> tuple:
    """Return counts with a tie or without, a row of zeros now and then, and two rows that want one column."""
    n, m = int(rng.integers(3, 6)), int(rng.integers(3, 6))
    counts = rng.permutation(np.arange(1, n * m + 1)).reshape(n, m) * 2
    counts[0, 0], counts[1, 0] = 90, 80  # both rows want the first column
    counts[1, 1] = 0 if rng.random() < 0.5 else 70
    if rng.random() < 0.5:
        counts[2] = 0
    tied = [[], [(2, 2), (2, 3 % m)], [(2, 2), (1, 2)], [(1, 2), (2, 1)]][rng.integers(4)]  # the last one is no tie
    for place in tied:
        counts[place] = 75
    # In any order: else the first row and column would be a pair in every table, which a loop too long also finds.
    return (counts[rng.permutation(n)][:, rng.permutation(m)],)


def turn_of_the_lower(azimuth_upper, azimuth_lower):
    """(turn, its standard error) of the lower camera [degrees], from matches of which up to half are wrong."""
    # Where most agree, then the mean of those near, and their spread over the root of their number.
    gap = np.degrees(wrap_angle(azimuth_upper - azimuth_lower))
    neighbours = [np.sum(np.abs((gap - one + 180) % 360 - 180) < 1) for one in gap]
    about = gap[np.argmax(neighbours)]
    near = (gap - about + 180) % 360 - 180
    good = near[np.abs(near) < 1.5]
    turn = (about + good.mean() + 180) % 360 - 180
    return turn, good.std(ddof=1) / np.sqrt(len(good))


def matches(rng: np.random.Generator, turn=None, n=None, noise=None, wrong=None) -> tuple:
    """Return azimuths of n matches that differ by turn and noise [degrees]. A share `wrong` of them lies anywhere."""
    n = int(rng.integers(80, 200)) if n is None else n
    turn = rng.uniform(-180, 180) if turn is None else turn
    noise, wrong = noise or rng.uniform(0.1, 0.4), wrong or rng.uniform(0.2, 0.5)
    upper = rng.uniform(-np.pi, np.pi, n)
    lower = upper - np.radians(turn + rng.normal(0, noise, n))
    strangers = rng.permutation(n) < wrong * n
    lower[strangers] = rng.uniform(-np.pi, np.pi, strangers.sum())
    return upper, wrap_angle(lower)


MANY = 1500  # so many matches, half of them wrong, tell an error bar from one that is off by the root of two


def misjudged(arguments: tuple, answer: object) -> str | None:
    """Say what is wrong with a turn and its standard error, compared with the solution's."""
    try:
        turn, error = (float(np.asarray(part, dtype=float).reshape(())) for part in answer)
    except (TypeError, ValueError):
        return "Give two numbers, separated by a comma: the turn and its standard error, degrees."
    wanted, se = turn_of_the_lower(*arguments)
    n, far = len(arguments[0]), max(4 * se, 0.1)  # a wrong match or two that happen to lie near may pull so much
    off, off_turned, off_radians = abs((np.array([turn, -turn, np.degrees(turn)]) - wanted + 180) % 360 - 180)
    complaints = {
        "There is a NaN or an infinity. Is a mean taken of nothing?": not np.isfinite([turn, error]).all(),
        "Your turn has the wrong sign. If a camera turns left, all moves to the right.": off_turned <= far < off,
        "Your turn is in radians, but the task asks for degrees.": off_radians <= far < off,
        "Your turn is over four standard errors off. Wrong matches or the seam pull at it.": off > far,
        "The turn is right but for whole turns. Bring it to [-180, 180).": not -180 - 1e-9 <= turn < 180 + 1e-9,
        "Your standard error is less than half of what it must be. What do you divide by?": error < 0.5 * se,
        "Your standard error is too small. Did wrong matches help to make it so?": n >= MANY and error < 0.8 * se,
        "That is about the spread of one match. The mean of many is surer.": 0.4 < error / se / np.sqrt(n) < 2,
        "Your standard error is far too large. Do wrong matches add to the spread?": error > 3 * se,
        "Your standard error is too large: one deviation, no 95 % interval.": n >= MANY and error > 1.6 * se,
    }
    return next((sentence for sentence, is_so in complaints.items() if is_so), None)


# fmt: off
EXERCISES = [
    Exercise("13.1", row_below, rows, "warm-up", example=(([320, 480], 2, 0.3, 640), [289.7, 463.5])),
    Exercise("13.2", miss, two_cameras, cases={
        "an upright rig": lambda rng: two_cameras(rng, np.array([0.0, 0.0, 1.0])),
        "cameras side by side": lambda rng: two_cameras(rng, np.array([0.0, 1.0, 0.0])),
        "pairs that obey exactly and directions near the poles": exact_pairs_and_poles,
    }, example=(
        ([[1.0, 0, 0], [1.0, 0, 0], [1.0, 0, 0]], [[0.6, 0.8, 0], [0.8, 0, 0.6], [-0.6, 0.8, 0]], [0, 1, 0]),
        [0, 0.644, 0.644],
    )),
    Exercise("13.3", partners, tables, cases={
        "a tie that goes on from row to row": lambda rng: (np.array([[6, 6, 0], [0, 6, 2], [0, 0, 1]]),),
        "two objects that share nothing": lambda rng: (np.array([[5, 3], [2, 0]]),),
        "a table of zeros": lambda rng: (np.zeros((2, 3), int),), "one count": lambda rng: (np.array([[3]]),),
    }, example=(([[90, 12], [80, 0], [4, 6]],), [0, -1, 1])),
    Exercise("13.4", turn_of_the_lower, matches, "challenge", verify=misjudged, cases={
        "many matches": lambda rng: matches(rng, 40.0, MANY, noise=0.3, wrong=0.5),
        "a turn of nearly half a circle": lambda rng: matches(rng, turn=179.9),
    }),
]
