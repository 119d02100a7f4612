"""Right answers to project 3 by other ways than its solutions."""

import cmath
import itertools
import math

import numpy as np
from scipy.optimize import minimize

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo import fit_rigid_2d
from course_lib.spherical_stereo.pose.rigid_fit import rotation_2d as turn


def distances_by_loops(pose, places, covariances, landmarks):
    r, table = turn(pose[2]), np.empty((len(places), len(landmarks)))
    for i, j in np.ndindex(table.shape):
        off = r @ places[i] + pose[:2] - landmarks[j]
        table[i, j] = off @ np.linalg.solve(r @ covariances[i] @ r.T + np.diag([0.0004, 0.0004]), off)
    return table


def poses_by_loops(places, labels, landmarks, map_labels, tolerance):
    """Every ordered choice, in another order than the library's, as a list."""
    found = []
    for j, m, k, i in np.ndindex(len(landmarks), len(landmarks), len(places), len(places)):
        seen, true = complex(*(places[k] - places[i])), complex(*(landmarks[m] - landmarks[j]))
        if i >= k or j == m or labels[i] != map_labels[j] or labels[k] != map_labels[m]:
            continue
        if abs(abs(seen) - abs(true)) <= tolerance and abs(seen) >= 0.5 and abs(true) >= 0.5:
            turned = cmath.phase(true / seen)
            middle = complex(*(places[i] + places[k])) / 2 * cmath.exp(1j * turned)
            t = complex(*(landmarks[j] + landmarks[m])) / 2 - middle
            found.append([t.real, t.imag, turned])
    return found


def poses_from_the_fit(places, labels, landmarks, map_labels, tolerance):
    """Two pairs and the least-squares fit of lesson 16: middle on middle by itself."""
    matches, found = [ij for ij in np.ndindex(len(places), len(landmarks)) if labels[ij[0]] == map_labels[ij[1]]], []
    for (i, j), (k, m) in itertools.combinations(matches, 2):
        lengths = math.dist(places[i], places[k]), math.dist(landmarks[j], landmarks[m])
        if i != k and j != m and abs(lengths[0] - lengths[1]) <= tolerance and min(lengths) >= 0.5:
            found.append(fit_rigid_2d(places[[i, k]], landmarks[[j, m]]))
    return np.array(found).reshape(-1, 3)


def assigned_by_trying(squared, like, reward):
    """All ways, one observation after the other: slow, and right."""

    def best(i, taken):
        if i == len(squared):
            return [], 0.0
        ways = [([-1, *(rest := best(i + 1, taken))[0]], rest[1])]
        for j, gain in enumerate(reward - squared[i] / 2):
            if like[i, j] and j not in taken and gain > 0:
                rest = best(i + 1, taken | {j})
                ways.append(([j, *rest[0]], rest[1] + gain))
        return max(ways, key=lambda way: way[1])

    landmark, score = best(0, frozenset())
    return np.array(landmark), score


def refit_by_nelder_and_mead(start, places, covariances, targets):
    weights = np.linalg.inv(covariances)

    def cost(pose):
        off = places - (targets - pose[:2]) @ turn(pose[2])
        return np.einsum("ni,nij,nj->", off, weights, off)

    options = {"xatol": 1e-9, "fatol": 1e-12, "maxiter": 4000, "maxfev": 4000}
    x, y, theta = minimize(cost, start, method="Nelder-Mead", options=options).x
    return [x, y, wrap_angle(theta)]


def refit_by_gauss_and_newton(start, places, covariances, targets):
    """Steps in the body frame, where the weights stand still; the derivative by hand."""
    pose, weights = np.array(start), np.linalg.inv(covariances)
    for _ in range(40):
        back = (targets - pose[:2]) @ turn(pose[2])
        slope = np.zeros((len(places), 2, 3))
        slope[:, :, :2], slope[:, 0, 2], slope[:, 1, 2] = turn(-pose[2]), -back[:, 1], back[:, 0]
        normal = np.einsum("nki,nkl,nlj->ij", slope, weights, slope)
        pose = pose - np.linalg.solve(normal, np.einsum("nki,nkl,nl->i", slope, weights, places - back))
    return np.array([pose[0], pose[1], wrap_angle(pose[2])], dtype=np.float32)


def sure_by_loop(poses, scores, nothing):
    if len(scores) == 0:
        return 0
    best, second = max(range(len(scores)), key=lambda k: scores[k]), -math.inf
    for pose, score in zip(poses, scores, strict=True):
        turned = abs(cmath.phase(cmath.exp(1j * (pose[2] - poses[best][2]))))
        if math.dist(pose[:2], poses[best][:2]) > 0.5 or turned > math.radians(10):
            second = max(second, score)
    with np.errstate(over="ignore"):
        return 1 / (1 + np.exp((second - scores[best]) / 2) + np.exp((nothing - scores[best]) / 2))


RIGHT = [
    ("P3.1", distances_by_loops),
    ("P3.2", poses_by_loops),
    ("P3.2", poses_from_the_fit),
    ("P3.3", assigned_by_trying),
    ("P3.4", refit_by_nelder_and_mead),
    ("P3.4", refit_by_gauss_and_newton),
    ("P3.5", sure_by_loop),
]
