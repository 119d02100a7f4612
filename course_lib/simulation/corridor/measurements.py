"""What is measured on the generated data, for its README and its tests: map error, holes, the camera's noise."""

from __future__ import annotations

import numpy as np
import trimesh
from numpy.random import Generator

from course_lib.rendering.camera import DepthCamera
from course_lib.simulation.corridor.mesh_building import WorldMesh, to_polydata
from course_lib.simulation.sensors.ray_casting import WorldCaster
from course_lib.simulation.sensors.time_of_flight import Frame, TimeOfFlightCamera, TimeOfFlightModel


def map_error(
    map_vertices: np.ndarray, map_faces: np.ndarray, world: WorldMesh, rng: Generator, n_points: int = 50_000
) -> dict[str, float]:
    """Distance in metres from points drawn on the map, by area, to the surface of the surveyed world."""
    corners = map_vertices[map_faces].astype(np.float64)
    areas = trimesh.triangles.area(corners)
    face = rng.choice(len(areas), n_points, p=areas / areas.sum())
    u, v = np.sort(rng.random((2, n_points)), axis=0)
    points = np.einsum("nk,nkd->nd", np.stack([u, v - u, 1 - v], axis=1), corners[face])
    nearest = to_polydata(world.vertices, world.faces).find_closest_cell(points, return_closest_point=True)[1]
    distance = np.linalg.norm(points - nearest, axis=1)
    return {
        "median_m": float(np.median(distance)),
        "p90_m": float(np.percentile(distance, 90)),
        "mean_m": float(distance.mean()),
        "area_m2": float(areas.sum()),
    }


def hole_share(
    map_vertices: np.ndarray,
    map_faces: np.ndarray,
    surveyed: WorldCaster,
    length: float,
    rng: Generator,
    n_rays: int = 100_000,
) -> float:
    """Share of the surveyed world, as eyes all along the corridor of `length` metres see it, with no map within 5 cm.

    Rays in all directions from places at most 0.6 m beside the middle, 0.4 to 2.0 m above the floor; what they meet of
    the survey day's world counts as mapped where the map lies within 0.05 m.
    """
    eyes = rng.uniform([1.0, -0.6, 0.4], [length - 1.0, 0.6, 2.0], (n_rays, 3))
    directions = rng.normal(size=(n_rays, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    distance = surveyed.cast(eyes, directions).distance
    hit = np.isfinite(distance)
    points = eyes[hit] + directions[hit] * distance[hit][:, None]
    nearest = to_polydata(map_vertices, map_faces).find_closest_cell(points, return_closest_point=True)[1]
    return float((np.linalg.norm(points - nearest, axis=1) > 0.05).mean())


def frame_counts(frame: Frame, model: TimeOfFlightModel) -> dict[str, float]:
    """Counts of pixels of one frame: all, without return, saturated, beyond the unambiguous range (all, and those that
    came back wrapped), flying.

    Flying: the pixel sees two surfaces more than 0.1 m apart, and reads a range between them, more than 5 cm and three
    times the noise away from both.
    """
    measured = np.isfinite(frame.depth)
    limit = model.unambiguous_range
    beyond = (frame.nearest > limit) & np.isfinite(frame.nearest)
    amplitude = np.maximum(frame.amplitude, 1e-9)
    noise_phase = np.sqrt(model.shot_noise**2 * amplitude + model.dark_noise**2) / amplitude
    margin = np.maximum(0.05, 3 * noise_phase * limit / (2 * np.pi))
    edge = measured & (frame.farthest - frame.nearest > 0.1) & (frame.farthest < limit)
    between = (frame.range > frame.nearest + margin) & (frame.range < frame.farthest - margin)
    return {
        "pixels": frame.depth.size,
        "no_return": int((~measured).sum()),
        "nothing_there": int(np.isinf(frame.nearest).sum()),
        "saturated": int((frame.amplitude > model.greatest_amplitude).sum()),
        "beyond_range": int(beyond.sum()),
        "wrapped": int((beyond & measured).sum()),
        "flying": int((edge & between).sum()),
    }


def noise_on_a_wall(model: TimeOfFlightModel, distance: float, rng: Generator, reflectivity: float = 0.72) -> float:
    """Standard deviation in metres over 50 frames of the central pixels' depth of a wall met squarely at `distance`.

    nan where fewer than nine in ten of the pixels come back.
    """
    half = 5.0
    vertices = np.array([[distance, y, z] for y in (-half, half) for z in (-half, half)])
    wall = WorldCaster(vertices, np.array([[0, 1, 2], [1, 3, 2]]), reflectivity)
    camera = TimeOfFlightCamera(DepthCamera.sr4000().resized(44, 36), model, rng)
    depths = np.stack([camera.capture(wall, np.zeros(6), rng).depth for _ in range(50)])[:, 14:22, 18:26]
    if np.isfinite(depths).mean() < 0.9:
        return float("nan")
    return float(np.sqrt(np.nanmean(np.nanvar(depths, axis=0))))
