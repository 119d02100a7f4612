"""Memory stays flat over many renders and many renderers, and the same poses give the same images to the last bit."""

import numpy as np
import psutil
import pytest

from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap
from courseware.paths import data_path

STATES = np.array([[0.0, 0.0, 1.0, 0.0, 0.0, yaw] for yaw in (0.0, 0.7, 1.4, 2.1)])


def growth_mb(calls: int, render) -> float:
    """Call `render` often; return by how many MB this process grows from the second quarter to the last."""
    first, held = render(), []
    for _ in range(calls):
        np.testing.assert_array_equal(render(), first)
        held.append(psutil.Process().memory_info().rss / 2**20)
    return min(held[-calls // 4 :]) - min(held[calls // 4 : calls // 2])


@pytest.mark.slow
def test_memory_is_flat_and_images_stay_over_many_renders_and_renderers():
    """If each of the 200 kept its images that would be 40 MB."""
    scene_map, camera = SceneMap.load(data_path("corridor/map.ply")), DepthCamera.sr4000()

    def render_once() -> np.ndarray:
        with DepthRenderer(scene_map, camera, "raster") as renderer:
            return renderer.render(STATES)

    with DepthRenderer(scene_map, camera, "raster") as renderer:
        assert growth_mb(200, lambda: renderer.render(STATES)) < 8.0
    assert growth_mb(60, render_once) < 8.0
