"""A plain particle filter that starts anywhere in the hotel and takes as many particles as KLD-sampling asks for."""

import functools
from typing import NamedTuple

import numpy as np

from course_lib.beyond.lost_and_found.adaptive_count import kld_count, occupied_bins
from course_lib.beyond.lost_and_found.free_space import FreeSpace
from course_lib.beyond.lost_and_found.global_search import TILT_SIGMA, upright_poses
from course_lib.depth_mcl import likelihood, normalize_likelihood, propagate, resample, weights
from course_lib.geometry import optical_pose, state_from_optical_pose
from course_lib.lessons.lesson_10.hotel import ALIKE, CAMERA, Recording, boxes_on_the_plan, hotel_map, record, walk
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.sensor import subsample_depth

# All chosen on this world, with seeds from 10,000 up.
COARSE = CAMERA.resized(20, 15)
ALPHA, BETA = 0.3, 0.15  # of eqs (8) and (10): wide, for the nearest of thousands is still decimetres off
SIGMA = np.array([0.12, 0.12, 0.03, 0.01, 0.02, 0.1])  # of eq. (5)
MAX_PARTICLES, MIN_PARTICLES = 3_000, 100
BIN = 0.5  # metres, and as a chord of the direction of view

# From beside the bed of 101 out of the door, and to the left.
OUT_OF_101 = (
    (3.3, 4.2, 200), (3.2, 3.6, 225), (3.05, 3.0, 258), (3.05, 2.2, 268),
    (3.05, 1.4, 262), (2.9, 0.9, 225), (2.6, 0.85, 180), (2.1, 0.85, 180),
)  # fmt: skip
FRAMES = 30
RUNS = range(1, 8)  # a run's seed is 10,000 and its number


class Round(NamedTuple):
    """One frame of a run."""

    particles: np.ndarray
    """`(n, 6)`, as they were weighed."""
    weights: np.ndarray
    """`(n,)`."""
    bins: int
    """How many bins the resampled particles fall into."""

    @property
    def best(self) -> np.ndarray:
        """The heaviest particle `(6,)`."""
        return self.particles[np.argmax(self.weights)]


@functools.cache
def leaving_101() -> Recording:
    """The walk from the bed of 101 into the corridor."""
    return record(walk(OUT_OF_101, FRAMES), seed=10_002)


@functools.cache
def free_space() -> FreeSpace:
    """Where in the hotel a camera can be."""
    return FreeSpace(hotel_map())


def distances_in_32_directions(positions: np.ndarray) -> np.ndarray:
    """How far it is from positions `(N, 3)` to the map, `(N, 32)` metres, `inf` where nothing is hit."""
    return free_space().distances(positions)


def inside_furniture(positions: np.ndarray) -> np.ndarray:
    """Which of positions `(N, 3)` lie inside something that stands in a room."""
    inside = np.zeros(len(positions), dtype=bool)
    for low, high in boxes_on_the_plan()[1]:
        inside |= ((positions > low) & (positions < high)).all(axis=1)
    return inside


def distance_to_either(states: np.ndarray, true: np.ndarray) -> np.ndarray:
    """Distances `(2, N)` on the floor of states `(N, 6)` from the camera and from its double, metres."""
    return np.array([np.hypot(*(states[:, :2] - true[:2] - offset[:2]).T) for offset in (0 * ALIKE, ALIKE)])


@functools.cache
def coarse_renderer() -> DepthRenderer:
    """Draws the map on 20 x 15 pixels."""
    return DepthRenderer(hotel_map(), COARSE)


def coarse(depth: np.ndarray) -> np.ndarray:
    """A depth image of the camera on 20 x 15 pixels."""
    return subsample_depth(depth, CAMERA, COARSE)


def start_anywhere(n: int, gravity: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Particles `(n, 6)` anywhere in the free space, upright as gravity `(3,)` says, of any heading."""
    return state_from_optical_pose(upright_poses(free_space().draw(n, rng), gravity, TILT_SIGMA, rng))


def one_round(particles: np.ndarray, depth: np.ndarray, rng: np.random.Generator) -> tuple[np.ndarray, int, np.ndarray]:
    """Weights of particles, how many bins they fall into once resampled, and the particles of the next frame."""
    likelihoods = likelihood(coarse(depth), coarse_renderer().render(particles), ALPHA)
    w = weights(normalize_likelihood(likelihoods), BETA)
    bins = occupied_bins(optical_pose(particles[resample(w, rng)]), BIN, BIN)
    n = kld_count(bins, MIN_PARTICLES, MAX_PARTICLES)
    return w, bins, propagate(particles[resample(w, rng, n=n)], SIGMA, rng)


@functools.lru_cache(maxsize=len(RUNS))
def narrow(run: int) -> list[Round]:
    """The run of that number over the walk out of 101."""
    recording, rng = leaving_101(), np.random.default_rng(10_000 + run)
    particles, rounds = start_anywhere(MAX_PARTICLES, recording.gravity[0], rng), []
    for depth in recording.depths:
        w, bins, following = one_round(particles, depth, rng)
        rounds.append(Round(particles, w, bins))
        particles = following
    return rounds


def share_near(one: Round, state: np.ndarray, metres: float = 1.0) -> float:
    """Weight of the particles within so many metres of a state, on the floor."""
    return float(one.weights @ (np.hypot(*(one.particles[:, :2] - state[:2]).T) <= metres))


def shares(rounds: list[Round]) -> tuple[np.ndarray, np.ndarray]:
    """Of every frame: the weight near the camera, and near its double in 102."""
    true = leaving_101().states
    doubles = true[:, :3] + ALIKE
    return (
        np.array([share_near(one, state) for one, state in zip(rounds, true, strict=True)]),
        np.array([share_near(one, state) for one, state in zip(rounds, doubles, strict=True)]),
    )
