"""What lesson 14 says of errors over range and baseline, of the two distances, and of boxes' centres holds."""

import numpy as np
import pytest

from course_lib.lessons.kit.room_photographs import room_map, room_recording
from course_lib.lessons.lesson_14.exercises import mean_error
from course_lib.lessons.lesson_14.noise import PIXEL, directions_to, ellipse, noisy_directions, sampled_places
from course_lib.lessons.lesson_14.panel import triangulation_panel
from course_lib.lessons.lesson_14.ranges import (
    PLACES,
    azimuth_gaps,
    both_ranges,
    box_range,
    cuboid_range,
    error_texts,
    exact_box_ranges,
    places_in_room,
    places_in_space,
    ranges_of_one_object,
)
from course_lib.spherical_stereo.ranging.triangulation import DIVERGING, OK, object_position, triangulation_covariance

BASELINE = 0.3


@pytest.fixture(scope="module")
def panel():
    return triangulation_panel()


@pytest.fixture(scope="module")
def recording():
    return room_recording(2)


def sigma_along(rho: float, baseline: float) -> float:
    covariance = triangulation_covariance(*directions_to([rho, 0.0, -0.1], baseline), baseline, PIXEL, PIXEL)
    return float(np.sqrt(covariance[0, 0]))


def relative(measured: np.ndarray, true: np.ndarray) -> float:
    return float(np.nanmedian(np.abs(measured - true) / true))


def test_directions_to_a_point_lead_back_to_it():
    point = np.array([2.0, -1.0, -0.7])
    assert object_position(*directions_to(point, BASELINE), BASELINE) == pytest.approx(point)


def test_twice_as_far_is_four_times_as_wrong_and_twice_the_baseline_half_as_wrong():
    assert sigma_along(4, BASELINE) == pytest.approx(4 * sigma_along(2, BASELINE), rel=0.05)
    assert sigma_along(4, 2 * BASELINE) == pytest.approx(0.5 * sigma_along(4, BASELINE), rel=0.05)
    assert sigma_along(2, BASELINE) == pytest.approx(0.1, rel=0.1)


def test_noisy_measurements_spread_as_the_covariance_says_while_the_object_is_near():
    point = np.array([2.0, 0.0, -0.5])
    places, outcomes = sampled_places(point, BASELINE, PIXEL)
    assert (outcomes == OK).all()
    covariance = triangulation_covariance(*directions_to(point, BASELINE), BASELINE, PIXEL, PIXEL)
    assert np.cov(places.T) == pytest.approx(covariance, rel=0.25, abs=2e-4)


def test_without_parallax_some_rays_run_apart():
    _, near = sampled_places(np.array([5.0, 0.0, 0.0]), BASELINE, PIXEL)
    _, far = sampled_places(np.array([80.0, 0.0, 0.0]), BASELINE, PIXEL)
    assert (near == DIVERGING).sum() == 0
    assert 0.1 < (far == DIVERGING).mean() < 0.4


def test_averaging_slopes_is_right_and_averaging_ranges_is_not():
    upper, lower = noisy_directions(np.array([8.0, 0.0, 0.0]), BASELINE, 2 * PIXEL)
    slopes = np.tan(np.arcsin(lower[:, 2])) - np.tan(np.arcsin(upper[:, 2]))
    tens = slopes.reshape(40, 10)
    assert BASELINE / slopes.mean() == pytest.approx(8.0, rel=0.05)
    assert np.ptp(BASELINE / tens.mean(axis=1)) < 0.5 * np.ptp((BASELINE / tens).mean(axis=1))


def test_the_ellipse_is_two_sigma_away_everywhere():
    covariance = np.array([[0.5, 0.2], [0.2, 0.3]])
    offsets = ellipse(covariance, np.array([1.0, 2.0])) - [1.0, 2.0]
    distances = np.sqrt(np.einsum("ni,ij,nj->n", offsets, np.linalg.inv(covariance), offsets))
    assert distances == pytest.approx(np.full(len(offsets), 2.0))


def typical_error(measured, true, bins):
    return [np.nanmedian(np.abs(measured - true)[(true >= low) & (true < high)]) for low, high in bins]


def test_exact_boxes_err_most_when_near_and_noisy_ones_when_far(recording):
    bins = ((0, 2), (2, 4), (4, 7))
    exact, noisy = (exact_box_ranges(recording, sigma) for sigma in (0.0, 2.0))
    near, _, far = typical_error(exact.box_centres, exact.true, bins)
    assert near > far
    near, middle, far = typical_error(noisy.box_centres, noisy.true, bins)
    assert near < middle < far


def test_features_hold_when_boxes_are_off_and_centres_do_not(recording):
    exact, shaken = (both_ranges(recording, PLACES[:2], sigma) for sigma in (0.0, 3.0))
    assert relative(shaken.box_centres, shaken.true) > 2 * relative(exact.box_centres, exact.true)
    assert relative(shaken.features, shaken.true) < 1.3 * relative(exact.features, exact.true)
    assert relative(exact.box_centres, exact.true) < relative(exact.features, exact.true)


def test_a_box_around_a_near_sofa_says_too_far():
    too_far = [cuboid_range(rho, (0.9, 1.8, 0.8), 1.44, BASELINE) - rho for rho in (1.2, 2.0, 5.0)]
    assert too_far[0] > too_far[1] > too_far[2] > 0
    assert too_far[0] > 0.25


def test_around_a_mere_point_the_box_centre_is_right():
    assert cuboid_range(2.0, (1e-6, 1e-6, 1e-6), 1.44, BASELINE) == pytest.approx(2.0, abs=1e-4)


def test_the_half_hidden_refrigerator_is_a_metre_too_near_by_its_visible_boxes_only():
    found = ranges_of_one_object("10_a", 11)
    assert found["map"] - found["boxes of what is visible"] > 1.0
    assert found["boxes of the whole object"] == pytest.approx(found["map"], abs=0.25)
    assert found["features"] == pytest.approx(found["map"], abs=0.25)


def test_boxes_that_diverge_have_no_range():
    lower, upper = (600, 400, 640, 440), (600, 350, 640, 390)
    assert np.isnan(box_range(upper, lower, BASELINE, (1280, 640)))


def test_places_turn_with_the_heading():
    places = np.array([[2.0, 0.0, -1.0], [0.0, 1.0, -1.0]])
    assert places_in_room(places, [1.0, 1.0, np.pi / 2]) == pytest.approx(np.array([[1.0, 3.0], [0.0, 1.0]]))


def test_the_map_has_the_objects_that_the_recording_numbers(recording):
    labels = room_map().labels
    assert all(labels[thing.number] == thing.label for pair in recording.pairs for thing in pair.upper_objects)


def test_in_the_panel_the_error_grows_with_the_distance_and_shrinks_with_the_baseline(panel):
    def along(**values) -> float:
        summary = panel.draw(**(panel.defaults() | {"y": 0.0} | values)).summary
        return float(summary.split("along the ray ")[1].split(" m")[0])

    assert along(x=8.0) == pytest.approx(4 * along(x=4.0), rel=0.1)
    assert along(x=6.0, baseline=0.6) == pytest.approx(along(x=6.0) / 2, rel=0.1)
    assert along(sigma=0.0) == 0


def test_the_panel_tells_how_often_there_is_no_distance(panel):
    drawing = panel.draw(**(panel.defaults() | {"x": 9.0, "sigma": 4.0}))
    share = int(drawing.summary.split("diverging): ")[1].split("%")[0])
    assert 5 <= share <= 25


def test_the_ellipse_has_the_range_s_error_along_the_ray_and_the_azimuth_s_across_it():
    point = np.array([2.0, 1.0, -0.8])
    upper, lower = directions_to(point, BASELINE)
    covariance = triangulation_covariance(upper, lower, BASELINE, PIXEL, PIXEL)[:2, :2]
    variances, ways = np.linalg.eigh(covariance)
    rho, ray = np.hypot(2, 1), point[:2] / np.hypot(2, 1)
    slopes = [1 + (z / rho) ** 2 for z in (-0.8, -0.5)]
    assert np.sqrt(variances) == pytest.approx([rho * PIXEL, rho**2 / BASELINE * PIXEL * np.hypot(*slopes)])
    assert abs(ways[:, 1] @ ray) == pytest.approx(1)


def test_the_places_in_space_are_those_on_the_map_and_their_needles_point_at_the_rig(recording):
    seen = places_in_space(recording, "09_a", PIXEL)
    assert len(seen.labels) == len(seen.places) == 12
    assert np.median(np.linalg.norm((seen.places - seen.true)[:, :2], axis=1)) < 0.2
    assert seen.cameras[0, 2] - seen.cameras[1, 2] == pytest.approx(recording.rig.baseline)
    for place, covariance in zip(seen.places, seen.covariances, strict=True):
        ray = (place - seen.cameras[0])[:2] / np.linalg.norm((place - seen.cameras[0])[:2])
        assert abs(np.linalg.eigh(covariance[:2, :2])[1][:, 1] @ ray) == pytest.approx(1, abs=1e-6)


def test_exact_boxes_of_one_object_lie_in_nearly_one_column(recording):
    gaps = azimuth_gaps(recording)
    assert len(gaps) == 258
    assert gaps.max() <= 0.5


def test_no_distance_is_an_error_greater_than_any_other():
    true = np.array([1.0, 1.1, 1.2, 3.0, 3.1, 3.2])
    errors = np.array([0.1, 0.1, 0.1, np.nan, np.nan, 0.2])
    assert error_texts(errors, true, ((0, 2), (2, 4))) == "0.10 m (0.10 to 0.10), 100.00 m (0.20 to 100.00)"


@pytest.mark.parametrize("rho", [2.0, 4.0])
def test_the_challenge_s_mean_error_is_what_a_simulation_says(rho):
    e_u, e_l = np.arctan2(-0.9, rho), np.arctan2(-0.6, rho)
    noise = np.random.default_rng(14).normal(0, 0.003, (2, 400_000))
    ranges = BASELINE / (np.tan(e_l + noise[1]) - np.tan(e_u + noise[0]))
    assert ranges.mean() - rho == pytest.approx(mean_error(rho, e_u, e_l, BASELINE, 0.003), rel=0.15)
