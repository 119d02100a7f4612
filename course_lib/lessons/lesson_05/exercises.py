"""Exercises of lesson 05: the spread after t frames, noise along a wagon's own axes, particles near a state."""

from __future__ import annotations

import numpy as np

from course_lib.geometry import wrap_angle
from course_lib.lessons.kit.exercises import Exercise, Mistake

# 05.1: the spread after t frames


def spread_after(spread0: np.ndarray, sigma: np.ndarray, t: int) -> np.ndarray:
    """Standard deviations (6,) of a cloud after t frames of noise sigma (6,), from spread0 (6,) at the start."""
    return np.sqrt(spread0**2 + t * sigma**2)


def _spreads(rng: np.random.Generator) -> tuple:
    spread0, sigma = rng.uniform(0.05, 0.6, 6), rng.uniform(0.02, 0.3, 6)
    spread0[rng.integers(6)] = 0.0
    sigma[rng.integers(6)] = 0.0
    return spread0, sigma, int(rng.integers(2, 60))


# 05.2: noise along the particle's own axes


def propagate_own_axes(particles: np.ndarray, sigma_forward: float, sigma_left: float, draws: np.ndarray) -> np.ndarray:
    """Particles (N, 6) moved by noise along each one's own forward and left axes; draws (N, 2) standard normal."""
    forward, left = sigma_forward * draws[:, 0], sigma_left * draws[:, 1]
    return _moved(particles, forward, left, particles[:, 5])


def _moved(particles: np.ndarray, forward: np.ndarray, left: np.ndarray, yaw: np.ndarray) -> np.ndarray:
    moved = particles.copy()
    moved[:, 0] += forward * np.cos(yaw) - left * np.sin(yaw)
    moved[:, 1] += forward * np.sin(yaw) + left * np.cos(yaw)
    return moved


def _particles_and_draws(rng: np.random.Generator) -> tuple:
    n = int(rng.integers(4, 9))
    particles = np.zeros((n, 6))
    particles[:, :3] = rng.uniform([5, -1, 0.8], [15, 1, 1.2], (n, 3))
    particles[:, 5] = rng.uniform(-np.pi, np.pi, n)
    return particles, rng.uniform(0.1, 0.3), rng.uniform(0.02, 0.09), rng.standard_normal((n, 2))


def _with(change):
    """A mistake: the particles moved as `change(forward, left, yaw)` says, which returns the three to use instead."""

    def mistaken(particles, sigma_forward, sigma_left, draws):
        forward, left = sigma_forward * draws[:, 0], sigma_left * draws[:, 1]
        return _moved(particles, *change(forward, left, particles[:, 5]))

    return mistaken


def _steps_alone(particles, sigma_forward, sigma_left, draws):
    right = propagate_own_axes(particles, sigma_forward, sigma_left, draws)
    return right - particles


def _as_variances(particles, sigma_forward, sigma_left, draws):
    return propagate_own_axes(particles, sigma_forward**2, sigma_left**2, draws)


def _left_minus(particles, sigma_forward, sigma_left, draws):
    forward, left, yaw = sigma_forward * draws[:, 0], sigma_left * draws[:, 1], particles[:, 5]
    moved = particles.copy()
    moved[:, 0] += forward * np.cos(yaw) + left * np.sin(yaw)
    moved[:, 1] += forward * np.sin(yaw) + left * np.cos(yaw)
    return moved


def _by_matrix(rows):
    """A mistake: the step in x and y is the matrix `rows(cos yaw, sin yaw)` times (forward, left)."""

    def mistaken(particles, sigma_forward, sigma_left, draws):
        turns = np.array(rows(np.cos(particles[:, 5]), np.sin(particles[:, 5])))
        moved = particles.copy()
        moved[:, :2] += np.einsum("abn,nb->na", turns, draws * [sigma_forward, sigma_left])
        return moved

    return mistaken


# 05.3: how many particles are near a state


def share_near(particles: np.ndarray, state: np.ndarray, radius: float, angle: float) -> float:
    """Share (0 to 1) of particles within `radius` [m] of a state on the floor and within `angle` [rad] of its yaw."""
    near = np.hypot(*(particles[:, :2] - state[:2]).T) <= radius
    return float(np.mean(near & (np.abs(wrap_angle(particles[:, 5] - state[5])) <= angle)))


def _cloud_and_state(rng: np.random.Generator) -> tuple:
    """A cloud about as wide as radius and angle, at another height than the state, mostly about the wrap; a few look
    the other way, and at times one is exactly `radius` away."""
    n = int(rng.integers(40, 81))
    # Eighths of a metre are exact in floating point, so that a distance can equal the radius.
    radius, angle = rng.choice([0.125, 0.25]), np.deg2rad(rng.uniform(5, 15))
    place = rng.integers(40, 121, 2) / 8
    middle = np.array([*place, 1.0, 0, 0, rng.choice([np.pi, rng.uniform(-2, 2)], p=[0.8, 0.2])])
    particles = middle + rng.standard_normal((n, 6)) * [0.8 * radius, 0.8 * radius, 0.8 * radius, 0, 0, angle]
    particles[:3, 5] += np.pi
    state = middle + np.array([0, 0, 0.3 * radius, 0, 0, -0.3 * angle])
    if rng.random() < 0.5:
        particles[-1] = state + np.array([radius, 0, 0, 0, 0, 0])
    particles[:, 5], state[5] = wrap_angle(particles[:, 5]), wrap_angle(state[5])
    return particles, state, radius, angle


def _tests(particles: np.ndarray, state: np.ndarray, radius: float, angle: float) -> tuple[np.ndarray, np.ndarray]:
    near = np.hypot(*(particles[:, :2] - state[:2]).T) <= radius
    return near, np.abs(wrap_angle(particles[:, 5] - state[5])) <= angle


def _not_wrapped(particles, state, radius, angle):
    near, _ = _tests(particles, state, radius, angle)
    return np.mean(near & (np.abs(particles[:, 5] - state[5]) <= angle))


def _in_space(particles, state, radius, angle):
    _, turned = _tests(particles, state, radius, angle)
    return np.mean(turned & (np.linalg.norm(particles[:, :3] - state[:3], axis=1) <= radius))


def _share_of_those_near(particles, state, radius, angle):
    near, turned = _tests(particles, state, radius, angle)
    return np.sum(near & turned) / max(np.sum(near), 1)


def _absolute_yaws(particles, state, radius, angle):
    near, _ = _tests(particles, state, radius, angle)
    return np.mean(near & (np.abs(np.abs(particles[:, 5]) - np.abs(state[5])) <= angle))


def _in_a_square(particles, state, radius, angle):
    _, turned = _tests(particles, state, radius, angle)
    return np.mean(turned & (np.abs(particles[:, :2] - state[:2]) <= radius).all(axis=1))


def _without_absolute(particles, state, radius, angle):
    near, _ = _tests(particles, state, radius, angle)
    return np.mean(near & (wrap_angle(particles[:, 5] - state[5]) <= angle))


def _squares_against_radius(particles, state, radius, angle):
    _, turned = _tests(particles, state, radius, angle)
    return np.mean(turned & (((particles[:, :2] - state[:2]) ** 2).sum(axis=1) <= radius))


EXERCISES = [
    Exercise(
        number="05.1",
        reference=spread_after,
        inputs=_spreads,
        mistakes=(
            Mistake(
                lambda spread0, sigma, t: spread0 + np.sqrt(t) * sigma,
                "You add standard deviations. Independent things add their variances: square, add, take the root.",
            ),
            Mistake(
                lambda spread0, sigma, t: np.sqrt(t) * sigma,
                "You forgot that the cloud has a spread at the start. Its variance counts, too.",
            ),
            Mistake(
                lambda spread0, sigma, t: np.sqrt(spread0**2 + (t * sigma) ** 2),
                "Your noise grows with t. Each frame adds one variance, so the variance grows with t, not its square.",
            ),
            Mistake(
                lambda spread0, sigma, t: spread0**2 + t * sigma**2,
                "That is the variance. The standard deviation is its root.",
            ),
            Mistake(
                lambda spread0, sigma, t: spread0 + t * sigma,
                "You let all steps point the same way. They are random: variances add, not standard deviations.",
            ),
            Mistake(
                lambda spread0, sigma, t: np.sqrt(t * (spread0**2 + sigma**2)),
                "You count the spread at the start in every frame. It is there once.",
            ),
            Mistake(
                lambda spread0, sigma, t: np.sqrt(spread0**2 + sigma**2),
                "That is the spread after one frame. Where is t?",
            ),
            Mistake(
                lambda spread0, sigma, t: np.sqrt(spread0**2 + (t - 1) * sigma**2),
                "One frame is missing: the first frame moves the particles already.",
            ),
            Mistake(
                lambda spread0, sigma, t: np.sqrt(spread0 + t * sigma),
                "You add standard deviations under the root. Square them first.",
            ),
            Mistake(
                lambda spread0, sigma, t: np.sqrt(spread0 + t * sigma**2),
                "You square sigma, but not the spread at the start. It is a standard deviation as well.",
            ),
            Mistake(
                lambda spread0, sigma, t: np.sqrt(spread0**2 + t * sigma),
                "You square the spread at the start, but not sigma.",
            ),
            Mistake(
                lambda spread0, sigma, t: np.sqrt(sigma**2 + t * spread0**2),
                "You swapped the two: the spread at the start counts once, sigma in every frame.",
            ),
        ),
    ),
    Exercise(
        number="05.2",
        reference=propagate_own_axes,
        inputs=_particles_and_draws,
        mistakes=(
            Mistake(
                _with(lambda forward, left, yaw: (forward, left, 0 * yaw)),
                "You add forward to x and left to y. That holds for yaw 0 only: turn the step by the particle's yaw.",
            ),
            Mistake(
                _with(lambda forward, left, yaw: (forward, left, -yaw)),
                "Your steps turn the wrong way: from the body to the world, by +yaw.",
            ),
            Mistake(
                _with(lambda forward, left, yaw: (forward, left, np.full_like(yaw, yaw[0]))),
                "All your particles step in the direction of the first one. Each has a yaw of its own.",
            ),
            Mistake(
                _with(lambda forward, left, yaw: (left, forward, yaw)),
                "You swapped forward and left: the first column of `draws` is forward.",
            ),
            Mistake(
                _with(lambda forward, left, yaw: (forward, -left, yaw)),
                "Your second step goes to the right. Left is forward turned by +90 degrees: (-sin, cos).",
            ),
            Mistake(
                _with(lambda forward, left, yaw: (forward, left, np.deg2rad(yaw))),
                "The yaw of a particle is in radians already.",
            ),
            Mistake(
                _with(lambda forward, left, yaw: (forward, 0 * left, yaw)),
                "Your particles never step sideways: the noise along the left axis is missing.",
            ),
            Mistake(
                _with(lambda forward, left, yaw: (np.abs(forward), left, yaw)),
                "Your particles never step back. The noise is normal: half of the draws are negative.",
            ),
            Mistake(
                _as_variances, "You multiply the draws by sigma squared. A standard normal draw times sigma is right."
            ),
            Mistake(_left_minus, "One sign is wrong in x: left points along (-sin yaw, cos yaw)."),
            Mistake(_steps_alone, "These are the steps alone. Add them to the particles."),
            Mistake(
                lambda particles, sigma_forward, sigma_left, draws: propagate_own_axes(particles, 1, 1, draws),
                "Your steps are about a metre long: multiply the draws by their sigmas.",
            ),
            Mistake(
                lambda particles, sigma_forward, sigma_left, draws: propagate_own_axes(
                    particles, sigma_left, sigma_forward, draws
                ),
                "You swapped the sigmas: sigma_forward belongs to the first column of `draws`.",
            ),
            Mistake(
                lambda particles, sigma_forward, sigma_left, draws: propagate_own_axes(
                    particles, sigma_forward, sigma_left, draws[:, ::-1]
                ),
                "You swapped the columns of `draws`: the first one is forward.",
            ),
            Mistake(
                _by_matrix(lambda c, s: [[s, c], [c, -s]]),
                "Sine and cosine have changed places. At yaw 0 forward is along x: so x has the cosine.",
            ),
            Mistake(
                _by_matrix(lambda c, s: [[c, -s], [s, -c]]),
                "One sign is wrong in y: left points along (-sin yaw, cos yaw).",
            ),
            Mistake(
                _by_matrix(lambda c, s: [[c, 0 * s], [s, 1 + 0 * c]]),
                "You turn forward, but not left: left is forward turned by +90 degrees, (-sin yaw, cos yaw).",
            ),
            Mistake(
                _by_matrix(lambda c, s: [[c, 0 * s], [0 * c, s]]),
                "Each of the two steps has a part in x *and* a part in y.",
            ),
            Mistake(
                _with(lambda forward, left, yaw: (forward, left, np.rad2deg(yaw))),
                "You turn the yaw into degrees; np.sin and np.cos take radians.",
            ),
            Mistake(
                _with(lambda forward, left, yaw: (forward, left, np.full_like(yaw, yaw.mean()))),
                "All your particles step in one mean direction. Each has a yaw of its own.",
            ),
        ),
    ),
    Exercise(
        number="05.3",
        reference=share_near,
        inputs=_cloud_and_state,
        mistakes=(
            Mistake(
                _not_wrapped,
                "Wrap the difference of the yaws: 179 and -179 degrees are 2 degrees apart, not 358.",
            ),
            Mistake(_in_space, "Your distance includes z. Near on the floor means x and y only."),
            Mistake(
                lambda particles, state, radius, angle: np.mean(
                    np.logical_or(*_tests(particles, state, radius, angle))
                ),
                "You count particles that are near in place *or* in heading. They must be near in both.",
            ),
            Mistake(
                lambda particles, state, radius, angle: np.sum(
                    np.logical_and(*_tests(particles, state, radius, angle))
                ),
                "You count the particles. A share is that count divided by their number.",
            ),
            Mistake(
                lambda particles, state, radius, angle: np.mean(_tests(particles, state, radius, angle)[0]),
                "You look at the place alone. The heading must be near, too.",
            ),
            Mistake(
                lambda particles, state, radius, angle: np.mean(_tests(particles, state, radius, angle)[1]),
                "You look at the heading alone. The place must be near, too.",
            ),
            Mistake(
                lambda particles, state, radius, angle: 1 - share_near(particles, state, radius, angle),
                "That is the share of the particles that are *not* near.",
            ),
            Mistake(
                lambda particles, state, radius, angle: 100 * share_near(particles, state, radius, angle),
                "Yours is in percent; the task asks for a share from 0 to 1.",
            ),
            Mistake(
                _in_a_square, "You test x and y one by one: that is a square. The distance is the root of dx^2 + dy^2."
            ),
            Mistake(_without_absolute, "A yaw far to the right passes your test. Compare the absolute difference."),
            Mistake(_squares_against_radius, "You compare a squared distance with the radius: take the root."),
            Mistake(
                lambda particles, state, radius, angle: share_near(particles, state, radius, np.deg2rad(angle)),
                "Degrees meet radians in your test: the yaws and `angle` are all in radians. Convert nothing.",
            ),
            Mistake(
                lambda particles, state, radius, angle: np.prod(
                    np.mean(_tests(particles, state, radius, angle), axis=1)
                ),
                "You multiply two shares. Ask of each particle whether it passes both tests, then take one mean.",
            ),
            Mistake(
                _share_of_those_near,
                "You divide by the particles that are near in place. The share is one of all particles.",
            ),
            Mistake(
                _absolute_yaws,
                "You compare the sizes of two yaws: 20 and -20 degrees are not one heading. Wrap their difference.",
            ),
            Mistake(
                lambda particles, state, radius, angle: np.mean(
                    _tests(particles, state, radius, angle)[0]
                    & (wrap_angle(np.abs(particles[:, 5] - state[5])) <= angle)
                ),
                "Wrap first, then take the absolute value: wrapping afterwards makes large differences negative.",
            ),
            Mistake(
                lambda particles, state, radius, angle: np.mean(
                    _tests(particles, state, radius, angle)[0]
                    & (np.mod(particles[:, 5] - state[5], 2 * np.pi) <= angle)
                ),
                "From 0 to 2 pi a small turn to the right is nearly 2 pi. Wrap to -pi ... pi, then the absolute value.",
            ),
            Mistake(
                lambda particles, state, radius, angle: np.mean(
                    (np.hypot(*(particles[:, :2] - state[:2]).T) < radius) & _tests(particles, state, radius, angle)[1]
                ),
                "A particle at exactly `radius` metres is left out. *At most* means <=.",
            ),
            Mistake(
                lambda particles, state, radius, angle: np.mean(
                    (np.abs(particles[:, :2] - state[:2]).sum(axis=1) <= radius)
                    & _tests(particles, state, radius, angle)[1]
                ),
                "You add the ways along x and y. The distance is the root of dx^2 + dy^2.",
            ),
        ),
    ),
]
