"""Exercises of lesson 07: a mean of angles, residual resampling mended, who survives, what stratified draws cost."""

import numpy as np

from course_lib.lessons.kit.exercises import Exercise

# 07.1: the mean of angles, and how far they agree


def mean_angle(angles, w):
    """Mean direction in radians, from -pi to pi, and length R of the mean point, of angles (N,) with weights w (N,)."""
    # Add up the points on the circle; direction and length of the sum.
    s, c = np.sum(w * np.sin(angles)), np.sum(w * np.cos(angles))
    return np.arctan2(s, c), np.hypot(s, c)


def weighted_headings(rng: np.random.Generator) -> tuple:
    """Headings about one direction, often one near the wrap or near zero, and weights that sum to one."""
    n = int(rng.integers(4, 9))
    centre = rng.choice([rng.uniform(-np.pi, np.pi), np.pi, 0.0]) + rng.uniform(-0.1, 0.1)
    w = rng.uniform(0.1, 1, n)
    return wrapped(centre + rng.normal(0, 0.4, n)), w / w.sum()


def about_the_wrap(rng: np.random.Generator) -> tuple:
    return np.deg2rad([170, 175, -175, -165]), np.arange(1, 5) / 10


def about_zero(rng: np.random.Generator) -> tuple:
    return np.deg2rad([-20, 5, 10]), np.arange(1, 4) / 6


def all_around(rng: np.random.Generator) -> tuple:
    return np.deg2rad([0, 90, 170, -90]), np.arange(1, 5) / 10


def all_the_same_way(rng: np.random.Generator) -> tuple:
    return np.deg2rad([30, 30, 30]), np.arange(1, 4) / 6


def wrapped(angle):
    return (angle + np.pi) % (2 * np.pi) - np.pi


# 07.2: residual resampling, mended


def residual_parts(w):
    """Certain copies (N,) and the probabilities (N,) of the remaining draws, for weights w (N,)."""
    # Filterpy's second line lacks the N. What is owed is N w, and N w - copies is left over.
    copies = np.floor(len(w) * w)
    rest = len(w) * w - copies
    return copies, rest / rest.sum()


def parts_rounded(w, rounded, rest_of):
    """A mistake: N w `rounded` in another way, and the rest by `rest_of` the difference."""
    copies = rounded(len(w) * w)
    rest = rest_of(len(w) * w - copies)
    with np.errstate(all="ignore"):  # the rest may add up to zero
        return copies, rest / rest.sum()


def uneven_weights(rng: np.random.Generator) -> tuple:
    """Weights, two or three of them heavy: these are copied for certain, and the others are light."""
    n = int(rng.integers(6, 13))
    light = rng.uniform(0.2, 0.9, n - int(rng.integers(2, 4))) / n
    heavy = rng.uniform(0.8, 1.2, n - len(light))
    return (rng.permutation(np.concatenate([light, heavy / heavy.sum() * (1 - light.sum())])),)


def whole_numbers(rng: np.random.Generator) -> tuple:
    """N w of 2, 1, 1/2 and 1/2: two particles are owed nothing more."""
    return (np.array([0.5, 0.25, 0.125, 0.125]),)


# 07.3: how many different particles survive


def expected_survivors(w):
    """Expected number of different particles after multinomial resampling with weights w (N,)."""
    # Each particle survives unless it is missed N times; the expectations add up.
    return np.sum(1 - (1 - w) ** len(w))


def all_equal(rng: np.random.Generator) -> tuple:
    n = int(rng.integers(3, 9))
    return (np.full(n, 1 / n),)


def one_has_all(rng: np.random.Generator) -> tuple:
    return (rng.permutation(np.eye(int(rng.integers(3, 9)))[0]),)


# 07.4: the error bar of stratified resampling


def stratified_error(w, x):
    """Standard deviation of the mean of x (N,) after stratified resampling with weights w (N,)."""
    # The variances of the parts add up; the mean divides by N.
    n, right, variance = len(w), np.cumsum(w), 0.0
    for k in range(n):
        overlap = np.minimum(right, (k + 1) / n) - np.maximum(right - w, k / n)
        p = n * np.clip(overlap, 0, None)
        variance += np.sum(p * (x - p @ x) ** 2)
    return np.sqrt(variance) / n


def weights_and_values(rng: np.random.Generator) -> tuple:
    (w,) = uneven_weights(rng)
    return w, rng.normal(rng.uniform(-3, 3), 1.0, len(w))


def three_particles(rng: np.random.Generator) -> tuple:
    return np.array([0.5, 0.3, 0.2]), rng.permutation(np.arange(3.0))


def light_ones_last(rng: np.random.Generator) -> tuple:
    """The ten particles of the lesson, two of them heavy."""
    return np.array([0.22] * 2 + [0.07] * 8), rng.normal(size=10)


def spread(w, x):
    """Standard deviation of x in one draw with probabilities w."""
    return np.sqrt(w @ (x - w @ x) ** 2)


def residual_error(w, x):
    """The error bar of residual resampling, for which some take it."""
    copies, rest = residual_parts(w)
    return np.sqrt(len(w) - copies.sum()) * spread(rest, x) / len(w)


# fmt: off
EXERCISES = [
    Exercise("07.1", mean_angle, weighted_headings, "warm-up", cases=[
        about_the_wrap, about_zero, all_around, all_the_same_way,
    ], mistakes="""
        np.arctan2(s, c) => np.sum(w * angles)
        np.arctan2(s, c) => np.mean(angles)
        Your direction averages numbers, as eq. (12) is printed: it fails at the wrap. Add points on the circle.
        np.arctan2(s, c) => wrapped(np.sum(w * (angles % (2 * np.pi))))
        You count angles from 0 to 2 pi and average those. That only moves the wrap: it now fails near 0.
        np.arctan2(s, c) => wrapped(angles[0] + np.sum(w * wrapped(angles - angles[0])))
        Close: you move the wrap away, then average numbers. Add points on the circle: sines and cosines.
        np.arctan2(s, c) => np.arcsin(s)
        arcsin knows half of the circle only, and the sum is no longer of length 1: use sine *and* cosine.
        np.arctan2(s, c) => np.arctan2(s, c) % (2 * np.pi)
        Right direction, but from 0 to 2 pi. The task asks for -pi to pi, as np.arctan2 gives it.
        w * np.sin(angles) => np.sin(w * angles) and also w * np.cos(angles) => np.cos(w * angles)
        You weigh the angles themselves. The weight stands before sine and cosine: w * np.sin(angles).
        w * np => np
        w * np => 1 / len(w) * np
        You have not used the weights: every particle counts the same in yours.
        np.arctan2(s, c), np.hypot(s, c) => c, s
        That is the mean point itself, by its coordinates. Asked for are its direction and its length.
        np.hypot(s, c) => np.hypot(np.mean(np.sin(angles)), np.mean(np.cos(angles)))
        Your direction is right. Your R has no weights: it is the length of the same mean point.
        np.hypot(s, c) => np.hypot(s, c) / len(w)
        np.mean divides by N once more: the weights sum to 1 already, so add up. Your R is too short.
        np.hypot(s, c) => 1 - np.hypot(s, c)
        Yours is 1 - R, how far they disagree. R itself is asked for: 1 where all look the same way.
        np.hypot(s, c) => 1.0
        A point *on* the circle has length 1; the mean of several lies inside it. How far from the middle?
    """),
    Exercise("07.2", residual_parts, uneven_weights, cases=[whole_numbers], mistakes="""
        rest = len(w) * w - copies => rest = w - copies
        That is filterpy's slip: w is taken for N w, and the light particles get a negative probability.
        rest = len(w) * w - copies => rest = np.maximum(w - copies, 0)
        rest = len(w) * w - copies => rest = np.abs(w - copies)
        Cut off at 0, or made positive, filterpy's slip remains: the heavy ones are owed something, too. N w, not w.
        rest / rest.sum() => rest
        rest / rest.sum() => rest / len(w)
        As probabilities the residuals must sum to 1: divide by their own sum.
        rest / rest.sum() => w
        You draw the rest by the full weights: heavy particles, served already, are served twice.
        rest / rest.sum() => len(w) * w / rest.sum()
        You divide by the right sum, but what has been given out is still in it: subtract the copies.
        rest / rest.sum() => np.full(len(w), 1 / len(w))
        You draw the rest with equal probabilities. The part of N w after the decimal point decides.
        ... => return parts_rounded(w, np.round, np.array)
        ... => return parts_rounded(w, np.round, np.abs)
        ... => return parts_rounded(w, np.ceil, np.abs)
        return copies => return np.round(len(w) * w)
        You round N w. Of 2.7 only 2 copies are certain, np.floor; a copy too many leaves a negative rest.
        return copies => return len(w) * w
        Copies come in whole numbers: np.floor of N w.
        len(w) * w => w
        N is missing: a weight below 1 has floor 0. It is N times the weight that counts copies.
        len(w) => 10
        Your N is always 10, as in the lesson: it is len(w).
    """),
    Exercise("07.3", expected_survivors, uneven_weights, cases=[all_equal, one_has_all, whole_numbers], mistakes="""
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
        ** len(w) => ** (len(w) - 1)
        ** len(w) => ** 2
        A particle must be missed in all draws: there are N of them, len(w).
        (1 - w) ** len(w) => w ** len(w)
        w to the power N is the chance to be drawn *every* time. You need that of never: 1 - w, to the N.
        np.sum(1 - (1 - w) ** len(w)) => np.sum(len(w) * w * (1 - w) ** (len(w) - 1))
        You count those that are drawn exactly once. Drawn twice or more they live on, too.
        (1 - w) ** len(w) => np.exp(-len(w) * w)
        Close: exp(-N w) is the limit for many particles. Here N is small: take the power itself.
        np.sum(1 - (1 - w) ** len(w)) => len(w) * (1 - (1 - 1 / len(w)) ** len(w))
        np.sum(1 - (1 - w) ** len(w)) => len(w) * (1 - np.exp(-1))
        That holds for equal weights. Each particle has its own chance of not being drawn: 1 - w.
        np.sum(1 - (1 - w) ** len(w)) => 1 / np.sum(w**2)
        That is the effective sample size. It says how uneven the weights are, not how many are drawn.
        np.sum(1 - (1 - w) ** len(w)) => np.sum(np.minimum(1, len(w) * w))
        That is the number for systematic resampling. N independent draws may miss a particle with N w > 1.
        ... => return round(expected_survivors(w))
        A mean number need not be whole: do not round.
    """),
    Exercise("07.4", stratified_error, weights_and_values, "challenge", cases=[
        three_particles, light_ones_last,
    ], mistakes="""
        ... => return spread(w, x) / np.sqrt(len(w))
        That is the formula for independent draws. Here each part of the strip has a mean of its own.
        ... => return spread(w, x) * np.sqrt(np.sum(w**2))
        With N_eff in it that is the error of the *weighted* mean. Asked for is what resampling adds.
        ... => return residual_error(w, x)
        That is residual resampling: certain copies, then independent draws. Here each part has one draw.
        ... => return spread(w, x)
        ... => return spread(w, x) / len(w)
        You take the spread of all the x. Find the variance of each part's draw, add, then divide the root by N.
        ... => return 0.0
        It is not zero: in a part that two fields share, chance decides which of them is picked.
        ... => order = np.argsort(-w); return stratified_error(w[order], x[order])
        You sort the particles first. The fields lie on the strip in the order given, and it matters.
        np.clip(overlap, 0, None) => overlap and also return np => with np.errstate(invalid="ignore"): return np
        Where a field lies outside a part your overlap is negative. It is 0 there.
        p = n * => p =
        np.sum(p * (x => np.sum(p / n * (x
        In each part your probabilities sum to 1/N. The point is in that part for certain: they sum to 1.
        variance += np.sum(p * (x - p @ x) ** 2) => variance += spread(p, x) and also np.sqrt(variance) => variance
        You add standard deviations. Of independent draws the *variances* add; the root comes last.
        np.sqrt(variance) / n => np.sqrt(variance) / (n - 1)
        The mean divides by N, not by N - 1: no variance is estimated here, all probabilities are known.
        np.sqrt(variance) / n => np.sqrt(variance)
        np.sqrt(variance) / n => np.sqrt(variance / n)
        That is for the *sum* of the new x. A factor 1/N enters a variance squared: N variances, divided by N * N.
    """),
]
