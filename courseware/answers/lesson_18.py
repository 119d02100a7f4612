"""Exercises of lesson 18: what a colour costs, a pose of two matches, assignments, coverage, how far a match is off."""

import numpy as np

from course_lib.spherical_stereo.pose.rigid_fit import rotation_2d
from courseware.lessons.kit.exercise import Exercise


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
    Exercise("18.1", colour_cost, pairs_of_colours, "warm-up", tolerance=1e-4),
    Exercise("18.2", pose_of_two, two_matches, example=(([[1, 0], [3, 0]], [[2, 1], [2, 3]]), (2, 0, 1.571))),
    Exercise("18.3", match_or_leave, costs_in_nats, example=(([[-5, -4], [-4, 3]],), [1, 0])),
    Exercise("18.4", max_answered, judged_poses, cases={
        "the surest is wrong": the_surest_is_wrong,
        "the limit met exactly": lambda rng: (  # by four and by eight; ten have too many wrong, and nine would do
            np.array([9, 9, 8, 8, 6, 6, 5, 5, 3, 3, 0]) / 10, np.array([1, 1, 1, 0, 1, 0, 1, 1, 0, 1, 1]) > 0, 0.25),
        "right at confidence 0": lambda rng: (np.append(np.zeros(4), rng.uniform(0.1, 1, 8)), np.arange(12) < 9, 0.5),
        "all right": lambda rng: (rng.uniform(0.1, 1, 9), np.full(9, True), 0.0),
    }, functions={
        ties_parted: "Poses of one confidence are answered together or not at all: no threshold parts them.",
    }, example=(([0.9, 0.8, 0.8, 0.4, 0], [True, False, True, True, True], 0.25), 0.8)),
    Exercise("18.5", farthest_match, objects_and_landmarks, "challenge", cases={
        "a match never pays": lambda rng: (9.0 * np.eye(2)[None], np.array([0.4, 0.2]), 0.5, np.array([[0.3, 0.9]]),
                                           np.array([0.3])),
    }),
]
