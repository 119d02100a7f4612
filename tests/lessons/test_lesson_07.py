"""The stepper steps as figure 1 does, and the error bar of exercise 07.4 is right."""

import numpy as np
import pytest

from courseware.answers.lesson_07 import stratified_error
from courseware.lessons.lesson_07.filter_stepper import stepper_panel
from courseware.lessons.lesson_07.simulations import copies


def test_buttons_step_in_the_order_of_figure_1_and_a_step_that_cannot_come_is_told_and_changes_nothing():
    panel = stepper_panel()
    for button, shown in (
        ("Weigh", "Not now: weigh comes after propagate; the last step was weigh.\nframe 1 of 23; last step: weigh"),
        ("Estimate", "estimate: off by"),
        ("Resample", "different particles"),
        ("Propagate", "frame 2 of 23; last step: propagate"),
        *[("Whole round", f"frame {frame} of 23; last step: estimate") for frame in range(3, 24)],
        ("Whole round", "the stretch ends here"),
        ("Reset", "frame 1 of 23; last step: weigh"),
    ):
        panel.press(button)
        assert shown in panel.draw(**panel.values()).summary


def test_the_error_bar_of_exercise_07_4_is_that_of_the_simulation():
    w, x = np.array([0.22] * 2 + [0.07] * 8), np.random.default_rng(1).normal(size=10)
    moved = copies("stratified", w, repeats=6000, seed=1) @ x / len(w)
    assert moved.std() == pytest.approx(stratified_error(w, x), rel=0.04)
