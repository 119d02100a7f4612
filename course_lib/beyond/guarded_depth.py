"""A filter that looks at each frame before it uses it, and says of every frame what became of it.

    localizer = GuardedLocalizer(MonteCarloLocalizer(renderer), period=0.1)
    localizer.initialize(state0)
    for depth, time in recording:
        frame = localizer.step(depth, time)       # frame.outcome, frame.estimate

A frame at fault is not weighed: the particles move as if nothing had been measured. After faults, as many good frames
must come before a pose is "tracked". Without faults the filter does exactly what it does without a guard.
"""

import warnings
from typing import Literal, NamedTuple, get_args

import numpy as np

from course_lib.beyond import being_lost
from course_lib.beyond.being_lost import Agreement, Debt, TrackStatus, agreement
from course_lib.beyond.guarded_frames import Fault, FrameCheck
from course_lib.beyond.six_dof.localizer import AnnealedEstimate, AnnealedLocalizer
from course_lib.depth_mcl.likelihood import checked_image
from course_lib.depth_mcl.localizer import Estimate, MonteCarloLocalizer, NoMeasurementWarning
from course_lib.depth_mcl.one_at_a_time import one_at_a_time

Outcome = TrackStatus | Fault | Literal["no image"]
# A frame was used (the first three), it never came, or it was not used.
OUTCOMES: tuple[Outcome, ...] = (*get_args(TrackStatus), "no image", *get_args(Fault))


class GuardedFrame(NamedTuple):
    """What became of a frame that arrived."""

    outcome: Outcome  # Only a "tracked" pose can be relied on.
    estimate: Estimate | AnnealedEstimate | None  # the latest; for a frame out of order, the previous one
    missed: tuple[Estimate | AnnealedEstimate, ...]  # one for every frame that should have come before ("no image")


class GuardedLocalizer:
    """A `MonteCarloLocalizer` or `AnnealedLocalizer` whose frames are looked at before they are used.

    period: seconds from frame to frame; None if unknown, then missing frames are not noticed.
    """

    def __init__(self, localizer: MonteCarloLocalizer | AnnealedLocalizer, period: float | None = None) -> None:
        self.localizer = localizer
        self._camera = localizer.renderer.camera
        self._period = period
        self._begin()

    @one_at_a_time
    def initialize(self, state0: np.ndarray) -> None:
        """Say where the camera is before the first frame, as the filter's own `initialize` does."""
        self.localizer.initialize(state0)
        self._begin()

    def _begin(self) -> None:
        self._check = FrameCheck(self._camera.near, self._camera.far, self._period)
        self._agreements: list[Agreement] = []
        self._last: Estimate | AnnealedEstimate | None = None
        self._debt = Debt()

    @one_at_a_time
    def step(self, depth: np.ndarray, time: float | None = None) -> GuardedFrame:
        """Return what becomes of a depth image `(H, W)` in metres (NaN = no measurement), taken at `time` (seconds)."""
        depth = checked_image(depth, self._camera)
        fault, n_missed = self._check.look(depth, time)
        missed = tuple(self._move() for _ in range(n_missed))
        if fault == "out of order":
            return GuardedFrame(fault, self._last, missed)
        if fault is not None:
            return GuardedFrame(fault, self._move(), missed)
        self._last = self.localizer.step(depth)
        return GuardedFrame(self._judged(depth), self._last, missed)

    def _move(self) -> Estimate | AnnealedEstimate:
        """Return the filter's estimate after a frame of which nothing is used."""
        self._debt.add()
        self._agreements.append(being_lost.NOTHING_MEASURED)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", NoMeasurementWarning)  # the outcome says it
            self._last = self.localizer.step(np.full(self._camera.shape, np.nan))
        return self._last

    def _judged(self, depth: np.ndarray) -> Outcome:
        """Return the outcome of a frame that was used: the annealed filter judges itself, the paper's is judged."""
        status = self._last.status
        if not isinstance(self.localizer, AnnealedLocalizer):
            renderer = self.localizer.renderer
            measured = renderer.render_points(self._camera.points(depth))
            self._agreements.append(agreement(measured, renderer.render(self._last.state)[0]))
            status = being_lost.judge_track(self._agreements)[-1]
            if status == "tracked" and not being_lost.is_known(self._last.error_covariance):
                return "doubtful"
        if status == "no measurement":  # all of it lies outside the camera's planes once it is projected
            return "no return"
        if status == "tracked" and not self._debt.is_paid(good=True):
            return "doubtful"
        return status
