"""Lesson 01: what it says of turns and of gimbal lock."""

import numpy as np
import pytest

from courseware.lessons.lesson_01.figures import drive_panel, turn_per_degree


@pytest.mark.parametrize("pitch_deg", [0, 18, 60, 85, -45])
def test_the_least_and_greatest_turn_follow_their_closed_form(pitch_deg):
    sine = abs(np.sin(np.deg2rad(pitch_deg)))
    assert turn_per_degree(np.deg2rad(pitch_deg)) == pytest.approx((np.sqrt(1 - sine), np.sqrt(1 + sine)), abs=1e-3)


def test_yaw_180_and_minus_180_show_the_same_and_lock_makes_roll_and_yaw_one():
    panel = drive_panel()

    def said(**values):
        return panel.draw(**(panel.defaults() | values)).summary

    assert said(yaw=180) == said(yaw=-180)
    assert said(pitch=90, x=17.6, roll=30) == said(pitch=90, x=17.6, yaw=-30) != said(pitch=90, x=17.6)
