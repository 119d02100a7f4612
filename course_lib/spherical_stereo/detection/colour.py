"""Hue and saturation of an object in a panorama (paper 2, 2.2): means over the central half of its box.

Hue is an angle, so its mean is taken on the circle, and each pixel weighs as much as its saturation.
"""

import cv2
import numpy as np

from course_lib.geometry import circular_mean
from course_lib.spherical_stereo.detection.detected_object import Detection, DetectionError
from course_lib.spherical_stereo.panorama import View

GREY_SATURATION_PERCENT = 10.0  # mean saturation below which a thing is grey: a wrong white balance gives as much
MIXED_HUES_RESULTANT = 0.2  # length of the mean hue vector (1: all hues equal) below which there is no mean hue
DARKEST_VALUE = 1 / 16  # brightness (0 to 1) below which a pixel has no say: a grey level turns its hue by 60 degrees

Box = tuple[float, float, float, float]


def central_half(box: Box) -> Box:
    """Return the box with the same centre, half the width and half the height. Source: paper 2, section 2.2."""
    u_min, v_min, u_max, v_max = box
    quarter_width, quarter_height = (u_max - u_min) / 4, (v_max - v_min) / 4
    return (u_min + quarter_width, v_min + quarter_height, u_max - quarter_width, v_max - quarter_height)


def mean_hue_saturation(
    image_bgr: np.ndarray, box: Box | None = None, mask: np.ndarray | None = None
) -> tuple[float, float]:
    """Return mean hue (degrees in [0, 360), NaN for grey) and mean saturation (percent) of part of an image.

    hue = direction of sum_i s_i (cos h_i, sin h_i), saturation = mean of s_i  over the pixels i of the central half of
    `box`, or of `mask` (bool, (H, W)), or of the whole image. The paper takes plain means of H. Raises `DetectionError`
    for an image that is not uint8 BGR `(H, W, 3)`, and a box or mask without a pixel. Source: paper 2, section 2.2.
    """
    image_bgr = np.asarray(image_bgr)
    if image_bgr.dtype != np.uint8 or image_bgr.ndim != 3 or image_bgr.shape[2] != 3:
        raise DetectionError(f"image must be uint8 BGR (H, W, 3); got {image_bgr.dtype} of shape {image_bgr.shape}")
    if box is not None:
        image_bgr = _crop(image_bgr, central_half(box))
    pixels = (image_bgr if mask is None else image_bgr[mask]).reshape(-1, 1, 3)
    if len(pixels) == 0:
        raise DetectionError(f"no pixel is left of the image for box {box} and the mask: give a box or mask inside it")
    # 8-bit HSV would round hue to 2 degrees; float input gives H in degrees and S from 0 to 1.
    hsv = cv2.cvtColor(pixels.astype(np.float32) / 255, cv2.COLOR_BGR2HSV).reshape(-1, 3).astype(np.float64)
    return _mean_hue(hsv), float(100 * hsv[:, 1].mean())


def coloured(view: View) -> View:
    """Return a panorama whose detections all have a colour. A missing one is measured in its image."""
    found = list(view.detections)
    for i, one in enumerate(found):
        if np.isnan(getattr(one, "saturation", np.nan)):
            if view.image is None:
                raise DetectionError(
                    f"detection {i}, {one.label}, has no colour: give hue and saturation (mean_hue_saturation), or the "
                    "images, in which they are measured"
                )
            colour = mean_hue_saturation(view.image, one.box)
            found[i] = Detection(one.label, getattr(one, "score", 1.0), one.box, *colour)
    return view.replace(detections=found)


def _mean_hue(hsv: np.ndarray) -> float:
    """Return the mean hue in degrees of pixels (n, 3) of H in degrees, S and V from 0 to 1; NaN if there is none."""
    weight = np.where(hsv[:, 2] >= DARKEST_VALUE, hsv[:, 1], 0.0)
    if weight.sum() == 0 or 100 * hsv[:, 1].mean() < GREY_SATURATION_PERCENT:
        return float("nan")
    angle = np.radians(hsv[:, 0])
    if np.abs(weight @ np.exp(1j * angle)) < MIXED_HUES_RESULTANT * weight.sum():
        return float("nan")
    hue = float(np.degrees(circular_mean(angle, weight)) % 360)
    return 0.0 if hue >= 360 else hue  # the remainder of a tiny negative number rounds up to 360


def _crop(image: np.ndarray, box: Box) -> np.ndarray:
    """Return the pixels whose centres lie in the box, at least one a direction, columns taken around the seam."""
    height, width = image.shape[:2]
    if not np.isfinite(box).all() or box[2] <= box[0] or box[3] <= box[1]:
        raise DetectionError(f"box must be finite with u_min < u_max and v_min < v_max; got {box} (its central half)")
    columns = _centres_between(box[0], min(box[2], box[0] + width)) % width
    rows = _centres_between(max(box[1], 0), min(box[3], height))
    rows = rows[(rows >= 0) & (rows < height)]
    return image[np.ix_(rows, columns)]


def _centres_between(start: float, stop: float) -> np.ndarray:
    """Return the indices i with start <= i + 1/2 < stop, or the pixel in the middle if there is none."""
    indices = np.arange(np.ceil(start - 0.5), np.ceil(stop - 0.5)).astype(int)
    return indices if len(indices) else np.array([int(np.floor((start + stop) / 2))])
