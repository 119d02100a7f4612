"""Stages of project P2: a box's angles, which box is which, places, the penalty, the repeated minimum, the pose."""

import numpy as np
from scipy.optimize import linear_sum_assignment

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.pose.rigid_fit import rotation_2d as rotation
from courseware.lessons.kit.exercise import Exercise

CLASSES = ["sofa", "chair", "table", "television"]


def angles_of(box, width):
    """(azimuth, elevation) of a box's centre, radians; box (4,) pixels."""
    u, v = (box[0] + box[2]) / 2, (box[1] + box[3]) / 2
    return wrap_angle((0.5 - u / width) * 2 * np.pi), (0.5 - v / (width / 2)) * np.pi


def a_box(rng: np.random.Generator) -> tuple:
    width = int(rng.choice([640, 1280, 2048]))
    u, v = rng.uniform(0, width), rng.uniform(0.45, 0.75) * width / 2
    size = rng.uniform(0.02, 0.2, 2) * width / 2
    return np.array([u, v, u + size[0], v + size[1]]), width


def pair_boxes(upper_labels, upper_angles, lower_labels, lower_angles, largest_gap):
    """Index (n,) of the lower box of every upper box; -1: none."""
    gap = np.abs(wrap_angle(upper_angles[:, None, 0] - lower_angles[None, :, 0]))
    same = np.asarray(upper_labels)[:, None] == np.asarray(lower_labels)[None]
    gap[~same | (lower_angles[None, :, 1] <= upper_angles[:, None, 1]) | (gap > largest_gap)] = np.inf
    partner = np.full(len(upper_labels), -1)
    while gap.size and np.isfinite(gap.min()):
        i, j = np.unravel_index(gap.argmin(), gap.shape)
        partner[i] = j
        gap[i], gap[:, j] = np.inf, np.inf
    return partner


def least_total(cost, limit):
    """A mistake: the column of each row that makes the total of a table least; -1 if the cost reaches the limit."""
    column = np.full(len(cost), -1)
    for i, j in zip(*linear_sum_assignment(np.minimum(cost, 1e3)), strict=True):
        column[i] = j if cost[i, j] < limit else -1
    return column


def two_images(rng: np.random.Generator) -> tuple:
    """Objects of three classes, each seen from both cameras or from one; four are nearly in line, three of a kind."""
    k, (one, other) = int(rng.integers(6, 11)), rng.permutation(CLASSES[:3])[:2]
    label, azimuth = rng.choice(CLASSES[:3], k), rng.uniform(-np.pi, np.pi, k)
    label[:3], label[4:6], azimuth[1:5] = one, other, [0.03, 0.06, 0, -0.02] + azimuth[0]
    azimuth[3] = np.pi - 0.01  # at the seam
    rho, z, noise = rng.uniform(1.0, 5.0, k), rng.uniform(-1.2, -0.4, k), rng.normal(0, 0.02, (2, k))
    noise[:, 3] = 0, 0.03
    upper = np.column_stack([wrap_angle(azimuth + noise[0]), np.arctan2(z, rho)])
    lower = np.column_stack([wrap_angle(azimuth + noise[1]), np.arctan2(z + 0.3, rho)])
    # The upper camera does not see object 5, the lower one not object 4, nor either one all of the others.
    seen = [rng.permutation([i for i in range(k) if i < 4 or (i != u and rng.random() < 0.8)]) for u in (5, 4)]
    return label[seen[0]], upper[seen[0]], label[seen[1]], lower[seen[1]], 0.1


def places_of(upper_angles, lower_angles, baseline):
    """Places (n, 2) in metres, body frame; NaN where the rays tell none."""
    slope = np.tan(lower_angles[:, 1]) - np.tan(upper_angles[:, 1])
    rho = np.full(len(slope), np.nan)
    there = lower_angles[:, 1] - upper_angles[:, 1] > 1e-3
    rho[there] = baseline / slope[there]
    return rho[:, None] * np.column_stack([np.cos(upper_angles[:, 0]), np.sin(upper_angles[:, 0])])


def angle_pairs(rng: np.random.Generator) -> tuple:
    """Objects below, level with and above the cameras; one pair diverges, one is parallel."""
    n = int(rng.integers(5, 9))
    baseline, rho, z = rng.uniform(0.15, 0.6), rng.uniform(0.8, 6.0, n), rng.uniform(-1.3, 0.4, n)
    azimuth = rng.uniform(-np.pi, np.pi, n)
    upper = np.column_stack([azimuth, np.arctan2(z, rho)])
    lower = np.column_stack([wrap_angle(azimuth + rng.normal(0, 0.03, n)), np.arctan2(z + baseline, rho)])
    lower[:2, 1] = upper[:2, 1] + [-rng.uniform(0.01, 0.1), 5e-4]
    return upper, lower, baseline


def penalties(labels, places, hues, saturations, map_labels, map_places, map_hues, map_saturations):
    """Eq. (1) as a table (n, m); labels (n,), places (n, 2), hues and saturations (n,), and the map's (m, ...)."""
    d_hue = np.abs(hues[:, None] - map_hues)
    d_hue = np.nan_to_num(np.minimum(d_hue, 360 - d_hue))
    d_saturation = np.abs(saturations[:, None] - map_saturations)
    seen, mapped = places - places.mean(axis=0), map_places - map_places.mean(axis=0)
    far_c, far_m = np.linalg.norm(seen, axis=1), np.linalg.norm(mapped, axis=1)
    d_far = np.abs(far_c[:, None] - far_m) / np.maximum(far_m, 0.1)
    unlike = np.asarray(labels)[:, None] != np.asarray(map_labels)
    return 100 * unlike + d_hue / 360 + d_saturation / 100 + d_far


def observed_and_mapped(rng: np.random.Generator, central: bool = False) -> tuple:
    """Some of a map's objects seen from a pose, some grey, hues across the wrap. central: one stands in the middle."""
    m = int(rng.integers(6, 11))
    map_labels, map_places = rng.choice(CLASSES, m), rng.uniform(0, 6, (m, 2))
    if central:
        map_places[-1] = map_places[:-1].mean(axis=0) + 0.01
    map_hues, map_saturations = rng.uniform(0, 360, m), rng.uniform(5, 90, m)
    map_hues[:2] = np.nan, 355.0
    seen = np.concatenate([[0, 1], 2 + rng.permutation(m - 2)[: int(rng.integers(1, m - 3))]])
    places = (map_places[seen] - rng.uniform(1, 5, 2)) @ rotation(rng.uniform(-np.pi, np.pi))
    hues = (map_hues[seen] + rng.normal(0, 15, len(seen))) % 360
    hues[[0, 1, -1]] = 40.0, 12.0, rng.choice([np.nan, hues[-1]])
    saturations = np.clip(map_saturations[seen] + rng.normal(0, 10, len(seen)), 0, 100)
    places = places + rng.normal(0, 0.1, places.shape)
    return map_labels[seen], places, hues, saturations, map_labels, map_places, map_hues, map_saturations


def associate(cost):
    """Landmark (n,) of every row of cost (n, m), by the repeated minimum; -1: none, or of another class."""
    cost, column = np.array(cost, dtype=float), np.full(len(cost), -1)
    for _ in range(min(cost.shape)):
        i, j = np.unravel_index(cost.argmin(), cost.shape)
        if cost[i, j] < 100:
            column[i] = j
        cost[i], cost[:, j] = np.inf, np.inf
    return column


def penalty_tables(rng: np.random.Generator) -> tuple:
    """Tables with competition; more rows than columns at times, and rows of classes that the map has used up."""
    n, m = int(rng.integers(4, 8)), int(rng.integers(4, 9))
    labels, map_labels = rng.integers(0, 3, n), rng.integers(0, 3, m)
    cost = rng.uniform(0, 1, (n, 1)) + rng.uniform(0, 1, (1, m)) + rng.uniform(0, 1, (n, m))
    return (cost + 100.0 * (labels[:, None] != map_labels[None]),)


def fit_pose(places, landmarks):
    """(x, y, theta) of the body on the map; places, landmarks (n, 2) metres; NaN where there is none."""
    if len(places) < 2 or min(np.ptp(places, axis=0).max(), np.ptp(landmarks, axis=0).max()) < 1e-3:
        return np.nan, np.nan, np.nan
    a, b = places - places.mean(axis=0), landmarks - landmarks.mean(axis=0)
    sine, cosine = np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]), np.sum(a * b)
    theta = np.arctan2(sine, cosine)
    x, y = landmarks.mean(axis=0) - rotation(theta) @ places.mean(axis=0)
    return x, y, theta


def without_sign(a, b):
    """A mistake: U V^T of the singular values, which may be a mirror."""
    u, _, vt = np.linalg.svd(b.T @ a)
    return u @ vt


def some_pairs(rng: np.random.Generator, n: int = 0, theta: float = 0.0, mirror: int = 1) -> tuple:
    """Matched places and landmarks. n, theta: drawn if they are 0."""
    n, theta = n or int(rng.integers(2, 9)), theta or rng.uniform(-np.pi, np.pi)
    places = rng.uniform(-4, 4, (n, 2))
    return places, places * [1, mirror] @ rotation(theta).T + rng.uniform(1, 5, 2) + rng.normal(0, 0.1, (n, 2))


# fmt: off
EXERCISES = [
    Exercise("P2.1", angles_of, a_box, "warm-up", cases={
        "a box across the seam": lambda rng: (np.array([636, 200, rng.uniform(660, 700), 220]), 640),
    }),
    Exercise("P2.2", pair_boxes, two_images, cases={
        "nothing seen below": lambda rng: (*two_images(rng)[:2], np.array([], dtype=str), np.zeros((0, 2)), 0.1),
    }),
    Exercise("P2.3", places_of, angle_pairs, cases={
        "no pairs": lambda rng: (np.zeros((0, 2)), np.zeros((0, 2)), 0.3),
    }),
    Exercise("P2.4", penalties, observed_and_mapped, cases={
        "a landmark at the centroid": lambda rng: observed_and_mapped(rng, central=True),
    }),
    Exercise("P2.5", associate, penalty_tables, cases={
        "more seen than mapped": lambda rng: (rng.uniform(0, 2, (6, 3)),),
    }, example=(([[1, 2], [0.5, 103]],), [1, 0])),
    Exercise("P2.6", fit_pose, some_pairs, "challenge", cases={
        "turned by half": lambda rng: some_pairs(rng, 5, 3.1),
        "a mirror image": lambda rng: some_pairs(rng, 5, 0.1, mirror=-1),
        "one pair": lambda rng: some_pairs(rng, 1),
        "nothing": lambda rng: (np.zeros((0, 2)), np.zeros((0, 2))),
        "one place twice": lambda rng: (np.full((2, 2), 1.5), rng.uniform(0, 6, (2, 2))),
        "one landmark twice": lambda rng: (rng.uniform(-4, 4, (2, 2)), np.full((2, 2), 2.5)),
    }, example=(([[1, 0], [3, 0]], [[2, 1], [2, 3]]), (2, 0, 1.571))),
]
