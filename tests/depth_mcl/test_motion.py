"""Laws of the three motions: eq. (5) as printed, along the body's axes, and in the tangent space."""

import numpy as np
import pytest

from course_lib.depth_mcl.motion import (
    BODY_AXES,
    TANGENT_SPACE,
    WORLD_AXES,
    propagate,
    propagate_body,
    propagate_tangent,
)
from course_lib.depth_mcl.particle_filter import initial_particles
from course_lib.geometry import pose_matrix, rotation_log, state_from_matrix

STATE = np.array([1.0, -2.0, 0.5, 0.1, -0.2, 3.1])
MOTIONS = {"world": WORLD_AXES, "body": BODY_AXES, "tangent": TANGENT_SPACE}


def test_system_noise_has_the_given_spread_angles_stay_wrapped_and_noise_along_the_body_is_forward_and_left(rng):
    sigma = np.array([0.3, 0.1, 0.05, 0.02, 0.03, 0.04])
    moved = propagate(initial_particles(STATE, 100), [0, 0, 0, 1, 1, 1], rng)
    assert (moved[:, :3] == STATE[:3]).all()
    assert (np.abs(moved[:, 3:]) <= np.pi).all()
    moved = propagate(initial_particles(np.zeros(6), 40_000), sigma, rng)
    assert np.allclose(moved.std(axis=0), sigma, rtol=0.02)
    assert np.allclose(moved.mean(axis=0), 0, atol=4 * sigma.max() / 200)
    particles = np.repeat([[0.0, 0, 1, 0.1, -0.2, yaw] for yaw in (0.3, np.pi / 2, -2.8)], 20_000, axis=0)
    moved = propagate_body(particles, [0.3, 0.05, 0, 0, 0, 0.2], rng)
    for start in (0, 20_000, 40_000):
        yaw = particles[start, 5]
        forward, left = np.array([np.cos(yaw), np.sin(yaw)]), np.array([-np.sin(yaw), np.cos(yaw)])
        steps = moved[start : start + 20_000, :2]
        assert (steps @ forward).std() == pytest.approx(0.3, rel=0.03)
        assert (steps @ left).std() == pytest.approx(0.05, rel=0.03)
    assert (moved[:, 2:5] == particles[:, 2:5]).all()


def test_a_bad_sigma_is_named(rng):
    for move in (propagate, propagate_body, propagate_tangent):
        for sigma in ([0.1] * 5, [0.1, 0.1, 0.1, 0, 0, -0.1], [np.nan] * 6, 0.1):
            with pytest.raises(ValueError, match="sigma"):
                move(initial_particles(STATE, 3), sigma, rng)


@pytest.mark.parametrize("pitch", [0.0, np.pi / 2])
def test_tangent_noise_is_the_same_in_gimbal_lock_as_out_of_it(pitch, rng):
    start = np.array([0, 0, 0, 0.2, pitch, 0.3])
    sigma = np.array([0, 0, 0, 0.02, 0.03, 0.04])
    moved = propagate_tangent(initial_particles(start, 20_000), sigma, rng)
    turn = np.swapaxes(pose_matrix(start)[None, :3, :3], -1, -2) @ pose_matrix(moved)[:, :3, :3]
    assert np.allclose(rotation_log(turn).std(axis=0), sigma[3:], rtol=0.03)


@pytest.mark.parametrize("name", ["body", "tangent"])
@pytest.mark.parametrize("turn", [np.pi / 4, np.pi / 2, -2.0])
def test_turning_the_world_about_z_turns_what_the_motion_does(name, turn):
    """The same draws, from particles and in the turned world: the results differ by the turn alone."""
    motion, sigma = MOTIONS[name], [0.3, 0.1, 0.05, 0.02, 0.03, 0.04]
    world = pose_matrix([1.0, 2.0, 0.0, 0, 0, turn])
    particles = initial_particles(STATE, 50) + np.random.default_rng(1).normal(0, 0.2, (50, 6))
    turned = state_from_matrix(world @ pose_matrix(particles))
    moved = motion.propagate(particles, sigma, np.random.default_rng(4))
    moved_in_turned = motion.propagate(turned, sigma, np.random.default_rng(4))
    assert pose_matrix(moved_in_turned) == pytest.approx(world @ pose_matrix(moved), abs=1e-12)


@pytest.mark.parametrize("name", MOTIONS)
def test_the_mean_has_no_mean_deviation_and_deviations_are_the_short_way_round(name, rng):
    motion = MOTIONS[name]
    particles = motion.propagate(initial_particles(STATE, 4000), [0.1, 0.2, 0.05, 0.02, 0.03, 0.1], rng)
    w = rng.random(4000)
    w /= w.sum()
    deviations = motion.deviations(particles, motion.mean(particles, w))
    assert w @ deviations == pytest.approx(np.zeros(6), abs=1e-3)
    assert np.abs(deviations[:, 3:]).max() < 0.6  # yaw lies around the wrap
