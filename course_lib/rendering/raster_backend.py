"""Depth images by the course's own z-buffer (rasterizer.py), on every processor: no OpenGL, no window, no driver."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numpy as np

from course_lib.processors import processors
from course_lib.rendering import rasterizer
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.chunks import MeshChunks, inward_normals
from course_lib.rendering.scene_map import SceneMap
from course_lib.rendering.sensor import depth_image_from_points

VIEWS_A_TASK = 8  # small enough that no thread waits long for the last, large enough that starting one costs nothing


class _Mesh(NamedTuple):
    """The chunks as the compiled loops read them: float32, relative to an anchor."""

    anchor: np.ndarray
    spheres: np.ndarray
    vertices: np.ndarray


class RasterBackend:
    """Draws views into plain arrays. Threads share it: what is exchanged, is exchanged as a whole (`_mesh_about`)."""

    def __init__(self, scene_map: SceneMap, camera: DepthCamera) -> None:
        self.camera = camera
        self._scene_map = scene_map
        self._chunks = MeshChunks(scene_map.vertices, scene_map.faces)
        self._vertices, self._vertex_starts, self._faces = self._chunks.with_own_vertices(
            scene_map.faces, scene_map.vertices
        )
        lens = (camera.fx, camera.fy, camera.cx, camera.cy, camera.nearest, camera.farthest)
        self._lens = np.array(lens, dtype=np.float32)
        self._sides = inward_normals(camera)[:4].astype(np.float32)
        self._mesh = self._mesh_about(scene_map.origin)

    def render(self, poses: np.ndarray, out: np.ndarray) -> None:
        """Fills `out` `(N, H, W)` with the depth seen from camera poses `(N, 4, 4)`."""
        mesh = self._mesh_about(self._scene_map.anchor(poses[:, :3, 3]))
        rotations = np.ascontiguousarray(poses[:, :3, :3].transpose(0, 2, 1), dtype=np.float32)
        positions = (poses[:, :3, 3] - mesh.anchor).astype(np.float32)

        def draw(start: int) -> None:
            views = slice(start, start + VIEWS_A_TASK)
            scratch = np.empty((6, int(np.diff(self._vertex_starts).max())))
            rasterizer.draw_views(
                out[views],
                rotations[views],
                positions[views],
                self._lens,
                self._sides,
                mesh.spheres,
                self._vertex_starts,
                mesh.vertices,
                self._chunks.starts,
                self._faces,
                scratch,
            )
            rasterizer.invert(out[views], self._lens[5])

        starts = range(0, len(poses), VIEWS_A_TASK)
        threads = min(processors(), len(starts))
        if threads == 1:
            for start in starts:
                draw(start)
        elif threads:
            # A pool for each call: it costs a tenth of a millisecond, and no thread is there to be lost in a fork.
            with ThreadPoolExecutor(threads) as pool:
                list(pool.map(draw, starts))

    def _mesh_about(self, anchor: np.ndarray) -> _Mesh:
        """The mesh relative to `anchor` `(3,)`; the last one is kept, as views seldom move on."""
        mesh = getattr(self, "_mesh", None)
        if mesh is None or not np.array_equal(mesh.anchor, anchor):
            spheres = np.column_stack([self._chunks.centers - anchor, self._chunks.radii * (1 + 1e-5) + 1e-5])
            vertices = (self._vertices - anchor).astype(np.float32)
            mesh = self._mesh = _Mesh(anchor, spheres.astype(np.float32), vertices)
        return mesh

    def render_points(self, points: np.ndarray) -> np.ndarray:
        """The camera's points as a depth image, in NumPy."""
        return depth_image_from_points(points, self.camera)

    def describe(self) -> str:
        """What draws, and on how many processors."""
        return f"z-buffer in compiled loops on {processors()} processors (Numba)"

    def close(self) -> None:
        """Nothing is held that the renderer's own end does not free."""
