"""Exercises of lesson 06: (8) read backwards, faults in given code, beta read backwards, an error bar of weights."""

import numpy as np
from scipy.stats import norm

from course_lib.lessons.kit.exercises import Exercise, Mistake

# 06.1: equation (8) read backwards


def difference_at(term: np.ndarray, alpha: float) -> np.ndarray:
    """Differences (n,) [m] at which a pixel's term of eq. (8) has these values, more than 0 and at most 1."""
    return alpha * (1 - term) / term


def _terms(rng: np.random.Generator) -> tuple:
    return rng.uniform(0.02, 0.98, int(rng.integers(3, 7))), rng.uniform(0.01, 1.0)


def _the_papers_alpha(rng: np.random.Generator) -> tuple:
    return np.array([1.0, 0.9, 0.5, 0.01]), 0.1


def _turned_over(term: np.ndarray, alpha: float) -> np.ndarray:
    with np.errstate(divide="ignore"):
        return alpha * term / (1 - term)


# 06.2: three faults in somebody's code


def weigh(measured: np.ndarray, images: np.ndarray, alpha: float, beta: float) -> np.ndarray:
    """Eqs (8) to (11): weights (N,) of images (N, H, W) beside a measured one (H, W); equal where all agree."""
    return _weigh(measured, images, alpha, beta)


def _weigh(measured, images, alpha, beta, misses="count 0", equal="guarded", square="of beta"):
    """Weights with each of the given code's faults left in or mended."""
    with np.errstate(invalid="ignore", divide="ignore"):
        terms = alpha / (alpha + np.abs(measured - images))
        hit = np.isfinite(measured) & np.isfinite(images)
        counted = hit if misses == "left out" else np.broadcast_to(np.isfinite(measured), hit.shape)
        number = counted.sum(axis=(1, 2)) if misses == "left out" else 1
        values = np.where(counted, terms, 0).sum(axis=(1, 2)) / number
        spread = np.ptp(values)
        if equal == "guarded" and not spread > 0:
            return np.full(len(images), 1 / len(images))
        normalized = (values - values.min()) / (spread + 1e-12)
        return _to_one(_exponential(normalized, beta, square))


def _exponential(normalized: np.ndarray, beta: float, square: str) -> np.ndarray:
    miss = normalized - 1
    return np.exp(-(miss**2) / beta**2) if square == "of beta" else np.exp(-((miss / beta**2) ** 2))


def _to_one(w: np.ndarray) -> np.ndarray:
    return w / w.sum()


def _with_faults(**faults):
    return lambda measured, images, alpha, beta: _weigh(measured, images, alpha, beta, **faults)


def _images(rng: np.random.Generator) -> tuple:
    """Images with pixels that were not measured, and particles that look into holes, more or less deep."""
    n, shape = int(rng.integers(4, 8)), (4, 5)
    measured = rng.uniform(1, 6, shape)
    images = measured + rng.normal(0, 1, (n, 1, 1)) * 0.2 + rng.normal(0, 0.05, (n, *shape))
    measured.flat[rng.permutation(20)[:4]] = np.nan
    for image in images:
        image.flat[rng.permutation(20)[: rng.integers(1, 12)]] = np.inf
    return measured, images, rng.uniform(0.05, 0.3), rng.uniform(0.2, 0.6)


def _all_alike(rng: np.random.Generator) -> tuple:
    return np.full((2, 3), 2.0), np.full((4, 2, 3), 2.1), 0.1, 0.01


def _nothing_measured(rng: np.random.Generator) -> tuple:
    return np.full((2, 3), np.nan), rng.uniform(1, 6, (5, 2, 3)), 0.1, 0.3


def _a_lucky_pixel(rng: np.random.Generator) -> tuple:
    """The lesson's case: 2 cm off everywhere, beside one right pixel in a hole; and somebody far off."""
    images = np.stack([np.full((1, 6), 2.02), [[2.0] + [np.inf] * 5], np.full((1, 6), 2.3)])
    return np.full((1, 6), 2.0), images, 0.1, 0.3


def _as_printed(measured, images, alpha, beta):
    """Inf / inf at a miss and NaN where nothing was measured spoil whole sums."""
    with np.errstate(invalid="ignore", divide="ignore"):
        d = np.abs(measured - images)
        values = np.sum(1 - d / (alpha + d), axis=(1, 2))
        return _to_one(_exponential((values - values.min()) / np.ptp(values), beta, "of beta"))


def _over_the_largest(measured, images, alpha, beta):
    with np.errstate(invalid="ignore", divide="ignore"):
        values = np.nansum(alpha / (alpha + np.abs(measured - images)), axis=(1, 2))
        if np.ptp(values) == 0:
            return np.full(len(values), 1 / len(values))
        return _to_one(_exponential(values / values.max(), beta, "of beta"))


def _misses_at(depth: float):
    return lambda measured, images, alpha, beta: weigh(measured, np.where(np.isinf(images), depth, images), alpha, beta)


def _misses_agree(measured, images, alpha, beta):
    return weigh(measured, np.where(np.isinf(images) & np.isfinite(measured), measured, images), alpha, beta)


def _unmeasured_at_zero(measured, images, alpha, beta):
    return weigh(np.nan_to_num(measured), images, alpha, beta)


def _not_to_one(measured, images, alpha, beta):
    w = weigh(measured, images, alpha, beta)
    return w / w.max()


def _equal_as(value: float):
    """A mistake: where all likelihoods agree every particle gets `value`."""

    def mistaken(measured, images, alpha, beta):
        w = weigh(measured, images, alpha, beta)
        return np.full(len(w), value) if np.ptp(w) < 1e-12 else w

    return mistaken


def _with_exponent(exponent):
    """A mistake: everything right but the exponent of (10), made of the normalized likelihood minus 1 and beta."""

    def mistaken(measured, images, alpha, beta):
        values = _likelihoods(measured, images, alpha)
        if not np.ptp(values) > 0:
            return weigh(measured, images, alpha, beta)
        with np.errstate(over="ignore", invalid="ignore"):
            return _to_one(np.exp(exponent((values - values.max()) / np.ptp(values), beta)))

    return mistaken


def _likelihoods(measured, images, alpha):
    valid = np.isfinite(measured)
    return np.sum(alpha / (alpha + np.abs(measured[valid] - images[:, valid])), axis=1)


def _by_normalized_likelihood(measured, images, alpha, beta):
    values = _likelihoods(measured, images, alpha)
    return _to_one(values - values.min()) if np.ptp(values) > 0 else weigh(measured, images, alpha, beta)


def _missed_by_any(measured, images, alpha, beta):
    seen_by_all = np.where(np.isfinite(images).all(axis=0), measured, np.nan)
    return weigh(seen_by_all, images, alpha, beta)


# 06.3: beta read backwards


def min_likelihood(values: np.ndarray, beta: float) -> float:
    """Likelihood at which a particle's w of eq. (10) is one half, that of the best being 1."""
    return float(values.max() - beta * np.sqrt(np.log(2)) * (values.max() - values.min()))


def _unequal_likelihoods(rng: np.random.Generator) -> tuple:
    return rng.uniform(100, 900, size=int(rng.integers(5, 12))), rng.uniform(0.05, 0.6)


def _the_papers_beta(rng: np.random.Generator) -> tuple:
    return rng.uniform(600, 900, 9), 0.01


def _a_large_beta(rng: np.random.Generator) -> tuple:
    """Even the worst particle has more than one half here: the answer lies below all of them."""
    return rng.uniform(100, 900, 6), 1.5


def _unnormalized(values: np.ndarray, beta: float) -> np.ndarray:
    return _exponential((values - values.min()) / np.ptp(values), beta, "of beta")


# 06.4: the error bar of a weighted mean


def importance_mean(x: np.ndarray, target: np.ndarray, proposal: np.ndarray) -> tuple[float, float]:
    """Mean of x (n,) over the target and its standard error, of samples of the proposal; densities (n,), any scale.

    The mean is sum(w x) / sum(w). Its error is sum(w (x - mean)) / sum(w), a sum of independent terms of mean 0, so
    that its variance is the sum of their squares.
    """
    w = _to_one(target / proposal)
    mean = w @ x
    return float(mean), float(np.sqrt(np.sum((w * (x - mean)) ** 2)))


def _with_bessel(x: np.ndarray, target: np.ndarray, proposal: np.ndarray) -> tuple[float, float]:
    mean, error = importance_mean(x, target, proposal)
    return mean, error * np.sqrt(len(x) / (len(x) - 1))


def _samples(rng: np.random.Generator) -> tuple:
    x = rng.normal(0, 1, int(rng.integers(20, 60)))
    target = norm.pdf(x, rng.uniform(-0.8, 0.8), rng.uniform(0.4, 0.9))
    return x + 10, rng.uniform(0.01, 100) * target, norm.pdf(x)


def _target_is_proposal(rng: np.random.Generator) -> tuple:
    x = rng.normal(0, 1, 30)
    return x, norm.pdf(x), norm.pdf(x)


def _one_outweighs_all(rng: np.random.Generator) -> tuple:
    x = np.linspace(-2, 2, 9)
    return x, 1e-30 * norm.pdf(x, 1.5, 0.2), norm.pdf(x)


def _mean_with(error):
    """A mistake: the right mean, and `error(w, deviations)` of weights that sum to one."""

    def mistaken(x, target, proposal):
        w = _to_one(target / proposal)
        return w @ x, error(w, x - w @ x)

    return mistaken


def _mean_by(weight):
    """A mistake: everything right but the weights, `weight(target, proposal)`."""

    def mistaken(x, target, proposal):
        return importance_mean(x, weight(target, proposal), np.ones(len(x)))

    return mistaken


def _mean_with_raw(error):
    """A mistake: the right mean, and `error(w, x)` of weights that sum to one."""

    def mistaken(x, target, proposal):
        w = _to_one(target / proposal)
        return w @ x, error(w, x)

    return mistaken


_MISSES, _EQUAL, _SQUARE = ("misses", "left out"), ("equal", "not guarded"), ("square", "of beta squared")
# Which faults of the given code are still in an answer, and what to say.
FAULTS_LEFT = (
    ((_MISSES,), "A particle that looks into a hole pays nothing in yours. One fault is left, in the first two lines."),
    ((_EQUAL,), "One fault is left: what does (9) give where all agree, and what is exp(-1 / beta^2) at beta = 0.01?"),
    ((_SQUARE,), "One fault is left: compare the exponent with (10) at a beta other than 1. What is squared?"),
    ((_MISSES, _EQUAL), "One fault is mended, two are left: think of a hole in the map, and of particles all alike."),
    ((_MISSES, _SQUARE), "One fault is mended, two are left: think of a hole in the map, and of the exponent."),
    ((_EQUAL, _SQUARE), "One fault is mended, two are left: think of particles all alike, and of the exponent."),
    ((_MISSES, _EQUAL, _SQUARE), "All three faults are still in. Try a hole, particles all alike, and a small beta."),
)

EXERCISES = [
    Exercise(
        number="06.1",
        solution=difference_at,
        inputs=_terms,
        cases=(_the_papers_alpha,),
        level="warm-up",
        mistakes=(
            Mistake(
                lambda term, alpha: alpha - alpha / term,
                "Your sign is turned round: a difference is not negative.",
            ),
            Mistake(
                lambda term, alpha: alpha / term - 1,
                "You take away 1, a share, from metres. Multiply (8) out once more: alpha + d stands there.",
            ),
            Mistake(
                lambda term, alpha: np.round(alpha / term - alpha, 1),
                "You round, as the example is printed. Give the numbers as they come out.",
            ),
            Mistake(
                _turned_over,
                "Yours grows with the term. A pixel that counts more differs *less*.",
            ),
            Mistake(
                lambda term, alpha: alpha * (1 - term),
                "Put yours back into (8): at one half it gives two thirds. A term t is alpha / (alpha + d), so divide.",
            ),
            Mistake(
                lambda term, alpha: alpha / term,
                "That is alpha + d. The difference is what is left without alpha.",
            ),
            Mistake(
                lambda term, alpha: (1 - term) / term, "That is the difference in units of alpha. Metres are asked."
            ),
            Mistake(lambda term, alpha: 0.1 * (1 - term) / term, "Your alpha is always 0.1 m: use the argument."),
            Mistake(
                lambda term, alpha: -alpha * np.log(term),
                "You undo an exponential. The term of (8) is a fraction.",
            ),
            Mistake(
                lambda term, alpha: alpha * np.sqrt((1 - term) / term),
                "You undo a square. Equation (8) has none.",
            ),
            Mistake(
                lambda term, alpha: alpha / (alpha + term),
                "You put the term in where the difference stands. It is the other way round: solve for the difference.",
            ),
            Mistake(
                lambda term, alpha: alpha * (1 / term + 1),
                "One sign: alpha / t is alpha *plus* the difference.",
            ),
        ),
    ),
    Exercise(
        number="06.2",
        solution=weigh,
        inputs=_images,
        cases=(_a_lucky_pixel, _all_alike, _nothing_measured),
        mistakes=(
            Mistake(
                _with_exponent(lambda miss, beta: -(miss**2) / (2 * beta**2)),
                "Your exponent has the 2 of the usual Gaussian below the line. Equation (10) has none.",
            ),
            Mistake(
                _with_exponent(lambda miss, beta: miss / beta),
                "Your exponent is not squared. Equation (10) squares the distance from 1, and beta.",
            ),
            Mistake(
                _with_exponent(lambda miss, beta: miss**2 / beta**2),
                "The minus sign of (10) is missing: your worst particle weighs most.",
            ),
            Mistake(
                _with_exponent(lambda miss, beta: -((miss + 1) ** 2) / beta**2),
                "Your worst particle weighs most: (10) takes the distance from 1, not from 0.",
            ),
            Mistake(
                _by_normalized_likelihood,
                "You leave (10) out: the normalized likelihood itself, divided by its sum, is not yet the weight.",
            ),
            Mistake(
                _missed_by_any,
                "You leave out, for all, a pixel that *any* particle misses. Leave out only what was not measured.",
            ),
            *(Mistake(_with_faults(**dict(faults)), hint) for faults, hint in FAULTS_LEFT),
            Mistake(
                _as_printed,
                "NaN: inf / inf at a miss, or a pixel that was not measured in the sum. And (9) may be 0/0.",
            ),
            Mistake(
                _over_the_largest,
                "You divide by the largest likelihood. Equation (9) takes the least away first: the worst gets 0.",
            ),
            Mistake(_misses_at(0.0), "You take a miss for a depth of 0 m. Its difference is infinite: it counts 0."),
            Mistake(
                _misses_at(11.0),
                "You take a miss for a wall at 11 m. That was the Gaussian's makeshift; in (8) a miss counts 0.",
            ),
            Mistake(_misses_agree, "In yours a particle that sees nothing agrees with everything: misses count 1."),
            Mistake(
                _unmeasured_at_zero,
                "You take a pixel without a measurement for a depth of 0 m. It says nothing: leave it out for all.",
            ),
            Mistake(_not_to_one, "The best has weight 1 in yours. Equation (11) makes the *sum* 1."),
            Mistake(
                _equal_as(0.0),
                "Where all likelihoods agree your weights are all 0, and their sum is not 1.",
            ),
            Mistake(
                lambda measured, images, alpha, beta: np.nan_to_num(
                    _weigh(measured, images, alpha, beta, equal="not guarded")
                ),
                "You hide a 0/0: of particles all alike none has a weight then. Give each the same.",
            ),
            Mistake(
                _equal_as(1.0),
                "Where all likelihoods agree your weights are all 1. Their sum shall be 1.",
            ),
            Mistake(
                lambda measured, images, alpha, beta: weigh(measured, images, 0.1, beta),
                "Your alpha is always 0.1 m: use the argument.",
            ),
            Mistake(
                lambda measured, images, alpha, beta: weigh(measured, images, alpha, np.sqrt(beta)),
                "beta is squared in equation (10).",
            ),
        ),
    ),
    Exercise(
        number="06.3",
        solution=min_likelihood,
        inputs=_unequal_likelihoods,
        cases=(_the_papers_beta, _a_large_beta),
        mistakes=(
            Mistake(
                lambda values, beta: round(min_likelihood(values, beta), 1),
                "You round, as the example is printed. Give the number as it comes out.",
            ),
            Mistake(
                lambda values, beta: max(min_likelihood(values, beta), values.min()),
                "You stop at the worst particle. For a large beta the l of one half lies below all of them.",
            ),
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
    Exercise(
        number="06.4",
        solution=importance_mean,
        inputs=_samples,
        cases=(_target_is_proposal, _one_outweighs_all),
        others=(_with_bessel,),
        level="challenge",
        mistakes=(
            Mistake(
                _mean_with_raw(lambda w, x: np.sqrt(np.sum((w * x) ** 2))),
                "Your mean is right. A spread is made of deviations from the mean, not of the samples themselves.",
            ),
            Mistake(
                _mean_with_raw(lambda w, x: np.sqrt(np.sum((w * (x - x.mean())) ** 2))),
                "Your mean is right. In the error take deviations from that mean, not from the plain one.",
            ),
            Mistake(
                _mean_with_raw(lambda w, x: x.std() * np.sqrt(np.sum(w**2))),
                "Your mean is right. In yours the samples' spread is unweighed, over root N_eff: derive it.",
            ),
            Mistake(
                _mean_with_raw(lambda w, x: np.std(w * x)),
                "Your mean is right. Yours is the scatter of w x: take deviations from the mean, then weigh them.",
            ),
            Mistake(
                lambda x, target, proposal: (x.mean(), np.sqrt(np.mean((x - x.mean()) ** 2) / len(x))),
                "These are the samples unweighed: they belong to the proposal. The target's mean is asked.",
            ),
            Mistake(
                _mean_by(lambda target, proposal: proposal / target),
                "Your weights are upside down. Where the proposal is dense there are too many samples: divide by it.",
            ),
            Mistake(
                _mean_by(lambda target, proposal: target),
                "You weigh by the target alone. The samples are dense already where the proposal is: divide by it.",
            ),
            Mistake(
                lambda x, target, proposal: (
                    np.mean(target / proposal * x),
                    np.sqrt(np.sum((target / proposal * (x - np.mean(target / proposal * x))) ** 2)) / len(x),
                ),
                "You divide by n. The target's scale is not known, so divide by the sum of the weights.",
            ),
            Mistake(
                _mean_with(lambda w, d: np.sqrt(np.sum(w * d**2))),
                "Your mean is right. That is the spread of the target; its mean is known better than that.",
            ),
            Mistake(
                _mean_with(lambda w, d: np.sqrt(np.sum(w * d**2) / len(w))),
                "Your mean is right. Spread over root n holds for equal weights: here some samples count for many.",
            ),
            Mistake(
                _mean_with(lambda w, d: np.sqrt(np.sum(w * d**2) * np.sum(w**2))),
                "Your mean is right. Spread over root N_eff is near, but heavy samples lie together: derive it.",
            ),
            Mistake(
                lambda x, target, proposal: (importance_mean(x, target, proposal)[0], x.std() / np.sqrt(len(x))),
                "Your mean is right. Your error is that of the unweighed samples, a mean over the proposal.",
            ),
            Mistake(
                lambda x, target, proposal: (
                    importance_mean(x, target, proposal)[0],
                    np.std(target / proposal * x) / np.sqrt(len(x)) / np.mean(target / proposal),
                ),
                "Your mean is right. But its denominator scatters too: take deviations from the mean, then weigh them.",
            ),
            Mistake(
                lambda x, target, proposal: (
                    importance_mean(x, target, proposal)[0],
                    np.sqrt(np.sum(target / proposal * (x - importance_mean(x, target, proposal)[0]) ** 2))
                    / np.sum(target / proposal),
                ),
                "Your mean is right. Your error changes with the target's unknown factor: a weight enters squared.",
            ),
            Mistake(
                _mean_with(lambda w, d: np.sum((w * d) ** 2)),
                "Your mean is right. The second value is the variance of the mean: take its root.",
            ),
            Mistake(
                _mean_with(lambda w, d: np.sqrt(np.sum((w * d) ** 2) / len(w))),
                "Your mean is right. In the error you divide by n though the weights sum to 1 already.",
            ),
            Mistake(
                _mean_with(lambda w, d: np.sum(w * np.abs(d))),
                "Your mean is right. Independent errors add by their squares, each with its own weight.",
            ),
            Mistake(
                _mean_with(lambda w, d: np.abs(np.sum(w * d))),
                "Your mean is right. Deviations from the mean cancel: square each term before you add.",
            ),
        ),
    ),
]
