"""The exact filter of F1 is exact, the particles come to it, and the box is what `run` does."""

import numpy as np
import pytest

from courseware.answers.foundation_1 import correct, share_left
from courseware.lessons.foundation_1 import corridor


def test_beliefs_sum_to_one_and_stay_on_the_grid():
    beliefs = corridor.exact_beliefs(seed=3)
    assert beliefs.sum(axis=1) == pytest.approx(np.ones(corridor.FRAMES))
    assert beliefs[:, -25:].max() < 1e-12, "nothing is lost at the grid's end"


def test_many_particles_come_to_the_exact_belief():
    few, many = (corridor.misplaced(corridor.run(2, n, 0.5).shares, 2).mean() for n in (100, 20_000))
    assert many < 0.02 < few


def test_resampling_on_demand_is_what_exercise_f1_2_does():
    z, rng = corridor.record(5)[1], np.random.default_rng([5, 300])
    x, w = rng.uniform(0, corridor.START, 300), np.full(300, 1 / 300)
    for frame in range(10):
        x = corridor.move(x, rng)
        size = 1 / np.sum((w * (seen := corridor.likelihood(z[frame], x)) / (w @ seen)) ** 2)
        assert size == pytest.approx(corridor.run(5, 300, 0.5).sizes[frame])
        x, w = correct(x, w, seen, rng.random() if size < 150 else 0.0, 0.5)


def test_a_weighted_set_wears_out_as_exercise_f1_3_says():
    x = np.random.default_rng(0).normal(0, 0.2, 100_000)
    w = np.exp(-((0.3 - x) ** 2) / (2 * 0.1**2))
    assert w.sum() ** 2 / np.sum(w**2) / len(w) == pytest.approx(share_left(0.04, 0.3, 0.1), rel=0.03)
