"""Memory stays flat over steps of the filter, and over renderers that come and go; `bench` has the long runs."""

import gc
import tracemalloc

import numpy as np
import psutil
import pytest

from course_lib.depth_mcl import DepthCamera, DepthRenderer, MonteCarloLocalizer
from tests.rendering.shapes import room

CAMERA = DepthCamera.from_fov(44, 36, 60.0, 50.0)


@pytest.fixture
def held():
    """A function that tells the bytes which Python and NumPy hold, garbage apart."""

    def tell():
        gc.collect()
        return tracemalloc.get_traced_memory()[0]

    tracemalloc.start()
    yield tell
    tracemalloc.stop()


def test_steps_of_the_filter_leave_nothing_behind(held):
    depth = np.full(CAMERA.shape, 1.5, dtype=np.float32)
    with DepthRenderer(room(), CAMERA) as renderer:
        localizer = MonteCarloLocalizer(renderer, n_particles=30, seed=2)
        localizer.initialize(np.zeros(6))
        for _ in range(20):
            localizer.step(depth)
        before = held()
        for _ in range(200):
            localizer.step(depth)
        # One depth image of one particle that stayed each time would be 1.3 MB.
        assert held() - before < 100_000


@pytest.mark.parametrize("backend", ["raster", "ray"])
def test_renderers_that_were_closed_leave_nothing_behind(backend, held):
    def draw_and_close():
        with DepthRenderer(room(), CAMERA, backend) as renderer:
            renderer.render(np.zeros((20, 6)))

    for _ in range(5):
        draw_and_close()
    before = held()
    for _ in range(30):
        draw_and_close()
    assert held() - before < 100_000


def test_windows_that_were_closed_leave_nothing_behind():
    process = psutil.Process()

    def open_draw_close():
        with DepthRenderer(room(), CAMERA, "vtk") as renderer:
            renderer.render(np.zeros((20, 6)))

    for _ in range(4):
        open_draw_close()
    before = process.memory_info().rss
    for _ in range(10):
        open_draw_close()
    # A window of 20 tiles with colour and depth, its buffers and its map, is some megabytes each.
    assert process.memory_info().rss - before < 15e6
