"""What lesson 14 says of places, their errors and the centres of boxes holds."""

import numpy as np
import pytest

from course_lib.spherical_stereo.ranging.triangulation import object_position, triangulation_covariance
from courseware.lessons.lesson_14.figures import PIXEL, directions_to, ellipse, sampled_places
from courseware.lessons.lesson_14.room_ranges import box_range, cuboid_range


def test_directions_to_a_point_lead_back_to_it_and_noisy_ones_spread_as_the_covariance_says():
    point = np.array([2.0, -1.0, -0.7])
    upper, lower = directions_to(point, 0.3)
    assert object_position(upper, lower, 0.3) == pytest.approx(point)
    covariance = triangulation_covariance(upper, lower, 0.3, PIXEL, PIXEL)
    assert np.cov(sampled_places(point, 0.3, PIXEL)[0].T) == pytest.approx(covariance, rel=0.25, abs=5e-4)
    offsets = ellipse(covariance[:2, :2], point[:2]) - point[:2]
    squares = np.einsum("ni,ij,nj->n", offsets, np.linalg.inv(covariance[:2, :2]), offsets)
    assert squares == pytest.approx(np.full(60, 4.0)), "two sigma away everywhere"


def test_around_a_mere_point_the_box_centre_is_right_and_boxes_that_diverge_have_no_range():
    assert cuboid_range(2.0, (1e-6, 1e-6, 1e-6), 1.44, 0.3) == pytest.approx(2.0, abs=1e-4)
    assert np.isnan(box_range([(600, 350, 640, 390), (600, 400, 640, 440)], 0.3, (1280, 640)))
