"""Stages of project P2: a box's angles, which box is which, places, the penalty, the repeated minimum, the pose."""

import numpy as np
from scipy.optimize import linear_sum_assignment

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.pose.rigid_fit import rotation_2d as rotation
from courseware.lessons.kit.exercises import Exercise

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
    }, mistakes="""
        wrap_angle((0.5 - u / width) * 2 * np.pi) => (0.5 - u / width) * 2 * np.pi
        Right but for whole turns: a box across the seam has its azimuth below -pi. Bring it into [-pi, pi).
        wrap_angle((0.5 - u / width) * 2 * np.pi) => (0.5 - u / width) * 2 * np.pi % (2 * np.pi)
        Your azimuth runs from 0 to 2 pi. The task asks for -pi to pi.
        0.5 - u / width => u / width - 0.5
        Columns run to the right as azimuth *decreases*: left of the centre is positive.
        0.5 - v / (width / 2) => v / (width / 2) - 0.5
        Row 0 is straight up: elevation grows as v falls.
        v / (width / 2) => v / width
        Your elevation divides by the width. A panorama is half as high as wide.
        * 2 * np.pi => * np.pi
        A whole turn, 2 pi, lies across the width; pi lies across the height.
        (box[0] + box[2]) / 2, (box[1] + box[3]) / 2 => box[0], box[1]
        You take the box's upper left corner. The task asks for its centre.
        u, v = (box[0] + box[2]) / 2 => u, v = (box[0] + (box[2] - width if box[2] > width else box[2])) / 2
        You move the right edge back before the mean, so the centre lands across the image. Mean first.
        ... => return angles_of(box + 0.5, width)
        Half a pixel off: boxes are in edge coordinates, where the middle is at width / 2.
    """),
    Exercise("P2.2", pair_boxes, two_images, cases={
        "nothing seen below": lambda rng: (*two_images(rng)[:2], np.array([], dtype=str), np.zeros((0, 2)), 0.1),
    }, mistakes="""
        wrap_angle( => (
        Azimuths of 3.13 and -3.13 are 0.02 apart, not 6.26: the gap goes around the circle.
        ~same | =>
        You pair boxes of unlike classes.
        (lower_angles[None, :, 1] <= upper_angles[:, None, 1]) | =>
        lower_angles[None, :, 1] <= => lower_angles[None, :, 1] >=
        The lower camera sees every object *higher*, e_l > e_u: do you ask for it? Draw the rig from the side.
        partner = => return least_total(gap, np.inf); partner =
        You make the *total* gap least. The task takes the least gap first and never goes back.
        | (gap > largest_gap) =>
        You pair boxes however far apart: largest_gap is not used.
        gap[i], gap[:, j] = np.inf, np.inf => gap[i] = np.inf
        Two upper boxes may take one lower box in yours: it must be one-to-one.
        np.unravel_index(gap.argmin(), gap.shape) => (k := np.isfinite(gap).any(axis=1).argmax()), gap[k].argmin()
        Yours depends on the order of the boxes: the least gap of the whole table comes first.
        partner = => gap[(gap > gap.min(0, initial=9)) | (gap.T > gap.min(1, initial=9)).T] = np.inf; partner =
        You pair only boxes that are each other's best. Strike both out and look again: others may remain.
        np.full(len(upper_labels), -1) => np.zeros(len(upper_labels), int)
        A box without a partner gets -1, not 0: box 0 is a box.
    """),
    Exercise("P2.3", places_of, angle_pairs, cases={
        "no pairs": lambda rng: (np.zeros((0, 2)), np.zeros((0, 2)), 0.3),
    }, mistakes="""
        there = lower_angles[:, 1] - upper_angles[:, 1] > 1e-3 => there = slope != 0
        > 1e-3 => > 0
        Where the rays diverge or run parallel to a thousandth (e_l - e_u <= 0.001) there is no place: NaN.
        return rho[:, None] => return np.nan_to_num(rho)[:, None]
        You put objects without a place at the origin, inside the rig. No place is NaN, not 0.
        baseline / slope => -baseline / slope
        Your ranges are negative: the lower camera sees the object higher, so tan e_l is the greater one.
        baseline / slope[there] => (baseline * np.cos(lower_angles) / np.sin(lower_angles - upper_angles))[there, 1]
        Yours is d, along the ray. On the floor it is rho = d cos e_u.
        np.tan(lower_angles[:, 1]) - np.tan(upper_angles[:, 1]) => np.tan(lower_angles - upper_angles)[:, 1]
        tan(e_l - e_u) is not tan e_l - tan e_u.
        np.tan(lower_angles[:, 1]) - np.tan(upper_angles[:, 1]) => lower_angles[:, 1] - upper_angles[:, 1]
        You divide by the difference of the angles. Draw the right triangle: heights are rho tan e.
        np.cos(upper_angles[:, 0]), np.sin(upper_angles => np.cos(lower_angles[:, 0]), np.sin(lower_angles
        Take the azimuth of the upper camera: the body frame is its own.
        np.sin(upper => -np.sin(upper
        y is to the left, where azimuths are positive: yours is mirrored.
    """),
    Exercise("P2.4", penalties, observed_and_mapped, cases={
        "a landmark at the centroid": lambda rng: observed_and_mapped(rng, central=True),
    }, mistakes="""
        np.minimum(d_hue, 360 - d_hue) => d_hue
        Hues of 355 and 12 degrees are 17 apart: the difference goes around the circle.
        np.nan_to_num(np.minimum(d_hue, 360 - d_hue)) => np.minimum(d_hue, 360 - d_hue)
        A grey object has no hue (NaN): its hue term is 0.
        np.abs(hues[:, None] - map_hues) => np.abs(np.nan_to_num(hues)[:, None] - np.nan_to_num(map_hues))
        You turn grey into hue 0, which is red. First the difference, then 0 where it is NaN.
        d_saturation / 100 => d_saturation
        The saturation's difference is in percent: divide by 100.
        np.abs(far_c[:, None] - far_m) => (far_c[:, None] - far_m)
        As printed, eq. (1) rewards an object that looks too near. Take the absolute value of the distance term.
        np.maximum(far_m, 0.1) => far_m
        A landmark at the map's centroid divides by nearly nothing: the divisor is at least 0.1 m.
        - places.mean(axis=0) => and also - map_places.mean(axis=0) =>
        Distances are to the *centroid* of their own side: without a pose nothing else is in both frames.
        100 * unlike + =>
        100 * unlike => 1 * unlike
        Unlike classes cost p_obj = 100, more than the other terms together.
        np.abs(far_c[:, None] - far_m) => np.linalg.norm(seen[:, None] - mapped, axis=2)
        Places of two frames are turned by the unknown heading. Compare distances from the centroids.
    """),
    Exercise("P2.5", associate, penalty_tables, cases={
        "more seen than mapped": lambda rng: (rng.uniform(0, 2, (6, 3)),),
    }, mistakes="""
        < 100 => < np.inf
        Your last rounds join a chair to a plant. A pair that costs 100 or more is not used: -1.
        ... => return np.where(cost.min(axis=1) < 100, cost.argmin(axis=1), -1)
        cost[i], cost[:, j] = np.inf, np.inf => cost[i] = np.inf
        Two observations may take one landmark in yours: strike out its column, too.
        cost[i], cost[:, j] = np.inf, np.inf => cost[:, j] = np.inf
        An observation that is matched stays open in yours: strike out its row, too.
        np.unravel_index(cost.argmin(), cost.shape) => (k := np.isfinite(cost).any(axis=1).argmax()), cost[k].argmin()
        Yours goes row by row. The least of the whole table comes first.
        ... => return least_total(cost, 100)
        You find the assignment of least total. The paper takes the least pair and never goes back.
        = np.inf, np.inf => = 0, 0
        You strike out with 0, which is the least of all from then on. Strike out with infinity.
        np.full(len(cost), -1) => np.zeros(len(cost), int)
        An observation without a landmark gets -1, not 0: landmark 0 is one.
    """),
    Exercise("P2.6", fit_pose, some_pairs, "challenge", cases={
        "turned by half": lambda rng: some_pairs(rng, 5, 3.1),
        "a mirror image": lambda rng: some_pairs(rng, 5, 0.1, mirror=-1),
        "one pair": lambda rng: some_pairs(rng, 1),
        "nothing": lambda rng: (np.zeros((0, 2)), np.zeros((0, 2))),
        "one place twice": lambda rng: (np.full((2, 2), 1.5), rng.uniform(0, 6, (2, 2))),
        "one landmark twice": lambda rng: (rng.uniform(-4, 4, (2, 2)), np.full((2, 2), 2.5)),
    }, mistakes="""
        or min(np.ptp(places, axis=0).max(), np.ptp(landmarks, axis=0).max()) < 1e-3 =>
        Right where there is a pose. Two pairs whose places (or landmarks) coincide tell no heading: NaN.
        len(places) < 2 or min(np.ptp(places, axis=0).max(), np.ptp(landmarks, axis=0).max()) < 1e-3 => len(places) == 0
        One pair tells where, not which way: fewer than two pairs give NaN, NaN, NaN.
        a, b = places - places.mean(axis=0), landmarks - landmarks.mean(axis=0) => a, b = places, landmarks
        Subtract each side's centroid before you turn one on the other.
        - rotation(theta) @ places.mean(axis=0) => - places.mean(axis=0)
        The heading is right. Turn the places' centroid before you take it off the landmarks'.
        rotation(theta) => without_sign(a, b) and also arctan2(sine, cosine) => arctan2(*without_sign(a, b)[::-1, 0])
        U V^T may be a mirror, which no rig can turn into: mind the sign of the determinant.
        return x, y, theta => return x, y, theta % (2 * np.pi)
        The pose is right, but theta is asked in radians, from -pi to pi.
        ... => return tuple(np.nan_to_num(fit_pose(places, landmarks)))
        Where there is no pose the answer is NaN three times: (0, 0, 0) is a place.
        np.arctan2(sine, cosine) => np.angle(np.mean(np.exp(1j * (np.arctan2(*b.T[::-1]) - np.arctan2(*a.T[::-1])))))
        You average the turns of single pairs. A far pair knows its direction better: let the sums weigh.
        rotation(theta) @ => np.linalg.norm(b) / np.linalg.norm(a) * rotation(theta) @
        Your fit may stretch: R alone turns, without a scale.
    """),
]
