"""Answers that students may give to lessons 01, 02 and 04 to 07, for test_exercise_answers.py."""

from __future__ import annotations

import numpy as np

from course_lib.geometry import BODY_FROM_OPTICAL, optical_pose, pose_matrix, state_from_matrix, wrap_angle

B = BODY_FROM_OPTICAL
LIGHT = 299_792_458.0  # m/s


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


def unwrapped(angles, w):
    return wrap_angle(np.average(np.unwrap(angles), weights=w))


def shadow_points(r, a, e):
    return r * np.cos(e) * np.cos(a), r * np.cos(e) * np.sin(a), r * np.sin(e)


def distances(seen, mapped):
    return np.linalg.norm(seen[:, None] - mapped[None], axis=2)


def phasor(r, f):
    return np.exp(4j * np.pi * f * r / LIGHT)


def pixel(r1, a1, r2, a2, f):
    return a1 * phasor(r1, f) + a2 * phasor(r2, f)


def read(s, f):
    return np.angle(s) / (2 * np.pi) % 1 * LIGHT / (2 * f)


def moved(particles, dx, dy):
    result = particles.copy()
    result[:, 0] += dx
    result[:, 1] += dy
    return result


def by_axes(step):
    """Particles moved by `step(forward, left, cosine, sine)`, which returns the steps in x and y."""

    def answer(particles, sigma_forward, sigma_left, draws):
        yaw = particles[:, 5]
        return moved(particles, *step(sigma_forward * draws[:, 0], sigma_left * draws[:, 1], np.cos(yaw), np.sin(yaw)))

    return answer


def complex_steps(particles, sigma_forward, sigma_left, draws):
    step = (sigma_forward * draws[:, 0] + 1j * sigma_left * draws[:, 1]) * np.exp(1j * particles[:, 5])
    return moved(particles, step.real, step.imag)


def near(particles, state, radius):
    return np.hypot(particles[:, 0] - state[0], particles[:, 1] - state[1]) <= radius


def turn(particles, state):
    return particles[:, 5] - state[5]


def measured_differences(measured, simulated):
    valid = np.isfinite(measured)
    return np.abs(measured[valid] - simulated[valid])


def pixel_by_pixel(measured, simulated, alpha):
    total = 0.0
    for z, s in zip(measured.flat, simulated.flat, strict=True):
        if np.isfinite(z) and np.isfinite(s):
            total += 1 - abs(z - s) / (alpha + abs(z - s))
    return total


def spread_out(likelihoods):
    spread = np.ptp(likelihoods)
    return (likelihoods - likelihoods.min()) / spread if spread else np.ones(len(likelihoods))


def w_of(likelihoods, beta):
    return np.exp(-((spread_out(likelihoods) - 1) ** 2) / beta**2)


def to_sum_one(w):
    return w / w.sum()


def in_place(likelihoods, beta):
    likelihoods -= likelihoods.min()
    return to_sum_one(w_of(likelihoods, beta))


# Exercise, answer, words of the hint that must come.
WRONG = [
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
    ("01.3", lambda y, w: np.arctan2(np.sin(w * y).sum(), np.cos(w * y).sum()), "weigh the headings themselves"),
    ("01.3", lambda y, w: np.arctan2(w @ np.sin(y) / w.sum(), w @ np.cos(y)), "Divide both, or none"),
    ("01.3", unwrapped, "Close"),
    ("02.1", lambda r, a, e: np.array(shadow_points(r, a, e)).reshape(-1, 3), "reshape"),
    ("02.1", lambda r, a, e: np.stack([r * np.cos(a), r * np.sin(a), r * np.tan(e)], 1), "along the ray"),
    ("02.1", lambda r, a, e: np.stack(shadow_points(r, a, e), 1)[:, [1, 0, 2]], "changed places"),
    ("02.2", lambda p, T: (p + T[:3, 3]) @ T[:3, :3], "Two slips"),
    ("02.2", lambda p, T: (homogeneous(p) @ T)[:, :3], "not moved"),
    ("02.2", lambda p, T: p @ T[:3, :3].T + T[3, :3], "where does the scanner stand"),
    ("02.3", lambda s, m, limit: np.mean(distances(s, m) > limit), "share of all pairs"),
    ("02.3", lambda s, m, limit: np.mean(distances(s[:, :2], m[:, :2]).min(1) > limit), "on the floor"),
    ("02.3", lambda s, m, limit: np.mean((distances(s, m) ** 2).min(1) > limit), "take the root"),
    ("02.3", lambda s, m, limit: np.mean(distances(s, m).min(1) > 0.1), "use the argument"),
    ("02.3", lambda s, m, limit: np.mean(np.abs(s[:, None] - m).max(2).min(1) > limit), "a cube"),
    ("02.3", lambda s, m, limit: np.mean(np.abs(s[:, None] - m).sum(2).min(1) > limit), "not yet"),
    ("02.3", lambda s, m, limit: np.mean(distances(s, m).max(1) > limit), "Only the nearest"),
    ("04.1", lambda r, rays: r / np.linalg.norm(rays[..., :2], axis=-1), "no forward component"),
    ("04.1", lambda r, rays: np.sqrt(r**2 - rays[..., 0] ** 2 - rays[..., 1] ** 2), "per metre of depth"),
    ("04.1", lambda r, rays: r * np.cos(np.arctan(rays[..., 0])) * np.cos(np.arctan(rays[..., 1])), "two tilts"),
    ("04.2", lambda r, f: r % (LIGHT / 2 * f), "brackets"),
    ("04.2", lambda r, f: r // (LIGHT / (2 * f)), "%, not //"),
    ("04.2", lambda r, f: np.angle(phasor(r, f)) / (2 * np.pi) * LIGHT / (2 * f), "negative"),
    ("04.2", lambda r, f: 4 * np.pi * f * r / LIGHT % (2 * np.pi), "phase in radians"),
    ("04.3", lambda r1, a1, r2, a2, f: read(pixel(r1, a1 / r1**2, r2, a2 / r2**2, f), f), "amplitudes already"),
    ("04.3", lambda r1, a1, r2, a2, f: np.angle(pixel(r1, a1, r2, a2, f)) % (2 * np.pi), "phase in radians"),
    ("04.3", lambda r1, a1, r2, a2, f: read(pixel(r1, a1, r2, a2, 15e6), 15e6), "15 MHz"),
    ("05.1", lambda start, sigma, t: np.sqrt(start + t * sigma**2), "not the spread at the start"),
    ("05.1", lambda start, sigma, t: np.sqrt(start**2 + t * sigma), "but not sigma"),
    ("05.1", lambda start, sigma, t: np.sqrt(sigma**2 + t * start**2), "swapped the two"),
    ("05.2", by_axes(lambda ahead, left, c, s: (ahead * s + left * c, ahead * c - left * s)), "have changed places"),
    ("05.2", by_axes(lambda ahead, left, c, s: (ahead * c, ahead * s + left)), "but not left"),
    ("05.2", by_axes(lambda ahead, left, c, s: (ahead * c, left * s)), "a part in x *and* a part in y"),
    ("05.2", lambda p, forward, left, draws: complex_steps(p, 1, 1, draws), "about a metre long"),
    ("05.3", lambda p, s, r, a: near(p, s, r).mean() * (np.abs(wrap_angle(turn(p, s))) <= a).mean(), "two shares"),
    ("05.3", lambda p, s, r, a: np.mean(near(p, s, r) & (wrap_angle(abs(turn(p, s))) <= a)), "Wrap first"),
    ("05.3", lambda p, s, r, a: np.mean(near(p, s, r) & (turn(p, s) % (2 * np.pi) <= a)), "to the right"),
    ("05.3", lambda p, s, r, a: np.mean(near(p, s, r - 1e-9) & (abs(wrap_angle(turn(p, s))) <= a)), "exactly `radius`"),
    ("05.3", lambda p, s, r, a: np.mean(near(p, s, r) & (abs(np.sin(turn(p, s))) <= np.sin(a))), "not yet"),
    ("06.1", lambda m, s, a: np.sum(a / a + measured_differences(m, s)), "Brackets"),
    ("06.1", lambda m, s, a: np.sum(1 - measured_differences(m, s) / a), "not alpha alone"),
    ("06.1", lambda m, s, a: a / (a + measured_differences(m, s).sum()), "differences first"),
    ("06.1", lambda m, s, a: pixel_by_pixel(m, np.where(np.isinf(s), 0, s), a), "depth of 0 m"),
    ("06.2", lambda v, beta: to_sum_one(v), "only divide by the sum"),
    ("06.2", lambda v, beta: w_of(v, beta) / len(v), "divide by N"),
    ("06.2", lambda v, beta: to_sum_one(np.exp(-(((spread_out(v) - 1) / beta**2) ** 2))), "beta is squared once"),
    ("06.2", in_place, "changes the array"),
    ("06.3", lambda v, beta: v[np.argmin(np.abs(w_of(v, beta) - 0.5))], "near one half"),
    ("06.3", lambda v, beta: (v.min() + v.max()) / 2, "normalized likelihood"),
    ("06.3", lambda v, beta: v.max() - 0.8326 * beta * np.ptp(v), "rounded"),
]
# Exercise, answer by another way than the solution.
RIGHT = [
    ("01.1", lambda p, s: (optical_pose(s) @ homogeneous(p).T)[:3].T),
    ("01.1", lambda p, s: [list(rotation(s) @ B @ q + s[:3]) for q in p]),
    ("01.2", lambda m: six_numbers(m, body(m), np.arcsin(-body(m)[2, 0]))),
    ("01.3", lambda y, w: np.angle(np.average(np.exp(1j * y), weights=w))),
    ("02.1", lambda r, a, e: np.column_stack(shadow_points(r, a, e))),
    ("02.2", lambda p, T: (homogeneous(p) @ T.T)[:, :3]),
    ("02.3", lambda s, m, limit: sum(not any(np.linalg.norm(m - p, axis=1) <= limit) for p in s) / len(s)),
    ("04.1", lambda r, rays: r * np.cos(np.arctan(np.hypot(rays[..., 0], rays[..., 1])))),
    ("04.2", lambda r, f: [x - np.floor(x * 2 * f / LIGHT) * LIGHT / (2 * f) for x in r]),
    ("04.2", lambda r, f: read(phasor(r, f), f)),
    ("04.3", lambda r1, a1, r2, a2, f: np.angle(pixel(r1, a1, r2, a2, f)) * LIGHT / (4 * np.pi * f) % (LIGHT / f / 2)),
    ("05.1", lambda start, sigma, t: np.hypot(start, np.sqrt(t) * sigma)),
    ("05.2", complex_steps),
    ("05.3", lambda p, s, r, a: np.count_nonzero(near(p, s, r) & (np.cos(turn(p, s)) >= np.cos(a))) / len(p)),
    ("06.1", lambda m, s, a: np.nansum(a / (a + np.abs(m - s)))),
    ("06.1", pixel_by_pixel),
    ("06.2", lambda v, beta: to_sum_one(np.exp(-(((v - v.max()) / (np.ptp(v) + 1e-12) / beta) ** 2)))),
    ("06.3", lambda v, beta: np.interp(1 - beta * np.log(2) ** 0.5, [0, 1], [v.min(), v.max()])),
]
