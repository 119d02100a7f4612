"""The map of the comparison partner: only the large planes of a detailed map, flattened.

Source: Fallon, Johannsson, Leonard, "Efficient Scene Simulation for Robust Monte Carlo Localization using an RGB-D
Camera", ICRA 2012.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import trimesh
from numpy.random import Generator
from scipy import ndimage

from course_lib.rendering.scene_map import SceneMap
from course_lib.simulation.corridor.mesh_building import to_polydata

Plane = tuple[np.ndarray, float]  # unit normal, offset


class _Triangles(NamedTuple):
    """corners `(n, 3, 3)`, centres, unit normals, areas; least_cosine between a normal and its plane's; distance."""

    corners: np.ndarray
    centres: np.ndarray
    normals: np.ndarray
    areas: np.ndarray
    least_cosine: float
    distance: float

    def near(self, index: np.ndarray, plane: Plane) -> np.ndarray:
        """Which of the triangles at `index` support the plane."""
        normal, offset = plane
        near = np.abs(self.centres[index] @ normal - offset) < self.distance
        return near & (np.abs(self.normals[index] @ normal) > self.least_cosine)


def planar_simplification(
    scene_map: SceneMap,
    rng: Generator,
    distance: float = 0.05,
    min_area: float = 1.0,
    max_angle_deg: float = 20.0,
    n_trials: int = 200,
    join: float = 0.3,
    reduction: float = 0.9,
) -> SceneMap:
    """The large planes of a map, each flattened; everything else is dropped.

    Repeated: of n_trials planes, each through a triangle drawn by area, the one with most area in support (triangles
    within `distance` metres and `max_angle_deg`) is refitted to it by least squares. Of its triangles those in regions
    of `min_area` square metres (no gap over `join` metres) are projected onto it and kept, until no plane is so large.
    Last, the share `reduction` of the triangles is decimated away. Raises `ValueError` for a map without such planes.
    Source: Fallon et al. 2012, section III (large planar segments); RANSAC: Fischler and Bolles 1981.
    """
    corners = scene_map.vertices[scene_map.faces]
    crosses = trimesh.triangles.cross(corners)
    areas = trimesh.triangles.area(crosses=crosses)
    least_cosine = np.cos(np.deg2rad(max_angle_deg))
    all_ = _Triangles(corners, corners.mean(axis=1), crosses / (2 * areas[:, None]), areas, least_cosine, distance)
    free = np.arange(len(areas))
    kept: list[np.ndarray] = []
    while areas[free].sum() >= min_area:
        plane = _best_plane(all_, free, n_trials, rng)
        for refits_left in (2, 1, 0):
            support = all_.near(free, plane)
            index = free[support]
            if not refits_left or areas[index].sum() < min_area:
                break
            plane = _fit_plane(corners[index], areas[index], plane[0])
        if areas[index].sum() < min_area:
            break
        free = free[~support]
        regions = _regions(all_.centres[index], join)
        large = np.bincount(regions, weights=areas[index])[regions] >= min_area
        flat = corners[index[large]]
        normal, offset = plane
        kept.append(flat - ((flat @ normal - offset)[..., None] * normal))
    if not sum(len(flat) for flat in kept):
        raise ValueError(f"the map has no plane of {min_area:g} square metres: lower min_area")
    vertices, faces = np.unique(np.concatenate(kept).reshape(-1, 3), axis=0, return_inverse=True)
    # Flattening makes triangles without area; SceneMap drops them.
    planes = SceneMap(vertices, faces.reshape(-1, 3))
    if reduction == 0:
        return planes
    mesh = to_polydata(planes.vertices, planes.faces).decimate(reduction)
    return SceneMap(np.asarray(mesh.points), mesh.regular_faces)


def _best_plane(triangles: _Triangles, free: np.ndarray, n_trials: int, rng: Generator) -> Plane:
    """The plane with most area in support, judged on 5,000 triangles drawn by area, among planes through such."""
    probability = triangles.areas[free] / triangles.areas[free].sum()
    sample = rng.choice(free, size=5000, p=probability)
    best, best_support = None, -1
    for face in rng.choice(free, size=n_trials, p=probability):
        plane = triangles.normals[face], float(triangles.normals[face] @ triangles.centres[face])
        support = int(triangles.near(sample, plane).sum())
        if support > best_support:
            best, best_support = plane, support
    return best


def _fit_plane(corners: np.ndarray, areas: np.ndarray, towards: np.ndarray) -> Plane:
    """Plane of least squared distance to triangles `(n, 3, 3)`, their corners weighted by area."""
    points, weights = corners.reshape(-1, 3), np.repeat(areas, 3)
    centre = np.average(points, axis=0, weights=weights)
    offset = points - centre
    _, vectors = np.linalg.eigh((offset * weights[:, None]).T @ offset)
    normal = vectors[:, 0] * np.sign(vectors[:, 0] @ towards or 1.0)
    return normal, float(normal @ centre)


def _regions(centres: np.ndarray, join: float) -> np.ndarray:
    """Labels `(n,)` of points that hang together on a grid of cells of `join` metres (neighbours: all 26 around)."""
    cells = np.floor(centres / join).astype(np.int64)
    cells -= cells.min(axis=0)
    occupied = np.zeros(cells.max(axis=0) + 1, bool)
    occupied[tuple(cells.T)] = True
    return ndimage.label(occupied, np.ones((3, 3, 3)))[0][tuple(cells.T)]
