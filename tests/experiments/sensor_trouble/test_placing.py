"""Which frames are troubled: as many as asked, never touching, the same for the same seed."""

from itertools import pairwise

import numpy as np
import pytest
from course_lib.experiments.sensor_trouble.placing import (
    LEFT_AT_THE_END,
    generator,
    require_fits,
    troubled_frames,
    troubled_runs,
)


@pytest.mark.parametrize("share", [0.01, 0.05, 0.2])
@pytest.mark.parametrize(("n", "length"), [(100, 1), (100, 10), (304, 1), (304, 10)])
def test_stretches_make_up_the_share_and_do_not_touch(share, n, length):
    for seed in range(20):
        runs = troubled_runs(n, share, length, np.random.default_rng(seed))
        assert len(runs) == max(1, round(share * n / length))
        assert all(end - first == length for first, end in runs)
        assert all(first > before_end for (_, before_end), (first, _) in pairwise(runs))
        assert runs[0][0] >= 1
        assert runs[-1][1] <= n - LEFT_AT_THE_END
        assert troubled_frames(runs, n).sum() == len(runs) * length


def test_every_frame_between_first_and_last_is_troubled_sometimes():
    hits = sum(troubled_frames(troubled_runs(24, 0.1, 1, np.random.default_rng(s)), 24).astype(int) for s in range(400))
    assert (hits[1 : 24 - LEFT_AT_THE_END] > 10).all()
    assert hits[0] == 0
    assert hits[24 - LEFT_AT_THE_END :].sum() == 0


def test_the_same_seed_has_the_same_places_and_each_trouble_its_own():
    def places(seed, name):
        return troubled_runs(304, 0.05, 1, generator(seed, name, 0.05))

    assert places(3, "black") == places(3, "black")
    assert places(3, "black") != places(3, "dropped")
    assert places(3, "black") != places(4, "black")


@pytest.mark.parametrize(("n", "share", "length"), [(20, 0.2, 10), (10, 0.2, 1), (100, 0.0, 1), (100, 0.2, 0)])
def test_what_does_not_fit_is_told_before_anything_is_run(n, share, length):
    with pytest.raises((ValueError, ZeroDivisionError)):
        troubled_runs(n, share, length, np.random.default_rng(0))


def test_the_longest_trouble_is_asked_for_too():
    require_fits(100, [0.01, 0.2], [1, 10])
    with pytest.raises(ValueError, match="take a longer recording or a smaller share"):
        require_fits(22, [0.01], [1, 10])
