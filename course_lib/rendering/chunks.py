"""The map cut into compact chunks, so that a batch of views draws only what one of its cameras can see.

Leaving out what lies outside every camera's view changes no pixel: a chunk is left out only when its bounding sphere is
wholly outside one of the five planes of *every* view (four sides and behind), or beyond far.
"""

from __future__ import annotations

import numpy as np

from course_lib.rendering.camera import DepthCamera

# Edge of the cubes that triangles are sorted into, metres (chosen: some hundred triangles of a 100,000-triangle map).
CHUNK_SIZE = 0.5


class MeshChunks:
    """Triangles sorted by the cube that their centre lies in.

    order: `(F,)` the triangles in chunk order. starts: `(C + 1,)` where each chunk begins in it. centers `(C, 3)` and
    radii `(C,)`: a sphere around each chunk's triangles, metres.
    """

    def __init__(self, vertices: np.ndarray, faces: np.ndarray, chunk_size: float = CHUNK_SIZE) -> None:
        corners = vertices[faces]
        cubes = np.floor(corners.mean(axis=1) / chunk_size).astype(np.int64)
        _, chunk_of_face = np.unique(cubes, axis=0, return_inverse=True)
        chunk_of_face = chunk_of_face.ravel()
        self.order = np.argsort(chunk_of_face, kind="stable")
        counts = np.bincount(chunk_of_face)
        self.starts = np.concatenate([[0], np.cumsum(counts)])
        sorted_corners = corners[self.order]
        low = np.minimum.reduceat(sorted_corners.min(axis=1), self.starts[:-1])
        high = np.maximum.reduceat(sorted_corners.max(axis=1), self.starts[:-1])
        self.centers = 0.5 * (low + high)
        self.radii = 0.5 * np.linalg.norm(high - low, axis=1)

    def visible(self, camera: DepthCamera, camera_to_world: np.ndarray) -> np.ndarray:
        """Which chunks any of the views can see: `(C,)` bool.

        camera_to_world: `(N, 4, 4)`, optical convention, in the frame of the vertices.
        """
        normals = inward_normals(camera)
        rotation, position = camera_to_world[:, :3, :3], camera_to_world[:, :3, 3]
        world_normals = np.einsum("nij,pj->npi", rotation, normals)
        offsets = np.einsum("npi,ni->np", world_normals, position)
        seen = np.zeros(len(self.centers), dtype=bool)
        for view_normals, view_offsets, forward, eye in zip(
            world_normals, offsets, rotation[:, :, 2], position, strict=True
        ):
            todo = np.flatnonzero(~seen)
            if len(todo) == 0:
                break
            centers, radii = self.centers[todo], self.radii[todo]
            inside = (centers @ view_normals.T - view_offsets >= -radii[:, None]).all(axis=1)
            inside &= (centers - eye) @ forward <= camera.far + radii
            seen[todo] = inside
        return seen

    def with_own_vertices(self, faces: np.ndarray, vertices: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Vertices `(V', 3)` chunk by chunk, where each chunk's begin `(C + 1,)`, and faces `(F, 3)` counted from it.

        faces, vertices: those that the chunks were made of. A vertex on the border of two chunks is in both.
        """
        chunk = np.repeat(np.arange(len(self.starts) - 1), np.diff(self.starts))
        # One number for a vertex in a chunk; sorted, they stand chunk by chunk.
        keys = (chunk[:, None] * np.int64(len(vertices)) + faces[self.order]).ravel()
        own, index = np.unique(keys, return_inverse=True)
        vertex_starts = np.searchsorted(own, np.arange(len(self.starts)) * np.int64(len(vertices)))
        local = index.reshape(-1, 3) - vertex_starts[chunk][:, None]
        return vertices[own % len(vertices)], vertex_starts, np.ascontiguousarray(local, dtype=np.int32)

    def faces_of(self, chunks: np.ndarray) -> np.ndarray:
        """Positions in chunk order of the triangles of the chunks marked in `(C,)` bool."""
        return np.flatnonzero(np.repeat(chunks, np.diff(self.starts)))


def inward_normals(camera: DepthCamera) -> np.ndarray:
    """Unit normals `(5, 3)`, optical frame, pointing into the view: its left, right, top, bottom, and the front."""
    left, right = (-0.5 - camera.cx) / camera.fx, (camera.width - 0.5 - camera.cx) / camera.fx
    top, bottom = (-0.5 - camera.cy) / camera.fy, (camera.height - 0.5 - camera.cy) / camera.fy
    planes = np.array([[1, 0, -left], [-1, 0, right], [0, 1, -top], [0, -1, bottom], [0, 0, 1]], dtype=np.float64)
    return planes / np.linalg.norm(planes, axis=1, keepdims=True)
