"""Right answers to lesson 16 by other ways than its solutions."""

import numpy as np
from scipy.optimize import least_squares

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo import fit_rigid_2d
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D


def turned(points, theta):
    return Pose2D(0, 0, theta).apply(points)


def centred(*sides):
    return [points - points.mean(axis=0) for points in sides]


def rests(s, m):
    """The lengths of the residuals without each pair."""
    fits = [fit_rigid_2d(np.delete(s, k, 0), np.delete(m, k, 0)) for k in range(len(s))]
    return [np.linalg.norm(np.delete(fit.apply(s) - m, k, 0), axis=1) for k, fit in enumerate(fits)]


def by_least_squares(s, m, w):
    """A general optimizer with its default tolerances, from the plain fit on."""
    start = np.add(fit_rigid_2d(s, m), [0.3, -0.2, 0.2])
    rest = lambda p: (np.sqrt(w)[:, None] * (Pose2D(*p).apply(s) - m)).ravel()  # noqa: E731
    x, y, theta = least_squares(rest, start, x_scale=[1, 1, 0.3]).x
    return x, y, wrap_angle(theta)


def bars_by_differences(s, theta, covariances):
    """Move every coordinate of every point a little, and fit again."""
    steps = 1e-5 * np.eye(s.size).reshape(-1, *s.shape)
    ends = [[fit_rigid_2d(s + way * step, turned(s, theta)) for step in steps] for way in (1, -1)]
    rows = (np.subtract(*ends) / 2e-5).T.reshape(3, *s.shape)
    return np.sqrt(np.einsum("ink,nkl,inl->i", rows, covariances, rows))


RIGHT = [
    ("16.1", lambda s, m, t: (m - turned(s, t)).mean(axis=0)),
    ("16.2", lambda s, m: abs(np.vdot(*(z @ [1, 1j] for z in centred(s, m)))) / np.sum(centred(s)[0] ** 2)),
    ("16.3", lambda s, m: int(np.argmin([np.mean(rest**2) for rest in rests(s, m)]))),
    ("16.4", by_least_squares),
    ("16.5", bars_by_differences),
]
