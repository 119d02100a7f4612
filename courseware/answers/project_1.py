"""Stages of project P1: the filter's steps one by one, then one round of figure 1 in the right order."""

import numpy as np

from course_lib.geometry import wrap_angle
from courseware.lessons.kit.exercises import Exercise
from courseware.lessons.project_1.recordings import wall_ahead


def initial_particles(state0, n):
    """Particles (n, 6), all at the start (6,)."""
    return np.tile(state0, (n, 1)).astype(float)


def propagate(particles, sigma, noise):
    """Particles (N, 6) after system noise sigma * noise, along each particle's own axes."""
    step = sigma * noise
    cosine, sine = np.cos(particles[:, 5]), np.sin(particles[:, 5])
    moved = particles + step
    moved[:, 0] = particles[:, 0] + cosine * step[:, 0] - sine * step[:, 1]
    moved[:, 1] = particles[:, 1] + sine * step[:, 0] + cosine * step[:, 1]
    return moved


def wrapped(moved, first):
    """Particles whose angles from component `first` on are wrapped: the task allows it."""
    return np.column_stack([moved[:, :first], wrap_angle(moved[:, first:])])


def cloud(rng: np.random.Generator) -> tuple:
    """Particles that look every way, and the noise of a wagon, which neither rises nor tilts."""
    n = int(rng.integers(3, 9))
    particles = np.column_stack([rng.uniform(-9, 9, (n, 3)), rng.uniform(-np.pi, np.pi, (n, 3))])
    sigma = np.array([rng.uniform(0.1, 0.4), rng.uniform(0.02, 0.08), 0.0, 0.0, 0.0, rng.uniform(0.2, 0.6)])
    return particles, sigma, rng.standard_normal((n, 6))


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


def particle_weights(values, beta):
    """Weights (N,), summing to one, of likelihoods (N,)."""
    spread = values.max() - values.min()
    normalized = (values - values.min()) / spread if spread > 0 else np.ones(len(values))
    w = np.exp(-((normalized - 1) ** 2) / beta**2)
    return w / w.sum()


def likelihoods(rng: np.random.Generator) -> tuple:
    return rng.uniform(100, 900) + rng.uniform(0, 50, int(rng.integers(3, 9))), float(rng.uniform(0.1, 0.8))


def estimate(particles, w):
    """Weighted mean state (6,) of particles (N, 6) with weights (N,)."""
    angles = particles[:, 3:]
    return np.concatenate([w @ particles[:, :3], np.arctan2(w @ np.sin(angles), w @ np.cos(angles))])


def weighted_cloud(rng: np.random.Generator) -> tuple:
    """A cloud about one state, whose yaw is often near the seam, and uneven weights."""
    n = int(rng.integers(4, 9))
    centre = np.concatenate([rng.uniform(-9, 9, 3), rng.uniform(-0.2, 0.2, 2), [rng.choice([np.pi, 0.0, 2.0])]])
    w = rng.uniform(0.1, 1, n)
    return wrapped(centre + rng.normal(0, [0.3, 0.3, 0.1, 0.05, 0.05, 0.3], (n, 6)), 3), w / w.sum()


def resample(w, u):
    """Indices (N,) of the particles that live on, ascending, for weights (N,) and an offset u in [0, 1)."""
    cumulative = np.cumsum(w)
    cumulative[-1] = 1.0  # rounding must not leave the last point beyond the sum
    return np.searchsorted(cumulative, (np.arange(len(w)) + u) / len(w), side="right")


def weights_and_offset(rng: np.random.Generator) -> tuple:
    """Uneven weights, some of them zero; an offset."""
    n = int(rng.integers(4, 11))
    w = rng.uniform(0.02, 1, n) ** 3
    w[1:][rng.random(n - 1) < 0.2] = 0.0
    return w / w.sum(), float(rng.uniform(0.05, 0.95))


def one_round(particles, measured, render, sigma, beta, noise, u):
    """Estimate (6,) after one frame, and the particles (N, 6) that live on."""
    moved = propagate(particles, sigma, noise)
    w = particle_weights(likelihood(measured, render(moved), 0.1), beta)
    return estimate(moved, w), moved[resample(w, u)]


def a_frame(rng: np.random.Generator, spread: float = 1.0) -> tuple:
    """A cloud before a frame, and the image of a camera near it. spread: 0 for a cloud in one point."""
    n = int(rng.integers(6, 12))
    true = np.array([rng.uniform(1, 5), rng.uniform(-1, 1), 1.0, 0.0, 0.0, rng.uniform(-0.3, 0.3)])
    particles = true + spread * rng.normal(0, [0.1, 0.05, 0, 0, 0, 0.03], (n, 6))
    measured = wall_ahead(true)[0] + rng.normal(0, 0.01, (3, 5))
    measured.flat[int(rng.integers(15))] = np.nan
    sigma, beta = spread * np.array([0.15, 0.05, 0, 0, 0, 0.03]), float(rng.choice([0.01, rng.uniform(0.3, 0.8)]))
    return particles, measured, wall_ahead, sigma, beta, rng.standard_normal((n, 6)), float(rng.uniform(0.05, 0.95))


# fmt: off
EXERCISES = [
    Exercise("P1.1", initial_particles, lambda rng: (rng.uniform(-3, 3, 6), int(rng.integers(1, 9))), "warm-up",
             mistakes="""
        ... => return np.tile(state0[:, None], (1, n))
        You have one column for each particle. Make one row for each: n rows of six numbers.
        ... => return np.tile(state0, n)
        You have one long row of 6 n numbers. Each particle is a row of its own.
        ... => return np.concatenate([state0[None], np.zeros((n - 1, 6))])
        Only your first particle is at the start. The others are at the origin.
        ... => return np.tile(np.append(state0[:3], np.zeros(3)), (n, 1))
        You copy the position, but you lose roll, pitch and yaw.
        ... => return state0 + np.linspace(0.01, 0.1, 6 * n).reshape(n, 6)
        Your particles are spread already. By (4) all start alike; the first propagation spreads them.
    """),
    Exercise("P1.2", propagate, cloud, cases={
        "facing back": lambda rng: (np.full((4, 6), np.pi), np.full(6, 0.3), rng.standard_normal((4, 6))),
        "a hand-held camera": lambda rng: (np.eye(5, 6), rng.uniform(0.02, 0.3, 6), rng.standard_normal((5, 6))),
    }, others=[lambda *given: wrapped(propagate(*given), 5), lambda *given: wrapped(propagate(*given), 3)], mistakes="""
        ... => return particles + sigma * noise
        You move along the world's axes. The noise is meant forward and to the left.
        np.sin(particles[:, 5]) => -np.sin(particles[:, 5])
        You turn the wrong way: at yaw 90 degrees, forward is the world's +y.
        (particles[:, 5]) => (particles[:, 5] + step[:, 5])
        You turn first and then move. The noise goes along the yaw *before* this frame.
        cosine, sine = => sine, cosine =
        Cosine and sine are exchanged: at yaw 0, forward is the world's +x.
        sigma * noise => sigma * noise[:1] * np.ones((len(noise), 1))
        All your particles get the same noise: row i of `noise` belongs to particle i.
        return moved => moved[:, 5] = particles[:, 5]; return moved
        Your particles move, but do not turn: the last component of the noise is the yaw's.
        sigma * noise => sigma**2 * noise
        You scale by the variance. The noise is standard normal: multiply it by sigma, not by its square.
        sigma * noise => noise
        sigma is missing: the noise is standard normal, one metre and one radian wide.
        sigma * noise => sigma * noise * [1, 1, 0, 0, 0, 1]
        Up, roll and pitch have noise, too: sigma holds six numbers. In the wagon three of them are 0.
        moved = particles + step => moved = particles + step * [1, 1, 1, 0, 0, 0]
        Only the place moves in yours. Roll, pitch and yaw get their noise, too.
    """),
    Exercise("P1.3", likelihood, images, cases={
        "nothing measured": lambda rng: (np.full((2, 3), np.nan), rng.uniform(1, 9, (4, 2, 3)), 0.1),
        "a particle that hits nothing": lambda rng: (np.full((1, 2), 4.0), np.array([[[4.1, 4]], [[np.inf] * 2]]), 0.1),
    }, mistakes="""
        ... => return np.sum(alpha / (alpha + np.abs(measured - simulated)), axis=(1, 2))
        A pixel that was not measured (NaN) makes the whole sum NaN. Leave it out, for all particles alike.
        .sum(axis=1) => .sum(axis=1) / np.maximum(np.isfinite(difference).sum(axis=1), 1) * valid.sum()
        You leave simulated misses out, so looking into holes costs nothing. A miss counts, with term 0.
        .sum(axis=1) => .sum(axis=1) / max(1, valid.sum())
        .sum(axis=1) => .sum(axis=1) / measured.size
        You take a mean over the pixels. Eq. (8) is a sum.
        alpha / (alpha + difference) => 1 - difference / (alpha + difference)
        At your simulated misses inf / inf is NaN. Write the term as one fraction.
        .sum(axis=1) => .sum(axis=1) + (~valid).sum()
        Pixels without measurement get the full 1 in yours. Leave them out.
        return ( => return valid.sum() - (
        Yours grows with the disagreement. The 1 - is missing, so the best particle becomes the worst.
        alpha / (alpha + difference) => np.exp(-(difference**2) / (2 * alpha**2))
        You use a bell curve. The term of (8) is 1 - d / (alpha + d), where d is the absolute difference.
        valid = np.isfinite(measured) => measured = np.nan_to_num(measured); valid = np.isfinite(measured)
        A pixel without measurement is not a wall at 0 m: leave NaN out.
        np.abs(measured[valid] - simulated[:, valid]) => measured[valid] - simulated[:, valid]
        The difference is not made absolute, so an image that is too near counts as more than perfect.
    """),
    Exercise("P1.4", particle_weights, likelihoods, cases={
        "the paper's beta": lambda rng: (likelihoods(rng)[0], 0.01),
        "all alike": lambda rng: (np.full(int(rng.integers(2, 6)), rng.uniform(100, 900)), 0.01),
        "one alone": lambda rng: (rng.uniform(100, 900, 1), 0.01),
    }, mistakes="""
        beta**2 => beta
        beta stands squared in (10).
        return w / w.sum() => return w
        Weights must sum to one: (11) is still missing.
        (normalized - 1) => normalized
        In yours the worst particle gets the most. In (10) l - 1 is squared, the distance from the best.
        np.exp(-((normalized - 1) ** 2) / beta**2) => normalized
        You make (9) sum to one, but (10) is missing.
        (values - values.min()) / spread => values / values.max()
        You divide by the greatest likelihood. (9) spreads them from 0 for the worst to 1 for the best.
        / beta**2 => / (2 * beta**2)
        There is no 2 in (10): it is no normal distribution.
        if spread > 0 else np.ones(len(values)) =>
        0/0 where all likelihoods agree. Nothing speaks for one of them then: which weights are fair?
        return w / w.sum() => return w / w.sum() if spread > 0 else np.zeros(len(w))
        Where all likelihoods agree the weights must sum to one, too, and nothing speaks for one of them.
    """),
    Exercise("P1.5", estimate, weighted_cloud, cases={
        "on both sides of the seam": lambda rng: (np.outer([1, -1], [1, 2, 3, 0.1, 0.1, 3.1]), np.array([0.3, 0.7])),
    }, mistakes="""
        ... => return w @ particles
        You compute (12) as printed. Its angles fail at +-180 degrees (lesson 07).
        ... => return particles.mean(axis=0)
        You take a plain mean: where are the weights, and the circle?
        ... => return particles[np.argmax(w)].copy()
        Yours is the heaviest particle. In (12) all take part.
        w @ np.sin(angles), w @ np.cos(angles) => np.mean(np.sin(angles), axis=0), np.mean(np.cos(angles), axis=0)
        Your positions are weighted, but your angles are not.
        np.arctan2 => 180 / np.pi * np.arctan2
        Your angles are in degrees: a state is in metres and radians.
        w @ np.cos(angles)) => w @ np.cos(angles)) % (2 * np.pi)
        The directions are right, but from 0 to 2 pi. The course's angles lie between -pi and pi.
        ... => return np.concatenate([w @ particles[:, :5], estimate(particles, w)[5:]])
        Your yaw is on the circle, but roll and pitch are not: average all three angles there.
        np.arctan2(w @ np.sin(angles), w @ np.cos(angles)) => w @ (angles % (2 * np.pi))
        From 0 to 2 pi the seam is at 0 instead of 180 degrees, but it is still there. Average on the circle.
        np.arctan2(w @ np.sin(angles), w @ np.cos(angles)) => wrap_angle(angles[0] + w @ wrap_angle(angles - angles[0]))
        You average differences from the first particle: which one is first decides the answer. Add arrows.
    """),
    Exercise("P1.6", resample, weights_and_offset, cases={
        "last ones without weight": lambda rng: (np.array([0.25, 0.25, 0.5, 0, 0, 0, 0, 0]), rng.uniform(0.05, 0.95)),
        "all weight on one": lambda rng: (np.eye(6)[rng.integers(6)], rng.uniform(0.05, 0.95)),
        "equal weights": lambda rng: (np.full(8, 0.125), rng.uniform(0.05, 0.95)),
    }, mistakes="""
        (np.arange(len(w)) + u) / len(w) => np.sort((np.arange(len(w)) / len(w) + u) % 1.0)
        The offset is u of one step: the first point lies at u / N, not at u.
        ... => return resample(w, 0.5)
        ... => return resample(w, 0.0)
        Your points do not start at u / N: where is u? The random offset makes the draw fair.
        ... => return np.repeat(np.arange(len(w)), np.round(len(w) * w).astype(int))
        You round N w. This is not unbiased: step through the summed weights instead.
        ... => return (np.arange(len(w)) + u) / len(w)
        Yours are the points. Return the particle whose share of the sum each point falls into.
        ... => return np.bincount(resample(w, u), minlength=len(w))
        Yours are the numbers of copies. Return the indices, each as often as it is copied.
        cumulative = np.cumsum(w) => cumulative = np.copy(w)
        You look the points up among the weights. They lie along the *sum* of the weights so far.
    """),
    Exercise("P1.7", one_round, a_frame, "challenge", cases={"all at one place": lambda rng: a_frame(rng, 0)},
             mistakes="""
        estimate(moved, w) => estimate(moved[resample(w, u)], np.full(len(w), 1 / len(w)))
        You estimate from the copies. The weights know more: estimate first, then resample.
        render(moved) => render(particles)
        You render from where the particles were. The image is of *this* frame: move them first.
        propagate(particles, sigma, noise) => particles and also moved[ => propagate(moved, sigma, noise)[
        You move at the end of the round, so this frame's image weighs the last frame's particles.
        moved[resample(w, u)] => moved
        Your particles are not resampled: the light ones live on with the heavy ones.
        moved[resample(w, u)] => particles[resample(w, u)]
        You copy the particles from before they moved.
        particle_weights( => (lambda values, beta: values / values.sum())(
        You weigh by the raw likelihoods: (9) and (10) are left out.
        propagate(particles, sigma, noise) => particles
        Your particles do not move at all: where is the system noise?
        estimate(moved, w) => moved[np.argmax(w)]
        Your estimate is the heaviest particle. In (12) all take part.
        estimate(moved, w) => estimate(particles, w)
        The weights are of the moved particles, but your estimate is of those from before they moved.
    """),
]
