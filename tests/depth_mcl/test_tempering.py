"""Weights as sharp as leave enough particles."""

import numpy as np
import pytest

from course_lib.depth_mcl.uncertainty import SHARPEST, temper


@pytest.mark.parametrize("sample_size", [1.5, 8.0, 40.0, 99.0])
def test_as_many_particles_are_left_as_asked_for(rng, sample_size):
    scores = rng.random(100)
    tempered = temper(scores, sample_size)
    assert tempered.ess == pytest.approx(sample_size, rel=1e-6)
    assert tempered.weights.sum() == pytest.approx(1)
    assert tempered.weights == pytest.approx(
        np.exp(tempered.sharpness * scores) / np.exp(tempered.sharpness * scores).sum()
    )
    assert (np.diff(tempered.weights[np.argsort(scores)]) > 0).all()


def test_fewer_survivors_ask_for_sharper_weights(rng):
    scores = rng.random(50)
    sharpness = [temper(scores, n).sharpness for n in (2, 5, 10, 25)]
    assert sharpness == sorted(sharpness, reverse=True)


def test_too_few_particles_weigh_the_same_and_equal_scores_too(rng):
    assert temper(rng.random(5), 10).weights == pytest.approx(np.full(5, 0.2))
    assert temper(rng.random(5), 10).sharpness == 0
    equal = temper(np.full(20, 0.7), 4)
    assert (equal.sharpness, equal.ess) == (SHARPEST, pytest.approx(20))


def test_a_cap_on_sharpness_leaves_more(rng):
    tempered = temper(rng.random(100), 2, sharpest=3.0)
    assert tempered.sharpness == 3.0
    assert tempered.ess > 50


@pytest.mark.parametrize("scores", [[], [0.1, np.nan], [[0.1, 0.2]]])
def test_scores_that_are_none_are_named(scores):
    with pytest.raises(ValueError, match="scores must be"):
        temper(np.array(scores), 2)
