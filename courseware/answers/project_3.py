"""Stages of project P3: distances under a pose, poses of two matches, an assignment, a weighted fit, how sure."""

import itertools

import numpy as np
from scipy.optimize import least_squares, linear_sum_assignment

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.pose.rigid_fit import fit_rigid_2d
from course_lib.spherical_stereo.pose.rigid_fit import rotation_2d as rotation
from courseware.lessons.kit.exercise import Exercise
from courseware.lessons.kit.values import as_numbers


def scene(rng: np.random.Generator, n: int, unseen: int, theta: float | None = None) -> tuple:
    """A pose, n places as a stereo camera sees them from there, their covariances, and n + unseen landmarks."""
    landmarks = rng.uniform(0, 6, (n + unseen, 2))
    pose = np.array([*rng.uniform(1, 5, 2), rng.uniform(-np.pi, np.pi) if theta is None else theta])
    places = (landmarks[:n] - pose[:2]) @ rotation(pose[2])
    away, turns = np.linalg.norm(places, axis=1), rotation(np.arctan2(places[:, 1], places[:, 0]))
    sigmas = np.column_stack([0.08 + 0.03 * away**2 * rng.uniform(0.7, 1.3), 0.08 + 0.01 * away])
    noise = np.einsum("nij,nj->ni", turns, sigmas * rng.standard_normal((n, 2)))
    return pose, places + noise, np.einsum("nij,nj,nkj->nik", turns, sigmas**2, turns), landmarks


def squared_distances(pose, places, covariances, landmarks):
    """d^2 (n, m); pose (3,), places (n, 2), covariances (n, 2, 2), landmarks (m, 2)."""
    R = rotation(pose[2])
    off = (places @ R.T + pose[:2])[:, None] - landmarks
    S = R @ covariances @ R.T + 0.02**2 * np.eye(2)
    return np.einsum("nmi,nij,nmj->nm", off, np.linalg.inv(S), off)


def hypotheses(places, labels, landmarks, map_labels, tolerance):
    """Poses (h, 3) of all pairs of matches; places (n, 2), landmarks (m, 2), labels (n,) and (m,)."""
    matches = np.argwhere(np.asarray(labels)[:, None] == np.asarray(map_labels))
    found = []
    for (i, j), (k, m) in itertools.combinations(matches, 2):
        if i == k or j == m:
            continue
        seen, true = places[k] - places[i], landmarks[m] - landmarks[j]
        lengths = np.hypot(*seen), np.hypot(*true)
        if abs(lengths[0] - lengths[1]) > tolerance or min(lengths) < 0.5:
            continue
        theta = wrap_angle(np.arctan2(true[1], true[0]) - np.arctan2(seen[1], seen[0]))
        middle = (landmarks[j] + landmarks[m]) / 2 - rotation(theta) @ (places[i] + places[k]) / 2
        found.append((*middle, theta))
    return np.array(found).reshape(-1, 3)


def verify_hypotheses(arguments: tuple, answer) -> str | None:
    """Return what is wrong with a set of poses, which may come in any order; None if nothing is."""
    wanted, poses = hypotheses(*arguments), np.asarray(as_numbers(answer))
    if not poses.size and not wanted.size:
        return None
    if poses.ndim != 2 or poses.shape[1] != 3:
        return f"Return an array (h, 3): x, y, theta of every pose; yours has shape {poses.shape}."
    if len(poses) != len(wanted):
        much = "many" if len(poses) > len(wanted) else "few"
        return f"Yours are too {much} poses. Each pair of places on each pair of landmarks, both ways round, once."
    same = (np.abs(poses[:, None] - wanted) < 1e-5).all(axis=2)
    if same.any(axis=0).all() and same.any(axis=1).all():
        return None
    return "As many poses as there are, but not these. Lay one pair of places on one pair of landmarks by hand."


def look_alikes(rng: np.random.Generator) -> tuple:
    """A few classes, so that most matches are wrong; two of a kind close together."""
    n = int(rng.integers(3, 6))
    _, places, _, landmarks = scene(rng, n, int(rng.integers(1, 4)))
    labels = rng.choice(["sofa", "chair"], len(landmarks))
    labels[1], landmarks[1] = labels[0], landmarks[0] + rng.uniform(0.15, 0.25, 2)
    places[1] = places[0] + rng.uniform(0.1, 0.2, 2)
    return places, labels[:n], landmarks, labels, float(rng.uniform(0.2, 0.8))


def assign(squared, like, reward):
    """(landmark (n,), score): one-to-one, -1 for none, of greatest total gain."""
    gain = np.where(like, reward - squared / 2, 0.0)
    rows, columns = linear_sum_assignment(np.maximum(gain, 0), maximize=True)
    good = gain[rows, columns] > 0
    landmark = np.full(len(squared), -1)
    landmark[rows[good]] = columns[good]
    return landmark, float(gain[rows[good], columns[good]].sum())


def one_by_one(gain, of_table):
    """A mistake: rows and columns of pairs that are chosen one by one, the best of the table or of the next row."""
    left, pairs = gain.copy(), np.empty((0, 2), dtype=int)
    for row in range(len(gain)):
        i = left.max(axis=1).argmax() if of_table else row
        j = left[i].argmax()
        if left[i, j] > 0:
            pairs = np.vstack([pairs, (i, j)])
            left[i], left[:, j] = 0, 0
    return pairs.T


def rivals_for_landmarks(rng: np.random.Generator) -> tuple:
    """Tables in which observations compete, and some fit nothing."""
    n, m = int(rng.integers(4, 7)), int(rng.integers(4, 8))
    squared = rng.uniform(0, 8, (n, 1)) + rng.uniform(0, 4, (1, m)) + rng.uniform(0, 6, (n, m))
    squared[int(rng.integers(n))] += 40
    return squared, rng.random((n, m)) < 0.8, float(rng.uniform(4, 6))


def refit(start, places, covariances, targets):
    """(x, y, theta) of least weighted squares; start (3,), places and targets (n, 2), covariances (n, 2, 2)."""
    # In the body frame R turns away: e = z - R^T (m - t), and e^T C^-1 e is a sum of squares.
    roots = np.linalg.cholesky(np.linalg.inv(covariances))

    def off(pose):
        return np.einsum("nji,nj->ni", roots, places - (targets - pose[:2]) @ rotation(pose[2])).ravel()

    x, y, theta = least_squares(off, start, xtol=1e-12, ftol=1e-12, gtol=1e-12).x
    return x, y, wrap_angle(theta)


def verify_refit(arguments: tuple, answer) -> str | None:
    """Return what is wrong with a pose; None if its weighted sum of squares is the least, as far as noise can tell."""
    _, places, covariances, targets = arguments
    pose = np.asarray(as_numbers(answer)).ravel()
    if pose.size != 3:
        return "Return three numbers: x, y, theta."
    if not np.isfinite(pose).all():
        return "There is a NaN or an infinity in your pose."
    if abs(pose[2]) > np.pi + 1e-9:
        return "theta from -pi to pi, please."
    off = [places - (targets - (x, y)) @ rotation(theta) for x, y, theta in (pose, refit(*arguments))]
    yours, least = (np.einsum("ni,nij,nj->", one, np.linalg.inv(covariances), one) for one in off)
    if yours <= least + 0.02:  # the noise alone makes this sum 2 n - 3
        return None
    return "Another pose has a smaller weighted sum of squares than yours: is every step a step down, to the end?"


def matched_places(rng: np.random.Generator, theta: float | None = None) -> tuple:
    """Four to eight matches and a start nearby, across the wrap of the heading at times."""
    pose, places, covariances, landmarks = scene(rng, int(rng.integers(4, 9)), 0, theta)
    start = pose + rng.normal(0, [0.15, 0.15, 0.08])
    return np.append(start[:2], wrap_angle(start[2])), places, covariances, landmarks


def confidence(poses, scores, nothing):
    """0 to 1: how sure the best of the poses (h, 3) with scores (h,) is."""
    if not len(poses):
        return 0.0
    best = int(np.argmax(scores))
    far = np.hypot(*(poses[:, :2] - poses[best, :2]).T) > 0.5
    turned = np.abs(wrap_angle(poses[:, 2] - poses[best, 2])) > np.deg2rad(10)
    second = scores[far | turned].max(initial=-np.inf)
    with np.errstate(over="ignore"):
        return float(1 / (1 + np.exp((second - scores[best]) / 2) + np.exp((nothing - scores[best]) / 2)))


def scored_poses(rng: np.random.Generator, height: float = 0.0) -> tuple:
    """The best pose, near copies of it, the same place the other way round, and true rivals."""
    best = np.array([*rng.uniform(1, 5, 2), rng.choice([np.pi - 0.02, rng.uniform(-3, 3)])])
    near, turned = best + rng.uniform(-0.08, 0.08, (3, 3)), best + np.array([0.1, 0, rng.uniform(1, 2)])
    poses = np.vstack([best, near, turned, rng.uniform((7, 7, -3), (9, 9, 3), (3, 3))])
    poses[:, 2] = wrap_angle(poses[:, 2])
    top, order = height + rng.uniform(12, 18), rng.permutation(len(poses))
    scores = top - rng.uniform([0, *[0.2] * 3, 1, *[1.5] * 3], [0, *[1] * 3, 3, *[6] * 3])
    return poses[order], scores[order], float(top - rng.uniform(1, 6))


# fmt: off
EXERCISES = [
    Exercise("P3.1", squared_distances, lambda rng: scene(rng, *rng.integers((2, 1), (6, 5))), "warm-up",
             cases={"nothing seen": lambda rng: scene(rng, 0, 4)}),
    Exercise("P3.2", hypotheses, look_alikes, verify=verify_hypotheses, cases={
        "one seen": lambda rng: (rng.uniform(-3, 3, (1, 2)), np.array(["sofa"]), *look_alikes(rng)[2:]),
    }),
    Exercise("P3.3", assign, rivals_for_landmarks, cases={
        "all too far": lambda rng: (rng.uniform(20, 60, (3, 5)), np.ones((3, 5), dtype=bool), 5.0),
    }, example=(([[1, 2], [1, 9]], [[True, True], [True, True]], 5), ([1, 0], 8.5))),
    Exercise("P3.4", refit, matched_places, "challenge", verify=verify_refit, tolerance=1e-4,
             cases={"heading at the wrap": lambda rng: matched_places(rng, np.pi - 0.01)}, functions={
        lambda start, places, covariances, targets: fit_rigid_2d(places, targets, covariances=covariances):
        "You hold the weights fixed in each step. They turn with the pose: the weighted sum can be less.",
    }),
    Exercise("P3.5", confidence, scored_poses, cases={
        "high scores": lambda rng: scored_poses(rng, 3000.0),
        "far below nothing": lambda rng: (*scored_poses(rng)[:2], 50.0),
        "no pose": lambda rng: (np.zeros((0, 3)), np.zeros(0), 5.0),
        "one answer": lambda rng: (np.array([[2.0, 2.0, 3.12], [2.1, 2.0, -3.13]]), np.array([9.0, 8.5]), 6.0),
        "same place or same heading": lambda rng: (
            np.array([[0, 0, 0], [2, 0, 0], [0, 0, 2], [2, 1, 1]]) + rng.uniform(0, 1, 3), np.arange(10.0, 6, -1), 4.0),
    }),
]
