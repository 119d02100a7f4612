"""A z-buffer in plain loops, compiled by Numba: what a graphics card does with a mesh, on every processor.

The chunks of the mesh that a view may see are drawn, the nearest first. Each triangle is filled row by row, and each
pixel keeps the greatest 1/Z, which is linear in the image; 0 is "nothing hit".

    u = fx X/Z + cx,    v = fy Y/Z + cy,    1/Z = a u + b v + c

A chunk is also left out if every block of 8 x 8 pixels that its bounding sphere may cover holds nearer surfaces
already.
"""

from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numba
import numpy as np

from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.chunks import MeshChunks, inward_normals
from course_lib.rendering.compiled import compiled
from course_lib.rendering.scene_map import SceneMap
from course_lib.rendering.sensor import depth_image_from_points

VIEWS_A_TASK = 8  # small enough that no thread waits long for the last, large enough that starting one costs nothing
BLOCK = 8  # pixels: edge of the blocks whose farthest depth is kept
CHUNKS_BETWEEN = 32  # chunks drawn before the blocks are looked at again: looking at every pixel costs, too
# Pixels by which a row's ends are stretched: two triangles leave no gap between them through rounding.
_OVERLAP = 1e-4
_ONE = np.float32(1.0)


class _Mesh(NamedTuple):
    """The chunks as the compiled loops read them: float32, relative to an anchor."""

    anchor: np.ndarray
    spheres: np.ndarray
    vertices: np.ndarray


class RasterBackend:
    """Draws views into plain arrays. Threads share it: `_mesh` is only ever exchanged as a whole."""

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
        self._mesh = self._about(scene_map.origin)

    def render(self, poses: np.ndarray, out: np.ndarray) -> None:
        """Fill `out` `(N, H, W)` with the depth seen from camera poses `(N, 4, 4)`."""
        anchor, mesh = self._scene_map.anchor(poses[:, :3, 3]), self._mesh
        if not np.array_equal(mesh.anchor, anchor):  # views seldom move on
            mesh = self._mesh = self._about(anchor)
        rotations = np.ascontiguousarray(poses[:, :3, :3].transpose(0, 2, 1), dtype=np.float32)
        positions = (poses[:, :3, 3] - mesh.anchor).astype(np.float32)

        def draw(start: int) -> None:
            views = slice(start, start + VIEWS_A_TASK)
            scratch = np.empty((6, int(np.diff(self._vertex_starts).max())))
            draw_views(
                out[views], rotations[views], positions[views], self._lens, self._sides, mesh.spheres,
                self._vertex_starts, mesh.vertices, self._chunks.starts, self._faces, scratch,
            )  # fmt: skip
            invert(out[views], self._lens[5])

        starts = range(0, len(poses), VIEWS_A_TASK)
        threads = min(numba.config.NUMBA_NUM_THREADS, len(starts))
        if threads == 1:
            for start in starts:
                draw(start)
        elif threads:
            # A pool for each call: it costs a tenth of a millisecond, and no thread is there to be lost in a fork.
            with ThreadPoolExecutor(threads) as pool:
                list(pool.map(draw, starts))

    def _about(self, anchor: np.ndarray) -> _Mesh:
        """The mesh relative to `anchor` `(3,)`."""
        spheres = np.column_stack([self._chunks.centers - anchor, self._chunks.radii * (1 + 1e-5) + 1e-5])
        return _Mesh(anchor, spheres.astype(np.float32), (self._vertices - anchor).astype(np.float32))

    def render_points(self, points: np.ndarray) -> np.ndarray:
        """The camera's points as a depth image, in NumPy."""
        return depth_image_from_points(points, self.camera)

    def describe(self) -> str:
        """What draws, and on how many processors."""
        return f"z-buffer in compiled loops on {numba.config.NUMBA_NUM_THREADS} processors (Numba)"

    def close(self) -> None:
        """Nothing is held that the renderer's own end does not free."""


@compiled()
def draw_views(
    images, rotations, positions, lens, sides, spheres, vertex_starts, vertices, face_starts, faces, scratch
):
    """Fill `images` `(N, H, W)` float32 with 1/Z of the mesh, 0 where nothing is hit.

    rotations `(N, 3, 3)`, world to cameras; positions `(N, 3)`; lens: fx, fy, cx, cy, near, far; sides `(4, 3)` inward
    normals; spheres `(C, 4)`; vertices `(V, 3)`, faces `(F, 3)` chunk by chunk; scratch `(6, V_max)` float64.
    """
    n_chunks = len(spheres)
    seen = np.empty(n_chunks, np.int64)
    nearest = np.empty(n_chunks, np.float32)
    height, width = images.shape[1:]
    blocks = np.empty(((height + BLOCK - 1) // BLOCK, (width + BLOCK - 1) // BLOCK), np.float32)
    for k in range(len(images)):
        images[k] = 0
        blocks[:] = 0
        drawn = 0
        count = chunks_in_view(seen, nearest, rotations[k], positions[k], lens, sides, spheres)
        for i in np.argsort(nearest[:count]):
            c = seen[i]
            rectangle = cover(rotations[k], positions[k], lens, spheres[c], height, width)
            if is_hidden(blocks, rectangle, nearest[i]):
                continue
            chunk = vertices[vertex_starts[c] : vertex_starts[c + 1]]
            project(scratch, rotations[k], positions[k], lens, chunk)
            draw_faces(images[k], scratch, lens, faces[face_starts[c] : face_starts[c + 1]])
            drawn += 1
            if drawn % CHUNKS_BETWEEN == 0:
                note_farthest(blocks, images[k])


@compiled()
def chunks_in_view(seen, nearest, rotation, position, lens, sides, spheres):
    """Writes the chunks that a view may see into `seen`, the least Z of each into `nearest`; returns how many."""
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
    """A point of the world in the camera's frame."""
    x, y, z = x - position[0], y - position[1], z - position[2]
    return (
        rotation[0, 0] * x + rotation[0, 1] * y + rotation[0, 2] * z,
        rotation[1, 0] * x + rotation[1, 1] * y + rotation[1, 2] * z,
        rotation[2, 0] * x + rotation[2, 1] * y + rotation[2, 2] * z,
    )


@compiled()
def cover(rotation, position, lens, sphere, height, width):
    """Blocks (first and last row, first and last column) that a sphere may cover; all where it comes near the eye."""
    x, y, z = to_camera(rotation, position, sphere[0], sphere[1], sphere[2])
    radius = sphere[3]
    front, back = z - radius, z + radius
    last_row, last_column = (height - 1) // BLOCK, (width - 1) // BLOCK
    if front <= lens[4]:
        return 0, last_row, 0, last_column
    # Of the ball's bounding box: its sides, seen from in front where that is farther out.
    left = lens[0] * (x - radius) / (front if x < radius else back) + lens[2]
    right = lens[0] * (x + radius) / (front if x > -radius else back) + lens[2]
    top = lens[1] * (y - radius) / (front if y < radius else back) + lens[3]
    bottom = lens[1] * (y + radius) / (front if y > -radius else back) + lens[3]
    return (
        max(0, int(np.floor(top)) // BLOCK),
        min(last_row, int(np.ceil(bottom)) // BLOCK),
        max(0, int(np.floor(left)) // BLOCK),
        min(last_column, int(np.ceil(right)) // BLOCK),
    )


@compiled()
def is_hidden(blocks, rectangle, nearest):
    """Whether all pixels of the blocks in the rectangle hold something nearer than Z = `nearest`."""
    if nearest <= 0:
        return False
    inverse = _ONE / nearest
    for row in range(rectangle[0], rectangle[1] + 1):
        for column in range(rectangle[2], rectangle[3] + 1):
            if blocks[row, column] < inverse:
                return False
    return True


@compiled()
def note_farthest(blocks, image):
    """Writes the least 1/Z of each block."""
    height, width = image.shape
    for row in range(len(blocks)):
        for column in range(blocks.shape[1]):
            least = image[row * BLOCK, column * BLOCK]
            for v in range(row * BLOCK, min(height, (row + 1) * BLOCK)):
                for u in range(column * BLOCK, min(width, (column + 1) * BLOCK)):
                    least = min(least, image[v, u])
            blocks[row, column] = least


@compiled()
def project(scratch, rotation, position, lens, vertices):
    """Writes u, v, 1/Z and X, Y, Z of vertices `(n, 3)` into the first n columns of `scratch`."""
    for i in range(len(vertices)):
        x, y, z = to_camera(rotation, position, vertices[i, 0], vertices[i, 1], vertices[i, 2])
        inverse = 1.0 / z if z > lens[4] else 0.0
        scratch[0, i] = lens[0] * x * inverse + lens[2]
        scratch[1, i] = lens[1] * y * inverse + lens[3]
        scratch[2, i] = inverse
        scratch[3, i], scratch[4, i], scratch[5, i] = x, y, z


@compiled()
def draw_faces(image, scratch, lens, faces):
    """Fills triangles `(F, 3)` of projected vertices; those that reach before the near plane are cut there."""
    u, v, w = scratch[0], scratch[1], scratch[2]
    for f in range(len(faces)):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        in_front = (w[a] > 0) + (w[b] > 0) + (w[c] > 0)
        if in_front == 3:
            fill_triangle(image, u[a], v[a], w[a], u[b], v[b], w[b], u[c], v[c], w[c])
        elif in_front > 0:
            draw_cut(image, scratch, lens, a, b, c)


@compiled()
def draw_cut(image, scratch, lens, a, b, c):
    """Fills the part of one triangle that lies behind the near plane: a polygon of three or four corners."""
    near = lens[4]
    corners = np.empty((4, 3), np.float64)
    count = 0
    for i, j in ((a, b), (b, c), (c, a)):
        zi, zj = scratch[5, i], scratch[5, j]
        if zi > near:
            corners[count, 0], corners[count, 1], corners[count, 2] = scratch[0, i], scratch[1, i], scratch[2, i]
            count += 1
        if (zi > near) != (zj > near):
            share = (near - zi) / (zj - zi)
            x = scratch[3, i] + share * (scratch[3, j] - scratch[3, i])
            y = scratch[4, i] + share * (scratch[4, j] - scratch[4, i])
            corners[count, 0] = lens[0] * x / near + lens[2]
            corners[count, 1] = lens[1] * y / near + lens[3]
            corners[count, 2] = 1.0 / near
            count += 1
    for k in range(1, count - 1):
        p, q, r = corners[0], corners[k], corners[k + 1]
        fill_triangle(image, p[0], p[1], p[2], q[0], q[1], q[2], r[0], r[1], r[2])


@compiled()
def fill_triangle(image, u0, v0, w0, u1, v1, w1, u2, v2, w2):
    """Keeps in each pixel whose centre lies in the triangle the greater of what it holds and the plane's 1/Z."""
    height, width = image.shape
    if v1 < v0:
        u0, v0, w0, u1, v1, w1 = u1, v1, w1, u0, v0, w0
    if v2 < v0:
        u0, v0, w0, u2, v2, w2 = u2, v2, w2, u0, v0, w0
    if v2 < v1:
        u1, v1, w1, u2, v2, w2 = u2, v2, w2, u1, v1, w1
    if v2 < 0 or v0 > height - 1:
        return
    left, right = min(u0, u1, u2), max(u0, u1, u2)
    if right < 0 or left > width - 1:
        return
    first_row, last_row = max(0, int(np.ceil(v0))), min(height - 1, int(np.floor(v2)))
    if first_row > last_row:
        return
    twice_area = (u1 - u0) * (v2 - v0) - (u2 - u0) * (v1 - v0)
    if twice_area == 0:
        return
    along_u = ((w1 - w0) * (v2 - v0) - (w2 - w0) * (v1 - v0)) / twice_area
    along_v = ((w2 - w0) * (u1 - u0) - (w1 - w0) * (u2 - u0)) / twice_area
    # The plane of a sliver is steep: its rounding must not leave the triangle's own depths.
    least, greatest = np.float32(min(w0, w1, w2)), np.float32(max(w0, w1, w2))
    long_slope = (u2 - u0) / (v2 - v0)
    upper_slope = (u1 - u0) / (v1 - v0) if v1 > v0 else 0.0
    lower_slope = (u2 - u1) / (v2 - v1) if v2 > v1 else 0.0
    for row in range(first_row, last_row + 1):
        v = float(row)
        start = u0 + (v - v0) * long_slope
        end = u0 + (v - v0) * upper_slope if v < v1 else u1 + (v - v1) * lower_slope
        if start > end:
            start, end = end, start
        first = max(0, int(np.ceil(start - _OVERLAP)))
        last = min(width - 1, int(np.floor(end + _OVERLAP)))
        # The row's first pixel in float64, for a corner far outside the image is far to reckon from; then in float32.
        w_first, step = np.float32(w0 + along_v * (v - v0) + along_u * (first - u0)), np.float32(along_u)
        line = image[row]
        for column in range(first, last + 1):
            w = min(max(w_first + step * np.float32(column - first), least), greatest)
            line[column] = max(line[column], w)


@compiled(fastmath=False)  # which knows no infinity
def invert(images, farthest):
    """Turns 1/Z into Z in place; `inf` where nothing was hit or it lies beyond `farthest`."""
    for k in range(len(images)):
        image = images[k]
        for row in range(image.shape[0]):
            for column in range(image.shape[1]):
                w = image[row, column]
                z = _ONE / w if w > 0 else np.float32(np.inf)
                image[row, column] = z if z <= farthest else np.float32(np.inf)
