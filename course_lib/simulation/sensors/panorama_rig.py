"""Where the two cameras of a rig really are: a place, a heading, and the small tilts that nobody measured."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from course_lib.geometry import pose_matrix, state_from_matrix


@dataclass(frozen=True)
class RigModel:
    """How far a rig that is set up by hand stands from upright."""

    tilt_deg: float = 1.0  # degrees, greatest tilt of the rig as a whole; chosen
    relative_tilt_deg: float = 0.05  # degrees, greatest tilt of the lower camera against the upper; chosen


@dataclass(frozen=True)
class RigPose:
    """A vertical pair of 360-degree cameras as it really stands.

    x, y, heading: of the upper camera, metres and radians: what the methods estimate. upper_height: metres above the
    floor; the lower camera is `baseline` metres below. tilt, relative_tilt: (roll, pitch), radians.
    """

    x: float
    y: float
    heading: float
    upper_height: float
    baseline: float
    tilt: tuple[float, float] = (0.0, 0.0)
    relative_tilt: tuple[float, float] = (0.0, 0.0)

    def camera_states(self) -> tuple[np.ndarray, np.ndarray]:
        """Poses `(6,)` of the upper and the lower camera: [x, y, z, roll, pitch, yaw], metres and radians."""
        upper = pose_matrix(np.array([self.x, self.y, self.upper_height, *self.tilt, self.heading]))
        below = pose_matrix(np.array([0.0, 0.0, -self.baseline, *self.relative_tilt, 0.0]))
        return state_from_matrix(upper), state_from_matrix(upper @ below)


def stand_up(
    x: float,
    y: float,
    heading: float,
    upper_height: float,
    baseline: float,
    model: RigModel,
    rng: np.random.Generator,
) -> RigPose:
    """A rig set up at a place, with tilts drawn uniformly from disks of the model's radii."""
    return RigPose(
        x,
        y,
        heading,
        upper_height,
        baseline,
        _from_disk(np.deg2rad(model.tilt_deg), rng),
        _from_disk(np.deg2rad(model.relative_tilt_deg), rng),
    )


def _from_disk(radius: float, rng: np.random.Generator) -> tuple[float, float]:
    length, direction = radius * np.sqrt(rng.uniform()), rng.uniform(0.0, 2.0 * np.pi)
    return float(length * np.cos(direction)), float(length * np.sin(direction))
