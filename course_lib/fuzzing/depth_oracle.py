"""Are the depths of an accepted map those of its triangles? Our z-buffer beside plain ray casting in float64."""

from __future__ import annotations

import numpy as np

from course_lib.depth_mcl.camera import DepthCamera
from course_lib.depth_mcl.rendering.renderer import DepthRenderer
from course_lib.depth_mcl.scene_map import SceneMap
from course_lib.geometry import optical_pose

CONTRACT = 1e-3
"""Metres: depths stay within it for any map that is accepted."""
JITTER = 0.02
"""Pixels: beside an edge, either of its sides is right."""
VIEWS = np.array([[0.3, 0.2, 0.1, 0.02, 0.05, 0.4], [-1.0, 0.5, -0.2, 0.0, 0.1, -2.0]])
"""Where the reference views are taken, states `(2, 6)`: inside the room of the samples."""
CAMERA = DepthCamera(32, 24, 24.0, 24.0, 15.5, 11.5, 0.1, 12.0)
PLANES = ((CAMERA.near, CAMERA.far), (CAMERA.nearest, CAMERA.farthest))
"""What lies between a plane and what rounding may make of it, may be seen or not."""


def depths_agree(vertices: np.ndarray, faces: np.ndarray) -> bool:
    """Whether each pixel's depth is within a millimetre of one that exact ray casting gives there."""
    scene_map = SceneMap(vertices, faces)
    with DepthRenderer(scene_map, CAMERA, exact=True) as renderer:
        rendered = renderer.render(VIEWS).astype(np.float64)
    return all(_agree(image, vertices[faces], state) for image, state in zip(rendered, VIEWS, strict=True))


def _agree(image: np.ndarray, corners: np.ndarray, state: np.ndarray) -> bool:
    fine = np.zeros(image.shape, bool)
    for planes in PLANES:
        steps = (0, JITTER, -JITTER)
        casts = np.stack([ray_cast(corners, state, du, dv, planes) for du in steps for dv in steps])
        with np.errstate(invalid="ignore"):
            fine |= (image >= casts.min(axis=0) - CONTRACT) & (image <= casts.max(axis=0) + CONTRACT)
    return bool(fine.all())


def ray_cast(
    corners: np.ndarray,
    state: np.ndarray,
    du: float = 0.0,
    dv: float = 0.0,
    planes: tuple[float, float] = (CAMERA.near, CAMERA.far),
) -> np.ndarray:
    """Depth `(H, W)` of triangles `(F, 3, 3)` from a state `(6,)`, float64, `inf` where nothing is hit.

    du, dv: pixels beside the pixels' centres. planes: the least and greatest depth that is seen. Both sides of a
    triangle are seen. Source: T. Moeller, B. Trumbore, "Fast, minimum storage ray/triangle intersection", 1997.
    """
    pose = optical_pose(np.asarray(state))
    local = (corners - pose[:3, 3]) @ pose[:3, :3]  # to the camera's axes: x right, y down, z forward
    column, row = np.meshgrid(np.arange(CAMERA.width) + du, np.arange(CAMERA.height) + dv)
    rays = np.stack([(column - CAMERA.cx) / CAMERA.fx, (row - CAMERA.cy) / CAMERA.fy, np.ones_like(column)], axis=-1)
    depth = np.full(column.shape, np.inf)
    for a, b, c in local:
        e1, e2 = b - a, c - a
        p = np.cross(rays, e2)
        det = p @ e1
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            u = (p @ -a) / det
            q = np.cross(-a, e1)
            v = (rays @ q) / det
            t = (e2 @ q) / det
            hit = (u >= 0) & (v >= 0) & (u + v <= 1) & (t >= planes[0]) & (t <= planes[1])
        depth = np.where(hit & (t < depth), t, depth)
    return depth
