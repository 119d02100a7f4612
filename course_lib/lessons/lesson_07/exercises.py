"""Exercises of lesson 07: the mean angle, residual resampling mended, and how many particles survive."""

from __future__ import annotations

import numpy as np

from course_lib.lessons.kit.exercises import Exercise, Mistake

# 07.1: the mean of angles


def mean_angle(angles: np.ndarray, w: np.ndarray) -> float:
    """Mean direction of angles (N,) [rad] with weights (N,), in [-pi, pi]."""
    return float(np.arctan2(np.sum(w * np.sin(angles)), np.sum(w * np.cos(angles))))


def _angles(rng: np.random.Generator) -> tuple:
    """Headings about one direction, often one near the wrap or near zero, and weights that sum to one."""
    n = int(rng.integers(4, 9))
    centre = rng.choice([rng.uniform(-np.pi, np.pi), np.pi, 0.0]) + rng.uniform(-0.1, 0.1)
    angles = (centre + rng.normal(0, 0.4, size=n) + np.pi) % (2 * np.pi) - np.pi
    w = rng.uniform(0.1, 1, size=n)
    return angles, w / w.sum()


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


def _copies(w: np.ndarray) -> np.ndarray:
    return np.floor(len(w) * w)


def _shares(values: np.ndarray) -> np.ndarray:
    return values / values.sum()


# 07.3: how many different particles survive


def expected_survivors(w: np.ndarray) -> float:
    """Expected number of different particles after N independent draws with probabilities w (N,)."""
    return float(np.sum(1 - (1 - w) ** len(w)))


EXERCISES = [
    Exercise(
        number="07.1",
        reference=mean_angle,
        inputs=_angles,
        mistakes=(
            Mistake(
                lambda angles, w: float(np.sum(w * angles)),
                "That is eq. (12) as printed: it fails at the wrap. Average directions, as points on the circle.",
            ),
            Mistake(
                _cut_at_zero,
                "You count angles from 0 to 2 pi and average those. That only moves the wrap: it now fails near 0.",
            ),
            Mistake(
                lambda angles, w: float(np.arctan(np.sum(w * np.sin(angles)) / np.sum(w * np.cos(angles)))),
                "arctan of a quotient cannot tell a direction from its opposite. np.arctan2 takes two arguments.",
            ),
            Mistake(
                lambda angles, w: float(np.arctan2(np.sum(w * np.cos(angles)), np.sum(w * np.sin(angles)))),
                "np.arctan2 takes the sine first, then the cosine: yours is turned by a quarter and mirrored.",
            ),
            Mistake(
                lambda angles, w: float(np.arctan2(np.sum(np.sin(angles)), np.sum(np.cos(angles)))),
                "You have not used the weights: every particle counts the same in yours.",
            ),
            Mistake(
                lambda angles, w: float(np.rad2deg(mean_angle(angles, w))),
                "Yours is in degrees. Angles in, angles out: radians.",
            ),
            Mistake(
                lambda angles, w: float(mean_angle(angles, w) % (2 * np.pi)),
                "Right direction, but from 0 to 2 pi. The task asks for -pi to pi, as np.arctan2 gives it.",
            ),
            Mistake(
                lambda angles, w: float(angles[np.argmax(w)]),
                "That is the heading of the heaviest particle. Eq. (12) lets all of them take part.",
            ),
            Mistake(
                lambda angles, w: float(np.mean(angles)),
                "A plain mean of the numbers: it has no weights, and it fails at the wrap. Add points on the circle.",
            ),
            Mistake(
                lambda angles, w: float(np.arctan2(np.sum(np.sin(w * angles)), np.sum(np.cos(w * angles)))),
                "You weigh the angles themselves. The weight stands before sine and cosine: w * np.sin(angles).",
            ),
            Mistake(
                lambda angles, w: float(np.arctan2(np.sum(w * np.sin(angles)), np.sum(np.cos(angles)))),
                "You weigh the sines, but not the cosines.",
            ),
            Mistake(
                lambda angles, w: mean_angle(np.deg2rad(angles), w),
                "The angles are in radians already; you convert them once more.",
            ),
            Mistake(
                _about_the_first,
                "Close: you move the wrap away, then average numbers. Add points on the circle: sines and cosines.",
            ),
            Mistake(
                lambda angles, w: float(np.arcsin(np.sum(w * np.sin(angles)))),
                "arcsin knows half of the circle only, and the sum is no longer of length 1: use sine *and* cosine.",
            ),
        ),
    ),
    Exercise(
        number="07.2",
        reference=residual_parts,
        inputs=_uneven_weights,
        mistakes=(
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
        reference=expected_survivors,
        inputs=_uneven_weights,
        mistakes=(
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
]
