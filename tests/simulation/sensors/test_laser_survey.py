"""Scans of a plain room: noise, drop-outs, mixed pixels, registration."""

import dataclasses

import numpy as np
import pytest

from courseware.simulation.corridor.materials import RUBBER, WALL_PAINT
from courseware.simulation.corridor.mesh_building import MeshBuilder, Placement
from courseware.simulation.corridor.surface_fusion import FusionModel, fuse
from courseware.simulation.sensors.laser_survey import ScannerModel, registration_error, scan, survey
from courseware.simulation.sensors.ray_casting import WorldCaster

COARSE = ScannerModel(step_deg=0.5)
TRUE_REGISTRATION = dataclasses.replace(
    COARSE, registration_position=0.0, registration_tilt_deg=0.0, registration_heading_deg=0.0
)
POSE = np.array([[1.0, 0, 0, 3.0], [0, 1, 0, 2.0], [0, 0, 1, 1.6], [0, 0, 0, 1]])


def room(with_pillar=False, material=WALL_PAINT):
    b = MeshBuilder()
    b.box(Placement(), (0, 0, 0), (6, 4, 2.6), material)
    if with_pillar:
        b.box(Placement(), (3.8, 1.8, 0), (4.2, 2.2, 2.6), material)
    built = b.build()
    return WorldCaster(built.vertices, built.faces, built.reflectivity)


def test_points_lie_on_the_walls_dark_and_grazing_surfaces_drop_out_and_mixed_pixels_float_before_the_wall():
    bright = np.isfinite(scan(room(), COARSE, POSE, POSE, np.random.default_rng(0)).ranges).mean()
    assert bright == 1.0
    # Lost is what has rho cos(theta) (10 m / r)^2 < 1: rubber straight below still gives 2.3, the far wall 0.7.
    demanding = dataclasses.replace(COARSE, least_signal=1.0)
    dark = scan(room(material=RUBBER), demanding, POSE, POSE, np.random.default_rng(0))
    assert np.isfinite(dark.ranges[0]).all()
    assert np.isnan(dark.ranges[np.abs(dark.elevations).argmin(), np.abs(dark.azimuths).argmin()])
    strict = dataclasses.replace(COARSE, grazing_deg=45.0)
    assert np.isfinite(scan(room(), strict, POSE, POSE, np.random.default_rng(0)).ranges).mean() < bright
    points = scan(room(), COARSE, POSE, POSE, np.random.default_rng(0)).points()
    off = np.min(np.abs(np.concatenate([points, points - [6, 4, 2.6]], axis=1)), axis=1)
    assert 0.0003 < np.median(off) < 0.002
    assert np.percentile(off, 99) < 0.01
    fine = dataclasses.replace(COARSE, step_deg=0.2, beam_at_exit=0.02)
    points = scan(room(with_pillar=True), fine, POSE, POSE, np.random.default_rng(0)).points()
    behind = (points[:, 0] > 4.3) & (points[:, 0] < 5.9) & (np.abs(points[:, 1] - 2) < 0.7)
    inside = behind & (points[:, 2] > 0.1) & (points[:, 2] < 2.5)
    assert 5 < inside.sum() < 0.01 * len(points)


def test_registration_error_grows_with_the_stations_errors():
    stations = ((2.0, 2.0), (4.0, 2.0))
    rough = dataclasses.replace(COARSE, registration_position=0.03)
    exact, off = (
        registration_error(survey(room(), m, np.random.default_rng(3), stations), np.random.default_rng(0))
        for m in (TRUE_REGISTRATION, rough)
    )
    assert exact["rms_station_position_error_m"] == 0.0
    assert exact["mean_point_distance_m"] == pytest.approx(exact["mean_point_distance_true_poses_m"], rel=0.05)
    assert off["mean_point_distance_m"] > 1.2 * off["mean_point_distance_true_poses_m"]


@pytest.mark.slow
def test_what_the_pillar_hides_stays_a_hole():
    fine = dataclasses.replace(TRUE_REGISTRATION, step_deg=0.25)
    scans = survey(room(with_pillar=True), fine, np.random.default_rng(3), ((1.5, 2.0), (2.0, 1.5)))
    model = FusionModel(voxel=0.04, truncation=0.12, slab=1.0, triangles=6000)
    caster = WorldCaster(*fuse(scans, model))
    towards_shadow = caster.cast(np.array([4.6, 2.2, 1.3]), np.array([[1.0, 0.0, 0.0]])).distance[0]
    beside_it = caster.cast(np.array([4.6, 0.6, 1.3]), np.array([[1.0, 0.0, 0.0]])).distance[0]
    assert np.isinf(towards_shadow)
    assert beside_it == pytest.approx(1.4, abs=0.02)
