"""The map of the comparison partner: only the large planes of a detailed map, flattened.

Source: Fallon, Johannsson, Leonard, "Efficient Scene Simulation for Robust Monte Carlo Localization using an RGB-D
Camera", ICRA 2012.
"""

import numpy as np
import trimesh
from numpy.random import Generator
from scipy import ndimage

from course_lib.rendering.scene_map import SceneMap
from courseware.simulation.corridor.mesh_building import to_polydata

MIN_COSINE = np.cos(np.deg2rad(20.0))  # between a triangle's normal and its plane's
N_TRIALS = 200  # planes, each through a triangle drawn by area
JOIN = 0.3  # m: widest gap within one region of a plane

Plane = tuple[np.ndarray, float]  # unit normal, offset


def planar_simplification(
    scene_map: SceneMap, rng: Generator, distance: float = 0.05, min_area: float = 1.0, reduction: float = 0.9
) -> SceneMap:
    """The large planes of a map, each flattened; everything else is dropped.

    Repeated until no plane is so large: of the trial planes the one with most area in support (triangles within
    `distance` metres, of a like direction) is refitted by least squares, and its regions of `min_area` square metres
    are projected onto it. Last, the share `reduction` of the triangles is decimated away.
    Source: Fallon et al. 2012, section III (large planar segments); RANSAC: Fischler and Bolles 1981.
    """
    corners = scene_map.vertices[scene_map.faces]
    crosses, centres = trimesh.triangles.cross(corners), corners.mean(axis=1)
    areas = trimesh.triangles.area(crosses=crosses)
    normals = crosses / (2 * areas[:, None])

    def supports(index: np.ndarray, plane: Plane) -> np.ndarray:
        """Which of the triangles at `index` support the plane."""
        near = np.abs(centres[index] @ plane[0] - plane[1]) < distance
        return near & (np.abs(normals[index] @ plane[0]) > MIN_COSINE)

    free = np.arange(len(areas))
    kept: list[np.ndarray] = []
    while areas[free].sum() >= min_area:
        # The plane with most area in support, judged on 5,000 triangles drawn by area.
        probability = areas[free] / areas[free].sum()
        sample = rng.choice(free, size=5000, p=probability)
        faces = rng.choice(free, size=N_TRIALS, p=probability)
        planes = [(normals[face], float(normals[face] @ centres[face])) for face in faces]
        plane = max(planes, key=lambda one: supports(sample, one).sum())
        for refits_left in (2, 1, 0):
            support = supports(free, plane)
            index = free[support]
            if not refits_left or areas[index].sum() < min_area:
                break
            plane = _fit_plane(corners[index], areas[index], plane[0])
        if areas[index].sum() < min_area:
            break
        free = free[~support]
        regions = _regions(centres[index])
        flat = corners[index[np.bincount(regions, weights=areas[index])[regions] >= min_area]]
        normal, offset = plane
        kept.append(flat - ((flat @ normal - offset)[..., None] * normal))
    if not sum(map(len, kept)):
        raise ValueError(f"the map has no plane of {min_area:g} square metres: lower min_area")
    vertices, faces = np.unique(np.concatenate(kept).reshape(-1, 3), axis=0, return_inverse=True)
    # Flattening makes triangles without area; SceneMap drops them.
    planes = SceneMap(vertices, faces.reshape(-1, 3))
    if reduction == 0:
        return planes
    mesh = to_polydata(planes.vertices, planes.faces).decimate(reduction)
    return SceneMap(np.asarray(mesh.points), mesh.regular_faces)


def _fit_plane(corners: np.ndarray, areas: np.ndarray, towards: np.ndarray) -> Plane:
    """Plane of least squared distance to triangles `(n, 3, 3)`, their corners weighted by area."""
    points, weights = corners.reshape(-1, 3), np.repeat(areas, 3)
    centre = np.average(points, axis=0, weights=weights)
    offset = points - centre
    _, vectors = np.linalg.eigh((offset * weights[:, None]).T @ offset)
    normal = vectors[:, 0] * np.sign(vectors[:, 0] @ towards or 1.0)
    return normal, float(normal @ centre)


def _regions(centres: np.ndarray) -> np.ndarray:
    """Labels `(n,)` of points that hang together on a grid of cells of JOIN metres (neighbours: all 26 around)."""
    cells = np.floor(centres / JOIN).astype(np.int64)
    cells -= cells.min(axis=0)
    occupied = np.zeros(cells.max(axis=0) + 1, bool)
    occupied[tuple(cells.T)] = True
    return ndimage.label(occupied, np.ones((3, 3, 3)))[0][tuple(cells.T)]
