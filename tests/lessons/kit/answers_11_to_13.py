"""Answers that students may give to lessons 11 to 13, for test_exercise_answers.py."""

import itertools

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.spatial.transform import Rotation

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.panorama import direction_from_angles, pixel_to_direction

PI = np.pi


def look(azimuth, elevation):
    flat = np.cos(elevation)
    return [flat * np.cos(azimuth), flat * np.sin(azimuth), np.sin(elevation)]


def gap_deg(a, b, w):
    return (a - b) / w * 360


def two_ifs(a, b, w):
    gap = gap_deg(a, b, w)
    return gap - 360 if gap >= 180 else gap + 360 if gap < -180 else gap


def turned_until_it_fits(a, b, w):
    gap = gap_deg(a, b, w)
    while gap >= 180:
        gap -= 360
    while gap < -180:
        gap += 360
    return gap


def stretch_by_trying(columns, width):
    """Every point as the first one: the shortest of all."""
    ends = [(u, float(u + np.max((columns - u) % width))) for u in columns]
    return min(ends, key=lambda pair: pair[1] - pair[0])


def stretch_twice(columns, width):
    """The list twice, a turn apart: n points in a row, the shortest such row."""
    n = len(columns)
    twice = sorted(columns) + sorted(columns + width)
    k = min(range(n), key=lambda k: twice[k + n - 1] - twice[k])
    return [twice[k], twice[k + n - 1]]


def least_and_greatest(columns, width):
    return min(columns), max(columns)


def moved_if_wide(columns, width):
    columns = np.where(columns < width / 2, columns + width, columns) if np.ptp(columns) > width / 2 else columns
    return columns.min(), columns.max()


def points_that_moved(before, after, width, height):
    return (pixel_to_direction(uv, width, height) for uv in (before, after))


def by_scipy(before, after, width, height):
    first, then = points_that_moved(before, after, width, height)
    return Rotation.align_vectors(first, then)[0].as_euler("ZYX", degrees=True)[::-1]


def mean_cross_product(before, after, width, height):
    """The turn as the mean of d_after x d_before: too small, since each point sees only a part of it."""
    first, then = points_that_moved(before, after, width, height)
    return np.degrees(np.cross(then, first).mean(axis=0))


def solved_for_the_points(before, after, width, height):
    """How the points moved, not the camera."""
    return by_scipy(after, before, width, height)


def centre(boxes):
    return boxes[:, [0, 2]].mean(axis=1)


def area(box):
    return (box[2] - box[0]) * (box[3] - box[1])


def across(a, b, turn=0):
    return max(0, min(a[2], b[2] + turn) - max(a[0], b[0] + turn))


def down(a, b):
    return min(a[3], b[3]) - max(a[1], b[1])


def iou(shared, a, b):
    return shared / (area(a) + area(b) - shared)


def moved_if_across(a, b, width):
    a, b = ([u - width, v, w - width, x] if w > width else [u, v, w, x] for u, v, w, x in (a, b))
    return iou(across(a, b) * max(0, down(a, b)), a, b)


def turns(a, b, width):
    return [across(a, b, turn) for turn in (-width, 0, width)]


def nearest_copy(a, b, width):
    gap = (b[0] + b[2] - a[0] - a[2]) / 2
    return iou(across(a, b, (gap + width / 2) % width - width / 2 - gap) * max(0, down(a, b)), a, b)


def always_to_the_left(a, b, width):
    return iou(across(a, b, -width) * max(0, down(a, b)), a, b)


def in_the_plane(a, b):
    return iou(across(a, b) * max(0, down(a, b)), a, b)


def suppressed(boxes, scores, threshold, limit, within_class=True):
    """The surest stays, all that overlap it go, and again with what is left."""
    best, classes = scores.max(axis=1), scores.argmax(axis=1)
    left, kept = [i for i in np.argsort(best)[::-1] if best[i] >= threshold], []
    while left:
        kept.append(left.pop(0))
        left = [
            i
            for i in left
            if (within_class and classes[i] != classes[kept[-1]]) or in_the_plane(boxes[i], boxes[kept[-1]]) <= limit
        ]
    return kept


def class_after_class(boxes, scores, threshold, limit):
    classes, kept = scores.argmax(axis=1), []
    for one in range(scores.shape[1]):
        rows = np.flatnonzero(classes == one)
        kept += [rows[i] for i in suppressed(boxes[rows], scores[rows], threshold, limit)]
    return np.array(sorted(kept, key=lambda i: -scores[i].max()), dtype=int)


def unsorted(boxes, scores, threshold, limit):
    """Class after class, and left so."""
    classes, kept = scores.argmax(axis=1), []
    for one in range(scores.shape[1]):
        rows = np.flatnonzero(classes == one)
        kept += [int(rows[i]) for i in suppressed(boxes[rows], scores[rows], threshold, limit)]
    return kept


def wilson(hits, n, z=1.96, side=-1):
    """The root of (p - hits / n)^2 = z^2 p (1 - p) / n."""
    return np.sort(np.roots([1 + z * z / n, -2 * hits / n - z * z / n, (hits / n) ** 2]).real)[0 if side < 0 else 1]


def thresholds(scores, right, least, low=wilson):
    good = [t for t in sorted(set(scores)) if low(right[scores >= t].sum(), (scores >= t).sum()) >= least]
    return good


def just_below(scores, right, least):
    """Between two scores: keeps the same boxes."""
    good = thresholds(scores, right, least)
    below = scores[scores < good[0]] if good else []
    return np.inf if not good else (good[0] + below.max()) / 2 if len(below) else 0.0


def fixed_steps(scores, right, least):
    """A grid of thresholds finds none of the best cuts, only some."""
    good = [t for t in np.arange(0.1, 1, 0.1) if (scores >= t).any()]
    good = [t for t in good if wilson(right[scores >= t].sum(), (scores >= t).sum()) >= least]
    return min(good, default=np.inf)


def uncut_product(a, b, width):
    best = max((min(a[2], b[2] + t) - max(a[0], b[0] + t)) * down(a, b) for t in (-width, 0, width))
    return iou(max(0, best), a, b)


def of_the_short_list(boxes, scores, threshold, limit):
    reach = scores.max(axis=1) >= threshold
    return suppressed(boxes[reach], scores[reach], threshold, limit)


def elevation(v, height):
    return (0.5 - v / height) * PI


def by_angles(upper, lower, baseline):
    """Turn the whole scene until the baseline is upright, and use equation (13.2)."""
    helper = np.eye(3)[np.argmin(np.abs(baseline))]
    ahead = np.cross(helper, baseline) / np.linalg.norm(np.cross(helper, baseline))
    axes = np.stack([ahead, np.cross(baseline, ahead), baseline], axis=1)
    (a_u, _), (a_l, e_l) = ((np.arctan2(d[:, 1], d[:, 0]), np.arcsin(d[:, 2])) for d in (upper @ axes, lower @ axes))
    gap = np.abs(wrap_angle(a_l - a_u))
    return np.where(gap > PI / 2, PI / 2 - np.abs(e_l), np.arcsin(np.cos(e_l) * np.sin(gap)))


def nearest_of_many(upper, lower, baseline):
    """Points along the half-circle, the nearest of them: right to a thousandth only, refined once."""
    result = []
    for u, x in zip(upper, lower, strict=True):
        ahead = u - (u @ baseline) * baseline
        ahead /= np.linalg.norm(ahead)
        along = np.arctan2(x @ baseline, x @ ahead)
        best = np.clip(along, -PI / 2, PI / 2)
        foot = np.cos(best) * ahead + np.sin(best) * baseline
        result.append(2 * np.arcsin(np.linalg.norm(x - foot) / 2))
    return result


def whole_plane(upper, lower, baseline):
    normal = np.cross(baseline, upper)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    return np.arcsin(np.clip(np.abs(np.sum(normal * lower, axis=1)), 0, 1))


def past_the_right_angle(upper, lower, baseline):
    ahead = upper - np.outer(upper @ baseline, baseline)
    angle = whole_plane(upper, lower, baseline)
    return np.where(np.sum(ahead * lower, axis=1) < 0, PI - angle, angle)


def one_row_and_one_column(counts):
    counts, result = counts.copy(), [-1] * len(counts)
    while counts.max() > 0:
        i, j = np.unravel_index(counts.argmax(), counts.shape)
        tie = np.sum(counts[i] == counts[i, j]) > 1 or np.sum(counts[:, j] == counts[i, j]) > 1
        result[i] = -1 if tie else int(j)
        counts[i], counts[:, j] = 0, 0
    return result


def struck(table, rounds=None, start=-1):
    """Repeated maximum of a table; without `rounds`, until nothing above 0 is left."""
    table, result = np.array(table, float), np.full(len(table), start)
    while table.max() > 0 if rounds is None else (rounds := rounds - 1) >= 0:
        i, j = np.unravel_index(table.argmax(), table.shape)
        result[i] = j
        table[i], table[:, j] = 0, 0
    return result


def best_sum(counts):
    result = np.full(len(counts), -1)
    i, j = linear_sum_assignment(-counts)
    result[i] = np.where(counts[i, j] > 0, j, -1)
    return result


def count_by_count(counts):
    """From the largest count down: what hangs together by one count is a pair, or a tie."""
    free_rows, free_columns = set(range(len(counts))), set(range(counts.shape[1]))
    result = [-1] * len(counts)
    for count in sorted({int(c) for c in counts.ravel() if c > 0}, reverse=True):
        places = [(i, j) for i, j in itertools.product(free_rows, free_columns) if counts[i, j] == count]
        for i, j in places:
            if sum(p[0] == i for p in places) == 1 == sum(p[1] == j for p in places):
                result[i] = j
        free_rows -= {i for i, _ in places}
        free_columns -= {j for _, j in places}
    return result


def gaps_deg(upper, lower):
    return np.degrees(wrap_angle(upper - lower))


def wrapped(angle):
    return (angle + 180) % 360 - 180


def by_histogram(upper, lower):
    gap = gaps_deg(upper, lower)
    counts, edges = np.histogram(gap, np.arange(-180, 181))
    about = edges[np.argmax(counts + np.roll(counts, 1))]
    good = wrapped(gap - about)
    good = good[np.abs(good) < 2]
    return wrapped(about + good.mean()), good.std() / np.sqrt(len(good))


def by_median(upper, lower):
    """The shortest stretch that holds half of the matches, then the median of what is near it."""
    gap = np.sort(gaps_deg(upper, lower))
    twice, half = np.r_[gap, gap + 360], (len(gap) + 1) // 3
    k = np.argmin(twice[half : half + len(gap)] - twice[: len(gap)])
    about = (twice[k] + twice[k + half]) / 2
    near = wrapped(gap - about)
    near = near[np.abs(near) < 2]
    return [
        wrapped(about + np.median(near)),
        1.25 * 1.4826 * np.median(np.abs(near - np.median(near))) / len(near) ** 0.5,
    ]


# Exercise, answer, words of the hint that must come.
def stretch_without_the_seam(around, width):
    k = np.diff(around).argmax()
    return around[k + 1], around[k] + width


def from_two_points(before, after, width, height):
    """The first two points alone; roll, pitch, yaw."""
    first, then = points_that_moved(before[:2], after[:2], width, height)
    rows = np.concatenate([np.stack([np.cross(axis, d) for axis in np.eye(3)], axis=-1) for d in then])
    return np.degrees(np.linalg.lstsq(rows, (first - then).ravel(), rcond=None)[0])


def best_of_three_products(a, b, w):
    """Lengths multiplied before they are cut off at 0."""
    shared = max((min(a[2], b[2] + t) - max(a[0], b[0] + t)) * (min(a[3], b[3]) - max(a[1], b[1])) for t in (-w, 0, w))
    areas = [(box[2] - box[0]) * (box[3] - box[1]) for box in (a, b)]
    return max(shared, 0) / (sum(areas) - max(shared, 0))


def box_after_box(scores, right, least):
    """Running sums in the order of the scores: equal ones are cut apart."""
    order = np.argsort(-scores)
    k, n = np.cumsum(right[order]), np.arange(1, len(scores) + 1)
    good = np.flatnonzero([wilson(hits, of) >= least for hits, of in zip(k, n, strict=True)])
    return scores[order][good[-1]] if len(good) else np.inf


def all_equal_counts_out(counts):
    counts, found = counts.astype(float), np.full(len(counts), -1)
    while counts.max() > 0:
        places = np.argwhere(counts == counts.max())
        if len(places) == 1:
            found[places[0, 0]] = places[0, 1]
        for i, j in places:
            counts[i], counts[:, j] = -1, -1
    return found


def with_b_cross_x(up, low, b):
    """The normal b x x_upper, not of length one; the halves are right."""
    ahead = up - np.outer(up @ b, b)
    beside = np.arcsin(np.clip(np.abs(np.sum(np.cross(b, up) * low, axis=1)), 0, 1))
    return np.where(np.sum(ahead * low, axis=1) < 0, np.arccos(np.clip(np.abs(low @ b), 0, 1)), beside)


def along_the_slanted_ray(v, rho, b, h):
    e = (0.5 - v / h) * PI
    return (0.5 - np.arctan2(rho * np.sin(e) + b, rho * np.cos(e)) / PI) * h


WRONG = [
    ("11.2", two_ifs, "more than one turn apart"),
    (
        "11.3",
        lambda c, w: stretch_without_the_seam(np.sort(c), w) if len(c) > 1 else (c[0], c[0]),
        "from the last point across the seam",
    ),
    ("11.4", from_two_points, "the first points only"),
    ("12.1", lambda b, w, s: (b[:, 0] + b[:, 2] / 2 >= s) & (b[:, 0] + b[:, 2] / 2 < s + w), "not its width"),
    ("12.1", lambda b, w, s: ((b[:, 0] + b[:, 2]) // 2 >= s) & ((b[:, 0] + b[:, 2]) // 2 < s + w), "half columns"),
    ("12.2", best_of_three_products, "two negative lengths"),
    ("12.4", box_after_box, "equal scores stay or go together"),
    ("12.4", lambda s, r, least: (thresholds(s, r, least, lambda k, n: wilson(k, n, 1.645)) or [np.inf])[0], "90 %"),
    ("13.1", along_the_slanted_ray, "along the slanted ray"),
    ("13.2", with_b_cross_x, "make it a unit vector"),
    ("13.3", all_equal_counts_out, "nobody has to choose"),
    ("13.4", lambda u, x: (by_histogram(u, x)[0], 1.96 * by_histogram(u, x)[1]), "no 95 % interval"),
    ("13.4", lambda u, x: (by_histogram(u, x)[0], by_histogram(u, x)[1] * 0.72), "did wrong matches help"),
    ("11.1", lambda c, r, w, h: look(-2 * PI * min(max(c + 0.5, 0), w) / w, PI / 2 - PI * (r + 0.5) / h), "Right on"),
    ("11.1", lambda c, r, w, h: look(2 * PI * (c + 0.5) / w, PI / 2 - PI * (r + 0.5) / h), "Mirrored"),
    ("11.1", lambda c, r, w, h: look(-2 * PI * c / w, PI / 2 - PI * r / h), "the middle of a pixel"),
    (
        "11.1",
        lambda c, r, w, h: look(PI - 2 * PI * (c + 0.5) / w, PI / 2 - PI * (r + 0.5) / h),
        "the left edge is ahead",
    ),
    ("11.2", lambda a, b, w: np.sign(a - b) * min(abs(a - b), w - abs(a - b)) / w * 360, "sign and all"),
    ("11.2", lambda a, b, w: 180 - (180 - gap_deg(a, b, w)) % 360, "not +180"),
    ("11.2", lambda a, b, w: np.degrees(np.angle(np.exp(2j * PI * (a - b) / w))), "-180 alone"),
    ("11.2", lambda a, b, w: abs(gap_deg(a, b, w) + 180) % 360 - 180, "absolute value"),
    ("11.2", lambda a, b, w: g if abs(g := gap_deg(a, b, w)) < 180 else 360 - g, "*taken away*"),
    ("11.3", least_and_greatest, "the long way round"),
    ("11.3", moved_if_wide, "need not lie across the seam"),
    ("11.3", lambda c, w: tuple(u % w for u in stretch_by_trying(c, w)), "inside out"),
    ("11.3", lambda c, w: stretch_by_trying(c, w)[::-1], "u_max first"),
    ("11.3", lambda c, w: stretch_by_trying(c, w)[0], "Return 2 values"),
    ("11.4", solved_for_the_points, "signs are turned around"),
    ("11.4", lambda *g: by_scipy(*g)[::-1], "yaw first"),
    ("11.4", lambda *g: np.radians(by_scipy(*g)), "radians"),
    ("11.4", mean_cross_product, "Right on"),
    ("12.1", lambda boxes, w, s: (centre(boxes) >= s) & (centre(boxes) < w), "Your range ends at W"),
    ("12.1", lambda boxes, w, s: (boxes[:, 2] >= s) & (boxes[:, 2] < s + w), "right edge"),
    ("12.1", lambda boxes, w, s: np.abs(centre(boxes) - s - w / 2) <= w / 2, "twice in all"),
    ("12.1", lambda boxes, w, s: np.logical_or(centre(boxes) >= s, centre(boxes) < s + w), "both conditions"),
    ("12.1", lambda boxes, w, s: (centre(boxes) >= w / 8) & (centre(boxes) < 9 * w / 8), "begins at `start`"),
    ("12.1", lambda boxes, w, s: centre(boxes) >= s, "does not end"),
    ("12.1", lambda boxes, w, s: [box for box in boxes if s <= box[::2].mean() < s + w], "shape"),
    ("12.2", uncut_product, "whose product is positive"),
    ("12.2", moved_if_across, "try all turns"),
    ("12.2", lambda a, b, w: iou(sum(turns(a, b, w)) * down(a, b), a, b), "cut the length down off at 0"),
    ("12.2", lambda a, b, w: sum(turns(a, b, w)) * max(0, down(a, b)) / max(area(a), area(b)), "larger box"),
    ("12.2", always_to_the_left, "try all three"),
    ("12.2", lambda a, b, w: in_the_plane(a, b), "Across the seam yours is 0"),
    ("12.3", lambda *g: suppressed(*g, within_class=False), "same class"),
    ("12.3", of_the_short_list, "in the list as given"),
    ("12.3", unsorted, "class after class"),
    ("12.3", lambda boxes, scores, t, limit: np.flatnonzero(scores.max(axis=1) >= t), "shape"),
    ("12.3", lambda *g: suppressed(*g)[::-1], "least score first"),
    ("12.4", lambda s, r, least: (thresholds(s, r, least, lambda k, n: k / n) or [np.inf])[0], "plain share"),
    ("12.4", lambda s, r, least: (thresholds(s, r, least) or [np.inf])[-1], "highest good threshold"),
    ("12.4", lambda s, r, least: thresholds(s, r, least), "Give one number"),
    ("12.4", lambda s, r, least: 0.5, "No threshold is good enough"),
    ("12.4", fixed_steps, "Yours"),
    ("12.4", lambda s, r, least: (thresholds(s, r, least) or [0.0])[0], "np.inf"),
    ("13.1", lambda v, rho, b, h: v - b / rho / PI * h, "not to the angle"),
    ("13.1", lambda v, rho, b, h: (0.5 - np.arctan(np.tan(elevation(v, h)) + rho / b) / PI) * h, "range / baseline"),
    ("13.1", lambda v, rho, b, h: (0.5 + np.arctan(np.tan(elevation(v, h)) + b / rho) / PI) * h, "upside down"),
    (
        "13.1",
        lambda v, rho, b, h: (0.5 - np.arctan(np.tan(np.degrees(elevation(v, h))) + b / rho) / PI) * h,
        "takes radians",
    ),
    ("13.2", whole_plane, "forbidden"),
    ("13.2", past_the_right_angle, "beyond a right angle"),
    ("13.2", lambda u, x, b: by_angles(x, u, b), "the other way round"),
    ("13.2", lambda u, x, b: by_angles(u, x, np.array([0.0, 0.0, 1.0])), "always upright"),
    ("13.2", lambda u, x, b: np.degrees(by_angles(u, x, b)), "in degrees"),
    ("13.3", one_row_and_one_column, "one row and one column"),
    ("13.3", struck, "comes first in the list"),
    ("13.3", lambda counts: struck(counts, rounds=min(counts.shape)), "stop at 0"),
    ("13.3", lambda counts: np.maximum(count_by_count(counts), 0), "must hold -1"),
    ("13.3", lambda counts: np.where(np.array(count_by_count(counts)) < 0, np.nan, count_by_count(counts)), "hold NaN"),
    ("13.3", best_sum, "largest sum"),
    ("13.4", lambda u, x: (-by_histogram(u, x)[0], by_histogram(u, x)[1]), "sign"),
    ("13.4", lambda u, x: (gaps_deg(u, x).mean(), gaps_deg(u, x).std() / len(u) ** 0.5), "wrong matches pull"),
    ("13.4", lambda u, x: (by_histogram(u, x)[0], by_histogram(u, x)[1] * len(u) ** 0.5), "one match"),
    ("13.4", lambda u, x: by_histogram(u, x)[0], "Give two numbers"),
    ("13.4", lambda u, x: (by_histogram(u, x)[0], gaps_deg(u, x).std() / len(u) ** 0.5), "wrong matches add"),
    ("13.4", lambda u, x: (by_histogram(u, x)[0], by_histogram(u, x)[1] / 4), "less than half"),
    ("13.4", lambda u, x: (by_histogram(u, x)[0] % 360, by_histogram(u, x)[1]), "[-180, 180)"),
]
# Exercise, answer by another way than the solution.
RIGHT = [
    ("11.1", lambda c, r, w, h: look(-2 * PI * (c + 0.5) / w, PI / 2 - PI * (r + 0.5) / h)),
    ("11.1", lambda c, r, w, h: pixel_to_direction([c + 0.5 + w / 2, r + 0.5], w, h)),
    (
        "11.1",
        lambda c, r, w, h: direction_from_angles(-2 * PI * (c + 0.5) / w, PI * (0.5 - (r + 0.5) / h)).astype("f4"),
    ),
    ("11.2", lambda a, b, w: np.degrees(wrap_angle((a - b) / w * 2 * PI))),
    ("11.2", turned_until_it_fits),
    ("11.2", lambda a, b, w: (180 - gap_deg(b, a, w)) % 360 - 180),
    ("11.2", lambda a, b, w: np.array([((a - b) % w + w / 2) % w - w / 2]) / w * 360),
    ("11.3", stretch_by_trying),
    ("11.3", stretch_twice),
    ("11.3", lambda c, w: np.array(stretch_twice(c, w), np.float32)),
    ("11.4", by_scipy),
    ("11.4", lambda *g: tuple(by_scipy(*g).tolist())),
    ("12.1", lambda boxes, w, s: [s <= (box[0] + box[2]) / 2 < s + w for box in boxes]),
    ("12.1", lambda boxes, w, s: ((centre(boxes) - s) // w == 0).astype(int)),
    ("12.2", nearest_copy),
    ("12.2", lambda a, b, w: [iou(sum(turns(a, b, w)) * max(0, down(a, b)), a, b)]),
    ("12.3", suppressed),
    ("12.3", class_after_class),
    ("12.4", lambda s, r, least: (thresholds(s, r, least) or [np.inf])[0]),
    ("12.4", just_below),
    ("12.4", lambda s, r, least: (thresholds(s, r, least, lambda k, n: wilson(k, n, 1.959964)) or [np.nan])[0]),
    ("13.1", lambda v, rho, b, h: np.arctan2(rho, rho / np.tan(v / h * PI) + b) / PI * h),
    (
        "13.1",
        lambda v, rho, b, h: [float(h / 2 - h / PI * np.arctan(np.tan((h / 2 - r) * PI / h) + b / rho)) for r in v],
    ),
    ("13.2", by_angles),
    ("13.2", nearest_of_many),
    ("13.3", count_by_count),
    ("13.3", lambda counts: np.array(count_by_count(counts), float)),
    ("13.4", by_histogram),
    ("13.4", by_median),
]
