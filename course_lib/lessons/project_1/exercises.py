"""Stages of project P1: the filter's steps one by one, then one round of figure 1 in the right order."""

import numpy as np

from course_lib.geometry import wrap_angle
from course_lib.lessons.kit.exercises import Exercise

# P1.1: eqs (3), (4)


def initial_particles(state0, n):
    """Particles (n, 6), all at the start (6,)."""
    return np.tile(state0, (n, 1)).astype(float)


def start(rng: np.random.Generator) -> tuple:
    return np.concatenate([rng.uniform(-9, 9, 3), rng.uniform(-np.pi, np.pi, 3)]), int(rng.integers(1, 9))


# P1.2: eq. (5), forward and left along each particle's own axes


def propagate(particles, sigma, noise):
    """Particles (N, 6) after system noise sigma * noise, along each particle's own axes."""
    step = sigma * noise
    cosine, sine = np.cos(particles[:, 5]), np.sin(particles[:, 5])
    moved = particles + step
    moved[:, 0] = particles[:, 0] + cosine * step[:, 0] - sine * step[:, 1]
    moved[:, 1] = particles[:, 1] + sine * step[:, 0] + cosine * step[:, 1]
    return moved


def yaw_wrapped(particles, sigma, noise):
    """Right as well."""
    moved = propagate(particles, sigma, noise)
    moved[:, 5] = (moved[:, 5] + np.pi) % (2 * np.pi) - np.pi
    return moved


def angles_wrapped(particles, sigma, noise):
    """Right as well."""
    moved = propagate(particles, sigma, noise)
    moved[:, 3:] = (moved[:, 3:] + np.pi) % (2 * np.pi) - np.pi
    return moved


def cloud(rng: np.random.Generator) -> tuple:
    """Particles that look every way, noise of a wagon: some components are kept by a sigma of 0."""
    n = int(rng.integers(3, 9))
    particles = np.concatenate([rng.uniform(-9, 9, (n, 3)), rng.uniform(-np.pi, np.pi, (n, 3))], axis=1)
    sigma = np.array([rng.uniform(0.1, 0.4), rng.uniform(0.02, 0.08), 0.0, 0.0, 0.0, rng.uniform(0.2, 0.6)])
    return particles, sigma, rng.standard_normal((n, 6))


def a_hand_held_camera(rng: np.random.Generator) -> tuple:
    particles, sigma, noise = cloud(rng)
    return particles, sigma + np.array([0, 0, 0.1, 0.02, 0.03, 0]), noise


def facing_back(rng: np.random.Generator) -> tuple:
    particles, sigma, noise = cloud(rng)
    particles[:, 5] = rng.choice((-1, 1), len(particles)) * np.pi
    return particles, sigma, noise


# P1.3: eq. (8)


def likelihood(measured, simulated, alpha):
    """Likelihood (N,) of simulated depth images (N, H, W) for a measured one (H, W)."""
    valid = np.isfinite(measured)
    difference = np.abs(measured[valid] - simulated[:, valid])
    return (alpha / (alpha + difference)).sum(axis=1)


def images(rng: np.random.Generator) -> tuple:
    """Images with holes on both sides."""
    n, height, width = (int(k) for k in rng.integers(2, 6, 3))
    measured = rng.uniform(1, 9, (height, width))
    simulated = measured + rng.normal(0, 0.2, (n, height, width))
    simulated[rng.random(simulated.shape) < 0.15] = np.inf
    measured[rng.random(measured.shape) < 0.2] = np.nan
    measured.flat[:2], simulated[0].flat[1] = (np.nan, 3.0), np.inf
    return measured, simulated, float(rng.uniform(0.05, 0.5))


def nothing_measured(rng: np.random.Generator) -> tuple:
    measured, simulated, _ = images(rng)
    return np.full_like(measured, np.nan), simulated, 0.1


def a_particle_that_hits_nothing(rng: np.random.Generator) -> tuple:
    measured, simulated, _ = images(rng)
    simulated[1] = np.inf
    return measured, simulated, 0.1


# P1.4: eqs (9), (10), (11)


def particle_weights(values, beta):
    """Weights (N,), summing to one, of likelihoods (N,)."""
    spread = values.max() - values.min()
    normalized = (values - values.min()) / spread if spread > 0 else np.ones(len(values))
    w = np.exp(-((normalized - 1) ** 2) / beta**2)
    return w / w.sum()


def likelihoods(rng: np.random.Generator) -> tuple:
    return rng.uniform(100, 900) + rng.uniform(0, 50, int(rng.integers(3, 9))), float(rng.uniform(0.1, 0.8))


def the_papers_beta(rng: np.random.Generator) -> tuple:
    return likelihoods(rng)[0], 0.01


def all_alike(rng: np.random.Generator) -> tuple:
    return np.full(int(rng.integers(2, 6)), rng.uniform(100, 900)), 0.01


def one_alone(rng: np.random.Generator) -> tuple:
    return rng.uniform(100, 900, 1), 0.01


# P1.5: eq. (12)


def estimate(particles, w):
    """Weighted mean state (6,) of particles (N, 6) with weights (N,)."""
    angles = particles[:, 3:]
    return np.concatenate([w @ particles[:, :3], np.arctan2(w @ np.sin(angles), w @ np.cos(angles))])


def about_the_first(particles, w):
    differences = wrap_angle(particles[:, 3:] - particles[0, 3:])
    return np.concatenate([w @ particles[:, :3], wrap_angle(particles[0, 3:] + w @ differences)])


def weighted_cloud(rng: np.random.Generator) -> tuple:
    """A cloud about one state, its yaw often near the wrap, and uneven weights."""
    n = int(rng.integers(4, 9))
    centre = np.concatenate([rng.uniform(-9, 9, 3), rng.uniform(-0.2, 0.2, 2), [rng.choice([np.pi, 0.0, 2.0])]])
    particles = centre + rng.normal(0, [0.3, 0.3, 0.1, 0.05, 0.05, 0.3], (n, 6))
    particles[:, 3:] = (particles[:, 3:] + np.pi) % (2 * np.pi) - np.pi
    w = rng.uniform(0.1, 1, n)
    return particles, w / w.sum()


def on_both_sides_of_the_seam(rng: np.random.Generator) -> tuple:
    particles, w = weighted_cloud(rng)
    particles[:, 5] = np.pi - rng.uniform(0.01, 0.1, len(w))
    particles[::2, 5] *= -1
    return particles, w


# P1.6: resampling, section 3.4


def resample(w, u):
    """Indices (N,) of the particles that live on, ascending, for weights (N,) and an offset u in [0, 1)."""
    cumulative = np.cumsum(w)
    cumulative[-1] = 1.0  # rounding must not leave the last point beyond the sum
    return np.searchsorted(cumulative, (np.arange(len(w)) + u) / len(w), side="right")


def rounded_copies(w):
    copies = np.repeat(np.arange(len(w)), np.round(len(w) * w).astype(int))
    return np.append(copies, np.full(len(w), np.argmax(w)))[: len(w)]


def weights_and_offset(rng: np.random.Generator) -> tuple:
    """Uneven weights, some of them zero; an offset."""
    n = int(rng.integers(4, 11))
    w = rng.uniform(0.02, 1, n) ** 3
    w[1:][rng.random(n - 1) < 0.2] = 0.0
    return w / w.sum(), float(rng.uniform(0.05, 0.95))


def last_ones_without_weight(rng: np.random.Generator) -> tuple:
    return np.array([0.25, 0.25, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0]), float(rng.uniform(0.05, 0.95))


def all_weight_on_one(rng: np.random.Generator) -> tuple:
    n = int(rng.integers(4, 11))
    return np.eye(n)[rng.integers(n)], float(rng.uniform(0.05, 0.95))


def equal_weights(rng: np.random.Generator) -> tuple:
    return np.full(8, 0.125), float(rng.uniform(0.05, 0.95))


# P1.7: one round of figure 1


def one_round(particles, measured, render, sigma, beta, noise, u):
    """Estimate (6,) after one frame, and the particles (N, 6) that live on."""
    moved = propagate(particles, sigma, noise)
    w = particle_weights(likelihood(measured, render(moved), 0.1), beta)
    return estimate(moved, w), moved[resample(w, u)]


def weigh(states, measured, render, beta):
    return particle_weights(likelihood(measured, render(states), 0.1), beta)


def raw_weights(measured, simulated):
    values = likelihood(measured, simulated, 0.1)
    return values / values.sum()


def moved_at_the_end(particles, measured, render, sigma, beta, noise, u):
    w = weigh(particles, measured, render, beta)
    return estimate(particles, w), propagate(particles[resample(w, u)], sigma, noise)


def wall_ahead(states):
    """Depth images (N, 3, 5) of a wall at x = 10 m and one at y = 2 m, from states (N, 6): stands for a renderer."""
    states = np.atleast_2d(states)
    rays = np.linspace(-0.4, 0.4, 5)[None, None, :] * np.ones((1, 3, 1))
    yaw = states[:, 5][:, None, None] + np.arctan(rays)
    with np.errstate(divide="ignore"):
        front = (10 - states[:, 0][:, None, None]) / np.cos(yaw)
        side = (2 - states[:, 1][:, None, None]) / np.sin(yaw)
    return np.minimum(front, np.where(side > 0, side, np.inf)) * np.cos(np.arctan(rays))


def a_frame(rng: np.random.Generator) -> tuple:
    """A cloud before a frame, and what a camera two steps on measures."""
    n = int(rng.integers(6, 12))
    true = np.array([rng.uniform(1, 5), rng.uniform(-1, 1), 1.0, 0.0, 0.0, rng.uniform(-0.3, 0.3)])
    particles = true + rng.normal(0, [0.1, 0.05, 0, 0, 0, 0.03], (n, 6))
    measured = wall_ahead(true)[0] + rng.normal(0, 0.01, (3, 5))
    measured.flat[int(rng.integers(15))] = np.nan
    sigma, beta = np.array([0.15, 0.05, 0.0, 0.0, 0.0, 0.03]), float(rng.choice([0.01, rng.uniform(0.3, 0.8)]))
    return particles, measured, wall_ahead, sigma, beta, rng.standard_normal((n, 6)), float(rng.uniform(0.05, 0.95))


def all_at_one_place(rng: np.random.Generator) -> tuple:
    particles, measured, render, _, beta, noise, u = a_frame(rng)
    return np.tile(particles[0], (len(particles), 1)), measured, render, np.zeros(6), beta, noise, u


# fmt: off
EXERCISES = [
    Exercise("P1.1", initial_particles, start, "warm-up", mistakes="""
        ... => return np.tile(state0[:, None], (1, n))
        You have a column a particle. One row a particle: n rows of six numbers.
        ... => return np.tile(state0, n)
        You have one long row of 6 n numbers. Each particle is a row of its own.
        ... => return np.concatenate([state0[None], np.zeros((n - 1, 6))])
        Only your first particle is at the start; the others are at the origin.
        ... => return np.tile(np.append(state0[:3], np.zeros(3)), (n, 1))
        You copy the position, and lose roll, pitch and yaw.
        (n, 1) => (n + 1, 1)
        You have one particle too many: n rows.
        ... => return state0 + np.linspace(0.01, 0.1, 6 * n).reshape(n, 6)
        Yours are spread already. By (4) all start alike; the first propagation spreads them.
    """),
    Exercise("P1.2", propagate, cloud, cases=[facing_back, a_hand_held_camera], others=[yaw_wrapped, angles_wrapped],
             mistakes="""
        ... => return particles + sigma * noise
        That moves along the world's axes. The noise is meant forward and to the left.
        np.sin(particles[:, 5]) => -np.sin(particles[:, 5])
        Turned the wrong way: at yaw 90 degrees, forward is the world's +y.
        (particles[:, 5]) => (particles[:, 5] + step[:, 5])
        You turn first and then move. The noise goes along the yaw *before* this frame.
        step = sigma * noise => step = sigma * noise * [1, -1, 1, 1, 1, 1]
        Left and right are exchanged: at yaw 0, left is the world's +y.
        cosine, sine = => sine, cosine =
        Cosine and sine are exchanged: at yaw 0, forward is the world's +x.
        sigma * noise => sigma * noise[:1] * np.ones((len(noise), 1))
        All your particles get the same noise: row i of `noise` is particle i's.
        sigma * noise => sigma * noise and also return moved => moved[:, 5] = particles[:, 5]; return moved
        Yours moves, but does not turn: the last component of the noise is the yaw's.
        sigma * noise => sigma**2 * noise
        You scale by the variance. The noise is standard normal: times sigma, not its square.
        sigma * noise => noise
        sigma is missing: the noise is standard normal, one metre and one radian wide.
        return moved => return moved - particles
        That is the step alone. Return where the particles are after it.
        particles[:, 5]) => np.deg2rad(particles[:, 5]))
        The yaw is in radians already; you convert it once more.
        sigma * noise => sigma * noise * [1, 1, 0, 0, 0, 1]
        Up, roll and pitch have noise, too: sigma holds six numbers. In the wagon three of them are 0.
    """),
    Exercise("P1.3", likelihood, images, cases=[nothing_measured, a_particle_that_hits_nothing], mistakes="""
        ... => return np.sum(alpha / (alpha + np.abs(measured - simulated)), axis=(1, 2))
        A pixel that was not measured (NaN) makes the whole sum NaN. Leave it out, for all particles alike.
        .sum(axis=1) => .sum(axis=1) / np.maximum(np.isfinite(difference).sum(axis=1), 1) * valid.sum()
        You leave simulated misses out, so looking into holes costs nothing. A miss counts, with term 0.
        .sum(axis=1) => .sum(axis=1) / max(1, valid.sum())
        .sum(axis=1) => .sum(axis=1) / measured.size
        That is a mean over the pixels. Eq. (8) is a sum.
        .sum(axis=1) => .sum(axis=1) + np.isinf(difference).sum(axis=1)
        A simulated miss counts as perfect in yours. It differs by infinity: term 0.
        alpha / (alpha + difference) => 1 - difference / (alpha + difference)
        inf / inf is NaN: that is your simulated misses. Write the term as one fraction.
        .sum(axis=1) => .sum(axis=1) + (~valid).sum()
        Pixels without measurement get the full 1 in yours. They are left out.
        return ( => return valid.sum() - (
        Yours grows with the disagreement: the 1 - is missing, and the best would be the worst.
        alpha / (alpha + difference) => np.exp(-(difference**2) / (2 * alpha**2))
        That is a bell curve. The term of (8) is 1 - d / (alpha + d), d the absolute difference.
        valid = np.isfinite(measured) => measured = np.nan_to_num(measured); valid = np.isfinite(measured)
        A pixel without measurement is not a wall at 0 m: leave NaN out.
        + difference) => + difference**2)
        The difference stands in (8) as an absolute value, not squared.
        ... => return likelihood(measured, simulated, 0.1)
        Your alpha is always 0.1 m: use the one that is given.
        .sum(axis=1) => .sum(keepdims=True)[0]
        One number for all particles: sum over the pixels of each, not over the particles.
        np.abs(measured[valid] - simulated[:, valid]) => measured[valid] - simulated[:, valid]
        The difference is not made absolute: too near counts as more than perfect, or as infinitely bad.
    """),
    Exercise("P1.4", particle_weights, likelihoods, cases=[the_papers_beta, all_alike, one_alone], mistakes="""
        beta**2 => beta
        beta stands squared in (10).
        return w / w.sum() => return w
        Weights must sum to one: (11) is still missing.
        return w / w.sum() => return w / w.mean()
        Your weights sum to N. By (11) they sum to one.
        (normalized - 1) => normalized
        The worst particle gets most in yours: it is (l - 1) that is squared, the distance from the best.
        np.exp(-((normalized - 1) ** 2) / beta**2) => normalized
        That is (9) made to sum to one; (10) is missing.
        (values - values.min()) / spread => values / values.max()
        You divide by the greatest likelihood. (9) spreads them from 0 for the worst to 1 for the best.
        / beta**2 => / (2 * beta**2)
        There is no 2 in (10): it is no normal distribution.
        -((normalized - 1) ** 2) / beta**2 => (normalized - 1) / beta
        The exponent of (10) is a square; yours falls off along a straight line.
        beta**2 => 0.01**2
        Your beta is always 0.01: use the one that is given.
        if spread > 0 else np.ones(len(values)) =>
        0/0 where all likelihoods agree. Nothing speaks for one of them then: what are fair weights?
        return w / w.sum() => return w / w.sum() if spread > 0 else np.zeros(len(w))
        return w / w.sum() => return w / w.sum() if spread > 0 else np.ones(len(w))
        return w / w.sum() => return w / w.sum() if spread > 0 else np.eye(len(w))[0]
        Where all likelihoods agree the weights must sum to one, too, and nothing speaks for one of them.
    """),
    Exercise("P1.5", estimate, weighted_cloud, cases=[on_both_sides_of_the_seam], mistakes="""
        ... => return w @ particles
        (12) as printed: its angles fail at +-180 degrees (lesson 07).
        ... => return particles.mean(axis=0)
        A plain mean: where are the weights, and the circle?
        ... => return particles[np.argmax(w)].copy()
        That is the heaviest particle. In (12) all take part.
        w @ np.sin(angles), w @ np.cos(angles) => np.mean(np.sin(angles), axis=0), np.mean(np.cos(angles), axis=0)
        Your positions are weighted, your angles are not.
        ... => return np.concatenate([w @ particles[:, :3], particles[0, 3:5], estimate(particles, w)[5:]])
        Your yaw is right; roll and pitch are those of one particle.
        np.arctan2 => 180 / np.pi * np.arctan2
        Your angles are in degrees: a state is in metres and radians.
        w @ np.cos(angles)) => w @ np.cos(angles)) % (2 * np.pi)
        Right directions, but from 0 to 2 pi. The course's angles lie between -pi and pi.
        ... => return estimate(particles, np.full(len(w), 1 / len(w)))
        You have the circle, but no weights.
        ... => return np.concatenate([w @ particles[:, :5], estimate(particles, w)[5:]])
        Yaw is on the circle in yours, roll and pitch are not: all three angles are averaged there.
        np.arctan2(w @ np.sin(angles), w @ np.cos(angles)) => w @ (angles % (2 * np.pi))
        From 0 to 2 pi the seam is at 0 instead of 180 degrees; it is still there. Average on the circle.
        ... => return about_the_first(particles, w)
        You average differences from the first particle: which one is first decides the answer. Add arrows.
    """),
    Exercise("P1.6", resample, weights_and_offset, cases=[last_ones_without_weight, all_weight_on_one, equal_weights],
             mistakes="""
        (np.arange(len(w)) + u) / len(w) => np.sort((np.arange(len(w)) / len(w) + u) % 1.0)
        (np.arange(len(w)) + u) / len(w) => (np.arange(len(w)) / len(w) + u) % 1.0
        The offset is u of one step: the first point lies at u / N, not at u.
        ... => return resample(w, 0.5)
        Your points do not start at u / N: where is u?
        ... => return resample(w, 0.0)
        Your points start at 0. The random offset makes the draw fair: use u.
        ... => return np.arange(len(w))
        You keep every particle once, whatever it weighs.
        ... => return np.minimum(resample(w, u) + 1, len(w) - 1)
        ... => return resample(w, u) + 1
        Yours is one particle too far: index 0 is the first one.
        ... => return rounded_copies(w)
        You round N w. That is not unbiased: step through the summed weights instead.
        ... => return (np.arange(len(w)) + u) / len(w)
        These are the points. Return which particle's share of the sum each falls into.
        ... => return np.argsort(-w, kind="stable")
        That sorts the particles; none is copied, none vanishes.
        ... => return np.full(len(w), np.argmax(w))
        You keep the heaviest alone. Others have a share, too.
        ... => return np.bincount(resample(w, u), minlength=len(w))
        These are the numbers of copies. Return the indices, each as often as it is copied.
        cumulative = np.cumsum(w) => cumulative = np.copy(w)
        You look the points up among the weights. They lie along the *sum* of the weights so far.
        ... => return resample(w, u)[::-1]
        Right particles, but descending.
        ... => return w[resample(w, u)]
        These are the weights of the particles that live on. Return their indices.
    """),
    Exercise("P1.7", one_round, a_frame, "challenge", cases=[all_at_one_place], mistakes="""
        estimate(moved, w) => estimate(moved[resample(w, u)], np.full(len(w), 1 / len(w)))
        You estimate from the copies. The weights know more: estimate first, then resample.
        render(moved) => render(particles)
        You render from where the particles were. The image is of *this* frame: move them first.
        ... => return moved_at_the_end(particles, measured, render, sigma, beta, noise, u)
        You move at the end of the round, so this frame's image weighs the last frame's particles.
        moved[resample(w, u)] => moved
        Your particles are not resampled: the light ones live on with the heavy ones.
        moved[resample(w, u)] => particles[resample(w, u)]
        You copy the particles from before they moved.
        return estimate(moved, w) => k = moved[resample(w, u)]; return estimate(k, weigh(k, measured, render, beta))
        You weigh the copies once more for the estimate: so the image counts twice.
        moved[resample(w, u)] => propagate(moved[resample(w, u)], sigma, noise)
        You move twice: before weighing, and once more what lives on.
        particle_weights(likelihood(measured, render(moved), 0.1), beta) => raw_weights(measured, render(moved))
        You weigh by the raw likelihoods: (9) and (10) are left out.
        0.1), beta) => 0.1), 0.01)
        Your beta is always 0.01: use the one that is given.
        ... => return one_round(particles, measured, render, sigma, beta, noise, u)[::-1]
        Return the estimate first, then the particles.
        propagate(particles, sigma, noise) => particles
        Your particles do not move at all: where is the system noise?
        estimate(moved, w) => moved[np.argmax(w)]
        Your estimate is the heaviest particle. In (12) all take part.
        estimate(moved, w) => estimate(moved, np.full(len(w), 1 / len(w)))
        Your estimate is a plain mean: it does not use the weights.
        estimate(moved, w) => estimate(particles, w)
        The weights are of the moved particles, your estimate is of those from before they moved.
        resample(w, u) => resample(w, 0.5)
        Your offset is always 0.5: use the u that is given.
    """),
]
