"""Figures of rooms that look alike: what they show is what they were given."""

import numpy as np

from course_lib.experiments.ambiguity import AmbiguityMap
from course_lib.plots.room_figures import ambiguity_figure
from tests.beyond.look_alikes.look_alike_scene import SYMMETRIC


def test_doubt_is_dark_and_only_real_confusions_are_drawn():
    confused = np.zeros((2, 5, 5))
    confused[:, 0, 1] = 0.4
    confused[:, 3, 4] = 0.001
    found = AmbiguityMap(np.array([[0.5, 0.5], [1.5, 0.5]]), np.array([1.0, 0.25]), confused, 1.0)
    axes = ambiguity_figure(SYMMETRIC, found).axes[0]
    np.testing.assert_allclose(axes.collections[0].get_array(), [0.0, 0.75])
    assert [text.get_text() for text in axes.texts] == ["40 %"]
    dashed = [line for line in axes.lines if line.get_linestyle() == "--"]
    np.testing.assert_allclose(dashed[0].get_xydata(), SYMMETRIC.positions[[0, 1]])
