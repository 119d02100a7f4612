"""The time-of-flight camera on walls of known distance: bias, noise, wraps, drop-outs, saturation, flying pixels."""

import dataclasses

import numpy as np
import pytest

from course_lib.rendering.camera import DepthCamera
from courseware.simulation.sensors.ray_casting import WorldCaster
from courseware.simulation.sensors.time_of_flight import (
    CalibrationErrors,
    CalibrationModel,
    TimeOfFlightCamera,
    TimeOfFlightModel,
)
from tools.corridor_data import noise_on_a_wall

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


def capture(world, model=MODEL, seed=0, errors=None):
    rng = np.random.default_rng(seed)
    return TimeOfFlightCamera(CAMERA, model, rng, errors).capture(world, np.zeros(6), rng)


def test_noise_grows_with_distance_and_darkness_a_near_bright_wall_saturates_and_one_beyond_the_range_is_wrapped():
    rng = np.random.default_rng(1)
    assert noise_on_a_wall(MODEL, 2.0, rng, reflectivity=0.99) == pytest.approx(0.006, abs=0.001)
    near, middle, far = (noise_on_a_wall(MODEL, d, rng) for d in (2, 5, 8))
    assert near < middle < far
    assert noise_on_a_wall(MODEL, 3.0, rng, reflectivity=0.2) > 1.3 * noise_on_a_wall(MODEL, 3.0, rng, reflectivity=0.8)
    assert np.isnan(capture(walls((0.5, -20.0), reflectivity=0.9)).depth[18, 22])
    assert capture(walls((0.5, -20.0), reflectivity=0.2)).depth[18, 22] == pytest.approx(0.5, abs=0.03)
    frame = capture(walls((12.0, -20.0), reflectivity=0.9))
    assert frame.depth[18, 22] == pytest.approx(12.0 - MODEL.unambiguous_range, abs=0.3)
    assert frame.nearest[18, 22] > MODEL.unambiguous_range


def test_a_wall_reads_its_distance_within_the_data_sheet_flying_pixels_lie_between_and_scattered_light_pulls():
    # The edge is a third of a sub-pixel column off the middle, so that one column of pixels sees both walls.
    frame = capture(walls((2.0, 0.012), (4.0, -20.0)), QUIET)
    mixed = frame.farthest - frame.nearest > 1.0
    assert mixed.any(axis=1).all()
    measured = frame.range[mixed]
    assert ((measured > frame.nearest[mixed]) & (measured < frame.farthest[mixed])).all()
    assert (measured > frame.nearest[mixed] + 0.05).any()
    away = np.minimum(np.abs(frame.depth - 2.0), np.abs(frame.depth - 4.0))
    assert away[~mixed].max() < 0.01
    # Three metres apart: at five, a half of the unambiguous range, the phasors would be opposite and only shorten.
    world = walls((1.0, 0.3), (4.0, -20.0), reflectivity=0.6)
    clean, scattered = capture(world, QUIET), capture(world, dataclasses.replace(QUIET, scattered_share=0.003))
    assert np.median((scattered.depth - clean.depth)[:, -4:]) < -0.005
    quiet_with_errors = dataclasses.replace(MODEL, shot_noise=0.0, dark_noise=0.0)
    errors = [np.median(capture(walls((d, -20.0)), quiet_with_errors).depth) - d for d in np.arange(1.0, 4.0, 0.2)]
    assert np.abs(errors).max() < 0.015
    assert np.ptp(errors) > 0.008  # they are cyclic, not constant
    depth = capture(walls((2.0, -20.0)), QUIET).depth
    # The sub-rays of one pixel have slightly different ranges, the corner pixels most: below a millimetre in all.
    assert np.abs(depth - 2.0).max() < 1e-3


def columns_of_the_wall(errors=None):
    """How many columns a wall to the left of y = 0.6 m at 3 m covers: those of its pixels in the middle row."""
    return np.isfinite(capture(walls((3.0, 0.6)), QUIET, errors=errors).depth[18]).sum()


def test_a_longer_focal_length_shows_things_farther_out_distortion_moves_the_corners_and_the_mount_the_camera():
    """The edge lies 0.2 fx = 11 pixels left of the middle; a tenth more is one pixel farther."""
    told = columns_of_the_wall()
    assert told == columns_of_the_wall(CalibrationErrors())
    assert told - columns_of_the_wall(CalibrationErrors(focal_length=0.2)) in (2, 3)
    assert columns_of_the_wall(CalibrationErrors(focal_length=-0.2)) - told in (2, 3)
    frame = capture(walls((3.0, -20.0)), QUIET, errors=CalibrationErrors(radial=0.5))
    # Range grows with the angle, and depth by the told rays keeps the excess: 3 m sqrt(1 + r'^2) / sqrt(1 + r^2).
    r = np.hypot(*np.moveaxis(CAMERA.rays()[..., :2], -1, 0))
    expected = 3.0 * np.sqrt((1 + (r * (1 + 0.5 * r**2)) ** 2) / (1 + r**2))
    assert frame.depth == pytest.approx(expected, abs=2e-3)
    assert frame.depth[0, 0] > 3.05
    assert frame.depth[18, 22] == pytest.approx(3.0, abs=1e-3)
    nearer = capture(walls((3.0, -20.0)), QUIET, errors=CalibrationErrors(mount=(0.1, 0, 0, 0, 0, 0))).depth
    assert nearer == pytest.approx(np.full(CAMERA.shape, 2.9), abs=1e-3)
    turned = capture(walls((3.0, -20.0)), QUIET, errors=CalibrationErrors(mount=(0, 0, 0, 0, 0, 0.1))).depth[18]
    # Turned to the left by 0.1 rad, the axis meets the wall at 3 / cos(0.1), and the left columns meet it farther off.
    assert turned[21:23].mean() == pytest.approx(3.0 / np.cos(0.1), abs=0.005)
    assert turned[0] > turned[-1] + 0.1


def test_drawn_errors_have_the_sizes_of_the_model_and_signs_of_their_own():
    drawn = [CalibrationModel().draw(np.random.default_rng(seed)) for seed in range(20)]
    assert {abs(errors.focal_length) for errors in drawn} == {0.01}
    numbers = np.array([(errors.focal_length, errors.radial, *errors.mount) for errors in drawn])
    sizes = [0.01, 0.02, *[0.005] * 3, *[np.deg2rad(0.3)] * 3]
    assert np.abs(numbers) == pytest.approx(np.tile(sizes, (20, 1)))
    assert (np.abs(np.sign(numbers).mean(axis=0)) < 0.8).all()
    assert np.abs(np.corrcoef(np.sign(numbers).T) - np.eye(8)).max() < 0.99
