"""`near` and `far` mean one thing in all three paths: the z-buffer, ray casting, and eq. (7) in NumPy."""

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from course_lib.geometry import optical_pose
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap
from course_lib.rendering.sensor import depth_image_from_points

# Half a metre to both sides of the outer rays of a board one metre away.
BOARD = np.array([[-1.5, -1.2, 1.0], [1.5, -1.2, 1.0], [1.5, 1.2, 1.0], [-1.5, 1.2, 1.0]])

cameras = st.builds(
    lambda near, ratio: DepthCamera(16, 12, 9.0, 11.0, 6.7, 6.1, near=near, far=near * ratio),
    near=st.floats(0.02, 1.0),
    ratio=st.floats(2.0, 300.0),
)
states = st.tuples(*[st.floats(-80.0, 80.0)] * 3, *[st.floats(-3.0, 3.0)] * 3).map(np.array)
# Steps of float32 at the plane, to either side of it.
rounding = st.integers(-2, 2).map(lambda steps: 1.0 + steps * 2.0**-23)


def board_map(depth, state):
    """A board across the view at this depth, wider than the view."""
    pose = optical_pose(state[None])[0]
    return SceneMap(depth * BOARD @ pose[:3, :3].T + pose[:3, 3], np.array([[0, 1, 2], [0, 2, 3]]))


def seen(depth, camera, state):
    """Share of the pixels on which a board at this depth is seen: by each path, views and points."""
    points = depth * camera.rays()
    shares = {"NumPy": np.isfinite(depth_image_from_points(points, camera)).mean()}
    for backend in ("raster", "vtk", "ray"):
        with DepthRenderer(board_map(depth, state), camera, backend) as renderer:
            shares[f"{backend}, views"] = np.isfinite(renderer.render(state)).mean()
            shares[f"{backend}, points"] = np.isfinite(renderer.render_points(points)).mean()
    return shares


# Each example opens two windows, so a failing one is not made smaller by trying hundreds more.
few = settings(max_examples=15, deadline=None, derandomize=True, phases=(Phase.explicit, Phase.generate))


@pytest.mark.parametrize("plane", ["near", "far"])
@few
@given(camera=cameras, state=states, factor=rounding)
def test_a_surface_on_a_plane_or_within_rounding_of_it_is_seen_by_all(plane, camera, state, factor):
    assert set(seen(getattr(camera, plane) * factor, camera, state).values()) == {1.0}


@few
@given(camera=cameras, state=states)
def test_a_surface_beyond_a_plane_is_seen_by_none(camera, state):
    step = camera.far**2 / (camera.near * 2**24)  # of the z-buffer
    for depth in (camera.far + 1e-3 + 8 * step, 0.97 * camera.near):
        assert set(seen(depth, camera, state).values()) == {0.0}


def test_the_planes_are_wider_by_rounding_alone():
    camera = DepthCamera.sr4000(near=0.1, far=15.0)
    assert camera.near - 2e-4 < camera.nearest < camera.near
    assert camera.far < camera.farthest < camera.far + 1e-3
    near = camera.with_clip_planes(0.001, 1.0).nearest
    assert 0.98e-3 < near < 0.001


@pytest.mark.parametrize("backend", ["raster", "vtk", "ray"])
def test_a_surface_just_before_near_does_not_hide_the_one_on_far(backend):
    camera = DepthCamera(16, 12, 9.0, 11.0, 6.7, 6.1, near=0.5, far=4.0)
    state = np.array([1.0, 2.0, 3.0, 0.1, 0.2, 0.3])
    boards = [board_map(0.49, state), board_map(4.0, state)]
    vertices = np.concatenate([board.vertices for board in boards])
    both = SceneMap(vertices, np.concatenate([boards[0].faces, boards[1].faces + 4]))
    with DepthRenderer(both, camera, backend) as renderer:
        assert np.abs(renderer.render(state) - 4.0).max() < 1e-3
