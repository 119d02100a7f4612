"""The sphere behind an equirectangular image, the rig, and the record of one image (paper 2, section 2.4).

A panorama's centre looks along body +x (x forward, y left, z up), row 0 is straight up, and the seam is behind.
Coordinates are edge coordinates: pixel i spans [i, i + 1), so 0.5 is added to OpenCV's keypoints.
"""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from course_lib.files import read_image
from course_lib.geometry import wrap_angle

MAX_BASELINE = 10.0  # Metres. A longer baseline was probably given in millimetres.
BLANK_LEVEL = 12  # Brightest value, of 255, of a frame that shows nothing. The noise of a covered lens stays below it.
HOT_SHARE = 1e-4  # Share of the pixels of such a frame that may be brighter, because a sensor has hot pixels (chosen).


class PanoramaError(ValueError):
    """A panorama, a pair of them, or a coordinate on one that cannot be used."""


@dataclass(frozen=True)
class StereoRig:
    """Two panoramic cameras on one vertical axis.

    baseline: metres, the upper camera's height minus the lower camera's, positive. upper_height: metres above the
    floor, or nan if nobody measured it.
    Raises `PanoramaError` for a baseline that is not positive or above `MAX_BASELINE`, and for an upper height that
    leaves the lower camera below the floor. Source: paper 2, section 3 (0.30 m; 1.32 m and 1.44 m).
    """

    baseline: float
    upper_height: float = float("nan")

    def __post_init__(self) -> None:
        if not 0 < self.baseline <= MAX_BASELINE:
            raise PanoramaError(
                f"baseline must be a positive number of metres, at most {MAX_BASELINE:g}; got {self.baseline:g}. Is it "
                "in millimetres? A negative one means that upper and lower are swapped"
            )
        if np.isinf(self.upper_height) or self.upper_height < self.baseline:
            raise PanoramaError(
                f"upper_height must be metres above the floor, at least the baseline; got {self.upper_height:g}"
            )


def azimuth_elevation_of_pixel(uv: np.ndarray, width: int, height: int) -> tuple[np.ndarray, np.ndarray]:
    """Return azimuth in [-pi, pi) and elevation in [-pi/2, pi/2] of edge coordinates `(..., 2)`, radians.

    azimuth = (1/2 - u/W) 2 pi, elevation = (1/2 - v/H) pi. u may lie beyond the seam. Source: paper 2, section 2.4.
    """
    uv = _finite(uv, "uv", "uv")
    if ((uv[..., 1] < 0) | (uv[..., 1] > height)).any():
        raise PanoramaError(
            f"v must lie between 0 and the image height {height}; got {uv[..., 1].min():g} to {uv[..., 1].max():g}"
        )
    return np.asarray(wrap_angle((0.5 - uv[..., 0] / width) * 2 * np.pi)), (0.5 - uv[..., 1] / height) * np.pi


def pixel_to_direction(uv: np.ndarray, width: int, height: int) -> np.ndarray:
    """Return the directions `(..., 3)` (unit vectors, body frame) of edge coordinates `(..., 2)` on a panorama.

    x_hat = (cos e cos a, cos e sin a, sin e) with a and e of `azimuth_elevation_of_pixel`. Raises `PanoramaError` for v
    outside the image and for values that are not finite. Source: paper 2, section 2.4.
    """
    return direction_from_angles(*azimuth_elevation_of_pixel(uv, width, height))


def direction_to_pixel(direction: np.ndarray, width: int, height: int) -> np.ndarray:
    """Return edge coordinates `(..., 2)` of directions `(..., 3)`: the inverse of `pixel_to_direction`, u in [0, W).

    u = (1/2 - a / 2 pi) W, v = (1/2 - e / pi) H. Directions need not have unit length; straight up and down have no
    azimuth and get u = W/2. Raises `PanoramaError` for a wrong shape, a zero vector or values that are not finite.
    Source: paper 2, section 2.4.
    """
    azimuth, elevation = azimuth_elevation(direction)
    u = (0.5 - azimuth / (2 * np.pi)) * width
    # Azimuth -pi is the seam's right edge, which is column 0; a tiny negative u rounds up to the width itself.
    u = np.where((u >= width) | (u < 0), u % width, u)
    return np.stack([np.where(u >= width, 0.0, u), (0.5 - elevation / np.pi) * height], axis=-1)


def azimuth_elevation(direction: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return azimuth a = atan2(y, x), 0 straight up and down, and elevation e of directions `(..., 3)`, radians."""
    x, y, z = np.moveaxis(_finite(direction, "direction", "xyz"), -1, 0)
    horizontal = np.hypot(x, y)
    if ((horizontal == 0) & (z == 0)).any():
        raise PanoramaError("direction must not be the zero vector")
    azimuth = np.where(horizontal == 0, 0.0, np.arctan2(y, x))
    return np.asarray(wrap_angle(azimuth)), np.arctan2(z, horizontal)


def direction_from_angles(azimuth: np.ndarray | float, elevation: np.ndarray | float) -> np.ndarray:
    """Return unit vectors `(..., 3)` of azimuths and elevations in radians: (cos e cos a, cos e sin a, sin e)."""
    azimuth, elevation = np.broadcast_arrays(np.asarray(azimuth, float), np.asarray(elevation, float))
    return np.stack(
        [np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)], axis=-1
    )


def _finite(values: np.ndarray, name: str, axes: str) -> np.ndarray:
    """Return values as floats `(..., len(axes))`; raise `PanoramaError` for another shape, NaN and infinity."""
    values = np.asarray(values, dtype=np.float64)
    if values.ndim == 0 or values.shape[-1] != len(axes):
        raise PanoramaError(f"{name} must have shape (..., {len(axes)}) [{', '.join(axes)}]; got {values.shape}")
    if not np.isfinite(values).all():
        raise PanoramaError(f"{name} must be finite; got NaN or infinity")
    return values


def azimuth_difference(first: np.ndarray | float, second: np.ndarray | float) -> np.ndarray | float:
    """Return first - second on the circle, radians in [-pi, pi)."""
    return wrap_angle(np.asarray(first, dtype=np.float64) - np.asarray(second, dtype=np.float64))


@dataclass(frozen=True, eq=False)
class View:
    """One panorama, checked once, and what the steps of the method found in it."""

    width: int  # Pixels; twice the height.
    height: int
    image: np.ndarray | None = None  # `(H, W, 3)` uint8 BGR; None if only its detections are known.
    detections: Sequence = ()  # Section 2.2: anything with `label` and `box`, and for the map `hue` and `saturation`.
    features: Any = None  # Section 2.3: `PanoramaFeatures`, once they were looked for.
    is_blank: bool = False  # True if the image shows nothing: a covered lens, or an exposure that failed.

    def __post_init__(self) -> None:
        if self.height < 1 or self.width != 2 * self.height:
            raise PanoramaError(f"a panorama is twice as wide as high; got size {self.width} x {self.height}")
        object.__setattr__(self, "detections", tuple(self.detections))

    @property
    def size(self) -> tuple[int, int]:
        """Return (width, height), pixels."""
        return self.width, self.height

    def replace(self, **found: Any) -> View:
        """Return the same panorama with what a step found: `detections` or `features`."""
        return dataclasses.replace(self, **found)


def open_view(image: np.ndarray | View, name: str = "image") -> View:
    """Return an image as a `View` if it is a panorama, uint8 BGR `(H, W, 3)`, W = 2 H, black or not, or a `View`."""
    if isinstance(image, View):
        return image
    image = np.asarray(image)
    if image.ndim != 3 or image.shape[2] != 3 or image.dtype != np.uint8:
        raise PanoramaError(
            f"{name} must be a colour image (height, width, 3) of 8 bits; got {image.shape} of {image.dtype}"
        )
    height, width = image.shape[:2]
    if height < 1 or width != 2 * height:
        raise PanoramaError(f"{name} is {width} x {height} pixels; a panorama is twice as wide as high")
    # A few pixels of nearly every image show that it is neither black nor grey, so the whole is seldom looked at.
    parts = image[::16, ::16], image
    is_blank = all((part > BLANK_LEVEL).any(axis=-1).sum() / (width * height) <= HOT_SHARE for part in parts)
    is_grey = all((part == part[..., :1]).all() for part in parts)
    if is_grey and not is_blank:
        raise PanoramaError(f"{name} is a grey image (its three channels are equal); a colour image is needed")
    return View(width, height, image, is_blank=is_blank)


def open_pair(upper_image: np.ndarray | View, lower_image: np.ndarray | View) -> tuple[View, View]:
    """Check the two panoramas of a rig."""
    upper, lower = open_view(upper_image, "upper image"), open_view(lower_image, "lower image")
    if upper.size != lower.size:
        raise PanoramaError(f"the two images must have one size; got {upper.size} (upper) and {lower.size} (lower)")
    return upper, lower


def read_panorama(path: str | os.PathLike) -> View:
    """Read and check the panorama in an image file. An alpha channel is left out."""
    image = read_image(path, "image", PanoramaError)
    if image.ndim == 3 and image.shape[2] == 4:
        image = np.ascontiguousarray(image[..., :3])
    return open_view(image, str(path))
