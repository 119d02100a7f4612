"""Project P1: the arguments of a submission, the budget of renders, and the value of an answer."""

import numpy as np
import pytest

from courseware.answers.project_1_task import PROJECT, measure, no_later_frames, prepare
from courseware.lessons.kit.projects import AnswerError, one_outcome

SEED = 10_001


def test_a_seed_has_its_own_recording_and_the_value_is_the_median_horizontal_error():
    task, other = prepare(SEED), prepare(SEED + 1)
    assert np.abs(other.truth[0] - task.truth[0]).max() > 0.1 > np.linalg.norm(task.arguments[3] - task.truth[0][0])
    task.arguments[2][:] = 0
    assert np.isnan(prepare(SEED).arguments[2]).any(), "a submission cannot change the recording"
    found = task.truth[0] + [0.03, 0.04, 1, 0, 0, 0]  # height does not count
    found[:5, 0] += 2
    assert measure(task, found.tolist()).value == pytest.approx(50)
    for answer, words in ((found[:-1], "one estimate"), ("here", "no array"), (np.nan * found, "NaN .* frame 0")):
        with pytest.raises(AnswerError, match=words):
            measure(task, answer)


def test_the_budget_ends_and_estimates_that_use_later_frames_are_refused():
    outcome = one_outcome(PROJECT, lambda renderer, *_: renderer.render(np.zeros((1601, 6))), SEED)
    assert "the budget of 1600 renders is spent" in outcome.remark
    no_later_frames(prepare(SEED), lambda *given: np.ones((len(given[2]), 6)), np.ones((40, 6)))
    with pytest.raises(AnswerError, match="when it is not given the later ones"):
        no_later_frames(prepare(SEED), lambda *given: np.full((len(given[2]), 6), len(given[2])), np.full((40, 6), 40))
