"""Exercises of lesson 18: what a colour costs, a pose of two matches, assignments, coverage, how far a match is off."""

import numpy as np

from course_lib.spherical_stereo.pose.rigid_fit import rotation_2d
from courseware.lessons.kit.exercises import Exercise


def colour_cost(hue_seen, saturation_seen, hue_map, saturation_map):
    """Cost (n,) of the colours, nats: 0 where they are the same, 3 at most."""
    apart = np.abs(hue_seen - hue_map)
    apart = np.minimum(apart, 360 - apart)
    sigma = np.maximum(600 / np.minimum(saturation_seen, saturation_map), 12)
    hue = np.nan_to_num((apart / sigma) ** 2 / 2)
    return np.minimum(hue + ((saturation_seen - saturation_map) / 15) ** 2 / 2, 3)


def pairs_of_colours(rng: np.random.Generator) -> tuple:
    """Return colours strong and pale, some across the wrap, some grey on one side. Few differ by more than the cap."""
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


def pose_of_two(seen, landmarks):
    """x, y, theta of the body on the map, from two matches: rows of seen (2, 2) and landmarks (2, 2)."""
    (dx, dy), (du, dv) = seen[1] - seen[0], landmarks[1] - landmarks[0]
    theta = np.arctan2(dv, du) - np.arctan2(dy, dx)
    R = np.array([[np.cos(theta), -np.sin(theta)], [np.sin(theta), np.cos(theta)]])
    x, y = landmarks.mean(axis=0) - R @ seen.mean(axis=0)
    return x, y, (theta + np.pi) % (2 * np.pi) - np.pi


def two_matches(rng: np.random.Generator) -> tuple:
    """Return two places as they are seen from a pose, measured a little too far out or too near."""
    landmarks = rng.uniform(0, 6, (2, 2))
    while np.hypot(*(landmarks[1] - landmarks[0])) < 1:
        landmarks = rng.uniform(0, 6, (2, 2))
    place, theta = rng.uniform(0, 6, 2), rng.uniform(-np.pi, np.pi)
    return (landmarks - place) @ rotation_2d(theta) * rng.uniform(0.85, 1.15, (2, 1)), landmarks


def match_or_leave(cost):
    """For every row of cost (n, m) its column (n,), -1: unmatched; least total cost."""
    from scipy.optimize import linear_sum_assignment

    rows, chosen = linear_sum_assignment(np.minimum(cost, 0))
    columns = np.full(len(cost), -1)
    columns[rows] = np.where(cost[rows, chosen] < 0, chosen, -1)
    return columns


def one_after_the_other(cost, by_row=False):
    """A mistake: take the cheapest open pair, or serve the rows in their order."""
    open_cost, columns = cost.copy(), np.full(len(cost), -1)
    for k in range(len(cost)):
        i = k if by_row else open_cost.min(axis=1).argmin()
        if open_cost[i].min() < 0:
            columns[i] = open_cost[i].argmin()
            open_cost[i], open_cost[:, columns[i]] = np.inf, np.inf
    return columns


def costs_in_nats(rng: np.random.Generator) -> tuple:
    """Return costs where rows compete for columns, unlike classes cost 50, and one row is best left alone.

    They are drawn until the mistakes give other answers, because a mistake must not pass by luck.
    """
    while True:
        n, m = int(rng.integers(4, 7)), int(rng.integers(4, 8))
        cost = rng.uniform(-5, 0.5, (n, 1)) + rng.uniform(-3, 3, (1, m)) + rng.uniform(-3, 3, (n, m))
        cost[rng.random((n, m)) < 0.25] = 50.0
        cost[int(rng.integers(n))] = 50.0 if rng.random() < 0.5 else rng.uniform(0.5, 4, m)
        others = one_after_the_other(cost), one_after_the_other(cost, by_row=True)
        if not any(np.array_equal(match_or_leave(cost), other) for other in others):
            return (cost,)


def max_answered(confidence, right, max_wrong):
    """Greatest coverage (0 to 1) whose risk is at most max_wrong; 0 where no threshold does."""
    best = 0.0
    for threshold in np.unique(confidence[confidence > 0]):
        given = confidence >= threshold
        if np.mean(~right[given]) <= max_wrong:
            best = max(best, given.mean())
    return best


def judged_poses(rng: np.random.Generator) -> tuple:
    """Return confidences as shares are, most of them near 1, with ties and zeros. Some must be left unanswered."""
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


def ties_parted(confidence, right, max_wrong):
    order = np.argsort(-confidence, kind="stable")
    order = order[confidence[order] > 0]
    n = np.arange(1, len(order) + 1)
    return max(n[np.cumsum(~right[order]) <= max_wrong * n], default=0) / len(confidence)


def farthest_match(S, p, clutter, e, g):
    """Distance d (n, m) up to which a match pays, sigmas, 0 if none does; S (n, k, k), p (m,), e (n, m), g (n,)."""
    # (18.2) for k coordinates, with the classes: the cost is 0 where exp(-d^2 / 2) * ratio is 1.
    k = S.shape[1]
    density = 1 / np.sqrt((2 * np.pi) ** k * np.linalg.det(S))
    ratio = (density / (clutter * g))[:, None] * e * p / (1 - p)
    return np.sqrt(np.maximum(2 * np.log(ratio), 0))


def objects_and_landmarks(rng: np.random.Generator) -> tuple:
    """Return objects of one, two or three coordinates. Some are known well and some hardly at all."""
    n, m, k = int(rng.integers(3, 6)), int(rng.integers(3, 6)), int(rng.integers(1, 4))
    shape = rng.normal(size=(n, k, k)) * 10.0 ** rng.uniform(-1, 0.5, (n, 1, 1))
    S = shape @ np.swapaxes(shape, 1, 2) + 0.05**2 * np.eye(k)
    clutter, e, g = 10.0 ** rng.uniform(-3, 0), rng.uniform(0.02, 0.95, (n, m)), rng.uniform(0.05, 0.4, n)
    return S, rng.uniform(0.1, 0.95, m), clutter, e, g


# fmt: off
EXERCISES = [
    Exercise("18.1", colour_cost, pairs_of_colours, "warm-up", tolerance=1e-4, mistakes="""
        np.minimum(apart, 360 - apart) => apart
        355 and 9 degrees are 14 apart, not 346. The hue goes the shorter way around the circle.
        / 15) ** 2 => ) ** 2 / 15
        A difference of saturation counts in units of 15 percent, so the 15 are squared with the difference.
        600 / np.minimum(saturation_seen, saturation_map) => 600 / np.maximum(saturation_seen, saturation_map)
        600 / np.minimum(saturation_seen, saturation_map) => 600 / saturation_seen
        The paler of the two tells how little a hue means: not the greater saturation, the mean, or one side's.
        np.maximum(600 / => (600 / and also _map), 12) => _map))
        s_h is at *least* 12 degrees, however colourful both are: the greater of the two numbers.
        return np.minimum(hue => return (hue and also / 2, 3) => / 2)
        The cost is the lesser of the sum and 3. A wrong colour never costs more.
        np.nan_to_num((apart / sigma) ** 2 / 2) => (apart / sigma) ** 2 / 2
        return np.minimum(hue => return ~np.isnan(apart) * np.minimum(hue
        Grey has no hue. Where either hue is NaN, the hue's term is 0, and the saturation still counts.
        sigma) ** 2 / 2) => sigma) ** 2 / 2, nan=3)
        For grey you charge the largest cost. But nothing is known of its hue, so its term is 0.
        ** 2 / 2 => ** 2
        The 2 below each fraction line is missing.
        hue + ((saturation_seen - saturation_map) / 15) ** 2 / 2 => hue
        A term is missing: add the hue's and the saturation's own term.
        np.abs(hue_seen - hue_map) => (hue_map - hue_seen) % 360 and also np.minimum(apart, 360 - apart) => apart
        You always go the same way around the circle, up to 360 degrees. The shorter way is never longer than 180.
    """),
    Exercise("18.2", pose_of_two, two_matches, mistakes="""
        np.arctan2(dv, du) - np.arctan2(dy, dx) => np.arctan2(dy, dx) - np.arctan2(dv, du)
        You turn the wrong way: theta turns the observed line into the map's. (np.arctan2 takes y first.)
        R @ seen => seen
        You subtract a place in the body frame from one on the map. Turn it by theta first.
        landmarks.mean(axis=0) - R @ seen.mean(axis=0) => landmarks[0] - R @ seen[0]
        You lay one end on its landmark, and then the other end takes the whole error. Lay middle on middle.
        (theta + np.pi) % (2 * np.pi) - np.pi => theta
        theta is right but for whole turns. Bring it into the range from -pi to pi.
        np.arctan2(dv, du) - np.arctan2(dy, dx) => np.arccos((dx * du + dy * dv) / np.hypot(dx, dy) / np.hypot(du, dv))
        arccos loses the sign of the angle, so a left turn and a right turn look alike to it.
        - R @ seen.mean(axis=0) =>
        You give the middle of the landmarks. The robot stands where the turned middle, taken back, ends.
        - R @ => - np.hypot(du, dv) / np.hypot(dx, dy) * R @
        Your fit may stretch. But a measured length is not scaled: only turn, then shift.
        ... => return pose_of_two(seen, landmarks[::-1])
        You lay the first observation on the second landmark.
    """),
    Exercise("18.3", match_or_leave, costs_in_nats, mistakes="""
        np.minimum(cost, 0) => cost
        You match everything first and drop the dear pairs afterwards. But a pair that is dropped spoilt others.
        np.minimum(cost, 0) => cost and also cost[rows, chosen] < 0 => True
        You match all that is left. A pair that costs more than 0 is dearer than leaving both alone.
        cost[rows, chosen] < 0 => True
        The rows that gain nothing got a column by chance. They must have -1.
        np.minimum(cost, 0) => cost and also chosen] < 0 => chosen] < 50
        Only unlike classes stay unmatched in yours. Every pair that costs more than 0 should, too.
        -1) => 0)
        A row without a column gets -1, not 0: column 0 is a column.
        ... => return np.where(cost.min(axis=1) < 0, cost.argmin(axis=1), -1)
        Two rows may take one column in yours. It must be one-to-one.
        ... => return one_after_the_other(cost)
        That is the repeated minimum of lesson 15. The least *total* may begin with a dearer pair.
        ... => return one_after_the_other(cost, by_row=True)
        Yours depends on the order of the rows: the first takes the column that a later one needs more.
        np.minimum(cost, 0) => -np.minimum(cost, 0)
        Yours makes the total large: linear_sum_assignment seeks the least, and gains are negative.
    """),
    Exercise("18.4", max_answered, judged_poses, cases={
        "the surest is wrong": the_surest_is_wrong,
        "the limit met exactly": lambda rng: (  # by four and by eight; ten have too many wrong, and nine would do
            np.array([9, 9, 8, 8, 6, 6, 5, 5, 3, 3, 0]) / 10, np.array([1, 1, 1, 0, 1, 0, 1, 1, 0, 1, 1]) > 0, 0.25),
        "right at confidence 0": lambda rng: (np.append(np.zeros(4), rng.uniform(0.1, 1, 8)), np.arange(12) < 9, 0.5),
        "all right": lambda rng: (rng.uniform(0.1, 1, 9), np.full(9, True), 0.0),
    }, functions={
        ties_parted: "Poses of one confidence are answered together or not at all: no threshold parts them.",
    }, mistakes="""
        np.mean(~right[given]) => max(np.mean(~right[confidence >= c]) for c in confidence[given])
        You stop at the first threshold that errs too much. A lower one may do again: look at all of them.
        np.unique(confidence[confidence > 0]) => np.arange(0.1, 1.05, 0.1) and also if np => if given.any() and np
        np.unique(confidence[confidence > 0]) => np.arange(0.01, 1.005, 0.01) and also if np => if given.any() and np
        A grid of thresholds steps over confidences that lie close together. Which thresholds are there to try?
        confidence[confidence > 0] => confidence
        A pose of confidence 0 is never answered, not even by a threshold of 0.
        ~right[given] => ~right & given
        You count the wrong ones as a share of all poses. The risk is their share of the answers.
        max(best, given.mean()) => best or threshold
        You give the threshold. The task asks for the share of all poses that it answers.
        given.mean() => given.sum()
        You give a number of poses. The task asks for the share of all of them.
        given.mean() => np.mean(given & right)
        You count the right ones. The task asks for all that one threshold answers, right or wrong.
        ... => return np.mean(confidence > 0)
        That is all that can be answered. How many of these answers are wrong?
    """),
    Exercise("18.5", farthest_match, objects_and_landmarks, "challenge", cases={
        "a match never pays": lambda rng: (9.0 * np.eye(2)[None], np.array([0.4, 0.2]), 0.5, np.array([[0.3, 0.9]]),
                                           np.array([0.3])),
    }, mistakes="""
        (2 * np.pi) ** k => (2 * np.pi) ** 2
        Yours has the log 2 pi of two coordinates for every k. Where in the normal density does it come from?
        np.sqrt((2 * np.pi) ** k * np.linalg.det(S)) => np.sqrt((2 * np.pi) ** k) * np.linalg.det(S)
        A normal density is divided by the root of the determinant, and of each 2 pi.
        * np.linalg.det(S) =>
        Without the determinant, a place known to a metre counts like one known to a centimetre.
        p / (1 - p) => p
        If matched, j is seen. If left alone, j is *not* seen. Both have a probability.
        p / (1 - p) => p / (1 - e * p)
        Left alone means that j is not seen. Seen under another name, it would be another observation's match.
        clutter * g => clutter
        Left alone, i is clutter that is reported as this class. Its share belongs to the density.
        * e * p => * p
        If matched, the detector must give an object of j's class the class of i. That has a probability, too.
        np.maximum(2 * np.log(ratio), 0) => np.abs(2 * np.log(ratio))
        The answer is 0 where even a match exactly on its landmark does not pay.
        ratio), 0)) => ratio), 0)) * np.linalg.det(S)[:, None] ** (1 / (2 * k))
        That is a length. The task asks for d, which counts in sigmas.
    """),
]
