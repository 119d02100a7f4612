"""What stands beside a submission to project P1: the paper's filter as printed, and one of ours within its budget."""

import numpy as np

from course_lib.beyond.six_dof.refinement import gauss_newton_step
from course_lib.depth_mcl import DepthCamera
from course_lib.depth_mcl.likelihood import compiled_likelihood as likelihood
from course_lib.depth_mcl.likelihood import normalize_likelihood, valid_pixels, weights
from course_lib.depth_mcl.motion import propagate, propagate_body
from course_lib.depth_mcl.particle_filter import initial_particles, resample, weighted_mean_state
from course_lib.depth_mcl.uncertainty import temper
from course_lib.geometry import optical_pose, pose_matrix, state_from_matrix, state_from_optical_pose

# Chosen on seeds 10,001 to 10,008.
PAPER_SIGMA = np.array([0.30, 0.06, 0.0, 0.0, 0.0, np.deg2rad(1.5)])  # along the world's axes; the step is 0.2 m

FIRST, SECOND, REFINED, STEPS = 18, 9, 2, 5  # renders: 18 + 9 + 2 (1 + 5) = 39 of 40
SPREAD = np.array([0.12, 0.05, 0.0, 0.0, 0.0, np.deg2rad(3.0)])  # about the prediction, along the body's axes
SCALES = (0.20, 0.12, 0.08, 0.05, 0.03)  # metres, of the residuals, step by step


def paper_filter(renderer, camera, frames, start, n_particles, rng) -> np.ndarray:
    """Eqs (1) to (12) as printed: random steps along the world's axes, min-max weights, all particles a frame."""
    particles = initial_particles(start, n_particles)
    estimates = []
    for measured in frames:
        particles = propagate(particles, PAPER_SIGMA, rng)
        w = weights(normalize_likelihood(likelihood(measured, renderer.render(particles))))
        estimates.append(weighted_mean_state(particles, w))
        particles = particles[resample(w, rng)]
    return np.array(estimates)


def refined_filter(renderer, camera, frames, start, n_particles, rng) -> np.ndarray:
    """Predicts by the last step, draws twice, the second time closer, and refines the two best by Gauss-Newton."""
    before, last = None, start
    estimates = []
    for measured in frames:
        expected = last if before is None else _one_step_on(before, last)
        states = propagate_body(initial_particles(expected, FIRST), SPREAD, rng)
        states, scores = _weighed(renderer, measured, states)
        parents = states[resample(temper(scores, 0.2 * FIRST).weights, rng, n=SECOND)]
        closer, more = _weighed(renderer, measured, propagate_body(parents, 0.4 * SPREAD, rng))
        states, scores = np.concatenate([states, closer]), np.concatenate([scores, more])
        best = states[np.argsort(scores)[-REFINED:]]
        for scale in SCALES:
            best = _refined(renderer, camera, measured, best, start, scale)
        best, scores = _weighed(renderer, measured, best)
        before, last = last, best[np.argmax(scores)]
        estimates.append(last)
    return np.array(estimates)


def _one_step_on(before: np.ndarray, last: np.ndarray) -> np.ndarray:
    """The state after the same motion once more, in the body's axes."""
    motion = np.linalg.inv(pose_matrix(before)) @ pose_matrix(last)
    return state_from_matrix(pose_matrix(last) @ motion)


def _weighed(renderer, measured: np.ndarray, states: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The states and their raw scores, eq. (8) as a mean over pixels."""
    return states, likelihood(measured, renderer.render(states)) / max(1, valid_pixels(measured).sum())


def _refined(
    renderer, camera: DepthCamera, measured: np.ndarray, states: np.ndarray, start: np.ndarray, scale: float
) -> np.ndarray:
    """States after one Gauss-Newton step; height, roll and pitch are the wagon's."""
    poses = gauss_newton_step(measured, renderer.render(states), camera, optical_pose(states), scale)
    moved = state_from_optical_pose(poses)
    moved[:, 2:5] = start[2:5]
    return moved
