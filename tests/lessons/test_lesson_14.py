"""What lesson 14 says of places, their errors and the centres of boxes holds."""

import numpy as np
import pytest

from course_lib.lessons.lesson_14.noise import PIXEL, directions_to, ellipse, sampled_places
from course_lib.lessons.lesson_14.panel import triangulation_panel
from course_lib.lessons.lesson_14.ranges import box_range
from course_lib.lessons.lesson_14.sizes import cuboid_range
from course_lib.spherical_stereo.ranging.triangulation import object_position, triangulation_covariance


def test_directions_to_a_point_lead_back_to_it_and_noisy_ones_spread_as_the_covariance_says():
    point = np.array([2.0, -1.0, -0.7])
    upper, lower = directions_to(point, 0.3)
    assert object_position(upper, lower, 0.3) == pytest.approx(point)
    covariance = triangulation_covariance(upper, lower, 0.3, PIXEL, PIXEL)
    assert np.cov(sampled_places(point, 0.3, PIXEL)[0].T) == pytest.approx(covariance, rel=0.25, abs=5e-4)


def test_the_ellipse_is_two_sigma_away_everywhere():
    covariance = np.array([[0.5, 0.2], [0.2, 0.3]])
    offsets = ellipse(covariance, np.array([1.0, 2.0])) - [1.0, 2.0]
    squares = np.einsum("ni,ij,nj->n", offsets, np.linalg.inv(covariance), offsets)
    assert squares == pytest.approx(np.full(60, 4.0))


def test_around_a_mere_point_the_box_centre_is_right_and_boxes_that_diverge_have_no_range():
    assert cuboid_range(2.0, (1e-6, 1e-6, 1e-6), 1.44, 0.3) == pytest.approx(2.0, abs=1e-4)
    assert np.isnan(box_range([(600, 350, 640, 390), (600, 400, 640, 440)], 0.3, (1280, 640)))


def test_in_the_panel_the_error_grows_with_the_square_of_the_distance():
    panel = triangulation_panel()
    words = [panel.draw(**(panel.defaults() | {"x": x, "y": 0.0})).summary for x in (4.0, 8.0)]
    near, far = (float(one.split("along the ray ")[1].split(" m")[0]) for one in words)
    assert far == pytest.approx(4 * near, rel=0.1)
