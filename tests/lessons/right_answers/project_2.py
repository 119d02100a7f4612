"""Right answers to project 2 by other ways than its solutions."""

import cmath
import math

import numpy as np

from course_lib.spherical_stereo import pixel_to_direction

PI = math.pi


def angles_by_direction(box, width):
    """The library's direction, and its angles: a list of arrays of shape (1,)."""
    x, y, z = pixel_to_direction([(box[0] + box[2]) / 2, (box[1] + box[3]) / 2], width, width // 2)
    return [np.array([math.atan2(y, x) if abs(math.atan2(y, x) - PI) > 1e-12 else -PI]), np.array([math.asin(z)])]


def angles_of_a_wrapped_column(box, width):
    u = (box[0] + box[2]) / 2
    return PI - 2 * PI * (u - width if u >= width else u) / width, PI / 2 - PI * (box[1] + box[3]) / width


def greedy_by_sorting(cost, limit=100):
    """Take all pairs in the order of their cost, each if both are still free."""
    found = [-1] * len(cost)
    for _, i, j in sorted((c, i, j) for i, row in enumerate(cost) for j, c in enumerate(row) if c < limit):
        if found[i] < 0 and j not in found:
            found[i] = j
    return found


def pairs_by_sorting(upper_labels, upper, lower_labels, lower, largest):
    gaps = [[abs(cmath.phase(cmath.exp(1j * (a - b)))) for b, _ in lower] for a, _ in upper]
    for i, j in np.ndindex(len(upper), len(lower)):
        if upper_labels[i] != lower_labels[j] or lower[j][1] <= upper[i][1] or gaps[i][j] > largest:
            gaps[i][j] = math.inf
    return greedy_by_sorting(gaps, math.inf)


def places_by_loop(upper, lower, baseline):
    rows = []
    for (a, e), (_, f) in zip(upper, lower, strict=True):
        d = baseline * math.cos(f) / math.sin(f - e) if f - e > 0.001 else math.nan
        rows.append([d * math.cos(e) * math.cos(a), d * math.cos(e) * math.sin(a)])
    return np.array(rows).reshape(-1, 2)


def places_by_complex_numbers(upper, lower, baseline):
    gone = lower[:, 1] - upper[:, 1] <= 1e-3
    z = baseline / np.where(gone, np.nan, np.tan(lower[:, 1]) - np.tan(upper[:, 1])) * np.exp(1j * upper[:, 0])
    return np.stack([z.real, z.imag], axis=1)


def penalties_by_loops(labels, places, hues, saturations, map_labels, map_places, map_hues, map_saturations):
    near, far = np.mean(places, axis=0), np.mean(map_places, axis=0)
    table = [[0.0] * len(map_labels) for _ in labels]
    for i, j in np.ndindex(len(labels), len(map_labels)):
        turn = abs((hues[i] - map_hues[j] + 180) % 360 - 180)
        c, m = math.dist(places[i], near), math.dist(map_places[j], far)
        table[i][j] = (0.0 if labels[i] == map_labels[j] else 100.0) + (0.0 if math.isnan(turn) else turn / 360)
        table[i][j] += abs(saturations[i] - map_saturations[j]) / 100 + abs(c - m) / max(m, 0.1)
    return table


def penalties_by_phases(labels, places, hues, saturations, map_labels, map_places, map_hues, map_saturations):
    a, b = (np.exp(1j * np.radians(h)) for h in (hues, map_hues))
    turn = np.nan_to_num(np.abs(np.degrees(np.angle(a[:, None] * b.conj()))))
    c, m = (np.hypot(*(p - p.mean(axis=0)).T) for p in (places, map_places))
    table = turn / 360 + np.abs(saturations[:, None] - map_saturations) / 100
    return table + np.abs(c[:, None] - m) / np.clip(m, 0.1, None) + np.where(labels[:, None] == map_labels, 0, 100)


def greedy_that_stops_at_100(cost):
    """No pair of 100 or more is used, so one may stop there: what is left would all be left out."""
    cost, found = cost.copy(), np.full(len(cost), -1)
    while cost.min() < 100:
        i, j = np.unravel_index(cost.argmin(), cost.shape)
        found[i], cost[i], cost[:, j] = j, 1e9, 1e9
    return found


def fit_by_complex_numbers(places, landmarks):
    if len(places) < 2 or np.ptp(places, axis=0).max() < 1e-3 or np.ptp(landmarks, axis=0).max() < 1e-3:
        return [math.nan] * 3
    a, b = (p[:, 0] + 1j * p[:, 1] for p in (places, landmarks))
    theta = cmath.phase(np.sum((a - a.mean()).conj() * (b - b.mean())))
    t = b.mean() - cmath.exp(1j * theta) * a.mean()
    return [t.real, t.imag, theta]


def fit_by_svd(places, landmarks):
    if np.isnan(fit_by_complex_numbers(places, landmarks)[0]):
        return np.full(3, np.nan)
    a, b = places - places.mean(axis=0), landmarks - landmarks.mean(axis=0)
    u, _, vt = np.linalg.svd(b.T @ a)
    r = u @ np.diag([1, np.linalg.det(u @ vt)]) @ vt
    return np.array([*(landmarks.mean(axis=0) - r @ places.mean(axis=0)), np.arctan2(r[1, 0], r[0, 0])])


# fmt: off
RIGHT = [
    ("P2.1", angles_by_direction), ("P2.1", angles_of_a_wrapped_column),
    ("P2.1", lambda *given: np.array(angles_of_a_wrapped_column(*given), np.float32)),
    ("P2.2", pairs_by_sorting), ("P2.2", lambda *given: np.array(pairs_by_sorting(*given), np.float32)),
    ("P2.3", places_by_loop), ("P2.3", places_by_complex_numbers),
    ("P2.4", penalties_by_loops), ("P2.4", penalties_by_phases),
    ("P2.5", greedy_by_sorting), ("P2.5", greedy_that_stops_at_100),
    ("P2.6", fit_by_complex_numbers), ("P2.6", fit_by_svd),
]
