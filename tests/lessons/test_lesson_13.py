"""What lesson 13 says of columns, of the band around a box and of matches holds."""

import numpy as np
import pytest

from course_lib.spherical_stereo.matching.epipolar import epipolar_residual
from course_lib.spherical_stereo.matching.object_matching import match_views
from courseware.lessons.kit.room_data import scene
from courseware.lessons.lesson_13.figures import band, half_circle
from courseware.lessons.lesson_13.matching import count_table


def test_counting_both_ways_at_once_is_what_the_library_does():
    one = scene()
    counts, found = count_table(one, "both"), match_views(one.upper.view(), one.lower.view(), one.rig)
    assert [counts[m.upper, m.lower] for m in found.matches] == [m.n_matches for m in found.matches] != []


def test_the_band_ends_where_the_tolerance_does_and_the_half_circle_is_where_the_residual_is_zero():
    u, v = band((600.0, 400.0, 640.0, 450.0), 0.05, 1280, 640)[:16].T
    a, e = (0.5 - u / 1280) * 2 * np.pi, (0.5 - v / 640) * np.pi
    assert epipolar_residual(2 * np.pi * 40 / 1280, e, a, e) == pytest.approx(np.full(16, 0.05))
    x, y, z = half_circle(np.array([2.2, 1.4, -1.5]))[1:-1].T
    assert epipolar_residual(np.arctan2(1.4, 2.2), -0.5, np.arctan2(y, x), np.arcsin(z)) == pytest.approx(0, abs=1e-9)
