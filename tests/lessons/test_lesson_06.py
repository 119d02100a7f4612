"""What lesson 06 says of outliers, of a person before the lens, of pixels and of its error bar holds."""

import numpy as np
import pytest

from course_lib.depth_mcl.fallon import depth_log_likelihood
from course_lib.lessons.lesson_06.exercises import importance_mean
from course_lib.lessons.lesson_06.forms import (
    FORMS,
    MISS_DEPTH,
    cost_of_a_pixel,
    gaussian_log_likelihood,
    peak,
    profile,
)
from course_lib.lessons.lesson_06.panel import PAPER, behind_a_person


def test_the_gaussian_is_a_sum_of_squares_and_a_miss_is_a_wall():
    images = np.array([[[2.0, 3.0], [4.0, 9.0]], [[2.1, 3.0], [3.8, 9.0]], [[2.0, np.inf], [4.0, 9.0]]])
    found = gaussian_log_likelihood(np.array([[2.0, 3.0], [4.0, np.nan]]), images)
    assert found == pytest.approx([0, -(1 + 4) / 2, -((MISS_DEPTH - 3) ** 2) / 0.02])


def test_the_drawn_cost_of_the_half_normal_is_that_of_the_library():
    l0, small, large = depth_log_likelihood(np.array([[5.0]]), np.array([[[5.0]], [[5.4]], [[6.0]]]))
    assert cost_of_a_pixel([0.4])["half-normal + uniform"] == pytest.approx((l0 - small) / (l0 - large), rel=1e-4)


def test_behind_a_person_the_papers_form_stands_at_the_truth_longest():
    off = {form: peak("x", profile(FORMS[form], "x", behind_a_person(0.8)))[0] for form in FORMS}
    assert off[PAPER] == 0 < min(off[form] for form in FORMS if form != PAPER)


def test_the_error_bar_of_exercise_06_4_is_the_scatter_of_the_weighted_means():
    x = np.random.default_rng(2).normal(0, 1, (1000, 200))
    means, errors = np.transpose([importance_mean(row, np.exp(-2 * (row - 1) ** 2), 1) for row in x])
    assert errors.mean() == pytest.approx(0.038, abs=0.0005), "as the task says"
    assert means.std() == pytest.approx(errors.mean(), rel=0.05)
    assert np.mean(np.abs(means - 0.8) < 2 * errors) == pytest.approx(0.95, abs=0.01)
