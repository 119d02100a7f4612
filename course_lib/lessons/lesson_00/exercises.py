"""Exercises of lesson 00: how exercises work, on the two halves of equation (8)'s term."""

from __future__ import annotations

import numpy as np

from course_lib.lessons.kit.exercises import Exercise, Mistake

# 00.1: by how much do two depth images differ?


def depth_difference(measured: np.ndarray, simulated: np.ndarray) -> np.ndarray:
    """Absolute difference (H, W) in metres of two depth images."""
    return np.abs(measured - simulated)


def _two_images(rng: np.random.Generator) -> tuple:
    measured = rng.uniform(1.0, 9.0, size=(rng.integers(2, 5), rng.integers(2, 5)))
    simulated = measured + rng.normal(0, 0.5, size=measured.shape)
    if rng.random() < 0.5:
        # A wall seen through an open door: nothing in the task caps a difference.
        simulated.flat[rng.integers(simulated.size)] += rng.uniform(12.0, 20.0)
    return measured, simulated


# 00.2: what one pixel adds to the likelihood


def pixel_term(difference: np.ndarray, alpha: float) -> np.ndarray:
    """One pixel's term of eq. (8), 0 to 1, for differences in metres; 0 where the difference is inf."""
    return alpha / (alpha + difference)


def _differences(rng: np.random.Generator) -> tuple:
    difference = rng.exponential(0.3, size=(rng.integers(2, 5), rng.integers(2, 5)))
    hole, agreed = rng.choice(difference.size, size=2, replace=False)
    difference.flat[hole], difference.flat[agreed] = np.inf, 0.0
    return difference, rng.uniform(0.05, 0.5)


def _as_printed(difference: np.ndarray, alpha: float) -> np.ndarray:
    with np.errstate(invalid="ignore"):
        return 1 - difference / (alpha + difference)


def _only_the_fraction(difference: np.ndarray, alpha: float) -> np.ndarray:
    finite = np.where(np.isfinite(difference), difference, 0.0)
    return np.where(np.isfinite(difference), finite / (alpha + finite), 1.0)


def _only_the_fraction_as_printed(difference: np.ndarray, alpha: float) -> np.ndarray:
    with np.errstate(invalid="ignore"):
        return difference / (alpha + difference)


def _one_where_nothing_is_hit(difference: np.ndarray, alpha: float) -> np.ndarray:
    return np.where(np.isfinite(difference), alpha / (alpha + difference), 1.0)


def _without_brackets(difference: np.ndarray, alpha: float) -> np.ndarray:
    with np.errstate(invalid="ignore"):
        return 1 - difference / alpha + difference


EXERCISES = [
    Exercise(
        number="00.1",
        reference=depth_difference,
        inputs=_two_images,
        mistakes=(
            Mistake(
                lambda measured, simulated: measured - simulated,
                "Some of yours are negative. Too near is as wrong as too far: which function drops the sign?",
            ),
            Mistake(
                lambda measured, simulated: simulated - measured,
                "The order does not matter, but the sign must go: no difference is less than zero.",
            ),
            Mistake(
                lambda measured, simulated: (measured - simulated) ** 2,
                "Yours is squared: its unit would be square metres. Equation (8) takes the absolute value.",
            ),
            Mistake(
                lambda measured, simulated: np.abs(measured - simulated).sum(),
                "That is one number for the whole image; here every pixel keeps its own.",
            ),
            Mistake(
                lambda measured, simulated: np.abs(measured - simulated) / measured,
                "Yours is a share of the depth, without a unit. Equation (8) counts metres.",
            ),
        ),
    ),
    Exercise(
        number="00.2",
        reference=pixel_term,
        inputs=_differences,
        mistakes=(
            Mistake(
                _as_printed,
                "Right, except where d is inf: inf / inf is NaN. Bring both terms over one fraction line first.",
            ),
            Mistake(
                _only_the_fraction_as_printed,
                "At difference 0 yours is 0: that counts disagreement. What about the 1 - in front?",
            ),
            Mistake(
                _only_the_fraction,
                "Yours grows as the images drift apart: it counts disagreement. Take it from 1.",
            ),
            Mistake(
                lambda difference, alpha: np.sum(alpha / (alpha + difference)),
                "That is already the whole sum of equation (8). Here every pixel keeps its own term.",
            ),
            Mistake(
                _without_brackets,
                "Mind the brackets: alpha + d stands below the fraction line as a whole.",
            ),
            Mistake(
                lambda difference, alpha: alpha / alpha + difference,
                "Yours is more than 1. Division comes before addition: put brackets around what stands below the line.",
            ),
            Mistake(
                lambda difference, alpha: 0.1 / (0.1 + difference),
                "Right for the example alone: your alpha is always 0.1. Take the one that is given.",
            ),
            Mistake(
                lambda difference, alpha: alpha / (alpha + difference) / difference.size,
                "You divide by the number of pixels. Here each pixel keeps its whole term: 1 at difference 0.",
            ),
            Mistake(
                lambda difference, alpha: np.exp(-difference / alpha),
                "An exponential falls much faster. Equation (8) has a fraction: at d = alpha it must give 1/2.",
            ),
            Mistake(
                lambda difference, alpha: alpha / (alpha + difference**2),
                "You squared the difference: then alpha and d have different units and cannot be added.",
            ),
            Mistake(
                _one_where_nothing_is_hit,
                "Where the difference is inf yours counts full agreement. A hole in the map must earn nothing: 0.",
            ),
        ),
    ),
]
