"""Right answers to lesson 16 by other ways than its solutions."""

import numpy as np
from scipy.optimize import least_squares

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo import fit_rigid_2d
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D, fit_covariance


def turned(points, theta):
    return np.stack([np.cos(theta) * points[:, 0] - np.sin(theta) * points[:, 1],
                     np.sin(theta) * points[:, 0] + np.cos(theta) * points[:, 1]], axis=1)  # fmt: skip


def sums(source, target):
    a, b = (points - points.mean(axis=0) for points in (source, target))
    return np.sum(a * b), np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]), np.sum(a**2)


def scale_by_svd(s, m):
    a, b = s - s.mean(axis=0), m - m.mean(axis=0)
    d = np.linalg.svd(b.T @ a, compute_uv=False)
    return (d[0] + np.sign(np.linalg.det(b.T @ a)) * d[1]) / np.sum(a**2)


def scale_by_search(source, target):
    theta = weighted_svd(source, target, np.ones(len(source)))[2]
    a, b = source - source.mean(axis=0), target - target.mean(axis=0)
    return np.linalg.lstsq(turned(a, theta).reshape(-1, 1), b.reshape(-1), rcond=None)[0][0]


def rests(source, target):
    """The lengths of the residuals without each pair."""
    fits = [fit_rigid_2d(np.delete(source, k, 0), np.delete(target, k, 0)) for k in range(len(source))]
    return [np.linalg.norm(np.delete(fit.apply(source) - target, k, 0), axis=1) for k, fit in enumerate(fits)]


def weighted_complex(s, m, w):
    """With complex numbers: a rotation is a factor of length 1."""
    s, m = s @ [1, 1j], m @ [1, 1j]
    s_g, m_g = (w @ s) / w.sum(), (w @ m) / w.sum()
    turn = (w * (m - m_g)) @ np.conj(s - s_g)
    turn /= abs(turn)
    t = m_g - turn * s_g
    return t.real, t.imag, np.angle(turn)


def weighted_svd(s, m, w):
    s_g, m_g = w @ s / w.sum(), w @ m / w.sum()
    u, _, vt = np.linalg.svd((w[:, None] * (m - m_g)).T @ (s - s_g))
    turn = u @ np.diag([1, np.linalg.det(u @ vt)]) @ vt
    return *(m_g - turn @ s_g), np.arctan2(turn[1, 0], turn[0, 0])


def by_least_squares(s, m, w):
    """A general optimizer with its default tolerances, from the plain fit on."""
    start = np.add(weighted_complex(s, m, np.ones(len(s))), [0.3, -0.2, 0.2])
    x, y, theta = least_squares(
        lambda p: (np.sqrt(w)[:, None] * (turned(s, p[2]) + p[:2] - m)).ravel(), start, x_scale=[1, 1, 0.3]
    ).x
    return x, y, wrap_angle(theta)


def bars_by_library(source, theta, covariances):
    pose = Pose2D(0.0, 0.0, theta)
    return np.sqrt(np.diag(fit_covariance(pose, source, pose.apply(source), noise=covariances)))


def bars_by_differences(source, theta, covariances):
    """Move every coordinate of every point a little, and fit again."""
    target, n, h = turned(source, theta), len(source), 1e-5
    steps = h * np.eye(2 * n).reshape(2 * n, n, 2)
    ends = [[weighted_complex(source + way * step, target, np.ones(n)) for step in steps] for way in (1, -1)]
    rows = (np.subtract(*ends) / (2 * h)).T.reshape(3, n, 2)
    return np.sqrt(np.einsum("ink,nkl,inl->i", rows, covariances, rows))


RIGHT = [
    ("16.1", lambda s, m, t: (m - turned(s, t)).mean(axis=0)),
    ("16.1", lambda s, m, t: [float(v) for v in m.mean(axis=0) - turned(s.mean(axis=0)[None], t)[0]]),
    ("16.2", lambda s, m: np.sqrt(sums(s, m)[0] ** 2 + sums(s, m)[1] ** 2) / sums(s, m)[2]),
    ("16.2", lambda s, m: np.array([scale_by_svd(s, m)])),
    ("16.2", scale_by_search),
    ("16.3", lambda s, m: np.argmin([np.linalg.norm(rest) for rest in rests(s, m)])),
    ("16.3", lambda s, m: int(np.argmin([np.mean(rest**2) for rest in rests(s, m)]))),
    ("16.4", weighted_complex),
    ("16.4", weighted_svd),
    ("16.4", by_least_squares),
    ("16.4", lambda s, m, w: fit_rigid_2d(s, m, weights=w)),
    ("16.5", bars_by_library),
    ("16.5", bars_by_differences),
]
