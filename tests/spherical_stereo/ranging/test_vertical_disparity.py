"""Distances from the vertical disparity of matched features."""

import numpy as np
import pytest

from course_lib.spherical_stereo.matching.object_matching import ObjectMatch, match_views
from course_lib.spherical_stereo.panorama import StereoRig, View, direction_from_angles, direction_to_pixel, open_pair
from course_lib.spherical_stereo.ranging.object_positions import disparity_distance, max_range, measure_objects
from tests.spherical_stereo.stereo_scene import BASELINE, Seen, scene

SIZE = (1280, 640)
RIG = StereoRig(BASELINE)


def match_of(points, noise=0.0):
    """An `ObjectMatch` of keypoints of points `(k, 3)` in the upper camera's frame, with noise `(k,)` in rows."""
    upper, lower = direction_to_pixel(points, *SIZE), direction_to_pixel(np.add(points, [0, 0, BASELINE]), *SIZE)
    return ObjectMatch(0, 0, "chair", upper, lower + np.multiply.outer(noise, [0, 1]))


def face(rng, n, distance, width=1.0):
    """Points on an upright square that faces the rig."""
    return np.column_stack([np.full(n, distance), rng.uniform(-width / 2, width / 2, n), rng.uniform(-1, 0, n)])


def test_three_exact_features_or_more_give_the_range_of_their_points(rng):
    points = rng.uniform([1, -3, -1.2], [4, 3, 0.5], (41, 3))
    found = disparity_distance(match_of(points), *SIZE, BASELINE)
    assert found.horizontal_range == pytest.approx(np.median(np.hypot(points[:, 0], points[:, 1])), rel=1e-9)
    for n, outcome in ((0, "too few disparities"), (2, "too few disparities"), (3, "ok")):
        found = disparity_distance(match_of(points[:n]), *SIZE, BASELINE)
        assert (found.outcome, np.isnan(found.horizontal_range), np.isnan(found.sigma)) == (outcome, n < 3, n < 3)


def test_a_third_of_strangers_from_the_wall_behind_moves_the_range_little(rng):
    points = np.concatenate([face(rng, 40, 2.0, 0.3), face(rng, 20, 5.0, 0.3)])
    found = disparity_distance(match_of(points, rng.normal(0, 0.3, 60)), *SIZE, BASELINE)
    assert found.horizontal_range == pytest.approx(2.0, rel=0.08)


def test_sigma_is_the_deviation_of_the_range_over_repeated_noise(rng):
    points = face(rng, 30, 3.0, 0.2)
    found = [disparity_distance(match_of(points, rng.normal(0, 1.0, 30)), *SIZE, BASELINE) for _ in range(300)]
    assert np.std([f.horizontal_range for f in found]) == pytest.approx(np.mean([f.sigma for f in found]), rel=0.2)


def test_both_distances_of_rendered_boards_are_right():
    """A board is flat and faces the rig, so here surface and centre are nearly one."""
    boards, *images, upper_seen, lower_seen = scene()
    upper, lower = open_pair(*images)
    views = upper.replace(detections=upper_seen), lower.replace(detections=lower_seen)
    measured = measure_objects(match_views(*views, RIG).matches, *views, RIG)
    assert [m.upper for m in measured] == list(range(8))
    ranges = np.array([board.range for board in boards])
    from_features = np.array([m.disparity.horizontal_range_m for m in measured])
    from_boxes = np.array([m.box_centre.horizontal_range_m for m in measured])
    assert np.median(np.abs(from_features / ranges - 1)) < 0.04
    # A wide flat board bulges on the sphere, and its box's middle is a little off the board's.
    assert np.median(np.abs(from_boxes / ranges - 1)) < 0.08
    for m, board in zip(measured, boards, strict=True):
        assert np.cos(np.radians(m.azimuth_deg) - board.azimuth) > np.cos(0.01)
        assert 0 < m.box_centre.horizontal_sigma_m < 1.5


def boxed(elevation, azimuth=0.0):
    """A view of one box whose centre is at an elevation and an azimuth (radians)."""
    u, v = direction_to_pixel(direction_from_angles(azimuth, elevation), *SIZE)
    return View(*SIZE, detections=[Seen("chair", (u - 9, v - 5, u + 9, v + 5))])


def test_box_centres_without_a_distance_keep_the_name_of_their_outcome(rng):
    (measured,) = measure_objects([match_of(face(rng, 20, 2.5))], boxed(-0.3), boxed(-0.4), RIG)
    assert (measured.box_centre.outcome, measured.disparity.outcome) == ("diverging", "ok")
    assert np.isnan(measured.box_centre.position).all()


def test_the_sigma_of_a_range_is_that_of_the_pixels():
    """d rho = rho^2 sec^2 e / B per radian of either elevation: a pixel each, at 0.4 and 0.3 radians down."""
    (measured,) = measure_objects([match_of(np.array([[2.0, 0, -1]] * 3))], boxed(-0.4), boxed(-0.3), RIG)
    rho = BASELINE / (np.tan(-0.3) - np.tan(-0.4))
    pixel = 2 * np.pi / 1280
    expected = rho**2 / BASELINE * pixel * np.hypot(1 / np.cos(0.4) ** 2, 1 / np.cos(0.3) ** 2)
    assert measured.box_centre.horizontal_range_m == pytest.approx(rho)
    assert measured.box_centre.horizontal_sigma_m == pytest.approx(expected)
    assert max_range(0.3) == pytest.approx(28.28, abs=0.01)


@pytest.mark.parametrize("azimuth", [0.0, np.pi / 4, 2.0, -2.5])
def test_a_position_from_exact_features_is_uncertain_only_across_the_line_of_sight(azimuth):
    along, across = np.array([[np.cos(azimuth), np.sin(azimuth)], [-np.sin(azimuth), np.cos(azimuth)]])
    match = match_of(np.array([[*2 * along, -1]] * 3))
    (measured,) = measure_objects([match], boxed(-0.4, azimuth), boxed(-0.3, azimuth), RIG)
    pixel = 2 * np.pi / 1280
    assert measured.disparity.position[:2] == pytest.approx(2 * along)
    assert measured.disparity.covariance == pytest.approx((2 * pixel) ** 2 * np.outer(across, across), abs=1e-12)
