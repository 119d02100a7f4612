"""What lesson 13 says of columns, of the band around a box and of matches holds."""

import numpy as np
import pytest

from course_lib.lessons.kit.panorama_features import scene
from course_lib.lessons.lesson_13.matching import count_table
from course_lib.lessons.lesson_13.panel import band, matching_panel
from course_lib.lessons.lesson_13.scenes import half_circle
from course_lib.spherical_stereo.matching.epipolar import epipolar_residual
from course_lib.spherical_stereo.matching.object_matching import match_views
from course_lib.spherical_stereo.panorama import azimuth_elevation_of_pixel


def test_counting_both_ways_at_once_is_what_the_library_does():
    one = scene()
    counts, found = count_table(one, "both"), match_views(one.upper.view(), one.lower.view(), one.rig)
    assert [counts[m.upper, m.lower] for m in found.matches] == [m.n_matches for m in found.matches] != []


def test_the_edge_of_the_band_is_the_tolerance_away_from_the_box():
    left = band((600.0, 400.0, 640.0, 450.0), 0.05, 1280, 640)[:16]
    a, e = azimuth_elevation_of_pixel(left, 1280, 640)
    a_box, _ = azimuth_elevation_of_pixel(np.array([600.0, 400.0]), 1280, 640)
    assert epipolar_residual(a_box, e, a, e) == pytest.approx(np.full(16, 0.05))


def test_the_half_circle_is_where_the_residual_is_zero():
    x, y, z = half_circle(np.array([2.2, 1.4, -1.5]))[1:-1].T
    assert epipolar_residual(np.arctan2(1.4, 2.2), -0.5, np.arctan2(y, x), np.arcsin(z)) == pytest.approx(0, abs=1e-9)


def test_the_panel_finds_the_table_across_the_seam_and_chance_matches_without_the_constraint():
    panel = matching_panel()
    values = panel.defaults()
    assert "table at -175, which is right" in panel.draw(**(values | {"chosen": "table at -175"})).summary
    assert "chair at -68: 0, " in panel.draw(**values).summary
    assert "chair at -68: 0, " not in panel.draw(**(values | {"constraint": False})).summary
