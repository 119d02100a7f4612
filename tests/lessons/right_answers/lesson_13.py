"""Right answers to lesson 13 by other ways than its solutions."""

import itertools

import numpy as np

from course_lib.geometry import wrap_angle

PI = np.pi


def by_angles(upper, lower, baseline):
    """Turn the whole scene until the baseline is upright, and use equation (13.2)."""
    ahead = np.cross(np.eye(3)[np.argmin(np.abs(baseline))], baseline)
    ahead /= np.linalg.norm(ahead)
    axes = np.stack([ahead, np.cross(baseline, ahead), baseline], axis=1)
    (a_u, _), (a_l, e_l) = ((np.arctan2(d[:, 1], d[:, 0]), np.arcsin(d[:, 2])) for d in (upper @ axes, lower @ axes))
    gap = np.abs(wrap_angle(a_l - a_u))
    return np.where(gap > PI / 2, PI / 2 - np.abs(e_l), np.arcsin(np.cos(e_l) * np.sin(gap)))


def nearest_point(upper, lower, baseline):
    """The point of each half-circle that is nearest, and the chord to it."""
    ahead = upper - np.outer(upper @ baseline, baseline)
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    along = np.clip(np.arctan2(lower @ baseline, np.sum(lower * ahead, axis=1)), -PI / 2, PI / 2)[:, None]
    foot = np.cos(along) * ahead + np.sin(along) * baseline
    return list(2 * np.arcsin(np.linalg.norm(lower - foot, axis=1) / 2))


def count_by_count(counts):
    """From the largest count down: what hangs together by one count is a pair, or a tie."""
    free_rows, free_columns, result = set(range(len(counts))), set(range(counts.shape[1])), [-1] * len(counts)
    for count in sorted(set(counts[counts > 0].tolist()), reverse=True):
        places = [(i, j) for i, j in itertools.product(free_rows, free_columns) if counts[i, j] == count]
        for i, j in places:
            if sum(p[0] == i for p in places) == 1 == sum(p[1] == j for p in places):
                result[i] = j
        free_rows -= {i for i, _ in places}
        free_columns -= {j for _, j in places}
    return result


def gaps(upper, lower):
    return np.degrees(wrap_angle(upper - lower))


def wrapped(angle):
    return (angle + 180) % 360 - 180


def by_histogram(upper, lower):
    counts, edges = np.histogram(gaps(upper, lower), np.arange(-180, 181))
    about = edges[np.argmax(counts + np.roll(counts, 1))]
    near = wrapped(gaps(upper, lower) - about)
    good = near[np.abs(near) < 2]
    return wrapped(about + good.mean()), good.std() / np.sqrt(len(good))


def by_median(upper, lower):
    """The shortest stretch that holds a third of the matches, then the median of what is near it."""
    gap = np.sort(gaps(upper, lower))
    twice, third = np.r_[gap, gap + 360], (len(gap) + 1) // 3
    k = np.argmin(twice[third : third + len(gap)] - twice[: len(gap)])
    near = wrapped(gap - (about := (twice[k] + twice[k + third]) / 2))
    near = near[np.abs(near) < 2]
    spread = 1.4826 * np.median(np.abs(near - np.median(near)))
    return [wrapped(about + np.median(near)), 1.25 * spread / len(near) ** 0.5]


RIGHT = [
    ("13.1", lambda v, rho, b, h: np.arctan2(rho, rho / np.tan(v / h * PI) + b) / PI * h),
    ("13.1", lambda v, rho, b, h: [h / 2 - h / PI * np.arctan(np.tan((h / 2 - r) * PI / h) + b / rho) for r in v]),
    ("13.2", by_angles),
    ("13.2", nearest_point),
    ("13.3", count_by_count),
    ("13.3", lambda counts: np.array(count_by_count(counts), float)),
    ("13.4", by_histogram),
    ("13.4", by_median),
]
