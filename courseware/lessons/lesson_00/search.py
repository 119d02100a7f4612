"""What exercise 00.3 searches: the score of a scanner's poses in a small room. A student's function is given it."""

import numpy as np

from courseware.lessons.kit.box_world import Box, BoxWorld

ALPHA = 0.3  # m, wider than the paper's, because so few rays make a rough hill
BUDGET = 400  # poses that a search may ask for
# A room of 5 x 4 m, a pillar and a cupboard. Each box has x and y of two opposite corners [m].
WALLS = (-0.2, -0.2, 0.0, 4.2), (5.0, -0.2, 5.2, 4.2), (-0.2, -0.2, 5.2, 0.0), (-0.2, 4.0, 5.2, 4.2)
THINGS = (3.6, 1.0, 3.9, 1.3), (4.2, 3.2, 5.0, 4.0)
ROOM = BoxWorld([Box((*corners[:2], 0.0), (*corners[2:], 3.0), 0.5) for corners in (*WALLS, *THINGS)])


def distances(poses: np.ndarray) -> np.ndarray:
    """Return the distances (N, 45) [m] that a scanner measures all around at poses (N, 3), each x, y, yaw."""
    angles = poses[:, 2:] + np.deg2rad(np.arange(-180, 180, 8))
    directions = np.stack([np.cos(angles), np.sin(angles), np.zeros_like(angles)], axis=-1)
    return ROOM.cast(np.insert(poses[:, :2], 2, 1.2, axis=1)[:, None], directions).distance


class Score:
    """`score(poses)` is l / m, eq. (8), of poses (N, 3) or of one pose (3,). It answers `BUDGET` poses in all."""

    def __init__(self, truth: np.ndarray, first_blocked: int) -> None:
        self.truth, self.asked = truth, 0
        self.measured = distances(truth[None])[0]
        self.measured[first_blocked : first_blocked + 5] = 0.7  # m, a person in front of the scanner

    def __call__(self, poses: np.ndarray) -> np.ndarray | float:
        given = np.asarray(poses, dtype=np.float64)
        if given.shape[-1:] != (3,) or given.ndim > 2:
            raise ValueError(f"score takes poses (N, 3), each x, y, yaw; got an array of shape {given.shape}")
        self.asked += given.size // 3
        if self.asked > BUDGET:
            raise RuntimeError(f"your search asked for more than {BUDGET} poses")
        share = np.mean(ALPHA / (ALPHA + np.abs(self.measured - distances(given.reshape(-1, 3)))), axis=1)
        return share if given.ndim == 2 else float(share[0])

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Score) and np.array_equal(self.measured, other.measured)

    def __deepcopy__(self, memo: dict) -> "Score":
        copied = object.__new__(Score)  # for another search, which has asked nothing yet
        vars(copied).update(vars(self), asked=0)
        return copied

    def __getstate__(self) -> dict:
        return vars(self) | {"truth": None}  # what is graded runs in another process, and the truth stays here
