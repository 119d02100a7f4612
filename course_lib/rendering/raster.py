"""Fill a z-buffer in plain loops, compiled by Numba, as a graphics card does it, on every processor.

Chunks of the mesh are drawn, the nearest first. A chunk is skipped if no view can see it, or if all blocks of 8 x 8
pixels that it may cover hold nearer surfaces already. Each triangle is filled row by row, and each pixel keeps the
greatest 1/Z.

    u = fx X/Z + cx,    v = fy Y/Z + cy,    1/Z = a u + b v + c (0: nothing hit)
"""

from concurrent.futures import ThreadPoolExecutor

import numba
import numpy as np

from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.chunks import MeshChunks, chunks_in_view, inward_normals, lens_of, to_camera, world_to_cameras
from course_lib.rendering.compiled import compiled
from course_lib.rendering.scene_map import SceneMap

VIEWS_A_TASK = 8  # fewer cost more starts of tasks; with more, the last thread keeps the others waiting
BLOCK = 8  # pixels: edge of the blocks whose farthest depth is kept
CHUNKS_BETWEEN = 32  # chunks between two updates of the blocks, because an update reads every pixel
_OVERLAP = 1e-4  # pixels by which a row's ends are stretched, so that rounding leaves no gap between two triangles
_ONE = np.float32(1.0)


class RasterBackend:
    """Render views into plain arrays. Threads may share it, because `_mesh` is always replaced as a whole."""

    def __init__(self, scene_map: SceneMap, camera: DepthCamera) -> None:
        self._scene_map = scene_map
        self._chunks = MeshChunks(scene_map.vertices, scene_map.faces)
        self._vertices, self._vertex_starts, self._faces = self._chunks.with_own_vertices(
            scene_map.faces, scene_map.vertices
        )
        self._lens, self._sides = lens_of(camera), inward_normals(camera)
        self._mesh = self._about(scene_map.origin)

    def render(self, poses: np.ndarray, out: np.ndarray) -> None:
        """Fill `out` `(N, H, W)` with the depth seen from camera poses `(N, 4, 4)`."""
        wanted, (anchor, spheres, vertices) = self._scene_map.anchor(poses[:, :3, 3]), self._mesh
        if not np.array_equal(anchor, wanted):  # rarely: the cameras stay near the anchor
            anchor, spheres, vertices = self._mesh = self._about(wanted)
        rotations, positions = world_to_cameras(poses, anchor)

        def draw(start: int) -> None:
            views = slice(start, start + VIEWS_A_TASK)
            scratch = np.empty((6, int(np.diff(self._vertex_starts).max())))
            draw_views(
                out[views], rotations[views], positions[views], self._lens, self._sides, spheres,
                self._vertex_starts, vertices, self._chunks.starts, self._faces, scratch,
            )  # fmt: skip
            invert(out[views], self._lens[5])

        starts = range(0, len(poses), VIEWS_A_TASK)
        threads = min(numba.config.NUMBA_NUM_THREADS, len(starts))
        if threads == 1:
            list(map(draw, starts))
        else:
            # A pool for each call costs a tenth of a millisecond. A thread that stayed would be lost in a fork.
            with ThreadPoolExecutor(threads) as pool:
                list(pool.map(draw, starts))

    def _about(self, anchor: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the anchor `(3,)`, and the chunks' spheres and vertices about it in float32."""
        return anchor, self._chunks.spheres(anchor), (self._vertices - anchor).astype(np.float32)

    def describe(self) -> str:
        """Return the name of the backend, and on how many processors it runs."""
        return f"z-buffer in compiled loops on {numba.config.NUMBA_NUM_THREADS} processors (Numba)"


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
def cover(rotation, position, lens, sphere, height, width):
    """Return the blocks (first, last row; first, last column) that a sphere may cover; all if it is near the camera."""
    x, y, z = to_camera(rotation, position, sphere[0], sphere[1], sphere[2])
    radius = sphere[3]
    front, back = z - radius, z + radius
    last_row, last_column = (height - 1) // BLOCK, (width - 1) // BLOCK
    if front <= lens[4]:
        return 0, last_row, 0, last_column
    # The sides of the ball's bounding box, as its front shows them if that is farther out, else its back.
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
    """Return whether all pixels of the blocks in the rectangle hold a surface nearer than Z = `nearest`."""
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
    """Write the least 1/Z of each block."""
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
    """Write u, v, 1/Z and X, Y, Z of vertices `(n, 3)` into the first n columns of `scratch`."""
    for i in range(len(vertices)):
        x, y, z = to_camera(rotation, position, vertices[i, 0], vertices[i, 1], vertices[i, 2])
        inverse = 1.0 / z if z > lens[4] else 0.0
        scratch[0, i] = lens[0] * x * inverse + lens[2]
        scratch[1, i] = lens[1] * y * inverse + lens[3]
        scratch[2, i] = inverse
        scratch[3, i], scratch[4, i], scratch[5, i] = x, y, z


@compiled()
def draw_faces(image, scratch, lens, faces):
    """Fill triangles `(F, 3)` of projected vertices; a triangle that reaches before the near plane is cut there."""
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
    """Fill the part of one triangle that lies behind the near plane: a polygon of three or four corners."""
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
    """Raise each pixel whose centre lies in the triangle to the triangle's 1/Z there, if that is greater."""
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
        # The row's first pixel in float64, for a corner far outside the image is far away; then in float32.
        w_first, step = np.float32(w0 + along_v * (v - v0) + along_u * (first - u0)), np.float32(along_u)
        line = image[row]
        for column in range(first, last + 1):
            w = min(max(w_first + step * np.float32(column - first), least), greatest)
            line[column] = max(line[column], w)


@compiled(fastmath=False)  # because fast mathematics assumes that there is no infinity
def invert(images, farthest):
    """Turn 1/Z into Z in place; `inf` where nothing was hit or it lies beyond `farthest`."""
    for k in range(len(images)):
        image = images[k]
        for row in range(image.shape[0]):
            for column in range(image.shape[1]):
                w = image[row, column]
                z = _ONE / w if w > 0 else np.float32(np.inf)
                image[row, column] = z if z <= farthest else np.float32(np.inf)
