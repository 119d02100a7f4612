"""Where the camera may be when the next image comes: as it has moved before, or as an odometer says.

The paper's system noise is one number, set by hand: too small for a camera that is swung round, and for one that hardly
moves a waste of particles. Here it follows the camera. Without an odometer the prediction is that the last motion goes
on, from not at all to a little more than before, and about it the cloud is as wide as recent motions were long. With
increments of an odometer or an IMU the centre is theirs, and the cloud as wide as a share of them.

Where another place explained the last frame nearly as well, the camera may have been there: a rival, from which the
cloud starts too.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from course_lib.beyond.six_dof.twists import lengths, motion_between, moved

# All chosen on development recordings: the kitchen and the shipped corridor, with every frame to every 12th; what
# concerns rivals on walks through rooms, seeds 10,041 to 10,066.
LEAST_SPREAD = np.array([0.015, np.deg2rad(1.0)])  # metres, radians: of a camera at rest
GREATEST_SPREAD = np.array([0.5, np.deg2rad(30.0)])
START_SPREAD = np.array([0.2, np.deg2rad(10.0)])  # before a motion was seen; and of a start that was set by hand
SPREAD_OF_MOTION = 1.2  # spread of the cloud as a share of the longest of the last motions
SPREAD_OF_INCREMENT = 0.3  # the same of an odometer's increment
FRAMES_REMEMBERED = 3
GOES_ON = (-0.25, 1.25)  # least and greatest share of the last motion that the next one may repeat
HEAVY_TAIL = 0.5  # of the logarithm of each particle's own spread: most are near, a few are far
WIDER = 2.5  # the spread of a second look at a frame, as a share of the first's
PRIOR_SHARE = 0.002  # what one unit of the prediction's log density is worth in score: it decides between equals
CARRIED = 0.7  # share of a rival's evidence that goes on to the next frame
GROWTH = 1.5  # of the spread, for every frame in which the camera was not found


class Rival(NamedTuple):
    """Another place where the camera may be."""

    pose: np.ndarray
    """Camera-to-world `(4, 4)`."""
    evidence: float
    """How much better its image fits than that of the best place, in units of the raw score: 0 or less."""


class MotionPrediction:
    """What is known of the camera's motion: where it was seen last, its last motion, how long the last motions were.

    pose: camera-to-world `(4, 4)` of the start, optical convention.
    """

    def __init__(self, pose: np.ndarray) -> None:
        self.pose = np.array(pose, dtype=np.float64)
        self.rivals: list[Rival] = []
        """Where else the camera may have been in the last frame; half the cloud starts from there."""
        self.motion = np.zeros(6)
        self._started = self._not_found = False
        self._lengths: list[np.ndarray] = []

    def spread(self, increment: np.ndarray | None = None) -> np.ndarray:
        """Standard deviations `(6,)` of the next pose about its prediction, metres and radians, camera's axes."""
        if increment is not None and not self._not_found:
            longest = SPREAD_OF_INCREMENT * lengths(increment)
        elif self._lengths:
            longest = SPREAD_OF_MOTION * np.max(self._lengths[-FRAMES_REMEMBERED:], axis=0)
        else:
            longest = START_SPREAD
        return np.repeat(np.clip(longest, LEAST_SPREAD, GREATEST_SPREAD), 3)

    def draw(
        self, n: int, spread: np.ndarray, rng: np.random.Generator, increment: np.ndarray | None = None
    ) -> np.ndarray:
        """Poses `(n, 4, 4)` where the camera may be now; the first two without noise: at rest, and going on. Half of
        them start from the rivals, where there are any.

        spread: `(6,)`. increment: the motion `(6,)` since the last frame in the camera's own frame, as an odometer or
        an IMU has it; None without one.
        """
        starts = np.tile(self.pose, (n, 1, 1))
        for k, rival in enumerate(self.rivals):
            starts[1 + 2 * k :: 2 * len(self.rivals)] = rival.pose
        shares = rng.uniform(*GOES_ON, n)
        noise = spread * rng.standard_normal((n, 6)) * np.exp(HEAVY_TAIL * rng.standard_normal((n, 1)))
        shares[:2], noise[:2] = [0.0, 1.0][:n], 0.0
        motions = shares[:, None] * self.motion if increment is None else np.tile(increment, (n, 1))
        return moved(moved(starts, motions), noise)

    def preference(self, poses: np.ndarray, spread: np.ndarray, increment: np.ndarray | None = None) -> np.ndarray:
        """What the prediction says of poses `(N, 4, 4)`, in units of the raw score: `(N,)`, at most 0.

        max_k  PRIOR_SHARE (-d_k^2 / 2) + CARRIED evidence_k,    over the places k where the camera may have been

        d: distance in units of the spread from the nearest motion between rest and going on (or from the odometer's).
        Where the image cannot tell, along a bare wall, this does.
        """
        return np.max([preference for preference, _ in self._ways(poses, spread, increment)], axis=0)

    def origin(
        self, pose: np.ndarray, spread: np.ndarray, increment: np.ndarray | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Where the camera came from if it is now at a pose `(4, 4)`, and where it was then predicted: two poses.

        Of all places where it may have been the one that the prediction prefers, and of its motions between rest and
        going on the nearest.
        """
        ways = self._ways(pose[None], spread, increment)
        likeliest = max(range(len(ways)), key=lambda k: ways[k][0][0])
        return self._places()[likeliest].pose, ways[likeliest][1][0]

    def _places(self) -> list[Rival]:
        return [Rival(self.pose, 0.0), *self.rivals]

    def _ways(
        self, poses: np.ndarray, spread: np.ndarray, increment: np.ndarray | None
    ) -> list[tuple[np.ndarray, np.ndarray]]:
        """From each place: the preference `(N,)` for poses `(N, 4, 4)`, and the predicted poses nearest to them."""
        going_on = self.motion if increment is None else np.asarray(increment, dtype=np.float64)
        ahead = going_on / spread
        ways = []
        for place, evidence in self._places():
            motion = motion_between(place, poses) / spread
            share = np.ones(len(poses))
            if increment is None:
                share = np.clip(motion @ ahead / max(ahead @ ahead, 1e-12), 0.0, 1.0)
            squares = np.sum((motion - share[:, None] * ahead) ** 2, axis=1)
            predicted = moved(np.tile(place, (len(poses), 1, 1)), share[:, None] * going_on)
            ways.append((-PRIOR_SHARE * squares / 2 + CARRIED * evidence, predicted))
        return ways

    def found(self, pose: np.ndarray, seen: bool = True, rivals: Sequence[Rival] = ()) -> None:
        """The camera is at `pose`, or at one of the rivals. From the start to the first frame it was the start that
        was off, not the camera.

        seen: False where the image leaves a direction open: how far the camera moved is then not learned.
        """
        if self._started:
            before = min(self._places(), key=lambda place: float(np.linalg.norm(motion_between(place.pose, pose))))
            self.motion = motion_between(before.pose, pose)
            if seen:
                self._lengths.append(lengths(self.motion))
        self._started, self._not_found = True, False
        self.pose, self.rivals = np.array(pose, dtype=np.float64), list(rivals)

    def not_found(self, pose: np.ndarray, spread: np.ndarray, rivals: Sequence[Rival] = ()) -> None:
        """The camera may be at `pose`, at a rival, or where it was seen last; next time the cloud is wider than
        `spread` `(6,)`."""
        self._started = self._not_found = True
        self.motion, self.rivals = np.zeros(6), [Rival(np.array(pose, dtype=np.float64), 0.0), *rivals]
        self._lengths = [spread[[0, 3]] * GROWTH / SPREAD_OF_MOTION]


def widened(spread: np.ndarray) -> np.ndarray:
    """The spread `(6,)` of a second look, where the first found nothing good: as wide as for a start, or wider."""
    return np.maximum(WIDER * spread, np.repeat(START_SPREAD, 3))
