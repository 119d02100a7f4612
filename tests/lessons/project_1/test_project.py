"""Project P1: what a submission is given, the budget of renders, and what its answer is worth."""

import numpy as np
import pytest

from course_lib.lessons.kit.projects import AnswerError, one_outcome
from course_lib.lessons.project_1 import recordings
from course_lib.lessons.project_1.project import PROJECT, measure, no_later_frames, prepare
from course_lib.lessons.project_1.recordings import FRAMES, PARTICLES, BudgetError, CountedRenderer

SEED = 10_001


@pytest.fixture
def task(monkeypatch):
    """A seed's task, its renderer one that draws nothing."""

    class Empty:
        def render(self, states):
            return np.full((len(states), 2, 2), np.inf, np.float32)

    monkeypatch.setattr(recordings, "_renderer", Empty)
    return prepare(SEED)


def test_a_submission_is_given_frames_a_start_a_little_wrong_and_no_truth(task):
    renderer, camera, frames, start, n_particles, _ = task.arguments
    states, _ = task.truth
    assert frames.shape == (FRAMES, *camera.shape)
    assert n_particles == PARTICLES
    assert 0.001 < np.linalg.norm((start - states[0])[:2]) < 0.3
    assert (start - states[0])[2:5] == pytest.approx(0)
    assert not [value for value in vars(renderer).values() if isinstance(value, np.ndarray)]
    assert 0.6 < np.isfinite(frames).mean() < 0.95


def test_a_seed_gives_one_recording_and_another_seed_another(task):
    assert (prepare(SEED).arguments[2] == task.arguments[2])[np.isfinite(task.arguments[2])].all()
    other = prepare(SEED + 1)
    assert np.abs(other.truth[0] - task.truth[0]).max() > 0.1
    assert prepare(SEED).arguments[5].random() == prepare(SEED).arguments[5].random()


def test_frames_that_a_submission_changes_are_its_own(task):
    task.arguments[2][:] = 0
    assert np.isnan(prepare(SEED).arguments[2]).any()


def test_every_image_counts_and_the_budget_ends(task):
    renderer = CountedRenderer(5)
    assert len(renderer.render(np.zeros((3, 6)))) == 3
    assert len(renderer.render(np.zeros(6))) == 1
    assert renderer.renders == 4
    with pytest.raises(BudgetError, match="5 renders"):
        renderer.render(np.zeros((2, 6)))


def test_the_value_is_the_median_horizontal_error_in_millimetres(task):
    states, _ = task.truth
    found = states.copy()
    found[:, 0] += 0.03
    found[:, 1] += 0.04
    found[:, 2] += 1.0  # height is not asked for
    found[:5, 0] += 2.0
    result = measure(task, found.tolist())
    assert result.value == pytest.approx(50.0)
    assert "worst frame 2030" in result.remark


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        (None, "one estimate of six numbers a frame"),
        (np.zeros((FRAMES - 1, 6)), "one estimate of six numbers a frame"),
        (np.zeros((FRAMES, 3)), "one estimate of six numbers a frame"),
        ("here", "no array of numbers"),
        (np.full((FRAMES, 6), np.nan), "NaN or infinity in frame 0"),
    ],
)
def test_an_answer_that_does_not_fit_is_named(task, answer, words):
    with pytest.raises(AnswerError, match=words):
        measure(task, answer)


def test_a_submission_beyond_the_budget_is_a_verdict(task):
    def greedy(renderer, camera, frames, start, n_particles, rng):
        for _ in frames:
            renderer.render(np.tile(start, (100, 1)))

    outcome = one_outcome(PROJECT, greedy, SEED)
    assert outcome.failed
    assert "the budget of 1600 renders is spent" in outcome.remark


def still(renderer, camera, frames, start, n_particles, rng):
    return np.tile(start, (len(frames), 1))


def smoothed(renderer, camera, frames, start, n_particles, rng):
    return np.tile(start, (len(frames), 1)) + np.nanmean(frames)


def test_estimates_that_use_later_frames_are_refused(task):
    no_later_frames(SEED, still, still(*task.arguments))
    with pytest.raises(AnswerError, match="when it is not given the later ones"):
        no_later_frames(SEED, smoothed, smoothed(*task.arguments))
