"""Exercises of lesson 18: what a colour costs, a pose of two matches, leaving things unmatched, risk and coverage."""

from collections.abc import Callable

import numpy as np
from scipy.optimize import linear_sum_assignment

from course_lib.geometry import wrap_angle
from course_lib.lessons.kit.exercises import Exercise, Mistake

# 18.1: what a colour costs


def colour_cost(hue_seen, saturation_seen, hue_map, saturation_map):
    """dh^2 / (2 s_h^2) + ds^2 / (2 15^2) (n,), at most 3; s_h = 600 / lesser saturation, at least 12; grey: dh = 0."""
    return _colour(hue_seen, saturation_seen, hue_map, saturation_map)


def _circle(a, b):
    apart = np.abs(a - b)
    return np.minimum(apart, 360 - apart)


def _hue_sigma(a, b):
    return np.maximum(600 / np.minimum(a, b), 12)


def _capped(hue, saturation):
    return np.minimum(hue + saturation, 3)


def _colour(
    hue_seen,
    saturation_seen,
    hue_map,
    saturation_map,
    apart: Callable = _circle,
    sigma: Callable = _hue_sigma,
    join: Callable = _capped,
    grey: float = 0.0,
    power: int = 2,
    twice: float = 2.0,
    spread: float = 15.0,
):
    """The cost, and with other parts its mistakes."""
    d_hue = apart(hue_seen, hue_map) / sigma(saturation_seen, saturation_map)
    d_saturation = np.abs(saturation_seen - saturation_map) / spread
    hue = np.where(np.isnan(d_hue), grey, d_hue**power / twice)
    return join(hue, d_saturation**power / twice)


def _colours(rng: np.random.Generator) -> tuple:
    """Colours strong and pale, some across the wrap, some grey on one side; few differ by more than the cap."""
    n = int(rng.integers(8, 12))
    hue_map, saturation_map = rng.uniform(0, 360, n), rng.uniform(25, 85, n)
    saturation_seen = np.clip(saturation_map + rng.uniform(-25, 25, n), 3, 100)
    hue_map[:2], saturation_map[:2] = rng.uniform([352, 0], [360, 8]), rng.uniform(30, 90, 2)
    hue_seen = (hue_map + rng.uniform(-25, 25, n)) % 360
    hue_seen[:2] = (hue_map[:2] + np.array([14.0, -14.0])) % 360
    hue_seen[2], saturation_seen[2] = np.nan, 3.0
    hue_map[3], saturation_map[3] = np.nan, 4.0
    saturation_seen[4], saturation_map[4] = rng.uniform(70, 95, 2)  # colourful: 600 / 70 is below 12
    hue_seen[4] = (hue_map[4] + 15) % 360
    hue_seen[5] = (hue_map[5] + 120) % 360  # beyond the cap
    return hue_seen, saturation_seen, hue_map, saturation_map


def _mistaken_colour(**parts) -> Callable:
    return lambda hue_seen, s_seen, hue_map, s_map: _colour(hue_seen, s_seen, hue_map, s_map, **parts)


# 18.2: the pose of two matches


def pose_of_two(seen, landmarks):
    """(x, y, theta): the line between two observations (2, 2) laid on that between two landmarks, middle on middle."""
    return _pose(seen, landmarks)


def _direction(line):
    return np.arctan2(line[1], line[0])


def _turned(theta, point):
    c, s = np.cos(theta), np.sin(theta)
    return np.array([c * point[0] - s * point[1], s * point[0] + c * point[1]])


def _difference_of_directions(seen, landmarks):
    return _direction(landmarks[1] - landmarks[0]) - _direction(seen[1] - seen[0])


def _pose(
    seen,
    landmarks,
    turn: Callable = _difference_of_directions,
    rotate: Callable = _turned,
    anchor: Callable = lambda points: points.mean(axis=0),
    wrap: Callable = wrap_angle,
):
    """The pose, and with other parts its mistakes."""
    theta = turn(seen, landmarks)
    x, y = anchor(landmarks) - rotate(theta, anchor(seen))
    return x, y, wrap(theta)


def _mistaken_pose(**parts) -> Callable:
    return lambda seen, landmarks: _pose(seen, landmarks, **parts)


def _the_way_back(seen, landmarks):
    theta = _difference_of_directions(seen, landmarks)
    x, y = seen.mean(axis=0) - _turned(-theta, landmarks.mean(axis=0))
    return x, y, wrap_angle(-theta)


def _added(seen, landmarks):
    theta = _difference_of_directions(seen, landmarks)
    x, y = landmarks.mean(axis=0) + _turned(theta, seen.mean(axis=0))
    return x, y, wrap_angle(theta)


def _stretched(seen, landmarks):
    theta = _difference_of_directions(seen, landmarks)
    scale = np.linalg.norm(landmarks[1] - landmarks[0]) / np.linalg.norm(seen[1] - seen[0])
    x, y = landmarks.mean(axis=0) - scale * _turned(theta, seen.mean(axis=0))
    return x, y, wrap_angle(theta)


def _in_degrees(seen, landmarks):
    x, y, theta = _pose(seen, landmarks)
    return x, y, np.degrees(theta)


def _two_matches(rng: np.random.Generator) -> tuple:
    """Two places as they are seen from a pose, measured a little too far out or too near."""
    landmarks = rng.uniform(0, 6, (2, 2))
    while np.hypot(*(landmarks[1] - landmarks[0])) < 1:
        landmarks = rng.uniform(0, 6, (2, 2))
    x, y, theta = rng.uniform([0, 0, -np.pi], [6, 6, np.pi])
    seen = np.array([_turned(-theta, one - (x, y)) for one in landmarks]) * rng.uniform(0.85, 1.15, (2, 1))
    return seen, landmarks


# 18.3: an assignment that may leave things unmatched


def match_or_leave(cost):
    """For every row of cost (n, m) its column (n,), -1: unmatched, which costs 0; one-to-one, of least total cost."""
    return _matched(np.minimum(cost, 0), lambda i, j: cost[i, j] < 0)


def _matched(table, good: Callable):
    columns = np.full(len(table), -1)
    for i, j in zip(*linear_sum_assignment(table), strict=True):
        if good(i, j):
            columns[i] = j
    return columns


def _rows_with_gain(cost):
    columns, rows = np.full(len(cost), -1), np.flatnonzero(cost.min(axis=1) < 0)
    for i, j in zip(*linear_sum_assignment(cost[rows]), strict=True):
        columns[rows[i]] = j
    return columns


def _best_of_each_row(cost):
    best = cost.argmin(axis=1)
    return np.where(cost.min(axis=1) < 0, best, -1)


def _repeated_minimum(cost):
    open_cost, columns = cost.copy(), np.full(len(cost), -1)
    while open_cost.min() < 0:
        i, j = np.unravel_index(open_cost.argmin(), cost.shape)
        columns[i] = j
        open_cost[i], open_cost[:, j] = np.inf, np.inf
    return columns


def _each_other_s_best(cost):
    best = _best_of_each_row(cost)
    return np.where(cost.argmin(axis=0)[best] == np.arange(len(cost)), best, -1)


def _row_by_row(cost):
    open_cost, columns = cost.copy(), np.full(len(cost), -1)
    for i in range(len(cost)):
        j = int(open_cost[i].argmin())
        if open_cost[i, j] < 0:
            columns[i], open_cost[:, j] = j, np.inf
    return columns


def _nat_costs(rng: np.random.Generator) -> tuple:
    """Costs in nats: rows compete for columns, unlike classes cost 50, one row and one column are best left alone.

    Drawn until the roads that look right lead elsewhere: else a mistake could pass by luck.
    """
    while True:
        n, m = int(rng.integers(4, 7)), int(rng.integers(4, 8))
        cost = rng.uniform(-5, 0.5, (n, 1)) + rng.uniform(-3, 3, (1, m)) + rng.uniform(-3, 3, (n, m))
        cost[rng.random((n, m)) < 0.25] = 50.0
        cost[int(rng.integers(n))] = 50.0 if rng.random() < 0.5 else rng.uniform(0.5, 4, m)
        right = match_or_leave(cost)
        forced = _matched(cost, lambda i, j, cost=cost: cost[i, j] < 0)
        others = (forced, _repeated_minimum(cost), _row_by_row(cost), _best_of_each_row(cost))
        if sum(not np.array_equal(right, other) for other in others) >= 3:
            return (cost,)


# 18.4: how much may be answered


def max_answered(confidence, right, max_wrong):
    """Return the largest share of poses that one threshold answers, with at most `max_wrong` of the answers wrong."""
    return _answered(confidence, right, max_wrong)


def _answered(
    confidence,
    right,
    max_wrong,
    nothing_at_zero: bool = True,
    allowed: Callable = lambda wrong, limit: wrong <= limit,
    wrong_share: Callable = lambda right, given: np.mean(~right[given]),
    gives: Callable = lambda given, threshold: given.mean(),
    stop: bool = False,
):
    """The share, and with other parts its mistakes."""
    best = 0.0
    for threshold in np.unique(confidence)[::-1]:
        if threshold == 0 and nothing_at_zero:
            continue
        given = confidence >= threshold
        if allowed(wrong_share(right, given), max_wrong):
            best = gives(given, threshold)
        elif stop:
            break
    return float(best)


def _mistaken_share(**parts) -> Callable:
    return lambda confidence, right, max_wrong: _answered(confidence, right, max_wrong, **parts)


def _ties_split(confidence, right, max_wrong):
    order = np.argsort(-confidence, kind="stable")
    order = order[confidence[order] > 0]
    wrong = np.cumsum(~right[order]) / np.arange(1, len(order) + 1)
    good = np.flatnonzero(wrong <= max_wrong)
    return float(good[-1] + 1) / len(confidence) if len(good) else 0.0


def _above(confidence, right, max_wrong):
    best = 0.0
    for threshold in np.unique(confidence):
        given = confidence > threshold
        if given.any() and np.mean(~right[given]) <= max_wrong:
            best = max(best, given.mean())
    return float(best)


def _given_wrong(confidence, right, max_wrong):
    return 1.0 - _answered(confidence, right, max_wrong)


def _right_of_the_best(confidence, right, max_wrong):
    shares = [0.0]
    for threshold in np.unique(confidence[confidence > 0]):
        given = confidence >= threshold
        if np.mean(~right[given]) <= max_wrong:
            shares.append(float(np.mean(given & right)))
    return max(shares)


def _answers(rng: np.random.Generator) -> tuple:
    """Confidences with ties, of five kinds: as they come; the surest answer wrong; zeros that are right and would be
    allowed; the limit met exactly, and again by half of a tie; all right."""
    kind = int(rng.integers(5))
    if kind == 3:  # four, then eight answers, one and two of them wrong: a quarter exactly; ten are too many
        quarters = [rng.permutation([True, True, True, False]) for _ in range(2)]
        right = np.concatenate([*quarters, rng.permutation([False, True]), [True]])
        return np.array([0.9, 0.9, 0.8, 0.8, 0.6, 0.6, 0.5, 0.5, 0.3, 0.3, 0.0]), right, 0.25
    n = int(rng.integers(10, 20))
    confidence = rng.choice(np.linspace(0.1, 0.9, 9), n)
    right = rng.random(n) < 0.35 + 0.6 * confidence
    if kind == 1:
        right[confidence == confidence.max()] = False  # no threshold does at first, a lower one may
    if kind == 2:
        confidence[: n // 4], right[: n // 2] = 0.0, True
        return confidence, right, 0.5
    if kind == 4:
        right[:] = True
    return confidence, right, float(rng.choice([0.0, 0.125, 0.25, 0.5]))


EXERCISES = [
    Exercise(
        number="18.1",
        solution=colour_cost,
        inputs=_colours,
        mistakes=(
            Mistake(
                _mistaken_colour(apart=lambda a, b: np.abs(a - b)),
                "355 and 9 degrees are 14 apart, not 346: the hue goes the shorter way around the circle.",
            ),
            Mistake(
                _mistaken_colour(apart=lambda a, b: (a - b) % 360),
                "The remainder by 360 goes one way around only. The hue goes the shorter way around the circle.",
            ),
            Mistake(
                _mistaken_colour(sigma=lambda a, b: np.maximum(600 / min(a.min(), b.min()), 12)),
                "You take one saturation for all. The lesser of each two is meant, element by element: np.minimum.",
            ),
            Mistake(
                _mistaken_colour(spread=1.0),
                "A difference of saturation counts in units of 15 percent.",
            ),
            Mistake(
                _mistaken_colour(spread=15.0**0.5),
                "The 15 percent are squared, too, as the difference is.",
            ),
            Mistake(
                _mistaken_colour(sigma=lambda a, b: np.maximum(600 / np.maximum(a, b), 12)),
                "You take the greater saturation. The paler of the two tells how little a hue means.",
            ),
            Mistake(
                _mistaken_colour(sigma=lambda a, b: np.maximum(600 / ((a + b) / 2), 12)),
                "You take the mean saturation. The paler of the two tells how little a hue means.",
            ),
            Mistake(
                _mistaken_colour(sigma=lambda a, b: np.maximum(600 / a, 12)),
                "You ask the observed saturation only. The landmark can be the paler one.",
            ),
            Mistake(
                _mistaken_colour(sigma=lambda a, b: np.maximum(600 / b, 12)),
                "You ask the map's saturation only. The observed object can be the paler one.",
            ),
            Mistake(
                _mistaken_colour(sigma=lambda a, b: 600 / np.minimum(a, b)),
                "s_h is never below 12 degrees, however colourful both are.",
            ),
            Mistake(
                _mistaken_colour(sigma=lambda a, b: np.minimum(600 / np.minimum(a, b), 12)),
                "s_h is at *least* 12 degrees: the greater of the two, not the lesser.",
            ),
            Mistake(
                _mistaken_colour(join=lambda hue, saturation: hue + saturation),
                "The sum is at most 3: a colour, however wrong, never speaks louder.",
            ),
            Mistake(
                _mistaken_colour(join=lambda hue, saturation: np.minimum(hue, 3) + np.minimum(saturation, 3)),
                "You cut each term off at 3. It is their sum that is at most 3.",
            ),
            Mistake(
                _mistaken_colour(join=lambda hue, saturation: np.minimum(hue, 3) + saturation),
                "You cut the hue off at 3 before you add. It is the sum that is at most 3.",
            ),
            Mistake(
                _mistaken_colour(join=lambda hue, saturation: np.maximum(hue + saturation, 3)),
                "At most 3 means the lesser of the sum and 3.",
            ),
            Mistake(
                _mistaken_colour(grey=np.nan),
                "Grey has no hue: where either hue is NaN the hue's term is 0, and the saturation still counts.",
            ),
            Mistake(
                lambda a, s, b, t: np.nan_to_num(_colour(a, s, b, t, grey=np.nan)),
                "Where a hue is NaN only the hue's term is 0: the saturation still counts.",
            ),
            Mistake(
                _mistaken_colour(grey=3.0),
                "You let grey cost the most there is. Nothing is known of its hue, so nothing is held against it.",
            ),
            Mistake(
                lambda a, s, b, t: _colour(np.nan_to_num(a), s, np.nan_to_num(b), t),
                "You turn grey into hue 0, which is red. First the difference, then 0 where it is NaN.",
            ),
            Mistake(_mistaken_colour(twice=1.0), "The 2 below each fraction line is missing."),
            Mistake(_mistaken_colour(power=1), "The squares are missing: both terms are squares of a ratio."),
            Mistake(
                _mistaken_colour(join=lambda hue, saturation: np.minimum(hue, 3)),
                "The saturation's own term is missing.",
            ),
            Mistake(
                _mistaken_colour(join=lambda hue, saturation: np.minimum(saturation, 3)),
                "The hue's term is missing.",
            ),
        ),
        tolerance=1e-4,
        level="warm-up",
    ),
    Exercise(
        number="18.2",
        solution=pose_of_two,
        inputs=_two_matches,
        mistakes=(
            Mistake(
                _mistaken_pose(turn=lambda seen, landmarks: -_difference_of_directions(seen, landmarks)),
                "You turn the wrong way: theta turns the observed line into the map's. (np.arctan2 takes y first.)",
            ),
            Mistake(
                _mistaken_pose(rotate=lambda theta, point: _turned(-theta, point)),
                "Your theta is right, but R is transposed: (1, 0) must go to (cos theta, sin theta).",
            ),
            Mistake(
                _mistaken_pose(rotate=lambda theta, point: point),
                "You subtract a place in the body frame from one on the map. Turn it by theta first.",
            ),
            Mistake(
                _mistaken_pose(anchor=lambda points: points[0]),
                "You lay the first on the first; then the second takes the whole error. Lay middle on middle.",
            ),
            Mistake(
                _mistaken_pose(anchor=lambda points: points[1]),
                "You lay the second on the second; then the first takes the whole error. Lay middle on middle.",
            ),
            Mistake(
                _mistaken_pose(anchor=lambda points: points.sum(axis=0)),
                "The middle of two points is half their sum.",
            ),
            Mistake(
                _mistaken_pose(wrap=lambda theta: theta),
                "theta is right but for whole turns: bring it into the range from -pi to pi.",
            ),
            Mistake(
                _mistaken_pose(wrap=lambda theta: theta % (2 * np.pi)),
                "Your theta runs from 0 to 2 pi; the task asks for -pi to pi.",
            ),
            Mistake(
                _mistaken_pose(
                    turn=lambda s, m: (
                        np.arctan((m[1] - m[0])[1] / (m[1] - m[0])[0]) - np.arctan((s[1] - s[0])[1] / (s[1] - s[0])[0])
                    )
                ),
                "arctan(y / x) knows half of the directions only. np.arctan2(y, x) knows all.",
            ),
            Mistake(
                _mistaken_pose(
                    turn=lambda s, m: np.arccos(
                        np.clip(
                            (m[1] - m[0]) @ (s[1] - s[0]) / np.hypot(*(m[1] - m[0])) / np.hypot(*(s[1] - s[0])), -1, 1
                        )
                    ),
                ),
                "arccos loses the sign of the angle: a left turn and a right turn look alike to it.",
            ),
            Mistake(
                lambda seen, landmarks: (*landmarks.mean(axis=0), pose_of_two(seen, landmarks)[2]),
                "You give the middle of the landmarks. The robot stands where the turned middle, taken back, ends.",
            ),
            Mistake(_added, "You take the turned middle of what is seen off the landmarks' middle: yours adds it."),
            Mistake(
                _stretched,
                "Your fit may stretch. A length measured on the spot is not scaled: turn, then shift, no more.",
            ),
            Mistake(_the_way_back, "That is the map seen from the robot. Asked is the robot on the map."),
            Mistake(_in_degrees, "theta in radians, please."),
            Mistake(
                lambda seen, landmarks: _pose(seen, landmarks[::-1]),
                "You lay the first observation on the second landmark.",
            ),
        ),
    ),
    Exercise(
        number="18.3",
        solution=match_or_leave,
        inputs=_nat_costs,
        mistakes=(
            Mistake(
                lambda cost: _matched(cost, lambda i, j: cost[i, j] < 0),
                "You match everything first and drop the dear pairs afterwards: a pair that is dropped spoilt others.",
            ),
            Mistake(
                lambda cost: _matched(cost, lambda i, j: True),
                "You match whatever is left. A pair that costs more than 0 is dearer than leaving both alone.",
            ),
            Mistake(
                lambda cost: _matched(np.minimum(cost, 0), lambda i, j: True),
                "The rows that gain nothing got a column by chance. They are to have -1.",
            ),
            Mistake(
                lambda cost: _matched(cost, lambda i, j: cost[i, j] < 50),
                "Only unlike classes stay unmatched in yours. So should every pair that costs more than 0.",
            ),
            Mistake(
                lambda cost: np.maximum(match_or_leave(cost), 0),
                "A row without a column gets -1, not 0: column 0 is a column.",
            ),
            Mistake(_best_of_each_row, "Two rows may take one column in yours: it must be one-to-one."),
            Mistake(
                _repeated_minimum,
                "That is the repeated minimum of lesson 15. The least *total* may begin with a dearer pair.",
            ),
            Mistake(
                _row_by_row, "Yours depends on the order of the rows: the first takes what a later one needs more."
            ),
            Mistake(_rows_with_gain, "You leave out rows without a gain, but force a column on all that are left."),
            Mistake(
                lambda cost: _matched(np.maximum(cost, 0), lambda i, j: cost[i, j] < 0),
                "You keep the costs above 0 and lose the gains: the lesser of cost and 0 is what counts.",
            ),
            Mistake(
                lambda cost: _matched(-np.minimum(cost, 0), lambda i, j: cost[i, j] < 0),
                "Yours makes the total as large as it can: linear_sum_assignment seeks the least.",
            ),
            Mistake(
                lambda cost: _matched(np.abs(cost), lambda i, j: cost[i, j] < 0),
                "Without its sign a great gain looks like a great cost.",
            ),
            Mistake(
                _each_other_s_best, "You match those only that are each other's best. A second choice can pay, too."
            ),
        ),
    ),
    Exercise(
        number="18.4",
        solution=max_answered,
        inputs=_answers,
        mistakes=(
            Mistake(
                _mistaken_share(stop=True),
                "You stop at the first threshold that errs too much. A lower one may do again: look at all of them.",
            ),
            Mistake(
                _ties_split,
                "Poses of one confidence are answered together or not at all: no threshold parts them.",
            ),
            Mistake(
                _mistaken_share(nothing_at_zero=False),
                "A pose of confidence 0 is never answered, not even by a threshold of 0.",
            ),
            Mistake(
                _mistaken_share(allowed=lambda wrong, limit: wrong < limit),
                "At most: a share of wrong answers that is exactly the limit is allowed.",
            ),
            Mistake(
                _mistaken_share(wrong_share=lambda right, given: np.mean(~right & given)),
                "You count the wrong ones as a share of all poses. The risk is their share of the answers.",
            ),
            Mistake(
                _mistaken_share(gives=lambda given, threshold: threshold),
                "You give the threshold. Asked is the share of all poses that it answers.",
            ),
            Mistake(
                _mistaken_share(gives=lambda given, threshold: given.sum()),
                "You give a number of poses. Asked is the share of all of them.",
            ),
            Mistake(
                _mistaken_share(gives=lambda given, threshold: 100 * given.mean()),
                "You give percent. Asked is a share from 0 to 1.",
            ),
            Mistake(
                _mistaken_share(wrong_share=lambda right, given: np.mean(right[given])),
                "You limit the share that is right. The limit is for those that are wrong.",
            ),
            Mistake(
                _mistaken_share(wrong_share=lambda right, given: np.sum(~right[given])),
                "You compare a number of wrong answers with a share.",
            ),
            Mistake(
                _above,
                "At least the threshold: a pose whose confidence is the threshold itself is answered, too.",
            ),
            Mistake(
                lambda confidence, right, max_wrong: float(np.mean((confidence > 0) & right)),
                "You count the right ones. Asked is what one threshold answers, right or wrong.",
            ),
            Mistake(_given_wrong, "You give the share that is *not* answered."),
            Mistake(
                _right_of_the_best, "You give the share that is answered *and* right. Coverage counts every answer."
            ),
        ),
        level="challenge",
    ),
]
