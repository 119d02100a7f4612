"""What lesson 03 measures on a z-buffer: its error and its step, seconds a view, thin things that are missed."""

import time

import numpy as np

from course_lib.lessons.kit.progress_bar import progress
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap

# Bits that tell depths apart in a depth buffer, whether 24-bit whole numbers or float32 just below 1.
DEPTH_BUFFER_BITS = 24


def slanted_wall_error(near: float) -> np.ndarray:
    """|z-buffer - exact depth| [m] at every pixel, for a wall about 7.5 m ahead, turned by 30 degrees."""
    camera = DepthCamera.sr4000(near=near)
    turn = np.deg2rad(30)
    along, up = np.array([np.sin(turn), np.cos(turn), 0.0]), np.array([0.0, 0.0, 1.0])
    middle = np.array([7.5, 0.0, 0.0])
    corners = [middle + a * along + b * up for a, b in ((-9, -9), (9, -9), (9, 9), (-9, 9))]
    with DepthRenderer(SceneMap(np.array(corners), np.array([[0, 1, 2], [0, 2, 3]])), camera, "vtk") as renderer:
        image = renderer.render(np.zeros(6))[0]
    # Plane n . p = d in the body frame (x forward, y left): with p = Z (1, -ray x, -ray y), Z = d / (n . (1, ...)).
    normal = np.cross(along, up)
    rays = camera.rays()
    exact = (normal @ middle) / (normal[0] - normal[1] * rays[..., 0] - normal[2] * rays[..., 1])
    return np.abs(image - exact)


def seconds_per_view(
    scene_map: SceneMap, camera: DepthCamera, states: np.ndarray, counts: list[int], repeats: int = 4
) -> tuple[np.ndarray, np.ndarray]:
    """Seconds a view for each count, the best of a few repeats: as tiles of one window, and one after the other."""
    tiled, single = np.full((2, len(counts)), np.inf)

    def renderer() -> DepthRenderer:
        return DepthRenderer(scene_map, camera, "vtk", exact=True)

    with renderer() as window, renderer() as alone:
        for _ in progress(range(repeats), "measuring times"):
            for index, count in enumerate(counts):
                started = time.perf_counter()
                window.render(states[:count])
                between = time.perf_counter()
                for state in states[:count]:
                    alone.render(state)
                tiled[index] = min(tiled[index], (between - started) / count)
                single[index] = min(single[index], (time.perf_counter() - between) / count)
    return tiled, single


def views_that_see(scene_map: SceneMap, n_views: int = 200) -> float:
    """Share of views, turned a little from one to the next, in which at least one pixel hits the map."""
    camera = DepthCamera(width=176, height=1, fx=220.0, fy=231.2, cx=87.5, cy=0.0)
    states = np.zeros((n_views, 6))
    states[:, 5] = np.linspace(-0.1, 0.1, n_views)
    with DepthRenderer(scene_map, camera) as renderer:
        return np.isfinite(renderer.render(states)).any(axis=(1, 2)).mean()


def buffer_step(z: np.ndarray | float, near: float, far: float) -> np.ndarray | float:
    """Depth in metres between two neighbouring values of the depth buffer at depth z: dZ/db 2^-24."""
    return z**2 * (far - near) / (near * far) * 2.0**-DEPTH_BUFFER_BITS
