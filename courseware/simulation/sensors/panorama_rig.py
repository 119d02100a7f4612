"""The two 360-degree cameras of a rig: where they really are, and what happens from light to the file they write."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import cv2
import numpy as np
from numpy.random import Generator

from course_lib.files import atomic_write
from course_lib.geometry import pose_matrix, state_from_matrix


@dataclass(frozen=True)
class PanoramaCameraModel:
    """What one photograph does to the light; each range is drawn anew for every photograph."""

    exposure_stops: float = 0.25  # standard deviation of the exposure, powers of two; chosen
    white_balance: float = 0.04  # standard deviation of each channel's gain, a share of one; chosen
    blur: tuple[float, float] = (0.3, 0.8)  # pixels at 1280, standard deviation of lens and stitching; chosen
    shot_noise: float = 0.15  # variance per brightness level, grey levels; chosen
    read_noise: float = 1.2  # standard deviation, grey levels; chosen
    jpeg_quality: tuple[int, int] = (78, 86)  # 0 to 100, OpenCV's scale; chosen


def photograph(light: np.ndarray, model: PanoramaCameraModel, rng: Generator) -> np.ndarray:
    """One photograph `(H, W, 3)` uint8 of light `(H, W, 3)` float32, both BGR; 255 = full scale at exposure 1."""
    gain = 2.0 ** rng.normal(0.0, model.exposure_stops) * rng.normal(1.0, model.white_balance, 3)
    image = light * gain.astype(np.float32)
    sigma = rng.uniform(*model.blur) * light.shape[1] / 1280
    # A panorama has no left and right end: blur it with a margin from its other side.
    margin = 8
    image = np.concatenate([image[:, -margin:], image, image[:, :margin]], axis=1)
    image = cv2.GaussianBlur(image, (0, 0), max(sigma, 0.1))[:, margin:-margin]
    spread = np.sqrt(model.shot_noise * np.clip(image, 0, 255) + model.read_noise**2, dtype=np.float32)
    image = image + spread * rng.standard_normal(image.shape, dtype=np.float32)
    return np.clip(np.rint(image), 0, 255).astype(np.uint8)


def write_photograph(path: str | Path, light: np.ndarray, model: PanoramaCameraModel, rng: Generator) -> None:
    """Write one photograph of the light as JPEG with a quality of its own."""
    image = photograph(light, model, rng)
    quality = int(rng.integers(model.jpeg_quality[0], model.jpeg_quality[1] + 1))
    atomic_write(path, cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, quality])[1].tobytes())


@dataclass(frozen=True)
class RigModel:
    """How far a rig that is set up by hand stands from upright, and its two cameras from one vertical axis.

    0.15 mm of dust under a tripod thread's seat, 30 mm wide, tilts a camera by 0.3 degrees; the two lenses inside one
    consumer camera were measured to be 0.7 to 1.2 degrees from opposite (a Theta SC; monochrome.sutic.nu, 2017-08-03).
    """

    tilt_deg: float = 1.0  # degrees, greatest tilt of the rig as a whole; chosen
    relative_tilt_deg: float = 0.3  # degrees, greatest tilt of the lower camera against the upper; chosen
    relative_yaw_deg: float = 0.3  # degrees, greatest turn of the lower camera against the upper; chosen: one column
    baseline_error: float = 0.001  # m, standard deviation of true less told baseline; chosen: a ruler
    height_error: float = 0.005  # m, standard deviation of true less told height of the rig; chosen: a tape measure
    assembled_anew: bool = False  # whether the lower camera is mounted anew at every place; chosen: once for all


# The rig of data/room, which was photographed before these faults had parameters: kinder than a real one.
NEARLY_PERFECT_RIG = RigModel(1.0, 0.05, 0.0, baseline_error=0.0, height_error=0.0, assembled_anew=True)


@dataclass(frozen=True)
class Mount:
    """How the lower camera really sits below the upper one."""

    relative_tilt: tuple[float, float] = (0.0, 0.0)  # (roll, pitch), radians
    relative_yaw: float = 0.0  # radians
    baseline_error: float = 0.0  # metres, true less told
    height_error: float = 0.0  # likewise

    def tilted(self, tilt_deg: float) -> Mount:
        """The same mount with a relative tilt of exactly so many degrees, in the direction that it has already."""
        roll, pitch = self.relative_tilt
        return replace(self, relative_tilt=_tilt(np.deg2rad(tilt_deg), np.arctan2(pitch, roll)))


@dataclass(frozen=True)
class RigPose:
    """A vertical pair of 360-degree cameras as it really stands, metres and radians; x, y, heading are estimated."""

    x: float
    y: float
    heading: float
    upper_height: float
    baseline: float
    tilt: tuple[float, float] = (0.0, 0.0)
    relative_tilt: tuple[float, float] = (0.0, 0.0)
    relative_yaw: float = 0.0

    def camera_states(self) -> tuple[np.ndarray, np.ndarray]:
        """Poses `(6,)` of the upper and the lower camera: [x, y, z, roll, pitch, yaw], metres and radians."""
        upper = pose_matrix(np.array([self.x, self.y, self.upper_height, *self.tilt, self.heading]))
        below = pose_matrix(np.array([0.0, 0.0, -self.baseline, *self.relative_tilt, self.relative_yaw]))
        return state_from_matrix(upper), state_from_matrix(upper @ below)

    def as_dict(self) -> dict:
        """For JSON. A yaw of exactly 0 is left out: data/room's files were written before rigs had one."""
        return {name: value for name, value in asdict(self).items() if name != "relative_yaw" or value != 0.0}


def assemble(model: RigModel, rng: Generator) -> Mount:
    """A mount with faults drawn from the model: tilt uniformly from a disk, yaw from a range, lengths normal."""
    relative_tilt = _from_disk(np.deg2rad(model.relative_tilt_deg), rng)
    # A generator of its own: the numbers that rng gives next do not depend on how many faults a mount has.
    (faults,) = rng.spawn(1)
    yaw = np.deg2rad(model.relative_yaw_deg)
    turn, errors = float(faults.uniform(-yaw, yaw)), faults.standard_normal(2)
    return Mount(relative_tilt, turn, float(model.baseline_error * errors[0]), float(model.height_error * errors[1]))


def stand_up(
    pose: Sequence[float],
    upper_height: float,
    baseline: float,
    model: RigModel,
    rng: Generator,
    mount: Mount | None = None,
) -> RigPose:
    """A rig set up at [x, y, heading], tilted as a whole; lengths as told to the method. No mount: assembled anew."""
    tilt = _from_disk(np.deg2rad(model.tilt_deg), rng)
    mount = mount or assemble(model, rng)
    heights = upper_height + mount.height_error, baseline + mount.baseline_error
    return RigPose(*map(float, pose), *heights, tilt, mount.relative_tilt, mount.relative_yaw)


def _from_disk(radius: float, rng: Generator) -> tuple[float, float]:
    return _tilt(radius * np.sqrt(rng.uniform()), rng.uniform(0.0, 2.0 * np.pi))


def _tilt(length: float, direction: float) -> tuple[float, float]:
    return float(length * np.cos(direction)), float(length * np.sin(direction))
