"""What lesson 04 says about the time-of-flight camera's faults holds, one by one."""

import numpy as np
import pytest

from course_lib.lessons.lesson_04.time_of_flight import FAULTS, MODEL, capture
from course_lib.rendering.camera import DepthCamera

SMALL = DepthCamera.sr4000().resized(88, 72)


def errors(x: float, *faults: str, frequency: float = 15e6) -> np.ndarray:
    """Measured minus true depth [m] `(H, W)`, NaN where either is missing."""
    depth, true, _ = capture(x, set(faults), SMALL, frequency)
    return depth - np.where(np.isfinite(true), true, np.nan)


@pytest.mark.parametrize("fault", FAULTS)
def test_without_faults_the_camera_reads_the_truth_and_every_fault_alone_changes_it(fault):
    assert np.nanmax(np.abs(errors(0.0))) < 0.001
    assert not np.array_equal(errors(0.0), errors(0.0, fault), equal_nan=True)


def test_wrapping_spoils_the_end_wall_by_c_over_2f_until_the_camera_is_near_enough():
    off = errors(0.0, "wrapping")
    far, slant = np.abs(off) > 1, np.linalg.norm(SMALL.rays(), axis=-1)
    assert off[far] == pytest.approx(-MODEL.unambiguous_range / slant[far], abs=0.001)
    assert 0 < (np.abs(errors(2.05, "wrapping")) > 1).mean() < far.mean()
    assert np.nanmax(np.abs(errors(2.3, "wrapping"))) < 0.001


def test_drop_outs_cost_the_dark_door_and_half_the_wave_halves_the_noise():
    end_wall = np.abs(capture(0.0, set(), SMALL)[1] - 12.0) < 0.01
    assert 0.2 < np.isnan(errors(0.0, "drop_outs")[end_wall]).mean() < 0.8
    slow, fast = (np.nanmedian(np.abs(errors(0.0, "noise", frequency=f))) for f in (15e6, 30e6))
    assert fast == pytest.approx(slow / 2, rel=0.1)
