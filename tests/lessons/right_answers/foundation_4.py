"""Right answers to F4 by other ways than its solutions."""

import numpy as np


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def cameras_by_null_vectors(R, c):
    """E forth = 0 and back E = 0; the signs come from c."""
    E = R.T @ np.cross(np.eye(3), c)
    U, _, Vt = np.linalg.svd(E)
    return [Vt[2] * np.sign(Vt[2] @ c), U[:, 2] * np.sign(U[:, 2] @ (-R.T @ c))]


def distance_by_least_squares(x1, x2, R, c):
    """Both lengths of d1 x1 - d2 y = c, match by match."""
    pairs = [np.linalg.lstsq(np.array([a, -R @ b]).T, c, rcond=None)[0] for a, b in zip(x1, x2, strict=True)]
    return np.array([d1 if min(d1, d2) > 0 else np.nan for d1, d2 in pairs])


def sigma_by_differences(x1, x2, R, c, sigma):
    """Turn one ray at a time by a little within the plane."""

    def d1(angle_1, angle_2):
        return np.linalg.norm(c) * np.sin(angle_2) / np.sin(angle_1 + angle_2)

    angles = np.arccos(x1 @ unit(c)), np.arccos(x2 @ unit(-R.T @ c))
    steps = [(d1(*(angles + 1e-6 * way)) - d1(*(angles - 1e-6 * way))) / 2e-6 for way in np.eye(2)[:, :, None]]
    return sigma * np.hypot(*steps)


RIGHT = [
    ("F4.1", cameras_by_null_vectors),
    ("F4.2", distance_by_least_squares),
    ("F4.3", sigma_by_differences),
]
