"""Find fewer triangles that look the same to a depth camera. `DepthRenderer` renders them unless `exact=True`.

VTK merges triangles as long as 99 of 100 vertices of the map are within a tolerance of the remaining triangles (after
Garland and Heckbert, "Surface simplification using quadric error metrics", 1997). joblib keeps the result.
"""

import contextlib
import os
from functools import lru_cache
from pathlib import Path

import numpy as np
from joblib import Memory
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_DOUBLE, mutable, vtkPoints, vtkVersion
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData, vtkStaticCellLocator
from vtkmodules.vtkFiltersCore import vtkQuadricDecimation, vtkStaticCleanPolyData

from course_lib.rendering.scene_map import SceneMap

TOLERANCE = 0.015  # metres: chosen with alpha = 0.1 m, where a pixel with this error still counts seven eighths
WITHIN_PERCENT = 99  # of the vertices lie within the tolerance: a stray one must not stop the merging
MIN_TRIANGLES = 20_000  # a smaller map is rendered as it is, because it is fast already
# Quadric errors (square metres, weighted by areas) up to which edges are merged: each in turn, until one is too much.
_QUADRIC_ERRORS = (1e-8, 1e-7, 3e-7, 6e-7, 1e-6, 2e-6, 4e-6, 8e-6, 2e-5, 5e-5)
_CHECKED_VERTICES = 20_000  # at most, evenly spread, because each is checked in a Python loop


@lru_cache(maxsize=4)
def simplified(scene_map: SceneMap) -> SceneMap:
    """Return the map with fewer triangles; 99 % of its vertices lie within `TOLERANCE` of them.

    A small map is returned as it is. A million triangles take 16 s, but only once, because the user's cache keeps the
    result.
    """
    if len(scene_map) < MIN_TRIANGLES:
        return scene_map
    home = os.environ.get("XDG_CACHE_HOME") or os.environ.get("LOCALAPPDATA") or "~/.cache"
    simplify = _simplify
    with contextlib.suppress(OSError):  # where nothing can be written, the next process simplifies again
        simplify = Memory(Path(home).expanduser() / "course_lib", verbose=0).cache(_simplify)
    return simplify(scene_map, TOLERANCE, WITHIN_PERCENT, _QUADRIC_ERRORS, vtkVersion.GetVTKVersion())


def _simplify(
    scene_map: SceneMap, tolerance: float, within_percent: int, quadric_errors: tuple[float, ...], vtk_version: str
) -> SceneMap:
    """Merge more and more edges, as long as the map stays within the tolerance (all arguments name what is kept)."""
    left = _welded(scene_map)
    stride = max(1, len(scene_map.vertices) // _CHECKED_VERTICES)
    checked = (scene_map.vertices - scene_map.origin)[np.unique(scene_map.faces)[::stride]]
    for error in quadric_errors:
        decimation = vtkQuadricDecimation()
        decimation.SetInputData(left)
        decimation.SetTargetReduction(0.99)  # VTK wants a share to leave out; the error decides
        decimation.SetMaximumError(error)
        decimation.Update()
        fewer = decimation.GetOutput()
        if not fewer.GetNumberOfCells() or np.percentile(_distances(checked, fewer), within_percent) > tolerance:
            break
        left = fewer
    vertices = vtk_to_numpy(left.GetPoints().GetData()) + scene_map.origin
    return SceneMap(vertices, vtk_to_numpy(left.GetPolys().GetConnectivityArray()).reshape(-1, 3).astype(np.int32))


def _welded(scene_map: SceneMap) -> vtkPolyData:
    """Return the map about its origin for VTK. Corners that meet become one vertex, or the merging would open gaps."""
    points, cells = vtkPoints(), vtkCellArray()
    points.SetData(numpy_to_vtk(scene_map.vertices - scene_map.origin, deep=True, array_type=VTK_DOUBLE))
    cells.SetData(3, numpy_to_vtkIdTypeArray(scene_map.faces.astype(np.int64).ravel(), deep=True))
    mesh = vtkPolyData()
    mesh.SetPoints(points)
    mesh.SetPolys(cells)
    weld = vtkStaticCleanPolyData()
    weld.SetInputData(mesh)
    weld.ToleranceIsAbsoluteOn()
    weld.SetAbsoluteTolerance(0.0)
    weld.Update()
    return weld.GetOutput()


def _distances(points: np.ndarray, mesh: vtkPolyData) -> np.ndarray:
    """Return distances `(N,)` in metres from points `(N, 3)` to a mesh."""
    locator = vtkStaticCellLocator()
    locator.SetDataSet(mesh)
    locator.BuildLocator()
    squares, closest, cell, part, square = np.empty(len(points)), [0.0] * 3, mutable(0), mutable(0), mutable(0.0)
    for i, point in enumerate(points):
        locator.FindClosestPoint(point, closest, cell, part, square)
        squares[i] = square.get()
    return np.sqrt(squares)
