"""A small room, its laser survey, its fused maps and how good they are; the corridor's map against its world."""

import functools
from collections import namedtuple

import numpy as np
import trimesh

from course_lib.geometry import BODY_FROM_OPTICAL, pose_matrix, state_from_optical_pose
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap
from courseware.experiments.intervals import wilson_percent
from courseware.lessons.kit.box_world import Box, BoxWorld
from courseware.lessons.kit.corridor_data import wagon_run
from courseware.simulation.corridor.mesh_building import to_polydata
from courseware.simulation.corridor.surface_fusion import FusionModel, fuse, simplify
from courseware.simulation.sensors.laser_survey import Scan, ScannerModel, survey

STATIONS = ((1.0, 1.0), (4.0, 2.6), (1.2, 3.4), (3.2, 0.6))  # x, y [m] of the scanner, in this order
HOLE_DISTANCE = 0.10  # metres: a place that has no map within it is a hole
CAMERA = DepthCamera.from_fov(132, 108, 70, 59)
EYE = np.array([1.2, 2.6, 1.2, 0.0, 0.05, np.deg2rad(8)])  # beside the table, looking past the pillar to the door


@functools.cache
def room(door_open: bool = False) -> BoxWorld:
    """Return a room of 5 x 4 x 2.5 m with a pillar, a cabinet, a table and a door, and a bit of corridor behind it."""
    (x, y, z), w = (5.0, 4.0, 2.5), 0.2
    leaf = ((4.06, y - 0.9, 0.0), (4.1, y, 2.05)) if door_open else ((3.2, y, 0.0), (4.1, y + 0.05, 2.05))
    legs = [((a, b, 0.0), (a + 0.04, b + 0.04, 0.7)) for a in (0.32, 0.84) for b in (1.92, 2.94)]
    cabinet, table_top = ((4.2, 0.0, 0.0), (x, 1.0, 1.8)), ((0.3, 1.9, 0.70), (0.9, 3.0, 0.74))
    painted = [
        ((-w, -w, z), (x + w, y + 2.0, z + w)),  # ceiling
        ((-w, -w, 0.0), (0.0, y + 2.0, z)), ((x, -w, 0.0), (x + w, y + 2.0, z)), ((0.0, -w, 0.0), (x, 0.0, z)),  # walls
        ((0.0, y, 0.0), (3.2, y + w, z)), ((4.1, y, 0.0), (x, y + w, z)), ((3.2, y, 2.05), (4.1, y + w, z)),  # door's
        ((-w, y + 1.8, 0.0), (x + w, y + 2.0, z)),  # the corridor's far wall
        ((2.3, 1.7, 0.0), (2.7, 2.1, z)),  # pillar
    ]  # fmt: skip
    boxes = [Box((-w, -w, -w), (x + w, y + 2.0, 0.0), 0.4), *(Box(*corners, 0.72) for corners in painted)]
    return BoxWorld(boxes + [Box(*corners, 0.55) for corners in (cabinet, table_top, *legs, leaf)])


@functools.lru_cache(maxsize=16)
def scans(
    n_stations: int, noise_mm: float = 1.0, registration_mm: float = 0.0, door_open: bool = False, seed: int = 2
) -> tuple[Scan, ...]:
    """Scan the room from the first stations, with one sigma of range noise and of each station's believed place.

    A row has a ray every 0.75 degrees, so that a survey takes a second (the corridor's rows: 0.15 degrees).
    """
    model = ScannerModel(
        step_deg=0.75, noise_constant=noise_mm / 1000, noise_per_metre=0.0,
        registration_position=registration_mm / 1000, registration_tilt_deg=0.0, registration_heading_deg=0.0,
    )  # fmt: skip
    return tuple(survey(room(door_open), model, np.random.default_rng(seed), STATIONS[:n_stations]))


def fusion(voxel: float, triangles: int = 10**9) -> FusionModel:
    """Return how we fuse the room's scans: voxels of this size [m], signed distances cut at three of them."""
    pieces = max(4, round(0.1 / voxel**2))  # we remove loose pieces below a tenth of a square metre
    return FusionModel(voxel=voxel, truncation=3 * voxel, slab=8.0, least_component=pieces, triangles=triangles)


@functools.lru_cache(maxsize=12)
def _fused(voxel: float, n_stations: int, **day) -> tuple[np.ndarray, np.ndarray]:
    return fuse([scan.as_registered() for scan in scans(n_stations, **day)], fusion(voxel))


def room_map(n_stations: int, voxel: float = 0.1, keep: float = 1.0, **day) -> SceneMap:
    """Fuse `scans(n_stations, **day)` of the room, and keep this share of the triangles."""
    vertices, faces = _fused(voxel, n_stations, **day)
    return SceneMap(*simplify(vertices, faces, fusion(voxel, max(20, round(keep * len(faces))))))


# median and p90: of the distances from the map to the room [m]. holes: share of what eyes in the room see that has no
# map within `HOLE_DISTANCE`, with its 95 % interval. false: share of the map that is farther than it from the room.
MapQuality = namedtuple("MapQuality", "triangles median p90 holes holes_interval false")


def quality(scene_map: SceneMap, door_open: bool = False) -> MapQuality:
    """Compare a map with the room as it was on the survey day."""
    distance, seen = distances(scene_map, door_open), seen_places(door_open)
    mesh = to_polydata(scene_map.vertices, scene_map.faces)
    gaps = np.linalg.norm(seen - mesh.find_closest_cell(seen, return_closest_point=True)[1], axis=1)
    hole, false = gaps > HOLE_DISTANCE, (distance > HOLE_DISTANCE).mean()
    interval = tuple(percent / 100 for percent in wilson_percent(int(hole.sum()), len(hole)))
    return MapQuality(len(scene_map), *np.percentile(distance, [50, 90]), hole.mean(), interval, false)


def distances(scene_map: SceneMap, door_open: bool = False) -> np.ndarray:
    """Return the distances [m] from 4,000 places on the map, drawn by area, to the nearest surface of the room."""
    corners = scene_map.vertices[scene_map.faces]
    area = trimesh.triangles.area(corners)
    rng = np.random.default_rng(0)
    face = rng.choice(len(area), 4000, p=area / area.sum())
    # Dirichlet shares of its corners give equal chances all over a triangle.
    return distance_to_room(np.einsum("nk,nkd->nd", rng.dirichlet(np.ones(3), 4000), corners[face]), door_open)


def distance_to_room(points: np.ndarray, door_open: bool = False) -> np.ndarray:
    """Return the distance [m] of each of points `(n, 3)` to the nearest surface of the room."""
    low, high = room(door_open).low, room(door_open).high
    off = np.maximum(low - points[:, None], points[:, None] - high)  # beyond each box's sides, negative inside
    outside = np.linalg.norm(np.maximum(off, 0), axis=2)
    return np.abs(outside + np.minimum(off.max(axis=2), 0)).min(axis=1)


@functools.cache
def seen_places(door_open: bool) -> np.ndarray:
    """Return places `(3000, 3)` on the room's surfaces that rays from eyes all over the room meet."""
    rng = np.random.default_rng(5)
    eyes = rng.uniform([0.1, 0.1, 0.9], [4.9, 3.9, 1.9], (12_000, 3))
    for low, high in (((2.2, 1.6), (2.8, 2.2)), ((4.0, -1.0), (9.0, 1.1))):  # not in the pillar, not in the cabinet
        eyes = eyes[~((eyes[:, :2] > low) & (eyes[:, :2] < high)).all(axis=1)]
    directions = rng.normal(size=eyes.shape)
    distance = room(door_open).cast(eyes, directions).distance
    return (eyes + directions * distance[:, None])[np.isfinite(distance)][:3000]


def row(found: MapQuality) -> str:
    """Return the numbers of a map in one line; holes with their 95 % interval."""
    low, high = found.holes_interval
    return (
        f"{found.triangles} triangles; map to room: median {1000 * found.median:.1f} mm, 90 % below "
        f"{1000 * found.p90:.0f} mm; holes {100 * found.holes:.1f} % ({100 * low:.1f} to {100 * high:.1f})"
    )


def camera_view(scene_map: SceneMap) -> np.ndarray:
    """Return the depth image [m] of a map of the room from `EYE`."""
    with DepthRenderer(scene_map, CAMERA, exact=True) as renderer:
        return renderer.render(EYE)[0]


def true_view(door_open: bool = True) -> np.ndarray:
    """Return what a perfect camera at `EYE` measures of the room itself."""
    pose = pose_matrix(EYE)
    return room(door_open).cast(pose[:3, 3], CAMERA.rays() @ (pose[:3, :3] @ BODY_FROM_OPTICAL).T).distance


def corridor_difference(scene_map: SceneMap, true_world: SceneMap, frames: range) -> tuple[float, float, float]:
    """Compare map and true world pixel by pixel up to 11 m, as a perfect camera sees them on the wagon's path.

    Return the share of pixels where the map has a hole, the share where the two differ by more than 10 cm, and the
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
