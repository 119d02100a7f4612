"""Exercises of lesson 18: what a colour costs, a pose of two matches, assignments, risk and coverage, how far a match
may be off."""

import numpy as np

from course_lib.lessons.kit.exercises import Exercise
from course_lib.spherical_stereo.pose.rigid_fit import rotation_2d

# 18.1: what a colour costs


def colour_cost(hue_seen, saturation_seen, hue_map, saturation_map):
    """Cost (n,) of the colours, nats: 0 where they are the same, 3 at most."""
    apart = np.abs(hue_seen - hue_map)
    apart = np.minimum(apart, 360 - apart)
    sigma = np.maximum(600 / np.minimum(saturation_seen, saturation_map), 12)
    hue = np.nan_to_num((apart / sigma) ** 2 / 2)
    return np.minimum(hue + ((saturation_seen - saturation_map) / 15) ** 2 / 2, 3)


def pairs_of_colours(rng: np.random.Generator) -> tuple:
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


# 18.2: the pose of two matches


def pose_of_two(seen, landmarks):
    """x, y, theta of the body on the map, from two matches: rows of seen (2, 2) and landmarks (2, 2)."""
    (dx, dy), (du, dv) = seen[1] - seen[0], landmarks[1] - landmarks[0]
    theta = np.arctan2(dv, du) - np.arctan2(dy, dx)
    R = np.array([[np.cos(theta), -np.sin(theta)], [np.sin(theta), np.cos(theta)]])
    x, y = landmarks.mean(axis=0) - R @ seen.mean(axis=0)
    return x, y, (theta + np.pi) % (2 * np.pi) - np.pi


def two_matches(rng: np.random.Generator) -> tuple:
    """Two places as they are seen from a pose, measured a little too far out or too near."""
    landmarks = rng.uniform(0, 6, (2, 2))
    while np.hypot(*(landmarks[1] - landmarks[0])) < 1:
        landmarks = rng.uniform(0, 6, (2, 2))
    place, theta = rng.uniform(0, 6, 2), rng.uniform(-np.pi, np.pi)
    return (landmarks - place) @ rotation_2d(theta) * rng.uniform(0.85, 1.15, (2, 1)), landmarks


# 18.3: an assignment that may leave things unmatched


def match_or_leave(cost):
    """For every row of cost (n, m) its column (n,), -1: unmatched; least total cost."""
    from scipy.optimize import linear_sum_assignment

    rows, chosen = linear_sum_assignment(np.minimum(cost, 0))
    columns = np.full(len(cost), -1)
    columns[rows] = np.where(cost[rows, chosen] < 0, chosen, -1)
    return columns


def repeated_minimum(cost):
    open_cost, columns = cost.copy(), np.full(len(cost), -1)
    while open_cost.min() < 0:
        i, j = np.unravel_index(open_cost.argmin(), cost.shape)
        columns[i], open_cost[i], open_cost[:, j] = j, np.inf, np.inf
    return columns


def row_by_row(cost):
    open_cost, columns = cost.copy(), np.full(len(cost), -1)
    for i, row in enumerate(open_cost):
        if row.min() < 0:
            columns[i] = row.argmin()
            open_cost[:, columns[i]] = np.inf
    return columns


def costs_in_nats(rng: np.random.Generator) -> tuple:
    """Rows compete for columns, unlike classes cost 50, one row is best left alone.

    Drawn until the ways that look right lead elsewhere: else a mistake could pass by luck.
    """
    while True:
        n, m = int(rng.integers(4, 7)), int(rng.integers(4, 8))
        cost = rng.uniform(-5, 0.5, (n, 1)) + rng.uniform(-3, 3, (1, m)) + rng.uniform(-3, 3, (n, m))
        cost[rng.random((n, m)) < 0.25] = 50.0
        cost[int(rng.integers(n))] = 50.0 if rng.random() < 0.5 else rng.uniform(0.5, 4, m)
        others = (repeated_minimum(cost), row_by_row(cost), np.where(cost.min(axis=1) < 0, cost.argmin(axis=1), -1))
        if sum(not np.array_equal(match_or_leave(cost), other) for other in others) >= 2:
            return (cost,)


# 18.4: how much may be answered


def max_answered(confidence, right, max_wrong):
    """Greatest coverage (0 to 1) whose risk is at most max_wrong; 0 where no threshold does."""
    best = 0.0
    for threshold in np.unique(confidence[confidence > 0]):
        given = confidence >= threshold
        if np.mean(~right[given]) <= max_wrong:
            best = max(best, given.mean())
    return best


def judged_poses(rng: np.random.Generator) -> tuple:
    """Confidences as shares are, most of them near 1, with ties and zeros; some must be left unanswered."""
    while True:
        n, max_wrong = int(rng.integers(12, 20)), rng.choice([0.0, 0.125, 0.25, 0.5])
        confidence = 1 - rng.choice(10.0 ** -rng.uniform(0.3, 7, 9), n)
        right = rng.random(n) < 0.95 - 0.8 * np.argsort(np.argsort(-confidence)) / n
        confidence[rng.random(n) < 0.1] = 0.0
        best = max_answered(confidence, right, max_wrong)
        if max_wrong == 0.0 or 0 < best < np.mean(confidence > 0):
            return confidence, right, max_wrong


def the_surest_is_wrong(rng: np.random.Generator) -> tuple:
    confidence = 1 - 10.0 ** -rng.uniform(0, 6, 12)
    return confidence, (confidence < confidence.max()) & (confidence > confidence.min()), 0.125


def right_at_confidence_0(rng: np.random.Generator) -> tuple:
    confidence = np.append(np.zeros(4), rng.uniform(0.1, 1, 8))
    return confidence, np.arange(12) < 9, 0.5


def the_limit_met_exactly(rng: np.random.Generator) -> tuple:
    """Four, then eight answers, one and two of them wrong: a quarter exactly; ten are too many, nine would do."""
    quarters = [rng.permutation([True, True, True, False]) for _ in range(2)]
    right = np.concatenate([*quarters, rng.permutation([False, True]), [True]])
    return np.array([0.9, 0.9, 0.8, 0.8, 0.6, 0.6, 0.5, 0.5, 0.3, 0.3, 0.0]), right, 0.25


def all_right(rng: np.random.Generator) -> tuple:
    return rng.uniform(0.1, 1, 9), np.full(9, True), 0.0


def ties_parted(confidence, right, max_wrong):
    order = np.argsort(-confidence, kind="stable")
    order = order[confidence[order] > 0]
    n = np.arange(1, len(order) + 1)
    return max(n[np.cumsum(~right[order]) <= max_wrong * n], default=0) / len(confidence)


# 18.5: how far off may a match be?


def farthest_match(S, p, clutter, e, g):
    """Distance d (n, m) up to which a match pays, sigmas, 0 if none does; S (n, k, k), p (m,), e (n, m), g (n,)."""
    # (18.2) for k coordinates, with the classes: the cost is 0 where exp(-d^2 / 2) * ratio is 1.
    k = S.shape[1]
    density = 1 / np.sqrt((2 * np.pi) ** k * np.linalg.det(S))
    ratio = (density / (clutter * g))[:, None] * e * p / (1 - p)
    return np.sqrt(np.maximum(2 * np.log(ratio), 0))


def objects_and_landmarks(rng: np.random.Generator) -> tuple:
    """Of one, two or three coordinates; some are known well and some hardly at all."""
    n, m, k = int(rng.integers(3, 6)), int(rng.integers(3, 6)), int(rng.integers(1, 4))
    shape = rng.normal(size=(n, k, k)) * 10.0 ** rng.uniform(-1, 0.5, (n, 1, 1))
    S = shape @ np.swapaxes(shape, 1, 2) + 0.05**2 * np.eye(k)
    clutter, e, g = 10.0 ** rng.uniform(-3, 0), rng.uniform(0.02, 0.95, (n, m)), rng.uniform(0.05, 0.4, n)
    return S, rng.uniform(0.1, 0.95, m), clutter, e, g


def a_match_never_pays(rng: np.random.Generator) -> tuple:
    return 9.0 * np.eye(2)[None], np.array([0.4, 0.2]), 0.5, np.array([[0.3, 0.9]]), np.array([0.3])


# fmt: off
EXERCISES = [
    Exercise("18.1", colour_cost, pairs_of_colours, "warm-up", tolerance=1e-4, mistakes="""
        np.minimum(apart, 360 - apart) => apart
        np.minimum(apart, 360 - apart) => (hue_seen - hue_map) % 360
        355 and 9 degrees are 14 apart, not 346: the hue goes the shorter way around the circle.
        np.minimum(saturation_seen, saturation_map) => min(saturation_seen.min(), saturation_map.min())
        You take one saturation for all. The lesser of each two is meant, element by element: np.minimum.
        / 15) ** 2 => ) ** 2
        / 15) ** 2 => ) ** 2 / 15
        A difference of saturation counts in units of 15 percent: the 15 are squared, too, as the difference is.
        600 / np.minimum(saturation_seen, saturation_map) => 600 / np.maximum(saturation_seen, saturation_map)
        600 / np.minimum(saturation_seen, saturation_map) => 1200 / (saturation_seen + saturation_map)
        600 / np.minimum(saturation_seen, saturation_map) => 600 / saturation_seen
        600 / np.minimum(saturation_seen, saturation_map) => 600 / saturation_map
        The paler of the two tells how little a hue means: not the greater saturation, nor the mean, nor one side's.
        np.maximum(600 => np.minimum(600
        np.maximum(600 / => (600 / and also _map), 12) => _map))
        s_h is at *least* 12 degrees, however colourful both are: the greater of the two numbers.
        return np.minimum(hue => return np.maximum(hue
        return np.minimum(hue => return (hue and also / 2, 3) => / 2)
        The cost is the lesser of the sum and 3: a colour, however wrong, never speaks louder.
        hue + (( => hue, 3) + np.minimum(((
        hue + (( => hue, 3) + (( and also / 2, 3) => / 2
        You cut a term off at 3 before you add. It is the sum that is at most 3.
        np.nan_to_num((apart / sigma) ** 2 / 2) => (apart / sigma) ** 2 / 2
        return np.minimum(hue => return ~np.isnan(apart) * np.minimum(hue
        Grey has no hue: where either hue is NaN the hue's term is 0, and the saturation still counts.
        sigma) ** 2 / 2) => sigma) ** 2 / 2, nan=3)
        You let grey cost the most there is. Nothing is known of its hue, so nothing is held against it.
        np.abs(hue_seen - hue_map) => np.abs(np.nan_to_num(hue_seen) - np.nan_to_num(hue_map))
        You turn grey into hue 0, which is red. First the difference, then 0 where it is NaN.
        ** 2 / 2 => ** 2
        The 2 below each fraction line is missing.
        ** 2 / 2 => / 2 and also (saturation_seen - saturation_map) => np.abs(saturation_seen - saturation_map)
        The squares are missing: both terms are squares of a ratio.
        hue + ((saturation_seen - saturation_map) / 15) ** 2 / 2 => hue
        hue + (( => ((
        A term is missing: the hue's and the saturation's own term are added.
    """),
    Exercise("18.2", pose_of_two, two_matches, mistakes="""
        np.arctan2(dv, du) - np.arctan2(dy, dx) => np.arctan2(dy, dx) - np.arctan2(dv, du)
        You turn the wrong way: theta turns the observed line into the map's. (np.arctan2 takes y first.)
        R @ seen => R.T @ seen
        Your theta is right, but R is transposed: (1, 0) must go to (cos theta, sin theta).
        R @ seen => seen
        You subtract a place in the body frame from one on the map. Turn it by theta first.
        landmarks.mean(axis=0) - R @ seen.mean(axis=0) => landmarks[0] - R @ seen[0]
        landmarks.mean(axis=0) - R @ seen.mean(axis=0) => landmarks[1] - R @ seen[1]
        You lay one end on its landmark; then the other end takes the whole error. Lay middle on middle.
        mean(axis=0) => sum(axis=0)
        The middle of two points is half their sum.
        (theta + np.pi) % (2 * np.pi) - np.pi => theta
        (theta + np.pi) % (2 * np.pi) - np.pi => theta % (2 * np.pi)
        theta is right but for whole turns: bring it into the range from -pi to pi.
        np.arctan2(dv, du) - np.arctan2(dy, dx) => np.arccos((dx * du + dy * dv) / np.hypot(dx, dy) / np.hypot(du, dv))
        arccos loses the sign of the angle: a left turn and a right turn look alike to it.
        - R @ seen.mean(axis=0) =>
        You give the middle of the landmarks. The robot stands where the turned middle, taken back, ends.
        - R @ => + R @
        You take the turned middle of what is seen off the landmarks' middle: yours adds it.
        - R @ => - np.hypot(du, dv) / np.hypot(dx, dy) * R @
        Your fit may stretch. A length measured on the spot is not scaled: turn, then shift, no more.
        ... => return pose_of_two(landmarks, seen)
        That is the map seen from the robot. Asked is the robot on the map.
        ... => return pose_of_two(seen, landmarks[::-1])
        You lay the first observation on the second landmark.
    """),
    Exercise("18.3", match_or_leave, costs_in_nats, mistakes="""
        np.minimum(cost, 0) => cost
        You match everything first and drop the dear pairs afterwards: a pair that is dropped spoilt others.
        np.minimum(cost, 0) => cost and also cost[rows, chosen] < 0 => True
        You match whatever is left. A pair that costs more than 0 is dearer than leaving both alone.
        cost[rows, chosen] < 0 => True
        The rows that gain nothing got a column by chance. They are to have -1.
        np.minimum(cost, 0) => cost and also chosen] < 0 => chosen] < 50
        Only unlike classes stay unmatched in yours. So should every pair that costs more than 0.
        -1) => 0)
        A row without a column gets -1, not 0: column 0 is a column.
        ... => return np.where(cost.min(axis=1) < 0, cost.argmin(axis=1), -1)
        Two rows may take one column in yours: it must be one-to-one.
        ... => return repeated_minimum(cost)
        That is the repeated minimum of lesson 15. The least *total* may begin with a dearer pair.
        ... => return row_by_row(cost)
        Yours depends on the order of the rows: the first takes what a later one needs more.
        np.minimum(cost, 0) => np.maximum(cost, 0)
        You keep the costs above 0 and lose the gains: the lesser of cost and 0 is what counts.
        np.minimum(cost, 0) => -np.minimum(cost, 0)
        np.minimum(cost, 0) => np.abs(cost)
        Yours makes the total large, or forgets its sign: linear_sum_assignment seeks the least, and gains are negative.
        ... => j = cost.argmin(1); ok = cost.argmin(0)[j] == range(len(j)); return np.where(ok * cost.min(1) < 0, j, -1)
        You match those only that are each other's best. A second choice can pay, too.
    """),
    Exercise("18.4", max_answered, judged_poses, cases=[
        the_surest_is_wrong, right_at_confidence_0, the_limit_met_exactly, all_right,
    ], functions={
        ties_parted: "Poses of one confidence are answered together or not at all: no threshold parts them.",
    }, mistakes="""
        np.mean(~right[given]) => max(np.mean(~right[confidence >= c]) for c in confidence[given])
        You stop at the first threshold that errs too much. A lower one may do again: look at all of them.
        np.unique(confidence[confidence > 0]) => np.arange(0.1, 1.05, 0.1) and also if np => if given.any() and np
        np.unique(confidence[confidence > 0]) => np.arange(0.05, 1.02, 0.05) and also if np => if given.any() and np
        np.unique(confidence[confidence > 0]) => np.arange(0.02, 1.01, 0.02) and also if np => if given.any() and np
        np.unique(confidence[confidence > 0]) => np.arange(0.01, 1.005, 0.01) and also if np => if given.any() and np
        np.unique(confidence[confidence > 0]) => np.linspace(0, 1, 101) and also if np => if given.any() and np
        A grid of thresholds steps over confidences that lie close together. Which thresholds are there to try?
        confidence[confidence > 0] => confidence
        A pose of confidence 0 is never answered, not even by a threshold of 0.
        <= max_wrong => < max_wrong
        At most: a share of wrong answers that is exactly the limit is allowed.
        ~right[given] => ~right & given
        You count the wrong ones as a share of all poses. The risk is their share of the answers.
        max(best, given.mean()) => best or threshold
        You give the threshold. Asked is the share of all poses that it answers.
        given.mean() => given.sum()
        You give a number of poses. Asked is the share of all of them.
        ~right[given] => right[given]
        You limit the share that is right. The limit is for those that are wrong.
        np.mean(~right => np.sum(~right
        You compare a number of wrong answers with a share.
        confidence >= threshold => confidence > threshold and also if np => if given.any() and np
        [confidence > 0] => and also >= threshold => > threshold and also if np => if given.any() and np
        At least the threshold: a pose whose confidence is the threshold itself is answered, too.
        ... => return np.mean((confidence > 0) & right)
        given.mean() => np.mean(given & right)
        You count the right ones. Asked is what one threshold answers, right or wrong.
        ... => return np.mean(confidence > 0)
        That is all that can be answered. How many of these answers are wrong?
        return best => return 1 - best
        You give the share that is *not* answered.
    """),
    Exercise("18.5", farthest_match, objects_and_landmarks, "challenge", cases=[a_match_never_pays], mistakes="""
        (2 * np.pi) ** k => (2 * np.pi) ** 2
        Yours has the log 2 pi of two coordinates for every k. Where in the normal density does it come from?
        np.sqrt((2 * np.pi) ** k * np.linalg.det(S)) => np.sqrt((2 * np.pi) ** k) * np.linalg.det(S)
        (2 * np.pi) ** k * np.linalg.det(S) => (2 * np.pi) ** (2 * k) * np.linalg.det(S) ** 2
        A normal density is divided by the root of the determinant, and of each 2 pi.
        * np.linalg.det(S) =>
        Without the determinant a place known to a metre counts like one known to a centimetre.
        p / (1 - p) => p
        p / (1 - p) => (1 - p)
        p / (1 - p) => (1 - p) / p
        Matched, j is seen; left alone, j is *not* seen: both have a probability.
        p / (1 - p) => p / (1 - e * p)
        Left alone means that j is not seen. Seen under another name, it would be another observation's match.
        clutter * g => clutter
        Left alone, i is clutter, and clutter that is reported as this class: its share belongs to the density.
        * e * p => * p
        Matched, the detector must give an object of j's class the class of i: that has a probability, too.
        2 * np.log(ratio) => np.log(ratio)
        The cost holds half of d squared: the 2 is lost on the way to d.
        np.sqrt(np.maximum(2 * np.log(ratio), 0)) => np.maximum(2 * np.log(ratio), 0)
        That is d squared. Asked is d.
        np.sqrt(np.maximum(2 * np.log(ratio), 0)) => np.where(ratio < 1, np.nan, np.sqrt(2 * np.abs(np.log(ratio))))
        np.maximum(2 * np.log(ratio), 0) => np.abs(2 * np.log(ratio))
        Where even a match exactly on its landmark does not pay, asked is 0.
        ratio), 0)) => ratio), 0)) * np.linalg.det(S)[:, None] ** (1 / (2 * k))
        That is a length. Asked is d, which counts in sigmas.
    """),
]
