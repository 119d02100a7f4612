"""Each trouble of a pair of panoramas does what its name says, to the pairs that were drawn and to no other."""

import numpy as np
import pytest
from course_lib.experiments.sensor_trouble.panoramas import STOPS, TROUBLES, troubled_walk
from course_lib.experiments.sensor_trouble.placing import troubled_frames

N = 40


@pytest.fixture(scope="module")
def pairs():
    images = np.random.default_rng(1).integers(20, 250, (N, 2, 8, 16, 3), dtype=np.uint8)
    return [(upper, lower) for upper, lower in images]


def bad_pairs(trouble, pairs):
    came, runs = troubled_walk(trouble, pairs, 0.2, np.random.default_rng(2))
    return [(k, came[k].image, came[k - 1].image) for k in np.flatnonzero(troubled_frames(runs, N))]


@pytest.mark.parametrize("trouble", TROUBLES)
def test_pairs_that_were_not_drawn_are_the_same_arrays_and_a_seed_makes_the_same_bytes(pairs, trouble):
    def made(seed):
        return troubled_walk(trouble, pairs, 0.2, np.random.default_rng(seed))

    came, runs = made(2)
    for k in np.flatnonzero(~troubled_frames(runs, N)):
        assert came[k].image is pairs[k]
        assert came[k].time == k

    def told(made):
        return made[1], [
            None if one.image is None else (one.image[0].tobytes(), one.image[1].tobytes()) for one in made[0]
        ]

    assert told(made(2)) == told((came, runs))
    assert told(made(3)) != told((came, runs))


def test_a_dark_camera_shows_noise_and_the_other_what_it_saw(pairs):
    which = set()
    for k, (upper, lower), _ in bad_pairs("one camera dark", pairs):
        dark, other, at = (upper, lower, 0) if upper.mean() < 10 else (lower, upper, 1)
        assert np.median(dark) <= 4
        assert other is pairs[k][1 - at]
        which.add(at)
    assert which == {0, 1}


def test_exchanged_cameras_are_exchanged(pairs):
    assert all(u is pairs[k][1] and lo is pairs[k][0] for k, (u, lo), _ in bad_pairs("cameras exchanged", pairs))


def test_the_lower_image_is_of_the_moment_before(pairs):
    assert all(u is pairs[k][0] and lo is pairs[k - 1][1] for k, (u, lo), _ in bad_pairs("different moments", pairs))


def test_a_repeated_pair_is_the_pair_before(pairs):
    for _, came, before in bad_pairs("repeated", pairs):
        assert np.array_equal(came[0], before[0])
        assert np.array_equal(came[1], before[1])


def test_a_dropped_pair_does_not_come(pairs):
    assert all(came is None for _, came, _ in bad_pairs("dropped", pairs))


def test_an_exposure_that_jumps_multiplies_one_image_and_clips_it(pairs):
    factors = set()
    for k, came, _ in bad_pairs("exposure jump", pairs):
        changed = [i for i in (0, 1) if came[i] is not pairs[k][i]]
        assert len(changed) == 1
        image, good = came[changed[0]], pairs[k][changed[0]].astype(float)
        factor = 2**STOPS if image.mean() > good.mean() else 2**-STOPS
        assert np.array_equal(image, np.clip(np.rint(good * factor), 0, 255))
        factors.add((changed[0], factor))
    assert len(factors) >= 3
