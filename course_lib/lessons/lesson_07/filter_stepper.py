"""The filter of figure 1, one step at a time on a stretch of the corridor: its state and its pure steps.

A state holds what earlier frames have left: the frame, the last step, and the particles before this frame's noise.
`look` computes all that is shown from it and the sliders, with fixed draws for a seed and a frame, so that a slider
changes the present frame at once.
"""

import functools
from collections import namedtuple

import numpy as np

from course_lib.depth_mcl import particle_filter
from course_lib.depth_mcl.likelihood import likelihood, normalize_likelihood, valid_pixels, weights
from course_lib.depth_mcl.localizer import SIGMA_XY_YAW
from course_lib.depth_mcl.motion import propagate
from course_lib.geometry import state_from_optical_pose
from course_lib.lessons.kit.corridor_views import corridor_map, wagon_run
from course_lib.plots.corridor_figures import floor_plan
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.sensor import subsample_depth

FRAMES = range(60, 84)  # of the wagon's run, the stretch of lesson 08
MAX_PARTICLES = 100
# Buttons in the order of figure 1, and after which steps each may be pressed.
ALLOWED_AFTER = {
    "propagate": ("propagate", "weigh", "estimate", "resample"),
    "weigh": ("propagate",),
    "estimate": ("weigh",),
    "resample": ("weigh", "estimate"),
}
Stretch = namedtuple("Stretch", "measured true walls renderer")
StepperState = namedtuple("StepperState", "frame done parents")
View = namedtuple("View", "particles weights score ess estimate indices")
FollowedStretch = namedtuple("FollowedStretch", "errors ess spread")


@functools.cache
def corridor_stretch() -> Stretch:
    """Return depth images `(T, 26, 32)` [m], the camera's states `(T, 6)`, the walls at its height `(M, 2)`, a renderer."""
    sequence, scene_map, camera = wagon_run(), corridor_map(), wagon_run().camera()
    small = camera.resized(32, 26)  # few pixels, so that a hundred views take milliseconds
    true = state_from_optical_pose(sequence.camera_to_world[list(FRAMES)])
    measured = np.stack([subsample_depth(sequence.depth(frame), camera, small) for frame in FRAMES])
    walls = floor_plan(scene_map.vertices, true[0, 2])
    near = (walls[:, 0] > true[:, 0].min() - 1.5) & (walls[:, 0] < true[:, 0].max() + 1.5)
    return Stretch(measured, true, walls[near], DepthRenderer(scene_map, small, "ray", exact=True))


def start() -> StepperState:
    """Put all particles at the true first pose, eqs (3), (4); the next frame's noise and weights are done already."""
    return StepperState(1, "weigh", particle_filter.initial_particles(corridor_stretch().true[0], MAX_PARTICLES))


def look(state: StepperState, alpha: float, beta: float, n_particles: int, noise: float, seed: int = 1) -> View:
    """Do all steps of the present frame; noise: a factor on the system noise of 0.15 m, 0.04 m, 1.5 degrees.

    The parents, evenly thinned or copied to N, get this frame's noise: particles `(N, 6)`. score: l / m of the best.
    indices `(N,)`: which particles live on.
    """
    stretch, parents = corridor_stretch(), state.parents[np.arange(n_particles) * len(state.parents) // n_particles]
    particles = propagate(parents, noise * np.array(SIGMA_XY_YAW), np.random.default_rng([seed, state.frame]))
    measured = stretch.measured[state.frame]
    raw = likelihood(measured, stretch.renderer.render(particles), alpha)
    w = weights(normalize_likelihood(raw), beta)
    indices = particle_filter.resample(w, np.random.default_rng([seed, state.frame, 1]))
    ess, estimate = particle_filter.effective_sample_size(w), particle_filter.weighted_mean_state(particles, w)
    return View(particles, w, raw.max() / max(1, valid_pixels(measured).sum()), ess, estimate, indices)


def refusal(state: StepperState, name: str) -> str:
    """Return why the step `name` cannot come now, and "" if it can."""
    if state.done not in ALLOWED_AFTER[name]:
        return f"Not now: {name} comes after {' or '.join(ALLOWED_AFTER[name])}; the last step was {state.done}."
    if name == "propagate" and state.frame + 1 == len(FRAMES):
        return "Not now: the stretch ends here: press Reset."
    return ""


def step(state: StepperState, name: str, view: View) -> StepperState:
    """Return the state after the button `name`. The present particles, resampled or not, are the next parents."""
    if name != "propagate":
        return state._replace(done=name)
    parents = view.particles[view.indices] if state.done == "resample" else view.particles
    return StepperState(state.frame + 1, "propagate", parents)


def follow(beta: float, resampled: bool = True) -> FollowedStretch:
    """Do the steps over the whole stretch: errors on the floor `(T,)` [m], sample sizes `(T,)`, spread along x [m]."""
    true, state, errors, ess = corridor_stretch().true, start(), [], []
    while True:
        view = look(state, 0.1, beta, 50, 1.0)
        errors.append(np.linalg.norm(view.estimate[:2] - true[state.frame, :2]))
        ess.append(view.ess)
        if state.frame == len(true) - 1:
            return FollowedStretch(np.array(errors), np.array(ess), view.particles[:, 0].std())
        state = step(state._replace(done="resample" if resampled else "estimate"), "propagate", view)
