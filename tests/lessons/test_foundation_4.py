"""What F4 says of essential matrices and of directions and ranges holds."""

import numpy as np
import pytest

from course_lib.geometry import rotation_exp
from courseware.lessons.foundation_4 import two_views
from courseware.lessons.foundation_4.figures import circle_about, on_panorama
from courseware.lessons.foundation_4.pose_from_sight import informations, pose_errors

R, C = rotation_exp(two_views.TURN), two_views.PLACE
E = R.T @ np.cross(np.eye(3), C)


def test_the_four_motions_make_the_matrix_and_the_one_with_all_points_in_front_is_right():
    x1, x2 = two_views.random_views(np.random.default_rng(0), 50, R, C, 0.0)
    assert np.sum(x2 @ E * x1, axis=1) == pytest.approx(np.zeros(50), abs=1e-12)
    for turn, place in two_views.four_motions(E):
        made = turn.T @ np.cross(np.eye(3), place) * np.linalg.norm(C)
        assert min(np.abs(made - E).max(), np.abs(made + E).max()) < 1e-9
    assert sorted(two_views.shares_in_front(E, x1, x2))[-2:] == [pytest.approx(0, abs=0.1), 1.0]
    assert two_views.motion_errors(E, x1, x2, R, C) == pytest.approx([0, 0], abs=1e-4)


def test_distances_lead_to_the_point():
    x1, x2 = two_views.random_views(np.random.default_rng(1), 50, R, C, 0.0)
    d1, d2 = two_views.distances(x1, x2, R, C)
    assert d1[:, None] * x1 == pytest.approx(d2[:, None] * (x2 @ R.T) + C)


def test_a_curve_on_a_panorama_is_broken_at_the_seam_and_lies_in_its_plane():
    normal = np.array([0.3, -0.5, 0.8])
    assert circle_about(normal) @ normal == pytest.approx(np.zeros(181), abs=1e-12)
    azimuth, _ = on_panorama(circle_about(normal))
    assert np.nanmax(np.abs(np.diff(azimuth))) < 180
    assert np.isnan(azimuth).any()


def test_ranges_never_fix_the_heading_and_fits_are_as_exact_as_the_information_says():
    objects, pose = np.array([[0.6, 3.9], [4.4, 4.2], [4.0, 0.8]]), np.array([1.8, 1.6, 0.6])
    _, by_ranges = informations(objects, pose, 0.005, 0.3)
    assert by_ranges[:, 2] == pytest.approx(np.zeros(3))
    alone, both, papers = np.median(pose_errors(8, 0.005, repeats=60), axis=0)
    assert both < 1.1 * alone < papers / 3
