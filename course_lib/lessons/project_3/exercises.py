"""Stages of project P3: distances under a pose, poses of two matches, an assignment, a weighted fit, how sure."""

import itertools
from collections.abc import Callable

import numpy as np
from scipy.optimize import least_squares, linear_sum_assignment

from course_lib.geometry import wrap_angle
from course_lib.lessons.kit.exercises import Exercise, Mistake

MAP_SIGMA = 0.02  # m
MIN_LENGTH = 0.5  # m
REFIT_EXCESS = 0.02  # of a sum that the noise alone makes 2 n - 3
SAME_PLACE, SAME_HEADING = 0.5, np.deg2rad(10.0)


def rotation(theta: float) -> np.ndarray:
    """R(theta) (2, 2)."""
    return np.array([[np.cos(theta), -np.sin(theta)], [np.sin(theta), np.cos(theta)]])


def _covariances(rng: np.random.Generator, places: np.ndarray) -> np.ndarray:
    """Of a stereo camera: centimetres across the ray, along it growing with the square of the distance."""
    away = np.linalg.norm(places, axis=1)
    turned = np.array([rotation(angle) for angle in np.arctan2(places[:, 1], places[:, 0])]).reshape(-1, 2, 2)
    along, across = 0.08 + 0.03 * away**2 * rng.uniform(0.7, 1.3), 0.08 + 0.01 * away
    axes = np.array([np.diag(one**2) for one in np.column_stack([along, across])]).reshape(-1, 2, 2)
    return turned @ axes @ np.swapaxes(turned, 1, 2)


def _scene(rng: np.random.Generator, n: int, m: int) -> tuple:
    """A pose, n places seen from it with their noise, their covariances, m landmarks of which the first n are seen."""
    landmarks = rng.uniform(0, 6, (m, 2))
    pose = np.array([*rng.uniform(1, 5, 2), rng.uniform(-np.pi, np.pi)])
    true = (landmarks[:n] - pose[:2]) @ rotation(pose[2])
    covariances = _covariances(rng, true)
    noise = np.array([rng.multivariate_normal([0, 0], one) for one in covariances]).reshape(n, 2)
    return pose, true + noise, covariances, landmarks


# P3.1: squared distances under a pose


def squared_distances(pose, places, covariances, landmarks) -> np.ndarray:
    """d^2 = r^T S^-1 r (n, m), r = R z + t - m, S = R C R^T + 0.02^2 I."""
    return _squared(pose, places, covariances, landmarks)


def _squared(
    pose,
    places,
    covariances,
    landmarks,
    turn: Callable = lambda r, places: places @ r.T,
    spread: Callable = lambda r, c: r @ c @ r.T,
    noise: float = MAP_SIGMA**2,
    shift: float = 1.0,
    weight: Callable = np.linalg.inv,
    finish: Callable = lambda squared: squared,
):
    """The table, and with other parts its mistakes."""
    r = rotation(pose[2])
    off = (turn(r, places) + shift * pose[:2])[:, None] - landmarks[None]
    information = weight(np.array([spread(r, one) for one in covariances]).reshape(-1, 2, 2) + noise * np.eye(2))
    return finish(np.einsum("nmi,nij,nmj->nm", off, information, off))


def _mistaken_squared(**parts) -> Callable:
    return lambda *given: _squared(*given, **parts)


def _some_scene(rng: np.random.Generator) -> tuple:
    n = int(rng.integers(2, 6))
    return _scene(rng, n, n + int(rng.integers(1, 5)))


def _nothing_seen(rng: np.random.Generator) -> tuple:
    return _scene(rng, 0, 4)


# P3.2: poses of two matches


def hypotheses(places, labels, landmarks, map_labels, tolerance) -> np.ndarray:
    """Poses (h, 3) of all pairs of matches: like labels, lengths that agree to tolerance and are at least 0.5 m."""
    return _hypotheses(places, labels, landmarks, map_labels, tolerance)


def _pose_of_two(seen, true):
    theta = np.arctan2(*(true[1] - true[0])[::-1]) - np.arctan2(*(seen[1] - seen[0])[::-1])
    return (*(true.mean(axis=0) - rotation(theta) @ seen.mean(axis=0)), wrap_angle(theta))


def _hypotheses(
    places,
    labels,
    landmarks,
    map_labels,
    tolerance,
    like: bool = True,
    both_ways: bool = True,
    gate: Callable = lambda a, b, tolerance: abs(a - b) <= tolerance,
    min_length: float = MIN_LENGTH,
    pose: Callable = _pose_of_two,
):
    """The poses, and with other parts their mistakes."""
    seen_lengths, true_lengths = (
        np.linalg.norm(points[:, None] - points[None], axis=2) for points in (places, landmarks)
    )
    matches = [
        (i, j) for i in range(len(places)) for j in range(len(landmarks)) if not like or labels[i] == map_labels[j]
    ]
    found = []
    for (i, j), (k, m) in itertools.combinations(matches, 2):
        if i == k or j == m or (m < j and not both_ways):
            continue
        a, b = seen_lengths[i, k], true_lengths[j, m]
        if gate(a, b, tolerance) and min(a, b) >= min_length:
            found.append(pose(places[[i, k]], landmarks[[j, m]]))
    return np.array(found).reshape(-1, 3)


def _mistaken_hypotheses(**parts) -> Callable:
    return lambda *given: _hypotheses(*given, **parts)


def _first_on_first(seen, true):
    theta = np.arctan2(*(true[1] - true[0])[::-1]) - np.arctan2(*(seen[1] - seen[0])[::-1])
    return (*(true[0] - rotation(theta) @ seen[0]), wrap_angle(theta))


def _verify_hypotheses(arguments: tuple, answer) -> str | None:
    """What is wrong with a set of poses, which may come in any order; None where nothing is."""
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


def _look_alikes(rng: np.random.Generator) -> tuple:
    """A few classes, so that most matches are wrong; two of a kind close together."""
    n = int(rng.integers(3, 6))
    m = n + int(rng.integers(1, 4))
    _, places, _, landmarks = _scene(rng, n, m)
    labels = rng.choice(["sofa", "chair"], m)
    landmarks[1] = landmarks[0] + rng.uniform(0.15, 0.25, 2)
    labels[1] = labels[0]
    places[1] = places[0] + rng.uniform(0.1, 0.2, 2)
    return places, labels[:n], landmarks, labels, float(rng.uniform(0.2, 0.8))


def _one_seen(rng: np.random.Generator) -> tuple:
    places, labels, landmarks, map_labels, tolerance = _look_alikes(rng)
    return places[:1], labels[:1], landmarks, map_labels, tolerance


# P3.3: one-to-one, or unmatched


def assign(squared, like, reward) -> tuple[np.ndarray, float]:
    """Landmark (n,) of every observation, -1: none, and the score: the greatest total of reward - d^2 / 2, one-to-one.

    Only pairs of like classes (n, m) whose gain is above 0 may be made.
    """
    return _assigned(squared, like, reward)


def _best_total(gain):
    return zip(*linear_sum_assignment(np.maximum(gain, 0), maximize=True), strict=True)


def _assigned(
    squared,
    like,
    reward,
    gain: Callable = lambda squared, reward: reward - squared / 2,
    pairs: Callable = _best_total,
    masked: bool = True,
    keep: Callable = lambda gain: gain > 0,
    total: Callable = lambda gains, squared: sum(gains),
    left: int = -1,
):
    """Landmarks and score, and with other parts their mistakes."""
    gains = gain(squared, reward)
    if masked:
        gains = np.where(like, gains, -np.inf)
    landmark, kept = np.full(len(squared), left), []
    for i, j in pairs(gains):
        if keep(gains[i, j]):
            landmark[i] = j
            kept.append((gains[i, j], squared[i, j]))
    return landmark, float(total([one for one, _ in kept], [one for _, one in kept]))


def _mistaken_assignment(**parts) -> Callable:
    return lambda *given: _assigned(*given, **parts)


def _repeated_maximum(gain):
    gain = gain.copy()
    for _ in range(min(gain.shape)):
        i, j = np.unravel_index(gain.argmax(), gain.shape)
        if gain[i, j] == -np.inf:
            return
        yield int(i), int(j)
        gain[i], gain[:, j] = -np.inf, -np.inf


def _each_its_best(gain):
    return ((i, int(row.argmax())) for i, row in enumerate(gain))


def _row_by_row(gain):
    gain = gain.copy()
    for i in range(len(gain)):
        j = int(gain[i].argmax())
        yield i, j
        if gain[i, j] > 0:
            gain[:, j] = -np.inf


def _everything_first(gain):
    return zip(*linear_sum_assignment(np.maximum(gain, -1e6), maximize=True), strict=True)


def _distances_with_rivalry(rng: np.random.Generator) -> tuple:
    """Tables in which observations compete, some fit nothing, and the roads that look right lead elsewhere."""
    while True:
        n, m = int(rng.integers(4, 7)), int(rng.integers(4, 8))
        squared = rng.uniform(0, 8, (n, 1)) + rng.uniform(0, 4, (1, m)) + rng.uniform(0, 6, (n, m))
        squared[int(rng.integers(n))] += 40
        like, reward = rng.random((n, m)) < 0.8, float(rng.uniform(4, 6))
        right = assign(squared, like, reward)[0]
        others = (_repeated_maximum, _each_its_best, _row_by_row, _everything_first)
        if all(not np.array_equal(right, _assigned(squared, like, reward, pairs=one)[0]) for one in others):
            return squared, like, reward


def _all_too_far(rng: np.random.Generator) -> tuple:
    return rng.uniform(20, 60, (3, 5)), np.ones((3, 5), dtype=bool), 5.0


# P3.4: the fit that knows its noise


def refit(start, places, covariances, targets) -> tuple[float, float, float]:
    """(x, y, theta) that makes sum r^T (R C R^T)^-1 r least, r = R z + t - m."""
    return _weighted_fit(start, places, covariances, targets)


def _weighted_fit(start, places, covariances, targets):
    """In the body frame R turns away: e = z - R^T (m - t), and e^T C^-1 e is a sum of squares."""
    roots = np.linalg.cholesky(np.linalg.inv(covariances))

    def whitened(pose):
        off = places - (targets - pose[:2]) @ rotation(pose[2])
        return np.einsum("nji,nj->ni", roots, off).ravel()

    x, y, theta = least_squares(whitened, _alike(start, places, targets), xtol=1e-14, ftol=1e-14, gtol=1e-14).x
    return float(x), float(y), float(wrap_angle(theta))


def _alike(start, places, targets):
    """All pairs counted alike: the closed form."""
    a, b = places - places.mean(axis=0), targets - targets.mean(axis=0)
    theta = np.arctan2(np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]), np.sum(a * b))
    return (*(targets.mean(axis=0) - rotation(theta) @ places.mean(axis=0)), float(theta))


def _in_steps(start, places, covariances, targets, steps=30, spread=lambda r, c: r @ c @ r.T, weigh=np.linalg.inv):
    """Gauss-Newton with the weights of the step before; with other parts its mistakes."""
    pose = np.array(start, dtype=float)
    for _ in range(steps):
        r = rotation(pose[2])
        turned = places @ r.T
        weights = weigh(np.array([spread(r, one) for one in covariances]))
        jacobian = np.zeros((len(places), 2, 3))
        jacobian[:, 0, 0] = jacobian[:, 1, 1] = 1
        jacobian[:, 0, 2], jacobian[:, 1, 2] = -turned[:, 1], turned[:, 0]
        normal = np.einsum("nki,nkl,nlj->ij", jacobian, weights, jacobian)
        slope = np.einsum("nki,nkl,nl->i", jacobian, weights, turned + pose[:2] - targets)
        pose = pose - np.linalg.solve(normal, slope)
    return float(pose[0]), float(pose[1]), float(wrap_angle(pose[2]))


def _mistaken_steps(**parts) -> Callable:
    return lambda *given: _in_steps(*given, **parts)


def _weighted_sum(pose, places, covariances, targets) -> float:
    off = places - (targets - pose[:2]) @ rotation(pose[2])
    return float(np.einsum("ni,nij,nj->", off, np.linalg.inv(covariances), off))


def _verify_refit(arguments: tuple, answer) -> str | None:
    """What is wrong with a pose; None where its weighted sum of squares is the least, as far as noise could tell."""
    try:
        pose = np.asarray(answer, dtype=np.float64).reshape(3)
    except (TypeError, ValueError):
        return "Return three numbers: x, y, theta."
    if not np.isfinite(pose).all():
        return "There is a NaN or an infinity in your pose."
    if abs(pose[2]) > np.pi + 1e-9:
        return "theta from -pi to pi, please."
    start, places, covariances, targets = arguments
    least = _weighted_sum(refit(start, places, covariances, targets), places, covariances, targets)
    if _weighted_sum(pose, places, covariances, targets) <= least + REFIT_EXCESS:
        return None
    return "Another pose has a smaller weighted sum of squares than yours: is every step a step down, to the end?"


def _by_traces(covariance):
    return np.array([np.eye(2) / np.trace(one) for one in covariance])


def _matched_places(rng: np.random.Generator) -> tuple:
    """Four to eight matches and a start nearby, across the wrap of the heading at times."""
    n = int(rng.integers(4, 9))
    pose, places, covariances, landmarks = _scene(rng, n, n)
    start = pose + rng.normal(0, [0.15, 0.15, 0.08])
    return start, places, covariances, landmarks


def _heading_at_the_wrap(rng: np.random.Generator) -> tuple:
    landmarks = rng.uniform(0, 6, (6, 2))
    back = np.array([3.0, 3.0, np.pi - 0.01])
    places = (landmarks - back[:2]) @ rotation(back[2]) + rng.normal(0, 0.05, (6, 2))
    return np.array([3.0, 3.0, -np.pi + 0.02]), places, _covariances(rng, places), landmarks


# P3.5: how sure


def confidence(poses, scores, nothing) -> float:
    """1 / (1 + e^((s_2 - s_1) / 2) + e^((nothing - s_1) / 2)); s_2: the best score of another answer; 0 without poses.

    Poses within 0.5 m and 10 degrees of the best are the same answer as the best.
    """
    return _sure(poses, scores, nothing)


def _another(poses, best):
    far = np.linalg.norm(poses[:, :2] - best[:2], axis=1) > SAME_PLACE
    return far | (np.abs(wrap_angle(poses[:, 2] - best[2])) > SAME_HEADING)


def _sure(
    poses,
    scores,
    nothing,
    another: Callable = _another,
    temper: float = 0.5,
    absolute: bool = True,
    rivals: Callable = lambda weights: weights.max(initial=0.0),
    none: float = 0.0,
):
    """The confidence, and with other parts its mistakes."""
    if not len(poses):
        return none
    k = int(np.argmax(scores))
    with np.errstate(over="ignore"):
        weights = np.exp(temper * (scores[another(poses, poses[k])] - scores[k]))
        nobody = np.exp(temper * (nothing - scores[k])) if absolute else 0.0
    return float(1 / (1 + rivals(weights) + nobody))


def _mistaken_confidence(**parts) -> Callable:
    return lambda *given: _sure(*given, **parts)


def _all_but_itself(poses, best):
    return ~(poses == best).all(axis=1)


def _without_wrap(poses, best):
    far = np.linalg.norm(poses[:, :2] - best[:2], axis=1) > SAME_PLACE
    return far | (np.abs(poses[:, 2] - best[2]) > SAME_HEADING)


def _elsewhere_and_turned(poses, best):
    far = np.linalg.norm(poses[:, :2] - best[:2], axis=1) > SAME_PLACE
    return far & (np.abs(wrap_angle(poses[:, 2] - best[2])) > SAME_HEADING)


def _one_rival(poses, scores, nothing):
    if not len(poses):
        return 0.0
    runner_up = scores[_another(poses, poses[np.argmax(scores)])].max(initial=nothing)
    return float(1 / (1 + np.exp((runner_up - scores.max()) / 2)))


def _overflowing(poses, scores, nothing):
    if not len(poses):
        return 0.0
    k = int(np.argmax(scores))
    with np.errstate(over="ignore", invalid="ignore"):
        weights = np.exp(0.5 * scores)
        rival = weights[_another(poses, poses[k])].max(initial=0.0)
        return float(weights[k] / (weights[k] + rival + np.exp(0.5 * nothing)))


def _scored_poses(rng: np.random.Generator, height: float = 0.0) -> tuple:
    """The best pose, near copies of it, the same place the other way round, and true rivals."""
    best = np.array([*rng.uniform(1, 5, 2), rng.choice([np.pi - 0.02, rng.uniform(-3, 3)])])
    near = best + rng.uniform(-0.05, 0.05, (3, 3))
    near[:, 2] = wrap_angle(near[:, 2] + np.array([0.0, 0.04, -0.04]))
    turned = best + np.array([0.1, 0.0, rng.uniform(1, 2)])
    turned[2] = wrap_angle(turned[2])
    others = np.column_stack([rng.uniform(7, 9, (3, 2)), rng.uniform(-3, 3, 3)])
    poses = np.vstack([best, near, turned, others])
    top = height + rng.uniform(12, 18)
    scores = top - np.concatenate([[0.0], rng.uniform(0.2, 1, 3), rng.uniform(1, 3, 1), rng.uniform(1.5, 6, 3)])
    order = rng.permutation(len(poses))
    return poses[order], scores[order], float(top - rng.uniform(1, 6))


def _high_scores(rng: np.random.Generator) -> tuple:
    return _scored_poses(rng, 3000.0)


def _far_below_nothing(rng: np.random.Generator) -> tuple:
    poses, scores, _ = _scored_poses(rng)
    return poses, scores, float(scores.max() + 30)


def _no_pose(rng: np.random.Generator) -> tuple:
    return np.zeros((0, 3)), np.zeros(0), 5.0


def _far_and_looking_alike(rng: np.random.Generator) -> tuple:
    """A rival elsewhere with the same heading, one at the same place turned round, and both at once."""
    best = np.array([*rng.uniform(1, 3, 2), rng.uniform(-3, 3)])
    poses = best + np.array([[0, 0, 0], [2, 0, 0], [0, 0, 2], [2, 1, 1]])
    poses[:, 2] = wrap_angle(poses[:, 2])
    return poses, np.array([10.0, 9.0, 8.0, 7.0]), 4.0


def _one_answer(rng: np.random.Generator) -> tuple:
    poses = np.array([[2.0, 2.0, 3.12], [2.1, 2.0, -3.13]])
    return poses, np.array([9.0, 8.5]), 6.0


EXERCISES = [
    Exercise(
        number="P3.1",
        level="warm-up",
        solution=squared_distances,
        inputs=_some_scene,
        cases=(_nothing_seen,),
        mistakes=(
            Mistake(
                _mistaken_squared(spread=lambda r, c: c),
                "The covariances are in the body frame, the residuals on the map: turn them, R C R^T.",
            ),
            Mistake(
                _mistaken_squared(spread=lambda r, c: r.T @ c @ r),
                "You turn the covariances back: R on the left, its transpose on the right.",
            ),
            Mistake(
                _mistaken_squared(turn=lambda r, places: places @ r),
                "R is transposed: (1, 0) in the body frame must go to (cos theta, sin theta) on the map.",
            ),
            Mistake(
                _mistaken_squared(turn=lambda r, places: places),
                "The places are not turned by the pose's heading.",
            ),
            Mistake(_mistaken_squared(shift=0.0), "The places are turned, but not moved to where the rig stands."),
            Mistake(
                _mistaken_squared(noise=0.0),
                "The map's own 2 cm are missing: S = R C R^T + 0.02^2 I.",
            ),
            Mistake(_mistaken_squared(noise=MAP_SIGMA), "Variances add: 0.02 is to be squared."),
            Mistake(
                _mistaken_squared(weight=lambda s: s),
                "You multiply by S. What is unsure must count less: its inverse.",
            ),
            Mistake(
                _mistaken_squared(
                    weight=lambda s: np.array([np.diag(1 / np.diag(one)) for one in s]).reshape(-1, 2, 2)
                ),
                "You use the diagonal of S alone. An error along the ray is in x and in y at once.",
            ),
            Mistake(_mistaken_squared(finish=np.sqrt), "Squared, please: without the root."),
            Mistake(
                _mistaken_squared(weight=lambda s: np.tile(np.eye(2), (len(s), 1, 1))),
                "That is the squared distance in metres. Weigh it with the inverse of S.",
            ),
            Mistake(
                lambda *given: squared_distances(*given) / 2,
                "The half belongs to stage 3. d^2 is r S^-1 r, without it.",
            ),
        ),
    ),
    Exercise(
        number="P3.2",
        solution=hypotheses,
        inputs=_look_alikes,
        cases=(_one_seen,),
        verify=_verify_hypotheses,
        mistakes=(
            Mistake(
                _mistaken_hypotheses(both_ways=False),
                "Two observations lie on two landmarks in two ways: first on first, and first on second.",
            ),
            Mistake(_mistaken_hypotheses(like=False), "You lay sofas on chairs: the labels must agree, both times."),
            Mistake(
                _mistaken_hypotheses(gate=lambda a, b, tolerance: True),
                "Lengths that disagree by more than the tolerance cannot both be right: leave them out.",
            ),
            Mistake(
                _mistaken_hypotheses(gate=lambda a, b, tolerance: a - b <= tolerance),
                "A length may be too long *or too short*: take the absolute difference.",
            ),
            Mistake(
                _mistaken_hypotheses(min_length=0.0),
                "Two things closer together than 0.5 m tell no heading worth having: leave such pairs out.",
            ),
            Mistake(
                _mistaken_hypotheses(pose=_first_on_first),
                "You lay the first on the first; then the second takes the whole error. Lay middle on middle.",
            ),
            Mistake(
                _mistaken_hypotheses(pose=lambda seen, true: _pose_of_two(true, seen)),
                "That takes the map to the body. Asked is the pose: from the body to the map.",
            ),
            Mistake(
                _mistaken_hypotheses(pose=lambda seen, true: (*_pose_of_two(seen, true)[:2], 0.0)),
                "theta is missing: the angle from the observed line to the line on the map.",
            ),
        ),
    ),
    Exercise(
        number="P3.3",
        solution=assign,
        inputs=_distances_with_rivalry,
        cases=(_all_too_far,),
        mistakes=(
            Mistake(
                _mistaken_assignment(pairs=_everything_first),
                "You match everything first and drop the bad pairs afterwards: a pair that is dropped spoilt others.",
            ),
            Mistake(
                _mistaken_assignment(pairs=_repeated_maximum),
                "That is the paper's repeated choice of the best. The greatest *total* may begin with a lesser pair.",
            ),
            Mistake(
                _mistaken_assignment(pairs=_each_its_best),
                "Two observations may take one landmark in yours: it must be one-to-one.",
            ),
            Mistake(
                _mistaken_assignment(pairs=_row_by_row),
                "Yours depends on the order of the observations: the first takes what a later one needs more.",
            ),
            Mistake(_mistaken_assignment(masked=False), "You match unlike classes."),
            Mistake(
                _mistaken_assignment(gain=lambda squared, reward: reward - squared),
                "A squared distance costs half of itself: the exponent of the normal distribution is -d^2 / 2.",
            ),
            Mistake(
                _mistaken_assignment(total=lambda gains, squared: -sum(gains)),
                "The score is the gain: the greater the better. Yours has the wrong sign.",
            ),
            Mistake(
                _mistaken_assignment(total=lambda gains, squared: sum(squared)),
                "Your score is the sum of squared distances. It must reward every match: reward - d^2 / 2 for each.",
            ),
            Mistake(
                _mistaken_assignment(total=lambda gains, squared: len(gains)),
                "Your score counts the matches. How well each fits counts, too.",
            ),
            Mistake(
                _mistaken_assignment(left=0), "An observation without a landmark gets -1, not 0: landmark 0 is one."
            ),
            Mistake(
                _mistaken_assignment(total=lambda gains, squared: np.mean(gains) if gains else 0.0),
                "The score is the sum of the gains, not their mean.",
            ),
        ),
    ),
    Exercise(
        number="P3.4",
        level="challenge",
        solution=refit,
        inputs=_matched_places,
        cases=(_heading_at_the_wrap,),
        verify=_verify_refit,
        tolerance=1e-4,
        mistakes=(
            Mistake(
                lambda start, places, covariances, targets: _alike(start, places, targets),
                "All pairs count alike in yours: that is the paper's fit. The covariances are not used.",
            ),
            Mistake(
                _in_steps,
                "You hold the weights fixed in each step. They turn with the pose: the weighted sum can be less.",
            ),
            Mistake(
                _mistaken_steps(weigh=_by_traces),
                "One weight for each pair is not enough: a place is sure across its ray and unsure along it.",
            ),
            Mistake(
                _mistaken_steps(steps=1),
                "One step of Gauss and Newton is not the end: step until nothing moves.",
            ),
            Mistake(
                _mistaken_steps(spread=lambda r, c: c),
                "The covariances are in the body frame: turn them onto the map, or the residuals back.",
            ),
            Mistake(
                _mistaken_steps(weigh=lambda s: s),
                "You weigh with the covariances. What is unsure must count less: their inverses.",
            ),
            Mistake(
                lambda *given: (*_weighted_fit(*given)[:2], _weighted_fit(*given)[2] % (2 * np.pi)),
                "Your theta runs from 0 to 2 pi; asked is -pi to pi.",
            ),
            Mistake(
                lambda *given: tuple(float(one) for one in given[0]),
                "That is the start, unchanged.",
            ),
            Mistake(
                lambda *given: (*_weighted_fit(*given)[:2], float(np.degrees(_weighted_fit(*given)[2]))),
                "theta in radians, please.",
            ),
        ),
    ),
    Exercise(
        number="P3.5",
        solution=confidence,
        inputs=_scored_poses,
        cases=(_high_scores, _far_below_nothing, _no_pose, _one_answer, _far_and_looking_alike),
        mistakes=(
            Mistake(
                _mistaken_confidence(another=_all_but_itself),
                "A pose within 0.5 m and 10 degrees of the best is the same answer, and no rival of it.",
            ),
            Mistake(
                _mistaken_confidence(
                    another=lambda poses, best: np.linalg.norm(poses[:, :2] - best[:2], axis=1) > SAME_PLACE
                ),
                "The same place the other way round is another answer: look at the heading, too.",
            ),
            Mistake(
                _mistaken_confidence(another=_without_wrap), "Headings of 3.12 and -3.13 differ by 0.03: wrap them."
            ),
            Mistake(
                _mistaken_confidence(temper=1.0), "The scores count half: e to the power of half their difference."
            ),
            Mistake(
                _mistaken_confidence(absolute=False),
                "`nothing` is a rival, too: a pose ahead of all others may still explain too little.",
            ),
            Mistake(
                _mistaken_confidence(rivals=lambda weights: weights.sum()),
                "You add up all rivals; among them are copies of one answer. Only the best of them counts.",
            ),
            Mistake(_mistaken_confidence(rivals=lambda weights: 0.0), "The runner-up is missing."),
            Mistake(_mistaken_confidence(none=1.0), "Without any pose there is nothing to be sure of: 0."),
            Mistake(
                _overflowing,
                "exp(3000) is infinite, and inf / inf is NaN. Only differences to the best score need an exponential.",
            ),
            Mistake(
                lambda *given: 1 - _sure(*given),
                "That is the doubt. Asked is the confidence.",
            ),
            Mistake(
                _mistaken_confidence(another=_elsewhere_and_turned),
                "Another answer is more than 0.5 m away *or* turned by more than 10 degrees; yours asks for both.",
            ),
            Mistake(
                _one_rival,
                "The runner-up and `nothing` both doubt the best: their exponentials add. You take the greater one.",
            ),
        ),
    ),
]
