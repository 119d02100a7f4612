"""Answers that students may give to lessons 14 to 17, for test_exercise_answers.py."""

import itertools
import math

import numpy as np
from scipy.optimize import least_squares, linear_sum_assignment

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo import fit_rigid_2d
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D, fit_covariance

PI = np.pi


# Lesson 14


def azimuth(box, width):
    return (0.5 - (box[0] + box[2]) / 2 / width) * 2 * PI


def elevation(box, width):
    return (0.5 - (box[1] + box[3]) / width) * PI


def place(u, lower, width, baseline, turn=None):
    """Without d: the horizontal range, and the height from it."""
    a = azimuth(u, width) if turn is None else turn
    e_u, e_l = elevation(u, width), elevation(lower, width)
    rho = baseline / (np.tan(e_l) - np.tan(e_u))
    return [rho * np.cos(a), rho * np.sin(a), rho * np.tan(e_u)]


def place_single(u, lower, width, baseline):
    return np.array(place(u, lower, width, baseline), dtype=np.float32)


def cut(box, width):
    return np.array([box[0], box[1], min(box[2], width), box[3]])


def remainder(box, width):
    return np.array([box[0], box[1], box[2] % width, box[3]])


def slope(e_u, e_l):
    return np.tan(e_l) - np.tan(e_u)


def sigma(rho, e_u, e_l, b, s, s_b):
    return np.sqrt((rho**2 / b * s) ** 2 * (np.cos(e_u) ** -4 + np.cos(e_l) ** -4) + (rho / b * s_b) ** 2)


def sigma_by_differences(rho, e_u, e_l, b, s, s_b):
    """Derivatives of (14.3) by small steps."""
    h = 1e-6

    def of(u, low, base):
        return base / (np.tan(low) - np.tan(u))

    by_u = (of(e_u + h, e_l, b) - of(e_u - h, e_l, b)) / (2 * h)
    by_l = (of(e_u, e_l + h, b) - of(e_u, e_l - h, b)) / (2 * h)
    by_b = (of(e_u, e_l, b + h) - of(e_u, e_l, b - h)) / (2 * h)
    return np.sqrt((by_u * s) ** 2 + (by_l * s) ** 2 + (by_b * s_b) ** 2)


def range_or_nan(slope_of):
    """A range from `slope_of(slopes)`, NaN where that is not positive."""

    def answer(e_u, e_l, b):
        one = slope_of(slope(e_u, e_l))
        return b / one if one > 0 else math.nan

    return answer


def of_positive(slopes):
    return np.median(slopes[slopes > 0]) if (slopes > 0).any() else -1


def inlier_mean(slopes):
    near = np.abs(slopes - np.median(slopes)) < 0.04
    return np.mean(slopes[near])


def hodges_lehmann(slopes):
    return np.median([(a + b) / 2 for a, b in itertools.combinations_with_replacement(slopes, 2)])


def median_of_ranges(e_u, e_l, b):
    return np.median(b / slope(e_u, e_l)) if np.median(slope(e_u, e_l)) > 0 else math.nan


def excess(rho, e_u, e_l, b, s):
    """Second derivatives by differences, to Taylor's second order."""
    h = 1e-3

    def of(u, low):
        return b / (np.tan(low) - np.tan(u))

    def second(f):
        return (-f(2 * h) + 16 * f(h) - 30 * f(0) + 16 * f(-h) - f(-2 * h)) / (12 * h**2)

    return s**2 / 2 * (second(lambda x: of(e_u + x, e_l)) + second(lambda x: of(e_u, e_l + x)))


def excess_of_slopes(rho, e_u, e_l, b, s):
    """By the slope's own mean and variance: E(B / s) = B / s (1 + var / s^2) - B / s^2 E(ds)."""
    steep = slope(e_u, e_l)
    variance = s**2 * (np.cos(e_u) ** -4 + np.cos(e_l) ** -4)
    shift = s**2 * (np.tan(e_l) / np.cos(e_l) ** 2 - np.tan(e_u) / np.cos(e_u) ** 2)
    return b / steep**3 * variance - b / steep**2 * shift


# Lesson 15


def circle(a, b):
    return np.minimum(np.abs(a - b), 360 - np.abs(a - b))


def far(points):
    return np.linalg.norm(points - points.mean(axis=0), axis=1)


def term(far_c, far_m, p_d, least=0.1):
    return p_d * np.abs(far_c[:, None] - far_m) / np.maximum(far_m, least)


def square(points):
    return ((points - points.mean(axis=0)) ** 2).sum(axis=1)


def margins_in_place(cost):
    found, margins = np.full(len(cost), -1), np.full(len(cost), np.nan)
    for _ in range(min(cost.shape)):
        i, j = np.unravel_index(cost.argmin(), cost.shape)
        found[i], margins[i] = j, np.min(np.delete(cost[i], j), initial=np.inf) - cost[i, j]
        cost[i], cost[:, j] = np.inf, np.inf
    return found, margins


def struck_with(blank, rounds=None):
    def answer(cost):
        table, found, margins = np.array(cost, float), np.full(len(cost), -1), np.full(len(cost), np.nan)
        for _ in range(min(cost.shape) if rounds is None else rounds(cost)):
            i, j = np.unravel_index(table.argmin(), table.shape)
            others = np.delete(table[i], j)
            found[i], margins[i] = j, others.min() - table[i, j] if len(others) else np.inf
            table[i], table[:, j] = blank, blank
        return found, margins

    return answer


def margins_by_lists(cost):
    """Lists of what is open, and plain loops."""
    n, m = cost.shape
    rows, columns, found, margins = list(range(n)), list(range(m)), [-1] * n, [math.nan] * n
    while rows and columns:
        _, i, j = min((cost[i, j], i, j) for i in rows for j in columns)
        found[i] = j
        margins[i] = min((cost[i, k] for k in columns if k != j), default=math.inf) - cost[i, j]
        rows.remove(i)
        columns.remove(j)
    return found, margins


def margins_by_sorting(cost):
    """Along the sorted list of all combinations."""
    found, margins, taken = np.full(len(cost), -1), np.full(len(cost), np.nan), set()
    for k in np.argsort(cost, axis=None):
        i, j = divmod(int(k), cost.shape[1])
        if found[i] < 0 and j not in taken:
            taken.add(j)
            left = [c for c in range(cost.shape[1]) if c not in taken]
            found[i], margins[i] = j, (cost[i, left].min() if left else np.inf) - cost[i, j]
    return found, margins


def masked_margins(cost):
    table = np.ma.masked_array(cost, np.zeros(cost.shape, bool))
    found, margins = np.full(len(cost), -1), np.full(len(cost), np.nan)
    while not table.mask.all():
        i, j = np.unravel_index(table.argmin(), table.shape)
        found[i], least = j, table[i, j]
        table.mask[i, j] = True
        margins[i] = np.inf if table.mask[i].all() else table[i].min() - least
        table.mask[i], table.mask[:, j] = True, True
    return found, margins


def least_sum(cost):
    found, margins = np.full(len(cost), -1), np.full(len(cost), np.nan)
    i, j = linear_sum_assignment(cost)
    found[i] = j
    margins[i] = [np.min(np.delete(cost[a], b), initial=np.inf) - cost[a, b] for a, b in zip(i, j, strict=True)]
    return found, margins


def shift_by_listing(places, n_hidden):
    """Every choice of the hidden ones."""
    centre, n = places.mean(axis=0), len(places)
    chosen = itertools.combinations(range(n), n - n_hidden)
    return math.sqrt(np.mean([((places[list(seen)].mean(axis=0) - centre) ** 2).sum() for seen in chosen]))


def shift_by_pairs(places, n_hidden):
    """The spread from the distances between places."""
    n = len(places)
    spread = np.sum((places[:, None] - places) ** 2) / (2 * n * (n - 1))
    return np.array([np.sqrt(spread * (1 / (n - n_hidden) - 1 / n))])


def shift_with_replacement(places, n_hidden):
    return math.sqrt(square(places).mean() / (len(places) - n_hidden))


# Lesson 16


def turned(points, theta):
    return np.stack([np.cos(theta) * points[:, 0] - np.sin(theta) * points[:, 1],
                     np.sin(theta) * points[:, 0] + np.cos(theta) * points[:, 1]], axis=1)  # fmt: skip


def weighted_complex(s, m, w, add=-1):
    """With complex numbers: a rotation is a factor of length 1."""
    s, m = s @ [1, 1j], m @ [1, 1j]
    s_g, m_g = (w @ s) / w.sum(), (w @ m) / w.sum()
    turn = (w * (m - m_g)) @ np.conj(s - s_g)
    turn /= abs(turn)
    t = m_g + add * turn * s_g
    return t.real, t.imag, np.angle(turn)


def weighted_svd(s, m, w, sign=True):
    s_g, m_g = w @ s / w.sum(), w @ m / w.sum()
    u, _, vt = np.linalg.svd((w[:, None] * (m - m_g)).T @ (s - s_g))
    turn = u @ np.diag([1, np.linalg.det(u @ vt) if sign else 1]) @ vt
    x, y = m_g - turn @ s_g
    return x, y, np.arctan2(turn[1, 0], turn[0, 0])


def by_least_squares(s, m, w):
    """A general optimizer with its default tolerances, from the plain fit on."""
    start = np.add(weighted_complex(s, m, np.ones(len(s))), [0.3, -0.2, 0.2])
    found = least_squares(
        lambda p: (np.sqrt(w)[:, None] * (turned(s, p[2]) + p[:2] - m)).ravel(), start, x_scale=[1, 1, 0.3]
    ).x
    return found[0], found[1], wrap_angle(found[2])


def repeated(s, m, w):
    """Weights as the library takes them."""
    return fit_rigid_2d(s, m, weights=w)


def full_circle(s, m, w):
    x, y, theta = weighted_complex(s, m, w)
    return x, y, theta % (2 * PI)


def by_arc(function, s, m, w):
    s_g, m_g = w @ s / w.sum(), w @ m / w.sum()
    a, b = s - s_g, m - m_g
    lengths = np.sqrt((w @ (a**2).sum(axis=1)) * (w @ (b**2).sum(axis=1)))
    total = {"cos": np.sum(a * b, axis=1), "sin": a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]}[function]
    theta = {"cos": np.arccos, "sin": np.arcsin}[function](np.clip(w @ total / lengths, -1, 1))
    x, y = m_g - turned(s_g[None], theta)[0]
    return x, y, theta


def sums(source, target):
    a, b = (points - points.mean(axis=0) for points in (source, target))
    return np.sum(a * b), np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]), np.sum(a**2)


def scale_by_svd(s, m, sign=True):
    a, b = s - s.mean(axis=0), m - m.mean(axis=0)
    d = np.linalg.svd(b.T @ a, compute_uv=False)
    return (d[0] + (np.sign(np.linalg.det(b.T @ a)) if sign else 1) * d[1]) / np.sum(a**2)


def left_over(source, target, k, everything=False, measure=lambda r: np.sum(r**2)):
    rest = np.arange(len(source)) != k
    residual = fit_rigid_2d(source[rest], target[rest]).apply(source) - target
    return measure(np.linalg.norm(residual[rest | everything], axis=1))


def each(source, target, **options):
    return [left_over(source, target, k, **options) for k in range(len(source))]


def bars_by_library(source, theta, covariances):
    pose = Pose2D(0.0, 0.0, theta)
    return np.sqrt(np.diag(fit_covariance(pose, source, pose.apply(source), noise=covariances)))


def bars_by_differences(source, theta, covariances):
    """Move every coordinate of every point a little, and fit again."""
    target, n, h = turned(source, theta), len(source), 1e-5
    rows = np.zeros((3, n, 2))
    for i in range(n):
        for k in range(2):
            step = np.zeros((n, 2))
            step[i, k] = h
            ends = [np.array(weighted_complex(source + way * step, target, np.ones(n))) for way in (1, -1)]
            rows[:, i, k] = (ends[0] - ends[1]) / (2 * h)
    return tuple(np.sqrt(np.einsum("ink,nkl,inl->i", rows, covariances, rows)))


def bars_of_the_lesson(source, theta, covariances):
    """The closed forms for round errors, with the mean size of the needles."""
    size = np.trace(covariances, axis1=1, axis2=2).mean() / 2
    return bars_by_library(source, theta, np.tile(size * np.eye(2), (len(source), 1, 1)))


# Lesson 17


def all_of_two(n_a, mean_a, std_a, n_b, mean_b, std_b):
    """Mean and deviation of two groups by their moments about zero."""
    first = (n_a * mean_a + n_b * mean_b) / (n_a + n_b)
    second = (n_a * (std_a**2 + mean_a**2) + n_b * (std_b**2 + mean_b**2)) / (n_a + n_b)
    return first, math.sqrt(max(second - first**2, 0.0))


def unable_by_listing(q):
    """Every case of seen and unseen."""
    cases = itertools.product((False, True), repeat=len(q))
    few = (case for case in cases if sum(case) < 2)
    return sum(math.prod(p if seen else 1 - p for p, seen in zip(q, case, strict=True)) for case in few)


def unable_by_recursion(q):
    """One object after the other: the chances of none and of one so far."""
    none, one = 1.0, 0.0
    for p in q:
        none, one = none * (1 - p), one * (1 - p) + none * p
    return none + one


def row(found, true, heading, keep=lambda found: ~np.isnan(found[:, 0])):
    d = found[keep(found)] - true[keep(found)]
    d[:, 2] = heading(d[:, 2])
    return np.concatenate([np.mean(np.abs(d), axis=0), np.std(np.abs(d), axis=0)])


def row_by_nan(found, true):
    """NaN functions leave unable poses out by themselves."""
    d = np.abs(found - true)
    d[:, 2] = np.degrees(np.abs((found - true)[:, 2] - 2 * PI * np.round((found - true)[:, 2] / (2 * PI))))
    return [*np.nanmean(d, axis=0), *np.nanstd(d, axis=0)]


def given_row(found, true, unable_leave=False, circle=False, lengths=False):
    """The code of the task, with some of its faults mended."""
    d = found - true
    d = d[~np.isnan(d[:, 0])] if unable_leave else np.nan_to_num(d)
    d[:, 2] = np.degrees(np.abs(wrap_angle(d[:, 2]))) if circle else np.degrees(d[:, 2]) % 180
    mean = np.abs(d).mean(axis=0) if lengths else np.abs(d.mean(axis=0))
    return np.concatenate([mean, np.abs(d).std(axis=0)])


# Exercise, answer, words of the hint that must come.
def fit_with_plain_place(source, target, weights):
    """The heading with weights, the place from plain centroids."""
    share = weights / weights.sum()
    a, b = source - share @ source, target - share @ target
    theta = np.arctan2(weights @ (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]), weights @ np.sum(a * b, axis=1))
    turn = np.array([[np.cos(theta), -np.sin(theta)], [np.sin(theta), np.cos(theta)]])
    x, y = target.mean(axis=0) - turn @ source.mean(axis=0)
    return x, y, theta


def farthest_off_the_others(source, target):
    off = []
    for k in range(len(source)):
        fit = fit_rigid_2d(np.delete(source, k, axis=0), np.delete(target, k, axis=0))
        off.append(np.linalg.norm(fit.apply(source[k : k + 1]) - target[k]))
    return np.argmax(off)


def scale_turned_around(source, target):
    """The target fitted to the source, and the scale's inverse."""
    a, b = (points - points.mean(axis=0) for points in (source, target))
    return np.sum(b**2) / np.hypot(np.sum(a * b), np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]))


def mean_error_by_differences(rho, u, e, b, sigma):
    """Second derivatives taken numerically."""

    def range_of(u, e):
        return b / (np.tan(e) - np.tan(u))

    h = 1e-4
    second = range_of(u + h, e) + range_of(u - h, e) + range_of(u, e + h) + range_of(u, e - h) - 4 * range_of(u, e)
    return sigma**2 / 2 * second / h**2


def row_sigma(rho, u, e, b, s):
    return rho**2 / b * s * np.hypot(1 / np.cos(u) ** 2, 1 / np.cos(e) ** 2)


def with_d_on_the_floor(u, lower, width, baseline):
    e_u, e_l = elevation(u, width), elevation(lower, width)
    d, a = baseline * np.cos(e_l) / np.sin(e_l - e_u), azimuth(u, width)
    return [d * np.cos(a), d * np.sin(a), d * np.tan(e_u)]


WRONG = [
    ("14.1", with_d_on_the_floor, "along the floor"),
    ("14.2", lambda rho, u, e, b, s, sb: np.hypot(row_sigma(rho, u, e, b, s), (rho / b) ** 2 * sb), "proportional"),
    ("14.3", lambda u, e, b: np.nan if (e < u).all() else b / np.mean(slope(u, e)), "spoils a mean"),
    (
        "14.3",
        lambda u, e, b: np.nan if (e < u).all() else np.median(b * np.cos(e) / np.sin(e - u)),
        "along the slanted ray",
    ),
    ("14.3", lambda u, e, b: np.nan if (e < u).any() else b / np.median(slope(u, e)), "as soon as one match"),
    ("14.4", lambda rho, u, e, b, s: mean_error_by_differences(rho, u, e, b, s) / rho, "share of the range"),
    (
        "15.4",
        lambda p, k: np.sqrt(k * np.sum((p - p.mean(axis=0)) ** 2) / len(p)) / (len(p) - k),
        "None is hidden twice",
    ),
    ("16.2", scale_turned_around, "turn that around"),
    ("16.3", farthest_off_the_others, "farthest off the fit of the others"),
    ("16.4", fit_with_plain_place, "*weighted* centroids"),
    ("16.4", lambda s, t, w: tuple(fit_rigid_2d(s[w > 0], t[w > 0])), "count all others alike"),
    ("14.1", lambda u, low, w, b: place(u, low, w, 0.3), "always 0.3 m"),
    ("14.1", lambda u, low, w, b: place(u, low, w, b)[:2], "shape (3,); yours has (2,)"),
    (
        "14.1",
        lambda u, low, w, b: np.array(place(u, low, w, b)) / np.linalg.norm(place(u, low, w, b)),
        "unit vector alone",
    ),
    ("14.1", lambda u, low, w, b: place(remainder(u, w), remainder(low, w), w, b), "a remainder the middle jumps"),
    ("14.1", lambda u, low, w, b: place(cut(u, w), cut(low, w), w, b), "greater than the width"),
    ("14.1", lambda u, low, w, b: place(u, low, w, b, turn=azimuth(low, w)), "the lower box's azimuth"),
    ("14.1", lambda u, low, w, b: place(u, low, w, b, turn=(azimuth(u, w) + azimuth(low, w)) / 2), "average"),
    ("14.1", lambda u, low, w, b: place(low, u, w, b), "behind the camera"),
    ("14.2", lambda *given: sigma(*given[:5], 0), "baseline is not known exactly"),
    ("14.2", lambda r, u, e, b, s, c: sigma(r, u, e, b, s, 0) + r / b * c, "under the root"),
    ("14.2", lambda r, u, e, b, s, c: np.hypot(sigma(r, u, e, b, s, 0), c), "grows with the range"),
    ("14.2", lambda r, u, e, b, s, c: sigma(r, np.radians(u), np.radians(e), b, s, c), "radians once more"),
    (
        "14.2",
        lambda r, u, e, b, s, c: np.hypot(r**2 / b * s * np.hypot(1 / np.cos(u), 1 / np.cos(e)), r / b * c),
        "square of 1 / cos^2",
    ),
    ("14.2", lambda r, u, e, b, s, c: np.hypot(sigma(r, u, e, b**2, s, 0), r / b * c), "counts once"),
    ("14.3", lambda u, e, b: b / np.median(np.abs(slope(u, e))), "negative slope"),
    ("14.3", lambda u, e, b: abs(b / np.median(-slope(u, e))), "NaN"),
    ("14.3", lambda u, e, b: b / np.median(slope(u, e)), "NaN belongs there"),
    ("14.3", lambda u, e, b: b / np.median(np.tan(e - u)), "difference of the two tangents"),
    ("14.3", lambda u, e, b: range_or_nan(lambda s: np.median(s) * b)(u, e, b), "baseline is missing"),
    ("14.3", lambda u, e, b: b / np.mean(slope(u, e)), "spoils a mean"),
    ("14.3", lambda u, e, b: [median_of_ranges(u, e, b)] * 2, "a single number"),
    ("14.4", lambda r, u, e, b, s: 2 * excess_of_slopes(r, u, e, b, s), "factor of one half"),
    ("14.4", lambda r, u, e, b, s: 2 * r**3 / b**2 * s**2, "level rays"),
    ("14.4", lambda r, u, e, b, s: sigma(r, u, e, b, s, 0), "the standard deviation"),
    ("14.4", lambda r, u, e, b, s: sigma(r, u, e, b, s, 0) ** 2 / r, "second part"),
    (
        "15.1",
        lambda a, b, p: np.where(np.isnan(a) & np.isnan(b), 0, p * circle(a, b) / 360),
        "One grey side is enough",
    ),
    ("15.1", lambda a, b, p: np.where(np.isnan(b), 0, p * circle(a, b) / 360), "observed object can be grey"),
    ("15.1", lambda a, b, p: np.where((a == np.nan) | (b == np.nan), 0, p * circle(a, b) / 360), "not NaN"),
    ("15.1", lambda a, b, p: np.nan_to_num(p * ((a - b) % 360) / 360), "one way around only"),
    ("15.2", lambda c, m, p: term(square(c), square(m), p), "root is missing"),
    ("15.2", lambda c, m, p: term(far(c), far(m), p).T, "other way round"),
    ("15.2", lambda c, m, p: term(far(c), far(m), p, 1), "at least 1 m"),
    ("15.2", lambda c, m, p: term(far(c), far(m), p, 0.01), "at least 0.01 m"),
    ("15.2", lambda c, m, p: p * np.maximum(np.abs(far(c)[:, None] - far(m)) / far(m), 0.1), "not the whole term"),
    ("15.3", margins_in_place, "changes the array"),
    *(("15.3", struck_with(blank), "cost can be larger") for blank in (1, 3, 10, 99, 100, 999)),
    ("15.3", struck_with(np.inf, lambda cost: min(cost.shape) - 1), "too early"),
    ("15.3", lambda cost: margins_by_lists(cost)[0], "Return 2 values"),
    ("15.3", least_sum, "never goes back"),
    ("15.4", shift_with_replacement, "with replacement"),
    ("15.4", lambda x, k: shift_by_listing(x, k) ** 2, "the root is missing"),
    ("15.4", lambda x, k: shift_by_listing(x, k) / math.sqrt(2), "along one axis"),
    ("16.1", lambda s, m, t: m.mean(axis=0) - turned(s, -t).mean(axis=0), "turn by -theta"),
    ("16.1", lambda s, m, t: m.mean(axis=0) + turned(s, t).mean(axis=0), "you add it"),
    ("16.1", lambda s, m, t: (m - turned(s, t))[0], "first pair"),
    ("16.1", lambda s, m, t: m - turned(s, t), "Return 2 values"),
    ("16.1", lambda s, m, t: m.mean(axis=0) - turned(s, np.radians(t)).mean(axis=0), "radians already"),
    ("16.2", lambda s, m: np.hypot(*sums(s, m)[:2]) ** 2 / sums(s, m)[2], "root of the sum of squares"),
    ("16.2", lambda s, m: np.hypot(*sums(s, m)[:2]) / np.sqrt(sums(s, m)[2]), "without a root"),
    ("16.2", lambda s, m: 2 * np.hypot(*sums(s, m)[:2]) / sums(s, m)[2], "the twos cancel"),
    ("16.2", lambda s, m: scale_by_svd(s, m, sign=False), "lets a mirror fit"),
    ("16.3", lambda s, m: np.argmax(far(s)), "farthest out"),
    ("16.3", lambda s, m: min(each(s, m)), "np.argmin"),
    ("16.3", lambda s, m: np.argmin(each(s, m)[:-1]), "never leave out the last"),
    ("16.3", lambda s, m: np.argmin(each(s, m, measure=np.sum)), "sum of their squares"),
    ("16.3", lambda s, m: np.argmin(each(s, m, measure=np.max)), "largest residual"),
    ("16.3", lambda s, m: np.argmin(each(s, m, measure=np.median)), "median"),
    ("16.4", lambda s, m, w: weighted_svd(s, m, w, sign=False), "may be a mirror"),
    ("16.4", lambda s, m, w: weighted_complex(s, m, w, add=1), "you add it"),
    ("16.4", lambda s, m, w: weighted_complex(s, m, np.ones(len(w))), "weights are not used"),
    ("16.4", lambda s, m, w: weighted_complex(s, m, w * w), "twice"),
    ("16.4", full_circle, "from -pi to pi"),
    ("16.4", lambda s, m, w: by_arc("cos", s, m, w), "loses the sign"),
    ("16.4", lambda s, m, w: by_arc("sin", s, m, w), "beyond a quarter"),
    ("16.5", bars_of_the_lesson, "round and alike"),
    ("16.5", lambda s, t, c: bars_by_library(s, 0.0, c), "turn by theta"),
    ("16.5", lambda s, t, c: bars_by_library(s, t, c) ** 2, "standard deviations"),
    ("17.1", lambda x, y, k, n: np.where(k - n < 2, -1, (n == 0) & (x <= 2) & (y <= 2)), "pairs *used*"),
    ("17.1", lambda x, y, k, n: np.where(n > 0, 0, np.where(k < 2, -1, (x <= 2) & (y <= 2))), "unable all the same"),
    ("17.1", lambda x, y, k, n: np.where(k < 2, -1, (n == 0) | (x <= 2) | (y <= 2)), "any one of them"),
    ("17.1", lambda x, y, k, n: np.where(k < 2, -1, (n == 0) & ((x <= 2) | (y <= 2))), "one of them is enough"),
    ("17.1", lambda x, y, k, n: np.where(k < 2, -1, (2 * n < k) & (x <= 2) & (y <= 2)), "minority"),
    (
        "17.1",
        lambda dx, dy, used, wrong: [int(w == 0 and x <= 2 and y <= 2) for x, y, w in zip(dx, dy, wrong, strict=True)],
        "unable",
    ),
    ("17.2", lambda n, m, s, k, p, t: ((n * m + k * p) / (n + k), (n * s + k * t) / (n + k)), "cannot be averaged"),
    ("17.2", lambda n, m, s, k, p, t: ((n * m + k * p) / (n + k), np.hypot(s, t)), "one beside the other"),
    ("17.2", lambda n, m, s, k, p, t: all_of_two(n, m, 0, k, p, 0), "own scatter is missing"),
    ("17.3", lambda q: unable_by_recursion(1 - q), "took q for the probability of missing"),
    ("17.3", lambda q: 1 - np.prod(1 - q), "at least one"),
    ("17.3", lambda q: np.prod(1 - q) * (1 + np.sum(q / (1 - q))), "divide by 1 - q = 0"),
    ("17.3", lambda q: unable_by_recursion(np.full(len(q), q.mean() if len(q) else 0)), "mean of q is not enough"),
    ("17.4", given_row, "the code as it was given"),
    ("17.4", lambda f, t: given_row(f, t, unable_leave=True, circle=True), "no mean error of 0 m"),
    ("17.4", lambda f, t: given_row(f, t, unable_leave=True, lengths=True), "exactly backwards"),
    ("17.4", lambda f, t: given_row(f, t, circle=True, lengths=True), "has no error"),
    ("17.4", lambda f, t: given_row(f, t, unable_leave=True), "Two faults are left"),
    ("17.4", lambda f, t: row(f, t, np.degrees), "on the circle"),
    ("17.4", lambda f, t: row(f, t, wrap_angle), "are radians"),
]
# Exercise, answer by another way than the solution.
RIGHT = [
    ("14.4", mean_error_by_differences),
    ("14.1", place),
    ("14.1", place_single),
    ("14.2", sigma),
    ("14.2", sigma_by_differences),
    ("14.3", range_or_nan(np.median)),
    ("14.3", range_or_nan(of_positive)),
    ("14.3", range_or_nan(inlier_mean)),
    ("14.3", range_or_nan(hodges_lehmann)),
    ("14.3", lambda u, e, b: np.array([median_of_ranges(u, e, b)])),
    ("14.4", excess_of_slopes),
    ("14.4", lambda *given: list(excess_of_slopes(*given))),
    ("15.1", lambda a, b, p: np.nan_to_num(p * np.abs((a - b + 180) % 360 - 180) / 360)),
    ("15.1", lambda a, b, p: [0 if x != x or y != y else p * circle(x, y) / 360 for x, y in zip(a, b, strict=True)]),
    ("15.2", lambda c, m, p: [[p * abs(one - other) / max(other, 0.1) for other in far(m)] for one in far(c)]),
    ("15.2", lambda c, m, p: term(far(c), far(m), p).astype(np.float32)),
    ("15.3", margins_by_lists),
    ("15.3", margins_by_sorting),
    ("15.3", masked_margins),
    ("15.4", shift_by_listing),
    ("15.4", shift_by_pairs),
    ("16.1", lambda s, m, t: (m - turned(s, t)).mean(axis=0)),
    ("16.1", lambda s, m, t: [float(v) for v in m.mean(axis=0) - turned(s.mean(axis=0)[None], t)[0]]),
    ("16.2", lambda s, m: math.sqrt(sums(s, m)[0] ** 2 + sums(s, m)[1] ** 2) / sums(s, m)[2]),
    ("16.2", lambda s, m: np.array([scale_by_svd(s, m)])),
    ("16.3", lambda s, m: np.argmin(np.sqrt(each(s, m)))),
    ("16.3", lambda s, m: int(np.argmin([np.mean(r) for r in each(s, m, measure=lambda r: r**2)]))),
    ("16.4", weighted_complex),
    ("16.4", weighted_svd),
    ("16.4", by_least_squares),
    ("16.4", repeated),
    ("16.5", bars_by_library),
    ("16.5", bars_by_differences),
    (
        "17.1",
        lambda dx, dy, used, wrong: [
            -1 if u < 2 else int(not w and max(x, y) <= 2) for x, y, u, w in zip(dx, dy, used, wrong, strict=True)
        ],
    ),
    ("17.1", lambda x, y, k, n: (k > 1) * ((n == 0) & (np.fmax(x, y) <= 2)) - 1.0 * (k <= 1)),
    ("17.2", all_of_two),
    ("17.2", lambda *given: np.array(all_of_two(*given), dtype=np.float32)),
    ("17.3", unable_by_listing),
    ("17.3", unable_by_recursion),
    ("17.4", lambda f, t: row(f, t, lambda turn: np.degrees(np.angle(np.exp(1j * turn))))),
    ("17.4", row_by_nan),
]
