"""The tools that the course's renderer is measured against: each renders the same poses of the same map.

A tool is made once from a map and a camera and then called with camera-to-world matrices `(N, 4, 4)`, optical
convention; it returns depth images `(N, H, W)`, or a part of them, and the seconds that count. What a tool needs to be
asked (rays, a plotter) is made outside the seconds that count: each is measured at its best.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap

# A loop that takes seconds for 200 images is run for so many of them and reckoned up.
LOOPED_IMAGES = 20


class Timed(NamedTuple):
    """What one call gave."""

    seconds: float
    """For all N images, reckoned up where only some were rendered."""
    images: np.ndarray
    """`(n, H, W)`, the first n; `inf` where nothing was hit."""


Tool = Callable[[np.ndarray], Timed]


def open3d_embree(scene_map: SceneMap, camera: DepthCamera) -> Tool:
    """Open3D's `RaycastingScene`, Intel's Embree on all processors: the casting alone, of rays that are ready."""
    import open3d as o3d

    anchor = scene_map.origin
    scene = o3d.t.geometry.RaycastingScene()
    scene.add_triangles(
        o3d.core.Tensor((scene_map.vertices - anchor).astype(np.float32)),
        o3d.core.Tensor(scene_map.faces.astype(np.uint32)),
    )
    rays = camera.rays().reshape(-1, 3)

    def cast(poses: np.ndarray) -> Timed:
        directions = np.einsum("nij,pj->npi", poses[:, :3, :3], rays)
        origins = np.broadcast_to((poses[:, :3, 3] - anchor)[:, None], directions.shape)
        tensor = o3d.core.Tensor(np.concatenate([origins, directions], axis=-1).astype(np.float32))
        begun = time.perf_counter()
        hits = scene.cast_rays(tensor)["t_hit"]
        seconds = time.perf_counter() - begun
        return Timed(seconds, hits.numpy().reshape(-1, *camera.shape))

    return cast


def course_backend(backend: str, scene_map: SceneMap, camera: DepthCamera, one_by_one: bool = False) -> Tool:
    """One of the course's own backends; one_by_one: a render and a read-back for each particle, half of them timed."""
    pixels = camera.width * camera.height if one_by_one else 200 * camera.width * camera.height
    renderer = DepthRenderer(scene_map, camera, backend, exact=True, max_batch_pixels=pixels)

    def render(poses: np.ndarray) -> Timed:
        asked = poses[:LOOPED_IMAGES] if one_by_one else poses
        begun = time.perf_counter()
        images = renderer.render_poses(asked)
        return Timed((time.perf_counter() - begun) * len(poses) / len(asked), images)

    return render


def pyvista_loop(scene_map: SceneMap, camera: DepthCamera) -> Tool:
    """PyVista as its documentation shows it: a plotter, a camera a particle, `get_image_depth`."""
    import pyvista as pv

    anchor = scene_map.origin
    faces = np.column_stack([np.full(len(scene_map.faces), 3), scene_map.faces])
    plotter = pv.Plotter(off_screen=True, window_size=(camera.width, camera.height), lighting="none")
    plotter.add_mesh(pv.PolyData(scene_map.vertices - anchor, faces.ravel()), lighting=False)
    plotter.disable_anti_aliasing()
    projection = pv.vtkmatrix_from_array(camera.projection_matrix())  # its own view angle takes fx for fy
    plotter.camera.SetUseExplicitProjectionTransformMatrix(True)
    plotter.camera.SetExplicitProjectionTransformMatrix(projection)
    plotter.show(auto_close=False)

    def render(poses: np.ndarray) -> Timed:
        images = np.empty((min(LOOPED_IMAGES, len(poses)), *camera.shape), dtype=np.float32)
        begun = time.perf_counter()
        for pose, image in zip(poses, images, strict=False):
            position = pose[:3, 3] - anchor
            plotter.camera.position, plotter.camera.focal_point = position, position + pose[:3, 2]
            plotter.camera.up = -pose[:3, 1]
            plotter.render()
            plotter.camera.clipping_range = (camera.near, camera.far)  # by which depths are read
            image[:] = -plotter.get_image_depth(fill_value=-np.inf, reset_camera_clipping_range=False)
        return Timed((time.perf_counter() - begun) * len(poses) / len(images), images)

    return render
