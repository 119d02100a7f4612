"""What lesson 05 says about clouds that walk holds, and 05.5 tells an answer that is rounded or simulated."""

import numpy as np
import pytest
from scipy.stats import norm

from course_lib.geometry import wrap_angle
from courseware.answers.lesson_05 import min_sigma
from courseware.lessons.kit.exercises import find_exercise, judge
from courseware.lessons.lesson_05.simulations import wagon_states, walk


def test_a_yaw_that_the_oracle_does_not_judge_does_a_random_walk():
    sigma = np.array([0.15, 0.04, 0, 0, 0, 0.03])
    ends = [walk(wagon_states()[:26], sigma, 50, seed, True).clouds[-1, 0, 5] for seed in range(60)]
    assert np.std(wrap_angle(np.array(ends) - wagon_states()[0, 5])) == pytest.approx(5 * 0.03, rel=0.35)


def simulated(step, n, frames, p):
    farthest = norm.ppf(np.random.default_rng(0).random((1000, frames)) ** (1 / n))
    return step / np.quantile(farthest.min(axis=1), 1 - p)


@pytest.mark.parametrize("answer", [simulated, lambda *given: round(min_sigma(*given), 3)])
def test_an_answer_to_05_5_that_is_rounded_or_simulated_is_told_so(answer):
    assert "simulated" in judge(find_exercise("05.5"), answer).message
