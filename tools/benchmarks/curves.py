"""Time of a step against particles, pixels and triangles, and the figure of it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkQuadricDecimation

from course_lib.geometry import optical_pose
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap
from course_lib.rendering.simplification import _welded
from tools.benchmarks.growth import finer_survey
from tools.benchmarks.side_by_side import IMAGE, N_PARTICLES, Scene, open3d_embree, timed_step

PARTICLES = (25, 50, 100, 200, 400, 800, 1600)
IMAGES = ((44, 36), (88, 72), (176, 144), (352, 288))
TRIANGLES = (5_000, 15_000, 40_000)
LABELS = {"particles": "particles", "pixels": "pixels of an image", "triangles": "triangles of the map"}
STYLES = {
    "default": ("our whole step", "tab:blue", "o-"),
    "exact": ("our whole step, every triangle drawn", "tab:cyan", "s--"),
    "embree": ("Embree (Open3D), ray casting alone", "tab:orange", "^-"),
}

Point = dict[str, float]


def curves(scene: Scene, repeats: int, note: Callable[[str], None]) -> dict[str, list[Point]]:
    """Milliseconds, medians over frames, with the other two quantities as in the paper's experiment."""
    maps = [*(decimated(scene.scene_map, n) for n in TRIANGLES), scene.scene_map, finer_survey(scene.scene_map)]
    usual = scene.scene_map
    asked = [("particles", n, (usual, IMAGE, n)) for n in PARTICLES]
    asked += [("pixels", image[0] * image[1], (usual, image, N_PARTICLES)) for image in IMAGES]
    asked += [("triangles", len(scene_map), (scene_map, IMAGE, N_PARTICLES)) for scene_map in maps]
    found: dict[str, list[Point]] = {}
    for quantity, x, given in asked:
        note(f"curve of {quantity}: {x}")
        found.setdefault(quantity, []).append({"x": x} | _point(scene, *given, repeats))
    return found


def _point(scene: Scene, scene_map: SceneMap, image: tuple[int, int], n: int, repeats: int) -> Point:
    camera = scene.sequence.camera().resized(*image)
    frames = np.linspace(1, len(scene.sequence) - 1, repeats).astype(int)
    seconds: dict[str, list[float]] = {"default": [], "exact": []}
    try:
        cast = open3d_embree(scene_map, camera)
        seconds["embree"] = []
    except ImportError:
        cast = None
    renderers = {exact: DepthRenderer(scene_map, camera, exact=exact) for exact in (False, True)}
    for frame in [frames[0], *frames]:
        took, particles = timed_step(scene, renderers[False], int(frame), n)
        seconds["default"].append(took)
        seconds["exact"].append(timed_step(scene, renderers[True], int(frame), n)[0])
        if cast:
            seconds["embree"].append(cast(optical_pose(particles)).seconds)
    return {f"{name}_ms": 1000 * float(np.median(values[1:])) for name, values in seconds.items()}


def decimated(scene_map: SceneMap, triangles: int) -> SceneMap:
    """A coarser map of the same building."""
    decimation = vtkQuadricDecimation()
    decimation.SetInputData(_welded(scene_map))
    decimation.SetTargetReduction(1 - triangles / len(scene_map))
    decimation.Update()
    mesh = decimation.GetOutput()
    faces = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3).astype(np.int32)
    return SceneMap(vtk_to_numpy(mesh.GetPoints().GetData()) + scene_map.origin, faces)


def draw(found: dict[str, list[Point]], path: Path) -> None:
    """Three panels, both axes logarithmic."""
    figure = Figure(figsize=(13, 4.2), layout="constrained")
    axes = figure.subplots(1, 3, sharey=True)
    for axis, (quantity, points) in zip(axes, found.items(), strict=True):
        for name, (label, colour, style) in STYLES.items():
            shown = [(point["x"], point[f"{name}_ms"]) for point in points if f"{name}_ms" in point]
            if shown:
                axis.loglog(*zip(*shown, strict=True), style, color=colour, label=label, markersize=5)
        axis.axhline(125, color="0.5", linewidth=1)
        axis.set_xlabel(LABELS[quantity])
        axis.grid(True, which="major", alpha=0.3)
        axis.xaxis.set_major_formatter("{x:,.0f}")
        axis.yaxis.set_major_formatter("{x:,.0f}")
    # Above the line where no curve runs.
    right = {"xy": (0.98, 130), "xycoords": ("axes fraction", "data"), "ha": "right"}
    axes[2].annotate("the paper: 125 ms on a GPU", **right, fontsize=8, color="0.4")
    axes[0].set_ylabel("time [ms]")
    figure.suptitle("One quantity changes, the others stay at 200 particles, 176 x 144 pixels and the shipped map")
    axes[0].legend(loc="lower right", fontsize=8)
    figure.savefig(path, dpi=110)
