"""A guarded filter: exactly the filter where nothing is wrong; where something is, it says so and comes back."""

import pickle
import sys

import numpy as np
import pytest

from course_lib.beyond.guarded_depth import OUTCOMES, GuardedLocalizer, status_of
from course_lib.beyond.lost_and_found.recovery import RecoveringLocalizer
from course_lib.beyond.six_dof.localizer import AnnealedLocalizer
from course_lib.beyond.six_dof.poses import motion_between
from course_lib.depth_mcl.likelihood import ALPHA, compiled_likelihood, likelihood
from course_lib.depth_mcl.localizer import MonteCarloLocalizer
from course_lib.geometry import optical_pose
from tests.rendering.shapes import SMALL

START = np.array([-1.0, 0.3, -0.3, 0.0, 0.0, -0.4])
SIGMA = [0.06, 0.06, 0, 0, 0, 0.04]
PERIOD = 0.1


@pytest.fixture(scope="module")
def walk(renderer):
    true = START + np.arange(1, 31)[:, None] * [0.04, 0, 0, 0, 0, 0.02]
    noise = 0.01 * np.random.default_rng(5).standard_normal((30, *SMALL.shape))
    return true, (renderer.render(true) + noise).astype(np.float32)


def filters(renderer):
    return {
        "paper": MonteCarloLocalizer(renderer, 150, SIGMA, seed=1),
        "annealed": AnnealedLocalizer(renderer, 100, seed=1),
    }


def run(renderer, kind, frames):
    guarded = GuardedLocalizer(filters(renderer)[kind], PERIOD)
    guarded.initialize(START)
    return [guarded.step(image, time) for image, time in frames]


def timed(images):
    return [(image, PERIOD * k) for k, image in enumerate(images)]


@pytest.mark.parametrize("kind", ["paper", "annealed"])
def test_where_nothing_is_wrong_it_is_the_filter_to_the_last_bit(renderer, walk, kind):
    images = walk[1]
    alone = filters(renderer)[kind]
    alone.initialize(START)
    plain = [alone.step(image) for image in images[:12]]
    seen = run(renderer, kind, timed(images[:12]))
    for one, other in zip(seen, plain, strict=True):
        assert np.array_equal(one.estimate.state, other.state)
        assert np.array_equal(one.estimate.particles, other.particles)
        assert np.array_equal(one.estimate.error_covariance, other.error_covariance)
    assert [one.outcome for one in seen] == ["tracked"] * 12


@pytest.mark.parametrize("kind", ["paper", "annealed"])
@pytest.mark.parametrize(
    ("trouble", "outcome"),
    [("black", "no return"), ("old", "repeated"), ("stop", "saturated"), ("noise", "noise"), ("half", "half covered")],
)
def test_every_trouble_is_named_and_it_comes_back(renderer, walk, rng, kind, trouble, outcome):
    true, images = walk
    frames = timed(images)
    for k in (10, 11, 12):
        bad = {
            "black": np.full(SMALL.shape, np.nan),
            "old": images[9],
            "stop": np.full(SMALL.shape, 9.99),
            "noise": rng.uniform(0.5, 9.0, SMALL.shape),
            "half": np.where(np.arange(SMALL.width) < 32, np.nan, images[k]),
        }[trouble]
        frames[k] = bad.astype(np.float32), PERIOD * k
    seen = run(renderer, kind, frames)
    assert [one.outcome for one in seen[10:13]] == [outcome] * 3
    assert {one.outcome for one in seen} <= set(OUTCOMES)
    errors = np.linalg.norm([one.estimate.state[:3] - state[:3] for one, state in zip(seen, true, strict=True)], axis=1)
    assert errors[23:].max() < 0.1, "ten good frames later it is where it was"
    assert seen[-1].outcome == "tracked"
    assert errors[[one.outcome == "tracked" for one in seen]].max() < 0.3


def test_a_frame_at_fault_or_missed_moves_the_particles_as_no_measurement_does_one_out_of_order_not(renderer, walk):
    images = walk[1]
    plain = filters(renderer)["paper"]
    plain.initialize(START)
    for image in images[:5]:
        plain.step(image)
    with pytest.warns(UserWarning, match="no measurement"):
        expected = [plain.step(np.full(SMALL.shape, np.nan)) for _ in range(3)]
    repeated = run(renderer, "paper", [*timed(images[:5]), (images[4], 0.5)])[-1]
    assert (repeated.outcome, repeated.estimate.status) == ("repeated", "no measurement")
    assert np.array_equal(repeated.estimate.particles, expected[0].particles)
    *before, after_gap = run(renderer, "paper", [*timed(images[:5]), (images[8], 0.8)])
    assert [len(one.missed) for one in before] == [0] * 5
    for missed, other in zip(after_gap.missed, expected, strict=True):
        assert np.array_equal(missed.particles, other.particles)
    seen = run(renderer, "paper", [*timed(images[:5]), (images[5], 0.2), (images[6], 0.5)])
    assert seen[5].outcome == "out of order"
    assert seen[5].estimate is seen[4].estimate
    undisturbed = run(renderer, "paper", [*timed(images[:5]), (images[6], 0.5)])
    assert np.array_equal(seen[6].estimate.state, undisturbed[5].estimate.state)


def test_another_alpha_shifts_no_status(renderer, monkeypatch):
    """Images 0.15 m behind the map are wrong, whatever eq. (8)'s alpha and its default are."""
    still = renderer.render(START)[0]
    images = [(still + 0.001 * k + 0.15 * (k >= 3)).astype(np.float32) for k in range(6)]

    def outcomes(alpha):
        guarded = GuardedLocalizer(MonteCarloLocalizer(renderer, 5, [1e-6, 1e-6, 0, 0, 0, 1e-6], alpha))
        guarded.initialize(START)
        return [guarded.step(image).outcome for image in images]

    usual = outcomes(ALPHA)
    assert usual == ["tracked"] * 3 + ["lost"] * 3
    for function in (likelihood, compiled_likelihood):
        monkeypatch.setattr(function, "__defaults__", (0.3,))
    for module in [one for name, one in sys.modules.items() if name.startswith("course_lib") and hasattr(one, "ALPHA")]:
        monkeypatch.setattr(module, "ALPHA", 0.3)
    assert outcomes(0.3) == usual


def test_after_long_trouble_one_good_frame_is_no_proof(renderer, walk):
    frames = timed(walk[1])
    frames[10:16] = [(np.full(SMALL.shape, np.nan), time) for _, time in frames[10:16]]
    seen = run(renderer, "annealed", frames)
    outcomes = [one.outcome for one in seen]
    assert [one.estimate.status for one in seen] == [status_of(one) for one in outcomes], "one word, wherever one looks"
    assert "tracked" not in outcomes[10:18]
    assert outcomes[-1] == "tracked"


def down(state):
    return -optical_pose(state)[2, :3]


@pytest.mark.parametrize("make", [AnnealedLocalizer, RecoveringLocalizer])
def test_an_odometer_carries_it_through_every_trouble(renderer, walk, make):
    """Black frames, one that never came and one that is late: the motion told with each of them counts once."""
    true = walk[0].copy()
    true[5:] += np.arange(1, 26)[:, None] * [-0.02, 0.05, 0, 0, 0, 0.06]  # a turn that no last motion foretells
    images = [renderer.render(state)[0] for state in true]
    frames = [(k, images[k], PERIOD * k) for k in range(13)]
    for k in (5, 6, 7, 11):
        frames[k] = k, np.full(SMALL.shape, np.nan), PERIOD * k
    del frames[9]
    frames[9] = 10, images[10], 0.2  # its clock is behind
    localizer, before, seen = GuardedLocalizer(make(renderer, 100, seed=1), PERIOD), START, {}
    localizer.initialize(START)
    for k, image, time in frames:
        seen[k] = localizer.step(image, time, increment=motion_between(before, true[k]), gravity=None)
        before = true[k]
    assert [seen[k].outcome for k in (5, 6, 7, 10, 11)] == ["no return"] * 3 + ["out of order", "no return"]
    assert len(seen[11].missed) == 2
    for k in (5, 6, 7, 11):
        assert seen[k].estimate.state == pytest.approx(true[k], abs=0.03), "the odometer alone"
    assert seen[12].estimate.state == pytest.approx(true[12], abs=0.03)


def test_a_part_that_the_filter_does_not_use_is_refused_before_anything_changes(renderer, walk):
    paper, annealed = (GuardedLocalizer(one, PERIOD) for one in filters(renderer).values())
    for guarded in (paper, annealed):
        guarded.initialize(START)
    with pytest.raises(ValueError, match=r"MonteCarloLocalizer uses no increment.*AnnealedLocalizer"):
        paper.step(walk[1][0], 0.0, increment=np.zeros(6))
    with pytest.raises(ValueError, match=r"AnnealedLocalizer uses no gravity.*RecoveringLocalizer"):
        annealed.step(walk[1][0], 0.0, gravity=down(START))
    with pytest.raises(ValueError, match="increment must be finite"):
        annealed.step(walk[1][0], 0.0, increment=np.full(6, np.nan))
    assert annealed.step(walk[1][0], 0.0).outcome == "tracked", "the refused frame was not taken for the first one"


@pytest.mark.slow
def test_watching_odometry_gravity_and_recovery_in_one_object_also_from_a_pickle(renderer, walk):
    """Followed, carried away while the driver repeats its last image, found elsewhere; a frame of noise on the way."""
    localizer = GuardedLocalizer(RecoveringLocalizer(renderer, 100, seed=1, max_places=1_000), PERIOD)
    localizer.initialize(START)
    elsewhere = np.array([-1.5, -1.5, 0.5, 0.1, 0.3, 0.8]) + np.arange(9)[:, None] * [0.03, 0.02, 0.01, 0, 0, 0.02]
    true = np.concatenate([walk[0][:6], np.repeat(walk[0][5:6], 4, axis=0), elsewhere])
    images = renderer.render(true)
    images[12] = np.random.default_rng(1).uniform(0.5, 6.0, SMALL.shape)
    seen, before, copy = [], START, None
    for k, (state, image) in enumerate(zip(true, images, strict=True)):
        wheels = np.zeros(6) if k >= 6 else motion_between(before, state)  # they stand while it is carried
        told, before = {"time": PERIOD * k, "increment": wheels, "gravity": down(state)}, state
        seen.append(localizer.step(image, **told))
        if copy is not None:
            assert np.array_equal(copy.step(image, **told).estimate.state, seen[-1].estimate.state)
        if k == 11:
            copy = pickle.loads(pickle.dumps(localizer))
    assert [one.outcome for one in seen[3:10]] == ["tracked"] * 3 + ["repeated"] * 4
    assert seen[12].outcome == "noise"
    modes = [one.recovery.mode for one in seen]
    assert modes[:6] == ["following"] * 6
    assert modes[10] == "searching"
    assert "found again" in modes[11:]
    assert seen[-1].outcome == "tracked"
    assert seen[-1].estimate.state[:3] == pytest.approx(true[-1][:3], abs=0.03)
    off = np.linalg.norm([one.estimate.state[:3] - state[:3] for one, state in zip(seen, true, strict=True)], axis=1)
    assert not [k for k in range(len(seen)) if seen[k].outcome == "tracked" and off[k] > 0.1]
