"""Fewer triangles that look the same to a depth camera: what `DepthRenderer` draws unless it is told `exact=True`.

Triangles are merged (VTK's quadric decimation, after Garland and Heckbert, "Surface simplification using quadric error
metrics", 1997) until 99 of 100 vertices of the map lie just within a tolerance of what is left. What was found is kept
in the user's cache, since it takes seconds.
"""

import contextlib
import hashlib
import io
import os
import warnings
from functools import lru_cache
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_DOUBLE, mutable, vtkPoints, vtkVersion
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData, vtkStaticCellLocator
from vtkmodules.vtkFiltersCore import vtkQuadricDecimation, vtkStaticCleanPolyData

from course_lib.files import atomic_write
from course_lib.rendering.scene_map import SceneMap

# Metres. A pixel that is off by so much still counts seven eighths in the likelihood (alpha = 0.1 m).
TOLERANCE = 0.015
WITHIN_PERCENT = 99
# A smaller map is drawn as it is: there is nothing to gain.
MIN_TRIANGLES = 20_000
# Quadric errors (square metres, weighed by areas) at which the merging of edges stops, one after the other.
_QUADRIC_ERRORS = (1e-8, 1e-7, 3e-7, 6e-7, 1e-6, 2e-6, 4e-6, 8e-6, 2e-5, 5e-5)
_CHECKED_VERTICES = 20_000
# Below, nobody waits long enough to be told why; a million took 16 s on one core of a server.
QUICK_TRIANGLES = 300_000
_SECONDS_A_TRIANGLE = 16e-6
_MIN_SHARE = 0.01  # of the triangles: VTK wants a number


class LargeMapWarning(UserWarning):
    """A map so large that its simplification, which happens once, makes one wait."""


@lru_cache(maxsize=4)
def simplified(scene_map: SceneMap, tolerance: float = TOLERANCE) -> SceneMap:
    """Return the map with fewer triangles: 99 % of its vertices lie within `tolerance` metres of them.

    A small map comes back as it is. Warns (`LargeMapWarning`) before a wait of many seconds.
    """
    if not (np.isfinite(tolerance) and tolerance > 0):
        raise ValueError(f"tolerance must be a positive number of metres; got {tolerance}")
    if len(scene_map) < MIN_TRIANGLES:
        return scene_map
    path = _cache_path(scene_map, tolerance)
    found = _read(path)
    if found is None:
        if len(scene_map) > QUICK_TRIANGLES:
            seconds = len(scene_map) * _SECONDS_A_TRIANGLE
            warnings.warn(
                f"simplifying a map of {len(scene_map):,} triangles takes about {seconds:.0f} s, once: what is found "
                f"is kept in {path.parent}. exact=True (--exact) draws every triangle, and each frame takes longer",
                LargeMapWarning,
                stacklevel=2,
            )
        found = _simplify(scene_map, tolerance)
        _keep(path, found)
    return found


def _simplify(scene_map: SceneMap, tolerance: float) -> SceneMap:
    left = _welded(scene_map)
    stride = max(1, len(scene_map.vertices) // _CHECKED_VERTICES)
    checked = (scene_map.vertices - scene_map.origin)[np.unique(scene_map.faces)[::stride]]
    for error in _QUADRIC_ERRORS:
        decimation = vtkQuadricDecimation()
        decimation.SetInputData(left)
        decimation.SetTargetReduction(1 - _MIN_SHARE)
        decimation.SetMaximumError(error)
        decimation.Update()
        fewer = decimation.GetOutput()
        if not fewer.GetNumberOfCells() or np.percentile(_distances(checked, fewer), WITHIN_PERCENT) > tolerance:
            break
        left = fewer
    vertices = vtk_to_numpy(left.GetPoints().GetData()) + scene_map.origin
    return SceneMap(vertices, vtk_to_numpy(left.GetPolys().GetConnectivityArray()).reshape(-1, 3).astype(np.int32))


def _welded(scene_map: SceneMap) -> vtkPolyData:
    """The map about its origin, as VTK's; corners at one place are one, or triangles would be torn apart."""
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
    """Distances `(N,)` in metres from points `(N, 3)` to a mesh."""
    locator = vtkStaticCellLocator()
    locator.SetDataSet(mesh)
    locator.BuildLocator()
    squares, closest, cell, part, square = np.empty(len(points)), [0.0] * 3, mutable(0), mutable(0), mutable(0.0)
    for i, point in enumerate(points):
        locator.FindClosestPoint(point, closest, cell, part, square)
        squares[i] = square.get()
    return np.sqrt(squares)


def _cache_path(scene_map: SceneMap, tolerance: float) -> Path:
    """Where the simplified map is kept: a name for this map, this tolerance, this VTK and this file's constants."""
    digest = hashlib.blake2b(digest_size=16)
    for part in (scene_map.vertices, scene_map.faces):
        digest.update(np.ascontiguousarray(part))
    told = (tolerance, WITHIN_PERCENT, _QUADRIC_ERRORS, vtkVersion.GetVTKVersion())
    digest.update(repr(told).encode())
    home = os.environ.get("XDG_CACHE_HOME") or os.environ.get("LOCALAPPDATA") or "~/.cache"
    return Path(home).expanduser() / "course_lib" / "simplified_maps" / f"{digest.hexdigest()}.npz"


def _read(path: Path) -> SceneMap | None:
    """The map that is kept there; None where there is none, or none that can be read."""
    try:
        with np.load(path) as kept:
            return SceneMap(kept["vertices"], kept["faces"])
    except Exception:  # damaged in whatever way: it is made again
        return None


def _keep(path: Path, found: SceneMap) -> None:
    """Writes the map, whole or not at all; where nothing can be written, the next process makes it again."""
    with contextlib.suppress(OSError):
        path.parent.mkdir(parents=True, exist_ok=True)
        packed = io.BytesIO()
        np.savez(packed, vertices=found.vertices, faces=found.faces)
        atomic_write(path, packed.getvalue())
