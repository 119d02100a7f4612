"""Exercises of lesson 07: a mean of angles, residual resampling mended, who survives, what stratified draws cost."""

import numpy as np

from course_lib.geometry import wrap_angle
from courseware.lessons.kit.exercises import Exercise


def mean_angle(angles, w):
    """Mean direction in radians, from -pi to pi, and length R of the mean point, of angles (N,) with weights w (N,)."""
    # Add up the points on the circle; direction and length of the sum.
    s, c = np.sum(w * np.sin(angles)), np.sum(w * np.cos(angles))
    return np.arctan2(s, c), np.hypot(s, c)


def weighted_headings(rng: np.random.Generator) -> tuple:
    """Make headings about one direction, often one near the wrap or near zero, and weights that sum to one."""
    n = int(rng.integers(4, 9))
    centre = rng.choice([rng.uniform(-np.pi, np.pi), np.pi, 0.0]) + rng.uniform(-0.1, 0.1)
    w = rng.uniform(0.1, 1, n)
    return wrap_angle(centre + rng.normal(0, 0.4, n)), w / w.sum()


def residual_parts(w):
    """Certain copies (N,) and the probabilities (N,) of the remaining draws, for weights w (N,)."""
    # Filterpy's second line lacks the N. What is owed is N w, and N w - copies is left over.
    copies = np.floor(len(w) * w)
    rest = len(w) * w - copies
    return copies, rest / rest.sum()


def uneven_weights(rng: np.random.Generator) -> tuple:
    """Make two or three heavy weights, which are copied for certain, and light ones."""
    n = int(rng.integers(6, 13))
    light = rng.uniform(0.2, 0.9, n - int(rng.integers(2, 4))) / n
    heavy = rng.uniform(0.8, 1.2, n - len(light))
    return (rng.permutation(np.concatenate([light, heavy / heavy.sum() * (1 - light.sum())])),)


def expected_survivors(w):
    """Expected number of different particles after multinomial resampling with weights w (N,)."""
    # Each particle survives unless it is missed N times; the expectations add up.
    return np.sum(1 - (1 - w) ** len(w))


def stratified_error(w, x):
    """Standard deviation of the mean of x (N,) after stratified resampling with weights w (N,)."""
    # The variances of the parts add up; the mean divides by N.
    n, right, variance = len(w), np.cumsum(w), 0.0
    for k in range(n):
        overlap = np.minimum(right, (k + 1) / n) - np.maximum(right - w, k / n)
        p = n * np.clip(overlap, 0, None)
        variance += np.sum(p * (x - p @ x) ** 2)
    return np.sqrt(variance) / n


def spread(w, x):
    """Return the standard deviation of x in one draw with probabilities w."""
    return np.sqrt(w @ (x - w @ x) ** 2)


# fmt: off
WHOLE_NUMBERS = {"whole numbers": lambda rng: (np.array([0.5, 0.25, 0.125, 0.125]),)}  # two are owed nothing more
EXERCISES = [
    Exercise("07.1", mean_angle, weighted_headings, "warm-up", cases={
        "about the wrap": lambda rng: (np.deg2rad([170, 175, -175, -165]), np.arange(1, 5) / 10),
        "about zero": lambda rng: (np.deg2rad([-20, 5, 10]), np.arange(1, 4) / 6),
        "all around": lambda rng: (np.deg2rad([0, 90, 170, -90]), np.arange(1, 5) / 10),
        "all the same way": lambda rng: (np.deg2rad([30, 30, 30]), np.arange(1, 4) / 6),
    }, mistakes="""
        np.arctan2(s, c) => np.sum(w * angles)
        Your direction averages numbers, as eq. (12) is printed: it fails at the wrap. Add points on the circle.
        np.arctan2(s, c) => wrap_angle(np.sum(w * (angles % (2 * np.pi))))
        You count angles from 0 to 2 pi and average those. That only moves the wrap: it now fails near 0.
        np.arctan2(s, c) => np.arcsin(s)
        arcsin knows half of the circle only, and the sum is no longer of length 1. Use sine *and* cosine.
        np.arctan2(s, c) => np.arctan2(s, c) % (2 * np.pi)
        Your direction is right, but from 0 to 2 pi. The task asks for -pi to pi, as np.arctan2 gives it.
        w * np => np
        w * np => 1 / len(w) * np
        You have not used the weights. In yours every particle counts the same.
        np.hypot(s, c) => np.hypot(np.mean(np.sin(angles)), np.mean(np.cos(angles)))
        Your direction is right. Your R has no weights: it is the length of the same mean point.
        np.hypot(s, c) => np.hypot(s, c) / len(w)
        np.mean divides by N once more. The weights sum to 1 already, so add up. Your R is too short.
        np.hypot(s, c) => 1.0
        A point *on* the circle has length 1; the mean of several lies inside it. How far from the middle?
    """),
    Exercise("07.2", residual_parts, uneven_weights, cases=WHOLE_NUMBERS, mistakes="""
        rest = len(w) * w - copies => rest = w - copies
        That is filterpy's slip: it takes w for N w, and the light particles get a negative probability.
        rest = len(w) * w - copies => rest = np.maximum(w - copies, 0)
        rest = len(w) * w - copies => rest = np.abs(w - copies)
        Cut off at 0, or made positive, filterpy's slip remains. The heavy ones are owed something, too: N w, not w.
        rest / rest.sum() => rest
        As probabilities the residuals must sum to 1: divide by their own sum.
        rest / rest.sum() => w
        You draw the rest by the full weights, so heavy particles, which are served already, are served twice.
        rest / rest.sum() => np.full(len(w), 1 / len(w))
        You draw the rest with equal probabilities. The part of N w after the decimal point decides.
        np.floor => np.round and also return copies => with np.errstate(all="ignore"): return copies
        return copies => return np.round(len(w) * w)
        You round N w. Of 2.7 only 2 copies are certain, np.floor; a copy too many leaves a negative rest.
        return copies => return len(w) * w
        Copies come in whole numbers: np.floor of N w.
        len(w) * w => w
        N is missing: a weight below 1 has floor 0. It is N times the weight that counts copies.
    """),
    Exercise("07.3", expected_survivors, uneven_weights, cases=WHOLE_NUMBERS | {
        "all equal": lambda rng: (np.full(n := int(rng.integers(3, 9)), 1 / n),),
        "one has all": lambda rng: (rng.permutation(np.eye(int(rng.integers(3, 9)))[0]),),
    }, mistakes="""
        np.sum(1 - (1 - w) ** len(w)) => np.sum((1 - w) ** len(w))
        That is how many die out. The others survive: 1 minus that, for each particle.
        np.sum(1 - (1 - w) ** len(w)) => 1 - np.sum((1 - w) ** len(w))
        The 1 belongs to every particle: sum 1 - (1 - w)^N, brackets and all.
        np.sum(1 - (1 - w) ** len(w)) => 1 - (1 - w) ** len(w)
        That is the chance of each particle. The expected number is the sum of the chances.
        np.sum => np.mean
        That is the share of the particles that survive. The task asks for their number.
        np.sum(1 => np.sum(w * (1 and also len(w)) => len(w)))
        You weigh the chances. A survivor counts 1, heavy or light: add up the chances alone.
        (1 - w) ** len(w) => w ** len(w)
        w to the power N is the chance to be drawn *every* time. You need the chance of never: 1 - w, to the N.
        (1 - w) ** len(w) => np.exp(-len(w) * w)
        Close: exp(-N w) is the limit for many particles. Here N is small: take the power itself.
        np.sum(1 - (1 - w) ** len(w)) => len(w) * (1 - (1 - 1 / len(w)) ** len(w))
        That holds for equal weights. Each particle has its own chance of not being drawn: 1 - w.
        np.sum(1 - (1 - w) ** len(w)) => 1 / np.sum(w**2)
        That is the effective sample size. It says how uneven the weights are, not how many are drawn.
    """),
    Exercise("07.4", stratified_error, lambda rng: (
        w := uneven_weights(rng)[0], rng.normal(rng.uniform(-3, 3), 1.0, len(w)),
    ), "challenge", cases={
        "three particles": lambda rng: (np.array([0.5, 0.3, 0.2]), rng.permutation(np.arange(3.0))),
        "light ones last": lambda rng: (np.array([0.22] * 2 + [0.07] * 8), rng.normal(size=10)),
    }, mistakes="""
        ... => return spread(w, x) / np.sqrt(len(w))
        That is the formula for independent draws. Here each part of the strip has a mean of its own.
        ... => return spread(w, x) * np.sqrt(np.sum(w**2))
        With N_eff in it that is the error of the *weighted* mean. The task asks for what resampling adds.
        ... => c, p = residual_parts(w); return np.sqrt(len(w) - c.sum()) * spread(p, x) / len(w)
        That is residual resampling: certain copies, then independent draws. Here each part has one draw.
        ... => return spread(w, x) / len(w)
        You take the spread of all the x. Find the variance of each part's draw, add, then divide the root by N.
        ... => order = np.argsort(-w); return stratified_error(w[order], x[order])
        You sort the particles first. The fields lie on the strip in the order given, and it matters.
        p = n * => p =
        In each part your probabilities sum to 1/N. The point is in that part for certain: they sum to 1.
        variance += np.sum(p * (x - p @ x) ** 2) => variance += spread(p, x) and also np.sqrt(variance) => variance
        You add standard deviations. The *variances* of independent draws add; the root comes last.
        np.sqrt(variance) / n => np.sqrt(variance)
        np.sqrt(variance) / n => np.sqrt(variance / n)
        That is for the *sum* of the new x. A factor 1/N enters a variance squared: N variances, divided by N * N.
    """),
]
