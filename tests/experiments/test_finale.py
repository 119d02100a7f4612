"""Both methods joined: the best of several starts, and what is told of the places."""

import itertools
from types import SimpleNamespace

import numpy as np
import pytest

from course_lib.rendering.renderer import DepthRenderer
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D
from courseware.experiments.finale import (
    FRAMES,
    VIEW_TURN,
    VIEWS,
    best_start,
    is_known,
    odometry,
    one_place,
    robot_states,
    summarize,
)
from tests.rendering.shapes import SMALL, furnished_room

TRUE = np.array([-1.2, 0.5, -0.3])


@pytest.fixture(scope="module")
def renderer():
    """A room whose floor is at z = -3, seen from a metre above z = 0."""
    with DepthRenderer(furnished_room(), SMALL) as opened:
        yield opened


OK = SimpleNamespace(status="ok", pose=Pose2D(TRUE[0] + 0.1, TRUE[1] - 0.08, TRUE[2] + 0.03), alternatives=())


def place(renderer, found, true=TRUE, blind=0):
    """What comes of a pose; the camera measures the map itself, but nothing in its first so many images."""
    captured = itertools.count()

    def capture(state, rng):
        depth = renderer.render(state)[0]
        return depth if next(captured) >= blind else np.full_like(depth, np.nan)

    return one_place(found, true, renderer, capture, np.random.default_rng(1))


def test_a_pose_that_is_decimetres_off_becomes_exact(renderer):
    result = place(renderer, OK)
    assert result["semantic_m"] == pytest.approx(np.hypot(0.1, 0.08))
    assert (result["reached"], result["starts"]) == (True, 1)
    assert result["position_m"] < 0.008


def test_of_several_poses_the_depth_camera_takes_the_right_one(renderer):
    poses = Pose2D(1.5, -0.5, 2.0), Pose2D(TRUE[0] + 0.05, TRUE[1], TRUE[2]), Pose2D(0.0, 2.0, 1.0)
    alternatives = tuple(SimpleNamespace(pose=pose) for pose in poses)
    result = place(renderer, SimpleNamespace(status="unable", pose=None, alternatives=alternatives))
    assert (result["starts"], result["reached"], "semantic_m" in result) == (3, True, False)
    states = robot_states(TRUE, np.random.default_rng(1))
    alone = best_start(renderer, poses[:1], renderer.render(states), seed=1)
    assert np.hypot(*(alone.state[:2] - TRUE[:2])) > 0.5


def test_a_robot_that_sees_nothing_turns_and_looks_again(renderer):
    """Two views are blind; the third looks where the first test looks, at furniture that leaves nothing open."""
    before = TRUE - [0.0, 0.0, 2 * VIEW_TURN]
    start = SimpleNamespace(status="ok", pose=Pose2D(OK.pose.x, OK.pose.y, before[2] + 0.03), alternatives=())
    result = place(renderer, start, before, blind=2 * FRAMES)
    assert (result["views"], result["reached"]) == (3, True), "the odometer carries the start on"


def test_a_robot_that_never_sees_anything_leaves_its_pose_open(renderer):
    result = place(renderer, OK, blind=np.inf)
    assert (result["views"], result["status"], result["reached"]) == (VIEWS, "open", False)
    assert summarize([result])["left_open"] == 1


def test_a_view_of_a_bare_wall_leaves_the_pose_open(renderer):
    def estimate(sigma_m, sigma_deg, status="tracked"):
        axis = np.array([sigma_m, 0.0, 0.0, 0.0, 0.0, np.deg2rad(sigma_deg)])
        return SimpleNamespace(status=status, error_covariance=np.diag(axis**2))

    assert is_known(estimate(0.02, 0.5))
    assert not is_known(estimate(0.20, 0.5)), "free to slide along the wall"
    assert not is_known(estimate(0.02, 5.0)), "free to turn"
    assert not is_known(estimate(0.02, 0.5, "doubtful"))


def test_the_odometer_is_a_few_percent_off_and_without_bias(rng):
    told = np.array([odometry(2.0, 0.5, rng) for _ in range(2000)])
    assert told.mean(axis=0) == pytest.approx([2.0, 0.5], abs=0.01)
    assert told.std(axis=0) == pytest.approx([0.1, np.hypot(0.025, np.deg2rad(1.0))], rel=0.1)
