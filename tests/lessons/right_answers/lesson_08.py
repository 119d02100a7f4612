"""Right answers to the exercises of lesson 08 by other ways than the solution's."""

import numpy as np
from scipy.spatial import cKDTree


def by_strings(scores, limit, patience):
    at = "".join("L" if score < limit else "h" for score in scores).find("L" * patience)
    return at + patience - 1 if at >= 0 else -1


def by_a_counter(scores, limit, patience):
    n = 0
    for frame in range(len(scores)):
        n = 0 if scores[frame] >= limit else n + 1
        if n >= patience:
            return frame
    return -1


ANSWERS = {
    "08.1": [
        lambda e, p: np.sqrt(((e[:, None, :2] - p[:, :2]) ** 2).sum(axis=-1)).min(axis=-1).astype(np.float32),
        lambda e, p: [min(np.hypot(*(q - r)[:2]) for r in p) for q in e],
        lambda e, p: cKDTree(p[:, :2]).query(e[:, :2])[0],
    ],
    "08.2": [
        lambda e: (np.quantile(e, 0.5), np.linalg.norm(e) / len(e) ** 0.5, sum(e <= 0.3) / len(e)),
        lambda e: np.array([np.quantile(e, 0.5), np.linalg.norm(e) / len(e) ** 0.5, sum(e <= 0.3) / len(e)]),
        lambda e: np.array([np.median(e), np.sqrt(np.mean(e**2)), np.mean(e <= 0.30)], dtype=np.float32),
        lambda e: [np.median(e), np.sqrt(e @ e / e.size), np.count_nonzero(e <= 0.30) / e.size],
    ],
    "08.3": [
        by_strings,
        by_a_counter,
        lambda s, limit, p: next((f for f in range(p - 1, len(s)) if all(s[f - p + 1 : f + 1] < limit)), -1),
    ],
    "08.4": [
        lambda n, a: n**2 / np.sum(float(a) ** np.abs(np.subtract.outer(np.arange(n), np.arange(n)))),
        lambda n, a: 1.0 if a == 1 else n**2 / (n * (1 + a) / (1 - a) - 2 * a * (1 - a**n) / (1 - a) ** 2),
        lambda n, a: n / (1 + 2 * sum((n - k) / n * a**k for k in range(1, n))),
    ],
}
RIGHT = [(number, answer) for number, answers in ANSWERS.items() for answer in answers]
