"""Predict where the camera may be at the next image, from its last motions or from a measured motion.

Without a measured motion, the last motion is repeated, in a cloud that is as wide as recent motions were long. An
odometer or two images (image_motion.py) may measure the motion. Then most of the cloud lies there, as wide as the
motion's covariance, and a share repeats the last motion, because a measured motion may be wrong. If another pose
explained the last frame nearly as well, the cloud starts from this rival, too.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from course_lib.beyond.six_dof.poses import lengths, local, retract

# Chosen on the kitchen and the shipped corridor; those of rivals on walks through rooms, seeds 10,041 to 10,066.
MIN_SPREAD = np.array([0.015, np.deg2rad(1.0)])  # metres, radians: of a camera at rest
MAX_SPREAD = np.array([0.5, np.deg2rad(30.0)])  # metres, radians: no cloud is wider
START_SPREAD = np.array([0.2, np.deg2rad(10.0)])  # metres, radians: the error of a start that was set by hand
SPREAD_OF_MOTION = 1.2  # of the longest recent motion: the next one may be longer
SPREAD_OF_INCREMENT = 0.3  # of an odometer's increment: standard deviation of its error
FRAMES_REMEMBERED = 3  # recent motions, the longest of which sets the spread
GUESSES_REMEMBERED = 6  # recent motions that show how well each one predicted the next
GOES_ON = (-0.25, 1.25)  # smallest and largest share of the last motion that the next one may repeat
HEAVY_TAIL = 0.5  # standard deviation of the logarithm of each particle's spread: most are near, a few are far
WIDER = 2.5  # spread of a second search of a frame, as a share of the first one's
PRIOR_SHARE = 0.002  # of score for one unit of the prediction's log density: it decides between poses that fit alike
MEASURED_SHARE = 0.005  # the same for a measured motion: it decides between poses that fit nearly alike
CARRIED = 0.7  # share of a rival's evidence that is kept in the next frame, so that old evidence fades
UNMEASURED = 4  # one pair of particles in four repeats the last motion, because a measured motion may be wrong
FARTHEST = 25.0  # squared distance from a measured motion, in units of the spread, at which the penalty stops growing
GROWTH = 1.5  # times as wide is the cloud after every frame in which the camera was not found


class Rival(NamedTuple):
    """Another pose that the camera may have."""

    pose: np.ndarray  # Camera-to-world `(4, 4)`.
    evidence: float  # Score of its image less the score of the best pose's image: 0 or less.


class MeasuredMotion(NamedTuple):
    """A motion since the frame before, measured by an odometer or by two images."""

    motion: np.ndarray  # `(6,)` metres, radians, along and about the optical axes of the frame before (`retract`).
    covariance: np.ndarray  # `(6, 6)` of the pose that it leads to, along and about that pose's axes.

    @classmethod
    def of_odometer(cls, increment: np.ndarray) -> "MeasuredMotion":
        """Return the motion of an increment `(6,)`, with `SPREAD_OF_INCREMENT` of its lengths as its errors."""
        sigma = np.maximum(SPREAD_OF_INCREMENT * lengths(increment), MIN_SPREAD)
        return cls(increment, np.diag(np.repeat(sigma, 3) ** 2))


class MotionPrediction:
    """Hold the camera's last pose (camera-to-world `(4, 4)`, optical), its last motions, and predict the next pose."""

    def __init__(self, pose: np.ndarray) -> None:
        self.pose = np.array(pose, dtype=np.float64)
        self.rivals: list[Rival] = []  # other poses of the last frame; half the cloud starts from them
        self.motion = np.zeros(6)
        self._started = self._not_found = False
        self._lengths: list[np.ndarray] = []
        self._surprises: list[np.ndarray] = []  # how much each motion differed from the motion before it

    def spread(self, measured: MeasuredMotion | None = None) -> np.ndarray:
        """Return the standard deviations `(6,)` of the next pose about its prediction: metres, radians, camera axes."""
        least, most = np.repeat(MIN_SPREAD, 3), np.repeat(MAX_SPREAD, 3)
        if measured is not None:
            return np.clip(np.sqrt(np.diag(measured.covariance)), least, most)
        longest = START_SPREAD
        if self._lengths:
            longest = SPREAD_OF_MOTION * np.max(self._lengths[-FRAMES_REMEMBERED:], axis=0)
        return np.clip(np.repeat(longest, 3), least, most)

    def guess_spread(self) -> np.ndarray:
        """Return the standard deviations `(6,)` of the next motion about the last one, from the recent differences."""
        if len(self._surprises) < GUESSES_REMEMBERED:
            return self.spread()
        off = np.repeat(np.max(self._surprises[-GUESSES_REMEMBERED:], axis=0), 3)
        return np.clip(off, np.repeat(MIN_SPREAD, 3), self.spread())

    def draw(
        self, n: int, spread: np.ndarray, rng: np.random.Generator, measured: MeasuredMotion | None = None
    ) -> np.ndarray:
        """Sample poses `(n, 4, 4)` where the camera may be now. If there are rivals, half of the poses start from them.

        spread: `(6,)` standard deviations. The first two poses have no noise: one is at rest, and one repeats the last
        motion. If the motion was measured, both are where it leads.
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
        """Return how likely the prediction makes poses `(N, 4, 4)`, in units of the raw score: `(N,)`, at most 0.

        max_k PRIOR_SHARE (-d_k^2 / 2) + CARRIED evidence_k

        k runs over the last pose and its rivals. d_k is the distance, in units of the spread `(6,)`, from the nearest
        motion between rest and the last motion. If the motion was measured, d_k is the distance from it, d_k^2 is at
        most `FARTHEST`, and MEASURED_SHARE replaces PRIOR_SHARE.
        """
        return np.max([preference for preference, _ in self._ways(poses, spread, measured)], axis=0)

    def origin(
        self, pose: np.ndarray, spread: np.ndarray, measured: MeasuredMotion | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return where the camera most likely came from if it is now at `pose`, and the pose predicted from there."""
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
        """Go on from `pose` `(4, 4)`. seen: whether the image shows all directions, so that the motion is learned."""
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
        """Go on from `pose`, from each rival, and from where the measured motion led from the last pose.

        spread: `(6,)` standard deviations of the cloud of this frame. The next cloud is `GROWTH` times as wide.
        """
        if measured is not None:
            self.pose = retract(self.pose, measured.motion)
        self._started = self._not_found = True
        self.motion = np.zeros(6) if measured is None else measured.motion
        self.rivals = [Rival(np.array(pose, dtype=np.float64), 0.0), *rivals]
        self._lengths, self._surprises = [spread[[0, 3]] * GROWTH / SPREAD_OF_MOTION], []
