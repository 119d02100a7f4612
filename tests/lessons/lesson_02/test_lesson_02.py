"""What lesson 02 says about its room's maps holds: holes, noise, registration, voxels, the door of another day."""

import numpy as np
import pytest

from course_lib.lessons.kit.box_world import Box, BoxWorld
from course_lib.lessons.lesson_02 import small_room
from course_lib.lessons.lesson_02.exercises import lateral_sigma, off_the_sigma
from course_lib.lessons.lesson_02.small_room import (
    STATIONS,
    MapQuality,
    distances,
    gaps,
    quality,
    room,
    room_map,
    scans,
    seen_places,
)
from course_lib.lessons.lesson_02.views import camera_view, cut, row, shipped_numbers, true_view
from course_lib.rendering.scene_map import SceneMap


def test_a_cut_through_a_box_is_its_outline():
    mesh = BoxWorld([Box((1.0, 2.0, 0.0), (2.0, 4.0, 3.0), 0.5)]).mesh()
    segments = cut(mesh.vertices, mesh.faces, 1.2)
    assert np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1).sum() == pytest.approx(6.0)


def test_distances_are_zero_on_the_room_and_as_large_as_a_shift():
    mesh = room().mesh()
    assert distances(mesh, n=500).max() < 1e-6
    floor = SceneMap(np.array([[1.0, 1, 0.03], [2, 1, 0.03], [1, 2, 0.03]]), np.array([[0, 1, 2]]))
    assert distances(floor, n=50) == pytest.approx(np.full(50, 0.03))


def test_the_room_itself_has_no_holes_and_eyes_see_surfaces_of_it():
    assert gaps(room().mesh()).max() < 1e-4
    places = seen_places()
    assert places.shape == (3000, 3)
    assert (np.ptp(places, axis=0) > [4.9, 3.9, 2.4]).all()


def test_stations_stand_in_the_open():
    for x, y in STATIONS:
        inside = (room().low < [x, y, 1.6]).all(axis=1) & (room().high > [x, y, 1.6]).all(axis=1)
        assert not inside.any()


def test_one_station_leaves_holes_that_three_close():
    one, three = quality(room_map(1)), quality(room_map(3))
    assert one.holes > 0.10
    assert three.holes < 0.01
    assert np.isinf(camera_view(room_map(1))).mean() > np.isinf(camera_view(room_map(3))).mean() + 0.02


def test_noise_averages_out_and_registration_does_not():
    clean, noisy, shifted = (quality(room_map(3, *errors)).median for errors in ((1, 0), (20, 0), (1, 20)))
    assert clean < 0.004
    assert clean < noisy < 0.010
    assert shifted > 1.2 * noisy


def test_half_the_voxel_gives_about_four_times_the_triangles():
    assert 3.5 < len(room_map(3, voxel=0.1)) / len(room_map(3, voxel=0.2)) < 5.0


def test_decimation_to_a_hundredth_keeps_the_walls():
    assert len(room_map(3, keep=0.01)) < 0.011 * len(room_map(3))
    assert quality(room_map(3, keep=0.01)).median < 0.005


def test_the_door_of_another_day_is_most_of_what_differs():
    shut, opened = (np.abs(camera_view(room_map(3, door_open=d)) - true_view(True)) > 0.1 for d in (False, True))
    assert shut.mean() > opened.mean() + 0.04


def test_the_same_survey_comes_out_again():
    before = scans(1)[0].ranges
    small_room._scans.cache_clear()
    np.testing.assert_array_equal(scans(1)[0].ranges, before)


def test_a_row_tells_holes_and_distances_with_their_digits():
    text = row(MapQuality(30295, 0.0025, 0.0173, 0.158, (0.1454, 0.1712), 0.02))
    assert text == "30295 triangles; map to room: median 2.5 mm, 90 % below 17 mm; holes 15.8 % (14.5 to 17.1)"


def test_the_interval_of_the_holes_holds_their_share():
    found = quality(room_map(1))
    assert 0.13 < found.holes_interval[0] < found.holes < found.holes_interval[1] < 0.19
    assert np.diff(found.holes_interval)[0] == pytest.approx(2 * 1.96 * np.sqrt(0.16 * 0.84 / 3000), rel=0.03)


def test_one_station_grows_a_surface_that_is_not_there_behind_the_pillar():
    assert quality(room_map(1)).false > 0.02
    assert 0.3 < distances(room_map(1)).max() < 0.6
    assert quality(room_map(3)).false < 0.015


def test_another_seed_is_another_survey():
    first, second = (scans(1, registration_mm=20, seed=seed)[0] for seed in (1, 3))
    assert not np.allclose(first.registered_pose, second.registered_pose, atol=0.001)
    assert np.nanmedian(np.abs(first.ranges - second.ranges)) > 0.0005


def test_the_shipped_numbers_are_those_of_the_papers_order():
    made = shipped_numbers()
    assert made["registration"]["mean_point_distance_m"] == pytest.approx(0.010, abs=0.004)
    assert made["distance_to_surveyed_world"]["median_m"] < made["registration"]["mean_point_distance_m"]


def test_a_predicted_sigma_may_be_five_percent_off_and_no_more():
    given = (10, 5.0, 0.006, np.deg2rad(0.03))
    assert lateral_sigma(*given) == pytest.approx(0.0481, abs=0.0001)
    assert lateral_sigma(1, 6.0, 0.008, 0.01) == pytest.approx(0.008)
    assert off_the_sigma(given, 1.04 * lateral_sigma(*given)) is None
    assert off_the_sigma(given, [0.96 * lateral_sigma(*given)]) is None
    assert "too large" in off_the_sigma(given, 1.06 * lateral_sigma(*given))
    assert "too small" in off_the_sigma(given, 0.94 * lateral_sigma(*given))
    assert "finite" in off_the_sigma(given, np.inf)
