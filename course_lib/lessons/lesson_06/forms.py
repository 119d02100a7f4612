"""Four forms of likelihood: their profiles along an axis of the state, and what one wrong pixel costs."""

import numpy as np

from course_lib.depth_mcl.fallon import DEPTH_CUT, DEPTH_SIGMA, depth_log_likelihood, disparity_log_likelihood
from course_lib.depth_mcl.likelihood import ALPHA, likelihood, normalize_likelihood, paired_pixels
from course_lib.lessons.lesson_06.places import UNIT, offsets, small_scene, views_along

GAUSSIAN_SIGMA = 0.1  # metres, as large as the paper's alpha, so that both forms have one scale
MISS_DEPTH = 11.0  # metres, what a simulated miss counts as: just beyond the 10 m that an SR4000 measures


def gaussian_log_likelihood(measured: np.ndarray, simulated: np.ndarray) -> np.ndarray:
    """Log-likelihood `(N,)` of images `(N, H, W)`, each pixel with a Gaussian error, and none ever an outlier.

    Its sum of squares would be infinite with one miss, so a miss counts as a wall at `MISS_DEPTH`. Source: Thrun,
    Burgard, Fox, Probabilistic Robotics (2005), section 6.3.1, p_hit.
    """
    valid, simulated = paired_pixels(measured, simulated)
    differences = (measured[valid].astype(float) - np.minimum(image[valid], MISS_DEPTH) for image in simulated)
    return np.array([-np.sum(d**2) / (2 * GAUSSIAN_SIGMA**2) for d in differences])


FORMS = {
    "paper, eq. (8)": likelihood,
    "Gaussian": gaussian_log_likelihood,
    "half-normal + uniform": depth_log_likelihood,
    "disparity": disparity_log_likelihood,
}


def profile(form, axis: str, measured: np.ndarray | None = None) -> np.ndarray:
    """A likelihood of the cameras along an axis, `(N_PLACES,)`, spread over [0, 1] by eq. (9)."""
    measured = small_scene().measured if measured is None else measured
    return normalize_likelihood(form(measured, views_along(axis)))


def peak(axis: str, normalized: np.ndarray) -> tuple[float, float]:
    """How far the highest place of a profile is from the truth, and how wide it is at half height (outer crossings)."""
    places = offsets(axis)
    fine = np.linspace(places[0], places[-1], 40001)
    high = fine[np.interp(fine, places, normalized) >= 0.5]
    return float(abs(places[normalized.argmax()])), float(high[-1] - high[0])


def peak_table(profiles: dict[str, dict[str, np.ndarray]]) -> str:
    """The `peak` of each form along each axis, as a text."""
    lines = [f"{'off / width':22}" + "".join(f"{f'{axis} [{UNIT[axis]}]':>16}" for axis in profiles)]
    for form in FORMS:
        found = [(UNIT[axis], *peak(axis, forms[form])) for axis, forms in profiles.items()]
        cells = [
            f"{off:.2f} / {width:.2f}" if unit == "m" else f"{off:.1f} / {width:.0f}" for unit, off, width in found
        ]
        lines.append(f"{form:22}" + "".join(f"{cell:>16}" for cell in cells))
    return "\n".join(lines)


def cost_of_a_pixel(difference: np.ndarray) -> dict[str, np.ndarray]:
    """What one pixel's difference [m] takes away from the sums of the first three forms, in units of that of 1 m."""
    d = np.append(difference, 1.0)
    bell = np.where(d <= DEPTH_CUT, np.exp(-(d**2) / (2 * DEPTH_SIGMA**2)), 0.0)
    ratio = 0.01 * 2 / (DEPTH_SIGMA * np.sqrt(2 * np.pi)) / (0.99 / DEPTH_CUT)
    costs = (d / (ALPHA + d), d**2, np.log1p(ratio) - np.log1p(ratio * bell))
    return {name: cost[:-1] / cost[-1] for name, cost in zip(FORMS, costs, strict=False)}
