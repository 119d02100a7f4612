"""What the owner of project P4's camera has: raw frames of a wall at taped distances, and of a room.

Every seed is another camera: unit, code of "no measurement", focal length, range error, pattern and noise are its own.
"""

import dataclasses
from functools import cache
from typing import NamedTuple

import numpy as np

from course_lib.depth_mcl import DepthCamera
from course_lib.lessons.kit.box_world import Box, BoxWorld
from course_lib.simulation.sensors.ray_casting import Hits
from course_lib.simulation.sensors.time_of_flight import TimeOfFlightCamera, TimeOfFlightModel

WIDTH, HEIGHT = 64, 52
REPEAT = TimeOfFlightModel().unambiguous_range  # m, c / 2f: the one number of the data sheet that is right
WALLS = np.array([0.9, 1.3, 1.8, 2.4, 3.1, 3.9, 4.8, 5.8, 6.9, 8.1])  # m
WALL_FRAMES, ROOM_FRAMES, VIEWS = 8, 8, 4
TAPE_SIGMA = 0.002  # m
MAX_RANGE = 9.0  # m, surfaces beyond it are not scored
UNITS = (500, 1000, 2000, 4000, 5000, 6000)  # per metre
CODES = (0, 1, 32_001, 65_000, 65_535)


class Session(NamedTuple):
    """All that a user of the camera has."""

    walls: np.ndarray
    """`(K, M, H, W)` uint16, M raw frames of a wall met squarely, at each of K distances"""
    distances: np.ndarray
    """`(K,)` metres from the camera to the wall, along the optical axis, by tape"""
    intrinsics: np.ndarray
    """`(3, 3)` the matrix K of the data sheet: its focal length is another camera's"""
    frames: np.ndarray
    """`(V, M, H, W)` uint16, M raw frames from each of V places in a room, the camera at rest"""


class Secrets(NamedTuple):
    """What the user does not know."""

    units: float
    """raw numbers a metre of range"""
    invalid: int
    """the raw number of a pixel without measurement"""
    focal: float
    """pixels"""
    model: TimeOfFlightModel
    pattern: np.ndarray
    """`(H, W)` metres of range, each pixel's own error"""
    depth: np.ndarray
    """`(V, H, W)` metres, the true depths of the room, inf = nothing there"""


class _Remembered:
    """A world that keeps what it answered last: the camera stands still, its rays are the same frame for frame."""

    def __init__(self, boxes: list[Box]) -> None:
        self._world = BoxWorld(boxes)
        self.reflectivity = self._world.reflectivity
        self._last: tuple[tuple, Hits] | None = None

    def cast(self, origins: np.ndarray, directions: np.ndarray) -> Hits:
        key = (tuple(np.ravel(origins)), directions.shape, float(directions.ravel()[0]))
        if self._last is None or self._last[0] != key:
            self._last = key, self._world.cast(origins, directions)
        return self._last[1]


@cache
def session(seed: int) -> tuple[Session, Secrets]:
    """The session of a seed's camera, and its secrets."""
    secrets_rng, room_rng, noise_rng, pattern_rng = np.random.default_rng([seed, 4]).spawn(4)
    focal = float(secrets_rng.uniform(72, 88))
    told = focal * (1 + secrets_rng.choice((-1, 1)) * secrets_rng.uniform(0.05, 0.12))
    model = dataclasses.replace(
        TimeOfFlightModel(),
        offset=float(secrets_rng.choice((-1, 1)) * secrets_rng.uniform(0.02, 0.06)),
        wiggling=float(secrets_rng.uniform(0.015, 0.040)),
        fixed_pattern=float(secrets_rng.uniform(0.004, 0.012)),
        shot_noise=float(secrets_rng.uniform(0.004, 0.006)),
        scatter_width=15.0,
    )
    units, invalid = float(secrets_rng.choice(UNITS)), int(secrets_rng.choice(CODES))
    dead = secrets_rng.random((HEIGHT, WIDTH)) < 0.01
    camera = _pinhole(focal)
    instrument = TimeOfFlightCamera(camera, model, pattern_rng)

    def raw(world: _Remembered, state: np.ndarray, count: int) -> np.ndarray:
        ranges = np.stack([instrument.capture(world, state, noise_rng).range for _ in range(count)])
        lost = np.isnan(ranges) | dead | (noise_rng.random(ranges.shape) < 0.005)
        numbers = np.clip(np.round(np.where(lost, 0.0, ranges) * units), 0, 65_535)
        return np.where(lost, invalid, numbers).astype(np.uint16)

    walls = np.stack([raw(_Remembered([_wall(d)]), np.zeros(6), WALL_FRAMES) for d in WALLS])
    room = _Remembered(_room(room_rng))
    frames, depth = [], []
    for _ in range(VIEWS):
        state = np.array([0.3, room_rng.uniform(-0.5, 0.5), 1.2, 0.0, 0.0, np.deg2rad(room_rng.uniform(-25, 25))])
        frames.append(raw(room, state, ROOM_FRAMES))
        depth.append(_true_depth(room, camera, state))
    distances = WALLS + TAPE_SIGMA * secrets_rng.standard_normal(len(WALLS))
    given = Session(walls, distances, _pinhole(told).matrix, np.stack(frames))
    return given, Secrets(units, invalid, focal, model, instrument.pattern, np.stack(depth))


def _pinhole(focal: float) -> DepthCamera:
    return DepthCamera(WIDTH, HEIGHT, focal, focal, (WIDTH - 1) / 2, (HEIGHT - 1) / 2, near=0.1, far=20.0)


def _wall(distance: float) -> Box:
    return Box((distance, -20.0, -20.0), (distance + 0.1, 20.0, 20.0), 0.8)


def _room(rng: np.random.Generator) -> list[Box]:
    """A room with things of all kinds in it, a pole among them, and a dark one."""
    length, half = rng.uniform(6.0, 8.5), rng.uniform(1.6, 2.6)
    boxes = [
        Box((-1.0, -half, -0.2), (length, half, 0.0), 0.4),
        Box((-1.0, -half, 2.6), (length, half, 2.8), 0.8),
        Box((-1.0, half, -0.2), (length, half + 0.2, 2.8), 0.7),
        Box((-1.0, -half - 0.2, -0.2), (length, -half, 2.8), 0.7),
        Box((length, -half - 0.2, -0.2), (length + 0.2, half + 0.2, 2.8), 0.8),
    ]
    for index in range(9):
        x, y = rng.uniform(1.6, length - 0.8), rng.uniform(-half, half - 0.3)
        wide, high = rng.uniform(0.2, 0.8), rng.uniform(0.4, 2.2)
        if index < 2:  # a pole
            wide, high = 0.07, 2.6
        boxes.append(Box((x, y, 0.0), (x + wide, y + wide, high), float(rng.choice((0.15, 0.5, 0.8)))))
    return boxes


def _true_depth(world: _Remembered, camera: DepthCamera, state: np.ndarray) -> np.ndarray:
    """Depth `(H, W)` on the rays through the pixels' centres, whose forward component is one."""
    optical = camera.rays()
    body = np.stack([optical[..., 2], -optical[..., 0], -optical[..., 1]], axis=-1)
    cosine, sine = np.cos(state[5]), np.sin(state[5])
    turned = np.stack(
        [cosine * body[..., 0] - sine * body[..., 1], sine * body[..., 0] + cosine * body[..., 1], body[..., 2]],
        axis=-1,
    )
    return world.cast(state[:3], turned).distance.astype(np.float64)
