"""Answers that students may give to the stages of projects P2 and P3, for test_exercise_answers.py."""

import cmath
import itertools
import math

import numpy as np
from scipy.optimize import linear_sum_assignment, minimize

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo import fit_rigid_2d, pixel_to_direction
from course_lib.spherical_stereo.pose.rigid_fit import RigidFitError

PI = math.pi

# P2.1


def angles_by_direction(box, width):
    """The library's direction, and its angles: a list of arrays of shape (1,)."""
    x, y, z = pixel_to_direction([(box[0] + box[2]) / 2, (box[1] + box[3]) / 2], width, width // 2)
    return [np.array([math.atan2(y, x) if abs(math.atan2(y, x) - PI) > 1e-12 else -PI]), np.array([math.asin(z)])]


def angles_of_a_wrapped_column(box, width):
    u_min, v_min, u_max, v_max = box
    u = (u_min + u_max) / 2
    if u >= width:
        u -= width
    return PI - 2 * PI * u / width, PI / 2 - PI * (v_min + v_max) / width


def angles_that_run_off(box, width):
    u, v = (box[0] + box[2]) / 2, (box[1] + box[3]) / 2
    return PI - 2 * PI * u / width, PI / 2 - PI * v / (width / 2)


def angles_to_the_right(box, width):
    azimuth, elevation = angles_of_a_wrapped_column(box, width)
    return wrap_angle(-azimuth), elevation


def angles_on_a_square(box, width):
    return angles_of_a_wrapped_column(box, width)[0], (0.5 - (box[1] + box[3]) / 2 / width) * PI


def column_at_the_wrong_edge(box, width):
    """The centre of a box across the seam taken with its right edge moved back: on the other side of the image."""
    right = box[2] - width if box[2] > width else box[2]
    return wrap_angle(PI - PI * (box[0] + right) / width), PI / 2 - PI * (box[1] + box[3]) / width


# P2.2


def pairs_from_a_sorted_list(upper_labels, upper, lower_labels, lower, largest):
    """All pairs that may be, sorted by their gap, each taken where both are still free."""
    candidates = []
    for i, (a, e) in enumerate(upper):
        for j, (b, f) in enumerate(lower):
            gap = abs(cmath.phase(cmath.exp(1j * (a - b))))
            if upper_labels[i] == lower_labels[j] and f > e and gap <= largest:
                candidates.append((gap, i, j))
    partner, taken = [-1] * len(upper), set()
    for _, i, j in sorted(candidates):
        if partner[i] < 0 and j not in taken:
            partner[i] = j
            taken.add(j)
    return partner


def pairs_as_floats(*given):
    return np.array(pairs_from_a_sorted_list(*given), dtype=np.float32)


def pairs_without_the_circle(upper_labels, upper, lower_labels, lower, largest):
    gaps = np.abs(upper[:, None, 0] - lower[None, :, 0])
    return _struck_out(upper_labels, upper, lower_labels, lower, largest, gaps)


def pairs_of_equal_height_too(upper_labels, upper, lower_labels, lower, largest):
    raised = np.add(lower, [0.0, 10.0])
    return pairs_from_a_sorted_list(upper_labels, upper, lower_labels, raised, largest)


def pairs_from_above(upper_labels, upper, lower_labels, lower, largest):
    return pairs_from_a_sorted_list(upper_labels, -upper, lower_labels, -lower, largest)


def pairs_of_any_class(upper_labels, upper, lower_labels, lower, largest):
    return pairs_from_a_sorted_list([""] * len(upper), upper, [""] * len(lower), lower, largest)


def pairs_by_hungarian(upper_labels, upper, lower_labels, lower, largest):
    gaps = np.abs(wrap_angle(upper[:, None, 0] - lower[None, :, 0]))
    bad = (upper_labels[:, None] != lower_labels) | (lower[None, :, 1] <= upper[:, None, 1]) | (gaps > largest)
    cost = np.where(bad, 10.0, gaps)
    partner = np.full(len(upper), -1)
    for i, j in zip(*linear_sum_assignment(cost), strict=True):
        partner[i] = j if cost[i, j] < 10 else -1
    return partner


def _struck_out(upper_labels, upper, lower_labels, lower, largest, gaps):
    bad = (upper_labels[:, None] != lower_labels) | (lower[None, :, 1] <= upper[:, None, 1]) | (gaps > largest)
    gaps, partner = np.where(bad, np.inf, gaps), np.full(len(upper), -1)
    while gaps.size and gaps.min() < np.inf:
        i, j = np.argwhere(gaps == gaps.min())[0]
        partner[i] = j
        gaps[i], gaps[:, j] = np.inf, np.inf
    return partner


# P2.3


def places_by_loop(upper, lower, baseline):
    rows = []
    for (a, e), (_, f) in zip(upper, lower, strict=True):
        if f - e <= 0.001:
            rows.append([math.nan, math.nan])
            continue
        d = baseline * math.cos(f) / math.sin(f - e)
        rows.append([d * math.cos(e) * math.cos(a), d * math.cos(e) * math.sin(a)])
    return np.array(rows).reshape(-1, 2)


def places_by_complex_numbers(upper, lower, baseline):
    gone = lower[:, 1] - upper[:, 1] <= 1e-3
    slope = np.where(gone, np.nan, np.tan(lower[:, 1]) - np.tan(upper[:, 1]))
    z = baseline / slope * np.exp(1j * upper[:, 0])
    return np.stack([z.real, z.imag], axis=1)


def places_along_the_ray(upper, lower, baseline):
    return places_by_loop(upper, lower, baseline) / np.cos(upper[:, 1:])


def places_even_where_rays_part(upper, lower, baseline):
    rho = baseline / (np.tan(lower[:, 1]) - np.tan(upper[:, 1]))
    return np.column_stack([rho * np.cos(upper[:, 0]), rho * np.sin(upper[:, 0])])


def places_from_below(upper, lower, baseline):
    moved = np.column_stack([lower[:, 0], upper[:, 1]])
    return places_by_loop(moved, lower, baseline)


def places_as_zeros(upper, lower, baseline):
    return np.nan_to_num(places_by_loop(upper, lower, baseline))


def places_without_the_parallel(upper, lower, baseline):
    """Only where the rays part is there none: the nearly parallel pair stands 300 m away."""
    rho = baseline / (np.tan(lower[:, 1]) - np.tan(upper[:, 1]))
    rho[rho <= 0] = np.nan
    return np.column_stack([rho * np.cos(upper[:, 0]), rho * np.sin(upper[:, 0])])


# P2.4


def penalties_by_loops(labels, places, hues, saturations, map_labels, map_places, map_hues, map_saturations):
    near, far = np.mean(places, axis=0), np.mean(map_places, axis=0)
    table = [[0.0] * len(map_labels) for _ in labels]
    for i in range(len(labels)):
        for j in range(len(map_labels)):
            turn = abs((hues[i] - map_hues[j] + 180) % 360 - 180)
            c, m = math.dist(places[i], near), math.dist(map_places[j], far)
            table[i][j] = 0.0 if labels[i] == map_labels[j] else 100.0
            table[i][j] += 0.0 if math.isnan(turn) else turn / 360
            table[i][j] += abs(saturations[i] - map_saturations[j]) / 100 + abs(c - m) / max(m, 0.1)
    return table


def penalties_by_phases(labels, places, hues, saturations, map_labels, map_places, map_hues, map_saturations):
    a, b = (np.exp(1j * np.radians(h)) for h in (hues, map_hues))
    turn = np.nan_to_num(np.abs(np.degrees(np.angle(a[:, None] * b.conj()))))
    c, m = (np.hypot(*(p - p.mean(axis=0)).T) for p in (places, map_places))
    table = turn / 360 + np.abs(saturations[:, None] - map_saturations) / 100
    return table + np.abs(c[:, None] - m) / np.clip(m, 0.1, None) + np.where(labels[:, None] == map_labels, 0, 100)


def penalties_the_long_way_round(*given):
    hues, map_hues = given[2], given[6]
    right = np.array(penalties_by_loops(*given))
    turn = np.nan_to_num(np.abs((hues[:, None] - map_hues + 180) % 360 - 180))
    return right - turn / 360 + np.nan_to_num(np.abs(hues[:, None] - map_hues)) / 360


def penalties_as_printed(*given):
    places, map_places = given[1], given[5]
    c, m = (np.linalg.norm(p - p.mean(axis=0), axis=1) for p in (places, map_places))
    signed = (c[:, None] - m) / np.maximum(m, 0.1)
    return np.array(penalties_by_loops(*given)) - np.abs(signed) + signed


def penalties_unguarded(*given):
    places, map_places = given[1], given[5]
    c, m = (np.linalg.norm(p - p.mean(axis=0), axis=1) for p in (places, map_places))
    gap = np.abs(c[:, None] - m)
    return np.array(penalties_by_loops(*given)) - gap / np.maximum(m, 0.1) + gap / m


def penalties_with_red_grey(*given):
    given = list(given)
    given[2], given[6] = np.nan_to_num(given[2]), np.nan_to_num(given[6])
    return penalties_by_loops(*given)


def penalties_of_grey_nan(*given):
    hues, map_hues = given[2], given[6]
    return np.array(penalties_by_loops(*given)) + 0 * (hues[:, None] + map_hues)


# P2.5


def greedy_by_sorting(cost):
    order = sorted((c, i, j) for i, row in enumerate(cost.tolist()) for j, c in enumerate(row))
    found, rows, columns = [-1] * len(cost), set(), set()
    for c, i, j in order:
        if i not in rows and j not in columns:
            rows.add(i)
            columns.add(j)
            found[i] = j if c < 100 else -1
    return found


def greedy_that_stops_at_100(cost):
    """No pair of 100 or more is used, so one may stop there: what is left would all be left out."""
    cost, found = cost.copy(), np.full(len(cost), -1)
    while cost.min() < 100:
        i, j = np.unravel_index(cost.argmin(), cost.shape)
        found[i], cost[i], cost[:, j] = j, 1e9, 1e9
    return found


def greedy_with_chairs_on_plants(cost):
    cost, found = cost.copy(), np.full(len(cost), -1)
    for _ in range(min(cost.shape)):
        i, j = np.unravel_index(cost.argmin(), cost.shape)
        found[i], cost[i], cost[:, j] = j, np.inf, np.inf
    return found


def least_of_each_row(cost):
    return [int(np.argmin(row)) if min(row) < 100 else -1 for row in cost]


def greedy_by_hungarian(cost):
    rows, columns = linear_sum_assignment(cost)
    found = np.full(len(cost), -1)
    found[rows] = np.where(cost[rows, columns] < 100, columns, -1)
    return found


def first_come(cost):
    found, taken = [], set()
    for row in cost:
        free = [j for j in range(len(row)) if j not in taken]
        if not free:
            found.append(-1)
            continue
        j = min(free, key=lambda k, row=row: row[k])
        taken.add(j)
        found.append(j if row[j] < 100 else -1)
    return found


# P2.6


def fit_by_complex_numbers(places, landmarks):
    if len(places) < 2 or np.ptp(places, axis=0).max() < 1e-3 or np.ptp(landmarks, axis=0).max() < 1e-3:
        return [math.nan] * 3
    a, b = (p[:, 0] + 1j * p[:, 1] for p in (places, landmarks))
    theta = cmath.phase(np.sum((a - a.mean()).conj() * (b - b.mean())))
    t = b.mean() - cmath.exp(1j * theta) * a.mean()
    return [t.real, t.imag, theta]


def fit_by_svd(places, landmarks):
    if len(places) < 2 or np.ptp(places, axis=0).max() < 1e-3 or np.ptp(landmarks, axis=0).max() < 1e-3:
        return np.full(3, np.nan)
    a, b = places - places.mean(axis=0), landmarks - landmarks.mean(axis=0)
    u, _, vt = np.linalg.svd(b.T @ a)
    r = u @ np.diag([1, np.linalg.det(u @ vt)]) @ vt
    return np.array([*(landmarks.mean(axis=0) - r @ places.mean(axis=0)), np.arctan2(r[1, 0], r[0, 0])])


def fit_with_mirrors(places, landmarks):
    if len(places) < 2 or np.ptp(places, axis=0).max() < 1e-3 or np.ptp(landmarks, axis=0).max() < 1e-3:
        return np.full(3, np.nan)
    a, b = places - places.mean(axis=0), landmarks - landmarks.mean(axis=0)
    u, _, vt = np.linalg.svd(b.T @ a)
    r = u @ vt
    return np.array([*(landmarks.mean(axis=0) - r @ places.mean(axis=0)), np.arctan2(r[1, 0], r[0, 0])])


def fit_by_the_library_that_refuses_mirrors(places, landmarks):
    try:
        return tuple(fit_rigid_2d(places, landmarks))
    except RigidFitError:
        return math.nan, math.nan, math.nan


def fit_of_anything(places, landmarks):
    if len(places) < 2:
        return math.nan, math.nan, math.nan
    a, b = places - places.mean(axis=0), landmarks - landmarks.mean(axis=0)
    theta = math.atan2(np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]), np.sum(a * b))
    c, s = math.cos(theta), math.sin(theta)
    return (*(landmarks.mean(axis=0) - np.array([[c, -s], [s, c]]) @ places.mean(axis=0)), theta)


def fit_the_way_back(places, landmarks):
    return fit_by_complex_numbers(landmarks, places)


def fit_by_one_line(places, landmarks):
    if len(places) < 2 or np.ptp(places, axis=0).max() < 1e-3 or np.ptp(landmarks, axis=0).max() < 1e-3:
        return [math.nan] * 3
    return fit_by_complex_numbers(places[:2], landmarks[:2])


# P3.1


def distances_by_loops(pose, places, covariances, landmarks):
    c, s = math.cos(pose[2]), math.sin(pose[2])
    r = np.array([[c, -s], [s, c]])
    table = np.empty((len(places), len(landmarks)))
    for i, (z, spread) in enumerate(zip(places, covariances, strict=True)):
        total = r @ spread @ r.T + np.diag([0.0004, 0.0004])
        for j, m in enumerate(landmarks):
            off = r @ z + pose[:2] - m
            table[i, j] = off @ np.linalg.solve(total, off)
    return table


def distances_in_the_body_frame(pose, places, covariances, landmarks):
    c, s = math.cos(pose[2]), math.sin(pose[2])
    back = (landmarks - pose[:2]) @ np.array([[c, -s], [s, c]])
    off = places[:, None] - back[None]
    weights = np.linalg.inv(covariances + 0.0004 * np.eye(2))
    return ((off[:, :, None, :] @ weights[:, None])[:, :, 0] * off).sum(axis=-1)


def distances_unturned(pose, places, covariances, landmarks):
    c, s = math.cos(pose[2]), math.sin(pose[2])
    off = (places @ np.array([[c, s], [-s, c]]) + pose[:2])[:, None] - landmarks[None]
    weights = np.linalg.inv(covariances + 0.0004 * np.eye(2))
    return np.einsum("nmi,nij,nmj->nm", off, weights, off)


def distances_of_a_perfect_map(pose, places, covariances, landmarks):
    return distances_in_the_body_frame(pose, places, covariances - 0.0004 * np.eye(2), landmarks)


def distances_with_a_root(*given):
    return np.sqrt(distances_by_loops(*given))


def distances_without_the_robot(pose, places, covariances, landmarks):
    return distances_by_loops(np.array([0.0, 0.0, pose[2]]), places, covariances, landmarks)


# P3.2


def poses_by_loops(places, labels, landmarks, map_labels, tolerance):
    """Every ordered choice, in another order than the library's, as a list."""
    found = []
    for j in range(len(landmarks)):
        for m in range(len(landmarks)):
            for k in range(len(places)):
                for i in range(k):
                    seen, true = complex(*(places[k] - places[i])), complex(*(landmarks[m] - landmarks[j]))
                    if j == m or labels[i] != map_labels[j] or labels[k] != map_labels[m]:
                        continue
                    if abs(abs(seen) - abs(true)) > tolerance or abs(seen) < 0.5 or abs(true) < 0.5:
                        continue
                    turn = (true / seen) / abs(true / seen)
                    t = complex(*(landmarks[j] + landmarks[m])) / 2 - turn * complex(*(places[i] + places[k])) / 2
                    found.append([t.real, t.imag, cmath.phase(turn)])
    return found


def poses_from_the_fit(places, labels, landmarks, map_labels, tolerance):
    """Two pairs and the least-squares fit of lesson 16: middle on middle by itself."""
    found = []
    matches = [(i, j) for i in range(len(places)) for j in range(len(landmarks)) if labels[i] == map_labels[j]]
    for n, (i, j) in enumerate(matches):
        for k, m in matches[n + 1 :]:
            lengths = math.dist(places[i], places[k]), math.dist(landmarks[j], landmarks[m])
            if i != k and j != m and abs(lengths[0] - lengths[1]) <= tolerance and min(lengths) >= 0.5:
                found.append(fit_rigid_2d(places[[i, k]], landmarks[[j, m]]))
    return np.array(found, dtype=np.float32).reshape(-1, 3).astype(float) if not found else np.array(found)


def poses_one_way_round(places, labels, landmarks, map_labels, tolerance):
    found = []
    for i, k in itertools.combinations(range(len(places)), 2):
        for j, m in itertools.combinations(range(len(landmarks)), 2):
            lengths = math.dist(places[i], places[k]), math.dist(landmarks[j], landmarks[m])
            like = labels[i] == map_labels[j] and labels[k] == map_labels[m]
            if like and abs(lengths[0] - lengths[1]) <= tolerance and min(lengths) >= 0.5:
                found.append(fit_rigid_2d(places[[i, k]], landmarks[[j, m]]))
    return np.array(found).reshape(-1, 3)


def poses_of_ordered_pairs(*given):
    """Each pair of observations taken twice: every pose is there two times."""
    return np.repeat(np.array(poses_by_loops(*given)).reshape(-1, 3), 2, axis=0)


def poses_of_sofas_on_chairs(places, labels, landmarks, map_labels, tolerance):
    return poses_by_loops(places, [""] * len(places), landmarks, [""] * len(landmarks), tolerance)


def poses_of_any_length(places, labels, landmarks, map_labels, tolerance):
    return poses_by_loops(places, labels, landmarks, map_labels, 1e9)


def poses_in_degrees(*given):
    return np.array(poses_by_loops(*given)).reshape(-1, 3) * [1, 1, 180 / PI]


# P3.3


def assigned_with_dummies(squared, like, reward):
    """A dummy landmark for every observation, which costs nothing."""
    n, m = squared.shape
    cost = np.where(like, squared / 2 - reward, 1e6)
    cost = np.hstack([cost, np.zeros((n, n))])
    _, columns = linear_sum_assignment(cost)
    return [int(j) if j < m else -1 for j in columns], -cost[np.arange(n), columns].sum()


def assigned_by_trying(squared, like, reward):
    """All ways, one observation after the other: slow, and right."""
    best = (0.0, [-1] * len(squared))

    def go(i, taken, score, found):
        nonlocal best
        if i == len(squared):
            if score > best[0] + 1e-12:
                best = (score, found)
            return
        go(i + 1, taken, score, [*found, -1])
        for j in range(squared.shape[1]):
            gain = reward - squared[i, j] / 2
            if like[i, j] and j not in taken and gain > 0:
                go(i + 1, taken | {j}, score + gain, [*found, j])

    go(0, frozenset(), 0.0, [])
    return np.array(best[1]), best[0]


def assigned_and_dropped(squared, like, reward):
    cost = np.where(like, squared / 2 - reward, 1e6)
    rows, columns = linear_sum_assignment(cost)
    found = np.full(len(squared), -1)
    good = cost[rows, columns] < 0
    found[rows[good]] = columns[good]
    return found, -cost[rows[good], columns[good]].sum()


def assigned_greedily(squared, like, reward):
    gain, found, score = np.where(like, reward - squared / 2, -1.0), np.full(len(squared), -1), 0.0
    while gain.max() > 0:
        i, j = np.unravel_index(gain.argmax(), gain.shape)
        found[i], score = j, score + gain[i, j]
        gain[i], gain[:, j] = -1, -1
    return found, score


def assigned_score_first(*given):
    found, score = assigned_with_dummies(*given)
    return score, np.array(found)


def assigned_without_a_score(*given):
    return np.array(assigned_with_dummies(*given)[0])


def assigned_at_full_cost(squared, like, reward):
    found, score = assigned_with_dummies(2 * squared, like, reward)
    return np.array(found), score


# P3.4


def refit_by_nelder_and_mead(start, places, covariances, targets):
    weights = np.linalg.inv(covariances)

    def cost(pose):
        c, s = math.cos(pose[2]), math.sin(pose[2])
        off = places - (targets - pose[:2]) @ np.array([[c, -s], [s, c]])
        return np.einsum("ni,nij,nj->", off, weights, off)

    options = {"xatol": 1e-9, "fatol": 1e-12, "maxiter": 4000, "maxfev": 4000}
    x, y, theta = minimize(cost, start, method="Nelder-Mead", options=options).x
    return [x, y, wrap_angle(theta)]


def refit_by_the_library(start, places, covariances, targets):
    return fit_rigid_2d(places, targets, covariances=covariances)


def refit_by_gauss_and_newton(start, places, covariances, targets):
    """Steps in the body frame, where the weights stand still; the derivative by hand."""
    pose, weights = np.array(start), np.linalg.inv(covariances)
    for _ in range(40):
        c, s = math.cos(pose[2]), math.sin(pose[2])
        back = (targets - pose[:2]) @ np.array([[c, -s], [s, c]])
        slope = np.zeros((len(places), 2, 3))
        slope[:, :, 0], slope[:, :, 1] = [c, -s], [s, c]
        slope[:, :, 2] = -np.column_stack([back[:, 1], -back[:, 0]])
        normal = np.einsum("nki,nkl,nlj->ij", slope, weights, slope)
        pose = pose - np.linalg.solve(normal, np.einsum("nki,nkl,nl->i", slope, weights, places - back))
    return np.array([pose[0], pose[1], wrap_angle(pose[2])], dtype=np.float32)


def refit_that_runs_off(start, places, covariances, targets):
    x, y, theta = refit_by_nelder_and_mead(start, places, covariances, targets)
    return x, y, theta % (2 * PI)


def refit_by_scalar_weights(start, places, covariances, targets):
    return fit_rigid_2d(places, targets, weights=1 / np.trace(covariances, axis1=1, axis2=2))


def refit_alike(start, places, covariances, targets):
    return fit_rigid_2d(places, targets)


def refit_of_the_world(start, places, covariances, targets):
    """The inverse covariances unturned: right for a heading of 0 alone."""
    weights = np.linalg.inv(covariances)

    def cost(pose):
        c, s = math.cos(pose[2]), math.sin(pose[2])
        off = places @ np.array([[c, s], [-s, c]]) + pose[:2] - targets
        return np.einsum("ni,nij,nj->", off, weights, off)

    x, y, theta = minimize(cost, start, method="BFGS", options={"gtol": 1e-9}).x
    return x, y, wrap_angle(theta)


# P3.5


def sure_by_loop(poses, scores, nothing):
    if len(scores) == 0:
        return 0
    best = max(range(len(scores)), key=lambda k: scores[k])
    second = -math.inf
    for pose, score in zip(poses, scores, strict=True):
        turned = abs(cmath.phase(cmath.exp(1j * (pose[2] - poses[best][2]))))
        if math.dist(pose[:2], poses[best][:2]) > 0.5 or turned > math.radians(10):
            second = max(second, score)
    with np.errstate(over="ignore"):
        return 1 / (1 + np.exp((second - scores[best]) / 2) + np.exp((nothing - scores[best]) / 2))


def sure_by_softmax(poses, scores, nothing):
    if not len(poses):
        return np.zeros(1)
    best = poses[np.argmax(scores)]
    other = np.hypot(*(poses[:, :2] - best[:2]).T) > 0.5
    other |= np.abs((poses[:, 2] - best[2] + PI) % (2 * PI) - PI) > PI / 18
    row = np.array([scores.max(), scores[other].max() if other.any() else -np.inf, nothing])
    share = np.exp((row - row.max()) / 2)
    return np.array([share[0] / share.sum()])


def sure_among_copies(poses, scores, nothing):
    if not len(poses):
        return 0.0
    first, second = (*sorted(scores, reverse=True), -np.inf)[:2]
    return 1 / (1 + np.exp((second - first) / 2) + np.exp((nothing - first) / 2))


def sure_by_place_alone(poses, scores, nothing):
    return sure_by_softmax(poses * [1, 1, 0], scores, nothing)


def sure_without_nothing(poses, scores, nothing):
    return sure_by_softmax(poses, scores, -np.inf)


def sure_by_plain_exponentials(poses, scores, nothing):
    if not len(poses):
        return 0.0
    best = int(np.argmax(scores))
    other = np.hypot(*(poses[:, :2] - poses[best, :2]).T) > 0.5
    other |= np.abs(wrap_angle(poses[:, 2] - poses[best, 2])) > PI / 18
    with np.errstate(over="ignore", invalid="ignore"):
        e = np.exp(scores / 2)
        return e[best] / (e[best] + (e[other].max() if other.any() else 0.0) + np.exp(nothing / 2))


def sure_without_a_guard(poses, scores, nothing):
    best = scores.argmax()
    return sure_by_softmax(poses, scores, nothing) * (best >= 0)


WRONG = [
    ("P2.1", angles_that_run_off, "whole turns"),
    ("P2.1", angles_to_the_right, "decreases"),
    ("P2.1", angles_on_a_square, "half as high as wide"),
    ("P2.1", column_at_the_wrong_edge, "Mean first"),
    ("P2.1", lambda box, width: np.degrees(angles_of_a_wrapped_column(box, width)), "In radians"),
    ("P2.1", lambda box, width: angles_of_a_wrapped_column(box, width)[::-1], "another order"),
    ("P2.2", pairs_without_the_circle, "around the circle"),
    ("P2.2", pairs_of_equal_height_too, "*higher*"),
    ("P2.2", pairs_from_above, "From below"),
    ("P2.2", pairs_of_any_class, "unlike classes"),
    ("P2.2", pairs_by_hungarian, "*total* gap"),
    ("P2.3", places_along_the_ray, "along the ray"),
    ("P2.3", places_even_where_rays_part, "diverge or run parallel"),
    ("P2.3", places_from_below, "upper camera"),
    ("P2.3", places_as_zeros, "not 0"),
    ("P2.3", places_without_the_parallel, "parallel to a thousandth"),
    ("P2.4", penalties_the_long_way_round, "around the circle"),
    ("P2.4", penalties_as_printed, "absolute value"),
    ("P2.4", penalties_unguarded, "at least 0.1 m"),
    ("P2.4", penalties_with_red_grey, "which is red"),
    ("P2.4", penalties_of_grey_nan, "its hue term is 0"),
    ("P2.4", lambda *given: np.array(penalties_by_loops(*given)).T, "shape"),
    ("P2.5", greedy_with_chairs_on_plants, "is not used"),
    ("P2.5", least_of_each_row, "strike both out"),
    ("P2.5", greedy_by_hungarian, "never goes back"),
    ("P2.5", first_come, "row by row"),
    ("P2.6", fit_with_mirrors, "sign of the determinant"),
    ("P2.6", fit_by_the_library_that_refuses_mirrors, "look mirrored"),
    ("P2.6", fit_of_anything, "tell no heading"),
    ("P2.6", fit_the_way_back, "from the body to the map"),
    ("P2.6", fit_by_one_line, "first two pairs"),
    ("P3.1", distances_unturned, "turn them"),
    ("P3.1", distances_of_a_perfect_map, "2 cm are missing"),
    ("P3.1", distances_with_a_root, "without the root"),
    ("P3.1", distances_without_the_robot, "not moved"),
    ("P3.2", poses_one_way_round, "too few poses"),
    ("P3.2", poses_of_ordered_pairs, "too many poses"),
    ("P3.2", poses_of_sofas_on_chairs, "too many poses"),
    ("P3.2", poses_of_any_length, "too many poses"),
    ("P3.2", poses_in_degrees, "not these"),
    ("P3.3", assigned_and_dropped, "spoilt others"),
    ("P3.3", assigned_greedily, "greatest *total*"),
    ("P3.3", assigned_score_first, "another order"),
    ("P3.3", assigned_without_a_score, "Return 2 values"),
    ("P3.3", assigned_at_full_cost, "half of itself"),
    ("P3.4", refit_alike, "count alike"),
    ("P3.4", refit_by_the_library, "weighted sum"),
    ("P3.4", refit_by_scalar_weights, "sure across its ray"),
    ("P3.4", refit_of_the_world, "turn them"),
    ("P3.4", refit_that_runs_off, "0 to 2 pi"),
    ("P3.5", sure_among_copies, "the same answer"),
    ("P3.5", sure_by_place_alone, "heading"),
    ("P3.5", sure_without_nothing, "is a rival"),
    ("P3.5", sure_by_plain_exponentials, "infinite"),
    ("P3.5", sure_without_a_guard, "ValueError"),
]
RIGHT = [
    ("P2.1", angles_by_direction),
    ("P2.1", angles_of_a_wrapped_column),
    ("P2.1", lambda box, width: np.array(angles_of_a_wrapped_column(box, width), dtype=np.float32)),
    ("P2.2", pairs_from_a_sorted_list),
    ("P2.2", pairs_as_floats),
    ("P2.3", places_by_loop),
    ("P2.3", places_by_complex_numbers),
    ("P2.4", penalties_by_loops),
    ("P2.4", penalties_by_phases),
    ("P2.5", greedy_by_sorting),
    ("P2.5", greedy_that_stops_at_100),
    ("P2.6", fit_by_complex_numbers),
    ("P2.6", fit_by_svd),
    ("P3.1", distances_by_loops),
    ("P3.1", distances_in_the_body_frame),
    ("P3.2", poses_by_loops),
    ("P3.2", poses_from_the_fit),
    ("P3.3", assigned_with_dummies),
    ("P3.3", assigned_by_trying),
    ("P3.4", refit_by_nelder_and_mead),
    ("P3.4", refit_by_gauss_and_newton),
    ("P3.5", sure_by_loop),
    ("P3.5", sure_by_softmax),
]
