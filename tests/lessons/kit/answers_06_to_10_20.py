"""Answers of a student who tried lessons 06 to 10 and 20 from their texts alone, for test_exercise_answers.py."""

import numpy as np
from scipy.optimize import brentq
from scipy.spatial import cKDTree
from scipy.stats import binom

from course_lib.beyond.lost_and_found.adaptive_count import kld_count
from course_lib.geometry import rotation_exp, rotation_log
from tests.lessons.kit.answers_04_to_06 import by_lines, weighed
from tests.lessons.kit.answers_07_08_20 import (
    baselines,
    by_bisection,
    by_roots,
    counted,
    frames_of_pairs,
    length,
    metres,
    row,
    stratified_by_cuts,
    to_sum_one,
)
from tests.lessons.kit.answers_09 import by_vectors, first, geman, sigma, walls
from tests.lessons.kit.answers_10 import ENOUGH, by_argwhere, by_ratio, by_unique, flat, kept_by, near


def direction(y, w):
    return np.angle(w @ np.exp(1j * y))


def weigh_with(exponent):
    """Loops over particles and measured pixels, then `exponent` of the normalized likelihood and beta."""

    def answer(m, images, alpha, beta):
        pixels = list(zip(*np.nonzero(np.isfinite(m)), strict=True))
        sums = np.array([sum(alpha / (alpha + abs(m[p] - image[p])) for p in pixels) for image in images])
        if np.ptp(sums) == 0:
            return [1 / len(sums)] * len(sums)
        return to_sum_one(np.exp(exponent((sums - sums.min()) / np.ptp(sums), beta)))

    return answer


def seen_by_all(m, images, alpha, beta):
    return by_lines()(np.where(np.isinf(images).any(axis=0), np.nan, m), images, alpha, beta)


def no_clip(w, x):
    edges, variance = np.append(0, np.cumsum(w)), 0
    for k in range(len(w)):
        p = len(w) * (np.minimum(edges[1:], (k + 1) / len(w)) - np.maximum(edges[:-1], k / len(w)))
        variance += p @ (x - p @ x) ** 2
    return np.sqrt(variance) / len(w)


def in_single_precision(p, n, c, s):
    return np.array(walls(p, n, c, s, geman), dtype=np.float32)


def sum_of_steps(points, normals, offsets, scale):
    """Moves the points from step to step and adds the steps up."""
    total, moved = np.zeros(3), points.copy()
    for _ in range(40):
        step = np.array(walls(moved, normals, offsets, scale, geman, steps=1))
        c, s = np.cos(step[2]), np.sin(step[2])
        moved, total = moved @ np.array([[c, s], [-s, c]]) + step[:2], total + step
    return total


def rounded_up(free, cell, u):
    corners = np.argwhere(free)[np.ceil(u[:, 0] * free.sum()).astype(int) - 1]
    return cell * (corners[:, ::-1] + u[:, 1:])


def by_running_sum(free, cell, u):
    chosen = np.searchsorted(np.cumsum(free.ravel()), u[:, 0] * free.sum(), side="right")
    return [cell * (chosen % free.shape[1] + u[:, 1]), cell * (chosen // free.shape[1] + u[:, 2])]


def last_score_again(scores, short, long):
    seen = list(scores)
    for k in range(1, len(seen)):
        seen[k] = seen[k - 1] if np.isnan(seen[k]) else seen[k]
    return by_ratio(np.array(seen), short, long)


def bins_before(bins, least):
    for n in range(1, len(bins) + 1):
        if n >= kld_count(max(1, len(set(bins[: n - 1].tolist()))), least, ENOUGH):
            return n
    return len(bins)


def up_to_3000(bins, least):
    for n in range(1, len(bins) + 1):
        if n >= kld_count(len(set(bins[:n].tolist())), least, 3_000):
            return n
    return len(bins)


def turn(a, b):
    return abs((a[2] - b[2] + np.pi) % (2 * np.pi) - np.pi)


WRONG = [
    ("06.1", lambda t, a: np.round(a / t - a, 1), "You round"),
    ("06.1", lambda t, a: a - a / t, "sign is turned round"),
    ("06.1", lambda t, a: a / t - 1, "a share, from metres"),
    ("06.2", weigh_with(lambda n, beta: -((n - 1) ** 2) / (2 * beta**2)), "the 2 of the usual Gaussian"),
    ("06.2", weigh_with(lambda n, beta: -(1 - n) / beta), "not squared"),
    ("06.2", weigh_with(lambda n, beta: (n - 1) ** 2 / beta**2), "minus sign"),
    ("06.2", weigh_with(lambda n, beta: -(n**2) / beta**2), "not from 0"),
    ("06.2", seen_by_all, "*any* particle misses"),
    ("06.3", lambda v, beta: round(v.max() - beta * np.log(2) ** 0.5 * np.ptp(v), 1), "You round"),
    ("06.4", lambda x, p, q: (weighed(x, p / q)[0], np.sqrt(to_sum_one(p / q) ** 2 @ x**2)), "not of the samples"),
    (
        "06.4",
        lambda x, p, q: (weighed(x, p / q)[0], np.sqrt(to_sum_one(p / q) ** 2 @ (x - x.mean()) ** 2)),
        "not from the plain one",
    ),
    ("07.1", lambda y, w: (direction(y, w), length(y, w) / len(y)), "divides by N once more"),
    ("07.1", lambda y, w: (direction(y, w), abs(np.mean(np.exp(1j * y)))), "Your R has no weights"),
    ("07.1", lambda y, w: (w @ np.cos(y), w @ np.sin(y)), "by its coordinates"),
    ("07.1", lambda y, w: (-direction(y, w), length(y, w)), "mirrored: it has"),
    ("07.2", lambda w: (10 * w // 1, to_sum_one(10 * w % 1)), "always 10"),
    ("07.3", lambda w: binom.pmf(1, len(w), w).sum(), "exactly once"),
    ("07.3", lambda w: w @ binom.sf(0, len(w), w), "You weigh the chances"),
    ("07.4", no_clip, "overlap is negative"),
    ("07.4", lambda w, x: stratified_by_cuts(w, x) * len(w) / (len(w) - 1), "not by N - 1"),
    ("07.4", lambda w, x: np.sqrt(w @ (x - w @ x) ** 2 * (w @ w)), "With N_eff"),
    ("08.1", lambda e, p: cKDTree(p[:, 1:]).query(e[:, 1:])[0], "columns y and z"),
    ("08.1", lambda e, p: cKDTree(p[:, :2]).query(e[:, :2], p=np.inf)[0], "larger of the ways"),
    ("08.1", lambda e, p: cKDTree(p[:, :1]).query(e[:, :1])[0], "x alone"),
    ("08.2", lambda e: (sorted(e)[len(e) // 2], *row(e)[1:]), "upper of the middle two"),
    ("08.2", lambda e: (e[len(e) // 2], *row(e)[1:]), "the middle frame"),
    ("08.2", lambda e: (np.median(e), np.linalg.norm(e) / len(e), np.mean(e <= 0.3)), "after the root"),
    ("08.2", lambda e: (np.median(e), np.linalg.norm(e) / (len(e) - 1) ** 0.5, np.mean(e <= 0.3)), "T - 1"),
    ("08.3", lambda s, limit, patience: counted(s, limit, patience, lambda n: 1), "counter to 1"),
    ("08.3", lambda s, limit, patience: counted(-s, -limit, patience, lambda n: 0), "*above* the limit"),
    ("08.4", lambda n, a: n / (1 + (n - 1) * a), "equally alike"),
    ("08.4", lambda n, a: frames_of_pairs(n, abs(a)), "absolute value of a"),
    ("08.4", lambda n, a: round(frames_of_pairs(n, a)), "round to whole frames"),
    ("08.4", lambda n, a: n / (1 + 2 * sum((n - k) * a**k for k in range(1, n))), "the *share* with a partner"),
    ("09.1", lambda n, d, k: int(n ** (1 / d)) ** k, "spacing changes"),
    ("09.1", lambda n, d, k: n ** (1 / k), "the *old* one"),
    ("09.2", lambda rot, w: by_vectors(rot, w).T, "transposed"),
    ("09.2", lambda rot, w: rotation_exp(w @ rotation_log(rot[0].T @ rot)), "first step alone"),
    ("09.3", lambda e, c: (first(e, c), np.mean(e**2 <= 3 * sigma(c) ** 2)), "nine variances"),
    ("09.3", lambda e, c: (first(e, c), np.sum(abs(e) <= 3 * sigma(c))), "divided by their number"),
    ("09.3", lambda e, c: (first(e, c[:1] * 0 + c.mean(0)), np.mean(abs(e) <= 3 * sigma(c))), "one mean covariance"),
    ("09.4", lambda p, n, c, s: walls(p, n, c, 0.2, geman), "always 0.2"),
    ("09.4", lambda p, n, c, s: walls(p, n, c, 1, geman), "leave `scale` out"),
    ("09.4", sum_of_steps, "add up the steps"),
    ("10.1", rounded_up, "a cell too low"),
    ("10.1", lambda free, cell, u: by_argwhere(free[::-1], cell, u), "from the last one up"),
    ("10.1", by_running_sum, "must have shape"),
    ("10.2", last_score_again, "last score once more"),
    ("10.2", lambda s, a, b: np.where(np.isnan(s), np.nan, by_ratio(s, a, b)), "you give NaN"),
    ("10.3", bins_before, "ask before you look"),
    ("10.3", lambda bins, least: max(by_unique(bins, least), least), "before `least`"),
    ("10.3", up_to_3000, "You stop at 3,000"),
    ("10.4", kept_by(lambda a, b, m, r: flat(a, b) <= m and turn(a, b) < r), "not nearer than"),
    ("10.4", kept_by(lambda a, b, m, r: flat(a, b) < m and abs(np.sin(turn(a, b))) < np.sin(r)), "The sine"),
    (
        "10.4",
        kept_by(lambda a, b, m, r: flat(a, b) < m and abs(a[2] % (2 * np.pi) - b[2] % (2 * np.pi)) < r),
        "the seam is ahead",
    ),
    ("10.4", kept_by(lambda a, b, m, r: flat(a, b) ** 2 < m and turn(a, b) < r), "root is missing"),
    ("20.1", lambda raw, units, invalid: np.where(raw <= invalid, np.nan, raw / units), "that is smaller"),
    ("20.1", lambda raw, units, invalid: np.where(raw == 0, np.nan, metres(raw, units, invalid)), "leave out 0 as"),
    ("20.2", lambda k, s: np.array([[s, 0, s - 1], [0, s, s - 1], [0, 0, 1]]) @ k, "a whole pixel off"),
    ("20.3", lambda u, v, h, d: np.median(baselines(u, v, h - 1, d)), "height - 1"),
    ("20.3", lambda u, v, h, d: round(float(np.median(baselines(u, v, h, d))), 2), "round to centimetres"),
    ("20.3", lambda u, v, h, d: baselines(u, v, h, d)[0], "first mark alone"),
    ("20.4", lambda rho, rows, h, limit: np.nan_to_num(by_roots(rho, rows, h, limit), nan=np.inf), "not for infinity"),
    ("20.4", lambda rho, rows, h, limit: np.nan_to_num(by_bisection(rho, rows, h, limit)), "not for 0"),
]
RIGHT = [
    ("06.1", lambda t, a: [brentq(lambda d, x=x: a / (a + d) - x, -1e-9, 1e4) for x in t]),
    ("06.2", weigh_with(lambda n, beta: -(((n - 1) / beta) ** 2))),
    ("06.3", lambda v, beta: np.float32([v.max() - beta * np.log(2) ** 0.5 * np.ptp(v)])),
    ("07.3", lambda w: binom.sf(0, len(w), w).sum()),
    ("07.4", lambda w, x: np.float32([stratified_by_cuts(w, x)])),
    ("08.1", lambda e, p: cKDTree(p[:, :2]).query(e[:, :2])[0]),
    ("09.2", lambda rot, w: by_vectors(rot, w, start=int(w.argmax())).tolist()),
    ("09.4", in_single_precision),
    ("10.1", lambda free, cell, u: np.transpose(by_running_sum(free, cell, u))),
    ("10.4", kept_by(near, order=lambda scores: np.argsort(scores)[::-1])),
]
