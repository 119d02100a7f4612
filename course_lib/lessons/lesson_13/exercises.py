"""Exercises of lesson 13: the row in the lower image, a rig of any direction, pairs and ties, a turned camera."""

from collections.abc import Callable

import numpy as np
from scipy.optimize import linear_sum_assignment

from course_lib.geometry import wrap_angle
from course_lib.lessons.kit.exercises import Exercise, Mistake
from course_lib.spherical_stereo.matching.object_matching import pair_by_most_matches

# 13.1: the row in the lower image


def lower_row(v: np.ndarray, horizontal_range: float, baseline: float, height: int) -> np.ndarray:
    """Row `(n,)` in the lower image of points at rows v of the upper one: tan e_l = tan e_u + baseline / range."""
    slope = np.tan(_elevation(v, height)) + baseline / horizontal_range
    return _row(np.arctan(slope), height)


def _elevation(v: np.ndarray, height: int) -> np.ndarray:
    return (0.5 - v / height) * np.pi


def _row(elevation: np.ndarray, height: int) -> np.ndarray:
    return (0.5 - elevation / np.pi) * height


def _rows(rng: np.random.Generator) -> tuple:
    height = int(rng.choice([320, 640, 960]))
    return rng.uniform(0.3, 0.9, 5) * height, rng.uniform(0.6, 5.0), rng.uniform(0.1, 0.6), height


def _row_of_a_higher_camera(v: np.ndarray, horizontal_range: float, baseline: float, height: int) -> np.ndarray:
    return lower_row(v, horizontal_range, -baseline, height)


def _row_from_angles_added(v: np.ndarray, horizontal_range: float, baseline: float, height: int) -> np.ndarray:
    return _row(_elevation(v, height) + baseline / horizontal_range, height)


def _row_without_arctan(v: np.ndarray, horizontal_range: float, baseline: float, height: int) -> np.ndarray:
    return _row(np.tan(_elevation(v, height)) + baseline / horizontal_range, height)


def _elevation_for_row(v: np.ndarray, horizontal_range: float, baseline: float, height: int) -> np.ndarray:
    return _elevation(lower_row(v, horizontal_range, baseline, height), height)


def _row_with_the_angle_of_the_level(
    v: np.ndarray, horizontal_range: float, baseline: float, height: int
) -> np.ndarray:
    return _row(_elevation(v, height) + np.arctan(baseline / horizontal_range), height)


def _row_at_a_slant(v: np.ndarray, horizontal_range: float, baseline: float, height: int) -> np.ndarray:
    """Takes the range along the ray of the upper camera."""
    e_u = _elevation(v, height)
    return _row(np.arctan2(horizontal_range * np.sin(e_u) + baseline, horizontal_range * np.cos(e_u)), height)


# 13.2: how far a direction misses the epipolar half-circle of another, for a rig of any direction


def miss(x_upper: np.ndarray, x_lower: np.ndarray, baseline: np.ndarray) -> np.ndarray:
    """Angles (n,) from directions x_lower (n, 3) to the half-circles of x_upper (n, 3); baseline: unit vector (3,)."""
    ahead = _across_the_baseline(x_upper, baseline)
    beside = np.abs(np.sum(x_lower * np.cross(baseline, ahead), axis=1))
    on_this_half = np.sum(x_lower * ahead, axis=1) >= 0
    return np.where(on_this_half, _arcsin(beside), _arccos(np.abs(x_lower @ baseline)))


def _across_the_baseline(directions: np.ndarray, baseline: np.ndarray) -> np.ndarray:
    """The part of each direction at a right angle to the baseline, of length 1."""
    part = directions - np.outer(directions @ baseline, baseline)
    return part / np.linalg.norm(part, axis=1, keepdims=True)


def _arcsin(values: np.ndarray) -> np.ndarray:
    return np.arcsin(np.clip(values, -1, 1))


def _arccos(values: np.ndarray) -> np.ndarray:
    return np.arccos(np.clip(values, -1, 1))


def _beside(x_upper: np.ndarray, x_lower: np.ndarray, baseline: np.ndarray) -> np.ndarray:
    """Sine of the angle to the plane, with its sign."""
    return np.sum(x_lower * np.cross(baseline, _across_the_baseline(x_upper, baseline)), axis=1)


def _behind(pole: Callable) -> Callable:
    """A mistake: `pole(x_lower, baseline)` where the direction lies on the other half."""

    def mistaken(x_upper: np.ndarray, x_lower: np.ndarray, baseline: np.ndarray) -> np.ndarray:
        ahead = _across_the_baseline(x_upper, baseline)
        found = miss(x_upper, x_lower, baseline)
        return np.where(np.sum(x_lower * ahead, axis=1) >= 0, found, pole(x_lower, baseline))

    return mistaken


def _along_the_other_side(x_upper: np.ndarray, x_lower: np.ndarray, baseline: np.ndarray) -> np.ndarray:
    """pi minus the angle to the plane, where the direction lies on the other half."""
    ahead, beside = _across_the_baseline(x_upper, baseline), _arcsin(np.abs(_beside(x_upper, x_lower, baseline)))
    return np.where(np.sum(x_lower * ahead, axis=1) >= 0, beside, np.pi - beside)


def _triple_product(x_upper: np.ndarray, x_lower: np.ndarray, baseline: np.ndarray) -> np.ndarray:
    return np.cross(x_upper, x_lower) @ baseline


def _sides_by_the_angle(x_upper: np.ndarray, x_lower: np.ndarray, baseline: np.ndarray) -> np.ndarray:
    """Takes the half by the angle between the two directions themselves."""
    near = np.sum(x_upper * x_lower, axis=1) >= 0
    beside = np.abs(_beside(x_upper, x_lower, baseline))
    return np.where(near, _arcsin(beside), _arccos(np.abs(x_lower @ baseline)))


def _normal_not_of_length_one(x_upper: np.ndarray, x_lower: np.ndarray, baseline: np.ndarray) -> np.ndarray:
    """The normal b x x_upper as it is; the rest is right."""
    on_this_half = np.sum(x_lower * _across_the_baseline(x_upper, baseline), axis=1) >= 0
    beside = _arcsin(np.abs(_triple_product(x_upper, x_lower, baseline)))
    return np.where(on_this_half, beside, _arccos(np.abs(x_lower @ baseline)))


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def _two_cameras(rng: np.random.Generator, baseline: np.ndarray | None = None) -> tuple:
    """Nine pairs: three near the half-circle, three anywhere, three on the other half."""
    baseline = _unit(rng.normal(size=3)) if baseline is None else baseline
    first = _unit(rng.normal(size=(9, 3)))
    first = _unit(_across_the_baseline(first, baseline) + np.outer(rng.uniform(-1.5, 1.5, 9), baseline))
    ahead = _across_the_baseline(first, baseline) * np.where(np.arange(9) < 6, 1, -1)[:, None]
    second = ahead + np.outer(rng.uniform(-1.5, 1.5, 9), baseline) + rng.normal(0, 0.3, (9, 3))
    return first, _unit(second), baseline


def _in_the_plane(rng: np.random.Generator) -> tuple:
    """Pairs that obey the constraint exactly, and directions close to both poles."""
    first, _, baseline = _two_cameras(rng)
    second = _unit(_across_the_baseline(first, baseline) + np.outer(np.linspace(-2, 2, 9), baseline))
    second[:2] = _unit(np.stack([baseline, -baseline]) + rng.normal(0, 1e-3, (2, 3)))
    return first, second, baseline


# 13.3: one-to-one by most matches


def partners(counts: np.ndarray) -> np.ndarray:
    """Column `(n,)` that each row of a table of counts `(n, m)` is paired with, most first; -1: none, or a tie."""
    result = np.full(len(counts), -1)
    for i, j in pair_by_most_matches(counts)[0]:
        result[i] = j
    return result


def _first_of_a_tie(counts: np.ndarray) -> np.ndarray:
    """Repeated `argmax`, as in the lesson: of a tie, what comes first in the list."""
    counts, result = np.array(counts), np.full(len(counts), -1)
    while counts.max() > 0:
        i, j = np.unravel_index(counts.argmax(), counts.shape)
        result[i] = j
        counts[i], counts[:, j] = 0, 0
    return result


def _with_ties(
    counts: np.ndarray,
    rows: bool = True,
    columns: bool = True,
    anywhere: bool = False,
    columns_out: bool = True,
    rows_out: bool = True,
    stop: bool = False,
) -> np.ndarray:
    """`partners` with the slips that a mistake makes."""
    counts, result = np.array(counts), np.full(len(counts), -1)
    while counts.max() > 0:
        i, j = np.unravel_index(counts.argmax(), counts.shape)
        largest = counts == counts[i, j]
        in_row, in_column = largest[i].sum() > 1, largest[:, j].sum() > 1
        tied = (rows and in_row) or (columns and in_column) or (anywhere and largest.sum() > 1)
        if tied and stop:
            break
        # All that hangs together by the largest count: rows by columns, and columns by rows.
        of_row, of_column = np.arange(len(counts)) == i, np.arange(counts.shape[1]) == j
        for _ in range(sum(counts.shape) if tied else 0):
            of_column = of_column | largest[of_row].any(axis=0)
            of_row = of_row | largest[:, of_column].any(axis=1)
        if not tied:
            result[i] = j
        counts[of_row if rows_out or not tied else np.zeros(0, int)] = 0
        counts[:, of_column if columns_out or not tied else np.zeros(0, int)] = 0
        if not (rows_out and columns_out) and tied:
            counts[np.ix_(of_row, of_column)] = 0
    return result


def _tables(rng: np.random.Generator) -> tuple:
    """Counts with a tie or without, a row of zeros now and then, and rows that want one column."""
    n, m = int(rng.integers(3, 6)), int(rng.integers(3, 6))
    counts = rng.permutation(np.arange(1, n * m + 1)).reshape(n, m) * 2
    counts[0, 0], counts[1, 0] = 90, 80  # both rows want the first column
    counts[1, 1] = 0 if rng.random() < 0.5 else 70
    if rng.random() < 0.5:
        counts[2] = 0
    tie = rng.integers(4)
    if tie == 1:
        counts[2, 2] = counts[2, (2 + 1) % m] = 75  # one row, two columns
    if tie == 2:
        counts[2, 2] = counts[1, 2] = 75  # two rows, one column
    if tie == 3:
        counts[1, 2] = counts[2, 1] = 75  # equal, but no tie
    # In any order: else the first row and column would be a pair in every table, which a loop too long also finds.
    return (counts[rng.permutation(n)][:, rng.permutation(m)],)


def _each_row_its_best(counts: np.ndarray) -> np.ndarray:
    return np.where(counts.max(axis=1) > 0, counts.argmax(axis=1), -1)


def _zeros_paired(counts: np.ndarray) -> np.ndarray:
    counts, result = np.array(counts), np.full(len(counts), -1)
    while counts.max() >= 0:
        i, j = np.unravel_index(counts.argmax(), counts.shape)
        result[i] = j
        counts[i], counts[:, j] = -1, -1
    return result


def _columns_stay_free(counts: np.ndarray) -> np.ndarray:
    return np.argmax(counts, axis=1)


def _row_by_row(counts: np.ndarray) -> np.ndarray:
    """The rows in their order: each takes the best column that is left."""
    counts, result = np.array(counts), np.full(len(counts), -1)
    for i in range(len(counts)):
        if counts[i].max() > 0:
            result[i] = counts[i].argmax()
            counts[:, result[i]] = 0
    return result


def _repeated_maximum(counts: np.ndarray, rounds: int) -> np.ndarray:
    """A mistake: so many rounds, whether or not a count above 0 is left."""
    counts, result = np.array(counts), np.full(len(counts), -1)
    for _ in range(rounds):
        i, j = np.unravel_index(counts.argmax(), counts.shape)
        result[i] = j
        counts[i], counts[:, j] = 0, 0
    return result


def _rows_stay_open(counts: np.ndarray) -> np.ndarray:
    counts, result = np.array(counts), np.full(len(counts), -1)
    while counts.max() > 0:
        i, j = np.unravel_index(counts.argmax(), counts.shape)
        result[i] = j
        counts[:, j] = 0
    return result


def _largest_sum(counts: np.ndarray) -> np.ndarray:
    result = np.full(len(counts), -1)
    rows, columns = linear_sum_assignment(counts, maximize=True)
    result[rows] = np.where(counts[rows, columns] > 0, columns, -1)
    return result


def _mutual_best(counts: np.ndarray) -> np.ndarray:
    best = counts.argmax(axis=1)
    mutual = (counts.argmax(axis=0)[best] == np.arange(len(counts))) & (counts.max(axis=1) > 0)
    return np.where(mutual, best, -1)


# 13.4: a lower camera that is turned


def turn_of_the_lower(azimuth_upper: np.ndarray, azimuth_lower: np.ndarray) -> tuple[float, float]:
    """(turn, its standard error), degrees, from the azimuths (n,) of matches of which up to half are wrong.

    The turn that most matches agree on, within `WINDOW`; then the mean of those, twice.
    """
    gap = np.degrees(wrap_angle(np.asarray(azimuth_upper) - np.asarray(azimuth_lower)))
    turn = gap[np.argmax([(np.abs(_wrap_deg(gap - one)) < WINDOW).sum() for one in gap])]
    for _ in range(3):
        near = _wrap_deg(gap - turn)
        good = near[np.abs(near) < WINDOW]
        turn = _wrap_deg(turn + good.mean())
    return float(turn), float(good.std(ddof=1) / np.sqrt(len(good)))


WINDOW = 1.5  # degrees: right matches scatter by 0.4 at most, wrong ones anywhere


def _wrap_deg(angle):
    return (angle + 180) % 360 - 180


def _matches(rng: np.random.Generator, turn: float | None = None, n: int | None = None) -> tuple:
    n = int(rng.integers(80, 200)) if n is None else n
    turn = rng.uniform(-180, 180) if turn is None else turn
    return _some_wrong(rng, turn, n, rng.uniform(0.1, 0.4), rng.uniform(0.2, 0.5))


def _some_wrong(rng: np.random.Generator, turn: float, n: int, noise: float, share: float) -> tuple:
    """n matches with noise (degrees) of which a share is wrong."""
    upper = rng.uniform(-np.pi, np.pi, n)
    lower = upper - np.radians(turn + rng.normal(0, noise, n))
    wrong = rng.permutation(n) < share * n
    lower[wrong] = rng.uniform(-np.pi, np.pi, wrong.sum())
    return upper, wrap_angle(lower)


MANY = 1500
"""So many matches, half of them wrong, tell an error bar from one that is off by the root of two."""


def _misjudged(arguments: tuple, answer: object) -> str | None:
    """What is wrong with a turn and its standard error, against those of the matches that agree."""
    try:
        turn, error = (float(np.asarray(part, dtype=float).reshape(())) for part in answer)
    except (TypeError, ValueError):
        return "Give two numbers, separated by a comma: the turn and its standard error, degrees."
    wanted, se = turn_of_the_lower(*arguments)
    n = len(arguments[0])
    far = max(4 * se, 0.1)  # a wrong match or two that happen to lie near may pull at a good answer so much
    if not np.isfinite([turn, error]).all():
        return "There is a NaN or an infinity in your result: is a mean taken of nothing?"
    if abs(_wrap_deg(turn - wanted)) > far:
        if abs(_wrap_deg(turn + wanted)) <= far:
            return "Your turn has the wrong sign: a camera that turns left sees everything move to the right."
        if abs(_wrap_deg(np.degrees(turn) - wanted)) <= far:
            return "Your turn is in radians; the task asks for degrees."
        return "Your turn is more than four standard errors off: wrong matches pull at it, or the seam does."
    if not -180 - 1e-9 <= turn < 180 + 1e-9:
        return "The turn is right but for whole turns: bring it to [-180, 180)."
    if n >= MANY and 0.5 * se <= error < 0.8 * se:
        return "Your standard error is too small by a quarter or more: did wrong matches help to make the mean sure?"
    if n >= MANY and 1.6 * se < error < 3 * se:
        return "Your standard error is too large: one standard deviation is asked for, no 95 % interval."
    if error < 0.5 * se:
        return "Your standard error is less than half of what it must be. By how many right matches do you divide?"
    if error > 3 * se:  # a wrong match that happens to lie near may widen it
        if 0.4 * se * np.sqrt(n) < error < 2 * se * np.sqrt(n):
            return "That is about the spread of one match. The mean of many is surer: by which factor?"
        return "Your standard error is far too large: do wrong matches add to the spread?"
    return None


def _of_all(direction: Callable) -> Callable:
    """A mistake: `direction(gap_deg)` of all matches, right and wrong."""

    def mistaken(azimuth_upper: np.ndarray, azimuth_lower: np.ndarray) -> tuple[float, float]:
        gap = np.degrees(wrap_angle(azimuth_upper - azimuth_lower))
        return float(direction(gap)), float(gap.std(ddof=1) / np.sqrt(len(gap)))

    return mistaken


def _circular_mean_deg(gap: np.ndarray) -> float:
    return np.degrees(np.angle(np.exp(1j * np.radians(gap)).sum()))


def _one_of_a_tie_out(counts: np.ndarray) -> np.ndarray:
    """Of a tie the first row and the first column are out; what else it joins may go on."""
    counts, result = np.array(counts), np.full(len(counts), -1)
    while counts.max() > 0:
        i, j = np.unravel_index(counts.argmax(), counts.shape)
        largest = counts == counts[i, j]
        if largest[i].sum() == 1 == largest[:, j].sum():
            result[i] = j
        counts[i], counts[:, j] = 0, 0
    return result


def _all_that_is_equal_out(counts: np.ndarray) -> np.ndarray:
    """Where the largest count stands twice, anywhere, the rows and columns of all of them are out."""
    counts, result = np.array(counts), np.full(len(counts), -1)
    while counts.max() > 0:
        places = np.argwhere(counts == counts.max())
        if len(places) == 1:
            result[places[0][0]] = places[0][1]
        for i, j in places:
            counts[i], counts[:, j] = 0, 0
    return result


def _ties_of_the_whole_table(counts: np.ndarray) -> np.ndarray:
    """Pairs first, then leaves out those whose count stands twice in the row or column of the table as given."""
    result = _first_of_a_tie(counts)
    for i, j in enumerate(result):
        if j >= 0 and max(np.sum(counts[i] == counts[i, j]), np.sum(counts[:, j] == counts[i, j])) > 1:
            result[i] = -1
    return result


EXERCISES = [
    Exercise(
        "13.1",
        lower_row,
        _rows,
        level="warm-up",
        cases=(
            lambda rng: (np.array([320.0, 480.0]), 2.0, 0.3, 640),
            lambda rng: (np.array([160.0, 320.0, 600.0]), 0.3, 0.3, 640),  # as near as can be
            lambda rng: (np.array([100.0]), 1000.0, 0.3, 640),  # far away: hardly higher
        ),
        mistakes=(
            Mistake(
                _row_at_a_slant,
                "You take the range along the slanted ray. It is horizontal, from the rig's axis: the same for both.",
            ),
            Mistake(
                lambda v, horizontal_range, baseline, height: lower_row(v, horizontal_range, baseline, 640),
                "Your panorama is always 640 rows high: use the argument.",
            ),
            Mistake(
                lambda v, horizontal_range, baseline, height: lower_row(v, horizontal_range, 0.3, height),
                "Your baseline is always 0.3 m: use the argument.",
            ),
            Mistake(
                lambda v, horizontal_range, baseline, height: np.degrees(
                    _elevation_for_row(v, horizontal_range, baseline, height)
                ),
                "That is the elevation in degrees; the task asks for the row in pixels.",
            ),
            Mistake(
                lambda v, horizontal_range, baseline, height: v - lower_row(v, horizontal_range, baseline, height),
                "That is by how many rows a point moves. Asked is the row itself.",
            ),
            Mistake(_row_of_a_higher_camera, "Your point sinks. A camera further down sees it higher: e_l > e_u."),
            Mistake(_row_from_angles_added, "baseline / range adds to the tangent of e_u, not to the angle."),
            Mistake(
                _row_with_the_angle_of_the_level, "Angles do not add here: add the tangents, then take the arctan."
            ),
            Mistake(
                _row_without_arctan, "You have the tangent of e_l. Turn it into an angle before you ask for its row."
            ),
            Mistake(
                lambda v, horizontal_range, baseline, height: _row(
                    np.radians(
                        np.degrees(np.arctan(np.tan(np.degrees(_elevation(v, height))) + baseline / horizontal_range))
                    ),
                    height,
                ),
                "np.tan takes radians; you give it degrees.",
            ),
            Mistake(
                lambda v, horizontal_range, baseline, height: (
                    v - np.arctan(baseline / horizontal_range) / np.pi * height * np.cos(_elevation(v, height)) ** 2
                ),
                "A first-order step, right for far points only: add the tangents, then take the arctan.",
            ),
            Mistake(_elevation_for_row, "That is the elevation in radians; the task asks for the row in pixels."),
            Mistake(
                lambda v, horizontal_range, baseline, height: lower_row(v, baseline, horizontal_range, height),
                "You add range / baseline. Near points move more: it is baseline / range.",
            ),
            Mistake(
                lambda v, horizontal_range, baseline, height: lower_row(v, 1 / horizontal_range, baseline, height),
                "You multiply by the range. Near points move more: divide by it.",
            ),
            Mistake(
                lambda v, horizontal_range, baseline, height: height - lower_row(v, horizontal_range, baseline, height),
                "Your picture is upside down: row 0 is straight up, so a row falls as the elevation grows.",
            ),
            Mistake(
                lambda v, horizontal_range, baseline, height: _row(
                    np.arctan(np.tan(2 * _elevation(v, height)) + baseline / horizontal_range) / 2, height
                ),
                "All rows together span pi, from straight up to straight down; the 2 pi belong to the columns.",
            ),
            Mistake(
                lambda v, horizontal_range, baseline, height: v + 0 * lower_row(v, horizontal_range, baseline, height),
                "These are the rows of the upper image. The lower camera sees every point higher.",
            ),
            Mistake(
                lambda v, horizontal_range, baseline, height: np.round(
                    lower_row(v, horizontal_range, baseline, height)
                ),
                "Rows are edge coordinates here, with fractions: do not round them.",
            ),
        ),
    ),
    Exercise(
        "13.2",
        miss,
        _two_cameras,
        cases=(
            lambda rng: _two_cameras(rng, np.array([0.0, 0.0, 1.0])),  # the lesson's rig
            lambda rng: _two_cameras(rng, np.array([0.0, 1.0, 0.0])),  # side by side
            _in_the_plane,
        ),
        mistakes=(
            Mistake(
                _normal_not_of_length_one,
                "The halves are right. But b x x_upper is shorter than 1: make it a unit vector before the arcsine.",
            ),
            Mistake(
                lambda up, low, b: np.maximum(miss(up, low, b), miss(low, up, b)),
                "That is the larger of the two ways, as in (13.2). Asked is the way from x_lower only.",
            ),
            Mistake(
                lambda up, low, b: np.pi / 2 - miss(up, low, b),
                "That is a right angle less the angle asked for: an arccosine in place of an arcsine?",
            ),
            Mistake(
                lambda up, low, b: _arcsin(np.abs(_beside(up, low, b))),
                "That is the angle to the whole circle. The half behind is forbidden: there the way ends at a pole.",
            ),
            Mistake(
                lambda up, low, b: _arcsin(_beside(up, low, b)),
                "Yours is the angle to the whole circle, with a sign. A distance has none, and half is forbidden.",
            ),
            Mistake(
                _behind(lambda low, b: np.full(len(low), np.pi / 2)),
                "On the other half the nearest point is a pole, +b or -b, and that may be nearer than pi/2.",
            ),
            Mistake(
                _behind(lambda low, b: np.full(len(low), np.pi)),
                "On the other half the nearest point is a pole, +b or -b: it is never farther than pi/2.",
            ),
            Mistake(
                _behind(lambda low, b: _arccos(low @ b)),
                "There are two poles: -b may be the nearer one.",
            ),
            Mistake(
                _behind(lambda low, b: _arcsin(np.abs(low @ b))),
                "On the other half you give |e|. The way to the pole is the rest to a right angle.",
            ),
            Mistake(
                lambda up, low, b: miss(low, up, b),
                "You measure from x_upper to the half-circle of x_lower. Asked is the other way round.",
            ),
            Mistake(
                lambda up, low, b: _arcsin(np.abs(_triple_product(up, low, b))),
                "b x x_upper is shorter than 1 unless at a right angle: make it a unit vector. And one half only.",
            ),
            Mistake(
                lambda up, low, b: np.abs(_triple_product(up, low, b)),
                "Equation (13.1) is 0 where it should be, but it is no angle yet: a unit normal, an arcsine, one half.",
            ),
            Mistake(
                _along_the_other_side,
                "On the other half you go on beyond a right angle. The half-circle ends at the poles: the way to one.",
            ),
            Mistake(
                _sides_by_the_angle,
                "Which half? Compare with the part of x_upper at a right angle to b, not with x_upper itself.",
            ),
            Mistake(
                lambda up, low, b: miss(up, low, np.array([0.0, 0.0, 1.0])),
                "Your baseline is always upright: use the argument.",
            ),
            Mistake(
                lambda up, low, b: np.where(
                    np.sum(low * _across_the_baseline(up, b), axis=1) >= 0,
                    np.abs(_beside(up, low, b)),
                    _arccos(np.abs(low @ b)),
                ),
                "On the right half that is the sine of the angle: the arcsine is missing.",
            ),
            Mistake(lambda up, low, b: np.degrees(miss(up, low, b)), "Yours is in degrees; give radians."),
        ),
    ),
    Exercise(
        "13.3",
        partners,
        _tables,
        cases=(
            lambda rng: (np.array([[90, 12], [80, 0], [4, 6]]),),
            lambda rng: (np.array([[5, 5], [0, 3]]),),  # a tie in a row, and its column wanted by another
            lambda rng: (np.array([[9, 0], [4, 2], [0, 2]]),),  # a tie in a column, after a pair
            lambda rng: (np.array([[7, 1], [1, 7]]),),  # equal, but no tie
            lambda rng: (np.array([[6, 6, 0], [0, 6, 2], [0, 0, 1]]),),  # ties hand on from row to row
            lambda rng: (np.zeros((2, 3), int),),
            lambda rng: (np.array([[3]]),),
        ),
        mistakes=(
            Mistake(
                _all_that_is_equal_out,
                "Equal counts in different rows and different columns are no tie: nobody has to choose.",
                others=(lambda counts: _with_ties(counts, anywhere=True),),
            ),
            Mistake(
                _ties_of_the_whole_table,
                "You look for ties after the pairing, in the table as given. Look in each round, among what is open.",
            ),
            Mistake(_each_row_its_best, "Two of your rows share a column: a column that is taken is taken."),
            Mistake(_columns_stay_free, "You give every row its best column: one-to-one, and never with a count of 0."),
            Mistake(
                _zeros_paired, "You pair objects that share no feature: a count of 0 pairs nothing, so stop there."
            ),
            Mistake(_row_by_row, "Not row after row: the largest count of the whole table comes first."),
            Mistake(_rows_stay_open, "You take out the column only: a row that has its partner is chosen again."),
            Mistake(
                lambda counts: _repeated_maximum(counts, min(counts.shape)),
                "When all counts left are 0, argmax says row 0, column 0, and you pair these: stop at 0.",
            ),
            Mistake(
                lambda counts: _repeated_maximum(counts, len(counts)),
                "One round for each row is too many: once all is 0, argmax says row 0, column 0. Stop at 0.",
            ),
            Mistake(
                _largest_sum,
                "That is the assignment with the largest sum. Here the largest count of all comes first.",
            ),
            Mistake(
                _first_of_a_tie,
                "Of a tie you take what comes first in the list. Any choice is a guess: both are left out.",
            ),
            Mistake(
                lambda counts: _with_ties(counts, columns=False),
                "You see ties in a row. Two rows with equally many matches for one column are a tie as well.",
            ),
            Mistake(
                lambda counts: _with_ties(counts, rows=False),
                "You see ties in a column. Two columns with equally many matches for one row are a tie as well.",
            ),
            Mistake(
                lambda counts: _with_ties(counts, columns_out=False),
                "The row of a tie is out in yours, but its columns are given to others. They are out, too.",
            ),
            Mistake(
                lambda counts: _with_ties(counts, rows_out=False),
                "The columns of a tie are out in yours, but its rows may choose again. They are out, too.",
            ),
            Mistake(
                _one_of_a_tie_out,
                "Of a tie you take out one row and one column. All rows and columns that such counts join are out.",
            ),
            Mistake(
                lambda counts: _with_ties(counts, stop=True),
                "You stop at the first tie. Those that it does not touch can still be paired.",
            ),
            Mistake(
                lambda counts: np.where(partners(counts) < 0, np.nan, partners(counts)),
                "Rows without a partner must hold -1; yours hold NaN.",
            ),
            Mistake(
                _mutual_best,
                "You pair only those that are each other's best. When these are out, the others choose again.",
            ),
            Mistake(
                lambda counts: np.maximum(partners(counts), 0),
                "Rows without a partner must hold -1; yours hold 0, which is a column.",
            ),
            Mistake(lambda counts: partners(counts.T), "Yours tells each column its row. Asked: each row its column."),
        ),
    ),
    Exercise(
        "13.4",
        turn_of_the_lower,
        _matches,
        level="challenge",
        verify=_misjudged,
        cases=(
            lambda rng: _some_wrong(rng, 40.0, MANY, noise=0.3, share=0.5),
            lambda rng: _matches(rng, turn=179.9),  # half of the matches on either side of the seam
            lambda rng: _matches(rng, turn=-180.0),
            lambda rng: _matches(rng, turn=0.0),
            lambda rng: _matches(rng, turn=3.0, n=800),
        ),
        mistakes=(
            Mistake(
                lambda up, low: (-turn_of_the_lower(up, low)[0], turn_of_the_lower(up, low)[1]),
                "The sign is turned around: a camera that turns left sees everything move to the right.",
            ),
            Mistake(
                lambda up, low: tuple(np.radians(turn_of_the_lower(up, low)).tolist()),
                "These are radians; the task asks for degrees.",
            ),
            Mistake(_of_all(np.mean), "A plain mean of all: wrong matches pull at it, and the seam does."),
            Mistake(
                _of_all(_circular_mean_deg),
                "On the circle, but wrong matches still pull: what do the right ones have in common?",
            ),
            Mistake(
                _of_all(np.median), "A median survives wrong matches, but not the seam, and its spread holds them all."
            ),
            Mistake(
                lambda up, low: (
                    turn_of_the_lower(up, low)[0],
                    turn_of_the_lower(up, low)[1] * np.sqrt(len(up)),
                ),
                "That is the spread of one match, not of their mean.",
            ),
            Mistake(
                lambda up, low: (turn_of_the_lower(up, low)[0], _of_all(np.mean)(up, low)[1]),
                "The turn is right. Your error bar is that of all matches: the wrong ones blow it up.",
            ),
            Mistake(
                lambda up, low: (turn_of_the_lower(up, low)[0], turn_of_the_lower(up, low)[1] ** 2),
                "The turn is right. Your error bar is a variance: take its root.",
            ),
        ),
    ),
]
