"""Stages of project P1: the filter's steps one by one, then one round of figure 1 in the right order."""

import numpy as np

from course_lib.geometry import wrap_angle
from course_lib.lessons.kit.exercises import Exercise, Mistake

# P1.1: eqs (3), (4)


def initial_particles(state0: np.ndarray, n: int) -> np.ndarray:
    """Particles (n, 6), all at the start (6,)."""
    return np.tile(np.asarray(state0, dtype=np.float64), (n, 1))


def _start(rng: np.random.Generator) -> tuple:
    return np.concatenate([rng.uniform(-9, 9, 3), rng.uniform(-np.pi, np.pi, 3)]), int(rng.integers(1, 9))


# P1.2: eq. (5), along the body's axes


def propagate(particles: np.ndarray, sigma: np.ndarray, noise: np.ndarray) -> np.ndarray:
    """Particles (N, 6) moved by sigma times noise: forward, left and up of each, then roll, pitch, yaw."""
    forward, left = (sigma * noise)[:, 0], (sigma * noise)[:, 1]
    moved = particles + sigma * noise
    yaw = particles[:, 5]
    moved[:, 0] = particles[:, 0] + forward * np.cos(yaw) - left * np.sin(yaw)
    moved[:, 1] = particles[:, 1] + forward * np.sin(yaw) + left * np.cos(yaw)
    return moved


def _cloud(rng: np.random.Generator) -> tuple:
    """Particles that look every way, noise of a wagon: some components are kept by a sigma of 0."""
    n = int(rng.integers(3, 9))
    particles = np.concatenate([rng.uniform(-9, 9, (n, 3)), rng.uniform(-np.pi, np.pi, (n, 3))], axis=1)
    sigma = np.array([rng.uniform(0.1, 0.4), rng.uniform(0.02, 0.08), 0.0, 0.0, 0.0, rng.uniform(0.2, 0.6)])
    return particles, sigma, rng.standard_normal((n, 6))


def _every_noise(rng: np.random.Generator) -> tuple:
    """A hand-held camera: up, roll and pitch have noise of their own."""
    particles, sigma, noise = _cloud(rng)
    return particles, sigma + np.array([0, 0, 0.1, 0.02, 0.03, 0]), noise


def _facing_back(rng: np.random.Generator) -> tuple:
    particles, sigma, noise = _cloud(rng)
    particles[:, 5] = rng.choice((-1, 1), len(particles)) * np.pi
    return particles, sigma, noise


def _nothing_moves(rng: np.random.Generator) -> tuple:
    particles, _, noise = _cloud(rng)
    return particles, np.zeros(6), noise


def _yaw_wrapped(particles: np.ndarray, sigma: np.ndarray, noise: np.ndarray) -> np.ndarray:
    """Right as well: the yaw brought back to [-pi, pi)."""
    moved = propagate(particles, sigma, noise)
    moved[:, 5] = (moved[:, 5] + np.pi) % (2 * np.pi) - np.pi
    return moved


def _angles_wrapped(particles: np.ndarray, sigma: np.ndarray, noise: np.ndarray) -> np.ndarray:
    """Right as well: all angles brought back to [-pi, pi)."""
    moved = propagate(particles, sigma, noise)
    moved[:, 3:] = (moved[:, 3:] + np.pi) % (2 * np.pi) - np.pi
    return moved


def _along_the_world(particles: np.ndarray, sigma: np.ndarray, noise: np.ndarray) -> np.ndarray:
    return particles + sigma * noise


def _turned_the_other_way(particles: np.ndarray, sigma: np.ndarray, noise: np.ndarray) -> np.ndarray:
    mirrored = particles * [1, 1, 1, 1, 1, -1]
    moved = propagate(mirrored, sigma, noise)
    moved[:, 5] = particles[:, 5] + (sigma * noise)[:, 5]
    return moved


def _by_the_new_yaw(particles: np.ndarray, sigma: np.ndarray, noise: np.ndarray) -> np.ndarray:
    turned = particles + sigma * noise * [0, 0, 0, 0, 0, 1]
    return propagate(turned, sigma * [1, 1, 1, 1, 1, 0], noise)


def _one_noise_for_all(particles: np.ndarray, sigma: np.ndarray, noise: np.ndarray) -> np.ndarray:
    return propagate(particles, sigma, np.tile(noise[0], (len(particles), 1)))


def _right_for_left(particles: np.ndarray, sigma: np.ndarray, noise: np.ndarray) -> np.ndarray:
    return propagate(particles, sigma, noise * [1, -1, 1, 1, 1, 1])


def _cosine_and_sine_exchanged(particles: np.ndarray, sigma: np.ndarray, noise: np.ndarray) -> np.ndarray:
    moved, step = particles + sigma * noise, sigma * noise
    cosine, sine = np.cos(particles[:, 5]), np.sin(particles[:, 5])
    moved[:, 0] = particles[:, 0] + sine * step[:, 0] - cosine * step[:, 1]
    moved[:, 1] = particles[:, 1] + cosine * step[:, 0] + sine * step[:, 1]
    return moved


def _only_moved(particles: np.ndarray, sigma: np.ndarray, noise: np.ndarray) -> np.ndarray:
    moved = propagate(particles, sigma, noise)
    moved[:, 5] = particles[:, 5]
    return moved


def _only_wagons_noise(particles: np.ndarray, sigma: np.ndarray, noise: np.ndarray) -> np.ndarray:
    return propagate(particles, sigma * [1, 1, 0, 0, 0, 1], noise)


# P1.3: eq. (8)


def likelihood(measured: np.ndarray, simulated: np.ndarray, alpha: float) -> np.ndarray:
    """Likelihood (N,) of simulated images (N, H, W) against a measured one (H, W) with NaN where nothing came."""
    valid = np.isfinite(measured)
    difference = np.abs(measured[valid] - simulated[:, valid])
    return np.sum(alpha / (alpha + difference), axis=1)


def _images(rng: np.random.Generator) -> tuple:
    """Images with holes on both sides."""
    n, height, width = (int(k) for k in rng.integers(2, 6, 3))
    measured = rng.uniform(1, 9, (height, width))
    simulated = measured + rng.normal(0, 0.2, (n, height, width))
    simulated[rng.random(simulated.shape) < 0.15] = np.inf
    measured[rng.random(measured.shape) < 0.2] = np.nan
    measured.flat[0], measured.flat[1] = np.nan, 3.0
    simulated[0].flat[1] = np.inf
    return measured, simulated, float(rng.uniform(0.05, 0.5))


def _nothing_measured(rng: np.random.Generator) -> tuple:
    measured, simulated, _ = _images(rng)
    return np.full_like(measured, np.nan), simulated, 0.1


def _nothing_hit(rng: np.random.Generator) -> tuple:
    measured, simulated, _ = _images(rng)
    simulated[1] = np.inf
    return measured, simulated, 0.1


def _misses_left_out(measured: np.ndarray, simulated: np.ndarray, alpha: float) -> np.ndarray:
    terms = alpha / (alpha + np.abs(measured - simulated))
    used = np.isfinite(measured) & np.isfinite(simulated)
    count = np.maximum(used.sum(axis=(1, 2)), 1)
    return np.where(used, terms, 0.0).sum(axis=(1, 2)) / count * np.isfinite(measured).sum()


def _mean(measured: np.ndarray, simulated: np.ndarray, alpha: float) -> np.ndarray:
    return likelihood(measured, simulated, alpha) / max(1, np.isfinite(measured).sum())


def _misses_worth_one(measured: np.ndarray, simulated: np.ndarray, alpha: float) -> np.ndarray:
    misses = np.isinf(simulated[:, np.isfinite(measured)]).sum(axis=1)
    return likelihood(measured, simulated, alpha) + misses


def _infinity_by_infinity(measured: np.ndarray, simulated: np.ndarray, alpha: float) -> np.ndarray:
    valid = np.isfinite(measured)
    difference = np.abs(measured[valid] - simulated[:, valid])
    with np.errstate(invalid="ignore"):
        return np.sum(1 - difference / (alpha + difference), axis=1)


def _worth_one(measured: np.ndarray, simulated: np.ndarray, alpha: float) -> np.ndarray:
    return likelihood(measured, simulated, alpha) + np.isnan(measured).sum()


def _cost(measured: np.ndarray, simulated: np.ndarray, alpha: float) -> np.ndarray:
    return np.isfinite(measured).sum() - likelihood(measured, simulated, alpha)


def _bell(measured: np.ndarray, simulated: np.ndarray, alpha: float) -> np.ndarray:
    valid = np.isfinite(measured)
    return np.exp(-((measured[valid] - simulated[:, valid]) ** 2) / (2 * alpha**2)).sum(axis=1)


def _holes_as_zero(measured: np.ndarray, simulated: np.ndarray, alpha: float) -> np.ndarray:
    return likelihood(np.nan_to_num(measured), simulated, alpha)


def _squared(measured: np.ndarray, simulated: np.ndarray, alpha: float) -> np.ndarray:
    valid = np.isfinite(measured)
    return np.sum(alpha / (alpha + (measured[valid] - simulated[:, valid]) ** 2), axis=1)


def _signed(measured: np.ndarray, simulated: np.ndarray, alpha: float) -> np.ndarray:
    valid = np.isfinite(measured)
    return np.sum(alpha / (alpha + measured[valid] - simulated[:, valid]), axis=1)


# P1.4: eqs (9), (10), (11)


def particle_weights(l: np.ndarray, beta: float) -> np.ndarray:  # noqa: E741 - the paper's letter
    """Weights (N,), summing to one, of likelihoods (N,)."""
    spread = l.max() - l.min()
    if spread == 0:
        return np.full(len(l), 1 / len(l))
    w = np.exp(-(((l - l.min()) / spread - 1) ** 2) / beta**2)
    return w / w.sum()


def _likelihoods(rng: np.random.Generator) -> tuple:
    """Likelihoods as they come from images."""
    return rng.uniform(100, 900) + rng.uniform(0, 50, int(rng.integers(3, 9))), float(rng.uniform(0.1, 0.8))


def _the_papers_beta(rng: np.random.Generator) -> tuple:
    return _likelihoods(rng)[0], 0.01


def _all_alike(rng: np.random.Generator) -> tuple:
    return np.full(int(rng.integers(2, 6)), rng.uniform(100, 900)), 0.01


def _one_alone(rng: np.random.Generator) -> tuple:
    return rng.uniform(100, 900, 1), 0.01


def _quotient(values: np.ndarray) -> np.ndarray:
    spread = np.ptp(values)
    return np.ones(len(values)) if spread == 0 else (values - values.min()) / spread


def _shares(values: np.ndarray) -> np.ndarray:
    total = values.sum()
    return values / total if total > 0 else np.full(len(values), 1 / len(values))


# P1.5: eq. (12)


def estimate(particles: np.ndarray, w: np.ndarray) -> np.ndarray:
    """Weighted mean state (6,), the angles on the circle."""
    angles = particles[:, 3:]
    mean = np.arctan2(w @ np.sin(angles), w @ np.cos(angles))
    return np.concatenate([w @ particles[:, :3], mean])


def _weighted_cloud(rng: np.random.Generator) -> tuple:
    """A cloud about one state, its yaw often near the wrap, and uneven weights."""
    n = int(rng.integers(4, 9))
    centre = np.concatenate([rng.uniform(-9, 9, 3), rng.uniform(-0.2, 0.2, 2), [rng.choice([np.pi, 0.0, 2.0])]])
    particles = centre + rng.normal(0, [0.3, 0.3, 0.1, 0.05, 0.05, 0.3], (n, 6))
    particles[:, 3:] = (particles[:, 3:] + np.pi) % (2 * np.pi) - np.pi
    w = rng.uniform(0.1, 1, n)
    return particles, w / w.sum()


def _on_both_sides_of_the_seam(rng: np.random.Generator) -> tuple:
    particles, w = _weighted_cloud(rng)
    particles[:, 5] = np.pi - rng.uniform(0.01, 0.1, len(w))
    particles[::2, 5] *= -1
    return particles, w


def _swapped(particles: np.ndarray, w: np.ndarray) -> np.ndarray:
    angles = particles[:, 3:]
    return np.concatenate([w @ particles[:, :3], np.arctan2(w @ np.cos(angles), w @ np.sin(angles))])


def _unweighted_angles(particles: np.ndarray, w: np.ndarray) -> np.ndarray:
    return np.concatenate([w @ particles[:, :3], estimate(particles, np.full(len(w), 1 / len(w)))[3:]])


def _only_yaw(particles: np.ndarray, w: np.ndarray) -> np.ndarray:
    found = estimate(particles, w)
    found[3:5] = particles[0, 3:5]
    return found


def _half_the_directions(particles: np.ndarray, w: np.ndarray) -> np.ndarray:
    angles = particles[:, 3:]
    return np.concatenate([w @ particles[:, :3], np.arctan((w @ np.sin(angles)) / (w @ np.cos(angles)))])


def _about_the_first(particles: np.ndarray, w: np.ndarray) -> np.ndarray:
    first = particles[0, 3:]
    mean = first + w @ wrap_angle(particles[:, 3:] - first)
    return np.concatenate([w @ particles[:, :3], wrap_angle(mean)])


# P1.6: resampling, 3.4


def resample(w: np.ndarray, u: float) -> np.ndarray:
    """Indices (N,) of the particles that live on: N equal steps through the summed weights, from u / N on."""
    cumulative = np.cumsum(w)
    cumulative[np.flatnonzero(w)[-1] :] = 1.0
    return np.searchsorted(cumulative, (np.arange(len(w)) + u) / len(w), side="right")


def _weights_and_offset(rng: np.random.Generator) -> tuple:
    """Uneven weights, some of them zero; an offset."""
    n = int(rng.integers(4, 11))
    w = rng.uniform(0.02, 1, n) ** 3
    w[1:][rng.random(n - 1) < 0.2] = 0.0
    return w / w.sum(), float(rng.uniform(0.05, 0.95))


def _last_without_weight(rng: np.random.Generator) -> tuple:
    return np.array([0.25, 0.25, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0]), float(rng.uniform(0.05, 0.95))


def _all_on_one(rng: np.random.Generator) -> tuple:
    n = int(rng.integers(4, 11))
    return np.eye(n)[rng.integers(n)], float(rng.uniform(0.05, 0.95))


def _first_without_weight(rng: np.random.Generator) -> tuple:
    """The first point lies at 0, where the stretch of a particle without weight begins and ends."""
    return np.array([0.0, 0.4, 0.6, 0.0]), 0.0


def _sum_short_of_one(rng: np.random.Generator) -> tuple:
    """Weights as single precision leaves them: their sum ends before the last point."""
    return np.array([0.3, 0.3, 0.4, 0.0]) * (1 - 1e-7), 1 - 1e-8


def _equal_weights(rng: np.random.Generator) -> tuple:
    return np.full(8, 0.125), float(rng.uniform(0.05, 0.95))


def _from_middle(w: np.ndarray, u: float) -> np.ndarray:
    return resample(w, 0.5)


def _offset_not_divided(w: np.ndarray, u: float) -> np.ndarray:
    points = (np.arange(len(w)) / len(w) + u) % 1.0
    return np.minimum(np.searchsorted(np.cumsum(w), points, side="right"), len(w) - 1)


def _one_too_far(w: np.ndarray, u: float) -> np.ndarray:
    return np.minimum(resample(w, u) + 1, len(w) - 1)


def _rounded_copies(w: np.ndarray, u: float) -> np.ndarray:
    copies = np.round(len(w) * w).astype(int)
    found = np.repeat(np.arange(len(w)), copies)
    return np.concatenate([found, np.full(len(w), np.argmax(w))])[: len(w)]


def _positions(w: np.ndarray, u: float) -> np.ndarray:
    return (np.arange(len(w)) + u) / len(w)


# P1.7: one round of figure 1


def one_round(
    particles: np.ndarray, measured: np.ndarray, render, sigma: np.ndarray, beta: float, noise: np.ndarray, u: float
) -> tuple[np.ndarray, np.ndarray]:
    """Estimate (6,) and the particles (N, 6) that live on, after one frame; alpha 0.1 m."""
    moved = propagate(particles, sigma, noise)
    w = particle_weights(likelihood(measured, render(moved), 0.1), beta)
    return estimate(moved, w), moved[resample(w, u)]


def wall_ahead(states: np.ndarray) -> np.ndarray:
    """Depth images (N, 3, 5) of a wall at x = 10 m and one at y = 2 m, from states (N, 6): stands for a renderer."""
    states = np.atleast_2d(states)
    rays = np.linspace(-0.4, 0.4, 5)[None, None, :] * np.ones((1, 3, 1))
    yaw = states[:, 5][:, None, None] + np.arctan(rays)
    with np.errstate(divide="ignore"):
        front = (10 - states[:, 0][:, None, None]) / np.cos(yaw)
        side = (2 - states[:, 1][:, None, None]) / np.sin(yaw)
    side = np.where(side > 0, side, np.inf)
    return np.minimum(front, side) * np.cos(np.arctan(rays))


def _a_frame(rng: np.random.Generator) -> tuple:
    """A cloud before a frame, and what a camera two steps on measures."""
    n = int(rng.integers(6, 12))
    true = np.array([rng.uniform(1, 5), rng.uniform(-1, 1), 1.0, 0.0, 0.0, rng.uniform(-0.3, 0.3)])
    particles = true + rng.normal(0, [0.1, 0.05, 0, 0, 0, 0.03], (n, 6))
    measured = wall_ahead(true)[0] + rng.normal(0, 0.01, (3, 5))
    measured.flat[int(rng.integers(15))] = np.nan
    sigma = np.array([0.15, 0.05, 0.0, 0.0, 0.0, 0.03])
    beta = float(rng.choice([0.01, rng.uniform(0.3, 0.8)]))
    return particles, measured, wall_ahead, sigma, beta, rng.standard_normal((n, 6)), float(rng.uniform(0.05, 0.95))


def _all_at_one_place(rng: np.random.Generator) -> tuple:
    particles, measured, render, _, beta, noise, u = _a_frame(rng)
    return np.tile(particles[0], (len(particles), 1)), measured, render, np.zeros(6), beta, noise, u


def _weighed(states: np.ndarray, measured: np.ndarray, render, beta: float) -> np.ndarray:
    return particle_weights(likelihood(measured, render(states), 0.1), beta)


def _heaviest_alone(particles, measured, render, sigma, beta, noise, u):
    moved = propagate(particles, sigma, noise)
    w = _weighed(moved, measured, render, beta)
    return moved[np.argmax(w)], moved[resample(w, u)]


def _weights_forgotten(particles, measured, render, sigma, beta, noise, u):
    moved = propagate(particles, sigma, noise)
    _, kept = one_round(particles, measured, render, sigma, beta, noise, u)
    return estimate(moved, np.full(len(moved), 1 / len(moved))), kept


def _estimate_before_moving(particles, measured, render, sigma, beta, noise, u):
    moved = propagate(particles, sigma, noise)
    w = _weighed(moved, measured, render, beta)
    return estimate(particles, w), moved[resample(w, u)]


def _estimate_after_resampling(particles, measured, render, sigma, beta, noise, u):
    _, kept = one_round(particles, measured, render, sigma, beta, noise, u)
    return estimate(kept, np.full(len(kept), 1 / len(kept))), kept


def _weighed_where_they_were(particles, measured, render, sigma, beta, noise, u):
    moved, w = propagate(particles, sigma, noise), _weighed(particles, measured, render, beta)
    return estimate(moved, w), moved[resample(w, u)]


def _moved_at_the_end(particles, measured, render, sigma, beta, noise, u):
    w = _weighed(particles, measured, render, beta)
    return estimate(particles, w), propagate(particles[resample(w, u)], sigma, noise)


def _not_resampled(particles, measured, render, sigma, beta, noise, u):
    found, _ = one_round(particles, measured, render, sigma, beta, noise, u)
    return found, propagate(particles, sigma, noise)


def _old_ones_copied(particles, measured, render, sigma, beta, noise, u):
    w = _weighed(propagate(particles, sigma, noise), measured, render, beta)
    return one_round(particles, measured, render, sigma, beta, noise, u)[0], particles[resample(w, u)]


def _weighed_again_after_resampling(particles, measured, render, sigma, beta, noise, u):
    kept = one_round(particles, measured, render, sigma, beta, noise, u)[1]
    return estimate(kept, _weighed(kept, measured, render, beta)), kept


def _moved_twice(particles, measured, render, sigma, beta, noise, u):
    found, kept = one_round(particles, measured, render, sigma, beta, noise, u)
    return found, propagate(kept, sigma, noise)


def _raw_likelihoods(particles, measured, render, sigma, beta, noise, u):
    moved = propagate(particles, sigma, noise)
    w = _shares(likelihood(measured, render(moved), 0.1))
    return estimate(moved, w), moved[resample(w, u)]


def _other_way_round(particles, measured, render, sigma, beta, noise, u):
    return one_round(particles, measured, render, sigma, beta, noise, u)[::-1]


EXERCISES = [
    Exercise(
        number="P1.1",
        level="warm-up",
        solution=initial_particles,
        inputs=_start,
        mistakes=(
            Mistake(
                lambda state0, n: np.tile(state0[:, None], (1, n)),
                "You have a column a particle. One row a particle: n rows of six numbers.",
            ),
            Mistake(
                lambda state0, n: np.tile(state0, n),
                "You have one long row of 6 n numbers. Each particle is a row of its own.",
            ),
            Mistake(
                lambda state0, n: np.concatenate([state0[None], np.zeros((n - 1, 6))]),
                "Only your first particle is at the start; the others are at the origin.",
            ),
            Mistake(
                lambda state0, n: np.tile(np.concatenate([state0[:3], np.zeros(3)]), (n, 1)),
                "You copy the position, and lose roll, pitch and yaw.",
            ),
            Mistake(lambda state0, n: np.tile(state0, (n + 1, 1)), "You have one particle too many: n rows."),
            Mistake(
                lambda state0, n: state0 + np.linspace(0.01, 0.1, 6 * n).reshape(n, 6),
                "Yours are spread already. By (4) all start alike; the first propagation spreads them.",
            ),
        ),
    ),
    Exercise(
        number="P1.2",
        solution=propagate,
        inputs=_cloud,
        cases=(_facing_back, _nothing_moves, _every_noise),
        others=(_yaw_wrapped, _angles_wrapped),
        mistakes=(
            Mistake(_along_the_world, "That moves along the world's axes. The noise is meant forward and to the left."),
            Mistake(_turned_the_other_way, "Turned the wrong way: at yaw 90 degrees, forward is the world's +y."),
            Mistake(_by_the_new_yaw, "You turn first and then move. The noise goes along the yaw *before* this frame."),
            Mistake(_right_for_left, "Left and right are exchanged: at yaw 0, left is the world's +y."),
            Mistake(_cosine_and_sine_exchanged, "Cosine and sine are exchanged: at yaw 0, forward is the world's +x."),
            Mistake(_one_noise_for_all, "All your particles get the same noise: row i of `noise` is particle i's."),
            Mistake(_only_moved, "Yours moves, but does not turn: the last component of the noise is the yaw's."),
            Mistake(
                lambda particles, sigma, noise: propagate(particles, sigma**2, noise),
                "You scale by the variance. The noise is standard normal: times sigma, not its square.",
            ),
            Mistake(
                lambda particles, sigma, noise: propagate(particles, np.ones(6), noise),
                "sigma is missing: the noise is standard normal, one metre and one radian wide.",
            ),
            Mistake(
                lambda particles, sigma, noise: propagate(particles, sigma, noise) - particles,
                "That is the step alone. Return where the particles are after it.",
            ),
            Mistake(
                lambda particles, sigma, noise: propagate(
                    np.concatenate([particles[:, :5], np.deg2rad(particles[:, 5:])], axis=1), sigma, noise
                ),
                "The yaw is in radians already; you convert it once more.",
            ),
            Mistake(
                _only_wagons_noise,
                "Up, roll and pitch have noise, too: sigma holds six numbers. In the wagon three of them are 0.",
            ),
        ),
    ),
    Exercise(
        number="P1.3",
        solution=likelihood,
        inputs=_images,
        cases=(_nothing_measured, _nothing_hit),
        mistakes=(
            Mistake(
                lambda measured, simulated, alpha: np.sum(alpha / (alpha + np.abs(measured - simulated)), axis=(1, 2)),
                "A pixel that was not measured (NaN) makes the whole sum NaN. Leave it out, for all particles alike.",
            ),
            Mistake(
                _misses_left_out,
                "You leave simulated misses out, so looking into holes costs nothing. A miss counts, with term 0.",
            ),
            Mistake(_mean, "That is a mean over the pixels. Eq. (8) is a sum."),
            Mistake(
                lambda measured, simulated, alpha: likelihood(measured, simulated, alpha) / measured.size,
                "You divide by the number of all pixels. Eq. (8) is a sum.",
            ),
            Mistake(_misses_worth_one, "A simulated miss counts as perfect in yours. It differs by infinity: term 0."),
            Mistake(
                _infinity_by_infinity,
                "inf / inf is NaN: that is your simulated misses. Write the term as one fraction.",
            ),
            Mistake(_worth_one, "Pixels without measurement get the full 1 in yours. They are left out."),
            Mistake(_cost, "Yours grows with the disagreement: the 1 - is missing, and the best would be the worst."),
            Mistake(_bell, "That is a bell curve. The term of (8) is 1 - d / (alpha + d), d the absolute difference."),
            Mistake(_holes_as_zero, "A pixel without measurement is not a wall at 0 m: leave NaN out."),
            Mistake(_squared, "The difference stands in (8) as an absolute value, not squared."),
            Mistake(
                lambda measured, simulated, alpha: likelihood(measured, simulated, 0.1),
                "Your alpha is always 0.1 m: use the one that is given.",
            ),
            Mistake(
                lambda measured, simulated, alpha: np.array([likelihood(measured, simulated, alpha).sum()]),
                "One number for all particles: sum over the pixels of each, not over the particles.",
            ),
            Mistake(
                _signed,
                "The difference is not made absolute: too near counts as more than perfect, or as infinitely bad.",
            ),
        ),
    ),
    Exercise(
        number="P1.4",
        solution=particle_weights,
        inputs=_likelihoods,
        cases=(_the_papers_beta, _all_alike, _one_alone),
        mistakes=(
            Mistake(
                lambda values, beta: _shares(np.exp(-((_quotient(values) - 1) ** 2) / beta)),
                "beta stands squared in (10).",
            ),
            Mistake(
                lambda values, beta: np.exp(-((_quotient(values) - 1) ** 2) / beta**2),
                "Weights must sum to one: (11) is still missing.",
            ),
            Mistake(
                lambda values, beta: particle_weights(values, beta) * len(values),
                "Your weights sum to N. By (11) they sum to one.",
            ),
            Mistake(
                lambda values, beta: _shares(np.exp(-(_quotient(values) ** 2) / beta**2)),
                "The worst particle gets most in yours: it is (l - 1) that is squared, the distance from the best.",
            ),
            Mistake(
                lambda values, beta: _shares(_quotient(values)), "That is (9) made to sum to one; (10) is missing."
            ),
            Mistake(
                lambda values, beta: _shares(np.exp(-((values / values.max() - 1) ** 2) / beta**2)),
                "You divide by the greatest likelihood. (9) spreads them from 0 for the worst to 1 for the best.",
            ),
            Mistake(
                lambda values, beta: _shares(np.exp(-((_quotient(values) - 1) ** 2) / (2 * beta**2))),
                "There is no 2 in (10): it is no normal distribution.",
            ),
            Mistake(
                lambda values, beta: _shares(np.exp(-np.abs(_quotient(values) - 1) / beta)),
                "The exponent of (10) is a square; yours falls off along a straight line.",
            ),
            Mistake(
                lambda values, beta: _shares(np.exp(-((_quotient(values) - 1) ** 2) / 0.01**2)),
                "Your beta is always 0.01: use the one that is given.",
            ),
            Mistake(
                lambda values, beta: (
                    np.full(len(values), np.nan) if np.ptp(values) == 0 else particle_weights(values, beta)
                ),
                "0/0 where all likelihoods agree. Nothing speaks for one of them then: what are fair weights?",
            ),
            Mistake(
                lambda values, beta: np.zeros(len(values)) if np.ptp(values) == 0 else particle_weights(values, beta),
                "Where all likelihoods agree your weights are 0, and do not sum to one. What would be fair?",
            ),
            Mistake(
                lambda values, beta: np.ones(len(values)) if np.ptp(values) == 0 else particle_weights(values, beta),
                "Where all likelihoods agree each of your weights is 1: they must sum to one there, too.",
            ),
            Mistake(
                lambda values, beta: np.eye(len(values))[0] if np.ptp(values) == 0 else particle_weights(values, beta),
                "Where all likelihoods agree one particle gets everything in yours. Nothing speaks for it.",
            ),
        ),
    ),
    Exercise(
        number="P1.5",
        solution=estimate,
        inputs=_weighted_cloud,
        cases=(_on_both_sides_of_the_seam,),
        mistakes=(
            Mistake(
                lambda particles, w: w @ particles, "(12) as printed: its angles fail at +-180 degrees (lesson 07)."
            ),
            Mistake(
                lambda particles, w: particles.mean(axis=0), "A plain mean: where are the weights, and the circle?"
            ),
            Mistake(
                lambda particles, w: particles[np.argmax(w)].copy(),
                "That is the heaviest particle. In (12) all take part.",
            ),
            Mistake(_swapped, "np.arctan2 takes the sine first, then the cosine."),
            Mistake(_unweighted_angles, "Your positions are weighted, your angles are not."),
            Mistake(_only_yaw, "Your yaw is right; roll and pitch are those of one particle."),
            Mistake(
                lambda particles, w: np.concatenate([w @ particles[:, :3], estimate(particles, w)[3:] % (2 * np.pi)]),
                "Right directions, but from 0 to 2 pi. The course's angles lie between -pi and pi.",
            ),
            Mistake(
                lambda particles, w: np.concatenate([w @ particles[:, :3], np.rad2deg(estimate(particles, w)[3:])]),
                "Your angles are in degrees: a state is in metres and radians.",
            ),
            Mistake(
                lambda particles, w: estimate(particles, np.full(len(w), 1 / len(w))),
                "You have the circle, but no weights.",
            ),
            Mistake(
                lambda particles, w: np.concatenate([w @ particles[:, :5], estimate(particles, w)[5:]]),
                "Yaw is on the circle in yours, roll and pitch are not: all three angles are averaged there.",
            ),
            Mistake(
                _half_the_directions,
                "arctan of a quotient knows half of the directions only: np.arctan2 takes both sums.",
            ),
            Mistake(
                lambda particles, w: np.concatenate([w @ particles[:, :3], w @ (particles[:, 3:] % (2 * np.pi))]),
                "From 0 to 2 pi the seam is at 0 instead of 180 degrees; it is still there. Average on the circle.",
            ),
            Mistake(
                _about_the_first,
                "You average differences from the first particle: which one is first decides the answer. Add arrows.",
            ),
        ),
    ),
    Exercise(
        number="P1.6",
        solution=resample,
        inputs=_weights_and_offset,
        cases=(_last_without_weight, _first_without_weight, _sum_short_of_one, _all_on_one, _equal_weights),
        mistakes=(
            Mistake(_offset_not_divided, "The offset is u of one step: the first point lies at u / N, not at u."),
            Mistake(_from_middle, "Your points do not start at u / N: where is u?"),
            Mistake(
                lambda w, u: resample(w, 0.0),
                "Your points start at 0. The random offset makes the draw fair: use u.",
            ),
            Mistake(lambda w, u: np.arange(len(w)), "You keep every particle once, whatever it weighs."),
            Mistake(_one_too_far, "Yours is one particle too far: index 0 is the first one."),
            Mistake(_rounded_copies, "You round N w. That is not unbiased: step through the summed weights instead."),
            Mistake(_positions, "These are the points. Return which particle's share of the sum each falls into."),
            Mistake(
                lambda w, u: np.argsort(-w, kind="stable"),
                "That sorts the particles; none is copied, none vanishes.",
            ),
            Mistake(
                lambda w, u: np.full(len(w), np.argmax(w)), "You keep the heaviest alone. Others have a share, too."
            ),
            Mistake(
                lambda w, u: np.bincount(resample(w, u), minlength=len(w)),
                "These are the numbers of copies. Return the indices, each as often as it is copied.",
            ),
            Mistake(
                lambda w, u: np.minimum(np.searchsorted(w, _positions(w, u), side="right"), len(w) - 1),
                "You look the points up among the weights. They lie along the *sum* of the weights so far.",
            ),
            Mistake(
                lambda w, u: np.minimum(np.searchsorted(np.cumsum(w), _positions(w, u)), len(w) - 1),
                "Right, but for a point on the end of a stretch: at u = 0 you draw a particle of weight 0.",
            ),
            Mistake(
                lambda w, u: np.minimum(np.searchsorted(np.cumsum(w), _positions(w, u), side="right"), len(w) - 1),
                "Right, but where the sum ends short of 1 by rounding you draw the last particle, be its weight 0.",
            ),
            Mistake(lambda w, u: resample(w, u) + 1, "Your indices begin with 1; NumPy's begin with 0."),
            Mistake(lambda w, u: resample(w, u)[::-1], "Right particles, but descending."),
            Mistake(
                lambda w, u: w[resample(w, u)],
                "These are the weights of the particles that live on. Return their indices.",
            ),
        ),
    ),
    Exercise(
        number="P1.7",
        level="challenge",
        solution=one_round,
        inputs=_a_frame,
        cases=(_all_at_one_place,),
        mistakes=(
            Mistake(
                _estimate_after_resampling,
                "You estimate from the copies. The weights know more: estimate first, then resample.",
            ),
            Mistake(
                _weighed_where_they_were,
                "You render from where the particles were. The image is of *this* frame: move them first.",
            ),
            Mistake(
                _moved_at_the_end,
                "You move at the end of the round, so this frame's image weighs the last frame's particles.",
            ),
            Mistake(_not_resampled, "Your particles are not resampled: the light ones live on with the heavy ones."),
            Mistake(_old_ones_copied, "You copy the particles from before they moved."),
            Mistake(
                _weighed_again_after_resampling,
                "You weigh the copies once more for the estimate: so the image counts twice.",
            ),
            Mistake(_moved_twice, "You move twice: before weighing, and once more what lives on."),
            Mistake(_raw_likelihoods, "You weigh by the raw likelihoods: (9) and (10) are left out."),
            Mistake(
                lambda particles, measured, render, sigma, beta, noise, u: one_round(
                    particles, measured, render, sigma, 0.01, noise, u
                ),
                "Your beta is always 0.01: use the one that is given.",
            ),
            Mistake(_other_way_round, "Return the estimate first, then the particles."),
            Mistake(
                lambda particles, measured, render, sigma, beta, noise, u: one_round(
                    particles, measured, render, 0 * sigma, beta, noise, u
                ),
                "Your particles do not move at all: where is the system noise?",
            ),
            Mistake(_heaviest_alone, "Your estimate is the heaviest particle. In (12) all take part."),
            Mistake(_weights_forgotten, "Your estimate is a plain mean: it does not use the weights."),
            Mistake(
                _estimate_before_moving,
                "The weights are of the moved particles, your estimate is of those from before they moved.",
            ),
            Mistake(
                lambda particles, measured, render, sigma, beta, noise, u: one_round(
                    particles, measured, render, sigma, beta, noise, 0.5
                ),
                "Your offset is always 0.5: use the u that is given.",
            ),
        ),
    ),
]
