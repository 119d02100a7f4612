"""The filter of figure 1, one step at a time on the corridor: its state, its pure steps, and the panel with buttons.

A state holds what earlier frames have left: the frame, which steps are done, and the particles before this frame's
noise. Everything that is shown follows from it and from the sliders: `look` propagates, weighs, estimates and resamples
with fixed draws for a seed and a frame, so that a slider changes the present frame at once, and a button moves on.
"""

import functools
from typing import NamedTuple

import numpy as np

from course_lib.depth_mcl.likelihood import likelihood, normalize_likelihood, valid_pixels, weights
from course_lib.depth_mcl.localizer import SIGMA_XY_YAW
from course_lib.depth_mcl.motion import propagate
from course_lib.depth_mcl.particle_filter import (
    effective_sample_size,
    initial_particles,
    resample,
    weighted_mean_state,
)
from course_lib.geometry import state_from_optical_pose
from course_lib.lessons.kit.corridor_views import corridor_map, wagon_run
from course_lib.plots.corridor_figures import floor_plan
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.sensor import subsample_depth

FRAMES = range(60, 84)  # of the wagon's run, the stretch of lesson 08
SMALL = (32, 26)  # pixels of the images: few, so that a hundred views take milliseconds
MAX_PARTICLES = 100
# Buttons in the order of figure 1, and after which steps each may be pressed.
ALLOWED_AFTER = {
    "propagate": ("propagate", "weigh", "estimate", "resample"),
    "weigh": ("propagate",),
    "estimate": ("weigh",),
    "resample": ("weigh", "estimate"),
}


class NotNowError(ValueError):
    """A step of the filter that cannot follow the last one; the message says what can."""


class Stretch(NamedTuple):
    """What the stepper runs on."""

    measured: np.ndarray
    """`(T, 26, 32)` depth images, metres, NaN = no measurement."""
    true: np.ndarray
    """`(T, 6)` where the camera was."""
    walls: np.ndarray
    """`(M, 2)` the map, cut at the camera's height."""
    renderer: DepthRenderer


class Settings(NamedTuple):
    """What the sliders say."""

    alpha: float
    beta: float
    n_particles: int
    noise: float
    """Factor on the system noise of 0.15 m, 0.04 m, 1.5 degrees."""
    seed: int = 1


class StepperState(NamedTuple):
    """Where the reader stands."""

    frame: int
    """Index of the present measurement in the stretch; the start is given at 0."""
    done: str
    """The last step that was done."""
    parents: np.ndarray
    """`(M, 6)` particles before this frame's noise."""


class View(NamedTuple):
    """One frame of the filter, all of its steps; how many of them are shown is the state's affair."""

    particles: np.ndarray
    """`(N, 6)` after the noise, before resampling."""
    weights: np.ndarray
    """`(N,)` summing to one."""
    score: float
    """l / m of the best particle."""
    ess: float
    estimate: np.ndarray
    """`(6,)`"""
    indices: np.ndarray
    """`(N,)` which particles live on."""


@functools.cache
def corridor_stretch() -> Stretch:
    """The stretch at 32 x 26 pixels. Small images are drawn faster by rays than by a window."""
    sequence = wagon_run()
    camera = sequence.camera()
    small = camera.resized(*SMALL)
    scene_map = corridor_map()
    true = state_from_optical_pose(sequence.camera_to_world[list(FRAMES)])
    measured = np.stack([subsample_depth(sequence.depth(frame), camera, small) for frame in FRAMES])
    walls = floor_plan(scene_map.vertices, true[0, 2])
    near = (walls[:, 0] > true[:, 0].min() - 1.5) & (walls[:, 0] < true[:, 0].max() + 1.5)
    return Stretch(measured, true, walls[near], DepthRenderer(scene_map, small, "ray", exact=True))


def start(stretch: Stretch) -> StepperState:
    """Eqs (3), (4): all particles at the true first pose; the next frame's noise and weights are done already."""
    return StepperState(1, "weigh", initial_particles(stretch.true[0], MAX_PARTICLES))


def present_particles(state: StepperState, settings: Settings) -> np.ndarray:
    """Eq. (5): the parents, as many as the slider asks for (evenly thinned or copied), with this frame's noise."""
    n = settings.n_particles
    parents = state.parents[np.arange(n) * len(state.parents) // n]
    rng = np.random.default_rng([settings.seed, state.frame])
    return propagate(parents, settings.noise * np.array(SIGMA_XY_YAW), rng)


def look(state: StepperState, settings: Settings, stretch: Stretch, images: np.ndarray | None = None) -> View:
    """All steps of the present frame. images: `(N, 26, 32)` views of the present particles, drawn here if None."""
    particles = present_particles(state, settings)
    images = stretch.renderer.render(particles) if images is None else images
    measured = stretch.measured[state.frame]
    l = likelihood(measured, images, settings.alpha)  # noqa: E741 - the paper's letter
    w = weights(normalize_likelihood(l), settings.beta)
    indices = resample(w, np.random.default_rng([settings.seed, state.frame, 1]))
    score = float(l.max() / max(1, valid_pixels(measured).sum()))
    return View(particles, w, score, effective_sample_size(w), weighted_mean_state(particles, w), indices)


def step(state: StepperState, name: str, view: View) -> StepperState:
    """The state after pressing the button `name` ("propagate", "weigh", "estimate", "resample").

    propagate makes the present particles the parents of the next frame: those that were resampled, or all of them as
    they are where resampling was left out. Raises `NotNowError` for a step that cannot come now.
    """
    if name not in ALLOWED_AFTER:
        raise NotNowError(f"there is no step {name!r}; there are {', '.join(ALLOWED_AFTER)}")
    if state.done not in ALLOWED_AFTER[name]:
        raise NotNowError(f"{name} comes after {' or '.join(ALLOWED_AFTER[name])}; the last step was {state.done}")
    if name != "propagate":
        return state._replace(done=name)
    if state.frame + 1 >= len(FRAMES):
        raise NotNowError("the stretch ends here: press Reset")
    parents = view.particles[view.indices] if state.done == "resample" else view.particles
    return StepperState(state.frame + 1, "propagate", parents)


def whole_round(state: StepperState, settings: Settings, stretch: Stretch) -> StepperState:
    """Finish this frame, resampling included, and go on to the estimate of the next one."""
    if state.done != "resample":
        state = state._replace(done="resample")
    state = step(state, "propagate", look(state, settings, stretch))
    return state._replace(done="estimate")
