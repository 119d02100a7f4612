"""The annealed filter in a small furnished room: it follows, finds again, says when it does not know."""

import numpy as np
import pytest

from course_lib.beyond.six_dof.localizer import AnnealedLocalizer
from course_lib.beyond.six_dof.poses import lengths, local, motion_between, retract
from course_lib.beyond.six_dof.prediction import START_SPREAD
from course_lib.depth_mcl.localizer import NoMeasurementWarning
from course_lib.geometry import optical_pose, state_from_optical_pose
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap
from tests.rendering.shapes import SMALL, fence, furnished_room, rough_wall, wall

START = np.array([-1.0, 0.3, -0.3, 0.05, 0.1, -0.4])


def walk(n, step=0.15, turn=0.08):
    """Poses on an arc to and fro through the room, the camera nodding and rolling: all six numbers change."""
    reach = np.array([1.0, 0.6, 0.3, 0.1, 0.15, 0.5])
    pace = np.array([step, 0.4 * step, 0.3 * step, 0.3 * turn, 0.4 * turn, turn])
    return START + reach * np.sin(np.arange(n)[:, None] * pace / reach)


def moved(state, motion):
    return state_from_optical_pose(retract(optical_pose(state), motion))


def noisy(depth, rng):
    return depth + 0.01 * rng.standard_normal(depth.shape).astype(np.float32)


def run(renderer, depth, start=START, **how):
    localizer = AnnealedLocalizer(renderer, **{"seed": 1, **how})
    localizer.initialize(start)
    return [localizer.step(image) for image in depth]


def off(estimates, true):
    """Distances in metres and angles in radians, `(T, 2)`."""
    return lengths(local(optical_pose(true), optical_pose(np.array([e.state for e in estimates]))))


@pytest.mark.parametrize("step", [0.02, 0.15, 0.3])
def test_slow_or_fast_it_follows_all_six(renderer, rng, step):
    true = walk(20, step, 0.6 * step)
    estimates = run(renderer, noisy(renderer.render(true), rng))
    errors = off(estimates, true)
    assert (np.median(errors, axis=0) < [0.01, 0.005]).all()
    assert (errors < [0.05, 0.03]).all()
    assert {e.status for e in estimates} <= {"tracked", "doubtful"}
    by_hand = run(renderer, renderer.render(true[:3]), moved(START, np.repeat(0.8 * START_SPREAD, 3)), seed=2)
    assert (off(by_hand, true[:3])[-1] < [0.01, 0.01]).all(), "a start by hand may be off"
    for estimate in estimates:
        assert estimate.renders <= 600
        assert estimate.weights.sum() == pytest.approx(1)
        assert len(estimate.particles) == len(estimate.weights) in (60, 80)
        assert np.linalg.eigvalsh(estimate.error_covariance).min() > 0


def test_a_jump_is_found_by_the_second_look(renderer):
    """At rest, then 0.35 m and 20 degrees at once: beyond the first look's cloud."""
    true = np.array([START] * 5 + [moved(START, np.array([0.2, 0.1, 0.27, 0.0, 0.35, 0.0]))] * 4)
    depth = renderer.render(true)
    with_it, without = (
        [off(run(renderer, depth, seed=seed, image_motion=False, **how), true)[5, 0] for seed in range(4)]
        for how in ({}, {"second_look": ()})
    )
    assert np.median(with_it) < 0.5 * np.median(without)


def test_two_metres_off_it_says_that_it_is_lost_a_person_does_not_unsettle_it_and_a_blind_frame_is_predicted(renderer):
    elsewhere = START + np.array([2.0, -1.5, 0.3, 0, 0, 1.5])
    estimates = run(renderer, renderer.render(np.concatenate([walk(4), np.tile(elsewhere, (2, 1))])))
    assert [e.status for e in estimates] == ["tracked"] * 4 + ["lost"] * 2
    sigma = [np.sqrt(np.trace(e.error_covariance[:3, :3])) for e in estimates]
    assert sigma[4] > 10 * sigma[3], "an image that cannot be right is no information"
    true = walk(15, 0.05, 0.03)
    depth = renderer.render(true)
    depth[5:12, :, 20:40] = 0.7
    estimates = run(renderer, depth, seed=3)
    errors, status = off(estimates, true), np.array([e.status for e in estimates])
    assert (errors[status == "tracked"] < [0.05, 0.03]).all()
    assert (errors < [0.2, 0.03]).all()
    assert "lost" not in status
    true = true[:9]
    depth = renderer.render(true)
    depth[4] = np.nan
    with pytest.warns(NoMeasurementWarning):
        estimates = run(renderer, depth)
    blind = estimates[4]
    assert (blind.status, blind.renders) == ("no measurement", 0)
    assert np.isnan(blind.score)
    errors = off(estimates, true)
    assert errors[4, 0] < 0.15
    assert np.trace(blind.error_covariance) > np.trace(estimates[3].error_covariance)
    assert (errors[5:] < [0.03, 0.02]).all()


def test_an_odometer_carries_it_where_motion_is_sudden(renderer):
    """Steps of half a metre to and fro: going on as before is the wrong prediction every time."""
    true = np.array([START, moved(START, np.array([0.3, 0.0, 0.4, 0.0, 0.5, 0.0]))] * 5)
    depth = renderer.render(true)
    localizer = AnnealedLocalizer(renderer, seed=1, second_look=(), image_motion=False)
    localizer.initialize(START)
    localizer.step(depth[0])
    told = motion_between(true[:-1], true[1:])
    estimates = [localizer.step(d, increment) for d, increment in zip(depth[1:], told, strict=True)]
    assert (off(estimates, true[1:]) < [0.02, 0.01]).all()


@pytest.mark.parametrize("increment", [np.full(6, np.nan), np.eye(4), np.full(6, 100.0)])
def test_an_increment_that_is_none_changes_nothing(renderer, increment):
    """On a blank frame and on another: the steps after it give the bytes that they give without it."""
    depth = renderer.render(walk(3))
    blank = np.full(SMALL.shape, np.nan)
    states = []
    for disturbed in (False, True):
        localizer = AnnealedLocalizer(renderer, n_particles=40, seed=1)
        localizer.initialize(START)
        localizer.step(depth[0])
        for image in (blank, depth[1]) if disturbed else ():
            with pytest.raises(ValueError, match="increment"):
                localizer.step(image, increment)
        states.append([localizer.step(image).state for image in depth[1:]])
    assert np.array_equal(*states)


def test_beyond_the_map_s_edge_images_carry_it_doubtful_and_back(renderer, rng):
    """It turns from what the map holds to what it does not, and back; its covariance grows meanwhile."""
    scene_map = furnished_room()
    left = scene_map.vertices[scene_map.faces].mean(axis=1)[:, 1] > 0.0
    turn = np.concatenate([np.linspace(0.6, -0.8, 8), np.full(2, -0.8), np.linspace(-0.8, 0.6, 8)])
    true = np.tile([-1.0, 0.5, -0.5, 0.0, 0.05, 0.0], (len(turn), 1))
    true[:, 5] = turn
    true[:, 0] += 0.3 * np.sin(3 * turn)
    depth = noisy(renderer.render(true), rng)
    with DepthRenderer(SceneMap(scene_map.vertices, scene_map.faces[left]), SMALL) as opened:
        estimates, blind = (run(opened, depth, true[0], image_motion=by_images) for by_images in (True, False))
    statuses, errors = [e.status for e in estimates], off(estimates, true)
    assert (errors < [0.15, 0.1]).all()
    assert "lost" not in statuses
    assert set(statuses[7:11]) == {"doubtful"}
    assert statuses[-1] == "tracked"
    sigma = np.array([np.sqrt(np.trace(e.error_covariance[:3, :3])) for e in estimates])
    assert sigma[10] > 2 * sigma[2]
    assert sigma[-1] < sigma[10]
    assert (errors[:, 0] < 4 * sigma).all()
    assert {e.status for e in blind[7:11]} == {"lost"}


def test_an_odometer_carries_the_first_frame_from_the_given_start_and_from_no_earlier_run(renderer):
    """The map does not hold the first image: nothing but the increment shows where the camera is."""
    scene_map = furnished_room()
    left = scene_map.vertices[scene_map.faces].mean(axis=1)[:, 1] > 0.0
    inside, edge = np.array([[-1.0, 0.5, -0.5, 0.0, 0.05, yaw] for yaw in (0.6, -0.8)])
    after = edge + np.array([0.1, 0, 0, 0, 0, -0.05])
    depth, increment = renderer.render([inside, after]), motion_between(edge, after)
    with DepthRenderer(SceneMap(scene_map.vertices, scene_map.faces[left]), SMALL) as opened:
        for earlier in (0, 1):
            localizer = AnnealedLocalizer(opened, seed=1)
            if earlier:
                localizer.initialize(inside)
                localizer.step(depth[0])
            localizer.initialize(edge)
            estimate = localizer.step(depth[1], increment)
            assert estimate.status == "doubtful"
            assert (off([estimate], after[None]) < 1e-6).all()


def test_before_a_bare_wall_it_soon_says_that_it_does_not_know_where(rng):
    """The covariance grows along the wall only; a pose that has slid on the map's roughness is not called tracked."""
    still = np.zeros((12, 6))
    with DepthRenderer(wall(0.9, 5.0), SMALL) as bare, DepthRenderer(rough_wall(rng), SMALL) as rough:
        depth = bare.render(still)
        sigma = np.sqrt([np.diag(e.error_covariance) for e in run(bare, depth, still[0])])
        estimates = run(rough, noisy(depth, rng), still[0])
    assert (sigma[:, 0] < 0.02).all()
    assert (np.diff(sigma[:, 1]) > 0).all()
    tracked = np.array([e.status == "tracked" for e in estimates])
    assert (off(estimates, still)[tracked, 0] < 0.1).all()
    assert {e.status for e in estimates[-4:]} == {"lost"}


def test_where_two_places_fit_alike_it_is_not_sure_of_either():
    """Before a fence, a step of half its pitch: on to the next post, or back?"""
    true = np.zeros((8, 6))
    true[:, 1] = 0.02 * np.arange(8)
    with DepthRenderer(fence(), SMALL) as opened:
        sure, unsure = (run(opened, opened.render(true), true[0], rivals=n) for n in (0, 1))
    along = [[np.sqrt(e.error_covariance[1, 1]) for e in estimates] for estimates in (sure, unsure)]
    assert max(along[0]) < 0.05, "without rivals it takes the nearest post for the only one"
    assert min(along[1]) > 0.2
    assert {e.status for e in unsure} == {"lost"}


def test_the_same_seed_gives_the_same_bytes(renderer):
    first, second, other = (
        np.array([e.state for e in run(renderer, renderer.render(walk(4)), seed=seed)]) for seed in (7, 7, 8)
    )
    assert first.tobytes() == second.tobytes()
    assert not np.array_equal(first, other)
