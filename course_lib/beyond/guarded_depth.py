"""Look at each frame before a filter uses it, and say of every frame whether it was used, and why not.

    localizer = GuardedLocalizer(RecoveringLocalizer(renderer), period=0.1)     # watching, odometry, gravity, recovery
    localizer.initialize(state0)
    for depth, time, increment, gravity in recording:
        frame = localizer.step(depth, time, increment, gravity)       # frame.outcome, frame.estimate, frame.recovery

A frame at fault is not weighed: the particles move as if nothing had been measured, or as the odometer says. After
faults, as many good frames must come before a pose is "tracked". Without faults the filter does exactly what it does
without a guard.
"""

import warnings
from typing import Literal, NamedTuple, get_args

import numpy as np

from course_lib.beyond.being_lost import Debt
from course_lib.beyond.guarded_frames import Fault, FrameCheck
from course_lib.beyond.lost_and_found.recovery import RecoveringLocalizer, RecoveryEstimate
from course_lib.beyond.six_dof.localizer import AnnealedEstimate, AnnealedLocalizer
from course_lib.beyond.six_dof.poses import local, optical_increment, retract
from course_lib.depth_mcl.likelihood import checked_image
from course_lib.depth_mcl.localizer import Estimate, MonteCarloLocalizer, NoMeasurementWarning
from course_lib.depth_mcl.one_at_a_time import one_at_a_time
from course_lib.depth_mcl.status import TrackStatus

USED = ("tracked", "doubtful", "lost")
Outcome = Literal["tracked", "doubtful", "lost", "no image"] | Fault
# A frame was used (the first three), it never came, or it was not used.
OUTCOMES: tuple[Outcome, ...] = (*USED, "no image", *get_args(Fault))


def status_of(outcome: Outcome) -> TrackStatus:
    """Return the status of a pose with this outcome: that of a frame that was used, else "no measurement"."""
    return outcome if outcome in USED else "no measurement"


class GuardedFrame(NamedTuple):
    """The result of a frame that arrived."""

    outcome: Outcome  # its status, or why it was not used; only a "tracked" pose can be relied on
    estimate: Estimate | AnnealedEstimate | None  # the latest; for a frame out of order, the previous one
    missed: tuple[Estimate | AnnealedEstimate, ...]  # one for every frame that should have come before ("no image")
    recovery: RecoveryEstimate | None = None  # the state of a `RecoveringLocalizer`'s search; else None


class GuardedLocalizer:
    """Look at each frame before a localizer uses it. The command `localize` and the experiments use this watch, too.

    localizer: a `MonteCarloLocalizer`, an `AnnealedLocalizer` (takes an odometer's increment), or a
    `RecoveringLocalizer` (takes gravity too). period: seconds from frame to frame; None if unknown, then missing frames
    are not noticed.
    """

    def __init__(
        self,
        localizer: MonteCarloLocalizer | AnnealedLocalizer | RecoveringLocalizer,
        period: float | None = None,
    ) -> None:
        self.localizer = localizer
        self.takes = localizer.takes | {"time"}  # what `step` can use in addition to the image
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
        self._last: Estimate | AnnealedEstimate | None = None
        self._recovery: RecoveryEstimate | None = None
        self._increments: list[np.ndarray | None] = []  # those of frames out of order, and of this one
        self._debt = Debt()

    @one_at_a_time
    def step(
        self,
        depth: np.ndarray,
        time: float | None = None,
        increment: np.ndarray | None = None,
        gravity: np.ndarray | None = None,
    ) -> GuardedFrame:
        """Return the result of a depth image `(H, W)` in metres (NaN = no measurement), taken at `time` (seconds).

        increment: motion `(6,)` since the last call, whatever became of that frame, as in `AnnealedLocalizer.step`.
        gravity: as in `RecoveringLocalizer.step`. Raises `ValueError` for one of them that the localizer does not use.
        """
        depth = checked_image(depth, self._camera)
        self._require_used(increment=increment, gravity=gravity)
        if increment is not None:
            optical_increment(increment)  # refused here, before anything changes
        fault, n_missed = self._check.look(depth, time)
        missed = tuple(self._move() for _ in range(n_missed))
        self._increments.append(increment)
        if fault == "out of order":
            return GuardedFrame(fault, self._last, missed, self._recovery)
        known = {"increment": _joined(self._increments), "gravity": gravity}
        self._increments = []
        if fault is not None:
            return GuardedFrame(fault, self._move(**known), missed, self._recovery)
        self._advance(depth, **known)
        outcome = self._judged()
        return GuardedFrame(outcome, self._last, missed, self._recovery)

    def _require_used(self, **given: np.ndarray | None) -> None:
        """Raise `ValueError` if something was given that the localizer does not take."""
        able = {"increment": "an AnnealedLocalizer or a RecoveringLocalizer", "gravity": "a RecoveringLocalizer"}
        for name, value in given.items():
            if value is not None and name not in self.takes:
                raise ValueError(f"{type(self.localizer).__name__} uses no {name}. Leave it out, or guard {able[name]}")

    def _advance(self, depth: np.ndarray, **known: np.ndarray | None) -> None:
        """Give the filter an image `(H, W)` and what else is known, and keep its estimate."""
        found = self.localizer.step(depth, **{name: value for name, value in known.items() if value is not None})
        self._recovery = found if isinstance(found, RecoveryEstimate) else None
        self._last = found if self._recovery is None else found.estimate

    def _move(self, **known: np.ndarray | None) -> Estimate | AnnealedEstimate:
        """Return the filter's estimate after a frame whose image is not used."""
        self._debt.add()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", NoMeasurementWarning)  # the outcome says it
            self._advance(np.full(self._camera.shape, np.nan), **known)
        return self._last

    def _judged(self) -> Outcome:
        """Return the outcome of a frame that was used: its status, doubtful while good frames are owed."""
        if self._last.status == "no measurement":  # all of it lies outside the camera's planes once it is projected
            return "no return"
        if self._last.status == "tracked" and not self._debt.is_paid(good=True):
            self._last = self._last._replace(status="doubtful")
        return self._last.status


def _joined(increments: list[np.ndarray | None]) -> np.ndarray | None:
    """Return one increment `(6,)` for several in a row; None if one of them is unknown."""
    if any(one is None for one in increments):
        return None
    if len(increments) == 1:
        return increments[0]
    pose = np.eye(4)
    for one in increments:
        pose = retract(pose, one)
    return local(np.eye(4), pose)
