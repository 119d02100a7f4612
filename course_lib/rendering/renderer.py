"""GPU scene simulation (paper 1, 3.3.1): what a depth camera would measure at every particle's pose.

"vtk" draws the map once per particle, as tiles of one off-screen window, and reads OpenGL's z-buffer back once.
"raster" fills a z-buffer in compiled loops. "ray" shoots one ray through every pixel centre: the reference. Threads may
share a renderer. A forked child may use an inherited one, unless it is "vtk". A pickled one opens at its first use.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Literal

import numpy as np

from course_lib.geometry import as_states, is_rotation, optical_pose
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.chunks import cut_large_triangles
from course_lib.rendering.errors import OpenGLError, RendererClosedError
from course_lib.rendering.raster import RasterBackend
from course_lib.rendering.ray import RayBackend
from course_lib.rendering.scene_map import SceneMap
from course_lib.rendering.sensor import depth_image_from_points, measured_points

MAX_BATCH_PIXELS = 200 * 176 * 144  # of one off-screen window: 200 images of the SR4000, 80 MB with colour and depth
# Files in /dev that show a graphics card on Linux: most drivers', NVIDIA's, and Windows' (WSL).
CARDS = ("dri/renderD*", "nvidia[0-9]*", "dxg")
# Parts of the names under which OpenGL draws on the processor: Mesa's, Apple's, Microsoft's and Google's.
SOFTWARE = ("llvmpipe", "softpipe", "swrast", "software", "gdi generic", "basic render", "swiftshader")

Backend = Literal["auto", "vtk", "raster", "ray"]


@cache  # so that a process decides once
def chosen_backend(backend: Backend) -> Backend:
    """Return `backend`, or what "auto" means on this computer: "vtk" on a graphics card, else "raster"."""
    if backend != "auto":
        return backend
    if sys.platform.startswith("linux") and not any(any(Path("/dev").glob(card)) for card in CARDS):
        return "raster"
    triangle, camera = SceneMap(np.eye(3), np.array([[0, 1, 2]])), DepthCamera(8, 8, 8.0, 8.0, 3.5, 3.5)
    try:
        with DepthRenderer(triangle, camera, "vtk") as trial:
            name = trial.describe().lower()
    except Exception:
        return "raster"
    return "raster" if any(word in name for word in SOFTWARE) else "vtk"


class DepthRenderer:
    """Draws depth images of a map from any number of poses; a context manager.

    backend: "vtk" (OpenGL's z-buffer), "raster" (a compiled z-buffer), "ray" (the reference), or "auto": "vtk" on a
    graphics card, else "raster"; the attribute `backend` says which. exact: draw every triangle; else a large map is
    drawn with fewer triangles, which lie within centimetres of it. max_batch_pixels: bounds the memory of a batch.
    Raises `OpenGLError` where OpenGL cannot start, `ValueError` for a bad backend, `RendererClosedError` after `close`.
    """

    def __init__(
        self,
        scene_map: SceneMap,
        camera: DepthCamera,
        backend: Backend = "auto",
        *,
        exact: bool = False,
        max_batch_pixels: int = MAX_BATCH_PIXELS,
    ) -> None:
        self.scene_map = scene_map
        self.camera = camera
        self.backend = chosen_backend(backend)
        self.exact = exact
        self.batch_size = max(1, int(max_batch_pixels) // (camera.width * camera.height))
        self._closed = False
        try:
            self._open_backend = self._new_backend()
        except (OpenGLError, ValueError):
            if backend != "auto" or self.backend == "raster":
                raise
            self.backend = "raster"
            self._open_backend = self._new_backend()

    def _new_backend(self) -> object:
        if self.backend == "vtk":
            from course_lib.rendering.vtk_backend import VtkBackend  # only here, because it needs OpenGL's libraries

            return VtkBackend(self.map_to_draw(), self.camera, self.batch_size)
        if self.backend not in ("raster", "ray"):
            raise ValueError(f"backend must be 'auto', 'vtk', 'raster' or 'ray'; got {self.backend!r}")
        return {"raster": RasterBackend, "ray": RayBackend}[self.backend](self.map_to_draw(), self.camera)

    def map_to_draw(self) -> SceneMap:
        """Return the map that a backend renders: with fewer triangles unless `exact`, and with none that is large.

        The first time in a process this takes up to 16 s for a large map; the user's cache keeps the result.
        """
        drawn = self.scene_map
        if not self.exact:
            from course_lib.rendering.simplification import simplified  # only here, because it loads VTK

            drawn = simplified(drawn)
        vertices, faces = cut_large_triangles(drawn.vertices, drawn.faces)
        return drawn if faces is drawn.faces else SceneMap(vertices, faces)

    def render(self, states: np.ndarray) -> np.ndarray:
        """Return depth images `(N, H, W)` float32 metres of the map from states `(N, 6)`; `inf` where nothing is hit.

        Z_(i) = {z_(i)^1, ..., z_(i)^m}: one value a pixel, m = H x W as many as the real camera has.
        A single state `(6,)` counts as N = 1. Raises `ValueError` for states of a wrong shape or not finite.
        Source: paper 1, eq. (6).
        """
        return self.render_poses(optical_pose(np.atleast_2d(as_states(states))))

    def batches(self, states: np.ndarray) -> Iterator[np.ndarray]:
        """Yield the same images a batch `(n, H, W)` at a time, for more particles than images fit into memory."""
        states = np.atleast_2d(states)
        for start in range(0, len(states), self.batch_size):
            yield self.render(states[start : start + self.batch_size])

    def render_poses(self, camera_to_world: np.ndarray) -> np.ndarray:
        """Return the same from camera-to-world matrices `(N, 4, 4)` in the optical convention."""
        backend = self._backend()
        poses = np.asarray(camera_to_world, dtype=np.float64)
        if poses.ndim != 3 or poses.shape[1:] != (4, 4):
            raise ValueError(f"camera_to_world must have shape (N, 4, 4); got {poses.shape}")
        if not (np.isfinite(poses).all() and is_rotation(poses[:, :3, :3]).all()):
            raise ValueError("camera_to_world must hold rigid transforms: finite, with a rotation in the upper left")
        images = np.empty((len(poses), *self.camera.shape), dtype=np.float32)
        for start in range(0, len(poses), self.batch_size):
            batch = slice(start, start + self.batch_size)
            backend.render(poses[batch], images[batch])
        return images

    def render_points(self, points: np.ndarray) -> np.ndarray:
        """Return the depth image `(H, W)` float32 metres of the camera's own points; NaN where none fell.

        points: `(..., 3)` metres in the optical frame; NaN points are no measurement. "vtk" sends them through its
        z-buffer, the others through `depth_image_from_points`. Raises `ValueError` for a wrong shape.
        Source: paper 1, section 3.3.2.
        """
        backend = self._backend()
        if self.backend != "vtk":
            return depth_image_from_points(points, self.camera)
        return backend.render_points(measured_points(points))

    def describe(self) -> str:
        """Return the name of what draws, such as OpenGL's name of the graphics card."""
        return self._backend().describe()

    def close(self) -> None:
        """Free the window and its memory; closing twice is harmless."""
        self._closed = True
        if self.backend == "vtk" and self._open_backend is not None:
            self._open_backend.close()
        self._open_backend = None

    def _backend(self) -> object:
        """Open after unpickling at first use, because an error on arrival would hang a pool."""
        if self._closed:
            raise RendererClosedError("this renderer was closed; make a new DepthRenderer(scene_map, camera)")
        backend = self._open_backend
        if backend is None:
            backend = self._open_backend = self._new_backend()
        return backend

    def __getstate__(self) -> dict[str, object]:
        """For pickle and copy: leave the window out."""
        return vars(self) | {"_open_backend": None}

    def __enter__(self) -> DepthRenderer:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()
