"""Answers that students may give to lessons 00 to 03, for test_exercise_answers.py."""

import itertools
import math

import numpy as np
from scipy.spatial.transform import Rotation

from course_lib.geometry import BODY_FROM_OPTICAL, optical_pose, pose_matrix, state_from_matrix, wrap_angle

B = BODY_FROM_OPTICAL


def one_by_one(measured, simulated):
    return [[abs(a - b) for a, b in zip(*rows, strict=True)] for rows in zip(measured, simulated, strict=True)]


def vote_by_vote(vote, alpha):
    flat = [math.inf if v == 0 else alpha * (1 - v) / v for v in vote.flat]
    return np.reshape(flat, vote.shape)


def coordinate_after_coordinate(score, start):
    """Rounds over x, y and yaw, each time the best of a few values, ever closer about the last best."""
    best, reach = start.copy(), np.array([0.4, 0.3, 0.18])
    for _ in range(8):
        for k in range(3):
            tried = np.tile(best, (16, 1))
            tried[:, k] += np.linspace(-1, 1, 16) * reach[k]
            best = tried[np.argmax(score(tried))]
        reach = 0.6 * reach
    return best


def one_pose_at_a_time(score, start):
    """A walk: a random step is kept where it leads uphill; the steps grow shorter."""
    rng = np.random.default_rng(1)
    best, height, reach = np.array(start), score(start), np.array([0.3, 0.25, 0.12])
    for _ in range(399):
        tried = best + reach * rng.normal(size=3)
        if (value := score(tried)) > height:
            best, height = tried, value
        reach = 0.985 * reach
    return best.tolist()


def weighted_cloud(score, start):
    """A small particle filter: resampled by a power of the score, moved less and less."""
    rng = np.random.default_rng(2)
    cloud, reach = np.tile(start, (50, 1)), np.array([0.3, 0.22, 0.12])
    for _ in range(8):
        cloud = cloud + reach * rng.normal(size=cloud.shape)
        values = score(cloud)
        best = cloud[values.argmax()]
        cloud = cloud[rng.choice(50, 50, p=values**30 / (values**30).sum())]
        cloud[0], reach = best, 0.6 * reach
    return best


def too_many(score, start):
    return start + max(np.random.default_rng(0).normal(size=(500, 3)) * 0.1, key=lambda d: score(start + d))


def degrees_for_radians(score, start):
    rng = np.random.default_rng(0)
    best, reach = start, np.array([0.28, 0.21, 7.0])
    for _ in range(10):
        cloud = best + reach * rng.normal(size=(40, 3))
        cloud[0] = best
        best, reach = cloud[np.argmax(score(cloud))], 0.5 * reach
    return best


def too_narrow_too_soon(score, start):
    rng = np.random.default_rng(0)
    best, reach = start, np.array([0.28, 0.21, 0.12])
    for _ in range(10):
        cloud = best + reach * rng.normal(size=(40, 3))
        cloud[0] = best
        best, reach = cloud[np.argmax(score(cloud))], 0.2 * reach
    return best


def ever_worse(score, start):
    rng = np.random.default_rng(0)
    best, reach = start, np.array([0.28, 0.21, 0.12])
    for _ in range(10):
        cloud = best + reach * rng.normal(size=(40, 3))
        best, reach = cloud[np.argmin(score(cloud))], 0.65 * reach
    return best


def grids_about_the_best(score, start):
    """A coarse grid over the whole box, then four finer ones about the best of each."""
    best, reach = start, np.array([0.4, 0.3, 0.18])
    for counts in ((6, 5, 5), *[(4, 4, 3)] * 4):
        steps = np.stack(np.meshgrid(*[np.linspace(-1, 1, k) for k in counts]), axis=-1).reshape(-1, 3)
        cloud = best + steps * reach
        best, reach = cloud[np.argmax(score(cloud))], 0.45 * reach
    return list(best)


def rotation(state):
    return pose_matrix(state)[:3, :3]


def homogeneous(points):
    return np.column_stack([points, np.ones(len(points))])


def turned_in_place(points, state):
    points[:] = points @ B.T
    return points @ rotation(state).T + state[:3]


def six_numbers(matrix, R, pitch=None):
    """Position of the matrix, angles of R, and another pitch where one is given."""
    roll, yaw = np.arctan2(R[2, 1], R[2, 2]), np.arctan2(R[1, 0], R[0, 0])
    usual = np.arctan2(-R[2, 0], np.hypot(R[0, 0], R[1, 0]))
    return [*matrix[:3, 3], roll, usual if pitch is None else pitch, yaw]


def body(matrix):
    return matrix[:3, :3] @ B.T


def swapped_arctan2(matrix):
    R = body(matrix)
    pitch = np.arctan2(-R[2, 0], np.hypot(R[0, 0], R[1, 0]))
    return [*matrix[:3, 3], np.arctan2(R[2, 2], R[2, 1]), pitch, np.arctan2(R[0, 0], R[1, 0])]


def left_on_the_whole_matrix(matrix):
    four = np.eye(4)
    four[:3, :3] = B
    return state_from_matrix(four.T @ matrix)


def by_first_pose(angles, rotations, new):
    """Every reading is tried, but on the first pose alone."""
    for axes, signs, step in itertools.product(
        itertools.permutations(range(3)), itertools.product((1, -1), repeat=3), (1, -1)
    ):

        def matrix(row, axes=axes, signs=signs, step=step):
            turns = [
                pose_matrix(np.deg2rad(s * a) * np.eye(6)[3 + k]) for k, s, a in zip(axes, signs, row, strict=True)
            ]
            return np.linalg.multi_dot(turns[::step])

        if np.allclose(matrix(angles[0])[:3, :3], rotations[0], atol=1e-6):
            return np.array([state_from_matrix(matrix(row))[3:] for row in new])
    return None


def turns_on_the_left(steps):
    turn, places = np.eye(3), [np.zeros(3)]
    for step in steps:
        places.append(places[-1] + turn @ step[:3, 3])
        turn = step[:3, :3] @ turn
    return np.array(places)


def by_heading(steps):
    heading, x, y, z, places = 0.0, 0.0, 0.0, 0.0, [[0.0, 0.0, 0.0]]
    for step in steps:
        forward, left, up = step[:3, 3]
        x += forward * np.cos(heading) - left * np.sin(heading)
        y += forward * np.sin(heading) + left * np.cos(heading)
        z += up
        heading += np.arctan2(step[1, 0], step[0, 0])
        places.append([x, y, z])
    return places


def distances(seen, mapped):
    return np.linalg.norm(seen[:, None] - mapped[None], axis=2)


def depth(b, near, far):
    return near * far / (far - b * (far - near))


def masked(layers, seen):
    return np.where(seen, layers, np.inf)


def relative(before, after):
    return np.linalg.inv(pose_matrix(before)) @ pose_matrix(after)


def axis_by_axis(before, after):
    """The step by dot products with the first camera's axes; the turn by its matrix."""
    R, S = rotation(before), rotation(after)
    step = [np.dot(R[:, k], after[:3] - before[:3]) for k in range(3)]
    turn = R.T @ S
    return [*step, math.atan2(turn[2, 1], turn[2, 2]), -math.asin(turn[2, 0]), math.atan2(turn[1, 0], turn[0, 0])]


def flat(before, after):
    """Right for a wagon: yaw alone."""
    c, s = np.cos(before[5]), np.sin(before[5])
    dx, dy, dz = after[:3] - before[:3]
    return [c * dx + s * dy, c * dy - s * dx, dz, *wrap_angle(after - before)[3:]]


def turn_about(axis, degrees):
    angles = np.zeros(6)
    angles[3 + axis] = np.deg2rad(degrees)
    return rotation(angles)


def product(axes, signs, first, row):
    turns = [turn_about(axis, sign * angle) for axis, sign, angle in zip(axes, signs, row, strict=True)]
    return turns[2] @ turns[1] @ turns[0] if first else turns[0] @ turns[1] @ turns[2]


def tried_one_by_one(angles, rotations, new, firsts=(True, False), signs=(1, -1)):
    """Every reading by matrices of our own, the first that fits."""
    for axes in itertools.permutations(range(3)):
        for sign in itertools.product(signs, repeat=3):
            for first in firsts:
                made = [product(axes, sign, first, row) for row in angles]
                if np.allclose(made, rotations, atol=1e-6):
                    matrices = np.tile(np.eye(4), (len(new), 1, 1))
                    matrices[:, :3, :3] = [product(axes, sign, first, row) for row in new]
                    return state_from_matrix(matrices)[:, 3:]
    return None


def aimed(points):
    """Range, azimuth, elevation one point after the other, with the standard library."""
    found = [
        (math.dist(p, (0, 0, 0)), math.atan2(p[1], p[0]), math.asin(p[2] / math.dist(p, (0, 0, 0)))) for p in points
    ]
    return [list(column) for column in zip(*found, strict=True)]


def floor_range(points):
    return np.hypot(points[:, 0], points[:, 1])


def walked(steps):
    """Places of a chain, with a place and a turn carried along."""
    place, turn, places = np.zeros(3), np.eye(3), [[0.0, 0.0, 0.0]]
    for step in steps:
        place = place + turn @ step[:3, 3]
        turn = turn @ step[:3, :3]
        places.append(list(place))
    return places


def one_by_matrix_products(steps):
    poses = [np.eye(4)]
    for step in steps:
        poses.append(poses[-1] @ step)
    return np.stack(poses)[:, :3, 3]


def simulated_sigma(n_steps, spacing, sigma_place, sigma_heading, runs=10_000):
    """The same sigma by simulation: rows of stations with random errors."""
    rng = np.random.default_rng(0)
    x, y, heading = np.zeros(runs), np.zeros(runs), np.zeros(runs)
    for _ in range(n_steps):
        ahead, left = spacing + sigma_place * rng.normal(size=runs), sigma_place * rng.normal(size=runs)
        x, y = (
            x + np.cos(heading) * ahead - np.sin(heading) * left,
            y + np.sin(heading) * ahead + np.cos(heading) * left,
        )
        heading = heading + sigma_heading * rng.normal(size=runs)
    return np.std(y)


def triangle_fan(corners, near):
    """The cut by cases: how many corners are before the plane, and which one is alone."""
    before = corners[:, 2] < near
    if before.sum() in (0, 3):
        return [] if before.all() else corners.tolist()
    k = int(np.flatnonzero(before == (before.sum() == 1))[0])  # the corner that is alone on its side
    alone, second, third = corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]
    meets = [alone + (near - alone[2]) / (other[2] - alone[2]) * (other - alone) for other in (second, third)]
    return np.array([meets[0], second, third, meets[1]] if before.sum() == 1 else [alone, *meets])


def cut_by_rays(corners, near):
    """New corners by mixing 1/Z, as on the screen: wrong where a corner is behind the camera."""
    kept = []
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        if a[2] >= near:
            kept.append(a)
        if (a[2] >= near) != (b[2] >= near):
            kept.append(a + (1 / near - 1 / a[2]) / (1 / b[2] - 1 / a[2]) * (b - a))
    return np.reshape(kept, (-1, 3))


# Exercise, answer, words of the hint that must come.
WRONG = [
    ("00.1", lambda m, s: np.minimum(np.abs(m - s), 10), "stops at 10 m"),
    ("00.1", lambda m, s: np.nan_to_num(np.abs(m - s)), "full agreement"),
    ("00.1", lambda m, s: np.where(np.isnan(m), 0, np.abs(m - s)), "must stay nan"),
    ("00.1", lambda m, s: np.abs(np.nan_to_num(m) - np.nan_to_num(s)), "before you subtract"),
    ("00.1", lambda m, s: np.abs(m - s)[np.isfinite(m)], "shape"),
    ("00.1", lambda m, s: np.nanmean(np.abs(m - s)), "shape"),
    ("00.2", lambda v, a: a * v / (1 - v), "changed places"),
    ("00.2", lambda v, a: a / v, "What is left to take away"),
    ("00.2", lambda v, a: (1 - v) / v, "no unit"),
    ("00.2", lambda v, a: 0.1 / v - 0.1, "paper's alpha"),
    ("00.2", lambda v, a: a / np.maximum(v, 1e-9) - a, "inf"),
    ("00.2", lambda v, a: np.where(v > 0, a / v - a, 0), "infinite one"),
    ("00.2", lambda v, a: np.where(v > 2 * a, a / v - a, np.inf), "inf where a finite number"),
    ("00.3", lambda score, start: start, "the pose that you were given"),
    ("00.3", too_many, "more than 400 poses"),
    ("00.3", degrees_for_radians, "from the top"),
    ("00.3", lambda score, start: start[:2], "three finite numbers"),
    ("00.3", lambda score, start: score(start), "three finite numbers"),
    ("00.3", lambda score, start: np.full(3, np.nan), "three finite numbers"),
    ("01.1", lambda p, s: p @ B @ rotation(s) + s[:3], "Both of your turns run backwards"),
    ("01.1", lambda p, s: p[:, [2, 0, 1]] @ rotation(s).T + s[:3], "keep their signs"),
    ("01.1", lambda p, s: p @ (B @ rotation(s)).T + s[:3], "R acts before B"),
    ("01.1", lambda p, s: p @ B.T @ rotation(s).T - s[:3], "added, not taken away"),
    ("01.1", turned_in_place, "changes the array"),
    ("01.2", left_on_the_whole_matrix, "turns the position, too"),
    ("01.2", lambda m: six_numbers(m, body(m).T), "transposed"),
    ("01.2", lambda m: six_numbers(m, body(m), np.arctan2(-body(m)[2, 0], body(m)[0, 0])), "R00 alone"),
    ("01.2", lambda m: six_numbers(m, body(m), np.arctan(-body(m)[2, 0])), "*sine* of the pitch"),
    ("01.2", swapped_arctan2, "sine part first"),
    ("01.1", lambda p, s: (p @ B.T - s[:3]) @ rotation(s), "from the body to the world already"),
    ("01.2", lambda m: six_numbers(m, body(m)) * np.array([1, 1, 1, 0, 1, 1]), "A camera in a hand rolls"),
    ("01.2", lambda m: [*m[:3, 3], *Rotation.from_matrix(body(m)).as_euler("zyx")[::-1]], "with capitals"),
    ("01.3", flat, "Right for a wagon"),
    ("01.3", lambda a, b: [*(b - a)[:3], *state_from_matrix(relative(a, b))[3:]], "along the world's axes"),
    ("01.3", lambda a, b: state_from_matrix(np.linalg.inv(relative(a, b))), "the way back"),
    ("01.3", lambda a, b: state_from_matrix(pose_matrix(b) @ np.linalg.inv(pose_matrix(a))), "wrong side"),
    ("01.3", lambda a, b: relative(a, b), "shape"),
    ("01.3", lambda a, b: b - a, "subtract the numbers"),
    ("01.4", lambda a, R, new: np.deg2rad(new), "as this course does"),
    ("01.4", lambda a, R, new: tried_one_by_one(a, R, new, firsts=(True,)), "None"),
    ("01.4", lambda a, R, new: tried_one_by_one(a, R, new, signs=(1,)), "None"),
    ("01.4", lambda a, R, new: np.rad2deg(tried_one_by_one(a, R, new)), "radians"),
    ("02.1", lambda p: (np.linalg.norm(p, axis=1), np.arctan(p[:, 1] / p[:, 0]), aimed(p)[2]), "behind the scanner"),
    ("02.1", lambda p: (aimed(p)[0], aimed(p)[1], -np.array(aimed(p)[2])), "wrong sign"),
    ("02.1", lambda p: (aimed(p)[0], aimed(p)[1], np.arccos(p[:, 2] / aimed(p)[0])), "straight up"),
    ("02.1", lambda p: (floor_range(p), *aimed(p)[1:]), "distance on the floor"),
    ("02.1", lambda p: (aimed(p)[1], aimed(p)[2], aimed(p)[0]), "another order"),
    ("02.1", lambda p: np.transpose(aimed(p)), "Return 3 values"),
    ("02.2", lambda steps: np.vstack([np.zeros(3), steps[:, :3, 3].cumsum(axis=0)]), "as if no station were turned"),
    ("02.2", lambda steps: one_by_matrix_products(steps)[1:], "first station is missing"),
    ("02.2", lambda steps: one_by_matrix_products(np.linalg.inv(steps)), "walk every step backwards"),
    ("02.2", lambda steps: steps[:, :3, 3], "shape"),
    ("02.4", lambda n, d, place, heading: math.sqrt(n) * place, "leave the headings out"),
    ("02.4", lambda n, d, place, heading: math.hypot(math.sqrt(n) * place, n * d * heading), "first heading swing"),
    ("02.4", lambda n, d, place, heading: n * math.hypot(place, d * heading), "too large"),
    ("02.4", lambda *given: 2 * simulated_sigma(*given), "too large"),
    ("02.4", lambda *given: simulated_sigma(*given) ** 2, "too small"),
    ("02.4", lambda *given: "0.05 m", "one number"),
    ("02.3", lambda s, m, limit: 1 - np.sum(distances(s, m) <= limit) / len(s), "You count pairs"),
    ("02.3", lambda s, m, limit: 1 - np.sum(distances(m, s).min(1) <= limit) / len(s), "Count the *places*"),
    ("02.3", lambda s, m, limit: np.mean(distances(s, m) > limit), "share of all pairs"),
    ("02.3", lambda s, m, limit: np.mean(distances(s[:, :2], m[:, :2]).min(1) > limit), "on the floor"),
    ("02.3", lambda s, m, limit: np.mean((distances(s, m) ** 2).min(1) > limit), "take the root"),
    ("02.3", lambda s, m, limit: np.mean(distances(s, m).min(1) > 0.1), "use the argument"),
    ("02.3", lambda s, m, limit: np.mean(np.abs(s[:, None] - m).max(2).min(1) > limit), "a cube"),
    ("02.3", lambda s, m, limit: np.mean(np.abs(s[:, None] - m).sum(2).min(1) > limit), "not yet"),
    ("02.3", lambda s, m, limit: np.mean(distances(s, m).max(1) > limit), "Only the nearest"),
    ("03.1", lambda b, n, f: np.where(b > 0.99, np.inf, depth(b, n, f)), "inf where a finite number is expected"),
    ("03.1", lambda b, n, f: np.where(np.isclose(b, 1), np.inf, depth(b, n, f)), "just below 1"),
    ("03.1", lambda b, n, f: np.where((b < 1) & (b > 0), depth(b, n, f), np.inf), "inf where a finite number"),
    ("03.1", lambda b, n, f: np.where(b < 1, n * f / (f + b * (f - n)), np.inf), "the sign below"),
    ("03.1", lambda b, n, f: np.where(b < 1, f / (f - b * (f - n)), np.inf), "missing above the fraction line"),
    ("03.1", lambda b, n, f: np.where(b < 1, 1000 * depth(b, n, f), np.inf), "millimetres"),
    ("03.1", lambda b, n, f: np.where(b < 1, n * f / (f - b * f - n), np.inf), "brackets"),
    ("03.2", lambda a, b, s: 1 / ((1 - s) / min(a, b) + s / max(a, b)), "walk from the nearer end"),
    ("03.2", lambda a, b, s: 1 / (1 / a + s / b), "At s = 1 only z_end"),
    ("03.1", lambda b, n, f: np.where(b < 1, depth(b, n, f), np.nan), "nan there"),
    ("03.1", lambda b, n, f: np.where(b < 1, depth(b, n, f), 0), "a surface at the lens"),
    ("03.1", lambda b, n, f: depth(b, n, f), "not far"),
    (
        "03.3",
        lambda layers, n, f: np.where(
            np.isinf(first := np.min(masked(layers, (layers >= n) & (layers <= f)), 0)), np.nan, first
        ),
        "reads nan",
    ),
    ("03.3", lambda layers, n, f: masked(layers, (layers > n) & (layers < f)).min(axis=0), "exactly on the near"),
    ("03.3", lambda layers, n, f: np.nanmin(np.where((layers >= n) & (layers <= f), layers, np.nan), axis=0), "nan"),
    ("03.4", lambda c, near: c[c[:, 2] >= near], "a corner is new"),
    ("03.4", lambda c, near: np.maximum(c, [-np.inf, -np.inf, near]), "bends the triangle"),
    ("03.4", cut_by_rays, "take the share from Z"),
    ("03.4", lambda c, near: c if c[:, 2].min() >= near else [], "corners and should have"),
    ("03.4", lambda c, near: triangle_fan(c, near)[0:3], "corners and should have"),
    ("03.4", lambda c, near: len(triangle_fan(c, near)), "(n, 3)"),
    ("03.3", lambda layers, n, f: masked(layers, layers >= n).min(axis=0), "not far"),
    ("03.3", lambda layers, n, f: masked(layers, layers <= f).min(axis=0), "not near"),
    ("03.3", lambda layers, n, f: masked(layers, (layers >= n) & (layers <= f))[0], "first layer alone"),
    ("03.3", lambda layers, n, f: masked(layers, (layers >= n) & (layers <= f)).mean(axis=0), "inf where a finite"),
    ("00.1", lambda m, s: 0.1 / (0.1 + np.abs(m - s)), "the pixel's vote"),
    ("00.1", lambda m, s: np.where(np.isinf(s), np.nan, np.abs(m - s)), "at a hole it is inf"),
    ("00.2", lambda v, a: 1 / v - a, "where alpha belongs"),
    ("00.3", too_narrow_too_soon, "left outside"),
    ("00.3", ever_worse, "greatest"),
    ("01.1", lambda p, s: p @ optical_pose(s)[:3, :3] + s[:3], "each matrix on their right"),
    ("01.1", lambda p, s: np.c_[p[:, 2], p[:, 0], -p[:, 1]] @ rotation(s).T + s[:3], "y counts to the *left*"),
    ("01.1", lambda p, s: np.c_[p[:, 2], -p[:, 0], p[:, 1]] @ rotation(s).T + s[:3], "z counts *up*"),
    ("01.2", lambda m: six_numbers(m, m[:3, :3] @ B), "apply B once more"),
    ("01.2", lambda m: six_numbers(m, B @ m[:3, :3]), "multiply by B on the left"),
    ("01.2", lambda m: np.r_[-m[:3, :3].T @ m[:3, 3], six_numbers(m, body(m))[3:]], "world-to-camera"),
    ("01.2", lambda m: np.r_[m[:3, 3], 0, 0, six_numbers(m, body(m))[5]], "Right for a wagon"),
    ("01.2", lambda m: np.r_[six_numbers(m, body(m))[:5], six_numbers(m, body(m))[5] % (2 * np.pi)], "from 0 to 2 pi"),
    (
        "01.3",
        lambda a, b: state_from_matrix(np.linalg.inv(optical_pose(a)) @ optical_pose(b)),
        "*optical* frame",
    ),
    ("01.4", by_first_pose, "first pose alone"),
    ("01.4", lambda a, R, new: tried_one_by_one(a, R, new)[:, ::-1], "returns yaw, pitch, roll"),
    ("02.2", turns_on_the_left, "wrong order"),
    ("02.2", by_heading, "heading alone"),
    ("02.2", lambda steps: np.vstack([np.zeros(3), steps[:, :3, 3]]), "the steps themselves"),
    ("02.3", lambda s, m, limit: np.mean(np.abs(s[:, None] - m).sum(-1).min(1) > limit), "along x, y and z"),
    ("02.4", lambda n, d, p, h: d * h * math.sqrt(sum(k * k for k in range(n))), "left these errors out"),
    (
        "02.4",
        lambda n, d, p, h: np.hypot(p * math.sqrt(2 * n), d * h * math.sqrt(sum(k * k for k in range(n)))),
        "side",
    ),
    ("02.4", lambda n, d, p, h: np.hypot(p * math.sqrt(n), (n - 1) * d * h), "forget the others"),
    (
        "02.4",
        lambda n, d, p, h: np.hypot(p * math.sqrt(n), d * np.deg2rad(h) * math.sqrt(sum(k * k for k in range(n)))),
        "radians already",
    ),
    ("03.1", lambda b, n, f: f * (b - n) / (b * (f - n)), "for b itself"),
    ("03.1", lambda b, n, f: np.where(b == 1, np.inf, n / np.where(b == 1, 1, 1 - b)), "infinite far plane"),
    ("03.1", lambda b, n, f: np.where(b == 1, np.inf, depth(b, 0.1, 30.0)), "the two that are given"),
    ("03.2", lambda a, b, s: 1 / (a + s * (b - a)), "Turn each depth over first"),
    ("03.2", lambda a, b, s: np.full(len(s), 2 * a * b / (a + b)), "Where is s?"),
    ("03.3", lambda layers, n, f: masked(layers, (layers > n) & (layers <= f)).min(axis=0), "on the near plane"),
    ("03.3", lambda layers, n, f: masked(layers, (layers >= n) & (layers < f)).min(axis=0), "on the far plane"),
]
RIGHT = [
    ("00.1", lambda m, s: np.maximum(m, s) - np.minimum(m, s)),
    ("00.1", one_by_one),
    ("00.1", lambda m, s: np.abs(m.astype(np.float32) - s.astype(np.float32))),
    ("00.1", lambda m, s: np.sqrt((s - m) ** 2)),
    ("00.2", lambda v, a: a * (1 - v) / v),
    ("00.2", vote_by_vote),
    ("00.2", lambda v, a: a * (1 / v - 1)),
    ("00.3", coordinate_after_coordinate),
    ("00.3", one_pose_at_a_time),
    ("00.3", weighted_cloud),
    ("01.1", lambda p, s: (optical_pose(s) @ homogeneous(p).T)[:3].T),
    ("01.1", lambda p, s: [list(rotation(s) @ B @ q + s[:3]) for q in p]),
    ("01.2", lambda m: six_numbers(m, body(m), np.arcsin(-body(m)[2, 0]))),
    ("01.1", lambda p, s: np.float32(p @ (rotation(s) @ B).T + s[:3])),
    ("01.3", lambda a, b: state_from_matrix(np.linalg.solve(pose_matrix(a), pose_matrix(b)))),
    ("01.3", axis_by_axis),
    ("01.4", tried_one_by_one),
    ("01.4", lambda a, R, new: tried_one_by_one(a, R, new, firsts=(False, True), signs=(-1, 1)).tolist()),
    ("02.1", aimed),
    ("02.1", lambda p: np.stack([np.linalg.norm(p, axis=1), np.angle(p[:, 0] + 1j * p[:, 1]), aimed(p)[2]])),
    ("02.2", walked),
    ("02.2", one_by_matrix_products),
    ("02.3", lambda s, m, limit: np.array([np.mean(distances(s, m).min(1) > limit)])),
    ("02.4", simulated_sigma),
    ("02.4", lambda n, d, p, h: math.sqrt(n * p * p + sum((d * h * k) ** 2 for k in range(n)))),
    ("02.3", lambda s, m, limit: sum(not any(np.linalg.norm(m - p, axis=1) <= limit) for p in s) / len(s)),
    ("03.1", lambda b, n, f: [[np.inf if v == 1 else 1 / (v / f + (1 - v) / n) for v in row] for row in b]),
    ("03.2", lambda a, b, s: a * b / (b + s * (a - b))),
    ("03.3", lambda layers, n, f: np.sort(masked(layers, (layers >= n) & (layers <= f)), axis=0)[0]),
    ("03.1", lambda b, n, f: np.where(depth(b, n, f) >= f, np.inf, depth(b, n, f))),
    ("03.1", lambda b, n, f: 1 / np.where(b == 1, 0, (1 - b) / n + b / f)),
    ("03.2", lambda a, b, s: [1 / (1 / a + t * (1 / b - 1 / a)) for t in s]),
    ("03.3", lambda layers, n, f: np.nanmin(np.where((layers >= n) & (layers <= f), layers, np.inf), axis=0).tolist()),
    ("03.4", triangle_fan),
    ("03.4", lambda c, near: np.array(triangle_fan(c, near))[::-1]),
    ("00.3", grids_about_the_best),
    ("01.2", lambda m: np.r_[m[:3, 3], Rotation.from_matrix(body(m)).as_euler("ZYX")[::-1]]),
    (
        "02.1",
        lambda p: [
            [f(q) for q in p]
            for f in (np.linalg.norm, lambda q: math.atan2(q[1], q[0]), lambda q: math.asin(q[2] / np.linalg.norm(q)))
        ],
    ),
    ("03.4", lambda c, near: np.float32(np.roll(np.reshape(triangle_fan(c, near), (-1, 3)), 1, axis=0))),
]
