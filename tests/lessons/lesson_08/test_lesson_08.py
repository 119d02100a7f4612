"""Lesson 08's filter along the corridor: it follows, it is lost, and its two errors tell different stories."""

import numpy as np
import pytest

from course_lib.lessons.lesson_08.along import OFFSETS, AgreementTable, localize_along, row
from course_lib.lessons.lesson_08.exercises import effective_frames
from course_lib.lessons.lesson_08.figures import as_in_the_paper_figure, two_errors_figure
from course_lib.lessons.lesson_08.stored_runs import neighbours_correlation, spread_over_seeds, stored_runs


@pytest.fixture(scope="module")
def table() -> AgreementTable:
    """A wagon that rolls 0.1 m a frame along a straight path, and a hill as wide as the corridor's."""
    true = np.zeros((24, 6))
    true[:, 0] = 8 + 0.1 * np.arange(24)
    path = np.column_stack([np.linspace(0, 20, 2001), np.zeros(2001), np.zeros(2001)])
    hill = 0.3 + 0.4 / (1 + np.abs(OFFSETS) / 0.15)
    return AgreementTable(true, path, np.tile(hill, (24, 1)))


def along(table, **changes):
    given = {"n_particles": 200, "sigma_x": 0.15, "beta": 0.01, "start_error": 0.0, "seed": 1} | changes
    return localize_along(table, **given)


def test_agreement_is_read_at_the_distance_from_the_truth(table):
    assert table.at(3, table.true[3, 0] + np.array([0.0, 0.15, -0.15])) == pytest.approx([0.7, 0.5, 0.5])
    assert table.at(0, np.array([100.0])) == pytest.approx(table.agreement[0, -1])


def test_with_the_papers_parameters_it_follows_the_wagon(table):
    run = along(table)
    assert run.timed.errors.max() < 0.05
    assert run.scores.min() > 0.6


def test_with_too_little_noise_it_lags_and_only_the_timed_error_and_the_score_say_so(table):
    run = along(table, sigma_x=0.01)
    assert run.timed.errors[-1] > 0.5
    assert run.nearest.errors.max() < 0.01
    assert run.scores[-1] < 0.8 * run.scores[0]
    assert np.median(run.best_weights) > 0.5


def test_the_same_seed_gives_the_same_run_and_another_one_does_not(table):
    assert np.array_equal(along(table).x, along(table).x)
    assert not np.array_equal(along(table).x, along(table, seed=2).x)


def test_a_row_tells_nothing_finer_than_the_table_is_spaced(table):
    assert row(along(table)).count("< 0.05 m") == 4
    lost = along(table, sigma_x=0.01)
    assert f"largest {lost.timed.errors.max():.2f} m" in row(lost)


def test_the_picture_of_two_errors_draws_what_it_says():
    _, errors = two_errors_figure()
    assert errors["timed error"] > 10 * errors["nearest-path error"]


@pytest.mark.parametrize("a", [0.9, -0.4])
def test_what_frames_are_worth_is_what_a_simulation_of_their_mean_says(a):
    rng, runs, n = np.random.default_rng(1), 3000, 40
    errors = [rng.normal(size=runs)]
    for _ in range(n - 1):
        errors.append(a * errors[-1] + np.sqrt(1 - a**2) * rng.normal(size=runs))
    assert 1 / np.var(np.mean(errors, axis=0)) == pytest.approx(effective_frames(n, a), rel=0.08)
    assert neighbours_correlation(np.ravel(np.array(errors).T)) == pytest.approx(a, abs=0.05)


def test_the_figures_as_in_the_paper_hold_the_stored_run():
    run = stored_runs()[0]
    place, error = as_in_the_paper_figure(run, np.zeros((2, 3))).axes
    assert len(place.lines[1].get_xdata()) == len(error.lines[0].get_ydata()) == 304
    assert error.get_yscale() == "linear"
    assert max(error.lines[0].get_ydata()) == run.columns["proposed_nearest_m"].max()


def test_a_number_is_told_with_its_least_and_greatest_over_the_seeds():
    assert spread_over_seeds(stored_runs(), "proposed", "median_m") == "0.017 (0.014 to 0.017)"
