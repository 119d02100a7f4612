"""Depth images by ray casting: one ray through every pixel centre. The reference for the z-buffer.

embreex (Intel's Embree) where it is installed, else trimesh's own ray casting, which is slower by far. Directions have
a forward component of one, so that the ray parameter is depth along the optical axis, not ray length.
"""

from __future__ import annotations

import numpy as np

from course_lib.depth_mcl.camera import DepthCamera
from course_lib.depth_mcl.scene_map import SceneMap
from course_lib.depth_mcl.sensor import depth_image_from_points

try:
    from embreex.mesh_construction import TriangleMesh
    from embreex.rtcore_scene import EmbreeScene
except ImportError:  # no wheel for this processor
    EmbreeScene = None


class RayBackend:
    """Casts rays into the map about its origin."""

    def __init__(self, scene_map: SceneMap, camera: DepthCamera) -> None:
        self.camera = camera
        self._rays = camera.rays().reshape(-1, 3)
        vertices = scene_map.vertices - scene_map.origin
        if EmbreeScene is not None:
            # robust: no ray slips through the edge that two triangles share.
            self._scene = EmbreeScene(robust=True)
            self._mesh = TriangleMesh(self._scene, vertices[scene_map.faces].astype(np.float32))
        else:
            import trimesh

            self._scene = None
            self._mesh = trimesh.Trimesh(vertices, scene_map.faces, process=False)

    def render(self, poses: np.ndarray, out: np.ndarray) -> None:
        """Fills `out` `(N, H, W)` with the depth seen from poses `(N, 4, 4)`, relative to the map's origin."""
        for pose, image in zip(poses, out, strict=True):
            directions = self._rays @ pose[:3, :3].T
            # Rays start on the near plane: what lies before it is not hit.
            origins = pose[:3, 3] + self.camera.near * directions
            depth = self.camera.near + self._first_hit(origins, directions)
            depth[depth > self.camera.far] = np.inf
            image[:] = depth.reshape(self.camera.shape)

    def _first_hit(self, origins: np.ndarray, directions: np.ndarray) -> np.ndarray:
        if self._scene is not None:
            hits = self._scene.run(origins.astype(np.float32), directions.astype(np.float32), output=True)
            return np.where(hits["primID"] >= 0, hits["tfar"], np.inf).astype(np.float64)
        triangle, ray, location = self._mesh.ray.intersects_id(
            origins, directions, multiple_hits=False, return_locations=True
        )
        del triangle
        parameter = np.full(len(origins), np.inf)
        along = np.einsum("ij,ij->i", location - origins[ray], directions[ray])
        np.minimum.at(parameter, ray, along / np.einsum("ij,ij->i", directions[ray], directions[ray]))
        return parameter

    def render_points(self, points: np.ndarray) -> np.ndarray:
        """The camera's points as a depth image, in NumPy."""
        return depth_image_from_points(points, self.camera)

    def describe(self) -> str:
        """Name of the ray caster."""
        return "ray casting with Embree (embreex)" if self._scene is not None else "ray casting with trimesh"

    def close(self) -> None:
        """Drops the scene."""
        self._scene = self._mesh = None
