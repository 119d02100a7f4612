"""A scene of boxes before a time-of-flight camera whose faults are switched on one by one."""

import dataclasses
import functools
from typing import NamedTuple

import numpy as np

from course_lib.lessons.kit.box_world import Box, BoxWorld
from course_lib.rendering.camera import DepthCamera
from course_lib.simulation.sensors.time_of_flight import Frame, TimeOfFlightCamera, TimeOfFlightModel

MODEL = TimeOfFlightModel()
# Each fault of the camera, and the parameters of `TimeOfFlightModel` that switch it off.
FAULTS: dict[str, dict[str, float]] = {
    "noise": {"shot_noise": 0.0, "dark_noise": 0.0},
    "mixing": {"sub_rays": 1},
    "systematic": {"offset": 0.0, "wiggling": 0.0, "fixed_pattern": 0.0},
    "scattering": {"scattered_share": 0.0},
    "drop_outs": {"least_amplitude": 1e-9, "greatest_amplitude": np.inf},
    "wrapping": {},  # no parameter: `capture` adds the lost multiples of c / 2f
}
LENGTH = 12.0  # metres from the origin to the scene's end wall
EYE_HEIGHT = 1.2  # metres


class Capture(NamedTuple):
    """One frame of the simulated camera beside the truth."""

    depth: np.ndarray
    """`(H, W)` [m] along the optical axis, NaN = no measurement"""
    true: np.ndarray
    """`(H, W)` [m] depth on the ray through each pixel's centre, inf = nothing there"""
    frame: Frame
    """what the camera reports: ranges, amplitudes, and the ranges of what each pixel sees"""


def model(faults: set[str] | frozenset[str], frequency: float = MODEL.frequency) -> TimeOfFlightModel:
    """The camera with these faults alone (names of `FAULTS`), modulated at `frequency` hertz."""
    changes = {key: value for name, off in FAULTS.items() if name not in faults for key, value in off.items()}
    return dataclasses.replace(MODEL, frequency=frequency, **changes)


QUIET = model(frozenset())  # the camera without any fault; its ranges still repeat


@functools.cache
def scene() -> BoxWorld:
    """A corridor of 12 m: pole, crate of rubber, reflecting band, an end wall with an open window and a dark door."""
    side, end = 1.5, LENGTH
    return BoxWorld(
        [
            Box((-1.0, -side, -0.2), (end, side, 0.0), 0.38),  # floor
            Box((-1.0, -side, 2.6), (end, side, 2.8), 0.78),  # ceiling
            Box((-1.0, side, -0.2), (end, side + 0.2, 2.8), 0.72),  # left wall
            Box((-1.0, -side - 0.2, -0.2), (end, -side, 2.8), 0.72),  # right wall
            Box((end, 0.2, 0.0), (end + 0.2, side, 2.6), 0.85),  # end wall, left of the door
            Box((end, -0.6, 0.0), (end + 0.2, 0.2, 2.1), 0.15),  # dark door
            Box((end, -0.6, 2.1), (end + 0.2, 0.2, 2.6), 0.85),  # above it
            Box((end, -side, 0.0), (end + 0.2, -0.6, 1.0), 0.85),  # below the open window
            Box((end, -side, 1.9), (end + 0.2, -0.6, 2.6), 0.85),  # above it
            Box((2.5, 0.28, 0.0), (2.56, 0.34, 2.6), 0.6),  # pole
            Box((4.0, -1.0, 0.0), (4.5, -0.4, 0.8), 0.06),  # crate of rubber
            Box((5.0, 0.7, 0.0), (5.3, 1.1, 2.6), 0.72),  # pillar
            Box((4.99, 0.7, 1.25), (5.0, 1.1, 1.4), 50.0),  # its retroreflective band
        ]
    )


@functools.lru_cache(maxsize=64)
def _truth(x: float, camera: DepthCamera) -> np.ndarray:
    """Depth `(H, W)` [m] of the scene on the rays through the pixels' centres, from (x, 0, EYE_HEIGHT)."""
    eye, directions = np.array([x, 0, EYE_HEIGHT]), _in_world(camera.rays())
    return scene().cast(eye, directions).distance


def _in_world(optical: np.ndarray) -> np.ndarray:
    """Directions in the world of a level camera that looks along +x: optical z, -x, -y."""
    return np.stack([optical[..., 2], -optical[..., 0], -optical[..., 1]], axis=-1)


class _Remembered:
    """The scene, which keeps what it answered to the last few cameras: a fault that is switched moves no ray."""

    def __init__(self) -> None:
        self.reflectivity = scene().reflectivity
        self._answers: dict[tuple, object] = {}

    def cast(self, origins: np.ndarray, directions: np.ndarray):
        key = (tuple(np.round(origins, 6)), directions.shape)
        if key not in self._answers:
            if len(self._answers) >= 8:
                self._answers.pop(next(iter(self._answers)))
            self._answers[key] = scene().cast(origins, directions)
        return self._answers[key]


_remembered = functools.cache(_Remembered)


@functools.lru_cache(maxsize=16)
def _camera(camera: DepthCamera, tof: TimeOfFlightModel, seed: int) -> TimeOfFlightCamera:
    return TimeOfFlightCamera(camera, tof, np.random.default_rng(seed))


def capture(
    x: float,
    faults: set[str] | frozenset[str] = frozenset(FAULTS),
    camera: DepthCamera | None = None,
    frequency: float = MODEL.frequency,
    seed: int = 0,
) -> Capture:
    """A frame of the scene from (x, 0, 1.2 m), looking along +x, with these faults of the camera alone.

    Without "wrapping" the multiple of c / 2f that the camera cannot know is added: as if it measured with two
    frequencies.
    """
    camera = camera or DepthCamera.sr4000()
    tof = model(faults, frequency)
    # The width of the scattered light is told in the pixels of the full image.
    tof = dataclasses.replace(tof, scatter_width=MODEL.scatter_width * camera.width / DepthCamera.sr4000().width)
    state = np.array([x, 0, EYE_HEIGHT, 0, 0, 0])
    frame = _camera(camera, tof, seed).capture(_remembered(), state, np.random.default_rng(seed + 1))
    depth = frame.depth.astype(np.float64)
    if "wrapping" not in faults:
        seen = np.isfinite(frame.nearest)
        turns = np.round((np.where(seen, frame.nearest, frame.range) - frame.range) / tof.unambiguous_range)
        depth += turns * tof.unambiguous_range / np.linalg.norm(camera.rays(), axis=-1)
    return Capture(depth, _truth(x, camera), frame)


def returns(x: float, camera: DepthCamera) -> tuple[np.ndarray, np.ndarray]:
    """Range along the ray [m] and reflectivity times cosine of incidence, `(H, W)` each, at the pixels' centres."""
    rays = _in_world(camera.rays())
    hits = scene().cast(np.array([x, 0, EYE_HEIGHT]), rays / np.linalg.norm(rays, axis=-1, keepdims=True))
    return hits.distance.astype(np.float64), np.where(hits.face >= 0, scene().reflectivity[hits.face] * hits.cosine, 0)


def wall(distance: float, reflectivity: float = 0.72, edge: float = -9.0) -> Box:
    """A wall across the view, `distance` metres ahead, from y = `edge` to the left."""
    return Box((distance, edge, -9.0), (distance + 0.1, 9.0, 9.0), reflectivity)


def frames_of(boxes: list[Box], n_frames: int, camera: DepthCamera, seed: int = 0) -> np.ndarray:
    """`(n, H, W)` depth images [m] of a few boxes by one camera with all its faults, at the origin, looking along x."""
    rng = np.random.default_rng(seed)
    tof, world = TimeOfFlightCamera(camera, MODEL, rng), BoxWorld(boxes)
    return np.stack([tof.capture(world, np.zeros(6), rng).depth for _ in range(n_frames)])
