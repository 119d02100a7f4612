"""Answers to the stages of projects P1 and P4."""

import collections
import itertools
import math

import numpy as np

from course_lib.lessons.project_1 import exercises as p1


def by_rotation_matrices(particles, sigma, noise):
    moved = []
    for particle, n in zip(particles, noise, strict=True):
        step = sigma * n
        c, s = math.cos(particle[5]), math.sin(particle[5])
        x, y = np.array([[c, -s], [s, c]]) @ step[:2]
        moved.append([particle[0] + x, particle[1] + y, *(particle[2:] + step[2:])])
    return moved


def by_complex_numbers(particles, sigma, noise):
    step = sigma * noise
    xy = particles[:, 0] + 1j * particles[:, 1] + (step[:, 0] + 1j * step[:, 1]) * np.exp(1j * particles[:, 5])
    return np.column_stack([xy.real, xy.imag, particles[:, 2:] + step[:, 2:]])


def wrapped_into_the_circle(particles, sigma, noise):
    moved = np.array(by_rotation_matrices(particles, sigma, noise))
    moved[:, 5] = np.mod(moved[:, 5] + np.pi, 2 * np.pi) - np.pi
    return moved


def left_is_right(particles, sigma, noise):
    return by_rotation_matrices(particles, sigma, noise * [1, -1, 1, 1, 1, 1])


def by_loops(measured, simulated, alpha):
    found = []
    for image in simulated:
        total = 0.0
        for z, s in zip(measured.ravel(), image.ravel(), strict=True):
            if not math.isnan(z):
                total += 0.0 if math.isinf(s) else 1 - abs(z - s) / (alpha + abs(z - s))
        found.append(total)
    return found


def by_nansum(measured, simulated, alpha):
    return np.nansum(alpha / (alpha + np.abs(measured[None] - simulated)), axis=(1, 2))


def as_printed(measured, simulated, alpha):
    difference = np.abs(measured - simulated)
    return np.nansum(1 - difference / (alpha + difference), axis=(1, 2)) * 1.0 + np.isinf(difference).sum(axis=(1, 2))


def weights_by_logarithms(values, beta):
    spread = max(values) - min(values)
    if spread == 0:
        return [1 / len(values)] * len(values)
    logs = [-(((v - max(values)) / spread / beta) ** 2) for v in values]
    total = sum(math.exp(x) for x in logs)
    return [math.exp(x) / total for x in logs]


def min_max_only_where_it_can(values, beta):
    w = np.exp(-(((values - values.min()) / (np.ptp(values) + 1e-300) - 1) ** 2) / beta**2)
    return w / w.sum()


def with_nan_to_num(values, beta):
    with np.errstate(all="ignore"):
        normalized = np.nan_to_num((values - values.min()) / np.ptp(values))
    w = np.exp(-((normalized - 1) ** 2) / beta**2)
    return w / w.sum()


def by_arrows(particles, w):
    arrows = (w[:, None] * np.exp(1j * particles[:, 3:])).sum(axis=0)
    return [*np.average(particles[:, :3], axis=0, weights=w), *np.angle(arrows)]


def about_the_first(particles, w):
    off = (particles - particles[0] + [0, 0, 0, *[math.pi] * 3]) % (2 * math.pi) - [0, 0, 0, *[math.pi] * 3]
    mean = particles[0] + np.concatenate([w @ (particles - particles[0])[:, :3], w @ off[:, 3:]])
    mean[3:] = (mean[3:] + np.pi) % (2 * np.pi) - np.pi
    return mean


def walking_along(w, u):
    """A pointer that only moves on."""
    found, i, reached = [], 0, 0.0
    heavy = np.flatnonzero(w)
    for k in range(len(w)):
        point = (k + u) / len(w)
        while reached + w[i] <= point and i < heavy[-1]:
            reached += w[i]
            i += 1
        found.append(i)
    return found


def by_counting(w, u):
    ends = np.cumsum(w)
    ends[np.flatnonzero(w)[-1] :] = 1.0
    upto = np.ceil(len(w) * ends - u).astype(int).clip(0, len(w))
    return np.repeat(np.arange(len(w)), np.diff(upto, prepend=0))


def one_round_in_one_breath(particles, measured, render, sigma, beta, noise, u):
    moved = np.array(by_rotation_matrices(particles, sigma, noise))
    w = np.array(weights_by_logarithms(by_nansum(measured, render(moved), 0.1), beta))
    return by_arrows(moved, w), moved[walking_along(w, u)]


def noise_forgotten_twice(particles, measured, render, sigma, beta, noise, u):
    found, kept = p1.one_round(particles, measured, render, sigma, beta, noise, u)
    return found, p1.propagate(kept, sigma, noise)


def raw_likelihoods_as_weights(particles, measured, render, sigma, beta, noise, u):
    moved = p1.propagate(particles, sigma, noise)
    w = p1.likelihood(measured, render(moved), 0.1)
    w = w / w.sum()
    return p1.estimate(moved, w), moved[p1.resample(w, u)]


def by_counter(raw):
    return collections.Counter(np.ravel(raw).tolist()).most_common(1)[0][0]


def the_extreme_that_is_alone(raw):
    numbers = np.unique(raw).astype(int)
    gaps = np.diff(numbers)
    return int(numbers[0] if gaps[0] > gaps[-1] else numbers[-1])


def by_moments(numbers, distances):
    d = distances - distances.mean()
    slope = (d * numbers).sum() / (d**2).sum()
    return np.array([slope, numbers.mean() / slope - distances.mean()])


def by_its_ends(numbers, distances):
    slope = (numbers[-1] - numbers[0]) / (distances[-1] - distances[0])
    return [slope, numbers[0] / slope - distances[0]]


def by_a_line(ranges, distance):
    v, u = np.indices(ranges.shape)
    s = (u - (ranges.shape[1] - 1) / 2) ** 2 + (v - (ranges.shape[0] - 1) / 2) ** 2
    y = (ranges / distance) ** 2 - 1
    used = np.isfinite(y)
    return math.sqrt(np.sum(s[used] ** 2) / np.sum(s[used] * y[used]))


def drawn_without_weightless(w, u):
    heavy = np.flatnonzero(w)
    ends = np.cumsum(w[heavy])
    return heavy[np.searchsorted(ends / ends[-1], (np.arange(len(w)) + u) / len(w))]


def drawn_from_the_left(w, u):
    return np.minimum(np.searchsorted(np.cumsum(w), (np.arange(len(w)) + u) / len(w)), len(w) - 1)


def only_what_a_wagon_does(particles, sigma, noise):
    moved = np.array(by_rotation_matrices(particles, sigma, noise))
    moved[:, 2:5] = particles[:, 2:5]
    return moved


def by_the_corner(ranges, distance):
    """One corner, measured or not."""
    height, width = ranges.shape
    square = ((width - 1) ** 2 + (height - 1) ** 2) / 4
    return np.array([math.sqrt(square / ((ranges[0, 0] / distance) ** 2 - 1))])


def half_a_pixel_by_width(ranges, distance):
    v, u = np.indices(ranges.shape)
    s = (u - ranges.shape[1] / 2) ** 2 + (v - ranges.shape[0] / 2) ** 2
    used = np.isfinite(ranges) & (s > 0)
    with np.errstate(divide="ignore"):
        return np.sqrt(np.median(s[used] / ((ranges[used] / distance) ** 2 - 1)))


def by_normal_equations(measured, true, repeat):
    p = 8 * np.pi * measured / repeat
    a = np.column_stack([p**0, np.sin(p), np.cos(p)])
    return np.linalg.solve(a.T @ a, a.T @ (measured - true)).tolist()


def by_loops_over_pixels(depth, tolerance):
    height, width = depth.shape
    found = np.zeros(depth.shape, dtype=bool)
    for v in range(height):
        for u in range(width):
            if math.isnan(depth[v, u]):
                continue
            found[v, u] = True
            for dv, du in ((0, 1), (0, -1), (1, 0), (-1, 0)):
                if 0 <= v + 2 * dv < height and 0 <= u + 2 * du < width:
                    one, two = depth[v + dv, u + du], depth[v + 2 * dv, u + 2 * du]
                    if abs(2 / one - 1 / two - 1 / depth[v, u]) * depth[v, u] ** 2 <= tolerance:
                        found[v, u] = False
    return found


def between_its_neighbours(depth, tolerance):
    left, right = np.roll(depth, 1, axis=1), np.roll(depth, -1, axis=1)
    with np.errstate(invalid="ignore"):
        return (np.minimum(left, right) + tolerance < depth) & (depth < np.maximum(left, right) - tolerance)


def noise_by_loops(frames, edges):
    found = [[] for _ in edges[:-1]]
    for series in frames.reshape(len(frames), -1).T:
        mean = series.mean()
        for i in range(len(edges) - 1):
            if edges[i] <= mean < edges[i + 1]:
                found[i].append(((series - mean) ** 2).sum() / (len(series) - 1))
    return [math.sqrt(sum(f) / len(f)) if f else math.nan for f in found]


def nan_ignored(frames, edges):
    """Pixels that were measured now and then take part."""
    count = np.isfinite(frames).sum(axis=0)
    mean = np.nansum(frames, axis=0) / np.maximum(count, 1)
    variance = np.nansum((frames - mean) ** 2, axis=0) / np.maximum(count - 1, 1)
    inside = [(count > 1) & (mean >= a) & (mean < b) for a, b in itertools.pairwise(edges)]
    return [np.sqrt(variance[i].mean()) if i.any() else np.nan for i in inside]


def chain_by_loops(raw, invalid, units, coefficients, pattern, focal, repeat):
    height, width = raw.shape
    found = np.full(raw.shape, np.nan)
    for v in range(height):
        for u in range(width):
            if raw[v, u] != invalid:
                m = float(raw[v, u]) / units
                p = 8 * math.pi * m / repeat
                r = m - coefficients @ [1, math.sin(p), math.cos(p)] - pattern[v, u]
                found[v, u] = r / math.hypot(1, (u - (width - 1) / 2) / focal, (v - (height - 1) / 2) / focal)
    return found


def pattern_before_the_wave(raw, invalid, units, coefficients, pattern, focal, repeat):
    m = np.where(raw == invalid, np.nan, raw / units) - pattern
    p = 8 * np.pi * m / repeat
    v, u = np.indices(raw.shape)
    length = np.sqrt(1 + ((u - (raw.shape[1] - 1) / 2) ** 2 + (v - (raw.shape[0] - 1) / 2) ** 2) / focal**2)
    return (m - coefficients[0] - coefficients[1] * np.sin(p) - coefficients[2] * np.cos(p)) / length


WRONG = [
    ("P4.1", the_extreme_that_is_alone, "Right on"),
    ("P4.1", lambda raw: 0 if (raw == 0).any() else 65_535, "Right on"),
    ("P4.1", lambda raw: np.unique(raw, return_counts=True)[1].argmax(), "place in a list"),
    ("P4.2", lambda n, d: tuple(np.polyfit(n, d, 1)), "numbers a metre"),
    ("P4.2", lambda n, d: (np.mean(n / d), 0.0), "mean of quotients"),
    ("P4.2", lambda n, d: by_moments(n, d)[0], "Return 2 values"),
    ("P4.3", half_a_pixel_by_width, "Half a pixel"),
    ("P4.3", by_the_corner, "need not have been measured"),
    ("P4.1", lambda raw: raw[0, 0, 0], "first pixel"),
    ("P1.2", only_what_a_wagon_does, "six numbers"),
    ("P1.6", drawn_from_the_left, "weight 0"),
    ("P4.3", lambda r, d: by_a_line(r, d) ** 2, "square of the focal length"),
    ("P4.3", lambda r, d: by_a_line(r, d) * d, "pixels times metres"),
    ("P4.4", lambda m, t, repeat: by_normal_equations(m, t, repeat / 4), "sixteen"),
    ("P4.4", lambda m, t, repeat: by_normal_equations(m, 2 * m - t, repeat), "other sign"),
    ("P4.4", lambda m, t, repeat: by_normal_equations(m, t, 9.993), "given"),
    ("P4.5", between_its_neighbours, "between"),
    ("P4.5", lambda z, t: by_loops_over_pixels(z, t) | np.isnan(z), "does not fly"),
    ("P4.5", lambda z, t: by_loops_over_pixels(z, t / 2), "Right on"),
    ("P4.6", nan_ignored, "now and then"),
    ("P4.6", lambda f, e: np.array(noise_by_loops(f, e)) ** 2, "root"),
    ("P4.6", lambda f, e: np.array(noise_by_loops(f, e)) * 1000, "millimetres"),
    ("P4.7", pattern_before_the_wave, "phase"),
    ("P4.7", lambda raw, i, k, c, p, f, r: chain_by_loops(raw, i, k, c, -p, f, r), "add the pattern"),
    ("P4.7", lambda raw, i, k, c, p, f, r: chain_by_loops(raw, 0, k, c, p, f, r), "0 for the code"),
    ("P1.1", lambda state0, n: np.array([state0] * n).T, "column a particle"),
    ("P1.1", lambda state0, n: np.zeros((n, 6)), "differ on every input"),
    ("P1.1", lambda state0, n: [state0] * (n + 1), "one particle too many"),
    ("P1.2", left_is_right, "Left and right"),
    ("P1.2", lambda p, s, n: p + s * n, "world's axes"),
    ("P1.2", lambda p, s, n: by_complex_numbers(p * [1, 1, 1, 1, 1, np.pi / 180], s, n), "radians already"),
    ("P1.3", as_printed, "counts as perfect"),
    ("P1.3", lambda m, s, a: by_nansum(m, s, a) / m.size, "all pixels"),
    ("P1.3", lambda m, s, a: by_nansum(np.nan_to_num(m), s, a), "not a wall at 0 m"),
    ("P1.4", min_max_only_where_it_can, "0/0"),
    ("P1.4", with_nan_to_num, "0/0"),
    ("P1.4", lambda v, b: np.exp(v / b) / np.exp(v / b).sum(), "NaN"),
    ("P1.4", lambda v, b: p1.particle_weights(v, b) * len(v), "sum to one"),
    ("P1.5", lambda p, w: np.average(p, axis=0, weights=w), "as printed"),
    ("P1.5", lambda p, w: p[np.argmax(w)], "heaviest"),
    ("P1.5", lambda p, w: by_arrows(p, w)[:3], "shape (6,)"),
    ("P1.6", lambda w, u: np.sort(np.argsort(-w, kind="stable")), "whatever it weighs"),
    ("P1.6", lambda w, u: np.searchsorted(np.cumsum(w), np.arange(len(w)) / len(w), side="right"), "start at 0"),
    ("P1.6", lambda w, u: np.repeat(np.arange(len(w)), np.floor(len(w) * w).astype(int)), "shape"),
    ("P1.7", noise_forgotten_twice, "move twice"),
    ("P1.7", raw_likelihoods_as_weights, "likelihoods"),
    ("P1.7", lambda p, m, render, s, b, n, u: p1.one_round(p, m, render, s, 0.01, n, u), "beta"),
]
RIGHT = [
    ("P4.1", by_counter),
    ("P4.1", lambda raw: np.bincount(raw.ravel()).argmax()),
    ("P4.2", by_moments),
    ("P4.2", by_its_ends),
    ("P4.3", by_a_line),
    ("P4.4", by_normal_equations),
    ("P4.4", lambda m, t, repeat: np.array(by_normal_equations(m, t, repeat), np.float32)),
    ("P4.5", by_loops_over_pixels),
    ("P4.5", lambda z, t: by_loops_over_pixels(z, t).astype(int).tolist()),
    ("P4.6", noise_by_loops),
    ("P4.6", lambda f, e: np.array(noise_by_loops(f, e), np.float32)),
    ("P4.7", chain_by_loops),
    ("P4.7", lambda *given: chain_by_loops(*given).astype(np.float32)),
    ("P1.1", lambda state0, n: [list(state0) for _ in range(n)]),
    ("P1.1", lambda state0, n: np.repeat(state0[None], n, axis=0)),
    ("P1.1", lambda state0, n: np.ones((n, 1)) * state0),
    ("P1.2", by_rotation_matrices),
    ("P1.2", by_complex_numbers),
    ("P1.2", wrapped_into_the_circle),
    ("P1.3", by_loops),
    ("P1.3", by_nansum),
    ("P1.3", lambda m, s, a: by_nansum(m, s, a).astype(np.float32)),
    ("P1.4", weights_by_logarithms),
    ("P1.4", lambda v, b: np.array(weights_by_logarithms(v, b), np.float32)),
    ("P1.5", by_arrows),
    ("P1.5", lambda p, w: np.array(by_arrows(p, w), np.float32)),
    ("P1.6", walking_along),
    ("P1.6", by_counting),
    ("P1.6", drawn_without_weightless),
    ("P1.7", one_round_in_one_breath),
    ("P1.7", lambda *given: list(one_round_in_one_breath(*given))),
]
