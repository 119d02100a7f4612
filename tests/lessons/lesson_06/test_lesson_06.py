"""What lesson 06 says of alpha, beta, outliers and the four likelihoods holds."""

import numpy as np
import pytest

from course_lib.depth_mcl.fallon import depth_log_likelihood
from course_lib.depth_mcl.likelihood import likelihood, normalize_likelihood, valid_pixels, weights
from course_lib.lessons.kit.exercises import find_exercise, judge
from course_lib.lessons.lesson_06.exercises import importance_mean
from course_lib.lessons.lesson_06.panel import likelihood_panel
from course_lib.lessons.lesson_06.profiles import (
    AXES,
    FORMS,
    behind_a_person,
    cost_of_a_pixel,
    peak,
    peak_table,
    profile,
    small_scene,
    views_along,
)

PAPER = "paper, eq. (8)"


def off(form: str, axis: str, hidden: float = 0.0) -> float:
    measured = behind_a_person(small_scene().measured, hidden)
    return peak(AXES[axis], profile(FORMS[form], axis, measured))[0]


def test_a_pixel_costs_at_most_twice_as_much_in_the_papers_form_and_10000_times_in_the_gaussian():
    costs = cost_of_a_pixel([0.1, 10.0])
    assert costs[PAPER][1] / costs[PAPER][0] == pytest.approx(2, rel=0.02)
    assert costs["Gaussian"][1] / costs["Gaussian"][0] == pytest.approx(10_000)


def test_the_drawn_cost_of_the_half_normal_is_that_of_the_library():
    measured = np.array([[5.0]])
    l0, small, large = depth_log_likelihood(measured, np.array([[[5.0]], [[5.4]], [[6.0]]]))
    assert cost_of_a_pixel([0.4])["half-normal + uniform"] == pytest.approx((l0 - small) / (l0 - large), rel=1e-4)


def test_all_forms_but_the_gaussian_find_the_truth_along_every_axis():
    for axis in AXES:
        assert [off(form, axis) for form in FORMS if form != "Gaussian"] == [0, 0, 0]
    assert off("Gaussian", "x") > 0.5


def test_the_papers_peak_is_the_narrowest_and_x_is_the_widest_position():
    width = {(form, axis): peak(AXES[axis], profile(FORMS[form], axis))[1] for form in FORMS for axis in AXES}
    for axis in AXES:
        assert all(width[PAPER, axis] < 0.7 * width[form, axis] for form in FORMS if form != PAPER)
    assert width[PAPER, "x"] > 3 * max(width[PAPER, "y"], width[PAPER, "z"])


def test_behind_a_person_the_papers_form_holds_longest():
    assert all(off(PAPER, "x", hidden) == 0 for hidden in (0.2, 0.4, 0.6, 0.8))
    assert off("half-normal + uniform", "x", 0.2) == pytest.approx(0.05)
    assert off(PAPER, "z", 0.8) == 0


def test_more_than_five_cameras_count_only_with_beta_of_a_third():
    normalized = profile(likelihood, "x")
    count = {beta: (lambda w: (w / w.max() >= 0.5).sum())(weights(normalized, beta)) for beta in (0.3, 0.4)}
    assert count[0.3] <= 5 < count[0.4]


def test_the_best_of_a_lost_cloud_weighs_as_much_but_scores_less():
    scene = small_scene()
    lost = scene.renderer.render(AXES["x"].states(scene.truth - [3.0, 0, 0, 0, 0, 0]))
    raw = [likelihood(scene.measured, images) for images in (views_along("x"), lost)]
    assert [normalize_likelihood(values).max() for values in raw] == [1, 1]
    scores = [values.max() / valid_pixels(scene.measured).sum() for values in raw]
    assert scores[1] < 0.6 * scores[0]


def test_a_larger_alpha_widens_the_peak_and_lifts_the_score():
    panel = likelihood_panel()
    low, high = (panel.draw(**(panel.defaults() | {"alpha": alpha})).summary for alpha in (0.01, 1.0))
    assert "width at half height 0.41 m" in low
    assert "l / m: 0.29" in low
    assert "width at half height 0.95 m" in high
    assert "l / m: 0.85" in high


def test_the_table_has_a_row_for_each_form_and_a_column_for_each_axis():
    table = peak_table({axis: {form: profile(f, axis) for form, f in FORMS.items()} for axis in ("x", "yaw")})
    head, *rows = table.splitlines()
    assert head.split() == ["off", "/", "width", "x", "[m]", "yaw", "[degrees]"]
    assert [row.strip().split("  ")[0] for row in rows] == list(FORMS)


def carried(share):
    """How many particles carry the weight."""
    return 1 / np.sum(share**2)


def test_more_pixels_narrow_a_product_over_them_and_leave_the_papers_weights_as_they_are():
    states = small_scene().truth + np.random.default_rng(0).normal(0, [0.15, 0.04, 0, 0, 0, 0.026], (150, 6))
    paper, product = [], []
    for width, height in ((22, 18), (44, 36), (88, 72)):
        scene = small_scene(width, height)
        assert scene.measured.shape == (height, width)
        views = scene.renderer.render(states)
        paper.append(carried(weights(normalize_likelihood(likelihood(scene.measured, views)), 0.3)))
        log_p = depth_log_likelihood(scene.measured, views)
        odds = np.exp(log_p - log_p.max())
        product.append(carried(odds / odds.sum()))
    assert max(paper) < 1.3 * min(paper)
    assert product[0] > 2 * product[1] > 4 * product[2]


def test_the_error_bar_of_exercise_06_4_is_the_scatter_of_the_weighted_means():
    rng, found = np.random.default_rng(2), []
    for _ in range(1500):
        x = rng.normal(0, 1, 200)
        proposal = np.exp(-(x**2) / 2)
        found.append(importance_mean(x, proposal * np.exp(-((x - 1) ** 2) / (2 * 0.5**2)), proposal))
    means, errors = np.array(found).T
    assert means.mean() == pytest.approx(0.8, abs=0.005)
    assert errors.mean() == pytest.approx(means.std(), rel=0.06)


def test_a_small_number_below_the_fraction_line_of_9_does_not_pass_for_a_guard():
    def almost_guarded(measured, images, alpha, beta):
        values = np.nansum(alpha / (alpha + np.abs(measured - images)), axis=(1, 2))
        normalized = (values - values.min()) / (np.ptp(values) + 1e-12)
        w = np.exp(-((normalized - 1) ** 2) / beta**2)
        return w / w.sum()

    with np.errstate(invalid="ignore"):
        assert all(judge(find_exercise("06.2"), almost_guarded, seed).status == "wrong" for seed in range(3))
