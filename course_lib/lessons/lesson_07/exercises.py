"""Exercises of lesson 07: a mean of angles, residual resampling mended, who survives, what stratified draws cost."""

from collections.abc import Callable

import numpy as np

from course_lib.lessons.kit.exercises import Exercise, Mistake

# 07.1: the mean of angles, and how far they agree


def mean_angle(angles: np.ndarray, w: np.ndarray) -> tuple[float, float]:
    """Mean direction in [-pi, pi] of angles (N,) [rad] with weights (N,), and the length R of the mean point."""
    s, c = np.sum(w * np.sin(angles)), np.sum(w * np.cos(angles))
    return float(np.arctan2(s, c)), float(np.hypot(s, c))


def _angles(rng: np.random.Generator) -> tuple:
    """Headings about one direction, often one near the wrap or near zero, and weights that sum to one."""
    n = int(rng.integers(4, 9))
    centre = rng.choice([rng.uniform(-np.pi, np.pi), np.pi, 0.0]) + rng.uniform(-0.1, 0.1)
    angles = (centre + rng.normal(0, 0.4, size=n) + np.pi) % (2 * np.pi) - np.pi
    w = rng.uniform(0.1, 1, size=n)
    return angles, w / w.sum()


def _given(*degrees: float) -> Callable[[np.random.Generator], tuple]:
    """Headings that are always asked for, with uneven weights: about the wrap, about zero, all around the circle."""
    w = np.arange(1.0, len(degrees) + 1)
    return lambda rng: (np.deg2rad(degrees), w / w.sum())


def _length(angles: np.ndarray, w: np.ndarray) -> float:
    return mean_angle(angles, w)[1]


def _cut_at_zero(angles: np.ndarray, w: np.ndarray) -> float:
    mean = np.sum(w * (angles % (2 * np.pi)))
    return float((mean + np.pi) % (2 * np.pi) - np.pi)


def _about_the_first(angles: np.ndarray, w: np.ndarray) -> float:
    def wrapped(a):
        return (a + np.pi) % (2 * np.pi) - np.pi

    return float(wrapped(angles[0] + np.sum(w * wrapped(angles - angles[0]))))


# 07.2: residual resampling, mended


def residual_parts(w: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Certain copies floor(N w) (N,), and the probabilities (N,) of the draws that fill up the rest."""
    copies = np.floor(len(w) * w)
    rest = len(w) * w - copies
    return copies, rest / rest.sum()


def _uneven_weights(rng: np.random.Generator) -> tuple:
    """Weights, two or three of them heavy: these are copied for certain, and the others are light."""
    n = int(rng.integers(6, 13))
    light = rng.uniform(0.2, 0.9, size=n - int(rng.integers(2, 4))) / n
    heavy = rng.uniform(0.8, 1.2, size=n - len(light))
    return (rng.permutation(np.concatenate([light, heavy / heavy.sum() * (1 - light.sum())])),)


def _some_whole(rng: np.random.Generator) -> tuple:
    """N w of 2, 1, 1/2 and 1/2: two particles are owed nothing more."""
    return (np.array([0.5, 0.25, 0.125, 0.125]),)


def _all_equal(rng: np.random.Generator) -> tuple:
    n = int(rng.integers(3, 9))
    return (np.full(n, 1 / n),)


def _one_has_all(rng: np.random.Generator) -> tuple:
    return (rng.permutation(np.eye(int(rng.integers(3, 9)))[0]),)


def _copies(w: np.ndarray) -> np.ndarray:
    return np.floor(len(w) * w)


def _shares(values: np.ndarray) -> np.ndarray:
    with np.errstate(divide="ignore", invalid="ignore"):  # what a wrong rest adds up to may be zero
        return values / values.sum()


# 07.3: how many different particles survive


def expected_survivors(w: np.ndarray) -> float:
    """Expected number of different particles after N independent draws with probabilities w (N,)."""
    return float(np.sum(1 - (1 - w) ** len(w)))


# 07.4: the error bar of stratified resampling


def stratified_error(w: np.ndarray, x: np.ndarray) -> float:
    """Standard deviation of the mean of x (N,) after stratified resampling with weights w (N,)."""
    p = _shares_of_parts(w)
    return float(np.sqrt(np.sum(_variances(p, x))) / len(w))


def _overlaps(w: np.ndarray) -> np.ndarray:
    """How much of each part of the strip (rows) each particle's field (columns) covers, `(N, N)`; sum 1 in all."""
    right, parts = np.cumsum(w), np.arange(len(w))[:, None] / len(w)
    return np.clip(np.minimum(right, parts + 1 / len(w)) - np.maximum(right - w, parts), 0, None)


def _shares_of_parts(w: np.ndarray) -> np.ndarray:
    return len(w) * _overlaps(w)


def _variances(p: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Variance of x in each row of probabilities."""
    return np.sum(p * (x - (p @ x)[:, None]) ** 2, axis=1)


def _one_draw(w: np.ndarray, x: np.ndarray) -> float:
    """Variance of x in one draw with probabilities w."""
    return float(np.sum(w * (x - w @ x) ** 2))


def _residual_error(w: np.ndarray, x: np.ndarray) -> float:
    copies, rest = residual_parts(w)
    return float(np.sqrt((len(w) - copies.sum()) * _one_draw(rest, x)) / len(w))


def _not_clipped(w: np.ndarray, x: np.ndarray) -> float:
    right, parts = np.cumsum(w), np.arange(len(w))[:, None] / len(w)
    p = len(w) * (np.minimum(right, parts + 1 / len(w)) - np.maximum(right - w, parts))
    with np.errstate(invalid="ignore"):  # a variance of negative probabilities may be negative
        return float(np.sqrt(np.sum(_variances(p, x))) / len(w))


def _weights_and_values(rng: np.random.Generator) -> tuple:
    (w,) = _uneven_weights(rng)
    return w, rng.normal(rng.uniform(-3, 3), 1.0, size=len(w))


def _three_and_values(rng: np.random.Generator) -> tuple:
    return np.array([0.5, 0.3, 0.2]), rng.permutation(np.arange(3.0))


def _light_ones_last(rng: np.random.Generator) -> tuple:
    """The ten particles of the lesson, two of them heavy."""
    return np.array([0.22] * 2 + [0.07] * 8), rng.normal(size=10)


EXERCISES = [
    Exercise(
        number="07.1",
        solution=mean_angle,
        inputs=_angles,
        level="warm-up",
        cases=(_given(170, 175, -175, -165), _given(-20, 5, 10), _given(0, 90, 170, -90), _given(30, 30, 30)),
        mistakes=(
            Mistake(
                lambda angles, w: (mean_angle(angles, w)[0], _length(angles, w) / len(w)),
                "np.mean divides by N once more: the weights sum to 1 already, so add up. Your R is too short.",
            ),
            Mistake(
                lambda angles, w: (mean_angle(angles, w)[0], _length(angles, np.full(len(w), 1 / len(w)))),
                "Your direction is right. Your R has no weights: it is the length of the same mean point.",
            ),
            Mistake(
                lambda angles, w: (mean_angle(angles, w)[0], _length(angles, w) * len(w)),
                "Your R grows with the number of particles: it is the length of a mean, at most 1.",
            ),
            Mistake(
                lambda angles, w: (float(np.sum(w * np.cos(angles))), float(np.sum(w * np.sin(angles)))),
                "That is the mean point itself, by its coordinates. Asked for are its direction and its length.",
            ),
            Mistake(
                lambda angles, w: (-mean_angle(angles, w)[0], _length(angles, w)),
                "Your direction is mirrored: it has the wrong sign.",
            ),
            Mistake(
                lambda angles, w: (
                    mean_angle(angles, w)[0],
                    float(np.sqrt(-2 * np.log(np.minimum(_length(angles, w), 1)))),
                ),
                "That is the circular standard deviation, made of R. R itself is asked for.",
            ),
            Mistake(
                lambda angles, w: (float(np.sum(w * angles)), _length(angles, w)),
                "Your direction is eq. (12) as printed: it fails at the wrap. Take the direction of the mean point.",
            ),
            Mistake(
                lambda angles, w: (_cut_at_zero(angles, w), _length(angles, w)),
                "You count angles from 0 to 2 pi and average those. That only moves the wrap: it now fails near 0.",
            ),
            Mistake(
                lambda angles, w: (
                    float(np.arctan(np.sum(w * np.sin(angles)) / np.sum(w * np.cos(angles)))),
                    _length(angles, w),
                ),
                "arctan of a quotient cannot tell a direction from its opposite. np.arctan2 takes two arguments.",
            ),
            Mistake(
                lambda angles, w: (
                    float(np.arctan2(np.sum(w * np.cos(angles)), np.sum(w * np.sin(angles)))),
                    _length(angles, w),
                ),
                "np.arctan2 takes the sine first, then the cosine: yours is turned by a quarter and mirrored.",
            ),
            Mistake(
                lambda angles, w: mean_angle(angles, np.full(len(w), 1 / len(w))),
                "You have not used the weights: every particle counts the same in yours.",
            ),
            Mistake(
                lambda angles, w: (
                    float(np.arctan2(np.sum(np.sin(angles)), np.sum(np.cos(angles)))),
                    float(np.hypot(np.sum(np.sin(angles)), np.sum(np.cos(angles)))),
                ),
                "You add up the points without their weights: the length then grows with the number of particles.",
            ),
            Mistake(
                lambda angles, w: (float(np.rad2deg(mean_angle(angles, w)[0])), _length(angles, w)),
                "Your direction is in degrees. Angles in, angles out: radians.",
            ),
            Mistake(
                lambda angles, w: (mean_angle(angles, w)[0] % (2 * np.pi), _length(angles, w)),
                "Right direction, but from 0 to 2 pi. The task asks for -pi to pi, as np.arctan2 gives it.",
            ),
            Mistake(
                lambda angles, w: (float(angles[np.argmax(w)]), _length(angles, w)),
                "That is the heading of the heaviest particle. Eq. (12) lets all of them take part.",
            ),
            Mistake(
                lambda angles, w: (float(np.mean(angles)), _length(angles, w)),
                "A plain mean of the numbers: it has no weights, and it fails at the wrap. Add points on the circle.",
            ),
            Mistake(
                lambda angles, w: (
                    float(np.arctan2(np.sum(np.sin(w * angles)), np.sum(np.cos(w * angles)))),
                    float(np.hypot(np.sum(np.sin(w * angles)), np.sum(np.cos(w * angles)))),
                ),
                "You weigh the angles themselves. The weight stands before sine and cosine: w * np.sin(angles).",
            ),
            Mistake(
                lambda angles, w: mean_angle(np.deg2rad(angles), w),
                "The angles are in radians already; you convert them once more.",
            ),
            Mistake(
                lambda angles, w: (_about_the_first(angles, w), _length(angles, w)),
                "Close: you move the wrap away, then average numbers. Add points on the circle: sines and cosines.",
            ),
            Mistake(
                lambda angles, w: (float(np.arcsin(np.sum(w * np.sin(angles)))), _length(angles, w)),
                "arcsin knows half of the circle only, and the sum is no longer of length 1: use sine *and* cosine.",
            ),
            Mistake(
                lambda angles, w: (mean_angle(angles, w)[0], _length(angles, w) ** 2),
                "Your R is its square: the root of the sum of the two squares is missing.",
            ),
            Mistake(
                lambda angles, w: (mean_angle(angles, w)[0], 1 - _length(angles, w)),
                "Yours is 1 - R, how far they disagree. R itself is asked for: 1 where all look the same way.",
            ),
            Mistake(
                lambda angles, w: (mean_angle(angles, w)[0], 1.0),
                "A point *on* the circle has length 1; the mean of several lies inside it. How far from the middle?",
            ),
            Mistake(
                lambda angles, w: (
                    mean_angle(angles, w)[0],
                    float(np.sum(w * np.cos(angles)) + np.sum(w * np.sin(angles))),
                ),
                "You add the two coordinates of the mean point. Its length is the root of the sum of their squares.",
            ),
        ),
    ),
    Exercise(
        number="07.2",
        solution=residual_parts,
        inputs=_uneven_weights,
        cases=(_some_whole,),
        mistakes=(
            Mistake(
                lambda w: (np.floor(10 * w), _shares(10 * w - np.floor(10 * w))),
                "Your N is always 10, as in the lesson: it is len(w).",
            ),
            Mistake(
                lambda w: (_copies(w), _shares(w - _copies(w))),
                "That is filterpy's slip: w is taken for N w, and the light particles get a negative probability.",
            ),
            Mistake(
                lambda w: (_copies(w), len(w) * w - _copies(w)),
                "These are the residuals. As probabilities they must sum to 1: divide by their sum.",
            ),
            Mistake(
                lambda w: (_copies(w), w),
                "You draw the rest by the full weights: heavy particles, served already, are served twice.",
            ),
            Mistake(
                lambda w: (np.round(len(w) * w), _shares(np.abs(len(w) * w - np.round(len(w) * w)))),
                "You round N w. A particle with 2.7 has only 2 copies for certain: np.floor.",
            ),
            Mistake(
                lambda w: (np.round(len(w) * w), _shares(len(w) * w - np.round(len(w) * w))),
                "np.round may give a copy too many, and then the rest is negative. Certain is what np.floor leaves.",
            ),
            Mistake(
                lambda w: (np.round(len(w) * w), residual_parts(w)[1]),
                "Your probabilities are right. Your copies are rounded: with 2.7 only 2 are certain, np.floor.",
            ),
            Mistake(
                lambda w: (_copies(w), len(w) * w / np.sum(len(w) * w - _copies(w))),
                "You divide by the right sum, but what has been given out is still in it: subtract the copies.",
            ),
            Mistake(
                lambda w: (np.ceil(len(w) * w), _shares(np.ceil(len(w) * w) - len(w) * w)),
                "You round N w up: that can give more than N particles in all. Certain are only np.floor of them.",
            ),
            Mistake(
                lambda w: (len(w) * w, _shares(len(w) * w - _copies(w))),
                "Copies come in whole numbers: np.floor of N w.",
            ),
            Mistake(
                lambda w: (np.floor(w), w),
                "N is missing: a weight below 1 has floor 0. It is N times the weight that counts copies.",
            ),
            Mistake(
                lambda w: (_copies(w), np.full(len(w), 1 / len(w))),
                "You draw the rest with equal probabilities. The part of N w after the decimal point decides.",
            ),
            Mistake(
                lambda w: (_copies(w), _shares(np.maximum(w - _copies(w), 0))),
                "Cut off at 0, filterpy's slip remains: the heavy ones are owed something, too. N w, not w.",
            ),
            Mistake(
                lambda w: (_copies(w), _shares(np.abs(w - _copies(w)))),
                "An absolute value hides filterpy's slip. What is left over is N w minus the copies, never negative.",
            ),
            Mistake(
                lambda w: (_copies(w), (len(w) * w - _copies(w)) / len(w)),
                "You divide by N. To sum to 1 the rest must be divided by its own sum.",
            ),
            Mistake(
                lambda w: (np.maximum(_copies(w), 1), residual_parts(w)[1]),
                "You give everybody a copy. Certain is only the whole part of N w: for a light particle that is 0.",
            ),
        ),
    ),
    Exercise(
        number="07.3",
        solution=expected_survivors,
        inputs=_uneven_weights,
        cases=(_all_equal, _one_has_all, _some_whole),
        mistakes=(
            Mistake(
                lambda w: float(np.sum(len(w) * w * (1 - w) ** (len(w) - 1))),
                "You count those that are drawn exactly once. Drawn twice or more they live on, too.",
            ),
            Mistake(
                lambda w: float(np.sum(w * (1 - (1 - w) ** len(w)))),
                "You weigh the chances. A survivor counts 1, heavy or light: add up the chances alone.",
            ),
            Mistake(
                lambda w: float(len(w)),
                "That is how many are drawn. Some of them are copies of the same one.",
            ),
            Mistake(
                lambda w: float(len(w) * np.sum(1 - (1 - w) ** len(w))),
                "The sum of the chances is the number already: do not multiply by N.",
            ),
            Mistake(
                lambda w: float(np.sum((1 - w) ** len(w))),
                "That is how many die out. The others survive: 1 minus that, for each particle.",
            ),
            Mistake(
                lambda w: 1 - (1 - w) ** len(w),
                "That is the chance of each particle. The expected number is the sum of the chances.",
            ),
            Mistake(
                lambda w: float(np.sum(1 - (1 - w) ** (len(w) - 1))),
                "There are N draws, not N - 1.",
            ),
            Mistake(
                lambda w: float(len(w) * (1 - (1 - 1 / len(w)) ** len(w))),
                "That holds for equal weights. Each particle has its own chance of not being drawn: 1 - w.",
            ),
            Mistake(
                lambda w: float(1 / np.sum(w**2)),
                "That is the effective sample size. It says how uneven the weights are, not how many are drawn.",
            ),
            Mistake(
                lambda w: float(np.sum(np.minimum(1, len(w) * w))),
                "That is the number for systematic resampling. N independent draws may miss a particle with N w > 1.",
            ),
            Mistake(
                lambda w: float(np.sum(1 - w ** len(w))),
                "w to the power N is the chance to be drawn *every* time. You need that of never: 1 - w, to the N.",
            ),
            Mistake(
                lambda w: float(np.sum(1 - np.exp(-len(w) * w))),
                "Close: exp(-N w) is the limit for many particles. Here N is small: take the power itself.",
            ),
            Mistake(
                lambda w: float(np.mean(1 - (1 - w) ** len(w))),
                "That is the share of the particles that survive. The task asks for their number.",
            ),
            Mistake(
                lambda w: float(np.sum(_copies(w) > 0)),
                "You count those with N w of at least 1. Light particles may be drawn, and heavy ones missed.",
            ),
            Mistake(
                lambda w: float(np.round(expected_survivors(w))),
                "A mean number need not be whole: do not round.",
            ),
            Mistake(
                lambda w: float(np.sum(1 - (1 - w) ** 2)),
                "That is for two draws. There are N of them: len(w).",
            ),
            Mistake(
                lambda w: float(1 - np.sum((1 - w) ** len(w))),
                "The 1 belongs to every particle: sum 1 - (1 - w)^N, brackets and all.",
            ),
            Mistake(
                lambda w: len(w) * (1 - np.exp(-1)),
                "That is for many particles of equal weight. Here every particle has a chance of its own.",
            ),
        ),
    ),
    Exercise(
        number="07.4",
        solution=stratified_error,
        inputs=_weights_and_values,
        level="challenge",
        cases=(_three_and_values, _light_ones_last),
        mistakes=(
            Mistake(
                lambda w, x: float(np.sqrt(_one_draw(w, x) * np.sum(w**2))),
                "With N_eff in it that is the error of the *weighted* mean. Asked for is what resampling adds.",
            ),
            Mistake(
                _not_clipped,
                "Where a field lies outside a part your overlap is negative. It is 0 there.",
            ),
            Mistake(
                lambda w, x: stratified_error(np.sort(w)[::-1], x[np.argsort(-w)]),
                "You sort the particles first. The fields lie on the strip in the order given, and it matters.",
            ),
            Mistake(
                lambda w, x: stratified_error(w, x) * len(w) / (len(w) - 1),
                "The mean divides by N, not by N - 1: no variance is estimated here, all probabilities are known.",
            ),
            Mistake(
                lambda w, x: float(np.sqrt(_one_draw(w, x) / len(w))),
                "That is the formula for independent draws. Here each part of the strip has a mean of its own.",
            ),
            Mistake(
                lambda w, x: float(np.sqrt(np.sum(_variances(_shares_of_parts(w), x)))),
                "That is for the *sum* of the new x. Their mean divides it by N, and its standard deviation with it.",
            ),
            Mistake(
                lambda w, x: float(np.sqrt(np.sum(_variances(_shares_of_parts(w), x)) / len(w))),
                "A factor 1/N enters a variance squared: N variances, divided by N * N.",
            ),
            Mistake(
                lambda w, x: stratified_error(w, x) ** 2,
                "That is the variance. The task asks for the standard deviation: its root.",
            ),
            Mistake(
                lambda w, x: float(np.sum(np.sqrt(_variances(_shares_of_parts(w), x))) / len(w)),
                "You add standard deviations. Of independent draws the *variances* add; the root comes last.",
            ),
            Mistake(
                lambda w, x: float(np.sqrt(np.sum(_variances(_overlaps(w), x))) / len(w)),
                "In each part your probabilities sum to 1/N. The point is in that part for certain: they sum to 1.",
            ),
            Mistake(
                lambda w, x: float(
                    np.sqrt(np.sum(_overlaps(w) * (x - (_shares_of_parts(w) @ x)[:, None]) ** 2)) / len(w)
                ),
                "Your means are right. In the variances too the probabilities of a part sum to 1, not to 1/N.",
            ),
            Mistake(
                _residual_error,
                "That is residual resampling: certain copies, then independent draws. Here each part has one draw.",
            ),
            Mistake(
                lambda w, x: float(np.sqrt(_one_draw(w, x))),
                "That is how far the x themselves are spread. Asked for is how far their *mean* strays.",
            ),
            Mistake(
                lambda w, x: float(np.sqrt(_one_draw(w, x)) / len(w)),
                "The spread of x, divided by N? Find the variance of each part's draw, add, then divide the root by N.",
            ),
            Mistake(
                lambda w, x: 0.0,
                "It is not zero: in a part that two fields share, chance decides which of them is picked.",
            ),
            Mistake(
                lambda w, x: float(np.std(x) / np.sqrt(len(x))),
                "That is the error of a plain mean of the old x. Where are the weights, and the parts of the strip?",
            ),
        ),
    ),
]
