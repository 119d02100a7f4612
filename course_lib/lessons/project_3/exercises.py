"""Stages of project P3: distances under a pose, poses of two matches, an assignment, a weighted fit, how sure."""

import itertools

import numpy as np
from scipy.optimize import least_squares, linear_sum_assignment

from course_lib.geometry import wrap_angle
from course_lib.lessons.kit.exercises import Exercise


def rotation(theta):
    return np.array([[np.cos(theta), -np.sin(theta)], [np.sin(theta), np.cos(theta)]])


def stereo_covariances(rng: np.random.Generator, places: np.ndarray) -> np.ndarray:
    """Of a stereo camera: centimetres across the ray, along it growing with the square of the distance."""
    away = np.linalg.norm(places, axis=1)
    turns = np.array([rotation(angle) for angle in np.arctan2(places[:, 1], places[:, 0])]).reshape(-1, 2, 2)
    sigmas = np.column_stack([0.08 + 0.03 * away**2 * rng.uniform(0.7, 1.3), 0.08 + 0.01 * away])
    return np.einsum("nij,nj,nkj->nik", turns, sigmas**2, turns)


def scene(rng: np.random.Generator, n: int, m: int) -> tuple:
    """A pose, n places seen from it with their noise, their covariances, m landmarks of which the first n are seen."""
    landmarks = rng.uniform(0, 6, (m, 2))
    pose = np.array([*rng.uniform(1, 5, 2), rng.uniform(-np.pi, np.pi)])
    true = (landmarks[:n] - pose[:2]) @ rotation(pose[2])
    covariances = stereo_covariances(rng, true)
    noise = np.array([rng.multivariate_normal([0, 0], one) for one in covariances]).reshape(n, 2)
    return pose, true + noise, covariances, landmarks


# P3.1: squared distances under a pose


def squared_distances(pose, places, covariances, landmarks):
    """d^2 (n, m); pose (3,), places (n, 2), covariances (n, 2, 2), landmarks (m, 2)."""
    R = np.array([[np.cos(pose[2]), -np.sin(pose[2])], [np.sin(pose[2]), np.cos(pose[2])]])
    off = (places @ R.T + pose[:2])[:, None] - landmarks
    S = R @ covariances @ R.T + 0.02**2 * np.eye(2)
    return np.einsum("nmi,nij,nmj->nm", off, np.linalg.inv(S), off)


def some_seen(rng: np.random.Generator) -> tuple:
    n = int(rng.integers(2, 6))
    return scene(rng, n, n + int(rng.integers(1, 5)))


def nothing_seen(rng: np.random.Generator) -> tuple:
    return scene(rng, 0, 4)


# P3.2: poses of two matches


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
    wanted = hypotheses(*arguments)
    try:
        poses = np.asarray(answer, dtype=np.float64)
    except (TypeError, ValueError):
        return "Return an array (h, 3): x, y, theta of every pose."
    if not poses.size and not wanted.size:
        return None
    if poses.ndim != 2 or poses.shape[1] != 3:
        return f"Return an array (h, 3): x, y, theta of every pose; yours has shape {poses.shape}."
    if len(poses) != len(wanted):
        much = "many" if len(poses) > len(wanted) else "few"
        return f"Yours are too {much} poses. Each pair of places on each pair of landmarks, both ways round, once."
    off = np.abs(poses[:, None] - wanted[None])
    off[..., 2] = np.minimum(off[..., 2], np.abs(poses[:, None, 2] - wanted[None, :, 2]))
    same = (off < 1e-5).all(axis=2)
    if same.any(axis=0).all() and same.any(axis=1).all():
        return None
    return "As many poses as there are, but not these. Lay one pair of places on one pair of landmarks by hand."


def look_alikes(rng: np.random.Generator) -> tuple:
    """A few classes, so that most matches are wrong; two of a kind close together."""
    n = int(rng.integers(3, 6))
    m = n + int(rng.integers(1, 4))
    _, places, _, landmarks = scene(rng, n, m)
    labels = rng.choice(["sofa", "chair"], m)
    landmarks[1] = landmarks[0] + rng.uniform(0.15, 0.25, 2)
    labels[1] = labels[0]
    places[1] = places[0] + rng.uniform(0.1, 0.2, 2)
    return places, labels[:n], landmarks, labels, float(rng.uniform(0.2, 0.8))


def one_seen(rng: np.random.Generator) -> tuple:
    places, labels, *others = look_alikes(rng)
    return places[:1], labels[:1], *others


# P3.3: one-to-one, or unmatched


def assign(squared, like, reward):
    """(landmark (n,), score): one-to-one, -1 for none, of greatest total gain."""
    gain = np.where(like, reward - squared / 2, 0.0)
    rows, columns = linear_sum_assignment(np.maximum(gain, 0), maximize=True)
    good = gain[rows, columns] > 0
    landmark = np.full(len(squared), -1)
    landmark[rows[good]] = columns[good]
    return landmark, float(gain[rows[good], columns[good]].sum())


def greedy(squared, like, reward, order):
    """A mistake: pairs are chosen one after the other. order: of the paper, row by row, or with landmarks twice."""
    gain = np.where(like, reward - squared / 2, 0.0)
    left, landmark = gain.copy(), np.full(len(gain), -1)
    for row in range(len(gain)):
        i = int(left.max(axis=1).argmax()) if order == "paper" else row
        j = int(left[i].argmax())
        if left[i, j] > 0:
            landmark[i] = j
            left[i] = 0
            left[:, j] = left[:, j] if order == "twice" else 0
    return landmark, float(gain[landmark >= 0, landmark[landmark >= 0]].sum())


def everything_first(squared, like, reward):
    """A mistake: all are matched, and bad pairs are dropped afterwards."""
    gain = np.where(like, reward - squared / 2, -1e6)
    rows, columns = linear_sum_assignment(gain, maximize=True)
    landmark = np.full(len(gain), -1)
    landmark[rows] = np.where(gain[rows, columns] > 0, columns, -1)
    return landmark, float(np.maximum(gain[rows, columns], 0).sum())


def rivals_for_landmarks(rng: np.random.Generator) -> tuple:
    """Tables in which observations compete, some fit nothing, and the ways that look right lead elsewhere."""
    while True:
        n, m = int(rng.integers(4, 7)), int(rng.integers(4, 8))
        squared = rng.uniform(0, 8, (n, 1)) + rng.uniform(0, 4, (1, m)) + rng.uniform(0, 6, (n, m))
        squared[int(rng.integers(n))] += 40
        given = squared, rng.random((n, m)) < 0.8, float(rng.uniform(4, 6))
        others = [*(greedy(*given, order) for order in ("paper", "row", "twice")), everything_first(*given)]
        if not any(np.array_equal(assign(*given)[0], other) for other, _ in others):
            return given


def all_too_far(rng: np.random.Generator) -> tuple:
    return rng.uniform(20, 60, (3, 5)), np.ones((3, 5), dtype=bool), 5.0


# P3.4: the fit that knows its noise


def refit(start, places, covariances, targets):
    """(x, y, theta) of least weighted squares; start (3,), places and targets (n, 2), covariances (n, 2, 2)."""
    # In the body frame R turns away: e = z - R^T (m - t), and e^T C^-1 e is a sum of squares.
    roots = np.linalg.cholesky(np.linalg.inv(covariances))

    def off(pose):
        return np.einsum("nji,nj->ni", roots, places - (targets - pose[:2]) @ rotation(pose[2])).ravel()

    x, y, theta = least_squares(off, start, xtol=1e-12, ftol=1e-12, gtol=1e-12).x
    return x, y, wrap_angle(theta)


def in_steps(start, places, covariances, targets, steps=30):
    """A mistake: Gauss-Newton with the weights of the step before."""
    pose = np.array(start, dtype=float)
    for _ in range(steps):
        R = rotation(pose[2])
        turned = places @ R.T
        weights = np.linalg.inv(R @ covariances @ R.T)
        jacobian = np.tile(np.eye(2, 3), (len(places), 1, 1))
        jacobian[:, 0, 2], jacobian[:, 1, 2] = -turned[:, 1], turned[:, 0]
        normal = np.einsum("nki,nkl,nlj->ij", jacobian, weights, jacobian)
        slope = np.einsum("nki,nkl,nl->i", jacobian, weights, turned + pose[:2] - targets)
        pose = pose - np.linalg.solve(normal, slope)
    return pose[0], pose[1], wrap_angle(pose[2])


def weighted_sum(pose, places, covariances, targets):
    off = places - (targets - pose[:2]) @ rotation(pose[2])
    return float(np.einsum("ni,nij,nj->", off, np.linalg.inv(covariances), off))


def verify_refit(arguments: tuple, answer) -> str | None:
    """Return what is wrong with a pose; None if its weighted sum of squares is the least, as far as noise can tell."""
    try:
        pose = np.asarray(answer, dtype=np.float64).reshape(3)
    except (TypeError, ValueError):
        return "Return three numbers: x, y, theta."
    if not np.isfinite(pose).all():
        return "There is a NaN or an infinity in your pose."
    if abs(pose[2]) > np.pi + 1e-9:
        return "theta from -pi to pi, please."
    if weighted_sum(pose, *arguments[1:]) <= weighted_sum(refit(*arguments), *arguments[1:]) + 0.02:
        return None  # the noise alone makes this sum 2 n - 3
    return "Another pose has a smaller weighted sum of squares than yours: is every step a step down, to the end?"


def matched_places(rng: np.random.Generator) -> tuple:
    """Four to eight matches and a start nearby, across the wrap of the heading at times."""
    n = int(rng.integers(4, 9))
    pose, places, covariances, landmarks = scene(rng, n, n)
    return pose + rng.normal(0, [0.15, 0.15, 0.08]), places, covariances, landmarks


def heading_at_the_wrap(rng: np.random.Generator) -> tuple:
    landmarks = rng.uniform(0, 6, (6, 2))
    places = (landmarks - 3.0) @ rotation(np.pi - 0.01) + rng.normal(0, 0.05, (6, 2))
    return np.array([3.0, 3.0, -np.pi + 0.02]), places, stereo_covariances(rng, places), landmarks


# P3.5: how sure


def confidence(poses, scores, nothing):
    """0 to 1: how sure the best of the poses (h, 3) with scores (h,) is."""
    if not len(poses):
        return 0.0
    best = int(np.argmax(scores))
    far = np.hypot(*(poses[:, :2] - poses[best, :2]).T) > 0.5
    turned = np.abs(wrap_angle(poses[:, 2] - poses[best, 2])) > np.deg2rad(10)
    rival = np.exp((scores[far | turned] - scores[best]) / 2).max(initial=0.0)
    with np.errstate(over="ignore"):
        return float(1 / (1 + rival + np.exp((nothing - scores[best]) / 2)))


def overflowing(poses, scores, nothing):
    """A mistake: exponentials of the scores themselves."""
    if not len(poses):
        return 0.0
    best = poses[np.argmax(scores)]
    another = (np.hypot(*(poses[:, :2] - best[:2]).T) > 0.5) | (np.abs(wrap_angle(poses[:, 2] - best[2])) > 0.1745)
    with np.errstate(over="ignore", invalid="ignore"):
        weights = np.exp(0.5 * scores)
        return weights.max() / (weights.max() + weights[another].max(initial=0.0) + np.exp(0.5 * nothing))


def scored_poses(rng: np.random.Generator, height: float = 0.0) -> tuple:
    """The best pose, near copies of it, the same place the other way round, and true rivals."""
    best = np.array([*rng.uniform(1, 5, 2), rng.choice([np.pi - 0.02, rng.uniform(-3, 3)])])
    near = best + rng.uniform(-0.05, 0.05, (3, 3)) + [[0, 0, 0], [0, 0, 0.04], [0, 0, -0.04]]
    turned = best + np.array([0.1, 0.0, rng.uniform(1, 2)])
    poses = np.vstack([best, near, turned, np.column_stack([rng.uniform(7, 9, (3, 2)), rng.uniform(-3, 3, 3)])])
    poses[:, 2] = wrap_angle(poses[:, 2])
    top = height + rng.uniform(12, 18)
    scores = top - np.concatenate([[0.0], rng.uniform(0.2, 1, 3), rng.uniform(1, 3, 1), rng.uniform(1.5, 6, 3)])
    order = rng.permutation(len(poses))
    return poses[order], scores[order], float(top - rng.uniform(1, 6))


def high_scores(rng: np.random.Generator) -> tuple:
    return scored_poses(rng, 3000.0)


def far_below_nothing(rng: np.random.Generator) -> tuple:
    poses, scores, _ = scored_poses(rng)
    return poses, scores, float(scores.max() + 30)


def no_pose(rng: np.random.Generator) -> tuple:
    return np.zeros((0, 3)), np.zeros(0), 5.0


def one_answer(rng: np.random.Generator) -> tuple:
    return np.array([[2.0, 2.0, 3.12], [2.1, 2.0, -3.13]]), np.array([9.0, 8.5]), 6.0


def same_place_or_same_heading(rng: np.random.Generator) -> tuple:
    best = np.append(rng.uniform(1, 3, 2), rng.uniform(-3, 3))
    poses = best + np.array([[0, 0, 0], [2, 0, 0], [0, 0, 2], [2, 1, 1]])
    poses[:, 2] = wrap_angle(poses[:, 2])
    return poses, np.array([10.0, 9.0, 8.0, 7.0]), 4.0


# fmt: off
EXERCISES = [
    Exercise("P3.1", squared_distances, some_seen, "warm-up", cases=[nothing_seen], mistakes="""
        R @ covariances @ R.T => covariances
        R @ covariances @ R.T => R.T @ covariances @ R
        The covariances are in the body frame, the residuals on the map: turn them, R C R^T.
        places @ R.T => places @ R
        R is transposed: (1, 0) in the body frame must go to (cos theta, sin theta) on the map.
        places @ R.T => places
        The places are not turned by the pose's heading.
        + pose[:2] =>
        The places are turned, but not moved to where the rig stands.
        + 0.02**2 * np.eye(2) =>
        0.02**2 => 0.02
        The map's own 2 cm are missing, or not squared: S = R C R^T + 0.02^2 I.
        np.linalg.inv(S) => S
        You multiply by S. What is unsure must count less: its inverse.
        np.linalg.inv(S) => np.linalg.inv(S * np.eye(2))
        You use the diagonal of S alone. An error along the ray is in x and in y at once.
        ... => return np.sqrt(squared_distances(pose, places, covariances, landmarks))
        ... => return squared_distances(pose, places, covariances, landmarks) / 2
        d^2 is r S^-1 r: without a root, and without the half, which belongs to stage 3.
        np.linalg.inv(S) => np.tile(np.eye(2), (len(S), 1, 1))
        That is the squared distance in metres. Weigh it with the inverse of S.
    """),
    Exercise("P3.2", hypotheses, look_alikes, cases=[one_seen], verify=verify_hypotheses, mistakes="""
        or j == m: => or m <= j:
        Two observations lie on two landmarks in two ways: first on first, and first on second.
        np.asarray(labels)[:, None] == np.asarray(map_labels) => np.ones((len(places), len(landmarks)))
        You lay sofas on chairs: the labels must agree, both times.
        abs(lengths[0] - lengths[1]) > tolerance or min => min
        Lengths that disagree by more than the tolerance cannot both be right: leave them out.
        abs(lengths[0] - lengths[1]) => lengths[0] - lengths[1]
        A length may be too long *or too short*: take the absolute difference.
        or min(lengths) < 0.5 =>
        Two things closer together than 0.5 m tell no heading worth having: leave such pairs out.
        (landmarks[j] + landmarks[m]) / 2 => landmarks[j] and also (places[i] + places[k]) / 2 => places[i]
        You lay the first on the first; then the second takes the whole error. Lay middle on middle.
        seen, true = => true, seen =
        (*middle, theta) => (*middle, 0.0)
        theta is the angle from the observed line to the line on the map: not the way back, and not 0.
    """),
    Exercise("P3.3", assign, rivals_for_landmarks, cases=[all_too_far], mistakes="""
        ... => return everything_first(squared, like, reward)
        You match everything first and drop the bad pairs afterwards: a pair that is dropped spoilt others.
        ... => return greedy(squared, like, reward, "paper")
        That is the paper's repeated choice of the best. The greatest *total* may begin with a lesser pair.
        ... => return greedy(squared, like, reward, "twice")
        Two observations may take one landmark in yours: it must be one-to-one.
        ... => return greedy(squared, like, reward, "row")
        Yours depends on the order of the observations: the first takes what a later one needs more.
        np.where(like, reward - squared / 2, 0.0) => reward - squared / 2
        You match unlike classes.
        squared / 2 => squared
        A squared distance costs half of itself: the exponent of the normal distribution is -d^2 / 2.
        float(gain => -float(gain
        float(gain => float(squared
        float(gain[rows[good], columns[good]].sum()) => float(good.sum())
        float(gain[rows[good], columns[good]].sum()) => float(gain[rows, columns][good].mean()) if good.any() else 0.0
        The score is the sum of the gains, reward - d^2 / 2 for each match: no count, no mean, no distance.
        np.full(len(squared), -1) => np.zeros(len(squared), int)
        An observation without a landmark gets -1, not 0: landmark 0 is one.
    """),
    Exercise("P3.4", refit, matched_places, "challenge", cases=[heading_at_the_wrap], verify=verify_refit,
             tolerance=1e-4, mistakes="""
        np.linalg.inv(covariances) => np.tile(np.eye(2), (len(places), 1, 1))
        All pairs count alike in yours: that is the paper's fit. The covariances are not used.
        ... => return in_steps(start, places, covariances, targets)
        You hold the weights fixed in each step. They turn with the pose: the weighted sum can be less.
        inv(covariances) => inv(np.trace(covariances, axis1=1, axis2=2)[:, None, None] * np.eye(2))
        One weight for each pair is not enough: a place is sure across its ray and unsure along it.
        ... => return in_steps(start, places, covariances, targets, steps=1)
        One step of Gauss and Newton is not the end: step until nothing moves.
        places - (targets - pose[:2]) @ rotation(pose[2]) => places @ rotation(pose[2]).T + pose[:2] - targets
        The covariances are in the body frame: turn them onto the map, or the residuals back.
        np.linalg.inv(covariances) => covariances
        You weigh with the covariances. What is unsure must count less: their inverses.
        wrap_angle(theta) => wrap_angle(theta) % (2 * np.pi)
        Your theta runs from 0 to 2 pi; asked is -pi to pi.
        ... => return tuple(start)
        That is the start, unchanged.
    """),
    Exercise("P3.5", confidence, scored_poses, cases=[
        high_scores, far_below_nothing, no_pose, one_answer, same_place_or_same_heading,
    ], mistakes="""
        far | turned => np.arange(len(poses)) != best
        A pose within 0.5 m and 10 degrees of the best is the same answer, and no rival of it.
        far | turned => far
        The same place the other way round is another answer: look at the heading, too.
        wrap_angle(poses[:, 2] - poses[best, 2]) => poses[:, 2] - poses[best, 2]
        Headings of 3.12 and -3.13 differ by 0.03: wrap them.
        / 2 =>
        The scores count half: e to the power of half their difference.
        + np.exp((nothing - scores[best]) / 2) =>
        `nothing` is a rival, too: a pose ahead of all others may still explain too little.
        .max(initial=0.0) => .sum()
        You add up all rivals; among them are copies of one answer. Only the best of them counts.
        1 + rival => 1
        The runner-up is missing.
        return 0.0 => return 1.0
        Without any pose there is nothing to be sure of: 0.
        ... => return overflowing(poses, scores, nothing)
        exp(3000) is infinite, and inf / inf is NaN. Only differences to the best score need an exponential.
        ... => return 1 - confidence(poses, scores, nothing)
        That is the doubt. Asked is the confidence.
        far | turned => far & turned
        Another answer is more than 0.5 m away *or* turned by more than 10 degrees; yours asks for both.
        rival + np.exp((nothing - scores[best]) / 2) => max(rival, np.exp((nothing - scores[best]) / 2))
        The runner-up and `nothing` both doubt the best: their exponentials add. You take the greater one.
    """),
]
