"""What lesson 05 says about clouds that walk holds: spread, drift, too small, too large, corners."""

import numpy as np
import pytest

from course_lib.geometry import wrap_angle
from course_lib.lessons.kit.exercises import find_exercise, judge
from course_lib.lessons.lesson_05.clouds import corner_states, nearest_expected, wagon_states, walk
from course_lib.lessons.lesson_05.exercises import bayes_step, min_sigma
from course_lib.lessons.lesson_05.figures import beliefs_figure

SIGMA = np.array([0.15, 0.04, 0, 0, 0, np.deg2rad(1.5)])


def test_a_cloud_that_only_moves_stays_in_the_mean_and_spreads_with_the_root_of_t():
    still = np.tile(wagon_states()[0], (26, 1))
    clouds = walk(still, SIGMA, 4000, 0, keep_nearest=False).clouds
    offsets = clouds[25] - still[0]
    assert offsets[:, 0].std() == pytest.approx(5 * 0.15, rel=0.05)
    assert abs(offsets[:, 0].mean()) < 0.05
    assert (offsets[:, 2:5] == 0).all()


def test_with_the_oracle_the_spread_is_that_of_one_step():
    cloud = walk(wagon_states()[:40], SIGMA, 2000, 0, keep_nearest=True).clouds[-1]
    assert cloud[:, 0].std() == pytest.approx(0.15, rel=0.1)


@pytest.mark.parametrize(("sigma_x", "keeps_up"), [(0.03, False), (0.045, True)])
def test_two_hundred_particles_keep_up_from_the_threshold_on(sigma_x, keeps_up):
    path = wagon_states()[:200]
    for seed in (0, 1):
        end = walk(path, np.array([sigma_x, 0.04, 0, 0, 0, 0]), 200, seed, keep_nearest=True).nearest[-1]
        assert (end < 0.1) == keeps_up


def test_the_nearest_particle_is_as_far_as_the_density_says():
    true = np.tile(wagon_states()[0], (2, 1))
    found = [walk(true, SIGMA, 200, seed, keep_nearest=False).nearest[1] for seed in range(200)]
    assert np.mean(found) == pytest.approx(nearest_expected(0.15, 0.04, 200), rel=0.15)
    assert nearest_expected(1.5, 0.4, 200) == pytest.approx(10 * nearest_expected(0.15, 0.04, 200))


def test_around_the_corner_only_noise_along_its_own_axes_follows():
    corner, sigma = corner_states(), np.array([0.15, 0.02, 0, 0, 0, 0])
    steps = np.hypot(*np.diff(corner[:, :2], axis=0).T)
    assert steps.max() <= 0.1 + 1e-9
    assert steps.min() > 0.09
    for seed in (1, 2):
        assert walk(corner, sigma, 200, seed, True).nearest[-1] > 1
        assert walk(corner, sigma, 200, seed, True, own_axes=True).nearest[-1] < 0.1


def test_the_wagons_truth_cannot_be_changed_by_a_lesson():
    with pytest.raises(ValueError, match="read-only"):
        wagon_states()[0, 0] = 1


def by_matrices(particles, sigma_forward, sigma_left, draws):
    moved = []
    for p, d in zip(particles, draws, strict=True):
        turn = np.array([[np.cos(p[5]), -np.sin(p[5])], [np.sin(p[5]), np.cos(p[5])]])
        moved.append([*(p[:2] + turn @ (d * [sigma_forward, sigma_left])), *p[2:]])
    return moved


def by_cosine(particles, state, radius, angle):
    inside = ((particles[:, :2] - state[:2]) ** 2).sum(axis=1) <= radius**2
    return sum(inside & (np.cos(particles[:, 5] - state[5]) >= np.cos(angle))) / len(particles)


ANSWERS = [
    ("05.1", lambda spread0, sigma, t: np.hypot(spread0, np.sqrt(t) * sigma)),
    ("05.2", by_matrices),
    ("05.3", by_cosine),
]


@pytest.mark.parametrize(("number", "answer"), ANSWERS, ids=[number for number, _ in ANSWERS])
def test_another_way_to_the_right_values_passes(number, answer):
    assert all(judge(find_exercise(number), answer, seed).status == "right" for seed in range(8))


def test_yaw_left_unjudged_by_the_oracle_does_a_random_walk():
    ends = [walk(wagon_states()[:26], SIGMA, 50, seed, True).clouds[-1, 0, 5] for seed in range(60)]
    spread = np.std(wrap_angle(np.array(ends) - wagon_states()[0, 5]))
    assert spread == pytest.approx(5 * np.deg2rad(1.5), rel=0.35)


def test_particles_that_move_one_by_one_come_to_the_exact_prediction_of_the_bayes_filter():
    belief, moves = np.array([0.5, 0.2, 0.1, 0.1, 0.1]), np.array([0.1, 0.8, 0.1])
    nothing_seen = (np.zeros(5, bool), False, 0.0, 0.0)
    exact = bayes_step(belief, moves, *nothing_seen)
    rng = np.random.default_rng(0)
    cells = np.minimum(rng.choice(5, 200_000, p=belief) + rng.choice(3, 200_000, p=moves), 4)
    assert np.bincount(cells, minlength=5) / 200_000 == pytest.approx(exact, abs=0.004)


def test_the_least_sigma_of_exercise_05_5_keeps_up_in_just_that_share_of_runs():
    sigma = min_sigma(0.1, 50, 30, 0.8)
    rng = np.random.default_rng(1)
    runs = [(sigma * rng.standard_normal((30, 50))).max(axis=1).min() >= 0.1 for _ in range(4000)]
    assert np.mean(runs) == pytest.approx(0.8, abs=0.02)


def test_the_figure_of_beliefs_has_a_bar_for_each_cell_and_the_shares_as_dots():
    beliefs = {name: np.arange(4) / 6 for name in "abcd"}
    figure = beliefs_figure(beliefs, [1, 3], {"b": np.full(4, 0.25)})
    assert [len(axes.patches) for axes in figure.axes] == [4] * 4
    assert [bar.get_height() for bar in figure.axes[1].patches] == pytest.approx(beliefs["b"])
    assert [len(axes.lines) for axes in figure.axes] == [1, 2, 1, 1]


def test_less_than_is_not_at_most_and_is_found_out():
    def less_than(particles, state, radius, angle):
        near = np.hypot(particles[:, 0] - state[0], particles[:, 1] - state[1]) <= radius
        return np.mean(near & (np.abs(wrap_angle(particles[:, 5] - state[5])) < angle))

    assert all(judge(find_exercise("05.3"), less_than, seed).status == "wrong" for seed in range(3))
