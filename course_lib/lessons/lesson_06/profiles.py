"""Four likelihoods of cameras that stand in a row along one axis of the state, about a frame of the wagon run."""

import functools
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from course_lib.depth_mcl.fallon import DEPTH_CUT, DEPTH_SIGMA, depth_log_likelihood, disparity_log_likelihood
from course_lib.depth_mcl.likelihood import ALPHA, likelihood, normalize_likelihood
from course_lib.geometry import state_from_optical_pose
from course_lib.lessons.kit.corridor_views import corridor_map, wagon_run
from course_lib.lessons.lesson_06.gaussian import gaussian_log_likelihood
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.sensor import subsample_depth

FRAME = 100  # of the wagon's run: two people stand before the camera who are not in the map
SMALL = (44, 36)  # pixels of the small images: a sixteenth, so that a profile takes milliseconds
N_PLACES = 41  # cameras along one axis
PERSON_DEPTH = 1.2  # metres, of the person whom the panel puts before the lens
Form = Callable[[np.ndarray, np.ndarray], np.ndarray]
FORMS: dict[str, Form] = {
    "paper, eq. (8)": likelihood,
    "Gaussian": gaussian_log_likelihood,
    "half-normal + uniform": depth_log_likelihood,
    "disparity": disparity_log_likelihood,
}


class Axis(NamedTuple):
    """One of the six components of a state, and how far a profile reaches to each side."""

    name: str
    index: int
    reach: float
    """Metres, or degrees for an angle."""

    @property
    def unit(self) -> str:
        return "m" if self.index < 3 else "degrees"

    def offsets(self) -> np.ndarray:
        """Where the cameras of a profile stand, `(N_PLACES,)` metres or degrees from the truth."""
        return np.linspace(-self.reach, self.reach, N_PLACES)

    def states(self, truth: np.ndarray) -> np.ndarray:
        """States `(N_PLACES, 6)` that differ from the truth along this axis only."""
        states = np.tile(truth, (N_PLACES, 1))
        states[:, self.index] += self.offsets() if self.index < 3 else np.deg2rad(self.offsets())
        return states


AXES = {
    axis.name: axis
    for axis in (
        Axis("x", 0, 1.0),
        Axis("y", 1, 0.4),
        Axis("z", 2, 0.4),
        Axis("roll", 3, 15.0),
        Axis("pitch", 4, 15.0),
        Axis("yaw", 5, 15.0),
    )
}


class Scene(NamedTuple):
    """One frame of the wagon's run as a small image, and what draws the map for small images."""

    measured: np.ndarray
    """`(H, W)` metres, NaN = no measurement."""
    truth: np.ndarray
    """`(6,)` where the camera was."""
    renderer: DepthRenderer


@functools.cache
def small_scene(width: int = SMALL[0], height: int = SMALL[1]) -> Scene:
    """The frame of this lesson at so many pixels. Small images are drawn faster by rays than by a window."""
    sequence = wagon_run()
    camera = sequence.camera()
    small = camera.resized(width, height)
    renderer = DepthRenderer(corridor_map(), small, "ray", exact=True)
    truth = state_from_optical_pose(sequence.camera_to_world[FRAME])
    return Scene(subsample_depth(sequence.depth(FRAME), camera, small), truth, renderer)


@functools.cache
def views_along(axis_name: str) -> np.ndarray:
    """Simulated images `(N_PLACES, 36, 44)` of the cameras along one axis."""
    scene = small_scene()
    return scene.renderer.render(AXES[axis_name].states(scene.truth))


def profile(form: Form, axis_name: str, measured: np.ndarray | None = None) -> np.ndarray:
    """A likelihood of the cameras along an axis, `(N_PLACES,)`, spread over [0, 1] by eq. (9)."""
    measured = small_scene().measured if measured is None else measured
    return normalize_likelihood(form(measured, views_along(axis_name)))


def peak(axis: Axis, normalized: np.ndarray) -> tuple[float, float]:
    """How far the highest place of a profile is from the truth, and how wide it is at half height (outer crossings).

    Half height of what eq. (9) spreads: the lowest of the places in the row has 0, so the reach matters a little.
    """
    offsets = axis.offsets()
    fine = np.linspace(offsets[0], offsets[-1], 40001)
    high = fine[np.interp(fine, offsets, normalized) >= 0.5]
    return float(abs(offsets[normalized.argmax()])), float(high[-1] - high[0])


def peak_table(profiles: dict[str, dict[str, np.ndarray]]) -> str:
    """How far each form's best camera is from the truth along each axis, and how wide its peak is, as a text."""
    lines = [f"{'off / width':22}" + "".join(f"{f'{name} [{AXES[name].unit}]':>16}" for name in profiles)]
    for form in FORMS:
        found = [(AXES[name], *peak(AXES[name], forms[form])) for name, forms in profiles.items()]
        cells = [
            f"{off:.2f} / {width:.2f}" if axis.unit == "m" else f"{off:.1f} / {width:.0f}" for axis, off, width in found
        ]
        lines.append(f"{form:22}" + "".join(f"{cell:>16}" for cell in cells))
    return "\n".join(lines)


def behind_a_person(measured: np.ndarray, share: float) -> np.ndarray:
    """The measured image with a share of its columns, from the right, hidden by a person right before the lens."""
    hidden = measured.copy()
    columns = round(share * measured.shape[1])
    hidden[:, measured.shape[1] - columns :] = PERSON_DEPTH
    return hidden


def cost_of_a_pixel(difference: np.ndarray, alpha: float = ALPHA) -> dict[str, np.ndarray]:
    """What one pixel's difference [m] takes away from each form's sum, in units of what 1 m takes away.

    The disparity form has no such curve: there the cost depends on the depth as well.
    """
    d = np.append(np.asarray(difference, dtype=np.float64), 1.0)
    half_normal = np.where(d <= DEPTH_CUT, np.exp(-(d**2) / (2 * DEPTH_SIGMA**2)), 0.0)
    ratio = 0.01 * 2 / (DEPTH_SIGMA * np.sqrt(2 * np.pi)) / (0.99 / DEPTH_CUT)
    costs = {
        "paper, eq. (8)": d / (alpha + d),
        "Gaussian": d**2,
        "half-normal + uniform": np.log1p(ratio) - np.log1p(ratio * half_normal),
    }
    return {name: cost[:-1] / cost[-1] for name, cost in costs.items()}
