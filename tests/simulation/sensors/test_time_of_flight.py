"""The time-of-flight camera on walls of known distance: bias, noise, wraps, drop-outs, saturation, flying pixels."""

import dataclasses

import numpy as np
import pytest

from course_lib.depth_mcl.camera import DepthCamera
from course_lib.simulation.corridor.measurements import noise_on_a_wall
from course_lib.simulation.sensors.ray_casting import WorldCaster
from course_lib.simulation.sensors.time_of_flight import TimeOfFlightCamera, TimeOfFlightModel

CAMERA = DepthCamera.sr4000().resized(44, 36)
MODEL = TimeOfFlightModel()
QUIET = dataclasses.replace(
    MODEL, shot_noise=0.0, dark_noise=0.0, fixed_pattern=0.0, offset=0.0, wiggling=0.0, scattered_share=0.0
)


def walls(*distances_and_edges, reflectivity=0.8):
    """Walls across x, each (distance, least y): a wall spans from its least y to 20 m."""
    vertices, faces = [], []
    for distance, edge in distances_and_edges:
        start = len(vertices)
        vertices += [[distance, y, z] for y in (edge, 20.0) for z in (-20.0, 20.0)]
        faces += [[start, start + 1, start + 2], [start + 1, start + 3, start + 2]]
    return WorldCaster(np.array(vertices), np.array(faces), reflectivity)


def capture(world, model=MODEL, seed=0):
    rng = np.random.default_rng(seed)
    return TimeOfFlightCamera(CAMERA, model, rng).capture(world, np.zeros(6), rng)


def test_a_wall_at_two_metres_reads_two_metres():
    depth = capture(walls((2.0, -20.0)), QUIET).depth
    # The sub-rays of one pixel have slightly different ranges, the corner pixels most: below a millimetre in all.
    assert np.abs(depth - 2.0).max() < 1e-3


def test_systematic_errors_stay_within_the_data_sheet():
    quiet_with_errors = dataclasses.replace(MODEL, shot_noise=0.0, dark_noise=0.0)
    errors = [np.median(capture(walls((d, -20.0)), quiet_with_errors).depth) - d for d in np.arange(1.0, 4.0, 0.2)]
    assert np.abs(errors).max() < 0.015
    assert np.ptp(errors) > 0.008  # they are cyclic, not constant


def test_noise_at_two_metres_is_the_data_sheets():
    noise = noise_on_a_wall(MODEL, 2.0, np.random.default_rng(0), reflectivity=0.99)
    assert noise == pytest.approx(0.006, abs=0.001)


def test_noise_grows_with_distance_and_with_darkness():
    rng = np.random.default_rng(1)
    near, middle, far = (noise_on_a_wall(MODEL, d, rng) for d in (2, 5, 8))
    assert near < middle < far
    assert noise_on_a_wall(MODEL, 3.0, rng, reflectivity=0.2) > 1.3 * noise_on_a_wall(MODEL, 3.0, rng, reflectivity=0.8)


def test_a_bright_wall_beyond_the_unambiguous_range_comes_back_wrapped():
    frame = capture(walls((12.0, -20.0), reflectivity=0.9))
    measured = frame.depth[18, 22]
    assert measured == pytest.approx(12.0 - MODEL.unambiguous_range, abs=0.3)
    assert frame.nearest[18, 22] > MODEL.unambiguous_range


def test_a_dark_wall_beyond_the_unambiguous_range_is_dropped():
    assert np.isnan(capture(walls((12.0, -20.0), reflectivity=0.2)).depth).all()


def test_a_near_bright_wall_saturates_and_a_near_dark_one_does_not():
    assert np.isnan(capture(walls((0.5, -20.0), reflectivity=0.9)).depth[18, 22])
    assert capture(walls((0.5, -20.0), reflectivity=0.2)).depth[18, 22] == pytest.approx(0.5, abs=0.03)


def test_where_there_is_nothing_there_is_no_return():
    depth = capture(walls((3.0, 0.0))).depth
    assert np.isnan(depth[:, CAMERA.width // 2 + 2 :]).all()  # right of the wall's edge: y below 0
    assert np.isfinite(depth[:, : CAMERA.width // 2 - 2]).all()


def test_flying_pixels_lie_between_foreground_and_background():
    # The edge is a third of a sub-pixel column off the middle, so that one column of pixels sees both walls.
    frame = capture(walls((2.0, 0.012), (4.0, -20.0)), QUIET)
    mixed = frame.farthest - frame.nearest > 1.0
    assert mixed.any(axis=1).all()
    measured = frame.range[mixed]
    assert ((measured > frame.nearest[mixed]) & (measured < frame.farthest[mixed])).all()
    assert (measured > frame.nearest[mixed] + 0.05).any()
    away = np.minimum(np.abs(frame.depth - 2.0), np.abs(frame.depth - 4.0))
    assert away[~mixed].max() < 0.01


def test_scattered_light_pulls_a_far_dark_wall_towards_a_near_bright_one():
    # Three metres apart: at five, a half of the unambiguous range, the phasors would be opposite and only shorten.
    world = walls((1.0, 0.3), (4.0, -20.0), reflectivity=0.6)
    clean, scattered = capture(world, QUIET), capture(world, dataclasses.replace(QUIET, scattered_share=0.003))
    assert np.median((scattered.depth - clean.depth)[:, -4:]) < -0.005


def test_one_seed_gives_one_frame():
    world = walls((3.0, -20.0))
    first, again, other = (capture(world, seed=seed).depth for seed in (1, 1, 2))
    assert first.tobytes() == again.tobytes()
    assert first.dtype == np.float32
    assert first.shape == CAMERA.shape
    assert (first != other).any()


def test_the_camera_looks_along_body_x_with_left_at_the_left():
    depth = capture(walls((3.0, 0.0)), QUIET).depth
    assert np.isfinite(depth[:, 0]).all()  # y > 0 is left, column 0
    assert np.isnan(depth[:, -1]).all()
