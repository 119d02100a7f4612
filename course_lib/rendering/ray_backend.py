"""Depth images by ray casting: one ray through every pixel centre. The reference for the z-buffer.

embreex (Intel's Embree) where it is installed, else trimesh's own ray casting, which is slower by far. Directions have
a forward component of one, so that the ray parameter is depth along the optical axis, not ray length.
"""

from __future__ import annotations

import numpy as np
import trimesh

from course_lib.rendering import embree
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.scene_map import SceneMap
from course_lib.rendering.sensor import depth_image_from_points


class RayBackend:
    """Casts rays into the map. Threads share it: what is exchanged, is exchanged as a whole (`_caster_about`)."""

    def __init__(self, scene_map: SceneMap, camera: DepthCamera) -> None:
        self.camera = camera
        self._scene_map = scene_map
        self._rays = camera.rays().reshape(-1, 3)
        self._anchor_and_caster = scene_map.origin, self._new_caster(scene_map.origin)

    def render(self, poses: np.ndarray, out: np.ndarray) -> None:
        """Fills `out` `(N, H, W)` with the depth seen from camera poses `(N, 4, 4)`."""
        anchor = self._scene_map.anchor(poses[:, :3, 3])
        caster = self._caster_about(anchor)
        for pose, image in zip(poses, out, strict=True):
            directions = self._rays @ pose[:3, :3].T
            # Rays start on the near plane: what lies before it is not hit.
            origins = pose[:3, 3] - anchor + self.camera.nearest * directions
            depth = self.camera.nearest + caster.cast(origins, directions)[0].astype(np.float64)
            depth[depth > self.camera.farthest] = np.inf
            image[:] = depth.reshape(self.camera.shape)

    def _caster_about(self, anchor: np.ndarray) -> embree.EmbreeCaster | _TrimeshCaster:
        """Caster of the map relative to `anchor` `(3,)`; the last one is kept, as views seldom move on."""
        made_about, caster = self._anchor_and_caster
        if not np.array_equal(anchor, made_about):
            caster = self._new_caster(anchor)
            self._anchor_and_caster = anchor, caster
        return caster

    def _new_caster(self, anchor: np.ndarray) -> embree.EmbreeCaster | _TrimeshCaster:
        corners = (self._scene_map.vertices - anchor)[self._scene_map.faces]
        return _TrimeshCaster(corners) if embree.EmbreeScene is None else embree.EmbreeCaster(corners)

    def render_points(self, points: np.ndarray) -> np.ndarray:
        """The camera's points as a depth image, in NumPy."""
        return depth_image_from_points(points, self.camera)

    def describe(self) -> str:
        """Name of the ray caster."""
        without_embree = isinstance(self._anchor_and_caster[1], _TrimeshCaster)
        return "ray casting with trimesh" if without_embree else "ray casting with Embree (embreex)"

    def close(self) -> None:
        """Nothing is held that the renderer's own end does not free."""


class _TrimeshCaster:
    """What `EmbreeCaster` does, in Python and far slower."""

    def __init__(self, corners: np.ndarray) -> None:
        self._mesh = trimesh.Trimesh(**trimesh.triangles.to_kwargs(corners), process=False)

    def cast(self, origins: np.ndarray, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """First hits of rays: as `EmbreeCaster.cast`."""
        faces, rays, places = self._mesh.ray.intersects_id(
            origins, directions, multiple_hits=False, return_locations=True
        )
        along = np.einsum("ij,ij->i", places - origins[rays], directions[rays])
        distance, face = np.full(len(origins), np.inf), np.full(len(origins), -1)
        distance[rays] = along / np.einsum("ij,ij->i", directions[rays], directions[rays])
        face[rays] = faces
        return distance, face, self._mesh.face_normals[face]
