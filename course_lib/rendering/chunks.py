"""A map made ready to be drawn: large triangles are cut, and all are sorted into compact chunks.

A chunk is left out of a batch only if its bounding sphere lies outside one side, behind, or beyond far of *every* view,
so leaving it out changes no pixel.
"""

import numpy as np

from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.mesh_file import SceneMapError

# Metres: up to this length of edges OpenGL's depth of a plane seen from 2 m above it is right within half a millimetre.
MAX_EDGE = 32.0
# Metres: an edge that is longer is not cut. Such a triangle belongs to no building; `SceneMap.load` refuses it.
MAX_CUT_EDGE = 20_000.0
# A map that needs more pieces is refused.
MAX_PIECES = 5_000_000


def cut_large_triangles(
    vertices: np.ndarray, faces: np.ndarray, max_edge: float = MAX_EDGE
) -> tuple[np.ndarray, np.ndarray]:
    """Return vertices `(V', 3)` and faces `(F', 3)` of the same surface, no edge longer than `max_edge` metres.

    In float64: in float32 a corner 10 km away is off by half a millimetre, and its plane, seen from near, by
    centimetres. A shared edge is halved for both triangles at one point, so no gap opens. Unchanged arrays come back as
    they are.
    """
    done: list[np.ndarray] = []
    while True:
        corners = vertices[faces]
        edges = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2)  # 01, 12, 20
        long = (edges > max_edge) & (edges.max(axis=1, keepdims=True) <= MAX_CUT_EDGE)
        cut = long.any(axis=1)
        if not cut.any():
            return vertices, np.concatenate([*done, faces]) if done else faces
        done.append(faces[~cut])
        faces, long = faces[cut], long[cut]
        if 4 * len(faces) + sum(map(len, done)) > MAX_PIECES:
            raise SceneMapError(
                f"the map has triangles so large that more than {MAX_PIECES:,} pieces of at most {max_edge:g} m "
                "would have to be drawn: are its coordinates metres? Remove what does not belong to the building"
            )
        vertices, faces = _halved(vertices, faces, long)


def _halved(vertices: np.ndarray, faces: np.ndarray, long: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Triangles `faces` cut at the middle of their edges marked `long` `(F, 3)`: each into two, three or four."""
    edges = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=-1), axis=-1)  # (F, 3, 2)
    unique, index = np.unique(edges[long], axis=0, return_inverse=True)
    middle = np.full(long.shape, -1)
    middle[long] = len(vertices) + index.ravel()
    vertices = np.concatenate([vertices, vertices[unique].mean(axis=1)])
    pieces = []
    for count in (1, 2, 3):
        chosen = long.sum(axis=1) == count
        if not chosen.any():
            continue
        # Turned so that edge 01 is long, and where two are long, 12 as well.
        first = long[chosen].argmax(axis=1) if count != 2 else (long[chosen].argmin(axis=1) + 1) % 3
        order = (first[:, None] + np.arange(3)) % 3
        (a, b, c), (ab, bc, ca) = (np.take_along_axis(x[chosen], order, axis=1).T for x in (faces, middle))
        rows = {
            1: [(a, ab, c), (ab, b, c)],
            2: [(a, ab, c), (ab, b, bc), (ab, bc, c)],
            3: [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)],
        }[count]
        pieces += [np.stack(row, axis=1) for row in rows]
    return vertices, np.concatenate(pieces).astype(faces.dtype)


# Edge of the cubes that triangles are sorted into, metres (chosen: some hundred triangles of a 100,000-triangle map).
CHUNK_SIZE = 0.5


class MeshChunks:
    """Triangles sorted by the cube that their centre lies in."""

    def __init__(self, vertices: np.ndarray, faces: np.ndarray, chunk_size: float = CHUNK_SIZE) -> None:
        corners = vertices[faces]
        cubes = np.floor(corners.mean(axis=1) / chunk_size).astype(np.int64)
        _, chunk_of_face = np.unique(cubes, axis=0, return_inverse=True)
        chunk_of_face = chunk_of_face.ravel()
        self.order = np.argsort(chunk_of_face, kind="stable")  # `(F,)` the triangles in chunk order
        counts = np.bincount(chunk_of_face)
        self.starts = np.concatenate([[0], np.cumsum(counts)])  # `(C + 1,)` where each chunk begins in it
        sorted_corners = corners[self.order]
        low = np.minimum.reduceat(sorted_corners.min(axis=1), self.starts[:-1])
        high = np.maximum.reduceat(sorted_corners.max(axis=1), self.starts[:-1])
        self.centers = 0.5 * (low + high)  # `(C, 3)` and radii `(C,)`: a sphere around each chunk, metres
        self.radii = 0.5 * np.linalg.norm(high - low, axis=1)

    def visible(self, camera: DepthCamera, camera_to_world: np.ndarray) -> np.ndarray:
        """Return which chunks any view can see: `(C,)` bool. camera_to_world: `(N, 4, 4)`, optical, in the vertices'
        frame.
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
        """Return vertices chunk by chunk `(V', 3)`, where each chunk's begin `(C + 1,)`, and faces counted so."""
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
