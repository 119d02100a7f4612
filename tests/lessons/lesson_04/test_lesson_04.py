"""What lesson 04 says about the time-of-flight camera's faults holds, one by one."""

import numpy as np
import pytest

from course_lib.depth_mcl import depth_image_from_points
from course_lib.lessons.lesson_04.exercises import nearest_of
from course_lib.lessons.lesson_04.figures import counts
from course_lib.lessons.lesson_04.panel import DEPTHS, faults_panel
from course_lib.lessons.lesson_04.recorded import KINDS, kinds_of, on_a_surface, sort_errors
from course_lib.lessons.lesson_04.time_of_flight import FAULTS, MODEL, capture, frames_of, model, returns, wall
from course_lib.rendering.camera import DepthCamera

SMALL = DepthCamera.sr4000().resized(88, 72)


def errors(x: float, *faults: str) -> np.ndarray:
    """Measured minus true depth [m] `(H, W)`, NaN where either is missing."""
    shot = capture(x, set(faults), SMALL)
    return np.where(np.isfinite(shot.true), shot.depth - np.where(np.isfinite(shot.true), shot.true, 0), np.nan)


def test_without_faults_the_camera_reads_the_truth():
    assert np.nanmax(np.abs(errors(0.0))) < 0.001


def test_all_faults_together_are_the_model_that_recorded_the_corridor():
    assert model(set(FAULTS)) == MODEL


@pytest.mark.parametrize("fault", FAULTS)
def test_every_fault_alone_changes_the_image(fault):
    clean, faulty = capture(0.0, set(), SMALL).depth, capture(0.0, {fault}, SMALL).depth
    assert not np.array_equal(clean, faulty, equal_nan=True)


def test_noise_is_strong_on_far_and_dark_surfaces_and_weak_on_the_near_pole():
    r, rho_cos = returns(0.0, SMALL)
    off = np.abs(errors(0.0, "noise"))
    faint, bright = rho_cos / r**2 < 0.004, rho_cos / r**2 > 0.05
    assert np.nanmedian(off[faint]) > 5 * np.nanmedian(off[bright])
    assert (np.abs(r[bright & (r < 3)] - 2.5) < 0.3).any()  # the pole is among the bright


def test_mixing_is_wrong_at_edges_alone():
    shot = capture(0.0, {"mixing"}, SMALL)
    off = np.abs(errors(0.0, "mixing")) > 0.05
    apart = shot.frame.farthest - shot.frame.nearest
    assert off.any()
    assert (apart[off] > 0.05).all()


def test_wrapping_spoils_the_end_wall_by_c_over_2f_until_the_camera_is_near_enough():
    off = errors(0.0, "wrapping")
    far = np.abs(off) > 1
    assert far.mean() > 0.05
    # In depth the lost turn is shortened by the ray's slant.
    assert off[far] == pytest.approx(-MODEL.unambiguous_range / np.linalg.norm(SMALL.rays(), axis=-1)[far], abs=0.001)
    assert np.nanmax(np.abs(errors(1.8, "wrapping"))) > 9
    assert 0 < (np.abs(errors(2.05, "wrapping")) > 1).mean() < far.mean()
    assert np.nanmax(np.abs(errors(2.3, "wrapping"))) < 0.001


def test_the_open_window_reads_anything_until_faint_pixels_are_dropped():
    window = np.isinf(capture(0.0, set(), SMALL).true)
    noisy = capture(0.0, {"noise", "wrapping"}, SMALL).depth[window]
    assert noisy.min() < 1.5
    assert noisy.max() > 8
    assert np.isnan(capture(0.0, {"noise", "wrapping", "drop_outs"}, SMALL).depth[window]).mean() > 0.9


def test_drop_outs_cost_the_dark_door_and_keep_the_white_wall():
    shot = capture(0.0, {"drop_outs"}, SMALL)
    end_wall = np.abs(shot.true - 12.0) < 0.01
    assert 0.2 < np.isnan(shot.depth[end_wall]).mean() < 0.8


def test_thirty_megahertz_is_less_noisy_and_wraps_more():
    slow, fast = (capture(0.0, {"noise"}, SMALL, f) for f in (15e6, 30e6))
    there = np.isfinite(slow.true)
    spread = [np.median(np.abs(s.depth - s.true)[there]) for s in (slow, fast)]
    assert spread[1] == pytest.approx(spread[0] / 2, rel=0.1)
    wrapped = [
        np.nanmean(np.abs(capture(0.0, {"wrapping"}, SMALL, f).depth - slow.true)[there] > 1) for f in (15e6, 30e6)
    ]
    assert wrapped[1] > 3 * wrapped[0]


def test_noise_grows_about_in_proportion_to_the_distance():
    camera = DepthCamera.sr4000().resized(44, 36)
    sigma = [np.sqrt(np.nanvar(frames_of([wall(d)], 12, camera), axis=0, ddof=1).mean()) for d in (2.0, 8.0)]
    assert sigma[0] == pytest.approx(0.007, abs=0.0007)
    assert 3.6 < sigma[1] / sigma[0] < 4.6


def test_every_pixel_is_of_exactly_one_kind():
    true = np.array([[4.0, 4.0, 4.0, 12.0, 4.0, np.inf]])
    measured = np.array([[4.01, 4.2, np.nan, 2.0, 7.0, 3.0]])
    shares = sort_errors(measured, true)
    assert sum(shares.values()) == pytest.approx(1.0)
    expected = ("no measurement", 1), ("within 5 cm", 1), ("5 to 30 cm off", 1), ("wrapped", 1), (KINDS[-1], 2)
    assert shares == {kind: pytest.approx(n / 6) for kind, n in expected}
    assert (np.sum(list(kinds_of(measured, true).values()), axis=0) == 1).all()


def test_the_panel_counts_what_it_shows_and_its_button_switches_all_faults_on():
    panel = faults_panel()
    assert "at most 5 cm: 100.0%" in panel.draw(**panel.defaults()).summary
    panel.press("All faults")
    assert all(panel.values()[fault] for fault in FAULTS)
    assert panel.values()["x"] == panel.defaults()["x"]


def test_without_faults_the_histograms_of_measured_and_true_depths_agree_wherever_the_camera_stands():
    for x in (0.0, 1.3, 2.0, 4.5):
        shot = capture(x, set(), SMALL)
        there = np.isfinite(shot.true)
        assert np.array_equal(counts(shot.depth[there], DEPTHS), counts(shot.true[there], DEPTHS))


def test_the_least_of_sixteen_noisy_points_is_as_far_off_as_exercise_04_4_predicts():
    camera = DepthCamera.sr4000()
    frame = frames_of([wall(6.0)], 1, camera)[0]
    nearest = depth_image_from_points(camera.points(frame), camera.resized(44, 36))
    assert nearest_of(2) == pytest.approx((-1 / np.sqrt(np.pi), np.sqrt(1 - 1 / np.pi)), abs=1e-6)
    mean, _ = nearest_of(16)
    assert np.nanmean(nearest) - np.nanmean(frame) == pytest.approx(mean * np.nanstd(frame), abs=0.002)


def test_a_point_beside_the_pixel_that_saw_it_may_lie_on_a_surface_and_one_in_the_air_does_not():
    true = np.full(SMALL.shape, 4.0)
    true[0, 0] = np.inf
    behind, before = np.array([0.02, 0.0, 4.09]), np.array([0.0, 0.0, 3.0])
    assert on_a_surface(np.array([behind, before]), true, SMALL) == 0.5
    assert on_a_surface(np.array([behind]), true, SMALL, within=0.05) == 0
