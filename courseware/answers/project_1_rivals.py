"""The rivals of a submission to project P1: the paper's filter as printed, and one of ours within the same budget."""

import numpy as np

from course_lib.beyond.six_dof.refinement import gauss_newton_step
from course_lib.depth_mcl.likelihood import paper_weighting
from course_lib.depth_mcl.motion import propagate, propagate_body
from course_lib.depth_mcl.particle_filter import initial_particles, resample, weighted_mean_state
from course_lib.depth_mcl.uncertainty import temper
from course_lib.geometry import optical_pose, pose_matrix, state_from_matrix, state_from_optical_pose

score, weigh = paper_weighting()
# Chosen on seeds 10,001 to 10,008.
PAPER_SIGMA = np.array([0.30, 0.06, 0.0, 0.0, 0.0, np.deg2rad(1.5)])  # along the world's axes; a step is 0.2 m

FIRST, SECOND, REFINED = 18, 9, 2  # renders of a frame: 18 + 9 + 2 (5 + 1) = 39 of 40
SPREAD = np.array([0.12, 0.05, 0.0, 0.0, 0.0, np.deg2rad(3.0)])  # about the prediction, along the body's axes
SCALES = (0.20, 0.12, 0.08, 0.05, 0.03)  # metres, of the residuals in each refining step


def paper_filter(renderer, camera, frames, start, n_particles, rng) -> np.ndarray:
    """Follow eqs (1) to (12) as printed: random steps along the world's axes, min-max weights."""
    particles, estimates = initial_particles(start, n_particles), []
    for measured in frames:
        particles = propagate(particles, PAPER_SIGMA, rng)
        w = weigh(measured, score(measured, renderer.render(particles)))
        estimates.append(weighted_mean_state(particles, w))
        particles = particles[resample(w, rng)]
    return np.array(estimates)


def refined_filter(renderer, camera, frames, start, n_particles, rng) -> np.ndarray:
    """Predict by the last step, draw twice, the second time closer, and refine the two best by Gauss-Newton steps."""
    estimates = [start, start]
    for measured in frames:
        before, last = (pose_matrix(state) for state in estimates[-2:])
        expected = state_from_matrix(last @ np.linalg.inv(before) @ last)  # the same motion once more
        states = propagate_body(initial_particles(expected, FIRST), SPREAD, rng)
        found = score(measured, renderer.render(states))
        parents = states[resample(temper(found, 0.2 * FIRST).weights, rng, n=SECOND)]
        closer = propagate_body(parents, 0.4 * SPREAD, rng)
        found = np.append(found, score(measured, renderer.render(closer)))
        best = np.concatenate([states, closer])[np.argsort(found)[-REFINED:]]
        for scale in SCALES:
            poses = gauss_newton_step(measured, renderer.render(best), camera, optical_pose(best), scale)
            best = state_from_optical_pose(poses)
            best[:, 2:5] = start[2:5]  # height, roll and pitch are the wagon's
        estimates.append(best[np.argmax(score(measured, renderer.render(best)))])
    return np.array(estimates[2:])
