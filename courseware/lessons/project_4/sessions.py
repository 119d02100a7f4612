"""What the owner of project P4's camera has: raw frames of a wall at taped distances, and of a room.

Every seed is another camera: unit, code of "no measurement", focal length, range error, pattern and noise are its own.
"""

import dataclasses
from functools import cache
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from course_lib.depth_mcl import DepthCamera
from course_lib.geometry import BODY_FROM_OPTICAL, pose_matrix
from courseware.lessons.kit.box_world import Box, BoxWorld
from courseware.lessons.kit.display import described
from courseware.plots import figures
from courseware.simulation.sensors.time_of_flight import TimeOfFlightCamera, TimeOfFlightModel

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

    walls: np.ndarray  # (K, M, H, W) uint16, M raw frames of a wall met squarely, at each of K distances
    distances: np.ndarray  # (K,) metres from the camera to the wall, along the optical axis, by tape
    intrinsics: np.ndarray  # (3, 3), the matrix K of the data sheet: its focal length is another camera's
    frames: np.ndarray  # (V, M, H, W) uint16, M raw frames from each of V places in a room, the camera at rest


class Secrets(NamedTuple):
    """What the user does not know."""

    units: float  # raw numbers a metre of range
    invalid: int  # the raw number of a pixel without measurement
    focal: float  # pixels
    model: TimeOfFlightModel
    pattern: np.ndarray  # (H, W) metres of range, each pixel's own error
    depth: np.ndarray  # (V, H, W) metres, the true depths of the room, inf = nothing there


@cache
def session(seed: int) -> tuple[Session, Secrets]:
    """Return the session of a seed's camera, and its secrets."""
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

    def raw(world: BoxWorld, state: np.ndarray, count: int) -> np.ndarray:
        ranges = np.stack([instrument.capture(world, state, noise_rng).range for _ in range(count)])
        lost = np.isnan(ranges) | dead | (noise_rng.random(ranges.shape) < 0.005)
        numbers = np.clip(np.round(np.where(lost, 0.0, ranges) * units), 0, 65_535)
        return np.where(lost, invalid, numbers).astype(np.uint16)

    a_wall = [BoxWorld([Box((d, -20.0, -20.0), (d + 0.1, 20.0, 20.0), 0.8)]) for d in WALLS]
    walls = np.stack([raw(world, np.zeros(6), WALL_FRAMES) for world in a_wall])
    room = _room(room_rng)
    frames, depth = [], []
    for _ in range(VIEWS):
        state = np.array([0.3, room_rng.uniform(-0.5, 0.5), 1.2, 0.0, 0.0, np.deg2rad(room_rng.uniform(-25, 25))])
        frames.append(raw(room, state, ROOM_FRAMES))
        rays = camera.rays() @ (pose_matrix(state)[:3, :3] @ BODY_FROM_OPTICAL).T  # their forward component is one
        depth.append(room.cast(state[:3], rays).distance.astype(np.float64))
    distances = WALLS + TAPE_SIGMA * secrets_rng.standard_normal(len(WALLS))
    given = Session(walls, distances, _pinhole(told).matrix, np.stack(frames))
    return given, Secrets(units, invalid, focal, model, instrument.pattern, np.stack(depth))


def _pinhole(focal: float) -> DepthCamera:
    return DepthCamera(WIDTH, HEIGHT, focal, focal, (WIDTH - 1) / 2, (HEIGHT - 1) / 2, near=0.1, far=20.0)


def _room(rng: np.random.Generator) -> BoxWorld:
    """Draw a room with things of all kinds in it, two poles among them, and dark ones."""
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
        size = rng.uniform(0.2, 0.8), rng.uniform(0.4, 2.2)
        wide, high = (0.07, 2.6) if index < 2 else size  # the first two are poles
        boxes.append(Box((x, y, 0.0), (x + wide, y + wide, high), float(rng.choice((0.15, 0.5, 0.8)))))
    return BoxWorld(boxes)


def room_figure(given: Session, secrets: Secrets) -> Figure:
    """Draw one raw frame from each place, in the unit that only the secrets tell, so that all seeds look alike."""
    first = [np.where(place[0] == secrets.invalid, np.nan, place[0] / secrets.units) for place in given.frames]
    figure, axes = figures.new_figure(1, len(first), size=(9.4, 2.3))
    for number, (a, shown) in enumerate(zip(axes, first, strict=True)):
        drawn = figures.depth_image(a, shown, f"place {number}", (0.0, 9.0))
    for a in axes[1:]:
        a.set_ylabel("v [pixels]")
    figures.colour_bar(figure, drawn, axes, "range as read [m]")
    alt = "Four range images of a room with boxes and poles, some pixels missing, blurred seams at the edges of things."
    return described(figure, alt)
