"""Render the depth image that a camera would measure at every particle's pose (paper 1, 3.3.1, GPU scene simulation).

"vtk" renders the map once per particle, as tiles of one off-screen window, and reads OpenGL's z-buffer back once.
"raster" fills a z-buffer in compiled loops. "ray" casts one ray through every pixel centre and is the reference.
Threads may share a renderer. A forked child may use an inherited one, unless it is "vtk". An unpickled renderer opens
its backend at its first use.
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

MAX_BATCH_PIXELS = 200 * 176 * 144  # of one off-screen window: the paper's 200 images, 80 MB with colour and depth
# Files in /dev that show a graphics card on Linux: most drivers', NVIDIA's, and Windows' (WSL).
CARDS = ("dri/renderD*", "nvidia[0-9]*", "dxg")
# Parts of the names under which OpenGL draws on the processor: Mesa's, Apple's, Microsoft's and Google's.
SOFTWARE = ("llvmpipe", "softpipe", "swrast", "software", "gdi generic", "basic render", "swiftshader")

Backend = Literal["auto", "vtk", "raster", "ray"]


@cache  # so that a process decides once
def chosen_backend(backend: Backend) -> Backend:
    """Return `backend`, or the choice of "auto" for this computer: "vtk" on a graphics card, else "raster"."""
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
    """Render depth images of a map from any number of poses; a context manager.

    Parameters
    ----------
    scene_map : SceneMap
        The map that is rendered.
    camera : DepthCamera
        Its pixels, rays and clip planes.
    backend : "auto", "vtk", "raster" or "ray"
        OpenGL's z-buffer, a compiled z-buffer, or the reference. "auto" chooses "vtk" on a graphics card, else
        "raster". The attribute `backend` is the choice.
    exact : bool
        Whether every triangle is rendered. Else a large map gets fewer triangles, which lie within centimetres of it.
    max_batch_pixels : int
        At most so many pixels are rendered at once, which bounds the memory.

    Raises
    ------
    ValueError
        If there is no such backend.
    OpenGLError
        If OpenGL cannot start.
    RendererClosedError
        If the renderer is used after `close`.
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
        """Return a depth image of the map from every state.

        Z_(i) = {z_(i)^1, ..., z_(i)^m}: one value for each of the real camera's m = H x W pixels

        Parameters
        ----------
        states : array `(N, 6)`
            x, y, z in metres, then roll, pitch, yaw in radians. A single state `(6,)` counts as N = 1.

        Returns
        -------
        array `(N, H, W)` of float32
            Metres along the optical axis; `inf` where nothing is hit.

        Raises
        ------
        ValueError
            If the states have a wrong shape or are not finite.

        Source: paper 1, eq. (6).
        """
        return self.render_poses(optical_pose(np.atleast_2d(as_states(states))))

    def batches(self, states: np.ndarray) -> Iterator[np.ndarray]:
        """Yield the images of `render` in batches `(n, H, W)`, where all of them would not fit into memory."""
        states = np.atleast_2d(states)
        for start in range(0, len(states), self.batch_size):
            yield self.render(states[start : start + self.batch_size])

    def render_poses(self, camera_to_world: np.ndarray) -> np.ndarray:
        """Return the images of `render` from camera-to-world matrices `(N, 4, 4)` in the optical convention."""
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
        """Return the depth image of the camera's own points, as the map's images are rendered.

        "vtk" sends the points through its z-buffer, the other backends through `depth_image_from_points`.

        Parameters
        ----------
        points : array `(..., 3)`
            Metres in the optical frame. NaN points are no measurement.

        Returns
        -------
        array `(H, W)` of float32
            Metres along the optical axis; NaN on a pixel without a point.

        Raises
        ------
        ValueError
            If the last axis does not have three values.

        Source: paper 1, section 3.3.2.
        """
        backend = self._backend()
        if self.backend != "vtk":
            return depth_image_from_points(points, self.camera)
        return backend.render_points(measured_points(points))

    def describe(self) -> str:
        """Return the name of the backend's device, such as OpenGL's name of the graphics card."""
        return self._backend().describe()

    def close(self) -> None:
        """Free the window and its memory; closing twice is harmless."""
        self._closed = True
        if self.backend == "vtk" and self._open_backend is not None:
            self._open_backend.close()
        self._open_backend = None

    def _backend(self) -> object:
        """Return the backend; open it if this renderer was unpickled, where an error would hang a pool."""
        if self._closed:
            raise RendererClosedError("this renderer was closed; make a new DepthRenderer(scene_map, camera)")
        backend = self._open_backend
        if backend is None:
            backend = self._open_backend = self._new_backend()
        return backend

    def __getstate__(self) -> dict[str, object]:
        """Return the state for pickle and copy, without the backend, which may hold a window."""
        return vars(self) | {"_open_backend": None}

    def __enter__(self) -> DepthRenderer:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()
