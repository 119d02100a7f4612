"""The recording carried by hand, every fourth frame of it, and what filters make of it."""

import functools
from typing import NamedTuple

import numpy as np

from course_lib.beyond import AnnealedLocalizer
from course_lib.beyond.six_dof.localizer import AnnealedEstimate
from course_lib.depth_mcl import MonteCarloLocalizer
from course_lib.depth_mcl.evaluation import pose_errors
from course_lib.depth_mcl.localizer import Estimate
from course_lib.depth_mcl.motion import TANGENT_SPACE
from course_lib.depth_mcl.sequence import DepthSequence, read_sequence
from course_lib.geometry import optical_pose, state_from_optical_pose
from course_lib.lessons.kit.progress_bar import progress
from course_lib.paths import data_path

FRAMES = list(range(0, 60, 4))  # every fourth: the camera moves four times as far between two images
SEED = 10_001  # a tuning seed: what is reported comes from stored results


@functools.cache
def hand_run() -> DepthSequence:
    """The recording of the camera carried by hand."""
    return read_sequence(data_path("corridor/hand"))


class Track(NamedTuple):
    """What a filter made of some frames."""

    estimates: list[Estimate] | list[AnnealedEstimate]
    position: np.ndarray
    """`(T,)` error [m]."""
    rotation: np.ndarray
    """`(T,)` error [degrees]."""
    deviations: np.ndarray
    """`(T, 6)` the true states from the estimates: metres along the world's axes, radians about the body's."""

    @property
    def error_sigmas(self) -> np.ndarray:
        """`(T, 6)` how far off the filter expects to be in each component, one sigma."""
        return np.sqrt([np.diag(estimate.error_covariance) for estimate in self.estimates])

    @property
    def beyond_three_sigma(self) -> int:
        """How many of the `6 T` errors are greater than the filter's three sigma."""
        return int(np.sum(np.abs(self.deviations) > 3 * self.error_sigmas))

    @property
    def statuses(self) -> list[str]:
        """What the filter says of itself, frame by frame."""
        return [estimate.status for estimate in self.estimates]


def localize(
    localizer: MonteCarloLocalizer | AnnealedLocalizer,
    frames: list[int],
    name: str,
    start: np.ndarray | None = None,
) -> Track:
    """A filter over frames of the recording, from the first frame's true state (or from `start`), with its errors."""
    sequence = hand_run()
    true = sequence.camera_to_world[frames]
    localizer.initialize(state_from_optical_pose(true[0]) if start is None else start)
    estimates = [localizer.step(sequence.depth(frame)) for frame in progress(frames, name)]
    states = np.array([estimate.state for estimate in estimates])
    position, rotation = pose_errors(optical_pose(states), true)
    deviations = [
        TANGENT_SPACE.deviations(t[None], s)[0] for t, s in zip(state_from_optical_pose(true), states, strict=True)
    ]
    return Track(estimates, position, np.rad2deg(rotation), np.array(deviations))
