"""What lesson 06 says of a person before the lens and of its error bar holds."""

import numpy as np
import pytest

from courseware.answers.lesson_06 import importance_mean
from courseware.lessons.lesson_06.figures import PAPER, behind_a_person
from courseware.lessons.lesson_06.forms import FORMS, peak, profile


def test_behind_a_person_the_papers_form_stands_at_the_truth_longest():
    off = {form: peak("x", profile(FORMS[form], "x", behind_a_person(0.8)))[0] for form in FORMS}
    assert off[PAPER] == 0 < min(off[form] for form in FORMS if form != PAPER)


def test_the_error_bar_of_exercise_06_4_is_the_scatter_of_the_weighted_means():
    x = np.random.default_rng(2).normal(0, 1, (1000, 200))
    means, errors = np.transpose([importance_mean(row, np.exp(-2 * (row - 1) ** 2), 1) for row in x])
    assert errors.mean() == pytest.approx(0.038, abs=0.0005), "as the task says"
    assert means.std() == pytest.approx(errors.mean(), rel=0.05)
    assert np.mean(np.abs(means - 0.8) < 2 * errors) == pytest.approx(0.95, abs=0.01)
