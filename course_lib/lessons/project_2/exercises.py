"""Stages of project P2: a box's angles, which box is which, places, the penalty, the repeated minimum, the pose."""

import numpy as np
from scipy.optimize import linear_sum_assignment

from course_lib.geometry import wrap_angle
from course_lib.lessons.kit.exercises import Exercise
from course_lib.spherical_stereo.pose.rigid_fit import RigidFitError, fit_rigid_2d


def rotation(theta):
    return np.array([[np.cos(theta), -np.sin(theta)], [np.sin(theta), np.cos(theta)]])


# P2.1: azimuth and elevation of a box's centre


def angles_of(box, width):
    """(azimuth, elevation) of a box's centre, radians; box (4,) pixels."""
    u, v = (box[0] + box[2]) / 2, (box[1] + box[3]) / 2
    return wrap_angle((0.5 - u / width) * 2 * np.pi), (0.5 - v / (width / 2)) * np.pi


def a_box(rng: np.random.Generator) -> tuple:
    width = int(rng.choice([640, 1280, 2048]))
    u, v = rng.uniform(0, width), rng.uniform(0.45, 0.75) * width / 2
    size = rng.uniform(0.02, 0.2, 2) * width / 2
    return np.array([u, v, u + size[0], v + size[1]]), width


def a_box_across_the_seam(rng: np.random.Generator) -> tuple:
    width = int(rng.choice([640, 1280]))
    return np.array([width - rng.uniform(2, 10), 0.3 * width, width + rng.uniform(20, 60), 0.35 * width]), width


# P2.2: which box is which


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


def allowed_gaps(upper_labels, upper, lower_labels, lower, largest):
    gaps = np.abs(wrap_angle(upper[:, None, 0] - lower[None, :, 0]))
    allowed = (upper_labels[:, None] == lower_labels[None]) & (lower[None, :, 1] > upper[:, None, 1])
    return np.where(allowed & (gaps <= largest), gaps, np.inf)


def each_its_best(*given):
    gaps = allowed_gaps(*given)
    if not gaps.shape[1]:
        return np.full(len(gaps), -1)
    return np.where(np.isfinite(gaps).any(axis=1), gaps.argmin(axis=1), -1)


def in_their_order(*given):
    gaps = allowed_gaps(*given)
    partner = np.full(len(gaps), -1)
    for i in range(len(gaps)):
        if np.isfinite(gaps[i]).any():
            partner[i] = gaps[i].argmin()
            gaps[:, partner[i]] = np.inf
    return partner


def least_total(*given):
    gaps = allowed_gaps(*given)
    partner = np.full(len(gaps), -1)
    for i, j in zip(*linear_sum_assignment(np.minimum(gaps, 10.0)), strict=True):
        partner[i] = j if np.isfinite(gaps[i, j]) else -1
    return partner


def each_others_best(*given):
    gaps, best = allowed_gaps(*given), each_its_best(*given)
    return np.array([j if j >= 0 and gaps[:, j].argmin() == i else -1 for i, j in enumerate(best)], dtype=int)


def two_images(rng: np.random.Generator) -> tuple:
    """Objects of three classes seen from both cameras, some by one alone; look-alikes close in azimuth."""
    while True:
        k = int(rng.integers(6, 11))
        label, azimuth = rng.choice(["sofa", "chair", "table"], k), rng.uniform(-np.pi, np.pi, k)
        azimuth[1], label[1] = azimuth[0] + rng.uniform(0.03, 0.06), label[0]  # two of a kind, nearly in line
        azimuth[2] = np.pi - 0.01  # at the seam
        rho, z = rng.uniform(1.0, 5.0, k), rng.uniform(-1.2, -0.4, k)
        upper = np.column_stack([wrap_angle(azimuth + rng.normal(0, 0.02, k)), np.arctan2(z, rho)])
        lower = np.column_stack([wrap_angle(azimuth + rng.normal(0, 0.02, k)), np.arctan2(z + 0.3, rho)])
        lower[2, 0] = wrap_angle(np.pi + 0.02)
        seen = [np.sort(rng.permutation(k)[: k - int(rng.integers(0, 3))]) for _ in range(2)]
        seen = [rng.permutation(np.union1d(one, [0, 1, 2])) for one in seen]
        given = label[seen[0]], upper[seen[0]], label[seen[1]], lower[seen[1]], 0.1
        others = each_its_best(*given), in_their_order(*given)
        if not any(np.array_equal(pair_boxes(*given), other) for other in others) or rng.random() < 0.2:
            return given


def nothing_seen_below(rng: np.random.Generator) -> tuple:
    labels, upper, _, _, largest = two_images(rng)
    return labels, upper, labels[:0], upper[:0], largest


# P2.3: places in the plane


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
    lower[0, 1] = upper[0, 1] - rng.uniform(0.01, 0.1)
    lower[1, 1] = upper[1, 1] + 5e-4
    return upper, lower, baseline


def no_pairs(rng: np.random.Generator) -> tuple:
    return np.zeros((0, 2)), np.zeros((0, 2)), 0.3


# P2.4: the penalty of eq. (1)


def penalties(labels, places, hues, saturations, map_labels, map_places, map_hues, map_saturations):
    """Eq. (1) as a table (n, m); labels (n,), places (n, 2), hues and saturations (n,), and the map's (m, ...)."""
    d_hue = np.abs(hues[:, None] - map_hues)
    d_hue = np.nan_to_num(np.minimum(d_hue, 360 - d_hue))
    d_saturation = np.abs(saturations[:, None] - map_saturations)
    far_c = np.linalg.norm(places - places.mean(axis=0), axis=1)
    far_m = np.linalg.norm(map_places - map_places.mean(axis=0), axis=1)
    d_far = np.abs(far_c[:, None] - far_m) / np.maximum(far_m, 0.1)
    unlike = np.asarray(labels)[:, None] != np.asarray(map_labels)
    return 100 * unlike + d_hue / 360 + d_saturation / 100 + d_far


def vectors_apart(places, map_places):
    seen, mapped = places - places.mean(axis=0), map_places - map_places.mean(axis=0)
    return np.linalg.norm(seen[:, None] - mapped[None], axis=2)


def observed_and_mapped(rng: np.random.Generator) -> tuple:
    """Observations of some of a map's objects, from some pose; grey ones, hues across the wrap."""
    m = int(rng.integers(6, 11))
    map_labels, map_places = rng.choice(["sofa", "chair", "table", "television"], m), rng.uniform(0, 6, (m, 2))
    map_hues, map_saturations = rng.uniform(0, 360, m), rng.uniform(5, 90, m)
    map_hues[:2] = np.nan, 355.0
    seen = np.concatenate([[0, 1], 2 + rng.permutation(m - 2)[: int(rng.integers(1, m - 3))]])
    places = (map_places[seen] - rng.uniform(1, 5, 2)) @ rotation(rng.uniform(-np.pi, np.pi))
    hues = (map_hues[seen] + rng.normal(0, 15, len(seen))) % 360
    hues[:2] = 40.0, 12.0
    hues[-1] = np.nan if rng.random() < 0.5 else hues[-1]
    saturations = np.clip(map_saturations[seen] + rng.normal(0, 10, len(seen)), 0, 100)
    places = places + rng.normal(0, 0.1, places.shape)
    return map_labels[seen], places, hues, saturations, map_labels, map_places, map_hues, map_saturations


def a_landmark_at_the_centroid(rng: np.random.Generator) -> tuple:
    given = observed_and_mapped(rng)
    given[5][-1] = given[5][:-1].mean(axis=0) + 0.01
    return given


# P2.5: the repeated minimum


def associate(cost):
    """Landmark (n,) of every row of cost (n, m), by the repeated minimum; -1: none, or of another class."""
    cost, column = np.array(cost, dtype=float), np.full(len(cost), -1)
    for _ in range(min(cost.shape)):
        i, j = np.unravel_index(cost.argmin(), cost.shape)
        if cost[i, j] < 100:
            column[i] = j
        cost[i], cost[:, j] = np.inf, np.inf
    return column


def row_by_row(cost):
    cost, column = np.array(cost, dtype=float), np.full(len(cost), -1)
    for i in range(len(cost)):
        j = int(cost[i].argmin())
        column[i] = j if cost[i, j] < 100 else -1
        cost[:, j] = np.inf
    return column


def best_total(cost):
    column = np.full(len(cost), -1)
    for i, j in zip(*linear_sum_assignment(cost), strict=True):
        column[i] = j if cost[i, j] < 100 else -1
    return column


def struck_out_on_one_side(cost, rows):
    cost, column = np.array(cost, dtype=float), np.full(len(cost), -1)
    for _ in range(min(cost.shape)):
        i, j = np.unravel_index(cost.argmin(), cost.shape)
        if np.isinf(cost[i, j]):
            break
        column[i] = j if cost[i, j] < 100 else -1
        if rows:
            cost[i] = np.inf
        else:
            cost[:, j] = np.inf
    return column


def penalty_tables(rng: np.random.Generator) -> tuple:
    """Tables with competition; more rows than columns at times, and rows of classes that the map has used up."""
    while True:
        n, m = int(rng.integers(4, 8)), int(rng.integers(4, 9))
        labels, map_labels = rng.integers(0, 3, n), rng.integers(0, 3, m)
        cost = rng.uniform(0, 1, (n, 1)) + rng.uniform(0, 1, (1, m)) + rng.uniform(0, 1, (n, m))
        cost = cost + 100.0 * (labels[:, None] != map_labels[None])
        others = cost.argmin(axis=1), row_by_row(cost), best_total(cost), associate(cost / 1000)
        if not any(np.array_equal(associate(cost), np.where(cost.min(axis=1) < 100, one, -1)) for one in others):
            return (cost,)


def more_seen_than_mapped(rng: np.random.Generator) -> tuple:
    return (rng.uniform(0, 2, (6, 3)),)


# P2.6: the pose


def fit_pose(places, landmarks):
    """(x, y, theta) of the body on the map; places, landmarks (n, 2) metres; NaN where there is none."""
    if len(places) < 2 or min(np.ptp(places, axis=0).max(), np.ptp(landmarks, axis=0).max()) < 1e-3:
        return np.nan, np.nan, np.nan
    a, b = places - places.mean(axis=0), landmarks - landmarks.mean(axis=0)
    theta = np.arctan2(np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]), np.sum(a * b))
    x, y = landmarks.mean(axis=0) - rotation(theta) @ places.mean(axis=0)
    return x, y, theta


def svd_without_sign(places, landmarks):
    if np.isnan(fit_pose(places, landmarks)[0]):
        return np.nan, np.nan, np.nan
    a, b = places - places.mean(axis=0), landmarks - landmarks.mean(axis=0)
    u, _, vt = np.linalg.svd(b.T @ a)
    return *(landmarks.mean(axis=0) - u @ vt @ places.mean(axis=0)), np.arctan2((u @ vt)[1, 0], (u @ vt)[0, 0])


def refusing_mirrors(places, landmarks):
    try:
        return tuple(fit_rigid_2d(places, landmarks))
    except RigidFitError:
        return np.nan, np.nan, np.nan


def mean_of_turns(a, b):
    turns = np.arctan2(b[:, 1], b[:, 0]) - np.arctan2(a[:, 1], a[:, 0])
    return np.arctan2(np.sin(turns).mean(), np.cos(turns).mean())


def some_pairs(rng: np.random.Generator) -> tuple:
    n = int(rng.integers(2, 9))
    places = rng.uniform(-4, 4, (n, 2))
    landmarks = places @ rotation(rng.uniform(-np.pi, np.pi)).T + rng.uniform(1, 5, 2) + rng.normal(0, 0.1, (n, 2))
    return places, landmarks


def turned_by_half(rng: np.random.Generator) -> tuple:
    places, _ = some_pairs(rng)
    return places, places @ rotation(3.1).T + 1


def a_mirror_image(rng: np.random.Generator) -> tuple:
    """Wrong pairs: a reflection would fit better, and is no pose."""
    places = rng.uniform(-4, 4, (5, 2))
    return places, places * np.array([1, -1]) + rng.normal(0, 0.1, (5, 2)) + 3


def one_pair(rng: np.random.Generator) -> tuple:
    return rng.uniform(-4, 4, (1, 2)), rng.uniform(0, 6, (1, 2))


def nothing(rng: np.random.Generator) -> tuple:
    return np.zeros((0, 2)), np.zeros((0, 2))


def one_place_twice(rng: np.random.Generator) -> tuple:
    return np.tile(rng.uniform(-4, 4, 2), (2, 1)), rng.uniform(0, 6, (2, 2))


def one_landmark_twice(rng: np.random.Generator) -> tuple:
    return rng.uniform(-4, 4, (2, 2)), np.tile(rng.uniform(0, 6, 2), (2, 1))


# fmt: off
EXERCISES = [
    Exercise("P2.1", angles_of, a_box, "warm-up", cases=[a_box_across_the_seam], mistakes="""
        wrap_angle((0.5 - u / width) * 2 * np.pi) => (0.5 - u / width) * 2 * np.pi
        Right but for whole turns: a box across the seam has its azimuth below -pi. Bring it into [-pi, pi).
        wrap_angle((0.5 - u / width) * 2 * np.pi) => (0.5 - u / width) * 2 * np.pi % (2 * np.pi)
        Your azimuth runs from 0 to 2 pi; asked is -pi to pi.
        0.5 - u / width => u / width - 0.5
        Columns run to the right as azimuth *decreases*: left of the centre is positive.
        0.5 - v / (width / 2) => v / (width / 2) - 0.5
        Row 0 is straight up: elevation grows as v falls.
        v / (width / 2) => v / width
        Your elevation divides by the width. A panorama is half as high as wide.
        * 2 * np.pi => * np.pi
        A whole turn, 2 pi, lies across the width; pi lies across the height.
        (box[0] + box[2]) / 2, (box[1] + box[3]) / 2 => box[0], box[1]
        That is the box's upper left corner. Its centre is asked for.
        (box[0] + box[2]) / 2, (box[1] + box[3]) / 2 => (box[2] - box[0]) / 2, (box[3] - box[1]) / 2
        That is half the box's size. The centre is the *mean* of opposite edges.
        u, v = (box[0] + box[2]) / 2 => u, v = (box[0] + (box[2] - width if box[2] > width else box[2])) / 2
        You move the right edge back before the mean, and the centre lands across the image. Mean first.
        ... => return angles_of(box + 0.5, width)
        ... => return angles_of(box - 0.5, width)
        Half a pixel off: boxes are in edge coordinates, where the middle is at width / 2.
        (0.5 - v / (width / 2)) * np.pi => v / (width / 2) * np.pi
        That is the angle from straight up. Elevation is 0 at the horizon.
        0.5 - u / width => 0 - u / width
        Azimuth 0 is the image's middle, not its left edge.
    """),
    Exercise("P2.2", pair_boxes, two_images, cases=[nothing_seen_below], mistakes="""
        wrap_angle( => (
        Azimuths of 3.13 and -3.13 are 0.02 apart, not 6.26: the gap goes around the circle.
        np.abs(wrap => (wrap
        Your gap has a sign, and the most negative one is taken for the least.
        ~same | =>
        You pair boxes of unlike classes.
        (lower_angles[None, :, 1] <= upper_angles[:, None, 1]) | =>
        The lower camera sees every object *higher* than the upper one does, e_l > e_u. You do not ask it.
        lower_angles[None, :, 1] <= => lower_angles[None, :, 1] >=
        You ask for e_l < e_u. From below, an object is seen higher: draw the rig from the side.
        ... => return least_total(upper_labels, upper_angles, lower_labels, lower_angles, largest_gap)
        That makes the *total* gap least. Asked is the least gap first, and no way back.
        | (gap > largest_gap) =>
        You pair boxes however far apart: largest_gap is not used.
        ... => return each_its_best(upper_labels, upper_angles, lower_labels, lower_angles, largest_gap)
        Two upper boxes may take one lower box in yours: it must be one-to-one.
        ... => return in_their_order(upper_labels, upper_angles, lower_labels, lower_angles, largest_gap)
        Yours depends on the order of the boxes: the least gap of the whole table comes first.
        ... => return each_others_best(upper_labels, upper_angles, lower_labels, lower_angles, largest_gap)
        You pair those only that are each other's best. Strike both out and look again: seconds may remain.
        np.full(len(upper_labels), -1) => np.zeros(len(upper_labels), int)
        A box without a partner gets -1, not 0: box 0 is a box.
    """),
    Exercise("P2.3", places_of, angle_pairs, cases=[no_pairs], mistakes="""
        there = lower_angles[:, 1] - upper_angles[:, 1] > 1e-3 => there = slope != 0
        Where the rays diverge or run parallel (e_l - e_u <= 0.001) there is no place: NaN.
        return rho[:, None] => return np.nan_to_num(rho)[:, None]
        You put what has no place at the origin, inside the rig. No place is NaN, not 0.
        > 1e-3 => > 0
        Rays that are parallel to a thousandth tell no place either: e_l - e_u <= 0.001 is NaN, too.
        baseline / slope => -baseline / slope
        Your ranges are negative: the lower camera sees the object higher, so tan e_l is the greater one.
        baseline / slope[there] => (baseline * np.cos(lower_angles) / np.sin(lower_angles - upper_angles))[there, 1]
        That is d, along the ray. On the floor it is rho = d cos e_u.
        np.tan(lower_angles[:, 1]) - np.tan(upper_angles[:, 1]) => np.tan(lower_angles - upper_angles)[:, 1]
        tan(e_l - e_u) is not tan e_l - tan e_u.
        np.tan(lower_angles[:, 1]) - np.tan(upper_angles[:, 1]) => lower_angles[:, 1] - upper_angles[:, 1]
        You divide by the difference of the angles. Draw the right triangle: heights are rho tan e.
        np.cos(upper_angles[:, 0]), np.sin(upper_angles => np.cos(lower_angles[:, 0]), np.sin(lower_angles
        Take the azimuth of the upper camera: the body frame is its own.
        np.sin(upper => -np.sin(upper
        y is to the left, where azimuths are positive: yours is mirrored.
        np.cos(upper_angles[:, 0]), np.sin(upper_angles => np.sin(upper_angles[:, 0]), np.cos(upper_angles
        x is forward, where the azimuth is 0: cos for x, sin for y.
        there = lower_angles[:, 1] - upper_angles[:, 1] > 1e-3 => slope = np.abs(slope); there = slope != 0
        Where the rays diverge there is no place: an absolute value makes one up.
    """),
    Exercise("P2.4", penalties, observed_and_mapped, cases=[a_landmark_at_the_centroid], mistakes="""
        np.minimum(d_hue, 360 - d_hue) => d_hue
        Hues of 355 and 12 degrees are 17 apart: the difference goes around the circle.
        d_hue / 360 => d_hue / 180
        Eq. (1) divides the hue's difference by 360, though none is above 180.
        np.nan_to_num(np.minimum(d_hue, 360 - d_hue)) => np.minimum(d_hue, 360 - d_hue)
        A grey object has no hue (NaN): its hue term is 0.
        np.abs(hues[:, None] - map_hues) => np.abs(np.nan_to_num(hues)[:, None] - np.nan_to_num(map_hues))
        You turn grey into hue 0, which is red. First the difference, then 0 where it is NaN.
        d_saturation / 100 => d_saturation
        The saturation's difference is in percent: divide by 100.
        np.abs(far_c[:, None] - far_m) => (far_c[:, None] - far_m)
        As printed, eq. (1) rewards what looks too near. Take the absolute value of the distance term.
        np.maximum(far_m, 0.1) => far_m
        A landmark at the map's centroid divides by nearly nothing: the divisor is at least 0.1 m.
        np.maximum(far_m, 0.1) => np.maximum(far_c[:, None], 0.1)
        You divide by the observed distance. Eq. (1) divides by that of the map.
        / np.maximum(far_m, 0.1) =>
        The distance term is relative: divide by the landmark's distance to the map's centroid.
        - places.mean(axis=0) => and also - map_places.mean(axis=0) =>
        Distances are to the *centroid* of their own side: without a pose nothing else is in both frames.
        places - places.mean(axis=0) => places - map_places.mean(axis=0)
        Each side has a centroid of its own, in its own frame.
        100 * unlike + =>
        100 * unlike => 1 * unlike
        Unlike classes cost p_obj = 100, above all that the others can add up to.
        np.abs(far_c[:, None] - far_m) => vectors_apart(places, map_places)
        Places of two frames are turned by the unknown heading. Compare distances from the centroids.
        np.maximum(far_m, 0.1) => (far_m + 0.1)
        The divisor is the greater of |dx_m| and 0.1 m, not their sum.
    """),
    Exercise("P2.5", associate, penalty_tables, cases=[more_seen_than_mapped], mistakes="""
        < 100 => < np.inf
        The rounds go on and join a chair to a plant at the end. Such a pair (100 or more) is not used: -1.
        ... => return np.where(cost.min(axis=1) < 100, cost.argmin(axis=1), -1)
        Two observations may take one landmark in yours: strike both out.
        ... => return row_by_row(cost)
        Yours goes row by row. The least of the whole table comes first.
        ... => return best_total(cost)
        That is the assignment of least total. The paper's search takes the least pair and never goes back.
        ... => return struck_out_on_one_side(cost, rows=True)
        A landmark that is taken stays open in yours: strike out its column too.
        ... => return struck_out_on_one_side(cost, rows=False)
        An observation that is matched stays open in yours: strike out its row too.
        = np.inf, np.inf => = 0, 0
        You strike out with 0, which is the least of all from then on. Strike out with infinity.
        np.full(len(cost), -1) => np.zeros(len(cost), int)
        An observation without a landmark gets -1, not 0: landmark 0 is one.
    """),
    Exercise("P2.6", fit_pose, some_pairs, "challenge", cases=[
        turned_by_half, a_mirror_image, one_pair, nothing, one_place_twice, one_landmark_twice,
    ], mistakes="""
        or min(np.ptp(places, axis=0).max(), np.ptp(landmarks, axis=0).max()) < 1e-3 =>
        Right where there is a pose. Two pairs whose places (or landmarks) coincide tell no heading: NaN.
        len(places) < 2 or min(np.ptp(places, axis=0).max(), np.ptp(landmarks, axis=0).max()) < 1e-3 => len(places) == 0
        One pair tells where, not which way: fewer than two pairs give NaN, NaN, NaN.
        theta = np.arctan2 => theta = -np.arctan2
        Your rotation goes the wrong way: the cross product is a_x b_y - a_y b_x.
        a, b = places - places.mean(axis=0), landmarks - landmarks.mean(axis=0) => a, b = places, landmarks
        Subtract each side's centroid before you turn one on the other.
        - rotation(theta) @ places.mean(axis=0) => - places.mean(axis=0)
        The heading is right. Turn the places' centroid before you take it off the landmarks'.
        rotation(theta) => rotation(-theta)
        The heading is right. R is transposed: (1, 0) must go to (cos theta, sin theta).
        - rotation(theta) @ places.mean(axis=0) =>
        That is the landmarks' centroid. The rig stands at the body frame's origin.
        ... => return svd_without_sign(places, landmarks)
        U V^T may be a mirror, which no rig can turn into: mind the sign of the determinant.
        ... => return refusing_mirrors(places, landmarks)
        Pairs that look mirrored have a best turn, too. No pose: too few pairs, or coincident ones, only.
        ... => return fit_pose(places[:2], landmarks[:2])
        You use the first two pairs. Sum over all of them.
        ... => return fit_pose(landmarks, places)
        That takes the map to the body. Asked is the pose: from the body to the map.
        return x, y, theta => return x, y, theta % (2 * np.pi)
        return x, y, theta => return x, y, np.degrees(theta)
        The pose is right, but theta is asked in radians, from -pi to pi.
        return x, y, theta => return x, y, -theta
        Right but for the sign of theta: the pose turns the body onto the map.
        ... => return tuple(np.nan_to_num(fit_pose(places, landmarks)))
        Where there is no pose the answer is NaN three times: (0, 0, 0) is a place.
        np.arctan2(np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]), np.sum(a * b)) => mean_of_turns(a, b)
        You average the turns of single pairs. A far pair knows its direction better: let the sums weigh.
        rotation(theta) @ => np.linalg.norm(b) / np.linalg.norm(a) * rotation(theta) @
        Your fit may stretch: R alone turns, without a scale.
    """),
]
