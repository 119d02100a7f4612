"""Lesson 08's filter along the corridor follows and gets lost as the text says; frames are worth what is said."""

import numpy as np
import pytest

from courseware.answers.lesson_08 import effective_frames
from courseware.lessons.lesson_08.panel import OFFSETS, AgreementTable, localize_along
from courseware.lessons.lesson_08.stored import stored_runs


def test_with_too_little_noise_it_lags_and_only_the_timed_error_and_the_score_say_so():
    true, path = np.zeros((24, 6)), np.zeros((2001, 3))  # a wagon rolls 0.1 m a frame along a straight path
    true[:, 0], path[:, 0] = 8 + 0.1 * np.arange(24), np.linspace(0, 20, 2001)
    table = AgreementTable(true, path, np.tile(0.3 + 0.4 / (1 + np.abs(OFFSETS) / 0.15), (24, 1)))
    good, lost = (localize_along(table, 200, sigma, beta=0.01, start_error=0.0, seed=1) for sigma in (0.15, 0.01))
    assert good.timed.errors.max() < 0.05
    assert lost.timed.errors[-1] > 0.5 > 0.01 > lost.nearest.errors.max()
    assert lost.scores[-1] < 0.8 * lost.scores[0]
    assert np.median(lost.best_weights) > 0.5


def test_frames_are_worth_what_a_simulation_of_their_mean_says_and_the_304_frames_what_the_solution_says():
    apart = np.abs(np.arange(40)[:, None] - np.arange(40))
    errors = np.random.default_rng(1).multivariate_normal(np.zeros(40), 0.9**apart, size=3000)
    assert 1 / np.var(errors.mean(axis=1)) == pytest.approx(effective_frames(40, 0.9), rel=0.08)
    near = [stored_runs()[0].columns[f"{method}_nearest_m"] for method in ("proposed", "fallon")]
    worth = [effective_frames(304, np.corrcoef(errors[:-1], errors[1:])[0, 1].round(2)) for errors in near]
    assert [round(frames) for frames in worth] == [164, 2]
