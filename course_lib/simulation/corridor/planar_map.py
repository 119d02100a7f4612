"""The map of the comparison partner: only the large planes of a detailed map, flattened.

Fallon, Johannsson, Leonard, "Efficient Scene Simulation for Robust Monte Carlo Localization using an RGB-D Camera",
ICRA 2012, localize in a low-fidelity model of large planar segments (walls, ceilings, floors). Here it is made from
the detailed map by sequential RANSAC over its triangles, each counted by its area.
"""

from __future__ import annotations

import numpy as np
import trimesh
from numpy.random import Generator
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from course_lib.rendering.scene_map import SceneMap


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

    Repeated: draw n_trials planes, each through a triangle drawn by area; a plane's support is the area of the
    triangles within `distance` metres of it whose normals lie within `max_angle_deg` of its own; the best plane is
    refitted to its support by area-weighted least squares. Its triangles are split into regions (no gap over `join`
    metres between their middles); regions of at least `min_area` square metres are projected onto the plane and kept.
    The search ends when the best plane has less than `min_area`. Last, the share `reduction` of the triangles is
    decimated away (by quadric errors, which are zero within a plane).
    Raises `ValueError` for parameters that are not positive, a reduction outside [0, 1), or a map without any plane so
    large.
    Source: Fallon et al. 2012, section III (large planar segments); RANSAC: Fischler and Bolles 1981.
    """
    for name, value in (("distance", distance), ("min_area", min_area), ("join", join), ("n_trials", n_trials)):
        if not value > 0:
            raise ValueError(f"{name} must be positive; got {value!r}")
    if not 0 <= reduction < 1:
        raise ValueError(f"reduction must lie in [0, 1); got {reduction!r}")
    corners = scene_map.vertices[scene_map.faces]
    crosses = trimesh.triangles.cross(corners)
    areas = trimesh.triangles.area(crosses=crosses)
    normals = crosses / (2 * areas[:, None])
    centres = corners.mean(axis=1)
    least_cosine = np.cos(np.deg2rad(max_angle_deg))
    free = np.ones(len(areas), dtype=bool)
    kept: list[np.ndarray] = []
    while free.any() and areas[free].sum() >= min_area:
        normal, offset = _best_plane(centres, normals, areas, free, distance, least_cosine, n_trials, rng)
        for _ in range(2):
            support = _support(centres, normals, free, normal, offset, distance, least_cosine)
            if areas[support].sum() < min_area:
                break
            normal, offset = _fit_plane(corners[support], areas[support], normal)
        support = _support(centres, normals, free, normal, offset, distance, least_cosine)
        if areas[support].sum() < min_area:
            break
        free[support] = False
        index = np.flatnonzero(support)
        regions = _regions(centres[index], join)
        large = np.bincount(regions, weights=areas[index])[regions] >= min_area
        flat = corners[index[large]]
        kept.append(flat - ((flat @ normal - offset)[..., None] * normal))
    if not sum(len(flat) for flat in kept):
        raise ValueError(f"the map has no plane of {min_area:g} square metres: lower min_area")
    vertices, faces = np.unique(np.concatenate(kept).reshape(-1, 3), axis=0, return_inverse=True)
    return _decimated(vertices, faces.reshape(-1, 3), reduction)


def _best_plane(
    centres: np.ndarray,
    normals: np.ndarray,
    areas: np.ndarray,
    free: np.ndarray,
    distance: float,
    least_cosine: float,
    n_trials: int,
    rng: Generator,
) -> tuple[np.ndarray, float]:
    """The plane (unit normal, offset) with most area in support among planes through triangles drawn by area.

    Trials are judged on at most 5,000 triangles, drawn by area: the number of them in support is the area's estimate.
    """
    index = np.flatnonzero(free)
    probability = areas[index] / areas[index].sum()
    sample = rng.choice(index, size=5000, p=probability)
    best, best_support = (normals[sample[0]], 0.0), -1
    for face in rng.choice(index, size=n_trials, p=probability):
        offset = float(normals[face] @ centres[face])
        near = np.abs(centres[sample] @ normals[face] - offset) < distance
        support = int((near & (np.abs(normals[sample] @ normals[face]) > least_cosine)).sum())
        if support > best_support:
            best, best_support = (normals[face], offset), support
    return best


def _support(
    centres: np.ndarray,
    normals: np.ndarray,
    free: np.ndarray,
    normal: np.ndarray,
    offset: float,
    distance: float,
    least_cosine: float,
) -> np.ndarray:
    near = np.abs(centres @ normal - offset) < distance
    return free & near & (np.abs(normals @ normal) > least_cosine)


def _fit_plane(corners: np.ndarray, areas: np.ndarray, towards: np.ndarray) -> tuple[np.ndarray, float]:
    """Plane of least squared distance to triangles `(n, 3, 3)`, their corners weighted by area."""
    points, weights = corners.reshape(-1, 3), np.repeat(areas, 3)
    centre = np.average(points, axis=0, weights=weights)
    offset = points - centre
    _, vectors = np.linalg.eigh((offset * weights[:, None]).T @ offset)
    normal = vectors[:, 0] * np.sign(vectors[:, 0] @ towards or 1.0)
    return normal, float(normal @ centre)


def _decimated(vertices: np.ndarray, faces: np.ndarray, reduction: float) -> SceneMap:
    """The map with the share `reduction` of its triangles decimated away (VTK's quadric decimation)."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    from vtkmodules.vtkFiltersCore import vtkQuadricDecimation

    # Flattening makes triangles without area; SceneMap drops them.
    flat = SceneMap(vertices, faces)
    if reduction == 0:
        return flat
    points, cells, mesh = vtkPoints(), vtkCellArray(), vtkPolyData()
    points.SetData(numpy_to_vtk(flat.vertices.copy(), deep=True))
    cells.SetData(3, numpy_to_vtkIdTypeArray(flat.faces.astype(np.int64).ravel(), deep=True))
    mesh.SetPoints(points)
    mesh.SetPolys(cells)
    decimation = vtkQuadricDecimation()
    decimation.SetInputData(mesh)
    decimation.SetTargetReduction(reduction)
    decimation.Update()
    result = decimation.GetOutput()
    triangles = vtk_to_numpy(result.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    return SceneMap(vtk_to_numpy(result.GetPoints().GetData()), triangles)


def _regions(centres: np.ndarray, join: float) -> np.ndarray:
    """Labels `(n,)` of points that hang together on a grid of cells of `join` metres (neighbours: all 26 around)."""
    cells, cell_of = np.unique(np.floor(centres / join).astype(np.int64), axis=0, return_inverse=True)
    cell_of = cell_of.ravel()
    lookup = {tuple(cell): i for i, cell in enumerate(cells)}
    steps = [(i, j, k) for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1) if (i, j, k) > (0, 0, 0)]
    pairs = [
        (here, lookup[near])
        for here, cell in enumerate(cells.tolist())
        for step in steps
        if (near := tuple(c + s for c, s in zip(cell, step, strict=True))) in lookup
    ]
    rows, columns = np.array(pairs, dtype=np.int64).reshape(-1, 2).T
    graph = coo_matrix((np.ones(len(rows)), (rows, columns)), shape=(len(cells), len(cells)))
    return connected_components(graph, directed=False)[1][cell_of]
