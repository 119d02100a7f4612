"""Exercises of lesson 06: the sum of equation (8), the weights of (9) to (11), and beta read backwards."""

from __future__ import annotations

import numpy as np

from course_lib.lessons.kit.exercises import Exercise, Mistake

# 06.1: the likelihood of one particle, with pixels that are empty


def likelihood_of(measured: np.ndarray, simulated: np.ndarray, alpha: float) -> float:
    """Eq. (8) for images (H, W) in metres: measured NaN is left out, a simulated inf contributes 0."""
    return float(np.sum(alpha / (alpha + _differences(measured, simulated))))


def _differences(measured: np.ndarray, simulated: np.ndarray) -> np.ndarray:
    valid = np.isfinite(measured)
    return np.abs(measured[valid] - simulated[valid])


def _images(rng: np.random.Generator) -> tuple:
    """Images, most of them with pixels that were not measured or where nothing is hit, or both, some on one pixel."""
    shape = (int(rng.integers(3, 6)), int(rng.integers(4, 7)))
    simulated = rng.uniform(1, 6, size=shape)
    measured = simulated + rng.normal(0, 0.3, size=shape)
    places = rng.permutation(measured.size)
    case = rng.integers(4)  # whole images, unmeasured pixels alone, misses alone, both
    if case in (1, 3):
        measured.flat[places[:3]] = np.nan
    if case in (2, 3):
        simulated.flat[places[2:5]] = np.inf
    return measured, simulated, rng.uniform(0.05, 0.5)


def _nan_pixels_kept(measured: np.ndarray, simulated: np.ndarray, alpha: float) -> float:
    return float(np.sum(alpha / (alpha + np.abs(measured - simulated))))


def _as_printed(measured: np.ndarray, simulated: np.ndarray, alpha: float) -> float:
    d = _differences(measured, simulated)
    with np.errstate(invalid="ignore"):
        return float(np.sum(1 - d / (alpha + d)))


def _as_printed_with_all_pixels(measured: np.ndarray, simulated: np.ndarray, alpha: float) -> float:
    d = np.abs(measured - simulated)
    with np.errstate(invalid="ignore"):
        return float(np.sum(1 - d / (alpha + d)))


def _empty_pixels_agree(measured: np.ndarray, simulated: np.ndarray, alpha: float) -> float:
    return likelihood_of(measured, simulated, alpha) + float(np.isnan(measured).sum())


def _measured_as_zero(measured: np.ndarray, simulated: np.ndarray, alpha: float) -> float:
    return likelihood_of(np.nan_to_num(measured, nan=0.0), simulated, alpha)


def _mean_of_hits(measured: np.ndarray, simulated: np.ndarray, alpha: float) -> float:
    compared = np.isfinite(measured) & np.isfinite(simulated)
    return likelihood_of(measured, simulated, alpha) / compared.sum()


def _no_absolute_value(measured: np.ndarray, simulated: np.ndarray, alpha: float) -> float:
    valid = np.isfinite(measured)
    return float(np.sum(alpha / (alpha + measured[valid] - simulated[valid])))


def _misses_agree(measured: np.ndarray, simulated: np.ndarray, alpha: float) -> float:
    missed = np.isfinite(measured) & np.isinf(simulated)
    return likelihood_of(measured, simulated, alpha) + float(missed.sum())


# 06.2: weights


def weights_of(values: np.ndarray, beta: float) -> np.ndarray:
    """Eqs (9) to (11): weights (N,) of likelihoods (N,), summing to one; equal weights where all likelihoods agree."""
    w = _unnormalized(values, beta)
    return w / w.sum()


def _spread(values: np.ndarray) -> np.ndarray:
    spread = values.max() - values.min()
    return np.ones(len(values)) if spread == 0 else (values - values.min()) / spread


def _unnormalized(values: np.ndarray, beta: float) -> np.ndarray:
    return np.exp(-((_spread(values) - 1) ** 2) / beta**2)


def _likelihoods(rng: np.random.Generator) -> tuple:
    n = int(rng.integers(5, 12))
    same = rng.random() < 0.25
    likelihoods = np.full(n, rng.uniform(100, 900)) if same else rng.uniform(100, 900, size=n)
    return likelihoods, rng.uniform(0.1, 0.6)


def _sums_to_one(w: np.ndarray) -> np.ndarray:
    return w / w.sum()


def _without_guard(values: np.ndarray, beta: float) -> np.ndarray:
    with np.errstate(invalid="ignore", divide="ignore"):
        normalized = (values - values.min()) / (values.max() - values.min())
    return _sums_to_one(np.exp(-((normalized - 1) ** 2) / beta**2))


def _zeros_where_equal(values: np.ndarray, beta: float) -> np.ndarray:
    return np.zeros(len(values)) if np.ptp(values) == 0 else weights_of(values, beta)


def _ones_where_equal(values: np.ndarray, beta: float) -> np.ndarray:
    return np.ones(len(values)) if np.ptp(values) == 0 else weights_of(values, beta)


def _without_least(values: np.ndarray, beta: float) -> np.ndarray:
    spread = np.ptp(values)
    return _sums_to_one(np.exp(-((values / spread - 1) ** 2) / beta**2) if spread else np.ones(len(values)))


# 06.3: beta read backwards


def least_likelihood(values: np.ndarray, beta: float) -> float:
    """Likelihood at which a particle's w of eq. (10) is one half, that of the best being 1."""
    return float(values.max() - beta * np.sqrt(np.log(2)) * (values.max() - values.min()))


def _unequal_likelihoods(rng: np.random.Generator) -> tuple:
    return rng.uniform(100, 900, size=int(rng.integers(5, 12))), rng.uniform(0.05, 0.6)


EXERCISES = [
    Exercise(
        number="06.1",
        reference=likelihood_of,
        inputs=_images,
        mistakes=(
            Mistake(
                _nan_pixels_kept,
                "Your sum is NaN where a pixel was not measured: one such pixel spoils it. Leave them out.",
            ),
            Mistake(
                _as_printed_with_all_pixels,
                "Your sum is NaN in two cases: a pixel that was not measured, and inf / inf where nothing is hit.",
            ),
            Mistake(
                _as_printed,
                "Your sum is NaN at a miss: |dz| is inf, and inf / inf is NaN. Rewrite the term as one fraction.",
            ),
            Mistake(
                lambda measured, simulated, alpha: float(
                    np.sum(1 - alpha / (alpha + _differences(measured, simulated)))
                ),
                "You sum what the pixels lose. The term of a pixel is 1 minus that.",
            ),
            Mistake(_no_absolute_value, "Your differences have a sign. Equation (8) takes their absolute value."),
            Mistake(
                lambda measured, simulated, alpha: (
                    likelihood_of(measured, simulated, alpha) / np.isfinite(measured).sum()
                ),
                "You divide by the number of pixels. That is the raw score l / m; equation (8) is the sum.",
            ),
            Mistake(
                _mean_of_hits,
                "You average over the pixels that hit something: a particle that looks into holes would pay nothing.",
            ),
            Mistake(
                _empty_pixels_agree,
                "A pixel that was not measured counts 1 in yours, as if it agreed. Leave it out of the sum.",
            ),
            Mistake(
                _misses_agree,
                "A pixel where the particle sees nothing counts 1 in yours. Its difference is infinite: it counts 0.",
            ),
            Mistake(
                _measured_as_zero,
                "You take a pixel without a measurement for a depth of 0 m. It says nothing: leave it out.",
            ),
            Mistake(
                lambda measured, simulated, alpha: float(
                    np.sum(alpha**2 / (alpha**2 + _differences(measured, simulated) ** 2))
                ),
                "Your differences are squared. Equation (8) has none of that: a large difference costs at most 1.",
            ),
            Mistake(
                lambda measured, simulated, alpha: likelihood_of(measured, simulated, 0.1),
                "Your alpha is always 0.1 m: use the argument.",
            ),
            Mistake(
                lambda measured, simulated, alpha: float(np.sum(1 / (alpha + _differences(measured, simulated)))),
                "Where both images agree a pixel must count 1. What stands above the fraction line?",
            ),
            Mistake(
                lambda measured, simulated, alpha: likelihood_of(measured, simulated, alpha) / measured.size,
                "You divide by the number of pixels, even of those not measured. Equation (8) is the sum.",
            ),
            Mistake(
                lambda measured, simulated, alpha: float(np.sum(1 + _differences(measured, simulated))),
                "Brackets are missing: alpha / alpha + d is 1 + d. Write alpha / (alpha + d).",
            ),
            Mistake(
                lambda measured, simulated, alpha: float(np.sum(1 - _differences(measured, simulated) / alpha)),
                "Below the fraction line stands alpha + |dz|, not alpha alone: so no pixel can count less than 0.",
            ),
            Mistake(
                lambda measured, simulated, alpha: float(alpha / (alpha + np.sum(_differences(measured, simulated)))),
                "You sum the differences first. Each pixel has a term of its own; equation (8) sums the terms.",
            ),
            Mistake(
                lambda measured, simulated, alpha: float(np.sum(np.exp(-_differences(measured, simulated) / alpha))),
                "An exponential forgets pixels that are far off sooner than equation (8). Write its fraction.",
            ),
            Mistake(
                lambda measured, simulated, alpha: likelihood_of(measured, np.nan_to_num(simulated, posinf=0), alpha),
                "Where the particle sees nothing you take a depth of 0 m. The depth is inf, and the pixel counts 0.",
            ),
        ),
    ),
    Exercise(
        number="06.2",
        reference=weights_of,
        inputs=_likelihoods,
        mistakes=(
            Mistake(
                _without_guard,
                "Where all likelihoods agree, (9) is 0/0, and yours is NaN. Give all particles the same weight there.",
            ),
            Mistake(_unnormalized, "Your weights do not sum to 1: equation (11) is missing."),
            Mistake(
                _zeros_where_equal,
                "Where all likelihoods agree your weights are all 0, and their sum is not 1. Give them equal weights.",
            ),
            Mistake(
                _ones_where_equal,
                "Where all likelihoods agree your weights are all 1. They have to pass through (11) as well.",
            ),
            Mistake(
                lambda values, beta: _sums_to_one(np.exp(-(_spread(values) ** 2) / beta**2)),
                "In yours the worst particle weighs most: equation (10) measures the distance from 1, not from 0.",
            ),
            Mistake(
                lambda values, beta: _sums_to_one(np.exp((_spread(values) - 1) ** 2 / beta**2)),
                "The minus sign in the exponent is missing: your weights grow with the distance from the best.",
            ),
            Mistake(
                lambda values, beta: _sums_to_one(np.exp(-((_spread(values) - 1) ** 2) / beta)),
                "beta is squared in equation (10).",
            ),
            Mistake(
                lambda values, beta: _sums_to_one(np.exp(-((_spread(values) - 1) ** 2) / (2 * beta**2))),
                "That is the usual Gaussian, with a 2 below. Equation (10) has none.",
            ),
            Mistake(
                lambda values, beta: _sums_to_one(np.exp(-np.abs(_spread(values) - 1) / beta)),
                "The square above the fraction line is missing.",
            ),
            Mistake(
                lambda values, beta: _sums_to_one(np.exp(-((values / values.max() - 1) ** 2) / beta**2)),
                "You divide by the largest likelihood. Equation (9) takes l_min away first, so that the worst gets 0.",
            ),
            Mistake(
                lambda values, beta: _sums_to_one(_spread(values)),
                "These are normalized likelihoods, summing to 1. Equation (10), with beta, comes between (9) and (11).",
            ),
            Mistake(
                lambda values, beta: weights_of(values, 0.01),
                "Your beta is always 0.01: use the argument.",
            ),
            Mistake(
                lambda values, beta: _sums_to_one(values),
                "You only divide by the sum, eq. (11). Before that come eq. (9), which spreads them, and eq. (10).",
            ),
            Mistake(
                lambda values, beta: _unnormalized(values, beta) / len(values),
                "You divide by N. Equation (11) divides by the sum of the weights.",
            ),
            Mistake(
                lambda values, beta: _sums_to_one(np.exp(-(((_spread(values) - 1) / beta**2) ** 2))),
                "The square is taken of beta squared as well: in equation (10) beta is squared once.",
            ),
            Mistake(
                _without_least,
                "l_min is missing above the fraction line of (9): the worst particle has to get 0.",
            ),
        ),
    ),
    Exercise(
        number="06.3",
        reference=least_likelihood,
        inputs=_unequal_likelihoods,
        mistakes=(
            Mistake(
                lambda values, beta: float(1 - beta * np.sqrt(np.log(2))),
                "That is the normalized likelihood. Turn (9) around, too, to get back to l.",
            ),
            Mistake(
                lambda values, beta: float(values.max() - beta * np.log(2) * np.ptp(values)),
                "A root is missing: (10) says that the *square* of the distance is beta squared times ln 2.",
            ),
            Mistake(
                lambda values, beta: float(values.max() - beta**2 * np.log(2) * np.ptp(values)),
                "That is the square of the distance from 1. Take the root of all of it, beta squared included.",
            ),
            Mistake(
                lambda values, beta: float(values.max() - beta * np.sqrt(np.log10(2)) * np.ptp(values)),
                "exp is undone by the natural logarithm, np.log; yours is the one to base 10.",
            ),
            Mistake(
                lambda values, beta: float(values.max() - beta * np.sqrt(np.log(2)) * values.max()),
                "You multiply by l_max. Equation (9) divides by l_max - l_min: undo that.",
            ),
            Mistake(
                lambda values, beta: float(values.max() - beta * np.ptp(values)),
                "At one beta below the best w is exp(-1), about 0.37. The task asks for one half.",
            ),
            Mistake(
                lambda values, beta: float(values.max() + beta * np.sqrt(np.log(2)) * np.ptp(values)),
                "Yours lies above the best likelihood. Of the two roots take the one below 1.",
            ),
            Mistake(
                lambda values, beta: float(values.min() + beta * np.sqrt(np.log(2)) * np.ptp(values)),
                "You count from the worst particle. The distance in (10) is that from the best.",
            ),
            Mistake(
                lambda values, beta: float((1 - beta * np.sqrt(np.log(2))) * np.ptp(values)),
                "Almost: l_min is missing. Equation (9) takes it away, so add it again.",
            ),
            Mistake(
                lambda values, beta: float(values.max() - beta * np.sqrt(2 * np.log(2)) * np.ptp(values)),
                "That is the half width of the usual Gaussian, with a 2 below. Equation (10) has none.",
            ),
            Mistake(
                lambda values, beta: values[np.argmin(np.abs(_unnormalized(values, beta) - 0.5))],
                "You look for a particle near one half. The task asks for the exact l, where no particle need be.",
            ),
            Mistake(
                lambda values, beta: values[_unnormalized(values, beta) >= 0.5].min(),
                "That is the worst particle that still has one half. The task asks for the l at which w *is* one half.",
            ),
            Mistake(
                lambda values, beta: (values.min() + values.max()) / 2,
                "There the *normalized likelihood* is one half. Its weight is less: solve (10) for w = 1/2.",
            ),
            Mistake(
                lambda values, beta: float(values.max() - np.sqrt(beta * np.log(2)) * np.ptp(values)),
                "Under your root beta stands alone; in (10) it is squared, so it comes out as beta.",
            ),
            Mistake(
                lambda values, beta: float(values.max() - beta * np.sqrt(np.log(2))),
                "You take a normalized distance away from a likelihood: multiply it by l_max - l_min first.",
            ),
            Mistake(
                lambda values, beta: float(values.max() - 0.8326 * beta * np.ptp(values)),
                "Close: 0.8326 is a rounded root of ln 2. Let NumPy work it out.",
            ),
            Mistake(
                lambda values, beta: float(values.max() - 0.83 * beta * np.ptp(values)),
                "Close: 0.83 is a rounded root of ln 2. Let NumPy work it out.",
            ),
        ),
    ),
]
