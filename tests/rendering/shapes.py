"""Meshes whose depth image has a closed form, and random ones."""

import numpy as np
import trimesh

from course_lib.geometry import optical_pose
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.scene_map import SceneMap

SMALL = DepthCamera.from_fov(64, 48, 60, 45, near=0.1, far=15.0)
OFF_CENTRE = DepthCamera(61, 47, 55.0, 83.0, 21.3, 30.8, near=0.1, far=15.0)  # fx unlike fy, odd sizes


def wall(distance=2.0, half=50.0, offset=(0.0, 0.0, 0.0)):
    corners = np.array([[distance, y, z] for y, z in ((-half, -half), (half, -half), (half, half), (-half, half))])
    return SceneMap(corners + offset, np.array([[0, 1, 2], [0, 2, 3]]))


def rough_wall(rng, distance=0.9, half=3.0, edge=0.08, sigma=0.012):
    """`wall` as a survey has it: vertices every `edge` metres, each off by `sigma` along x."""
    ticks = np.arange(-half, half + edge, edge)
    y, z = (axis.ravel() for axis in np.meshgrid(ticks, ticks))
    n = len(ticks)
    corner = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    faces = corner[:, None, None] + np.array([[0, 1, n + 1], [0, n + 1, n]])
    return SceneMap(np.column_stack([distance + sigma * rng.standard_normal(n * n), y, z]), faces.reshape(-1, 3))


def _with_boxes(mesh, *boxes):
    boxes = [trimesh.creation.box(size, trimesh.transformations.translation_matrix(at)) for size, at in boxes]
    joined = trimesh.util.concatenate([mesh, *boxes])
    return SceneMap(joined.vertices, joined.faces)


def fence(distance=0.9, pitch=0.4):
    """A wall with posts that look alike, one every `pitch` metres along y, and a sill."""
    behind = wall(distance + 0.05)
    posts = [((0.1, 0.12, 6.0), (distance, y, 0.0)) for y in pitch * np.arange(-25, 26)]
    return _with_boxes(trimesh.Trimesh(behind.vertices, behind.faces), *posts, ((0.3, 40, 0.2), (distance, 0, -0.3)))


def room(size=6.0, offset=(0.0, 0.0, 0.0)):
    box = trimesh.creation.box((size, size, size))
    return SceneMap(box.vertices + offset, box.faces)


def furnished_room():
    """The cube with boxes on its floor, walls and ceiling, which look alike from no two places."""
    boxes = [
        ((1.2, 0.6, 2.0), (2.2, -1.5, -2.0)), ((0.8, 1.6, 0.7), (-1.0, 2.0, -2.65)),
        ((0.5, 0.5, 1.5), (1.5, 1.8, -2.25)), ((1.5, 0.9, 1.0), (-2.0, -1.2, -2.5)),
        ((0.4, 1.0, 0.8), (2.8, 0.9, 0.4)), ((0.5, 0.6, 1.3), (2.75, -0.5, 1.1)), ((1.1, 0.3, 0.5), (0.4, -2.85, 0.6)),
        ((0.7, 0.4, 0.4), (0.8, 0.2, 2.8)), ((0.3, 0.9, 0.5), (2.85, -2.2, 0.2)), ((0.9, 0.3, 1.2), (1.6, 2.85, 0.9)),
    ]  # fmt: skip
    return _with_boxes(trimesh.creation.box((6.0,) * 3), *boxes)


def room_depth(camera, states, size=6.0, offset=(0.0, 0.0, 0.0)):
    """Closed form of the depth inside `room`: the nearest wall along each pixel's ray. `(N, H, W)`."""
    poses = optical_pose(np.atleast_2d(states))
    directions = np.einsum("nij,hwj->nhwi", poses[:, :3, :3], camera.rays())
    origins = (poses[:, :3, 3] - np.asarray(offset))[:, None, None, :]
    with np.errstate(divide="ignore"):
        return ((np.sign(directions) * size / 2 - origins) / directions).min(axis=-1)


def random_triangles(n, rng, spread=8.0, edge=1.5):
    """A soup of n triangles with corners within `edge` of centres spread over a cube."""
    centres = rng.uniform(-spread / 2, spread / 2, (n, 1, 3))
    corners = centres + rng.uniform(-edge, edge, (n, 3, 3))
    return SceneMap(corners.reshape(-1, 3), np.arange(3 * n).reshape(-1, 3))


def random_states(n, rng, spread=3.0):
    states = rng.uniform(-spread, spread, (n, 6))
    states[:, 3:] = rng.uniform(-np.pi, np.pi, (n, 3))
    states[:, 4] /= 2
    return states
