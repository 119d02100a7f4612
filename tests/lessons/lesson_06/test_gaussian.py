"""The Gaussian form: a sum of squares, and what that does to outliers and to holes of the map."""

import numpy as np
import pytest

from course_lib.depth_mcl.likelihood import DepthImageError, likelihood
from course_lib.lessons.lesson_06.gaussian import MISS_DEPTH, gaussian_log_likelihood


def test_it_is_the_sum_of_squares_in_units_of_sigma():
    measured = np.array([[2.0, 3.0], [4.0, np.nan]])
    simulated = np.array([[[2.0, 3.0], [4.0, 9.0]], [[2.1, 3.0], [3.8, 9.0]]])
    assert gaussian_log_likelihood(measured, simulated, sigma=0.1) == pytest.approx([0.0, -(1 + 4) / 2])


def test_a_miss_counts_as_a_surface_at_the_given_depth():
    measured = np.array([[2.0]])
    miss, wall = np.array([[[np.inf]]]), np.array([[[MISS_DEPTH]]])
    assert gaussian_log_likelihood(measured, miss) == pytest.approx(gaussian_log_likelihood(measured, wall))


def test_one_outlier_of_ten_metres_outweighs_a_thousand_pixels_that_are_off_by_a_decimetre():
    measured = np.full((25, 40), 2.0)
    slightly_off, one_outlier = np.full((25, 40), 2.1), measured.copy()
    one_outlier[0, 0] = 12.0
    gaussian = gaussian_log_likelihood(measured, np.array([slightly_off, one_outlier]), miss_depth=20.0)
    paper = likelihood(measured, np.array([slightly_off, one_outlier]))
    assert gaussian[1] < 9 * gaussian[0]
    assert paper[1] > 1.9 * paper[0]


def test_bad_input_is_named():
    images = np.ones((2, 2)), np.ones((1, 2, 2))
    with pytest.raises(ValueError, match="sigma must be a positive"):
        gaussian_log_likelihood(*images, sigma=0.0)
    with pytest.raises(ValueError, match="miss_depth must be a positive"):
        gaussian_log_likelihood(*images, miss_depth=np.nan)
    with pytest.raises(DepthImageError):
        gaussian_log_likelihood(np.ones((2, 3)), np.ones((1, 2, 2)))
