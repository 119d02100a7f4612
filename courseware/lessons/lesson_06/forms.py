"""A row of cameras along one axis of the state, and four forms of likelihood: their profiles and a pixel's cost."""

import functools
from collections import namedtuple

import numpy as np

from course_lib.depth_mcl.fallon import DEPTH_CUT, DEPTH_SIGMA, depth_log_likelihood, disparity_log_likelihood
from course_lib.depth_mcl.likelihood import ALPHA, likelihood, normalize_likelihood, paired_pixels
from course_lib.geometry import state_from_optical_pose
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.sensor import subsample_depth
from courseware.lessons.kit.corridor_data import corridor_map, wagon_run

FRAME = 100  # of the wagon's run: two people stand before the camera who are not in the map
N_PLACES = 41  # cameras along one axis
REACH = {"x": 1.0, "y": 0.4, "z": 0.4, "roll": 15.0, "pitch": 15.0, "yaw": 15.0}  # to each side, metres or degrees
UNIT = {axis: "m" if axis in "xyz" else "degrees" for axis in REACH}
GAUSSIAN_SIGMA = 0.1  # metres, as large as the paper's alpha, so that both forms have one scale
MISS_DEPTH = 11.0  # metres, what a simulated miss counts as: just beyond the 10 m that an SR4000 measures
Scene = namedtuple("Scene", "measured truth renderer")


@functools.cache
def small_scene(width: int = 44, height: int = 36) -> Scene:
    """Return the frame as an image `(H, W)` [m], the true state `(6,)`, and the fastest renderer for small images."""
    sequence = wagon_run()
    camera = sequence.camera()
    small = camera.resized(width, height)
    measured = subsample_depth(sequence.depth(FRAME), camera, small)
    truth = state_from_optical_pose(sequence.camera_to_world[FRAME])
    return Scene(measured, truth, DepthRenderer(corridor_map(), small, "ray", exact=True))


def offsets(axis: str) -> np.ndarray:
    """Return where the cameras of a row stand, `(N_PLACES,)` metres or degrees from the truth."""
    return np.linspace(-REACH[axis], REACH[axis], N_PLACES)


@functools.cache
def views_along(axis: str) -> np.ndarray:
    """Return simulated images `(N_PLACES, 36, 44)` of the cameras along one axis."""
    states = np.tile(small_scene().truth, (N_PLACES, 1))
    states[:, list(REACH).index(axis)] += offsets(axis) if UNIT[axis] == "m" else np.deg2rad(offsets(axis))
    return small_scene().renderer.render(states)


def gaussian_log_likelihood(measured: np.ndarray, simulated: np.ndarray) -> np.ndarray:
    """Return the log-likelihood `(N,)` of images `(N, H, W)` if each pixel has a Gaussian error and none is an outlier.

    One miss would make the sum of squares infinite, so a miss counts as a wall at `MISS_DEPTH`. Source: Thrun, Burgard,
    Fox, Probabilistic Robotics (2005), section 6.3.1, p_hit.
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
    """Return a likelihood of the cameras along an axis, `(N_PLACES,)`, spread over [0, 1] by eq. (9)."""
    return normalize_likelihood(form(small_scene().measured if measured is None else measured, views_along(axis)))


def peak(axis: str, normalized: np.ndarray) -> tuple[float, float]:
    """Return how far the highest place of a profile is from the truth, and how wide it is at half height."""
    places = offsets(axis)
    fine = np.linspace(places[0], places[-1], 40001)
    high = fine[np.interp(fine, places, normalized) >= 0.5]
    return float(abs(places[normalized.argmax()])), float(high[-1] - high[0])


def peak_table(profiles: dict[str, dict[str, np.ndarray]]) -> str:
    """Return the `peak` of each form along each axis as a text."""
    lines = [f"{'off / width':22}" + "".join(f"{f'{axis} [{UNIT[axis]}]':>16}" for axis in profiles)]
    for form in FORMS:
        lines.append(f"{form:22}")
        for axis, forms in profiles.items():
            off, width = peak(axis, forms[form])
            cell = f"{off:.2f} / {width:.2f}" if UNIT[axis] == "m" else f"{off:.1f} / {width:.0f}"
            lines[-1] += f"{cell:>16}"
    return "\n".join(lines)


def cost_of_a_pixel(difference: np.ndarray) -> dict[str, np.ndarray]:
    """Return what one pixel's difference [m] costs in the first three forms, where a difference of 1 m costs 1."""
    d = np.append(difference, 1.0)
    bell = np.where(d <= DEPTH_CUT, np.exp(-(d**2) / (2 * DEPTH_SIGMA**2)), 0.0)
    ratio = 0.01 * 2 / (DEPTH_SIGMA * np.sqrt(2 * np.pi)) / (0.99 / DEPTH_CUT)
    costs = (d / (ALPHA + d), d**2, np.log1p(ratio) - np.log1p(ratio * bell))
    return {name: cost[:-1] / cost[-1] for name, cost in zip(FORMS, costs, strict=False)}
