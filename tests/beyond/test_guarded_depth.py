"""A guarded filter: exactly the filter where nothing is wrong; where something is, it says so and comes back."""

import numpy as np
import pytest

from course_lib.beyond.guarded_depth import OUTCOMES, GuardedLocalizer
from course_lib.beyond.six_dof.localizer import AnnealedLocalizer
from course_lib.depth_mcl.localizer import MonteCarloLocalizer
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


def test_after_long_trouble_one_good_frame_is_no_proof(renderer, walk):
    frames = timed(walk[1])
    frames[10:16] = [(np.full(SMALL.shape, np.nan), time) for _, time in frames[10:16]]
    outcomes = [one.outcome for one in run(renderer, "annealed", frames)]
    assert "tracked" not in outcomes[10:18]
    assert outcomes[-1] == "tracked"
