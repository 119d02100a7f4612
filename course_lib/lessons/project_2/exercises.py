"""Stages of project P2: a box's angles, which box is which, places, the penalty, the repeated minimum, the pose."""

from collections.abc import Callable

import numpy as np
from scipy.optimize import linear_sum_assignment

from course_lib.geometry import wrap_angle
from course_lib.lessons.kit.exercises import Exercise, Mistake
from course_lib.spherical_stereo.pose.rigid_fit import RigidFitError, fit_rigid_2d

# P2.1: azimuth and elevation of a box's centre


def angles_of(box: np.ndarray, width: int) -> tuple[float, float]:
    """(azimuth in [-pi, pi), elevation) of the centre of a box (4,) on a panorama width x width / 2; radians."""
    return _angles(box, width)


def _wrapped(azimuth: float) -> float:
    return float(wrap_angle(azimuth))


def _centre(box: np.ndarray) -> np.ndarray:
    return (box[:2] + box[2:]) / 2


def _angles(
    box: np.ndarray,
    width: int,
    centre: Callable = _centre,
    wrap: Callable = _wrapped,
    left: float = 1.0,
    up: float = 1.0,
    height_share: float = 0.5,
    turn: float = 2 * np.pi,
    corner: float = 0.0,
):
    """The angles, and with other parts their mistakes."""
    u, v = centre(box)
    azimuth = left * (0.5 - (u + corner) / width) * turn
    elevation = up * (0.5 - (v + corner) / (height_share * width)) * np.pi
    return wrap(azimuth), elevation


def _mistaken_angles(**parts) -> Callable:
    return lambda box, width: _angles(box, width, **parts)


def _edge_moved_back(box: np.ndarray, width: int):
    right = box[2] - width if box[2] > width else box[2]
    return _angles(np.array([box[0], box[1], right, box[3]]), width)


def _box(rng: np.random.Generator) -> tuple:
    width = int(rng.choice([640, 1280, 2048]))
    u, v = rng.uniform(0, width), rng.uniform(0.45, 0.75) * width / 2
    size = rng.uniform(0.02, 0.2, 2) * width / 2
    return np.array([u, v, u + size[0], v + size[1]]), width


def _box_across_the_seam(rng: np.random.Generator) -> tuple:
    width = int(rng.choice([640, 1280]))
    return np.array([width - rng.uniform(2, 10), 0.3 * width, width + rng.uniform(20, 60), 0.35 * width]), width


# P2.2: which box is which


def pair_boxes(upper_labels, upper_angles, lower_labels, lower_angles, largest_gap) -> np.ndarray:
    """For every upper box its lower one (n,), -1: none; like classes, seen higher from below, least azimuth gaps first.

    upper_angles (n, 2), lower_angles (m, 2): azimuth, elevation, radians. One-to-one; no gap above largest_gap.
    """
    return _paired(_gaps(upper_labels, upper_angles, lower_labels, lower_angles, largest_gap))


def _circle_gap(a, b):
    return np.abs(wrap_angle(a - b))


def _gaps(upper_labels, upper, lower_labels, lower, largest, gap=_circle_gap, classes=True, higher=1, limit=True):
    """Azimuth gaps (n, m), inf where two boxes cannot show one object."""
    gaps = gap(upper[:, None, 0], lower[None, :, 0])
    allowed = np.ones(gaps.shape, dtype=bool)
    if classes:
        allowed &= upper_labels[:, None] == lower_labels[None]
    if higher:
        allowed &= higher * (lower[None, :, 1] - upper[:, None, 1]) > 0
    if limit:
        allowed &= gaps <= largest
    return np.where(allowed, gaps, np.inf)


def _paired(gaps: np.ndarray) -> np.ndarray:
    """Repeated minimum of a table, until nothing finite is left."""
    gaps, partner = gaps.copy(), np.full(len(gaps), -1)
    while np.isfinite(gaps).any():
        i, j = np.unravel_index(np.argmin(gaps), gaps.shape)
        partner[i] = j
        gaps[i, :] = gaps[:, j] = np.inf
    return partner


def _mistaken_pairs(pair: Callable = _paired, **parts) -> Callable:
    return lambda *given: pair(_gaps(*given, **parts))


def _each_its_best(gaps: np.ndarray) -> np.ndarray:
    if not gaps.shape[1]:
        return np.full(len(gaps), -1)
    return np.where(np.isfinite(gaps).any(axis=1), gaps.argmin(axis=1), -1)


def _in_their_order(gaps: np.ndarray) -> np.ndarray:
    gaps, partner = gaps.copy(), np.full(len(gaps), -1)
    for i in range(len(gaps)):
        if np.isfinite(gaps[i]).any():
            partner[i] = gaps[i].argmin()
            gaps[:, partner[i]] = np.inf
    return partner


def _min_total(gaps: np.ndarray) -> np.ndarray:
    partner = np.full(len(gaps), -1)
    for i, j in zip(*linear_sum_assignment(np.minimum(gaps, 10.0)), strict=True):
        partner[i] = j if np.isfinite(gaps[i, j]) else -1
    return partner


def _each_others_best(gaps: np.ndarray) -> np.ndarray:
    best = _each_its_best(gaps)
    return np.array([j if j >= 0 and gaps[:, j].argmin() == i else -1 for i, j in enumerate(best)], dtype=int)


def _two_images(rng: np.random.Generator, n: int | None = None, m: int | None = None) -> tuple:
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
        right = pair_boxes(*given)
        others = [_each_its_best(_gaps(*given)), _in_their_order(_gaps(*given))]
        if all(not np.array_equal(right, other) for other in others) or rng.random() < 0.2:
            return given


def _nothing_below(rng: np.random.Generator) -> tuple:
    labels, upper, _, _, largest = _two_images(rng)
    return labels, upper, labels[:0], upper[:0], largest


# P2.3: places in the plane


def places_of(upper_angles, lower_angles, baseline) -> np.ndarray:
    """(n, 2) metres, body frame: rho (cos a, sin a), rho = B / (tan e_l - tan e_u); NaN where e_l - e_u <= 0.001."""
    return _places(upper_angles, lower_angles, baseline)


def _range(e_u, e_l, baseline):
    return baseline / (np.tan(e_l) - np.tan(e_u))


def _only_forward(e_u, e_l, baseline):
    rho = _range(e_u, e_l, baseline)
    return np.where(rho > 0, rho, np.nan)


def _places(upper, lower, baseline, distance: Callable = _range, azimuth: int = 0, guard: bool = True, mirror=1.0):
    """The places, and with other parts their mistakes."""
    with np.errstate(divide="ignore", invalid="ignore"):
        rho = distance(upper[:, 1], lower[:, 1], baseline)
    if guard:
        rho = np.where(lower[:, 1] - upper[:, 1] > 1e-3, rho, np.nan)
    a = (upper, lower)[azimuth][:, 0]
    return np.column_stack([rho * np.cos(a), mirror * rho * np.sin(a)])


def _mistaken_places(**parts) -> Callable:
    return lambda upper, lower, baseline: _places(upper, lower, baseline, **parts)


def _angle_pairs(rng: np.random.Generator) -> tuple:
    """Objects below, level with and above the cameras; one pair diverges, one is parallel."""
    n = int(rng.integers(5, 9))
    baseline, rho, z = rng.uniform(0.15, 0.6), rng.uniform(0.8, 6.0, n), rng.uniform(-1.3, 0.4, n)
    azimuth = rng.uniform(-np.pi, np.pi, n)
    upper = np.column_stack([azimuth, np.arctan2(z, rho)])
    lower = np.column_stack([wrap_angle(azimuth + rng.normal(0, 0.03, n)), np.arctan2(z + baseline, rho)])
    lower[0, 1] = upper[0, 1] - rng.uniform(0.01, 0.1)
    lower[1, 1] = upper[1, 1] + 5e-4
    return upper, lower, baseline


def _no_pairs(rng: np.random.Generator) -> tuple:
    return np.zeros((0, 2)), np.zeros((0, 2)), 0.3


def _diverging_turned_round(upper, lower, baseline):
    return _places(upper, lower, baseline, lambda *given: np.abs(_range(*given)), guard=False)


# P2.4: the penalty of eq. (1)


def penalties(labels, places, hues, saturations, map_labels, map_places, map_hues, map_saturations) -> np.ndarray:
    """Eq. (1) for every observation with every landmark (n, m); p_obj = 100, p_h = p_s = p_d = 1.

    dh on the circle, 0 where either is grey (NaN); |dx| to the centroid of its own side; divisor at least 0.1 m.
    """
    return _penalties(labels, places, hues, saturations, map_labels, map_places, map_hues, map_saturations)


def _hue_gap(a, b):
    apart = np.abs(a - b)
    return np.minimum(apart, 360 - apart)


def _from_centroid(places):
    return np.linalg.norm(places - places.mean(axis=0), axis=1)


def _penalties(
    labels,
    places,
    hues,
    saturations,
    map_labels,
    map_places,
    map_hues,
    map_saturations,
    hue: Callable = lambda a, b: np.nan_to_num(_hue_gap(a, b)) / 360,
    saturation: Callable = lambda a, b: np.abs(a - b) / 100,
    far: Callable = _from_centroid,
    relative: Callable = lambda c, m: np.abs(c - m) / np.maximum(m, 0.1),
    unlike: float = 100.0,
):
    """The table, and with other parts its mistakes."""
    table = unlike * (labels[:, None] != map_labels[None])
    table = table + hue(hues[:, None], map_hues[None]) + saturation(saturations[:, None], map_saturations[None])
    return table + relative(far(places)[:, None], far(map_places)[None])


def _mistaken_penalties(**parts) -> Callable:
    return lambda *given: _penalties(*given, **parts)


def _one_centroid(*given):
    middle = given[5].mean(axis=0)
    return _penalties(*given, far=lambda points: np.linalg.norm(points - middle, axis=1))


def _by_vectors(*given):
    seen, mapped = (given[k] - given[k].mean(axis=0) for k in (1, 5))
    apart = np.linalg.norm(seen[:, None] - mapped[None], axis=2)
    return _penalties(*given, relative=lambda c, m: apart / np.maximum(m, 0.1))


def _observed_and_mapped(rng: np.random.Generator) -> tuple:
    """Observations of some of a map's objects, from some pose; grey ones, hues across the wrap."""
    m = int(rng.integers(6, 11))
    map_labels = rng.choice(["sofa", "chair", "table", "television"], m)
    map_places = rng.uniform(0, 6, (m, 2))
    map_hues, map_saturations = rng.uniform(0, 360, m), rng.uniform(5, 90, m)
    map_hues[0], map_hues[1] = np.nan, 355.0
    seen = np.concatenate([[0, 1], 2 + rng.permutation(m - 2)[: int(rng.integers(1, m - 3))]])
    theta = rng.uniform(-np.pi, np.pi)
    places = (map_places[seen] - rng.uniform(1, 5, 2)) @ rotation(theta) + rng.normal(0, 0.1, (len(seen), 2))
    hues = (map_hues[seen] + rng.normal(0, 15, len(seen))) % 360
    hues[0], hues[1] = 40.0, 12.0
    hues[-1] = np.nan if rng.random() < 0.5 else hues[-1]
    saturations = np.clip(map_saturations[seen] + rng.normal(0, 10, len(seen)), 0, 100)
    return map_labels[seen], places, hues, saturations, map_labels, map_places, map_hues, map_saturations


def _landmark_at_the_centroid(rng: np.random.Generator) -> tuple:
    given = list(_observed_and_mapped(rng))
    given[5][-1] = given[5][:-1].mean(axis=0) + 0.01
    return tuple(given)


# P2.5: the repeated minimum


def associate(cost) -> np.ndarray:
    """For every row of cost (n, m) its column (n,), -1: none. Repeated minimum until a side is used up.

    A pair that costs 100 or more is of unlike classes: it is struck out as any other, but not used.
    """
    return _associated(cost)


def _associated(cost, unlike: float = 100.0, strike_rows: bool = True, strike_columns: bool = True, struck=np.inf):
    """The columns, and with other parts their mistakes."""
    cost, column = cost.astype(float).copy(), np.full(len(cost), -1)
    for _ in range(min(cost.shape)):
        i, j = np.unravel_index(np.argmin(cost), cost.shape)
        if np.isinf(cost[i, j]):
            break
        column[i] = j if cost[i, j] < unlike else -1
        if strike_rows:
            cost[i, :] = struck
        if strike_columns:
            cost[:, j] = struck
    return column


def _best_of_each_row(cost):
    return np.where(cost.min(axis=1) < 100, cost.argmin(axis=1), -1)


def _row_by_row(cost):
    cost, column = cost.astype(float).copy(), np.full(len(cost), -1)
    for i in range(len(cost)):
        j = int(cost[i].argmin())
        if cost[i, j] < 100:
            column[i] = j
        cost[:, j] = np.inf
    return column


def _best_total(cost):
    column = np.full(len(cost), -1)
    for i, j in zip(*linear_sum_assignment(cost), strict=True):
        column[i] = j if cost[i, j] < 100 else -1
    return column


def _penalty_tables(rng: np.random.Generator) -> tuple:
    """Tables with competition; more rows than columns at times, and rows of classes that the map has used up."""
    while True:
        n, m = int(rng.integers(4, 8)), int(rng.integers(4, 9))
        labels, map_labels = rng.integers(0, 3, n), rng.integers(0, 3, m)
        cost = rng.uniform(0, 1, (n, 1)) + rng.uniform(0, 1, (1, m)) + rng.uniform(0, 1, (n, m))
        cost = cost + 100.0 * (labels[:, None] != map_labels[None])
        right = associate(cost)
        others = (_best_of_each_row(cost), _row_by_row(cost), _best_total(cost), _associated(cost, np.inf))
        if all(not np.array_equal(right, other) for other in others):
            return (cost,)


def _more_seen_than_mapped(rng: np.random.Generator) -> tuple:
    return (rng.uniform(0, 2, (6, 3)),)


# P2.6: the pose


def fit_pose(places, landmarks) -> tuple[float, float, float]:
    """(x, y, theta in [-pi, pi)) that takes places (n, 2) to landmarks (n, 2), least squares; NaN where there is none.

    There is none with fewer than two pairs, or with all places, or all landmarks, within a millimetre.
    """
    return _fitted(places, landmarks)


def rotation(theta: float) -> np.ndarray:
    """R(theta) (2, 2)."""
    return np.array([[np.cos(theta), -np.sin(theta)], [np.sin(theta), np.cos(theta)]])


def _no_pose(places, landmarks) -> bool:
    return len(places) < 2 or min(np.ptp(points, axis=0).max() for points in (places, landmarks)) < 1e-3


def _turn(places, landmarks) -> float:
    a, b = places - places.mean(axis=0), landmarks - landmarks.mean(axis=0)
    return float(np.arctan2(np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]), np.sum(a * b)))


def _shift(places, landmarks, theta):
    return landmarks.mean(axis=0) - rotation(theta) @ places.mean(axis=0)


def _fitted(places, landmarks, turn: Callable = _turn, shift: Callable = _shift, none: Callable = _no_pose):
    """The pose, and with other parts its mistakes."""
    if none(places, landmarks):
        return np.nan, np.nan, np.nan
    theta = turn(places, landmarks)
    x, y = shift(places, landmarks, theta)
    return float(x), float(y), float(theta)


def _mistaken_fit(**parts) -> Callable:
    return lambda places, landmarks: _fitted(places, landmarks, **parts)


def _half_turns(places, landmarks) -> float:
    theta = _turn(places, landmarks)
    return float(np.arctan(np.tan(theta)))


def _mean_turn(places, landmarks) -> float:
    a, b = places - places.mean(axis=0), landmarks - landmarks.mean(axis=0)
    turns = np.arctan2(b[:, 1], b[:, 0]) - np.arctan2(a[:, 1], a[:, 0])
    return float(np.arctan2(np.sin(turns).mean(), np.cos(turns).mean()))


def _stretched(places, landmarks):
    if _no_pose(places, landmarks):
        return np.nan, np.nan, np.nan
    scale = np.linalg.norm(landmarks - landmarks.mean(axis=0)) / np.linalg.norm(places - places.mean(axis=0))
    x, y = _shift(scale * places, landmarks, _turn(places, landmarks))
    return float(x), float(y), _turn(places, landmarks)


def _svd_without_sign(places, landmarks):
    if _no_pose(places, landmarks):
        return np.nan, np.nan, np.nan
    a, b = places - places.mean(axis=0), landmarks - landmarks.mean(axis=0)
    u, _, vt = np.linalg.svd(b.T @ a)
    r = u @ vt
    return (*(landmarks.mean(axis=0) - r @ places.mean(axis=0)), np.arctan2(r[1, 0], r[0, 0]))


def _refusing_mirrors(places, landmarks):
    try:
        return tuple(fit_rigid_2d(places, landmarks))
    except RigidFitError:
        return np.nan, np.nan, np.nan


def _in_degrees(places, landmarks):
    x, y, theta = fit_pose(places, landmarks)
    return x, y, np.degrees(theta)


def _uncentred(places, landmarks):
    return float(
        np.arctan2(np.sum(places[:, 0] * landmarks[:, 1] - places[:, 1] * landmarks[:, 0]), np.sum(places * landmarks))
    )


def _pairs(rng: np.random.Generator) -> tuple:
    n = int(rng.integers(2, 9))
    places = rng.uniform(-4, 4, (n, 2))
    landmarks = places @ rotation(rng.uniform(-np.pi, np.pi)).T + rng.uniform(1, 5, 2) + rng.normal(0, 0.1, (n, 2))
    return places, landmarks


def _turned_by_half(rng: np.random.Generator) -> tuple:
    places, _ = _pairs(rng)
    return places, places @ rotation(3.1).T + 1


def _mirror_image(rng: np.random.Generator) -> tuple:
    """Wrong pairs: a reflection would fit better, and is no pose."""
    places = rng.uniform(-4, 4, (5, 2))
    return places, places * np.array([1, -1]) + rng.normal(0, 0.1, (5, 2)) + 3


def _one_pair(rng: np.random.Generator) -> tuple:
    return rng.uniform(-4, 4, (1, 2)), rng.uniform(0, 6, (1, 2))


def _nothing(rng: np.random.Generator) -> tuple:
    return np.zeros((0, 2)), np.zeros((0, 2))


def _one_place_twice(rng: np.random.Generator) -> tuple:
    return np.tile(rng.uniform(-4, 4, 2), (2, 1)), rng.uniform(0, 6, (2, 2))


def _one_landmark_twice(rng: np.random.Generator) -> tuple:
    return rng.uniform(-4, 4, (2, 2)), np.tile(rng.uniform(0, 6, 2), (2, 1))


EXERCISES = [
    Exercise(
        number="P2.1",
        level="warm-up",
        solution=angles_of,
        inputs=_box,
        cases=(_box_across_the_seam,),
        mistakes=(
            Mistake(
                _mistaken_angles(wrap=float),
                "Right but for whole turns: a box across the seam has its centre beyond the width, and its azimuth "
                "below -pi. Bring it into [-pi, pi).",
            ),
            Mistake(
                _mistaken_angles(wrap=lambda azimuth: azimuth % (2 * np.pi)),
                "Your azimuth runs from 0 to 2 pi; asked is -pi to pi.",
            ),
            Mistake(
                _mistaken_angles(left=-1.0),
                "Columns run to the right as azimuth *decreases*: left of the centre is positive.",
            ),
            Mistake(_mistaken_angles(up=-1.0), "Row 0 is straight up: elevation grows as v falls."),
            Mistake(
                _mistaken_angles(height_share=1.0),
                "Your elevation divides by the width. A panorama is half as high as wide.",
            ),
            Mistake(
                _mistaken_angles(turn=np.pi),
                "A whole turn, 2 pi, lies across the width; pi lies across the height.",
            ),
            Mistake(
                _mistaken_angles(centre=lambda box: box[:2]),
                "That is the box's upper left corner. Its centre is asked for.",
            ),
            Mistake(
                _mistaken_angles(centre=lambda box: (box[2:] - box[:2]) / 2),
                "That is half the box's size. The centre is the *mean* of opposite edges.",
            ),
            Mistake(
                _edge_moved_back,
                "You move the right edge back before the mean, and the centre lands across the image. Mean first.",
            ),
            Mistake(
                _mistaken_angles(corner=0.5),
                "You add half a pixel. Boxes are in edge coordinates: only OpenCV's keypoints need that.",
            ),
            Mistake(
                lambda box, width: tuple(np.degrees(_angles(box, width))),
                "In radians, please.",
            ),
            Mistake(
                lambda box, width: (angles_of(box, width)[0], np.pi / 2 - angles_of(box, width)[1]),
                "That is the angle from straight up. Elevation is 0 at the horizon.",
            ),
            Mistake(
                lambda box, width: angles_of(box - 0.5, width),
                "Half a pixel off: boxes are in edge coordinates, where the middle is at width / 2.",
            ),
            Mistake(
                lambda box, width: (_wrapped(angles_of(box, width)[0] - np.pi), angles_of(box, width)[1]),
                "Azimuth 0 is the image's middle, not its left edge.",
            ),
        ),
    ),
    Exercise(
        number="P2.2",
        solution=pair_boxes,
        inputs=_two_images,
        cases=(_nothing_below,),
        mistakes=(
            Mistake(
                _mistaken_pairs(gap=lambda a, b: np.abs(a - b)),
                "Azimuths of 3.13 and -3.13 are 0.02 apart, not 6.26: the gap goes around the circle.",
            ),
            Mistake(
                _mistaken_pairs(gap=lambda a, b: wrap_angle(a - b)),
                "Your gap has a sign, and the most negative one is taken for the least.",
            ),
            Mistake(_mistaken_pairs(classes=False), "You pair boxes of unlike classes."),
            Mistake(
                _mistaken_pairs(higher=0),
                "The lower camera sees every object *higher* than the upper one does, e_l > e_u. You do not ask it.",
            ),
            Mistake(
                _mistaken_pairs(higher=-1),
                "You ask for e_l < e_u. From below, an object is seen higher: draw the rig from the side.",
            ),
            Mistake(
                _mistaken_pairs(pair=_min_total),
                "That makes the *total* gap least. Asked is the least gap first, and no way back.",
            ),
            Mistake(_mistaken_pairs(limit=False), "You pair boxes however far apart: largest_gap is not used."),
            Mistake(
                _mistaken_pairs(pair=_each_its_best),
                "Two upper boxes may take one lower box in yours: it must be one-to-one.",
            ),
            Mistake(
                _mistaken_pairs(pair=_in_their_order),
                "Yours depends on the order of the boxes: the least gap of the whole table comes first.",
            ),
            Mistake(
                _mistaken_pairs(pair=_each_others_best),
                "You pair those only that are each other's best. Strike both out and look again: seconds may remain.",
            ),
            Mistake(
                lambda *given: np.maximum(pair_boxes(*given), 0),
                "A box without a partner gets -1, not 0: box 0 is a box.",
            ),
        ),
    ),
    Exercise(
        number="P2.3",
        solution=places_of,
        inputs=_angle_pairs,
        cases=(_no_pairs,),
        mistakes=(
            Mistake(
                _mistaken_places(guard=False),
                "Right where there is a place. Where the rays diverge or run parallel (e_l - e_u <= 0.001) there is "
                "none: NaN.",
            ),
            Mistake(
                lambda *given: np.nan_to_num(_places(*given)),
                "You put what has no place at the origin, inside the rig. No place is NaN, not 0.",
            ),
            Mistake(
                _mistaken_places(distance=_only_forward, guard=False),
                "Rays that are parallel to a thousandth tell no place either: e_l - e_u <= 0.001 is NaN, too.",
            ),
            Mistake(
                _mistaken_places(distance=lambda u, v, b: b / (np.tan(u) - np.tan(v)), guard=True),
                "Your ranges are negative: the lower camera sees the object higher, so tan e_l is the greater one.",
            ),
            Mistake(
                _mistaken_places(distance=lambda u, v, b: b * np.cos(v) / np.sin(v - u)),
                "That is d, along the ray. On the floor it is rho = d cos e_u.",
            ),
            Mistake(
                _mistaken_places(distance=lambda u, v, b: b / np.tan(v - u)),
                "tan(e_l - e_u) is not tan e_l - tan e_u.",
            ),
            Mistake(
                _mistaken_places(distance=lambda u, v, b: b / (v - u)),
                "You divide by the difference of the angles. Draw the right triangle: heights are rho tan e.",
            ),
            Mistake(_mistaken_places(azimuth=1), "Take the azimuth of the upper camera: the body frame is its own."),
            Mistake(_mistaken_places(mirror=-1.0), "y is to the left, where azimuths are positive: yours is mirrored."),
            Mistake(
                lambda upper, lower, baseline: _places(upper, lower, baseline)[:, ::-1],
                "x is forward, where the azimuth is 0: cos for x, sin for y.",
            ),
            Mistake(
                _diverging_turned_round, "Where the rays diverge there is no place: an absolute value makes one up."
            ),
        ),
    ),
    Exercise(
        number="P2.4",
        solution=penalties,
        inputs=_observed_and_mapped,
        cases=(_landmark_at_the_centroid,),
        mistakes=(
            Mistake(
                _mistaken_penalties(hue=lambda a, b: np.nan_to_num(np.abs(a - b)) / 360),
                "Hues of 355 and 12 degrees are 17 apart: the difference goes around the circle.",
            ),
            Mistake(
                _mistaken_penalties(hue=lambda a, b: np.nan_to_num(_hue_gap(a, b)) / 180),
                "Eq. (1) divides the hue's difference by 360, though none is above 180.",
            ),
            Mistake(
                _mistaken_penalties(hue=lambda a, b: _hue_gap(a, b) / 360),
                "A grey object has no hue (NaN): its hue term is 0.",
            ),
            Mistake(
                _mistaken_penalties(hue=lambda a, b: _hue_gap(np.nan_to_num(a), np.nan_to_num(b)) / 360),
                "You turn grey into hue 0, which is red. First the difference, then 0 where it is NaN.",
            ),
            Mistake(
                _mistaken_penalties(saturation=lambda a, b: np.abs(a - b)),
                "The saturation's difference is in percent: divide by 100.",
            ),
            Mistake(
                _mistaken_penalties(relative=lambda c, m: (c - m) / np.maximum(m, 0.1)),
                "As printed, eq. (1) rewards what looks too near. Take the absolute value of the distance term.",
            ),
            Mistake(
                _mistaken_penalties(relative=lambda c, m: np.abs(c - m) / m),
                "A landmark at the map's centroid divides by nearly nothing: the divisor is at least 0.1 m.",
            ),
            Mistake(
                _mistaken_penalties(relative=lambda c, m: np.abs(c - m) / np.maximum(c, 0.1)),
                "You divide by the observed distance. Eq. (1) divides by that of the map.",
            ),
            Mistake(
                _mistaken_penalties(relative=lambda c, m: np.abs(c - m)),
                "The distance term is relative: divide by the landmark's distance to the map's centroid.",
            ),
            Mistake(
                _mistaken_penalties(far=lambda points: np.linalg.norm(points, axis=1)),
                "Distances are to the *centroid* of their own side: without a pose nothing else is in both frames.",
            ),
            Mistake(_one_centroid, "Each side has a centroid of its own, in its own frame."),
            Mistake(_mistaken_penalties(unlike=0.0), "Unlike classes cost p_obj = 100."),
            Mistake(_mistaken_penalties(unlike=1.0), "p_obj is 100, not 1: above all that the others can add up to."),
            Mistake(
                _by_vectors,
                "Places of two frames are turned by the unknown heading. Compare distances from the centroids.",
            ),
            Mistake(
                lambda *given: _penalties(*given, relative=lambda c, m: np.abs(c - m) / (m + 0.1)),
                "The divisor is the greater of |dx_m| and 0.1 m, not their sum.",
            ),
        ),
    ),
    Exercise(
        number="P2.5",
        solution=associate,
        inputs=_penalty_tables,
        cases=(_more_seen_than_mapped,),
        mistakes=(
            Mistake(
                lambda cost: _associated(cost, np.inf),
                "The rounds go on until a side is used up, and join a chair to a plant at the end. Such a pair (100 or "
                "more) is not used: -1.",
            ),
            Mistake(_best_of_each_row, "Two observations may take one landmark in yours: strike both out."),
            Mistake(_row_by_row, "Yours goes row by row. The least of the whole table comes first."),
            Mistake(
                _best_total,
                "That is the assignment of least total. The paper's search takes the least pair and never goes back.",
            ),
            Mistake(
                lambda cost: _associated(cost, strike_columns=False),
                "A landmark that is taken stays open in yours: strike out its column too.",
            ),
            Mistake(
                lambda cost: _associated(cost, strike_rows=False),
                "An observation that is matched stays open in yours: strike out its row too.",
            ),
            Mistake(
                lambda cost: _associated(cost, struck=0.0),
                "You strike out with 0, which is the least of all from then on. Strike out with infinity.",
            ),
            Mistake(
                lambda cost: np.maximum(associate(cost), 0),
                "An observation without a landmark gets -1, not 0: landmark 0 is one.",
            ),
        ),
    ),
    Exercise(
        number="P2.6",
        level="challenge",
        solution=fit_pose,
        inputs=_pairs,
        cases=(_turned_by_half, _mirror_image, _one_pair, _nothing, _one_place_twice, _one_landmark_twice),
        mistakes=(
            Mistake(
                _mistaken_fit(none=lambda places, landmarks: len(places) < 2),
                "Right where there is a pose. Two pairs whose places (or landmarks) coincide tell no heading: NaN.",
            ),
            Mistake(
                _mistaken_fit(none=lambda places, landmarks: len(places) == 0),
                "One pair tells where, not which way: fewer than two pairs give NaN, NaN, NaN.",
            ),
            Mistake(
                _mistaken_fit(turn=lambda places, landmarks: -_turn(places, landmarks)),
                "Your rotation goes the wrong way: the cross product is a_x b_y - a_y b_x.",
            ),
            Mistake(_mistaken_fit(turn=_uncentred), "Subtract each side's centroid before you turn one on the other."),
            Mistake(
                _mistaken_fit(shift=lambda p, m, theta: m.mean(axis=0) - p.mean(axis=0)),
                "The heading is right. Turn the places' centroid before you take it off the landmarks'.",
            ),
            Mistake(
                _mistaken_fit(shift=lambda p, m, theta: m.mean(axis=0) - rotation(-theta) @ p.mean(axis=0)),
                "The heading is right. R is transposed: (1, 0) must go to (cos theta, sin theta).",
            ),
            Mistake(
                _mistaken_fit(shift=lambda p, m, theta: m.mean(axis=0)),
                "That is the landmarks' centroid. The rig stands at the body frame's origin.",
            ),
            Mistake(
                _svd_without_sign,
                "U V^T may be a mirror, which no rig can turn into: mind the sign of the determinant.",
            ),
            Mistake(
                _refusing_mirrors,
                "Pairs that look mirrored have a best turn, too. No pose: too few pairs, or coincident ones, only.",
            ),
            Mistake(
                lambda places, landmarks: fit_pose(places[:2], landmarks[:2]),
                "You use the first two pairs. Sum over all of them.",
            ),
            Mistake(
                lambda places, landmarks: fit_pose(landmarks, places),
                "That takes the map to the body. Asked is the pose: from the body to the map.",
            ),
            Mistake(_in_degrees, "theta in radians, please."),
            Mistake(
                _mistaken_fit(turn=lambda places, landmarks: _turn(places, landmarks) % (2 * np.pi)),
                "Your theta runs from 0 to 2 pi; asked is -pi to pi.",
            ),
            Mistake(
                lambda places, landmarks: (*fit_pose(places, landmarks)[:2], -fit_pose(places, landmarks)[2]),
                "Right but for the sign of theta: the pose turns the body onto the map.",
            ),
            Mistake(
                lambda places, landmarks: tuple(np.nan_to_num(fit_pose(places, landmarks))),
                "Where there is no pose the answer is NaN three times: (0, 0, 0) is a place.",
            ),
            Mistake(
                _mistaken_fit(turn=_half_turns),
                "arctan of a quotient knows half of the directions only: np.arctan2 takes both.",
            ),
            Mistake(
                _mistaken_fit(turn=_mean_turn),
                "You average the turns of single pairs. A far pair knows its direction better: let the sums weigh.",
            ),
            Mistake(_stretched, "Your fit may stretch: R alone turns, without a scale."),
        ),
    ),
]
