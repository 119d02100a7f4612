"""Where the camera may be when the next image comes: as it has moved before, or as an odometer says.

The paper's system noise is one number, set by hand: too small for a camera that is swung round, and for one that hardly
moves a waste of particles. Here it follows the camera. Without an odometer the prediction is that the last motion goes
on, from not at all to a little more than before, and about it the cloud is as wide as recent motions were long. With
increments of an odometer or an IMU the centre is theirs, and the cloud as wide as a share of them.
"""

from __future__ import annotations

import numpy as np

from course_lib.depth_mcl.annealed.twists import lengths, motion_between, moved

# All chosen on development recordings: the kitchen and the shipped corridor, with every frame to every 12th.
LEAST_SPREAD = np.array([0.015, np.deg2rad(1.0)])  # metres, radians: of a camera at rest
GREATEST_SPREAD = np.array([0.5, np.deg2rad(30.0)])
START_SPREAD = np.array([0.2, np.deg2rad(10.0)])  # before a motion was seen; and of a start that was set by hand
SPREAD_OF_MOTION = 1.2  # spread of the cloud as a share of the longest of the last motions
SPREAD_OF_INCREMENT = 0.3  # the same of an odometer's increment
FRAMES_REMEMBERED = 3
GOES_ON = (-0.25, 1.25)  # least and greatest share of the last motion that the next one may repeat
HEAVY_TAIL = 0.5  # of the logarithm of each particle's own spread: most are near, a few are far
WIDER = 2.5  # the spread of a second look at a frame, as a share of the first's
GROWTH = 1.5  # of the spread, for every frame in which the camera was not found


class MotionPrediction:
    """What is known of the camera's motion: where it was seen last, its last motion, how long the last motions were.

    pose: camera-to-world `(4, 4)` of the start, optical convention.
    """

    def __init__(self, pose: np.ndarray) -> None:
        self.pose = np.array(pose, dtype=np.float64)
        self.doubted: np.ndarray | None = None
        """Where the camera was thought to be in the last frame, if that is doubted; then half the cloud starts there,
        the other half from `pose`."""
        self.motion = np.zeros(6)
        self._started = False
        self._lengths: list[np.ndarray] = []

    def spread(self, increment: np.ndarray | None = None) -> np.ndarray:
        """Standard deviations `(6,)` of the next pose about its prediction, metres and radians, camera's axes."""
        if increment is not None and self.doubted is None:
            longest = SPREAD_OF_INCREMENT * lengths(increment)
        elif self._lengths:
            longest = SPREAD_OF_MOTION * np.max(self._lengths[-FRAMES_REMEMBERED:], axis=0)
        else:
            longest = START_SPREAD
        return np.repeat(np.clip(longest, LEAST_SPREAD, GREATEST_SPREAD), 3)

    def draw(
        self, n: int, spread: np.ndarray, rng: np.random.Generator, increment: np.ndarray | None = None
    ) -> np.ndarray:
        """Poses `(n, 4, 4)` where the camera may be now; the first two without noise: at rest, and going on.

        spread: `(6,)`. increment: the motion `(6,)` since the last frame in the camera's own frame, as an odometer or
        an IMU has it; None without one.
        """
        starts = np.tile(self.pose, (n, 1, 1))
        if self.doubted is not None:
            starts[1::2] = self.doubted
        shares = rng.uniform(*GOES_ON, n)
        noise = spread * rng.standard_normal((n, 6)) * np.exp(HEAVY_TAIL * rng.standard_normal((n, 1)))
        shares[:2], noise[:2] = [0.0, 1.0][:n], 0.0
        motions = shares[:, None] * self.motion if increment is None else np.tile(increment, (n, 1))
        return moved(moved(starts, motions), noise)

    def log_prior(self, poses: np.ndarray, spread: np.ndarray, increment: np.ndarray | None = None) -> np.ndarray:
        """What the prediction says of poses `(N, 4, 4)`: -d^2 / 2, d the distance in units of the spread from the
        nearest motion between rest and going on (or from the odometer's). `(N,)`, at most 0.

        Where the image cannot tell, along a bare wall, this does.
        """
        starts = [self.pose] if self.doubted is None else [self.pose, self.doubted]
        going_on = self.motion if increment is None else np.asarray(increment, dtype=np.float64)
        squares = []
        for start in starts:
            motion = motion_between(start, poses) / spread
            ahead = going_on / spread
            share = np.ones(len(poses))
            if increment is None:
                share = np.clip(motion @ ahead / max(ahead @ ahead, 1e-12), 0.0, 1.0)
            squares.append(np.sum((motion - share[:, None] * ahead) ** 2, axis=1))
        return -np.min(squares, axis=0) / 2

    def found(self, pose: np.ndarray) -> None:
        """The camera is at `pose`. From the start to the first frame it was the start that was off, not the camera."""
        if self._started:
            self.motion = motion_between(self.pose, pose)
            self._lengths.append(lengths(self.motion))
        self._started = True
        self.pose, self.doubted = np.array(pose, dtype=np.float64), None

    def not_found(self, pose: np.ndarray, spread: np.ndarray) -> None:
        """The camera may be at `pose`, or where it was seen last; next time the cloud is wider than `spread` `(6,)`."""
        self._started = True
        self.motion, self.doubted = np.zeros(6), np.array(pose, dtype=np.float64)
        self._lengths = [spread[[0, 3]] * GROWTH / SPREAD_OF_MOTION]


def widened(spread: np.ndarray) -> np.ndarray:
    """The spread `(6,)` of a second look, where the first found nothing good: as wide as for a start, or wider."""
    return np.maximum(WIDER * spread, np.repeat(START_SPREAD, 3))
