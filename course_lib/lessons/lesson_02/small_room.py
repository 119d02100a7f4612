"""A small room, its laser survey, its fused maps and how good they are; the corridor's map against its world."""

import functools
from typing import NamedTuple

import numpy as np
import trimesh

from course_lib.experiments.intervals import wilson_percent
from course_lib.geometry import BODY_FROM_OPTICAL, pose_matrix, state_from_optical_pose
from course_lib.lessons.kit.box_world import Box, BoxWorld
from course_lib.lessons.kit.corridor_views import wagon_run
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap
from course_lib.simulation.corridor.mesh_building import to_polydata
from course_lib.simulation.corridor.surface_fusion import FusionModel, fuse, simplify
from course_lib.simulation.sensors.laser_survey import Scan, ScannerModel, survey

SIZE = (5.0, 4.0, 2.5)  # metres, the room's inside from the origin
STATIONS = ((1.0, 1.0), (4.0, 2.6), (1.2, 3.4), (3.2, 0.6))  # x, y [m] of the scanner, in this order
HOLE_DISTANCE = 0.10  # metres: what has no map within it counts as a hole
CAMERA = DepthCamera.from_fov(132, 108, 70, 59)
EYE = np.array([1.2, 2.6, 1.2, 0.0, 0.05, np.deg2rad(8)])  # beside the table, looking past the pillar to the door


@functools.cache
def room(door_open: bool = False) -> BoxWorld:
    """A room of 5 x 4 x 2.5 m with a pillar, a cabinet, a table and a door, and a bit of corridor behind the door."""
    (x, y, z), w = SIZE, 0.2
    paint, wood = 0.72, 0.55
    legs = [(along, across, 0.0) for along in (0.32, 0.84) for across in (1.92, 2.94)]
    leaf = ((4.06, y - 0.9, 0.0), (4.1, y, 2.05)) if door_open else ((3.2, y, 0.0), (4.1, y + 0.05, 2.05))
    return BoxWorld([
        Box((-w, -w, -w), (x + w, y + 2.0, 0.0), 0.4),  # floor
        Box((-w, -w, z), (x + w, y + 2.0, z + w), paint),  # ceiling
        Box((-w, -w, 0.0), (0.0, y + 2.0, z), paint),
        Box((x, -w, 0.0), (x + w, y + 2.0, z), paint),
        Box((0.0, -w, 0.0), (x, 0.0, z), paint),
        Box((0.0, y, 0.0), (3.2, y + w, z), paint),  # the wall with the door
        Box((4.1, y, 0.0), (x, y + w, z), paint),
        Box((3.2, y, 2.05), (4.1, y + w, z), paint),
        Box((-w, y + 1.8, 0.0), (x + w, y + 2.0, z), paint),  # the corridor's far wall
        Box((2.3, 1.7, 0.0), (2.7, 2.1, z), paint),  # pillar
        Box((4.2, 0.0, 0.0), (x, 1.0, 1.8), wood),  # cabinet
        Box((0.3, 1.9, 0.70), (0.9, 3.0, 0.74), wood),  # table top
        *(Box(low, (low[0] + 0.04, low[1] + 0.04, 0.7), wood) for low in legs),
        Box(*leaf, wood),
    ])  # fmt: skip


@functools.lru_cache(maxsize=16)
def scans(
    n_stations: int, noise_mm: float = 1.0, registration_mm: float = 0.0, door_open: bool = False, seed: int = 2
) -> tuple[Scan, ...]:
    """The room scanned from the first stations, with one sigma of range noise and of each station's believed place.

    A row has a ray every 0.75 degrees, so that a survey takes a second (the corridor's rows: 0.15 degrees). Another
    `seed` is another survey.
    """
    model = ScannerModel(
        step_deg=0.75, noise_constant=noise_mm / 1000, noise_per_metre=0.0,
        registration_position=registration_mm / 1000, registration_tilt_deg=0.0, registration_heading_deg=0.0,
    )  # fmt: skip
    return tuple(survey(room(door_open), model, np.random.default_rng(seed), STATIONS[:n_stations]))


def fusion(voxel: float, triangles: int = 10**9) -> FusionModel:
    """How the room's scans are fused: voxels of this size [m], signed distances cut at three of them."""
    pieces = max(4, round(0.1 / voxel**2))  # loose pieces below a tenth of a square metre are removed
    return FusionModel(voxel=voxel, truncation=3 * voxel, slab=8.0, least_component=pieces, triangles=triangles)


@functools.lru_cache(maxsize=12)
def _fused(voxel: float, *survey_day) -> tuple[np.ndarray, np.ndarray]:
    return fuse([scan.as_registered() for scan in scans(*survey_day)], fusion(voxel))


def room_map(
    n_stations: int, noise_mm: float = 1.0, registration_mm: float = 0.0, voxel: float = 0.1, keep: float = 1.0,
    door_open: bool = False, seed: int = 2,
) -> SceneMap:  # fmt: skip
    """Scans of the room (`scans`), fused, and decimated to the share `keep` of the triangles."""
    vertices, faces = _fused(voxel, n_stations, noise_mm, registration_mm, door_open, seed)
    return SceneMap(*simplify(vertices, faces, fusion(voxel, max(20, round(keep * len(faces))))))


class MapQuality(NamedTuple):
    """How good a map of the room is; the distances are from points on the map to the surveyed room."""

    triangles: int
    median: float  # of the distances [m]
    p90: float  # nine in ten distances are below it [m]
    holes: float  # share of what eyes in the room see that has no map within `HOLE_DISTANCE`
    holes_interval: tuple[float, float]  # of 95 %, Wilson's
    false: float  # share of the map's surface that is farther than `HOLE_DISTANCE` from anything in the room


def quality(scene_map: SceneMap, door_open: bool = False) -> MapQuality:
    """Distances from the map to the room as it was on the survey day, and the share of holes."""
    distance, seen = distances(scene_map, door_open), seen_places(door_open)
    mesh = to_polydata(scene_map.vertices, scene_map.faces)
    gaps = np.linalg.norm(seen - mesh.find_closest_cell(seen, return_closest_point=True)[1], axis=1)
    hole, (median, p90) = gaps > HOLE_DISTANCE, np.percentile(distance, [50, 90])
    low, high = wilson_percent(int(hole.sum()), len(hole))
    interval = float(low) / 100, float(high) / 100
    return MapQuality(len(scene_map), median, p90, hole.mean(), interval, (distance > HOLE_DISTANCE).mean())


def distances(scene_map: SceneMap, door_open: bool = False) -> np.ndarray:
    """Distances [m] from 4,000 places on the map, drawn by area, to the nearest surface of the room."""
    corners = scene_map.vertices[scene_map.faces]
    area = trimesh.triangles.area(corners)
    rng = np.random.default_rng(0)
    face = rng.choice(len(area), 4000, p=area / area.sum())
    # Equal chances all over a triangle: Dirichlet shares of its corners.
    return distance_to_room(np.einsum("nk,nkd->nd", rng.dirichlet(np.ones(3), 4000), corners[face]), door_open)


def distance_to_room(points: np.ndarray, door_open: bool = False) -> np.ndarray:
    """Distance [m] of each of points `(n, 3)` to the nearest surface of the room."""
    low, high = room(door_open).low, room(door_open).high
    off = np.maximum(low - points[:, None], points[:, None] - high)  # beyond each box's sides, negative inside
    outside = np.linalg.norm(np.maximum(off, 0), axis=2)
    return np.abs(outside + np.minimum(off.max(axis=2), 0)).min(axis=1)


@functools.cache
def seen_places(door_open: bool) -> np.ndarray:
    """Places `(3000, 3)` on the room's surfaces: what rays in all directions from eyes all over the room meet."""
    rng, n = np.random.default_rng(5), 3000
    eyes = rng.uniform([0.1, 0.1, 0.9], [SIZE[0] - 0.1, SIZE[1] - 0.1, 1.9], (4 * n, 3))
    in_pillar = ((eyes[:, :2] > [2.2, 1.6]) & (eyes[:, :2] < [2.8, 2.2])).all(axis=1)
    in_cabinet = ((eyes[:, :2] > [4.0, -1]) & (eyes[:, :2] < [9, 1.1])).all(axis=1)
    eyes = eyes[~in_pillar & ~in_cabinet]
    directions = rng.normal(size=eyes.shape)
    distance = room(door_open).cast(eyes, directions).distance
    return (eyes + directions * distance[:, None])[np.isfinite(distance)][:n]


def row(found: MapQuality) -> str:
    """The numbers of a map in one line; holes with their 95 % interval."""
    low, high = found.holes_interval
    return (
        f"{found.triangles} triangles; map to room: median {1000 * found.median:.1f} mm, 90 % below "
        f"{1000 * found.p90:.0f} mm; holes {100 * found.holes:.1f} % ({100 * low:.1f} to {100 * high:.1f})"
    )


def camera_view(scene_map: SceneMap) -> np.ndarray:
    """Depth image [m] of a map of the room from `EYE`."""
    with DepthRenderer(scene_map, CAMERA, exact=True) as renderer:
        return renderer.render(EYE)[0]


def true_view(door_open: bool = True) -> np.ndarray:
    """What a perfect camera at `EYE` measures of the room itself."""
    pose = pose_matrix(EYE)
    return room(door_open).cast(pose[:3, 3], CAMERA.rays() @ (pose[:3, :3] @ BODY_FROM_OPTICAL).T).distance


def corridor_difference(scene_map: SceneMap, true_world: SceneMap, frames: range) -> tuple[float, float, float]:
    """Map and true world as a perfect camera sees them on the wagon's path, compared pixel by pixel up to 11 m.

    Returns the share of pixels where the map has a hole, the share where the two differ by more than 10 cm, and the
    median difference [m] of the others.
    """
    recording = wagon_run()
    states = state_from_optical_pose(recording.camera_to_world[frames])
    images = []
    for scene in (scene_map, true_world):
        with DepthRenderer(scene, recording.camera(), exact=True) as renderer:
            images.append(renderer.render(states))
    mapped, true = (image[np.isfinite(images[1])] for image in images)
    difference = np.abs(mapped - true)[np.isfinite(mapped)]
    changed = difference > 0.1
    return np.isinf(mapped).mean(), changed.sum() / len(true), np.median(difference[~changed])
