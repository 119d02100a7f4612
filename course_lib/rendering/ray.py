"""Cast a ray through every pixel centre: the reference backend, by Embree where it is installed."""

import numpy as np
import trimesh

from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.scene_map import SceneMap

try:
    from embreex.mesh_construction import TriangleMesh
    from embreex.rtcore_scene import EmbreeScene
except ImportError:  # no wheel for this processor
    EmbreeScene = TriangleMesh = None


class EmbreeCaster:
    """Cast rays at triangles `(F, 3, 3)` in float32. Raises `ImportError` if embreex is missing."""

    def __init__(self, corners: np.ndarray) -> None:
        if EmbreeScene is None:
            raise ImportError(
                "embreex is missing, which has wheels for x86-64 and for macOS: make data there, or search for a start"
            )
        # robust: no ray slips through the edge that two triangles share.
        self._scene = EmbreeScene(robust=True)
        self._mesh = TriangleMesh(self._scene, np.ascontiguousarray(corners, dtype=np.float32))

    def cast(self, origins: np.ndarray, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return where rays, origins and directions `(N, 3)`, first hit.

        Distances `(N,)` in units of the direction's length, or `inf`; faces `(N,)`, or -1; normals `(N, 3)`.
        """
        origins, directions = (np.ascontiguousarray(array, dtype=np.float32) for array in (origins, directions))
        hits = self._scene.run(origins, directions, output=True)
        return np.where(hits["primID"] >= 0, hits["tfar"], np.inf), hits["primID"], hits["Ng"]


class TrimeshCaster:
    """Cast rays as `EmbreeCaster` does, in Python and far slower."""

    def __init__(self, corners: np.ndarray) -> None:
        self._mesh = trimesh.Trimesh(**trimesh.triangles.to_kwargs(corners), process=False)

    def cast(self, origins: np.ndarray, directions: np.ndarray) -> tuple[np.ndarray]:
        """Return the distances `(N,)` of `EmbreeCaster.cast`, and nothing else."""
        places, rays, _ = self._mesh.ray.intersects_location(origins, directions, multiple_hits=False)
        distance, along = np.full(len(origins), np.inf), directions[rays]
        distance[rays] = np.einsum("ij,ij->i", places - origins[rays], along) / np.einsum("ij,ij->i", along, along)
        return (distance,)


class RayBackend:
    """Cast rays into the map. Threads may share it, because anchor and caster are always replaced together."""

    def __init__(self, scene_map: SceneMap, camera: DepthCamera) -> None:
        self.camera = camera
        self._scene_map = scene_map
        self._rays = camera.rays().reshape(-1, 3)
        self._anchor_and_caster = self._about(scene_map.origin)

    def render(self, poses: np.ndarray, out: np.ndarray) -> None:
        """Fill `out` `(N, H, W)` with the depth seen from camera poses `(N, 4, 4)`."""
        wanted, (anchor, caster) = self._scene_map.anchor(poses[:, :3, 3]), self._anchor_and_caster
        if not np.array_equal(anchor, wanted):  # rarely: the cameras stay near the anchor
            anchor, caster = self._anchor_and_caster = self._about(wanted)
        for pose, image in zip(poses, out, strict=True):
            directions = self._rays @ pose[:3, :3].T
            # Rays start on the near plane, so they hit nothing before it.
            origins = pose[:3, 3] - anchor + self.camera.nearest * directions
            depth = self.camera.nearest + caster.cast(origins, directions)[0].astype(np.float64)
            depth[depth > self.camera.farthest] = np.inf
            image[:] = depth.reshape(self.camera.shape)

    def _about(self, anchor: np.ndarray) -> tuple[np.ndarray, EmbreeCaster | TrimeshCaster]:
        """Return an anchor `(3,)` and a caster of the map about it."""
        corners = (self._scene_map.vertices - anchor)[self._scene_map.faces]
        return anchor, TrimeshCaster(corners) if EmbreeScene is None else EmbreeCaster(corners)

    def describe(self) -> str:
        """Return the name of the ray caster."""
        return f"ray casting with {'trimesh' if EmbreeScene is None else 'Embree (embreex)'}"
