"""Right answers to lesson 16 by other ways than its solutions."""

import numpy as np
from scipy.optimize import least_squares

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo import fit_rigid_2d
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D, fit_covariance


def turned(points, theta):
    return Pose2D(0, 0, theta).apply(points)


def centred(*sides):
    return [points - points.mean(axis=0) for points in sides]


def scale_by_svd(s, m):
    a, b = centred(s, m)
    d = np.linalg.svd(b.T @ a, compute_uv=False)
    return np.array([(d[0] + np.sign(np.linalg.det(b.T @ a)) * d[1]) / np.sum(a**2)])


def rests(s, m):
    """The lengths of the residuals without each pair."""
    fits = [fit_rigid_2d(np.delete(s, k, 0), np.delete(m, k, 0)) for k in range(len(s))]
    return [np.linalg.norm(np.delete(fit.apply(s) - m, k, 0), axis=1) for k, fit in enumerate(fits)]


def by_complex_numbers(s, m, w):
    """A rotation is a factor of length 1."""
    s, m = s @ [1, 1j], m @ [1, 1j]
    s_g, m_g = (w @ s) / w.sum(), (w @ m) / w.sum()
    turn = (w * (m - m_g)) @ np.conj(s - s_g)
    t = m_g - turn / abs(turn) * s_g
    return t.real, t.imag, np.angle(turn)


def by_least_squares(s, m, w):
    """A general optimizer with its default tolerances, from the plain fit on."""
    start = np.add(by_complex_numbers(s, m, np.ones(len(s))), [0.3, -0.2, 0.2])
    rest = lambda p: (np.sqrt(w)[:, None] * (Pose2D(*p).apply(s) - m)).ravel()  # noqa: E731
    x, y, theta = least_squares(rest, start, x_scale=[1, 1, 0.3]).x
    return x, y, wrap_angle(theta)


RIGHT = [
    ("16.1", lambda s, m, t: (m - turned(s, t)).mean(axis=0)),
    ("16.2", scale_by_svd),
    ("16.3", lambda s, m: np.argmin([np.linalg.norm(rest) for rest in rests(s, m)])),
    ("16.4", by_least_squares),
    ("16.5", lambda s, t, c: np.sqrt(np.diag(fit_covariance(Pose2D(0, 0, t), s, turned(s, t), noise=c)))),
]
