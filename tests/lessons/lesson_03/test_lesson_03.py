"""What lesson 03 says about its panel and its z-buffer holds."""

import numpy as np
import pytest

from course_lib.lessons.lesson_03.exercises import cut_at_near, off_the_cut
from course_lib.lessons.lesson_03.measurements import buffer_step, slanted_wall_error
from course_lib.lessons.lesson_03.panel import camera_panel
from course_lib.lessons.lesson_03.scenes import corridor
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer


def corridor_views(states: list[list[float]], near: float = 0.1, backend: str = "vtk") -> np.ndarray:
    with DepthRenderer(corridor(), DepthCamera.sr4000(near=near), backend) as renderer:
        return renderer.render(np.array(states, dtype=float))


def test_a_side_wall_does_not_tell_x_but_the_open_end_does():
    left = np.pi / 2
    views = corridor_views([[x, 0, 1.2, 0, 0, left] for x in (0.5, 3.0, 3.1)])
    assert np.isinf(views[0]).mean() > 0.05
    np.testing.assert_allclose(views[1], 1.5, atol=0.001)
    np.testing.assert_allclose(views[1], views[2], atol=0.001)


def test_the_crate_grows_more_on_the_screen_than_the_pillar_and_the_wall():
    spans = {"crate": ([-0.8, -0.3], 4.0), "pillar": ([0.5, 0.8], 5.0), "wall": ([-1.5, 1.5], 8.0)}
    camera, wider = DepthCamera.sr4000(), {}
    for name, (y, front) in spans.items():
        assert np.isclose(corridor().vertices[:, 0], front).any()
        before, after = (np.array([[-y[0], 0, front - x], [-y[1], 0, front - x]]) for x in (0.5, 0.6))
        wider[name] = np.ptp(camera.project(after)[0]) / np.ptp(camera.project(before)[0])
    assert wider["crate"] > wider["pillar"] > wider["wall"] > 1


def test_a_near_plane_cuts_the_pillar_away_for_the_z_buffer_and_for_ray_casting_alike():
    state = [[4.7, 0.6, 1.2, 0, 0, 0]]
    assert corridor_views(state)[0, 72, 88] == pytest.approx(0.3, abs=0.001)
    for backend in ("vtk", "ray"):
        assert corridor_views(state, 1.0, backend)[0, 72, 88] == pytest.approx(3.3, abs=0.001)
    panel = camera_panel()
    summary = panel.draw(**(panel.defaults() | {"x": 4.7, "y": 0.6, "near": "1"})).summary
    assert "more than 1 mm off: 0%" in summary


def test_the_bright_line_at_the_start_is_crate_against_wall():
    state = [[0.5, 0, 1.2, 0, 0, 0]]
    images = np.stack([corridor_views(state)[0], corridor_views(state, backend="ray")[0]])
    off = np.abs(images[0] - images[1]) > 0.001
    assert off.mean() < 0.005
    nearer, farther = images[:, off].min(axis=0), images[:, off].max(axis=0)
    assert ((nearer < 4.6) & (nearer < farther)).all()


def test_a_step_of_the_buffer_with_near_a_tenth_of_a_millimetre_is_centimetres_and_far_hardly_matters():
    assert buffer_step(7.5, 0.0001, 30.0) == pytest.approx(0.0335, abs=0.0005)
    assert slanted_wall_error(0.0001).max() > 0.03
    assert buffer_step(7.5, 0.1, 11.0) == pytest.approx(buffer_step(7.5, 0.1, 30.0), rel=0.01)


TRIANGLE = np.array([[0.0, 0, 3], [4, 0, -1], [0, 2, 3]])


def test_a_cut_triangle_may_begin_anywhere_and_go_round_either_way():
    cut = cut_at_near(TRIANGLE, 1.0)
    np.testing.assert_allclose(cut, [[0, 0, 3], [2, 0, 1], [2, 1, 1], [0, 2, 3]])
    for polygon in (cut, np.roll(cut, 2, axis=0), cut[::-1], cut.tolist()):
        assert off_the_cut((TRIANGLE, 1.0), polygon) is None
    assert "crosses itself" in off_the_cut((TRIANGLE, 1.0), cut[[0, 2, 1, 3]])
    assert "should have 4" in off_the_cut((TRIANGLE, 1.0), cut[:3])
    assert "before the near plane" in off_the_cut((TRIANGLE, 1.0), TRIANGLE)
    assert "not their places" in off_the_cut((TRIANGLE, 1.0), np.add(cut, [0.1, 0, 0]))


def test_a_corner_on_the_plane_counts_once_and_nothing_left_is_nothing():
    touching = np.array([[0.0, 0, 1], [4, 0, -1], [0, 2, 3]])
    assert off_the_cut((touching, 1.0), cut_at_near(touching, 1.0)) is None
    assert off_the_cut((touching, 1.0), [[0, 0, 1], [2, 1, 1], [0, 2, 3]]) is None
    assert off_the_cut((TRIANGLE - [0, 0, 9], 1.0), []) is None
    assert off_the_cut((TRIANGLE - [0, 0, 9], 1.0), np.empty((0, 3))) is None
