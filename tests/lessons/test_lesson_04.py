"""What lesson 04 says about the time-of-flight camera's faults holds."""

import numpy as np
import pytest

from course_lib.rendering.camera import DepthCamera
from courseware.lessons.lesson_04.time_of_flight import FAULTS, MODEL, capture

SMALL = DepthCamera.sr4000().resized(88, 72)


def errors(x: float, *faults: str) -> np.ndarray:
    """Measured minus true depth [m] `(H, W)`, NaN where either is missing."""
    depth, true, _ = capture(x, set(faults), SMALL)
    return depth - np.where(np.isfinite(true), true, np.nan)


def test_without_faults_the_camera_reads_the_truth_and_every_fault_alone_changes_it():
    assert np.nanmax(np.abs(errors(0.0))) < 0.001
    assert not any(np.array_equal(errors(0.0), errors(0.0, fault), equal_nan=True) for fault in FAULTS)


def test_wrapping_spoils_the_end_wall_by_c_over_2f_until_the_camera_is_near_enough():
    off = errors(0.0, "wrapping")
    far, slant = np.abs(off) > 1, np.linalg.norm(SMALL.rays(), axis=-1)
    assert off[far] == pytest.approx(-MODEL.unambiguous_range / slant[far], abs=0.001)
    assert np.nanmax(np.abs(errors(2.3, "wrapping"))) < 0.001
