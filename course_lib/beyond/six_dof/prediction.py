"""Where the camera may be when the next image comes: as it has moved before, or as a measured motion says.

If nobody measured the motion, the last one goes on, in a cloud as wide as recent motions were long. An odometer or two
images (image_motion.py) measure it: most of the cloud lies there, as wide as its covariance, and a share goes on as
before, because a measured motion may be wrong. If another pose explained the last frame nearly as well, the cloud also
starts from this rival.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from course_lib.beyond.six_dof.poses import lengths, local, retract

# All chosen on the kitchen and the shipped corridor; those of rivals on walks through rooms, seeds 10,041 to 10,066.
MIN_SPREAD = np.array([0.015, np.deg2rad(1.0)])  # metres, radians: of a camera at rest
MAX_SPREAD = np.array([0.5, np.deg2rad(30.0)])
START_SPREAD = np.array([0.2, np.deg2rad(10.0)])  # of a start that was set by hand, before a motion was seen
SPREAD_OF_MOTION = 1.2  # spread of the cloud as a share of the longest of the last motions
SPREAD_OF_INCREMENT = 0.3  # the same share of an odometer's increment
FRAMES_REMEMBERED = 3
GUESSES_REMEMBERED = 6  # motions that tell how well the last one foretold the next
GOES_ON = (-0.25, 1.25)  # smallest and largest share of the last motion that the next one may repeat
HEAVY_TAIL = 0.5  # of the logarithm of each particle's own spread: most are near, a few are far
WIDER = 2.5  # the spread of a second look at a frame, as a share of the first look's
PRIOR_SHARE = 0.002  # what one unit of the prediction's log density is worth in score: it decides between equals
MEASURED_SHARE = 0.005  # the same of a measured motion: it decides between places that fit nearly as well
CARRIED = 0.7  # share of a rival's evidence that goes on to the next frame
UNMEASURED = 4  # every so many particles go on as before, although the motion was measured
FARTHEST = 25.0  # squared distance from a measured motion, in units of the spread, beyond which none is less likely
GROWTH = 1.5  # of the spread, for every frame in which the camera was not found


class Rival(NamedTuple):
    """Another pose that the camera may have."""

    pose: np.ndarray  # Camera-to-world `(4, 4)`.
    evidence: float  # Score of its image less the score of the best pose's image: 0 or less.


class MeasuredMotion(NamedTuple):
    """A motion since the frame before, as an odometer or two images tell it."""

    motion: np.ndarray  # `(6,)` metres, radians, along and about the optical axes of the frame before (`retract`).
    covariance: np.ndarray  # `(6, 6)` of the pose that it leads to, along and about that pose's axes.

    @classmethod
    def of_odometer(cls, increment: np.ndarray) -> "MeasuredMotion":
        """Return the motion of an increment `(6,)`; standard deviations: `SPREAD_OF_INCREMENT` of its lengths."""
        sigma = np.maximum(SPREAD_OF_INCREMENT * lengths(increment), MIN_SPREAD)
        return cls(increment, np.diag(np.repeat(sigma, 3) ** 2))


class MotionPrediction:
    """The camera's last pose (camera-to-world `(4, 4)`, optical), its motion, and how long the last motions were."""

    def __init__(self, pose: np.ndarray) -> None:
        self.pose = np.array(pose, dtype=np.float64)
        self.rivals: list[Rival] = []  # other poses of the last frame; half the cloud starts from them
        self.motion = np.zeros(6)
        self._started = self._not_found = False
        self._lengths: list[np.ndarray] = []
        self._surprises: list[np.ndarray] = []  # how far motions were from the motions before them

    def spread(self, measured: MeasuredMotion | None = None) -> np.ndarray:
        """Return standard deviations `(6,)` of the next pose about its prediction, metres and radians, camera axes."""
        least, most = np.repeat(MIN_SPREAD, 3), np.repeat(MAX_SPREAD, 3)
        if measured is not None:
            return np.clip(np.sqrt(np.diag(measured.covariance)), least, most)
        longest = START_SPREAD
        if self._lengths:
            longest = SPREAD_OF_MOTION * np.max(self._lengths[-FRAMES_REMEMBERED:], axis=0)
        return np.clip(np.repeat(longest, 3), least, most)

    def guess_spread(self) -> np.ndarray:
        """Return standard deviations `(6,)` of the next motion about the last one, as far as it has gone on so far."""
        if len(self._surprises) < GUESSES_REMEMBERED:
            return self.spread()
        off = np.repeat(np.max(self._surprises[-GUESSES_REMEMBERED:], axis=0), 3)
        return np.clip(off, np.repeat(MIN_SPREAD, 3), self.spread())

    def draw(
        self, n: int, spread: np.ndarray, rng: np.random.Generator, measured: MeasuredMotion | None = None
    ) -> np.ndarray:
        """Draw poses `(n, 4, 4)` where the camera may be now. If there are rivals, half of the poses start from them.

        The first two poses have no noise: one at rest, one going on; with a measured motion, both there. spread: `(6,)`
        """
        starts = np.tile(self.pose, (n, 1, 1))
        for k, rival in enumerate(self.rivals):
            starts[1 + 2 * k :: 2 * len(self.rivals)] = rival.pose
        shares = rng.uniform(*GOES_ON, n)
        noise = rng.standard_normal((n, 6)) * np.exp(HEAVY_TAIL * rng.standard_normal((n, 1)))
        shares[:2], noise[:2] = [0.0, 1.0][:n], 0.0
        motions, wide = shares[:, None] * self.motion, np.tile(spread, (n, 1))
        if measured is not None:
            # Of pairs, because every other pose may start from a rival.
            there = np.arange(n) // 2 % UNMEASURED < UNMEASURED - 1
            motions[there], wide[~there] = measured.motion, np.maximum(spread, self.spread())
        return retract(retract(starts, motions), wide * noise)

    def preference(self, poses: np.ndarray, spread: np.ndarray, measured: MeasuredMotion | None = None) -> np.ndarray:
        """Return what the prediction says of poses `(N, 4, 4)`, in units of the raw score: `(N,)`, at most 0.

        max_k PRIOR_SHARE (-d_k^2 / 2) + CARRIED evidence_k, over the last pose and its rivals k; d: distance from the
        nearest motion between rest and going on, in units of the spread. With a measured motion, d is the distance from
        it, d^2 <= `FARTHEST`, and MEASURED_SHARE stands for PRIOR_SHARE.
        """
        return np.max([preference for preference, _ in self._ways(poses, spread, measured)], axis=0)

    def origin(
        self, pose: np.ndarray, spread: np.ndarray, measured: MeasuredMotion | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return the pose that the camera came from if it is now at `pose`, and the pose predicted from there."""
        ways = self._ways(pose[None], spread, measured)
        likeliest = max(range(len(ways)), key=lambda k: ways[k][0][0])
        return self._last_poses()[likeliest].pose, ways[likeliest][1][0]

    def _last_poses(self) -> list[Rival]:
        return [Rival(self.pose, 0.0), *self.rivals]

    def _ways(
        self, poses: np.ndarray, spread: np.ndarray, measured: MeasuredMotion | None
    ) -> list[tuple[np.ndarray, np.ndarray]]:
        """Return for each last pose the preference `(N,)` for poses `(N, 4, 4)`, and the nearest predicted poses."""
        going_on = self.motion if measured is None else measured.motion
        ahead = going_on / spread
        ways = []
        for last, evidence in self._last_poses():
            motion = local(last, poses) / spread
            share = np.ones(len(poses))
            if measured is None:
                share = np.clip(motion @ ahead / max(ahead @ ahead, 1e-12), 0.0, 1.0)
            squares = np.sum((motion - share[:, None] * ahead) ** 2, axis=1)
            worth = PRIOR_SHARE
            if measured is not None:
                squares, worth = np.minimum(squares, FARTHEST), MEASURED_SHARE
            predicted = retract(np.tile(last, (len(poses), 1, 1)), share[:, None] * going_on)
            ways.append((-worth * squares / 2 + CARRIED * evidence, predicted))
        return ways

    def found(self, pose: np.ndarray, seen: bool = True, rivals: Sequence[Rival] = ()) -> None:
        """Tell that the camera is at `pose`. seen: False if the image leaves a direction open: no length is learned."""
        if self._started:
            before = min(self._last_poses(), key=lambda last: float(np.linalg.norm(local(last.pose, pose))))
            expected, self.motion = retract(before.pose, self.motion), local(before.pose, pose)
            if seen:
                self._lengths.append(lengths(self.motion))
                self._surprises.append(lengths(local(expected, pose)))
        self._started, self._not_found = True, False
        self.pose, self.rivals = np.array(pose, dtype=np.float64), list(rivals)

    def not_found(
        self, pose: np.ndarray, spread: np.ndarray, rivals: Sequence[Rival] = (), measured: MeasuredMotion | None = None
    ) -> None:
        """Tell that the camera may be at `pose`, at a rival, or where the measured motion led from its last pose.

        spread: `(6,)` of this cloud.
        """
        if measured is not None:
            self.pose = retract(self.pose, measured.motion)
        self._started = self._not_found = True
        self.motion = np.zeros(6) if measured is None else measured.motion
        self.rivals = [Rival(np.array(pose, dtype=np.float64), 0.0), *rivals]
        self._lengths, self._surprises = [spread[[0, 3]] * GROWTH / SPREAD_OF_MOTION], []
