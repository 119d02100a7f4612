"""Right answers to lesson 13 by other ways than its solutions."""

import numpy as np

from course_lib.geometry import wrap_angle

PI = np.pi


def by_angles(upper, lower, baseline):
    """Turn the whole scene until the baseline is upright, and use equation (13.2)."""
    ahead = np.cross(np.eye(3)[np.argmin(np.abs(baseline))], baseline)
    ahead /= np.linalg.norm(ahead)
    (x, y, _), (x_l, y_l, z_l) = (np.stack([ahead, np.cross(baseline, ahead), baseline]) @ d.T for d in (upper, lower))
    gap = np.abs(wrap_angle(np.arctan2(y_l, x_l) - np.arctan2(y, x)))
    return np.where(gap > PI / 2, np.arccos(np.abs(z_l)), np.arcsin(np.sqrt(1 - z_l**2) * np.sin(gap)))


def count_by_count(counts):
    """From the largest count down: what hangs together by one count is a pair, or a tie."""
    left, result = np.argwhere(counts > 0).tolist(), [-1] * len(counts)
    while left:
        places = [(i, j) for i, j in left if counts[i, j] == max(counts[place] for place in map(tuple, left))]
        for i, j in places:
            if sum(i == row or j == column for row, column in places) == 1:
                result[i] = j
        left = [(i, j) for i, j in left if not any(i == row or j == column for row, column in places)]
    return result


def wrapped(angle):
    return (angle + 180) % 360 - 180


def near(gap, about):
    return wrapped(gap - about)[np.abs(wrapped(gap - about)) < 2]


def by_histogram(upper, lower):
    gap = np.degrees(wrap_angle(upper - lower))
    counts, edges = np.histogram(gap, np.arange(-180, 181))
    good = near(gap, about := edges[np.argmax(counts + np.roll(counts, 1))])
    return wrapped(about + good.mean()), good.std() / np.sqrt(len(good))


def by_median(upper, lower):
    """The shortest stretch that holds a third of the matches, then the median of what is near it."""
    gap = np.sort(np.degrees(wrap_angle(upper - lower)))
    twice, third = np.r_[gap, gap + 360], (len(gap) + 1) // 3
    k = np.argmin(twice[third : third + len(gap)] - twice[: len(gap)])
    good = near(gap, about := (twice[k] + twice[k + third]) / 2)
    spread = 1.4826 * np.median(np.abs(good - np.median(good)))
    return [wrapped(about + np.median(good)), 1.25 * spread / len(good) ** 0.5]


RIGHT = [
    ("13.1", lambda v, rho, b, h: np.arctan2(rho, rho / np.tan(v / h * PI) + b) / PI * h),
    ("13.2", by_angles),
    ("13.3", count_by_count),
    ("13.4", by_histogram),
    ("13.4", by_median),
]
