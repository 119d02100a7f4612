"""The sphere behind an equirectangular image: pixels, directions, angles, and the rig of two cameras (paper 2, 2.4).

A panorama is twice as wide as high. Its centre looks along body +x, columns run to the right as azimuth decreases, row
0 is straight up, and the seam is behind. Coordinates are edge coordinates: pixel i spans [i, i + 1), so 0.5 is added to
OpenCV's keypoints, and

    azimuth = (1/2 - u / W) 2 pi        elevation = (1/2 - v / H) pi

A direction is the unit vector (cos e cos a, cos e sin a, sin e) in the body frame: x forward, y left, z up.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from course_lib.geometry import wrap_angle


class PanoramaError(ValueError):
    """A panorama, a pair of them, or a coordinate on one that cannot be used."""


class UnreadableImageError(PanoramaError):
    """A file that is missing or that OpenCV cannot decode."""


class EmptyImageError(PanoramaError):
    """An image without pixels."""


class GreyImageError(PanoramaError):
    """An image without colour, one channel or three equal ones: hue and saturation are needed."""


class NotPanoramaError(PanoramaError):
    """An image that is not twice as wide as high, or not 8 bits a channel."""


class ImageSizeError(PanoramaError):
    """Two images of one rig whose sizes differ."""


class RigError(PanoramaError):
    """A rig that no two cameras can have: a baseline or a height that is not a usable number of metres."""


@dataclass(frozen=True)
class StereoRig:
    """Two panoramic cameras on one vertical axis.

    baseline: metres, the upper camera's height minus the lower's, positive. upper_height: metres above the floor, or
    nan where nobody measured it (only heights need it).
    Raises `RigError` for a baseline that is not positive and finite, or an upper height that leaves the lower camera
    below the floor. Source: paper 2, section 3 (0.30 m; 1.32 m and 1.44 m).
    """

    baseline: float
    upper_height: float = float("nan")

    def __post_init__(self) -> None:
        try:
            baseline, upper_height = float(self.baseline), float(self.upper_height)
        except (TypeError, ValueError):
            raise RigError(
                f"baseline and upper_height must be metres; got {self.baseline!r} and {self.upper_height!r}"
            ) from None
        if not (np.isfinite(baseline) and baseline > 0):
            raise RigError(
                f"baseline must be a positive number of metres (upper height minus lower height); got {baseline!r}."
                " A negative one means that upper and lower were swapped"
            )
        if np.isinf(upper_height) or upper_height < baseline:
            raise RigError(
                f"upper_height must be metres above the floor, at least the baseline {baseline:g}; got {upper_height:g}"
            )
        object.__setattr__(self, "baseline", baseline)
        object.__setattr__(self, "upper_height", upper_height)

    @property
    def lower_height(self) -> float:
        """Height of the lower camera above the floor, metres."""
        return self.upper_height - self.baseline


def azimuth_elevation_of_pixel(uv: np.ndarray, width: int, height: int) -> tuple[np.ndarray, np.ndarray]:
    """Azimuth in [-pi, pi) and elevation in [-pi/2, pi/2] of edge coordinates `(..., 2)`, radians.

    azimuth = (1/2 - u/W) 2 pi, elevation = (1/2 - v/H) pi. u may lie beyond the seam; v must lie in [0, H].
    Raises `PanoramaError` for a wrong shape, values that are not finite, or v outside the image.
    Source: paper 2, section 2.4.
    """
    uv = np.asarray(uv, dtype=np.float64)
    if uv.ndim == 0 or uv.shape[-1] != 2:
        raise PanoramaError(f"uv must have shape (..., 2) [u, v]; got {uv.shape}")
    if not np.isfinite(uv).all():
        raise PanoramaError("uv must be finite; got NaN or infinity")
    if ((uv[..., 1] < 0) | (uv[..., 1] > height)).any():
        raise PanoramaError(
            f"v must lie between 0 and the image height {height}; got {uv[..., 1].min():g} to {uv[..., 1].max():g}"
        )
    return np.asarray(wrap_angle((0.5 - uv[..., 0] / width) * 2 * np.pi)), (0.5 - uv[..., 1] / height) * np.pi


def pixel_to_direction(uv: np.ndarray, width: int, height: int) -> np.ndarray:
    """Directions `(..., 3)` (unit vectors, body frame) of edge coordinates `(..., 2)` on a panorama.

    x_hat = (cos e cos a, cos e sin a, sin e) with a and e of `azimuth_elevation_of_pixel`.
    Raises `PanoramaError` as that does. Source: paper 2, section 2.4.
    """
    return direction_from_angles(*azimuth_elevation_of_pixel(uv, width, height))


def direction_to_pixel(direction: np.ndarray, width: int, height: int) -> np.ndarray:
    """Edge coordinates `(..., 2)` of directions `(..., 3)`: the inverse of `pixel_to_direction`, with u in [0, W).

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
    """Azimuth in [-pi, pi) and elevation in [-pi/2, pi/2] (radians, `(...)`) of directions `(..., 3)`.

    a = atan2(y, x), e = atan2(z, hypot(x, y)); straight up and down a is 0.
    Raises `PanoramaError` for a wrong shape, a zero vector or values that are not finite.
    Source: paper 2, section 2.4.
    """
    direction = np.asarray(direction, dtype=np.float64)
    if direction.ndim == 0 or direction.shape[-1] != 3:
        raise PanoramaError(f"direction must have shape (..., 3) [x, y, z]; got {direction.shape}")
    if not np.isfinite(direction).all():
        raise PanoramaError("direction must be finite; got NaN or infinity")
    x, y, z = np.moveaxis(direction, -1, 0)
    horizontal = np.hypot(x, y)
    if ((horizontal == 0) & (z == 0)).any():
        raise PanoramaError("direction must not be the zero vector")
    azimuth = np.where(horizontal == 0, 0.0, np.arctan2(y, x))
    return np.asarray(wrap_angle(azimuth)), np.arctan2(z, horizontal)


def direction_from_angles(azimuth: np.ndarray | float, elevation: np.ndarray | float) -> np.ndarray:
    """Unit vectors `(..., 3)` of azimuths and elevations in radians: (cos e cos a, cos e sin a, sin e).

    Source: paper 2, section 2.4.
    """
    azimuth, elevation = np.broadcast_arrays(np.asarray(azimuth, float), np.asarray(elevation, float))
    return np.stack(
        [np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)], axis=-1
    )


def azimuth_difference(first: np.ndarray | float, second: np.ndarray | float) -> np.ndarray | float:
    """first - second on the circle, radians in [-pi, pi)."""
    return wrap_angle(np.asarray(first, dtype=np.float64) - np.asarray(second, dtype=np.float64))


def check_panorama(image: np.ndarray, name: str = "image") -> np.ndarray:
    """`image` itself when it is a panorama: uint8 BGR `(H, W, 3)` with W = 2 H.

    Raises `EmptyImageError` (None, or no pixels), `GreyImageError` (one channel, or three equal ones),
    `NotPanoramaError` (another shape, not 2:1, not 8 bits); the message begins with `name`.
    """
    if image is None or np.size(image) == 0:
        raise EmptyImageError(f"{name} is empty; an equirectangular colour image was expected")
    if not isinstance(image, np.ndarray) or image.ndim not in (2, 3):
        shape = getattr(image, "shape", type(image).__name__)
        raise NotPanoramaError(f"{name} must be an array (height, width, 3) of BGR values; got {shape}")
    if image.ndim == 2 or image.shape[2] == 1:
        raise GreyImageError(f"{name} is a grey image of shape {image.shape}; colour (height, width, 3) is needed")
    if image.shape[2] != 3 or image.dtype != np.uint8:
        raise NotPanoramaError(
            f"{name} must have 3 channels (BGR) of 8 bits; got {image.shape[2]} of {image.dtype}. Convert it first"
        )
    height, width = image.shape[:2]
    if width != 2 * height:
        raise NotPanoramaError(
            f"{name} is {width} x {height} pixels; an equirectangular panorama is twice as wide as high"
            f" ({2 * height} x {height})"
        )
    # Nearly every colour image shows its colour in a few pixels; only what may be grey is looked at as a whole.
    if _is_grey(image[::16, ::16]) and _is_grey(image):
        raise GreyImageError(f"{name} is a grey image (its three channels are equal); a colour image is needed")
    return image


def _is_grey(image: np.ndarray) -> bool:
    return bool((image == image[..., :1]).all())


def check_panorama_pair(upper_image: np.ndarray, lower_image: np.ndarray) -> tuple[int, int]:
    """(width, height) of two panoramas of one size.

    Raises `check_panorama`'s errors, and `ImageSizeError` when the sizes differ.
    """
    check_panorama(upper_image, "upper image")
    check_panorama(lower_image, "lower image")
    if upper_image.shape != lower_image.shape:
        (h_upper, w_upper), (h_lower, w_lower) = upper_image.shape[:2], lower_image.shape[:2]
        raise ImageSizeError(
            f"the two images must have one size; got {w_upper} x {h_upper} (upper) and {w_lower} x {h_lower} (lower)"
        )
    return upper_image.shape[1], upper_image.shape[0]


def read_panorama(path: str | os.PathLike) -> np.ndarray:
    """The panorama in an image file, uint8 BGR `(H, W, 3)`; an alpha channel is left out.

    Raises `UnreadableImageError` (no such file, or not an image), and `check_panorama`'s errors.
    """
    path = Path(path)
    if not path.is_file():
        raise UnreadableImageError(f"there is no image file {path}")
    data = np.frombuffer(path.read_bytes(), dtype=np.uint8)
    image = cv2.imdecode(data, cv2.IMREAD_UNCHANGED) if data.size else None
    if image is None:
        raise UnreadableImageError(f"{path} cannot be read as an image; PNG or JPEG is expected")
    if image.ndim == 3 and image.shape[2] == 4:
        image = np.ascontiguousarray(image[..., :3])
    return check_panorama(image, str(path))
