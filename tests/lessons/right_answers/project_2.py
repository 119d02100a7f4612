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


def penalties_by_loops(labels, places, hues, saturations, map_labels, map_places, map_hues, map_saturations):
    near, far = np.mean(places, axis=0), np.mean(map_places, axis=0)
    table = [[0.0] * len(map_labels) for _ in labels]
    for i, j in np.ndindex(len(labels), len(map_labels)):
        turn = abs((hues[i] - map_hues[j] + 180) % 360 - 180)
        c, m = math.dist(places[i], near), math.dist(map_places[j], far)
        table[i][j] = (0.0 if labels[i] == map_labels[j] else 100.0) + (0.0 if math.isnan(turn) else turn / 360)
        table[i][j] += abs(saturations[i] - map_saturations[j]) / 100 + abs(c - m) / max(m, 0.1)
    return table


def fit_by_complex_numbers(places, landmarks):
    if len(places) < 2 or np.ptp(places, axis=0).max() < 1e-3 or np.ptp(landmarks, axis=0).max() < 1e-3:
        return [math.nan] * 3
    a, b = (p[:, 0] + 1j * p[:, 1] for p in (places, landmarks))
    theta = cmath.phase(np.sum((a - a.mean()).conj() * (b - b.mean())))
    t = b.mean() - cmath.exp(1j * theta) * a.mean()
    return [t.real, t.imag, theta]


RIGHT = [
    ("P2.1", angles_by_direction),
    ("P2.2", pairs_by_sorting),
    ("P2.3", places_by_loop),
    ("P2.4", penalties_by_loops),
    ("P2.5", greedy_by_sorting),
    ("P2.6", fit_by_complex_numbers),
]
