"""Both methods joined: the best of several starts, and what is told of the places."""

from types import SimpleNamespace

import numpy as np
import pytest

from course_lib.experiments.finale import (
    FRAMES,
    LEVEL_SIGMA,
    VIEW_TURN,
    VIEWS,
    best_start,
    is_known,
    joined,
    odometry,
    one_place,
    robot_states,
    start_covariance,
    summarize,
)
from course_lib.geometry import wrap_angle
from course_lib.rendering.renderer import DepthRenderer
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D
from tests.rendering.shapes import SMALL, furnished_room

TRUE = np.array([-1.2, 0.5, -0.3])


@pytest.fixture(scope="module")
def renderer():
    """A room whose floor is at z = -3, seen from a metre above z = 0."""
    with DepthRenderer(furnished_room(), SMALL) as opened:
        yield opened


class Sensor:
    """A camera that measures the map itself."""

    def __init__(self, renderer):
        self.renderer = renderer

    def capture(self, caster, state, rng):
        return SimpleNamespace(depth=self.renderer.render(state)[0])


def place(renderer, found):
    return one_place(found, TRUE, renderer, Sensor(renderer), None, np.random.default_rng(1))


def test_a_pose_that_is_decimetres_off_becomes_exact(renderer):
    result = place(renderer, OK)
    assert result["semantic_m"] == pytest.approx(np.hypot(0.1, 0.08))
    assert result["reached"]
    assert result["position_m"] < 0.005
    assert result["starts"] == 1


def test_of_several_poses_the_depth_camera_takes_the_right_one(renderer):
    wrong = [Pose2D(1.5, -0.5, 2.0), Pose2D(0.0, 2.0, 1.0)]
    right = Pose2D(TRUE[0] + 0.05, TRUE[1], TRUE[2])
    alternatives = tuple(SimpleNamespace(pose=pose) for pose in (wrong[0], right, wrong[1]))
    result = place(renderer, SimpleNamespace(status="unable", pose=None, alternatives=alternatives))
    assert result["starts"] == 3
    assert result["reached"]
    assert "semantic_m" not in result
    states = robot_states(TRUE, np.random.default_rng(1))
    alone = best_start(renderer, [wrong[0]], renderer.render(states), seed=1)
    assert np.hypot(*(alone.state[:2] - TRUE[:2])) > 0.5


class Blind(Sensor):
    """A camera that measures nothing for so many images: it stands too near to a wall."""

    def __init__(self, renderer, images):
        super().__init__(renderer)
        self.images, self.captured = images, 0

    def capture(self, caster, state, rng):
        self.captured += 1
        depth = self.renderer.render(state)[0]
        return SimpleNamespace(depth=depth if self.captured > self.images else np.full_like(depth, np.nan))


OK = SimpleNamespace(status="ok", pose=Pose2D(TRUE[0] + 0.1, TRUE[1] - 0.08, TRUE[2] + 0.03), alternatives=())


def test_a_robot_that_sees_nothing_turns_and_looks_again(renderer):
    """Two views are blind; the third looks where the first test looks, at furniture that leaves nothing open."""
    before = TRUE - [0.0, 0.0, 2 * VIEW_TURN]
    start = SimpleNamespace(status="ok", pose=Pose2D(OK.pose.x, OK.pose.y, before[2] + 0.03), alternatives=())
    result = one_place(start, before, renderer, Blind(renderer, 2 * FRAMES), None, np.random.default_rng(1))
    assert result["views"] == 3
    assert result["reached"], "the odometer carries the start on"


def test_a_robot_that_never_sees_anything_leaves_its_pose_open(renderer):
    result = one_place(OK, TRUE, renderer, Blind(renderer, np.inf), None, np.random.default_rng(1))
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


SEMANTIC = np.array([[0.0025, 0.0005, 0.0002], [0.0005, 0.0036, -0.0001], [0.0002, -0.0001, 0.0004]])


def some_covariance(rng):
    mixing = rng.standard_normal((6, 6))
    return mixing @ mixing.T + np.eye(6)


def test_the_start_knows_the_semantic_pose_and_how_a_robot_stands():
    known = start_covariance(SEMANTIC)
    for a, i in enumerate((0, 1, 5)):
        for b, j in enumerate((0, 1, 5)):
            assert known[i, j] == SEMANTIC[a, b]
    assert np.diag(known)[2:5] == pytest.approx([LEVEL_SIGMA[0] ** 2, LEVEL_SIGMA[1] ** 2, LEVEL_SIGMA[1] ** 2])
    assert np.count_nonzero(known) == 9 + 3


def test_information_adds_up(rng):
    """P^-1 = P_0^-1 + P_1^-1, and the state is the mean weighed by these."""
    a, b, x, y = some_covariance(rng), some_covariance(rng), rng.uniform(-1, 1, 6), rng.uniform(-1, 1, 6)
    state, covariance = joined(x, a, y, b)
    information = np.linalg.inv(a) + np.linalg.inv(b)
    assert covariance == pytest.approx(np.linalg.inv(information), rel=1e-6, abs=1e-9)
    assert state == pytest.approx(np.linalg.solve(information, np.linalg.solve(a, x) + np.linalg.solve(b, y)))


def test_angles_are_joined_across_the_half_turn():
    start, state = np.zeros(6), np.zeros(6)
    start[5], state[5] = np.pi - 0.1, -np.pi + 0.3
    found, _ = joined(start, np.eye(6), state, np.eye(6))
    assert found[5] == pytest.approx(wrap_angle(np.pi + 0.1))
    assert start[5] == np.pi - 0.1, "what is given stays as it is"
