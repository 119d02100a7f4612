"""The whole filter on small rooms, and what it does with bad input."""

import warnings
from typing import get_args

import numpy as np
import pytest

from course_lib.depth_mcl.evaluation import PAPER_TABLE_1, nearest_path_error, pose_errors, timed_error
from course_lib.depth_mcl.fallon import fallon_weighting
from course_lib.depth_mcl.likelihood import (
    ALPHA,
    BETA,
    DepthImageError,
    likelihood,
    normalize_likelihood,
    paper_weighting,
    weights,
)
from course_lib.depth_mcl.localizer import MonteCarloLocalizer, NoMeasurementWarning, SlowFilterWarning
from course_lib.depth_mcl.motion import BODY_AXES, TANGENT_SPACE, WORLD_AXES, propagate
from course_lib.depth_mcl.particle_filter import Scheme, initial_particles, resample, weighted_mean_state
from course_lib.geometry import pose_matrix, state_from_matrix, wrap_angle
from course_lib.rendering.renderer import DepthRenderer
from tests.rendering.shapes import SMALL, furnished_room, room, room_depth

START = np.array([0.5, -0.3, 0.2, 0.0, 0.0, 0.4])
SIGMA = [0.05, 0.05, 0, 0, 0, 0.03]


@pytest.fixture
def renderer():
    with DepthRenderer(room(), SMALL, "vtk") as opened:
        yield opened


def walk(n):
    steps = np.zeros((n, 6))
    steps[:, 0], steps[:, 5] = 0.04, 0.02
    return START + np.cumsum(steps, axis=0)


def run(localizer, true):
    localizer.initialize(START)
    return [localizer.step(room_depth(SMALL, state)[0]) for state in true]


@pytest.mark.parametrize(
    ("motion", "weighting", "bound"),
    [
        *((motion, None, 0.05) for motion in (BODY_AXES, WORLD_AXES, TANGENT_SPACE)),
        *((motion, fallon_weighting(form), 0.15) for motion, form in ((BODY_AXES, "depth"), (WORLD_AXES, "disparity"))),
    ],
)
def test_the_filter_follows_a_walk(renderer, motion, weighting, bound):
    true = walk(25)
    estimates = run(MonteCarloLocalizer(renderer, 150, SIGMA, seed=1, motion=motion, weighting=weighting), true)
    states = np.array([e.state for e in estimates])
    # A filter that stays at its start, or loses the walk anywhere, is off by up to a metre and half a radian.
    assert timed_error(states[:, :3], true[:, :3]).errors.max() < 3 * bound
    assert timed_error(states[:, :3], true[:, :3]).median < bound
    assert np.abs(wrap_angle(states[:, 5] - true[:, 5])).max() < 3 * bound
    for estimate in estimates:
        assert estimate.weights.sum() == pytest.approx(1)
        assert 1 <= estimate.ess <= 150 + 1e-9
        assert np.linalg.eigvalsh(estimate.covariance).min() > -1e-12


def test_a_filter_knows_no_direction_of_the_world():
    """The same draws in a room that is drawn askew: the same particles and the same answer, turned."""
    world, estimates = pose_matrix([1.0, 2.0, 0, 0, 0, 0.7]), []
    for moved in (np.eye(4), world):
        with DepthRenderer(furnished_room().transformed(moved), SMALL, "ray") as renderer:
            localizer = MonteCarloLocalizer(renderer, 60, SIGMA, seed=1)
            localizer.initialize(state_from_matrix(moved @ pose_matrix(START)))
            estimates.append(localizer.step(room_depth(SMALL, START)[0]))
    first, second = estimates
    assert pose_matrix(second.particles) == pytest.approx(world @ pose_matrix(first.particles), abs=1e-9)
    assert pose_matrix(second.state) == pytest.approx(world @ pose_matrix(first.state), abs=1e-3)


@pytest.mark.parametrize("scheme", get_args(Scheme))
def test_a_step_is_figure_1_one_equation_after_the_other(renderer, scheme):
    """Eq. (5), then (6) and (7), (8), (9) to (11), (12), and 3.4, each by its own function."""
    depth = room_depth(SMALL, walk(1)[0])[0]
    localizer = MonteCarloLocalizer(renderer, 40, SIGMA, 0.5, 0.3, seed=5, motion=WORLD_AXES, resampling=scheme)
    localizer.initialize(START)
    estimate = localizer.step(depth)
    rng = np.random.default_rng(5)
    particles = propagate(initial_particles(START, 40), SIGMA, rng)
    values = likelihood(renderer.render_points(SMALL.points(depth)), renderer.render(particles), 0.5)
    w = weights(normalize_likelihood(values), 0.3)
    assert np.array_equal(estimate.particles, particles)
    assert (particles[:, 2:5] == START[2:5]).all()  # what has no noise stays at its start
    assert estimate.weights == pytest.approx(w, rel=1e-4)
    assert estimate.state == pytest.approx(weighted_mean_state(particles, w), abs=1e-6)
    assert np.array_equal(localizer.particles, particles[resample(estimate.weights, rng, scheme)])


def test_the_same_seed_gives_the_same_bytes_and_the_score_falls_when_the_filter_is_lost(renderer):
    runs = [
        np.array([e.particles for e in run(MonteCarloLocalizer(renderer, 60, SIGMA, seed=seed), walk(4))])
        for seed in (7, 7, 8)
    ]
    assert runs[0].tobytes() == runs[1].tobytes()
    assert runs[0].tobytes() != runs[2].tobytes()
    estimates = []
    for start in (START, START + np.array([-2.0, 1.5, 0, 0, 0, 1.0])):
        localizer = MonteCarloLocalizer(renderer, 40, SIGMA)
        localizer.initialize(start)
        estimates.append(localizer.step(room_depth(SMALL, START)[0]))
    assert estimates[0].score > 0.8
    assert estimates[1].score < 0.5
    assert estimates[1].ess < 20


def test_a_frame_without_measurement_moves_the_particles_says_so_and_the_filter_goes_on(renderer):
    localizer, true = MonteCarloLocalizer(renderer, 80, SIGMA), walk(3)
    localizer.initialize(START)
    localizer.step(room_depth(SMALL, true[0])[0])
    before = localizer.particles.copy()
    with pytest.warns(NoMeasurementWarning, match="no measurement"):
        estimate = localizer.step(np.full(SMALL.shape, np.nan))
    assert estimate.status == "no measurement"
    assert np.isnan(estimate.score)
    assert estimate.weights == pytest.approx(np.full(80, 1 / 80))
    # One more frame's noise, on the cloud as it was: the particles moved, each a step of its own.
    steps = localizer.particles - before
    assert np.array_equal(localizer.particles, estimate.particles)
    assert np.linalg.norm(steps[:, :2], axis=1).min() > 0
    assert np.abs(steps[:, 5]).std() == pytest.approx(SIGMA[5] * np.sqrt(1 - 2 / np.pi), rel=0.3)
    assert (steps[:, 2:5] == 0).all()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert localizer.step(room_depth(SMALL, true[2])[0]).status == "tracked"


def test_with_three_components_good_frames_are_tracked_and_wrong_ones_lost(renderer):
    assert {e.status for e in run(MonteCarloLocalizer(renderer, 150, SIGMA, seed=1), walk(10))} == {"tracked"}
    lost = MonteCarloLocalizer(renderer, 40, SIGMA)
    lost.initialize(START + np.array([-2.0, 1.5, 0, 0, 0, 1.0]))
    assert lost.step(room_depth(SMALL, START)[0]).status == "lost"


def test_with_six_components_and_few_particles_wrong_poses_are_not_tracked():
    """As wrong as such a filter becomes: metres, in two of three frames."""
    true = START + np.sin(np.arange(40)[:, None] * [0.15, 0.1, 0.15, 0.2, 0.2, 0.15]) * [1.0, 0.6, 0.3, 0.1, 0.15, 0.5]
    with DepthRenderer(furnished_room(), SMALL) as renderer:
        images, wrong = renderer.render(true), []
        for seed in (1, 2):
            localizer = MonteCarloLocalizer(renderer, 100, [0.05] * 3 + [0.03] * 3, seed=seed, motion=TANGENT_SPACE)
            localizer.initialize(true[0])
            for image, state in zip(images, true, strict=True):
                estimate = localizer.step(image)
                if np.linalg.norm(estimate.state[:3] - state[:3]) > 0.2:
                    wrong.append(estimate.status)
    assert len(wrong) > 40
    assert wrong.count("tracked") <= 0.05 * len(wrong)


@pytest.mark.parametrize("motion", [BODY_AXES, WORLD_AXES, TANGENT_SPACE])
def test_a_start_with_a_covariance_is_drawn_from_it(renderer, motion):
    root = np.zeros((6, 6))
    root[np.ix_([0, 1, 5], [0, 1, 5])] = [[0.3, 0, 0], [0.1, 0.2, 0], [0.02, -0.05, 0.1]]
    localizer = MonteCarloLocalizer(renderer, 20_000, SIGMA, motion=motion)
    start = START + np.array([0, 0, 0, 0, 0, np.pi])
    localizer.initialize(start, root @ root.T)
    deviations = motion.deviations(localizer.particles, start)
    assert np.cov(deviations.T) == pytest.approx(root @ root.T, abs=0.002)
    assert deviations[:, 2:5] == pytest.approx(np.zeros((20_000, 3)), abs=1e-12)
    assert motion.scatter(start, deviations) == pytest.approx(localizer.particles, abs=1e-9)
    localizer.initialize(START)
    assert (localizer.particles == START).all()
    for bad, said in (
        (np.eye(5), r"\(6, 6\)"),
        (np.triu(np.ones((6, 6))), "symmetric"),
        (-np.eye(6), "negative eigenvalues"),
        (np.diag([1, 1, 1, 0, 0, 100.0]), "square radians"),
        (np.full((6, 6), np.nan), "finite"),
    ):
        with pytest.raises(ValueError, match=said):
            localizer.initialize(START, bad)


def test_a_filter_that_would_be_slow_says_how_to_make_it_fast():
    large = SMALL.resized(640, 480)
    with DepthRenderer(room(), large, "raster") as renderer:
        with pytest.warns(SlowFilterWarning, match=r"200 particles of 640 x 480 .*camera\.resized\(160, 120\)"):
            MonteCarloLocalizer(renderer, 200)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            MonteCarloLocalizer(renderer, 100)


@pytest.mark.filterwarnings("ignore::course_lib.depth_mcl.localizer.NoMeasurementWarning")
@pytest.mark.parametrize("depth", [SMALL.near / 2, SMALL.far + 1])
def test_what_the_views_cannot_show_is_no_measurement(renderer, depth):
    """Eq. (7): the measured image goes through the camera's near and far planes as the simulated ones do."""
    localizer = MonteCarloLocalizer(renderer, 10, SIGMA)
    localizer.initialize(START)
    assert localizer.step(np.full(SMALL.shape, depth)).status == "no measurement"


@pytest.mark.filterwarnings("ignore::course_lib.depth_mcl.localizer.NoMeasurementWarning")
def test_arrays_that_the_filter_took_or_gave_are_the_callers_own(renderer):
    depths = [room_depth(SMALL, walk(3)[0])[0], np.full(SMALL.shape, np.nan), room_depth(SMALL, walk(3)[2])[0]]
    last = []
    for spoil in (False, True):
        sigma, start = np.array(SIGMA), START.copy()
        localizer = MonteCarloLocalizer(renderer, 30, sigma)
        localizer.initialize(start)
        for depth in depths:
            image = depth.copy()
            estimate = localizer.step(image)
            last.append(np.concatenate([estimate.state, localizer.particles.ravel()]))
            for array in (sigma, start, image, *estimate[:2], estimate.particles, estimate.weights) if spoil else ():
                array[:] = 9.0
    assert np.array_equal(last[:3], last[3:])


# Weights that depend on the particle's number alone.
by_rank = paper_weighting()._replace(weigh=lambda measured, scores: np.arange(1, 61) / np.arange(1, 61).sum())


@pytest.mark.parametrize("motion", [BODY_AXES, WORLD_AXES, TANGENT_SPACE])
def test_the_covariance_is_that_of_the_weighted_particles_across_the_wrap_too(renderer, motion):
    backwards = START * [1, 1, 1, 0, 0, 0] + [0, 0, 0, 0, 0, np.pi]
    localizer = MonteCarloLocalizer(renderer, 60, SIGMA, motion=motion, weighting=by_rank)
    localizer.initialize(backwards)
    estimate = localizer.step(room_depth(SMALL, backwards)[0])
    unwrapped = estimate.particles.copy()
    unwrapped[:, 5] %= 2 * np.pi
    expected = np.cov(unwrapped.T, aweights=np.arange(1, 61), ddof=0)
    assert expected[5, 5] == pytest.approx(SIGMA[5] ** 2, rel=0.6)
    assert estimate.covariance == pytest.approx(expected, rel=1e-3, abs=1e-7)


@pytest.mark.parametrize("weighting", [None, fallon_weighting("depth")])
def test_particles_that_are_rendered_in_batches_are_weighed_together(weighting):
    """Seven images a batch, forty particles: nothing changes but the memory that it takes."""
    estimates = []
    for max_batch_pixels in (7 * SMALL.width * SMALL.height, 10**7):
        with DepthRenderer(room(), SMALL, max_batch_pixels=max_batch_pixels) as renderer:
            assert (renderer.batch_size == 7) == (not estimates)
            estimates += run(MonteCarloLocalizer(renderer, 40, SIGMA, seed=3, weighting=weighting), walk(1))
    assert np.array_equal(estimates[0].weights, estimates[1].weights)
    assert estimates[0].score == estimates[1].score


def test_what_cannot_be_a_setting_a_start_or_a_frame_is_named(renderer):
    bad = {"n_particles": 0, "sigma": [0.1] * 5, "alpha": 0.0, "beta": -1.0, "motion": "tangent", "seed": -1}
    for name, value in (*bad.items(), ("resampling", "lottery"), ("weighting", likelihood)):
        with pytest.raises(ValueError, match=rf"{name} must|sigma needs|scheme must"):
            MonteCarloLocalizer(renderer, **{name: value})
    for setting in ({"alpha": 2 * ALPHA}, {"beta": 2 * BETA}):
        with pytest.raises(ValueError, match="leave them out"):
            MonteCarloLocalizer(renderer, weighting=paper_weighting(), **setting)
    localizer = MonteCarloLocalizer(renderer, 10, SIGMA)
    with pytest.raises(RuntimeError, match="initialize"):
        localizer.step(np.ones(SMALL.shape))
    for state in ([20.0, 0, 0, 0, 0, 0], [np.nan] * 6, np.zeros(5)):
        with pytest.raises(ValueError, match=r"outside the map|state0"):
            localizer.initialize(state)
    for angles in ((0, 0, 90), (4, 0, 0), (0, -5, 0)):
        with pytest.raises(ValueError, match=r"look like degrees: give np\.deg2rad"):
            localizer.initialize([0, 0, 0, *angles])
    localizer.initialize([0, 0, 0, np.pi, -np.pi, 2 * np.pi])
    localizer.initialize(START)
    before = localizer.particles.copy()
    depth = room_depth(SMALL, START)[0]
    millimetres = 1000 * depth
    for image, said in (
        (np.ones((64, 48)), r"\(48, 64\)"),
        (millimetres.astype(np.uint16), "holds uint16; metres as float .* divide them by 1000"),
        (millimetres, "millimetres: divide them by 1000"),
        (np.where(depth > 2.9, millimetres, np.nan), "millimetres"),
    ):
        with pytest.raises(DepthImageError, match=said):
            localizer.step(image)
    assert np.array_equal(localizer.particles, before)


def test_the_nearest_path_error_hides_error_along_the_path_and_the_timed_error_does_not():
    path = np.column_stack([np.arange(0, 10, 0.01), np.zeros(1000)])
    true = path[::20]
    estimated = true + np.array([0.4, 0.05])
    nearest, timed = nearest_path_error(estimated[:40], path), timed_error(estimated[:40], true[:40])
    assert nearest.median == pytest.approx(0.05, abs=1e-6)
    assert timed.median == pytest.approx(np.hypot(0.4, 0.05))
    assert (nearest.within_3sigma, timed.within_3sigma) == (1.0, 0.0)
    errors = nearest_path_error(np.array([[0, 0.299], [0, -0.301]]), np.zeros((1, 2)))
    assert errors.sigma == pytest.approx(np.sqrt((0.299**2 + 0.301**2) / 2))
    assert errors.within_3sigma == 0.5
    assert PAPER_TABLE_1 == {"proposed method": (0.07, 0.10, 99.0), "Fallon et al. [2]": (0.30, None, 90.0)}


def test_pose_errors_are_metres_and_radians_in_space():
    true = pose_matrix([1.0, 2.0, 3.0, 0.0, 0.0, 0.5])
    estimated = pose_matrix([[1.2, 2.1, 3.2, 0.0, 0.0, 0.2], [1.0, 2.0, 3.0, 0.4, 0.0, 0.5]])
    metres, radians = pose_errors(estimated, true)
    assert metres == pytest.approx([0.3, 0.0])
    assert radians == pytest.approx([0.3, 0.4])
