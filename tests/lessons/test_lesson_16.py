"""Lesson 16: the residual's lowest place, the closed forms of the errors, mirrors, and the panel's named failures."""

import numpy as np
import pytest

from course_lib.spherical_stereo import Pose2D, fit_rigid_2d
from courseware.lessons.lesson_16 import fits
from courseware.lessons.lesson_16.fits import residual_over_heading
from courseware.lessons.lesson_16.panel import fit_panel


def test_the_residual_is_lowest_at_the_fit_and_the_errors_are_those_of_the_closed_forms():
    points, headings = fits.matched_points(), np.linspace(-np.pi, np.pi, 3601)
    best = headings[residual_over_heading(points.source, points.target, headings).argmin()]
    assert best == pytest.approx(fit_rigid_2d(points.source, points.target).theta, abs=0.002)
    ring, camera = fits.ring_of_landmarks(5), Pose2D(1.0, 2.0, 0.5)
    x, y, theta = fits.noisy_fits(ring, camera, 0.1, 600, np.random.default_rng(5)).T
    expected = fits.expected_sigmas(ring, camera, 0.1)
    assert [theta.std(), np.sqrt(np.mean(x**2 + y**2))] == pytest.approx(expected, rel=0.1)


def test_half_of_the_lines_become_mirrors_and_covariances_help_more_than_weights():
    sets, rng = map(fits.landmarks_of, (fits.ROOM, fits.LINE)), np.random.default_rng(0)
    assert np.allclose([fits.mirrored_by_plain_svd(one, 0.05, 400, rng) for one in sets], [0, 200], atol=40)
    alike, weighted, best = (e[:, 0] for e in fits.weighted_fits(2.0, 3, np.random.default_rng(5)).values())
    assert np.median(best) < np.median(weighted) < np.median(alike)


def test_the_panel_says_what_a_move_does_and_why_there_is_no_pose():
    panel = fit_panel()
    for name, value, says in (
        ("forward", 3.0, "pose off by 0.50 m"),
        ("arrangement", "mirrored", "no pose. mirrored points"),
        ("arrangement", "in one place", "no pose. coincident points"),
    ):
        assert panel.draw(**(panel.defaults() | {"noise": 0.0, name: value})).summary.startswith(says)
