"""A filter that looks at each frame before it uses it, and says of every frame what became of it.

    localizer = WatchedLocalizer(MonteCarloLocalizer(renderer), period=0.1)
    localizer.initialize(state0)
    for depth, time in recording:
        watched = localizer.step(depth, time)       # watched.outcome, watched.estimate

A frame that the check finds at fault (frame_check.py) is not weighed: the filter moves its particles as if nothing had
been measured, so that the cloud grows while the camera goes on unseen; a frame that came out of order does not even
move them. For frames that never came it is moved once each. Where no frame is at fault, the filter does exactly what it
does without being watched.

After faults a pose is "tracked" only once it has been confirmed: as many good frames as there were faults, at most
`CONFIRMED` of them, and a covariance as narrow as that of a pose that is known (annealed/certainty.py).
"""

from __future__ import annotations

import warnings
from typing import Literal, NamedTuple

import numpy as np

from course_lib.beyond.frame_check import Fault, FrameCheck
from course_lib.beyond.six_dof.certainty import CONFIRMED, KNOWN
from course_lib.beyond.six_dof.covariance import sigmas
from course_lib.beyond.six_dof.localizer import AnnealedEstimate, AnnealedLocalizer
from course_lib.beyond.tracking import Agreement, TrackStatus, agreement, judge_track
from course_lib.depth_mcl.likelihood import DepthImageError
from course_lib.depth_mcl.localizer import Estimate, MonteCarloLocalizer, NoMeasurementWarning

Outcome = TrackStatus | Fault | Literal["no image"]
OUTCOMES: tuple[Outcome, ...] = (
    "tracked", "doubtful", "lost",
    "no image", "out of order", "repeated", "no return", "saturated", "noise",
    "half covered", "few returns", "exposure jump",
)  # fmt: skip
"""What becomes of a frame: used, and the pose is one of the first three; never came; came and was not used."""


class Watched(NamedTuple):
    """What became of a frame that arrived."""

    outcome: Outcome
    """Only a "tracked" pose is one to go by."""
    estimate: Estimate | AnnealedEstimate | None
    """Of the filter; after a frame out of order the one before (None where there is none)."""
    missed: tuple[Estimate | AnnealedEstimate, ...]
    """One for every frame that should have come before this one: where the camera may have been, "no image"."""


class WatchedLocalizer:
    """`MonteCarloLocalizer` or `AnnealedLocalizer`, watched. period: seconds from frame to frame; None: unknown."""

    def __init__(self, localizer: MonteCarloLocalizer | AnnealedLocalizer, period: float | None = None) -> None:
        self.localizer = localizer
        self._period = period
        self._judges_itself = isinstance(localizer, AnnealedLocalizer)
        self._begin()

    def initialize(self, state0: np.ndarray) -> None:
        """Says where the camera is before the first frame, as the filter's own `initialize` does."""
        self.localizer.initialize(state0)
        self._begin()

    def step(self, depth: np.ndarray, time: float | None = None) -> Watched:
        """What a depth image `(H, W)` in metres (NaN = no measurement), taken at `time` (seconds), says of the pose.

        Raises `DepthImageError` for an image of another size, `ValueError` for a time that is not finite.
        """
        depth = np.asarray(depth)
        if depth.shape != self.localizer.renderer.camera.shape:
            raise DepthImageError(
                f"the depth image has shape {depth.shape}; the camera gives {self.localizer.renderer.camera.shape} "
                "(height, width)"
            )
        seen = self._check.look(depth, time)
        missed = tuple(self._move() for _ in range(seen.missed))
        if seen.fault == "out of order":
            return Watched(seen.fault, self._last, missed)
        if seen.fault is not None:
            return Watched(seen.fault, self._move(), missed)
        self._last = self.localizer.step(depth)
        return Watched(self._judged(depth), self._last, missed)

    def _begin(self) -> None:
        camera = self.localizer.renderer.camera
        self._check = FrameCheck(camera.near, camera.far, self._period)
        self._agreements: list[Agreement] = []
        self._last: Estimate | AnnealedEstimate | None = None
        self._owed = 0

    def _move(self) -> Estimate | AnnealedEstimate:
        """The filter after a frame of which nothing is used."""
        self._owed = min(self._owed + 1, CONFIRMED)
        self._agreements.append(Agreement(0, np.nan, np.nan, np.nan))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", NoMeasurementWarning)  # it is told by name
            self._last = self.localizer.step(np.full(self.localizer.renderer.camera.shape, np.nan))
        return self._last

    def _judged(self, depth: np.ndarray) -> Outcome:
        """What the pose of a frame that was used is."""
        status = self._last.status if self._judges_itself else self._judged_by_track(depth)
        if status == "no measurement":  # all of it lies outside the camera's planes once it is projected
            return "no return"
        if status == "tracked" and self._owed:
            self._owed -= 1
            if self._owed:
                return "doubtful"
        return status

    def _judged_by_track(self, depth: np.ndarray) -> TrackStatus:
        renderer = self.localizer.renderer
        measured = renderer.render_points(renderer.camera.points(depth))
        self._agreements.append(agreement(measured, renderer.render(self._last.state)[0]))
        status = judge_track(self._agreements)[-1]
        unknown = (sigmas(self._last.error_covariance) > KNOWN).any()
        return "doubtful" if status == "tracked" and unknown else status
