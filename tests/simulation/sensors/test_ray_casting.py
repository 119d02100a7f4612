"""Rays at a plane: distance, cosine and miss, in closed form."""

import numpy as np
import pytest

from courseware.simulation.sensors.ray_casting import WorldCaster


def test_distance_and_cosine_of_a_plane_in_the_directions_own_unit_and_a_miss_is_infinite():
    vertices = np.array([[2.0, y, z] for y in (-9.0, 9.0) for z in (-9.0, 9.0)])
    wall = WorldCaster(vertices, np.array([[0, 1, 2], [1, 3, 2]]), np.array([0.3, 0.6]))
    angle = np.deg2rad([0.0, 30.0, 60.0, 75.0])
    directions = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=-1)
    hits = wall.cast(np.zeros(3), directions)
    assert hits.distance == pytest.approx(2.0 / np.cos(angle), rel=1e-5)
    assert hits.cosine == pytest.approx(np.cos(angle), abs=1e-5)
    assert wall.cast(np.zeros(3), np.array([[4.0, 0.5, 0.0]])).distance[0] == pytest.approx(0.5, rel=1e-6)
    hits = wall.cast(np.zeros((2, 5, 3)), np.broadcast_to([-1.0, 0.0, 0.0], (2, 5, 3)))
    assert hits.distance.shape == (2, 5)
    assert np.isinf(hits.distance).all()
    assert (hits.face == -1).all()
    assert (hits.cosine == 0).all()
