"""A time-of-flight camera whose faults are switched on one by one, and recorded frames beside their truth."""

import dataclasses
from collections.abc import Set

import numpy as np
from scipy.spatial import cKDTree

from course_lib.depth_mcl.sequence import DepthSequence
from course_lib.geometry import BODY_FROM_OPTICAL, state_from_optical_pose
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap
from courseware.lessons.kit.box_world import Box, BoxWorld
from courseware.paths import data_path
from courseware.simulation.sensors.time_of_flight import TimeOfFlightCamera, TimeOfFlightModel

MODEL = TimeOfFlightModel()
# Each fault of the camera: how the panel names it, and the parameters of `TimeOfFlightModel` that switch it off.
FAULTS: dict[str, tuple[str, dict[str, float]]] = {
    "noise": ("noise", {"shot_noise": 0, "dark_noise": 0}),
    "mixing": ("mixing: a pixel has an area, not one ray", {"sub_rays": 1}),
    "systematic": ("systematic: offset, wiggling, a pattern of the pixels",
                   {"offset": 0, "wiggling": 0, "fixed_pattern": 0}),
    "scattering": ("scattering: light strays inside the camera", {"scattered_share": 0}),
    "drop_outs": ("drop-outs: too little or too much light gives no measurement",
                  {"least_amplitude": 1e-9, "greatest_amplitude": np.inf}),
    "wrapping": ("wrapping: ranges repeat after c / 2f", {}),  # `capture` adds the lost multiples of c / 2f
}  # fmt: skip
CORRIDOR = BoxWorld(
    [
        Box((-1.0, -1.5, -0.2), (12.0, 1.5, 0.0), 0.38),  # floor
        Box((-1.0, -1.5, 2.6), (12.0, 1.5, 2.8), 0.78),  # ceiling
        Box((-1.0, 1.5, -0.2), (12.0, 1.7, 2.8), 0.72),  # left wall
        Box((-1.0, -1.7, -0.2), (12.0, -1.5, 2.8), 0.72),  # right wall
        Box((12.0, 0.2, 0.0), (12.2, 1.5, 2.6), 0.85),  # end wall, left of the door
        Box((12.0, -0.6, 0.0), (12.2, 0.2, 2.1), 0.15),  # dark door
        Box((12.0, -0.6, 2.1), (12.2, 0.2, 2.6), 0.85),  # above it
        Box((12.0, -1.5, 0.0), (12.2, -0.6, 1.0), 0.85),  # below the open window
        Box((12.0, -1.5, 1.9), (12.2, -0.6, 2.6), 0.85),  # above it
        Box((2.5, 0.28, 0.0), (2.56, 0.34, 2.6), 0.6),  # pole
        Box((4.0, -1.0, 0.0), (4.5, -0.4, 0.8), 0.06),  # crate of rubber
        Box((5.0, 0.7, 0.0), (5.3, 1.1, 2.6), 0.72),  # pillar
        Box((4.99, 0.7, 1.25), (5.0, 1.1, 1.4), 50.0),  # its retroreflective band
    ]
)
EYE_HEIGHT = 1.2  # metres


def capture(x: float, faults: Set[str], camera: DepthCamera, frequency: float = MODEL.frequency) -> tuple:
    """Return measured depth, true depth `(H, W)` [m] and the `Frame`, from (x, 0, 1.2 m), with these faults alone.

    NaN is no measurement, inf is nothing there. Without "wrapping" we add the lost multiple of c / 2f.
    """
    changes = {key: value for name, (_, off) in FAULTS.items() if name not in faults for key, value in off.items()}
    # The model gives the width of the scattered light in pixels of the full image.
    width = MODEL.scatter_width * camera.width / DepthCamera.sr4000().width
    model = dataclasses.replace(MODEL, frequency=frequency, scatter_width=width, **changes)
    tof, state = TimeOfFlightCamera(camera, model, np.random.default_rng(0)), np.array([x, 0, EYE_HEIGHT, 0, 0, 0])
    frame, rays = tof.capture(CORRIDOR, state, np.random.default_rng(1)), camera.rays()
    depth, repeats = frame.depth.astype(np.float64), model.unambiguous_range
    if "wrapping" not in faults:
        lost = np.round((frame.nearest - frame.range) / repeats) * repeats / np.linalg.norm(rays, axis=-1)
        depth += np.where(np.isfinite(lost), lost, 0)
    return depth, CORRIDOR.cast(state[:3], rays @ BODY_FROM_OPTICAL.T).distance, frame


def returns(x: float, camera: DepthCamera) -> tuple[np.ndarray, np.ndarray]:
    """Return range along the ray [m] and reflectivity times cosine, `(H, W)` each, at the pixels' centres."""
    rays = camera.rays() @ BODY_FROM_OPTICAL.T
    hits = CORRIDOR.cast(np.array([x, 0, EYE_HEIGHT]), rays / np.linalg.norm(rays, axis=-1, keepdims=True))
    return hits.distance.astype(np.float64), np.where(hits.face >= 0, CORRIDOR.reflectivity[hits.face] * hits.cosine, 0)


def wall_frames(distance: float, n_frames: int, camera: DepthCamera, seed: int = 0) -> np.ndarray:
    """Return `(n, H, W)` depth images [m] of a white wall across the view, by one camera with all its faults."""
    rng = np.random.default_rng(seed)
    tof, wall = TimeOfFlightCamera(camera, MODEL, rng), Box((distance, -9.0, -9.0), (distance + 0.1, 9.0, 9.0), 0.72)
    world = BoxWorld([wall])
    return np.stack([tof.capture(world, np.zeros(6), rng).depth for _ in range(n_frames)])


def true_depths(recording: DepthSequence, camera: DepthCamera, frames: range) -> np.ndarray:
    """Return `(n, H, W)` true depths [m] of recorded frames: the corridor as it was, with its people."""
    world = SceneMap.load(data_path("corridor/true_world.ply"))  # no filter ever sees it
    with DepthRenderer(world, camera.with_clip_planes(0.1, 40.0), exact=True) as renderer:
        return renderer.render(state_from_optical_pose(recording.camera_to_world[list(frames)]))


def kinds_of(measured: np.ndarray, true: np.ndarray) -> dict[str, np.ndarray]:
    """Return a mask of the pixels for each kind of error. Wrapped pixels are about one whole c / 2f too near."""
    error, repeats = measured - true, MODEL.unambiguous_range
    off = np.abs(error)
    kinds = {"no measurement": np.isnan(measured), "within 5 cm": off <= 0.05}
    kinds |= {"5 to 30 cm off": (off > 0.05) & (off <= 0.3), "wrapped": np.abs(error + repeats) < 0.1 * repeats}
    return kinds | {"other, mostly edges": ~np.any(list(kinds.values()), axis=0)}


def on_a_surface(points: np.ndarray, true: np.ndarray, camera: DepthCamera) -> float:
    """Return the share of points `(n, 3)` (optical frame, metres) within 0.1 m of a point that is truly seen."""
    surface = camera.points(np.where(np.isfinite(true), true, np.nan)).reshape(-1, 3)
    distances, _ = cKDTree(surface[np.isfinite(surface).all(axis=1)]).query(points)
    return float(np.mean(distances <= 0.1))
