"""Answers that students may give to lessons 07, 08 and 20, for test_exercise_answers.py."""

import itertools

import numpy as np


def to_sum_one(values):
    return values / np.sum(values)


def unwrapped(angles, w):
    return np.angle(np.exp(1j * (angles[0] + np.sum(w * np.angle(np.exp(1j * (angles - angles[0])))))))


def length(angles, w):
    return abs(w @ np.exp(1j * angles))


def strata(w):
    """For each part of the strip: (share, particle) of each field in it, by cutting the strip at every border."""
    n = len(w)
    cuts = np.unique(np.concatenate([np.arange(n + 1) / n, np.clip(np.cumsum(w), 0, 1)]))
    parts = [[] for _ in range(n)]
    for left, right in itertools.pairwise(cuts):
        middle = (left + right) / 2
        particle = min(int(np.searchsorted(np.cumsum(w), middle)), n - 1)
        parts[min(int(middle * n), n - 1)].append((n * (right - left), particle))
    return parts


def variance_in(part, x):
    share, particle = np.array([p for p, _ in part]), [i for _, i in part]
    mean = np.sum(share * x[particle])
    return max(0.0, np.sum(share * x[particle] ** 2) - mean**2)


def stratified_by_cuts(w, x):
    return np.sqrt(sum(variance_in(part, x) for part in strata(w))) / len(w)


def stratified_by_covariance(w, x):
    """The same from the covariance of the numbers of copies."""
    covariance = np.zeros((len(w), len(w)))
    for part in strata(w):
        p = np.zeros(len(w))
        for share, particle in part:
            p[particle] += share
        covariance += np.diag(p) - np.outer(p, p)
    return (x @ covariance @ x) ** 0.5 / len(w)


def windows(scores, limit, patience):
    """Needs at least `patience` scores: NumPy refuses a window that is longer than the array."""
    low = np.lib.stride_tricks.sliding_window_view(scores, patience).max(axis=1) < limit
    return int(np.argmax(low)) + patience - 1 if low.any() else -1


def counted(scores, limit, patience, after_good):
    n = 0
    for frame, score in enumerate(scores):
        n = n + 1 if score < limit else after_good(n)
        if n >= patience:
            return frame
    return -1


def first_window_short(scores, limit, patience):
    for frame in range(len(scores)):
        if np.max(scores[max(0, frame - patience + 1) : frame + 1]) < limit:
            return frame
    return -1


def last_one(scores, limit, patience):
    alarm, n = -1, 0
    for frame, score in enumerate(scores):
        n = n + 1 if score < limit else 0
        alarm = frame if n >= patience else alarm
    return alarm


def never_is_t(scores, limit, patience):
    found = counted(scores, limit, patience, lambda n: 0)
    return len(scores) if found < 0 else found


def by_strings(scores, limit, patience):
    at = "".join("L" if s < limit else "h" for s in scores).find("L" * patience)
    return at + patience - 1 if at >= 0 else -1


def nearest_in_space(estimated, path):
    result = []
    for p in estimated:
        k = np.argmin(np.linalg.norm(path - p, axis=1))
        result.append(np.hypot(*(path[k, :2] - p[:2])))
    return result


def row(errors):
    return np.median(errors), np.sqrt(np.mean(errors**2)), np.mean(errors <= 0.30)


def frames_of_pairs(n, a):
    total = sum(a ** abs(i - j) for i in range(n) for j in range(n)) if n < 100 else None
    return n * n / total if total else n / (1 + 2 * sum((n - k) / n * a**k for k in range(1, n)))


def frames_in_closed_form(n, a):
    if a == 1:
        return 1.0
    return n**2 / (n * (1 + a) / (1 - a) - 2 * a * (1 - a**n) / (1 - a) ** 2)


def metres(raw, units, invalid):
    depth = raw.astype(float) / units
    depth[raw == invalid] = np.nan
    return depth


def baselines(u, v, h, d):
    return d * (np.tan(np.pi * (0.5 - v / h)) - np.tan(np.pi * (0.5 - u / h)))


def sigma_of_range(b, rho, rows, height):
    e = np.arctan(b / (2 * rho))
    return rho**2 / b / np.cos(e) ** 2 * np.sqrt(2) * np.pi * rows / height


def by_bisection(rho, rows, height, limit):
    """The error falls up to a baseline of 2 rho, where it is least."""
    low, high = 1e-9 * rho, 2 * rho
    if sigma_of_range(high, rho, rows, height) > limit:
        return np.nan
    for _ in range(80):
        middle = (low + high) / 2
        low, high = (middle, high) if sigma_of_range(middle, rho, rows, height) > limit else (low, middle)
    return high


def by_roots(rho, rows, height, limit):
    s = np.sqrt(2) * np.pi * rows / height
    roots = np.roots([s / 4, -limit, s * rho**2])
    return min(roots.real) if np.isreal(roots).all() else np.nan


# Exercise, wrong answer, words of the hint that fits it.
WRONG = [
    ("07.1", lambda y, w: (np.angle(np.sum(np.exp(1j * w * y))), abs(np.sum(np.exp(1j * w * y)))), "angles themselves"),
    ("07.1", lambda y, w: (y.mean(), length(y, w)), "plain mean"),
    ("07.1", lambda y, w: (unwrapped(y, w), length(y, w)), "Close"),
    ("07.1", lambda y, w: (w @ y, length(y, w)), "fails at the wrap"),
    ("07.1", lambda y, w: (np.angle(w @ np.exp(1j * y)), 1), "lies inside it"),
    ("07.1", lambda y, w: (np.angle(w @ np.exp(1j * y)), length(y, w) ** 2), "is its square"),
    ("07.1", lambda y, w: (length(y, w), np.angle(w @ np.exp(1j * y))), "in another order"),
    ("07.1", lambda y, w: np.angle(w @ np.exp(1j * y)), "Return 2 values"),
    ("07.2", lambda w: (len(w) * w // 1, to_sum_one(np.clip(w - len(w) * w // 1, 0, None))), "Cut off at 0"),
    ("07.2", lambda w: (len(w) * w // 1, to_sum_one(abs(w - len(w) * w // 1))), "absolute value hides"),
    ("07.2", lambda w: (len(w) * w // 1, len(w) * w % 1 / len(w)), "by its own sum"),
    ("07.2", lambda w: (to_sum_one(len(w) * w % 1), len(w) * w // 1), "in another order"),
    ("07.2", lambda w: (np.round(len(w) * w), to_sum_one(len(w) * w - np.round(len(w) * w))), "np.round may give"),
    ("07.2", lambda w: (np.rint(len(w) * w), to_sum_one(len(w) * w % 1)), "copies are rounded"),
    ("07.3", lambda w: np.count_nonzero(len(w) * w >= 1), "N w of at least 1"),
    ("07.3", lambda w: np.sum(1 - (1 - w) ** 2), "two draws"),
    ("07.3", lambda w: 1 - np.sum((1 - w) ** len(w)), "belongs to every particle"),
    ("07.4", lambda w, x: np.sqrt((w @ x**2 - (w @ x) ** 2) / len(w)), "independent draws"),
    ("07.4", lambda w, x: stratified_by_cuts(w, x) * len(w), "for the *sum*"),
    ("07.4", lambda w, x: stratified_by_cuts(w, x) * len(w) ** 0.5, "enters a variance squared"),
    ("07.4", lambda w, x: stratified_by_cuts(w, x) ** 2, "That is the variance"),
    ("07.4", lambda w, x: sum(variance_in(part, x) ** 0.5 for part in strata(w)) / len(w), "add standard deviations"),
    ("07.4", lambda w, x: x.std() / len(x) ** 0.5, "plain mean of the old x"),
    ("08.1", nearest_in_space, "before you search"),
    ("08.2", lambda e: (np.median(e), np.std(e), np.mean(e <= 0.3)), "scatter about the mean"),
    ("08.3", lambda s, limit, patience: counted(s, limit, patience, lambda n: max(0, n - 1)), "down by one"),
    ("08.3", lambda s, limit, patience: counted(s, limit, patience, lambda n: n // 2), "is halved"),
    ("08.3", lambda s, limit, patience: counted(s, limit, patience, lambda n: n), "all low scores together"),
    ("08.3", windows, "stops with ValueError"),
    ("08.3", first_window_short, "In the first frames"),
    ("08.3", last_one, "last frame of an alarm"),
    ("08.3", never_is_t, "number of frames"),
    ("08.4", lambda n, a: n * (1 - a) / (1 + a), "limit of long runs"),
    ("08.4", lambda n, a: n / (1 + sum((1 - k / n) * a**k for k in range(1, n))), "counts twice"),
    ("08.4", lambda n, a: n / (1 + 2 * sum(a**k for k in range(1, n))), "only n - k"),
    ("08.4", lambda n, a: n / frames_of_pairs(n, a), "variance grows"),
    ("08.4", lambda n, a: n * (1 - a), "A guess?"),
    ("08.4", lambda n, a: n, "independent frames"),
    ("20.1", lambda raw, units, invalid: np.where(raw == 65535, np.nan, raw / units), "You take 65535"),
    ("20.1", lambda raw, units, invalid: metres(raw, units, invalid).round(3), "round to millimetres"),
    ("20.1", lambda raw, units, invalid: np.nan_to_num(metres(raw, units, invalid)), "A hole is 0 m"),
    ("20.2", lambda k, s: np.vstack([[k[0, 0] * s, 0, (k[0, 2] + 0.5) * s - 0.5], k[1:]]), "both directions"),
    ("20.2", lambda k, s: np.array([[s, 0, (s - 1) / 2], [0, s, (s - 1) / 2], [0, 0, 1]]) @ k // 1, "cut off"),
    ("20.3", lambda u, v, h, d: abs(np.median(baselines(u, v, h, d))), "drop the sign."),
    ("20.3", lambda u, v, h, d: np.median(abs(baselines(u, v, h, d))), "mark by mark"),
    ("20.3", lambda u, v, h, d: np.sort(baselines(u, v, h, d))[len(d) // 2], "upper of the middle two"),
    ("20.3", lambda u, v, h, d: np.sort(baselines(u, v, h, d))[(len(d) - 1) // 2], "lower of the middle two"),
    ("20.3", lambda u, v, h, d: np.median(d) * np.median(np.tan(np.pi * (u - v) / h)), "tangent of a difference"),
    ("20.4", lambda rho, rows, h, limit: rho**2 * 2**0.5 * np.pi * rows / h / limit, "far marks"),
    ("20.4", lambda rho, rows, h, limit: by_bisection(rho, rows / 2**0.5, h, limit), "Two rows are read"),
    ("20.4", lambda rho, rows, h, limit: by_bisection(rho, rows * 2**0.5, h, limit), "add the two rows' errors"),
    ("20.4", lambda rho, rows, h, limit: by_bisection(rho, 2 * rows, h, limit), "not 2 pi"),
    ("20.4", lambda rho, rows, h, limit: by_roots(rho, rows, h, limit) / 2, "half of it"),
    ("20.4", lambda rho, rows, h, limit: np.nan_to_num(by_roots(rho, rows, h, limit), nan=2 * rho), "asks for NaN"),
]
# Exercise, answer by another way than the solution.
RIGHT = [
    ("07.1", lambda y, w: (np.angle(w @ np.exp(1j * y)), length(y, w))),
    ("07.1", lambda y, w: [np.array([np.angle(w @ np.exp(1j * y))]), np.float32(length(y, w))]),
    ("07.2", lambda w: [(len(w) * w).astype(int), (len(w) * w % 1) / (len(w) - (len(w) * w).astype(int).sum())]),
    ("07.2", lambda w: ([int(len(w) * v) for v in w], to_sum_one([len(w) * v - int(len(w) * v) for v in w]))),
    ("07.3", lambda w: len(w) - sum((1 - share) ** len(w) for share in w)),
    ("07.3", lambda w: np.array([np.sum(1 - np.prod(np.tile(1 - w, (len(w), 1)), axis=0))])),
    ("07.4", stratified_by_cuts),
    ("07.4", stratified_by_covariance),
    ("08.1", lambda e, p: np.sqrt(((e[:, None, :2] - p[:, :2]) ** 2).sum(axis=-1)).min(axis=-1).astype(np.float32)),
    ("08.2", lambda e: np.array(row(e), dtype=np.float32)),
    ("08.2", lambda e: (np.quantile(e, 0.5), np.linalg.norm(e) / len(e) ** 0.5, sum(v <= 0.30 for v in e) / len(e))),
    ("08.3", by_strings),
    ("08.3", lambda s, limit, patience: counted(s, limit, patience, lambda n: 0)),
    ("08.4", frames_of_pairs),
    ("08.4", frames_in_closed_form),
    ("20.1", metres),
    ("20.2", lambda k, s: np.array([[s, 0, (s - 1) / 2], [0, s, (s - 1) / 2], [0, 0, 1]]) @ k),
    ("20.3", lambda u, v, h, d: np.array([np.median(baselines(u, v, h, d))])),
    ("20.4", by_bisection),
    ("20.4", by_roots),
]
