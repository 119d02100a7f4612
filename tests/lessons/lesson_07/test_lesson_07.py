"""What lesson 07 says of means, sample sizes and resamplers holds, and the filter stepper steps as figure 1 does."""

import numpy as np
import pytest
from filterpy.kalman import predict, update
from filterpy.monte_carlo import residual_resample

from course_lib.depth_mcl.particle_filter import resample
from course_lib.lessons.lesson_07.beside_kalman import (
    DOORS,
    LASER,
    ROLLING,
    START,
    STEP,
    beside_kalman,
    best_bells,
    door_likelihood,
    kalman_means,
    wagon_and_laser,
)
from course_lib.lessons.lesson_07.exercises import stratified_error
from course_lib.lessons.lesson_07.filter_stepper import (
    ALLOWED_AFTER,
    FRAMES,
    NotNowError,
    Settings,
    corridor_stretch,
    look,
    present_particles,
    start,
    step,
    whole_round,
)
from course_lib.lessons.lesson_07.panel import StepperSession, stepper_panel
from course_lib.lessons.lesson_07.resampling import (
    copies,
    different_over_rounds,
    follow,
    mean_copies,
    numpy_global_seed,
)

PAPER = Settings(alpha=0.1, beta=0.01, n_particles=50, noise=1.0)
TEN = np.array([0.22] * 2 + [0.07] * 8)


def test_the_steps_come_in_the_order_of_figure_1():
    stretch = corridor_stretch()
    state = start(stretch)
    view = look(state, PAPER, stretch)
    for name in ("estimate", "resample", "propagate", "weigh"):
        state = step(state, name, view)
        assert state.done == name
    assert state.frame == 2


def test_a_step_out_of_order_is_refused_by_name_and_changes_nothing():
    stretch = corridor_stretch()
    state = start(stretch)
    with pytest.raises(NotNowError, match="weigh comes after propagate"):
        step(state, "weigh", look(state, PAPER, stretch))
    with pytest.raises(NotNowError, match="there is no step 'fly'"):
        step(state, "fly", look(state, PAPER, stretch))


def test_resampling_before_propagating_keeps_the_heavy_particles_only():
    stretch = corridor_stretch()
    state = start(stretch)
    view = look(state, PAPER, stretch)
    kept = step(step(state, "resample", view), "propagate", view).parents
    assert len(np.unique(kept[:, 0])) < 10
    assert len(np.unique(step(state, "propagate", view).parents[:, 0])) == 50


def test_the_same_state_and_settings_give_the_same_view():
    stretch = corridor_stretch()
    first, second = (look(start(stretch), PAPER, stretch) for _ in range(2))
    assert np.array_equal(first.particles, second.particles)
    assert np.array_equal(first.indices, second.indices)


def test_the_number_of_particles_and_the_noise_act_on_the_present_frame():
    stretch = corridor_stretch()
    few, still = PAPER._replace(n_particles=5), PAPER._replace(noise=0.0)
    assert present_particles(start(stretch), few).shape == (5, 6)
    assert np.ptp(present_particles(start(stretch), still), axis=0).max() < 1e-12
    assert look(start(stretch), still, stretch).ess == pytest.approx(50)


def test_whole_rounds_follow_the_wagon_to_the_end_of_the_stretch():
    stretch = corridor_stretch()
    state = start(stretch)
    for _ in range(len(FRAMES) - 2):
        state = whole_round(state, PAPER, stretch)
    estimate = look(state, PAPER, stretch).estimate
    assert np.linalg.norm(estimate[:2] - stretch.true[-1, :2]) < 0.3
    with pytest.raises(NotNowError, match="the stretch ends here"):
        whole_round(state, PAPER, stretch)


def test_buttons_do_what_they_say_and_a_refusal_is_told():
    panel = stepper_panel()
    panel.press("Weigh")
    assert panel.error is None
    assert "Not now: weigh comes after propagate" in panel.draw(**panel.values()).summary
    panel.press("Estimate")
    assert "estimate: off by" in panel.draw(**panel.values()).summary
    panel.press("Resample")
    assert "different particles" in panel.draw(**panel.values()).summary
    panel.press("Propagate")
    assert "frame 2 of 23; last step: propagate" in panel.draw(**panel.values()).summary
    panel.press("Whole round")
    assert "frame 3 of 23; last step: estimate" in panel.draw(**panel.values()).summary
    panel.set(beta=0.5)
    panel.press("Reset")
    assert panel.values() == panel.defaults()
    assert "frame 1 of 23; last step: weigh" in panel.draw(**panel.values()).summary


def test_every_panel_has_a_session_of_its_own():
    one, other = StepperSession(corridor_stretch()), StepperSession(corridor_stretch())
    values = {"alpha": 0.1, "beta": 0.1, "n_particles": 50, "noise": 1.0, "seed": 1}
    one.press("estimate", values)
    assert (one.state.done, other.state.done) == ("estimate", "weigh")
    assert set(ALLOWED_AFTER) == {"propagate", "weigh", "estimate", "resample"}


def test_a_larger_beta_lets_more_particles_take_part_and_lags():
    paper, middle, flat = (follow(beta) for beta in (0.01, 0.1, 1.0))
    assert np.median(paper.ess) < np.median(middle.ess) < np.median(flat.ess)
    assert np.median(paper.ess) < 2
    assert np.median(flat.errors) > 2 * np.median(paper.errors)


def test_without_resampling_the_cloud_grows():
    assert follow(0.1, resampled=False).spread > 2 * follow(0.1).spread


def test_equal_weights_lose_particles_only_to_independent_draws():
    left = {scheme: different_over_rounds(scheme, 64, 100, seed=1)[-1] for scheme in ("systematic", "multinomial")}
    assert left["systematic"] == 64
    assert left["multinomial"] < 10


def test_systematic_resampling_gives_two_or_three_copies_for_two_point_two():
    drawn = copies("systematic", TEN, repeats=500, seed=0)
    assert set(drawn[:, 1].tolist()) == {2, 3}
    assert (drawn.sum(axis=1) == 10).all()


def test_the_kalman_filter_is_filterpys():
    _, measured = wagon_and_laser(seed=3)
    mean, variance, means = START, 0.0, []
    for z in measured:
        mean, variance = update(*predict(mean, variance, u=STEP, Q=ROLLING**2), z, LASER**2)
        means.append(mean)
    assert kalman_means(measured) == pytest.approx(means)


def test_sixteen_times_the_particles_come_four_times_as_near_to_the_kalman_filter():
    few, many = (np.median(beside_kalman(n).from_kalman) for n in (25, 400))
    assert 3 < few / many < 5.5


def test_particles_tell_doors_apart_and_one_bell_does_not():
    first, second = best_bells((0.0, 2.0))
    assert first.mean == pytest.approx(np.mean(DOORS), abs=1e-3)
    assert np.trapezoid(second.density(np.linspace(-30, 40, 7001)), dx=0.01) == pytest.approx(1)
    assert second.share_within(4.0, 0.5) < 0.2
    assert abs(second.mean - np.array(DOORS)).min() > 1
    assert door_likelihood(np.array([4.0, 6.0])) == pytest.approx([1, 0], abs=1e-9)


@pytest.mark.parametrize("seed", [1, 2])
def test_the_error_bar_of_stratified_resampling_is_that_of_the_simulation(seed):
    rng = np.random.default_rng(seed)
    w, x = TEN if seed == 1 else rng.dirichlet(np.ones(8)), rng.normal(size=10 if seed == 1 else 8)
    moved = copies("stratified", w, repeats=6000, seed=seed) @ x / len(w)
    assert moved.std() == pytest.approx(stratified_error(w, x), rel=0.04)


def test_filterpy_loses_the_light_particles_and_ours_does_not():
    with numpy_global_seed(1):
        famous = mean_copies(residual_resample, TEN, repeats=300)
    rng = np.random.default_rng(1)
    ours = mean_copies(lambda w: resample(w, rng, "residual"), TEN, repeats=300)
    assert (famous[2:] == 0).all()
    assert np.abs(ours - 10 * TEN).max() < 0.15


def test_the_global_generator_is_left_as_it_was():
    before = np.random.get_state()[1].copy()  # noqa: NPY002
    with numpy_global_seed(3):
        first = np.random.random()  # noqa: NPY002
    assert np.array_equal(before, np.random.get_state()[1])  # noqa: NPY002
    with numpy_global_seed(3):
        assert np.random.random() == first  # noqa: NPY002
