"""A plain particle filter that starts anywhere in the hotel and takes as many particles as KLD-sampling asks for."""

import functools
from collections import namedtuple

import numpy as np

from course_lib.beyond.lost_and_found.global_search import TILT_SIGMA, upright_rotation
from course_lib.depth_mcl import likelihood, normalize_likelihood, propagate, resample, weights
from course_lib.geometry import optical_pose, rotation_exp, state_from_optical_pose
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.sensor import subsample_depth
from courseware.lessons.lesson_10.adaptive_count import kld_count, occupied_bins
from courseware.lessons.lesson_10.enclosed_space import EnclosedSpace
from courseware.lessons.lesson_10.hotel_floor import ALIKE, CAMERA, hotel_map, leaving_101

# All chosen in this world, with seeds from 10,000 up.
COARSE = CAMERA.resized(20, 15)
ALPHA, BETA = 0.3, 0.15  # of eqs (8) and (10): wide, because the nearest of thousands is still decimetres off
SIGMA = np.array([0.12, 0.12, 0.03, 0.01, 0.02, 0.1])  # of eq. (5)
MAX_PARTICLES, MIN_PARTICLES = 3_000, 100
BIN = 0.5  # metres, and as a chord of the direction of view

RUNS = range(1, 8)  # a run's seed is 10,000 and its number

# One frame of a run: its particles `(n, 6)`, their weights `(n,)`, and how many bins they fill once resampled.
Round = namedtuple("Round", "particles weights bins")


free_space = functools.cache(lambda: EnclosedSpace(hotel_map()))
# A depth image of the camera, and the map, on 20 x 15 pixels.
coarse = functools.partial(subsample_depth, camera=CAMERA, coarse=COARSE)
coarse_renderer = functools.cache(lambda: DepthRenderer(hotel_map(), COARSE))


def distance_to_either(states: np.ndarray, true: np.ndarray) -> np.ndarray:
    """Return the distances `(2, N)` [m] on the floor of states `(N, 6)` from the camera and from its double."""
    return np.array([np.hypot(*(states[:, :2] - true[:2] - offset[:2]).T) for offset in (0 * ALIKE, ALIKE)])


def start_anywhere(n: int, gravity: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Draw particles `(n, 6)` anywhere in the free space, upright as gravity `(3,)` says, of any heading."""
    return state_from_optical_pose(upright_poses(free_space().draw(n, rng), gravity, TILT_SIGMA, rng))


def upright_poses(
    positions: np.ndarray, gravity: np.ndarray, tilt_sigma: float, rng: np.random.Generator
) -> np.ndarray:
    """Draw camera-to-world poses `(N, 4, 4)` at positions `(N, 3)`, of any heading, upright as gravity says.

    gravity: `(3,)` down in the camera's optical frame, known to within `tilt_sigma` radians. The world's z is up.
    """
    n = len(positions)
    tilt = np.concatenate([tilt_sigma * rng.standard_normal((n, 2)), np.zeros((n, 1))], axis=1)
    heading = np.concatenate([np.zeros((n, 2)), rng.uniform(-np.pi, np.pi, (n, 1))], axis=1)
    poses = np.tile(np.eye(4), (n, 1, 1))
    poses[:, :3, :3] = rotation_exp(heading) @ rotation_exp(tilt) @ upright_rotation(gravity)
    poses[:, :3, 3] = positions
    return poses


@functools.lru_cache(maxsize=len(RUNS))
def narrow(run: int) -> list[Round]:
    """Run the filter with this number over the walk out of 101."""
    recording, rng = leaving_101(), np.random.default_rng(10_000 + run)
    particles, rounds = start_anywhere(MAX_PARTICLES, recording.gravity[0], rng), []
    for depth in recording.depths:
        likelihoods = likelihood(coarse(depth), coarse_renderer().render(particles), ALPHA)
        w = weights(normalize_likelihood(likelihoods), BETA)
        rounds.append(Round(particles, w, occupied_bins(optical_pose(particles[resample(w, rng)]), BIN, BIN)))
        n = kld_count(rounds[-1].bins, MIN_PARTICLES, MAX_PARTICLES)
        particles = propagate(particles[resample(w, rng, n=n)], SIGMA, rng)
    return rounds


def shares(rounds: list[Round]) -> np.ndarray:
    """Return the weight `(2, T)` within 1 m of the camera, and within 1 m of its double in 102, in every frame."""
    pairs = zip(rounds, leaving_101().states, strict=True)
    return np.transpose([(distance_to_either(one.particles, true) <= 1.0) @ one.weights for one, true in pairs])
