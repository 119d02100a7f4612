"""Figures of the tables show what they were given: an honest covariance lies on the dashed line."""

import numpy as np
import pytest

from courseware.plots.experiment_figures import covariance_figure


def runs_of(factor, rng):
    errors = factor * rng.chisquare(6, 4000) / 6
    return [{"normalized_error": errors.tolist(), "within_3_sigma": [0.98] * len(errors)}]


def test_an_honest_covariance_lies_on_the_dashed_line(rng):
    axes = covariance_figure({"honest": runs_of(1.0, rng), "narrow": runs_of(9.0, rng)}).axes[0]
    ideal, honest, narrow = axes.lines
    at = np.array([0.7, 1.0, 2.0])
    wanted = np.interp(at, *ideal.get_data())
    assert np.interp(at, *honest.get_data()) == pytest.approx(wanted, abs=3)
    assert (np.interp(at, *narrow.get_data()) < wanted - 20).all(), "a third of the sigma that it should have"
    assert [text.get_text() for text in axes.figure.legends[0].get_texts()][1] == "honest: 98.0 % within three sigma"


def test_frames_without_a_covariance_are_left_out():
    floor = [{"position_m": [0.01]}]
    blind = [{"normalized_error": [1.0, float("nan")], "within_3_sigma": [1.0, 1.0]}]
    axes = covariance_figure({"floor": floor, "blind": blind}).axes[0]
    assert len(axes.lines) == 2, "the dashed line and one more"
    assert axes.lines[1].get_data()[1][-1] == 100.0
