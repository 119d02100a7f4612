"""What lesson 01 says about turns, gimbal lock and its panel holds."""

import numpy as np
import pytest

from course_lib.geometry import pose_matrix
from course_lib.lessons.kit.corridor_views import corridor_cut
from course_lib.lessons.kit.exercises import find_exercise, judge
from course_lib.lessons.lesson_01.panel import drive_panel
from course_lib.lessons.lesson_01.poses import matrix_text, turn_per_degree


def turned(**angles_deg):
    state = np.zeros(6)
    for name, angle in angles_deg.items():
        state[("roll", "pitch", "yaw").index(name) + 3] = np.deg2rad(angle)
    return pose_matrix(state)[:3, :3]


def test_yaw_turns_left_pitch_looks_down_and_roll_lifts_the_left_side():
    assert turned(yaw=30)[1, 0] == pytest.approx(0.5)
    assert turned(pitch=30)[2, 0] == pytest.approx(-0.5)
    assert turned(roll=30)[2, 1] == pytest.approx(0.5)


def test_without_roll_the_left_axis_is_level():
    for pitch, yaw in ((20, 40), (-70, 130), (89, -5)):
        assert turned(pitch=pitch, yaw=yaw)[2, 1] == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize("pitch_deg", [0, 18, 60, 85, -45])
def test_the_least_and_greatest_turn_follow_their_closed_form(pitch_deg):
    sine = abs(np.sin(np.deg2rad(pitch_deg)))
    assert turn_per_degree(np.deg2rad(pitch_deg)) == pytest.approx((np.sqrt(1 - sine), np.sqrt(1 + sine)), abs=1e-3)


def test_a_matrix_is_printed_without_minus_zero():
    text = matrix_text(pose_matrix(np.array([1.0, 2.0, 3.0, 0.0, -1e-9, np.pi])))
    assert "-0.00" not in text
    assert text.splitlines()[1].split() == ["x", "-1.00", "0.00", "0.00", "1.00"]


def test_the_corridor_is_cut_into_lines_near_its_walls_and_floor():
    plan = corridor_cut(2, 1.2)
    assert plan.shape[1:] == (2, 2)
    near = plan[(plan[:, 0, 0] > 3.5) & (plan[:, 0, 0] < 5.5)]
    assert np.abs(near[..., 1]).min() > 0.9
    side = corridor_cut(1, 0.0)
    assert np.isclose(side[..., 1], 0, atol=0.05).mean() > 0.2


def test_yaw_180_and_minus_180_show_the_same_and_lock_makes_roll_and_yaw_one():
    panel = drive_panel()
    at = panel.defaults()
    assert panel.draw(**(at | {"yaw": 180})).summary == panel.draw(**(at | {"yaw": -180})).summary
    down = at | {"pitch": 90, "x": 17.6}
    rolled, yawed = panel.draw(**(down | {"roll": 30})), panel.draw(**(down | {"yaw": -30}))
    assert rolled.summary == yawed.summary
    assert rolled.summary != panel.draw(**down).summary


def euler_of_scipy(matrix):
    from scipy.spatial.transform import Rotation

    body = matrix[:3, :3] @ np.array([[0.0, -1, 0], [0, 0, -1], [1, 0, 0]])
    return np.r_[matrix[:3, 3], Rotation.from_matrix(body).as_euler("ZYX")[::-1]]


def world_by_loop(points, state):
    return [(pose_matrix(state) @ [p[2], -p[0], -p[1], 1.0])[:3] for p in points]


ANSWERS = [
    ("01.1", world_by_loop),
    ("01.2", euler_of_scipy),
]


@pytest.mark.parametrize(("number", "answer"), ANSWERS, ids=[number for number, _ in ANSWERS])
def test_another_way_to_the_right_values_passes(number, answer):
    assert all(judge(find_exercise(number), answer, seed).status == "right" for seed in range(8))
