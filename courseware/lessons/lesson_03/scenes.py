"""Small scenes of lesson 03, and what it measures on them: a z-buffer's error and step, seconds a view, thin things."""

import time

import numpy as np

from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap
from courseware.lessons.kit.box_world import box_map
from courseware.lessons.kit.opengl import vtk
from courseware.lessons.kit.progress_bar import progress

END_WALL, PILLAR = ((8.0, -1.5, 0.0), (8.2, 1.5, 2.6)), ((5.0, 0.5, 0.0), (5.3, 0.8, 2.6))
CRATE = ((4.0, -0.8, 0.0), (4.5, -0.3, 0.7))
FLOOR, CEILING = ((0.0, -1.5, -0.1), (8.2, 1.5, 0.0)), ((0.0, -1.5, 2.6), (8.2, 1.5, 2.7))
LEFT, RIGHT = ((0.0, 1.5, 0.0), (8.2, 1.6, 2.6)), ((0.0, -1.6, 0.0), (8.2, -1.5, 2.6))


def corridor_end() -> SceneMap:
    """Return a corridor's end: the end wall (8 m), a pillar (5 m) and a crate (4 m)."""
    return box_map(END_WALL, PILLAR, CRATE)


def corridor() -> SceneMap:
    """Return a corridor with the same end, 3 m wide, 2.6 m high, 8 m long."""
    return box_map(END_WALL, PILLAR, CRATE, FLOOR, CEILING, LEFT, RIGHT)


def wall_with_hole(radius: float) -> SceneMap:
    """Return a wall of small triangles 4 m ahead, 6 m by 6 m, with a hole of this radius [m] in its middle."""
    n = 121
    y, z = np.meshgrid(np.linspace(-3, 3, n), np.linspace(-3, 3, n))
    vertices = np.column_stack([np.full(n * n, 4.0), y.ravel(), z.ravel()])
    first = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()[:, None]
    faces = np.concatenate([first + np.array(corners) for corners in ([0, 1, n], [1, n + 1, n])])
    return SceneMap(vertices, faces[np.hypot(*vertices[faces].mean(axis=1)[:, 1:].T) > radius])


def buffer_step(z: float, near: float, far: float) -> float:
    """Return the depth [m] between two neighbouring values of a depth buffer of 24 bits at depth z [m]: dZ/db 2^-24."""
    return z**2 * (far - near) / (near * far) * 2.0**-24


def slanted_wall_error(near: float) -> np.ndarray:
    """Return |z-buffer - exact depth| [m] at every pixel, for a wall about 7.5 m ahead, turned by 30 degrees."""
    camera, turn = DepthCamera.sr4000(near=near), np.deg2rad(30)
    along, up, middle = np.array([np.sin(turn), np.cos(turn), 0]), np.array([0, 0, 1]), np.array([7.5, 0, 0])
    corners = np.array([middle + a * along + b * up for a, b in ((-9, -9), (9, -9), (9, 9), (-9, 9))])
    with DepthRenderer(SceneMap(corners, np.array([[0, 1, 2], [0, 2, 3]])), camera, vtk()) as renderer:
        image = renderer.render(np.zeros(6))[0]
    # Plane n . p = d in the body frame (x forward, y left): with p = Z (1, -ray x, -ray y), Z = d / (n . (1, ...)).
    normal = np.cross(along, up)
    return np.abs(image - normal @ middle / (normal[0] - normal[1] * camera.rays()[..., 0]))


def seconds_per_view(scene_map: SceneMap, camera: DepthCamera, states: np.ndarray, counts: list[int]) -> np.ndarray:
    """Return seconds a view (2, counts), the best of four repeats: as tiles of one window, and one after the other."""
    window, alone = (DepthRenderer(scene_map, camera, vtk(), exact=True) for _ in range(2))
    seconds = np.zeros((4, 2, len(counts)))
    with window, alone:
        for repeat in progress(range(4), "measuring times"):
            for index, count in enumerate(counts):
                times = [time.perf_counter()]
                window.render(states[:count])
                times.append(time.perf_counter())
                for state in states[:count]:
                    alone.render(state)
                seconds[repeat, :, index] = np.diff([*times, time.perf_counter()]) / count
    return seconds.min(axis=0)


def views_that_see(scene_map: SceneMap, n_views: int) -> float:
    """Return the share of views, each turned a little, in which at least one pixel hits the map."""
    states = np.outer(np.linspace(-0.1, 0.1, n_views), [0, 0, 0, 0, 0, 1])
    with DepthRenderer(scene_map, DepthCamera(width=176, height=1, fx=220.0, fy=231.2, cx=87.5, cy=0.0)) as renderer:
        return np.isfinite(renderer.render(states)).any(axis=(1, 2)).mean()
