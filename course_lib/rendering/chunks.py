"""Prepare a map for rendering: cut large triangles, and sort all triangles into compact chunks.

A view leaves a chunk out only if the chunk's bounding sphere lies outside one of its sides, before near, or beyond far.
"""

import numpy as np

from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.compiled import compiled
from course_lib.rendering.errors import SceneMapError

MAX_EDGE = 32.0  # metres: OpenGL renders such an edge, seen from 2 m above, right to half a millimetre
MAX_CUT_EDGE = 20_000.0  # metres: a longer edge is not cut; it belongs to no building, and `SceneMap.load` refuses it
MAX_PIECES = 5_000_000  # a map that needs more is refused
CHUNK_SIZE = 0.5  # metres, edge of the cubes into which triangles are sorted: a hundred of a map's 100,000 (chosen)


def cut_large_triangles(
    vertices: np.ndarray, faces: np.ndarray, max_edge: float = MAX_EDGE
) -> tuple[np.ndarray, np.ndarray]:
    """Return vertices `(V', 3)` and faces `(F', 3)` of the same surface, no edge longer than `max_edge` metres.

    An edge that two triangles share is cut at one point, so no gap opens. Arrays that need no cut are returned as they
    are. Raises `SceneMapError` if more than `MAX_PIECES` would be needed.
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
            reason = f"the map's triangles make more than {MAX_PIECES:,} pieces of {max_edge:g} m"
            raise SceneMapError(f"{reason}: are its coordinates metres? Remove what does not belong to the building")
        vertices, faces = _halved(vertices, faces, long)


def _halved(vertices: np.ndarray, faces: np.ndarray, long: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return vertices and faces after each edge marked `long` `(F, 3)` was cut in the middle: 2 to 4 for each face."""
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
        # Number the corners so that edge 01 is long, and where two edges are long, 12 too.
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


class MeshChunks:
    """Sort triangles by the cube in which their centre lies."""

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

    def spheres(self, anchor: np.ndarray) -> np.ndarray:
        """Return centres about `anchor` `(3,)` and radii, `(C, 4)` float32, the radii rounded up."""
        return np.column_stack([self.centers - anchor, self.radii * (1 + 1e-5) + 1e-5]).astype(np.float32)

    def visible(self, camera: DepthCamera, poses: np.ndarray, anchor: np.ndarray) -> np.ndarray:
        """Return which chunks `(C,)` bool any of the camera poses `(N, 4, 4)` can see."""
        lens, sides, spheres = lens_of(camera), inward_normals(camera), self.spheres(anchor)
        seen, nearest = np.empty(len(spheres), np.int64), np.empty(len(spheres), np.float32)
        visible = np.zeros(len(spheres), dtype=bool)
        for rotation, position in zip(*world_to_cameras(poses, anchor), strict=True):
            visible[seen[: chunks_in_view(seen, nearest, rotation, position, lens, sides, spheres)]] = True
        return visible

    def with_own_vertices(self, faces: np.ndarray, vertices: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return vertices chunk by chunk `(V', 3)`, where each chunk begins `(C + 1,)`, and faces in its numbers."""
        chunk = np.repeat(np.arange(len(self.starts) - 1), np.diff(self.starts))
        # One number for each vertex of each chunk, which sorts them chunk by chunk.
        keys = (chunk[:, None] * np.int64(len(vertices)) + faces[self.order]).ravel()
        own, index = np.unique(keys, return_inverse=True)
        vertex_starts = np.searchsorted(own, np.arange(len(self.starts)) * np.int64(len(vertices)))
        local = index.reshape(-1, 3) - vertex_starts[chunk][:, None]
        return vertices[own % len(vertices)], vertex_starts, np.ascontiguousarray(local, dtype=np.int32)


def lens_of(camera: DepthCamera) -> np.ndarray:
    """Return fx, fy, cx, cy, nearest and farthest `(6,)` float32, as the compiled loops read them."""
    lens = (camera.fx, camera.fy, camera.cx, camera.cy, camera.nearest, camera.farthest)
    return np.array(lens, dtype=np.float32)


def inward_normals(camera: DepthCamera) -> np.ndarray:
    """Return unit normals `(4, 3)` float32, optical frame, pointing in, of a view's left, right, top and bottom."""
    left, right = (-0.5 - camera.cx) / camera.fx, (camera.width - 0.5 - camera.cx) / camera.fx
    top, bottom = (-0.5 - camera.cy) / camera.fy, (camera.height - 0.5 - camera.cy) / camera.fy
    planes = np.array([[1, 0, -left], [-1, 0, right], [0, 1, -top], [0, -1, bottom]], dtype=np.float64)
    return (planes / np.linalg.norm(planes, axis=1, keepdims=True)).astype(np.float32)


def world_to_cameras(poses: np.ndarray, anchor: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return rotations `(N, 3, 3)` and positions `(N, 3)` about `anchor`, float32, of camera poses `(N, 4, 4)`."""
    rotations = np.ascontiguousarray(poses[:, :3, :3].transpose(0, 2, 1), dtype=np.float32)
    return rotations, (poses[:, :3, 3] - anchor).astype(np.float32)


@compiled()
def chunks_in_view(seen, nearest, rotation, position, lens, sides, spheres):
    """Write the chunks that a view may see into `seen`, and the least Z of each into `nearest`; return how many."""
    near, far = lens[4], lens[5]
    count = 0
    for c in range(len(spheres)):
        x, y, z = to_camera(rotation, position, spheres[c, 0], spheres[c, 1], spheres[c, 2])
        radius = spheres[c, 3]
        if z + radius < near or z - radius > far:
            continue
        inside = True
        for side in range(4):
            if sides[side, 0] * x + sides[side, 1] * y + sides[side, 2] * z < -radius:
                inside = False
                break
        if inside:
            seen[count], nearest[count] = c, z - radius
            count += 1
    return count


@compiled()
def to_camera(rotation, position, x, y, z):
    """Return a point of the world in the camera's frame."""
    x, y, z = x - position[0], y - position[1], z - position[2]
    return (
        rotation[0, 0] * x + rotation[0, 1] * y + rotation[0, 2] * z,
        rotation[1, 0] * x + rotation[1, 1] * y + rotation[1, 2] * z,
        rotation[2, 0] * x + rotation[2, 1] * y + rotation[2, 2] * z,
    )
