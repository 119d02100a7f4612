"""Clouds of particles that walk along the wagon's path, and an oracle that keeps the nearest."""

import itertools
from collections import namedtuple

import numpy as np

from course_lib.depth_mcl.motion import propagate
from course_lib.depth_mcl.particle_filter import initial_particles
from course_lib.geometry import pose_matrix, state_from_optical_pose
from courseware.lessons.kit.corridor_data import wagon_run

Walk = namedtuple("Walk", "clouds nearest")


def wagon_states() -> np.ndarray:
    """Return the true states `(T, 6)` of the wagon's camera."""
    return state_from_optical_pose(wagon_run().camera_to_world)


def corner_states() -> np.ndarray:
    """Return the states `(T, 6)` of a wagon that rolls along x, turns left on an arc of 0.6 m, and goes on along y."""
    radius, before = 0.6, 3.1
    quarter = radius * np.pi / 2
    way = np.arange(0, before + quarter + 4.2, 0.1)
    turn = np.clip((way - before) / radius, 0, np.pi / 2)
    x = 14.0 + np.minimum(way, before) + radius * np.sin(turn)
    y = radius - radius * np.cos(turn) + np.maximum(way - before - quarter, 0)
    return np.column_stack([x, y, np.ones(len(way)), 0 * way, 0 * way, turn])


def walk(true: np.ndarray, sigma: np.ndarray, n: int, seed: int, keep_nearest: bool, own_axes: bool = False) -> Walk:
    """Start a cloud at the first true state `(T, 6)`, and move it once a frame by eq. (5).

    Return its clouds `(T, N, 6)`, and the distance `(T,)` [m] on the floor from the wagon to its nearest particle.
    keep_nearest: after each move an oracle names the particle that is nearest to the wagon on the floor, and all start
    from there. own_axes: sigma's first two are along the wagon's forward and left axes, whose heading a compass gives,
    and not along the world's x and y.
    """
    rng = np.random.default_rng(seed)
    particles = initial_particles(true[0], n)
    clouds = [particles]
    for before, state in itertools.pairwise(true):
        moved = propagate(particles, sigma, rng)
        if own_axes:
            moved[:, :2] = particles[:, :2] + (moved - particles)[:, :2] @ pose_matrix(before)[:2, :2].T
        clouds.append(moved)
        nearest = np.hypot(*(moved - state)[:, :2].T).argmin()
        particles = np.tile(moved[nearest], (n, 1)) if keep_nearest else moved
    return Walk(np.array(clouds), distances(np.array(clouds), true).min(axis=1))


def distances(clouds: np.ndarray, true: np.ndarray) -> np.ndarray:
    """Return the distances `(T, N)` [m] on the floor of clouds `(T, N, 6)` from true states `(T, 6)`."""
    return np.linalg.norm((clouds - true[:, None])[..., :2], axis=-1)
