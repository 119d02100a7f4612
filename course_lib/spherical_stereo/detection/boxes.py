"""Boxes on a panorama, which is a cylinder once unrolled: wrapping, centre, and overlap across the seam.

A box is (u_min, v_min, u_max, v_max) in edge coordinates, pixels: pixel i spans [i, i + 1). Its left edge lies in
[0, width); its right edge passes the width when the box crosses the seam.
"""

from __future__ import annotations

import numpy as np

from course_lib.spherical_stereo.panorama import View


class DetectionError(ValueError):
    """Boxes, colours, detections or matches of them that cannot be, or do not belong together."""


def checked_boxes(boxes: np.ndarray, width: float, name: str = "boxes") -> np.ndarray:
    """Boxes `(..., 4)` as float64; raises `DetectionError` for another shape, NaN, edges in another order, too wide."""
    if not (np.isfinite(width) and width > 0):
        raise DetectionError(f"the width of the panorama must be a positive number of pixels; got {width!r}")
    array = np.asarray(boxes, dtype=np.float64)
    if array.size == 0:
        return array.reshape(0, 4)
    if array.ndim == 0 or array.shape[-1] != 4:
        raise DetectionError(f"{name} must have shape (..., 4) [u_min, v_min, u_max, v_max]; got {array.shape}")
    if not np.isfinite(array).all():
        raise DetectionError(
            f"{name} must be finite; got NaN or infinity in {array[~np.isfinite(array).all(axis=-1)][0]}"
        )
    wrong = (array[..., 2] <= array[..., 0]) | (array[..., 3] <= array[..., 1])
    if wrong.any():
        raise DetectionError(
            f"{name}: u_min < u_max and v_min < v_max are needed; got {array[wrong][0].tolist()}. "
            f"A box across the seam has u_max above the width ({width:g})"
        )
    too_wide = array[..., 2] - array[..., 0] > width
    if too_wide.any():
        raise DetectionError(
            f"{name}: no box is wider than the panorama ({width:g} px); got {array[too_wide][0].tolist()}"
        )
    return array


def boxes_on(view: View, name: str) -> np.ndarray:
    """The boxes `(n, 4)` of a panorama's detections.

    Raises `DetectionError` for what is no box, or sticks out of the panorama; the message begins with `name`.
    """
    boxes = checked_boxes([one.box for one in view.detections], view.width, f"boxes of the {name} image")
    # A millionth of a pixel: boxes come from sums and remainders, which round.
    low, right, bottom = -1e-6, view.width + 1e-6, view.height + 1e-6
    outside = (boxes[:, 0] < low) | (boxes[:, 0] >= right) | (boxes[:, 1] < low) | (boxes[:, 3] > bottom)
    if outside.any():
        raise DetectionError(
            f"{name} box {boxes[outside][0].tolist()} is not on a panorama of {view.width} x {view.height} pixels: "
            "give size=(width, height) of the image it comes from"
        )
    return boxes


def wrapped_box(box: np.ndarray, width: float) -> np.ndarray:
    """Boxes `(..., 4)` moved by whole turns so that 0 <= u_min < width; u_max may pass the width.

    Raises `DetectionError` for what is no box.
    """
    box = checked_boxes(box, width)
    turns = np.floor(box[..., 0] / width)
    moved = box - (turns * width)[..., None] * np.array([1.0, 0.0, 1.0, 0.0])
    # The remainder of a tiny negative number rounds up to the width itself, which would read as one turn too far.
    over = moved[..., 0] >= width
    return moved - np.where(over, width, 0.0)[..., None] * np.array([1.0, 0.0, 1.0, 0.0])


def box_centre(box: np.ndarray) -> np.ndarray:
    """Centres `(..., 2)` (u, v) of boxes `(..., 4)`: the mean of opposite edges, pixels, edge coordinates.

    u may pass the width, as the box does: a direction made from it is the same. Source: paper 2, section 2.4.
    """
    box = np.asarray(box, dtype=np.float64)
    return 0.5 * (box[..., :2] + box[..., 2:])


def box_iou(boxes_a: np.ndarray, boxes_b: np.ndarray, width: float) -> np.ndarray:
    """Intersection over union `(n, m)` of boxes `(n, 4)` and `(m, 4)` on the circle of columns.

    IoU = |A and B| / (|A| + |B| - |A and B|)

    Raises `DetectionError` for what is no box.
    """
    shared = shared_area(boxes_a, boxes_b, width)
    areas_a, areas_b = (box_area(np.asarray(boxes, np.float64).reshape(-1, 4)) for boxes in (boxes_a, boxes_b))
    return shared / (areas_a[:, None] + areas_b[None, :] - shared)


def shared_area(boxes_a: np.ndarray, boxes_b: np.ndarray, width: float) -> np.ndarray:
    """Area `(n, m)`, square pixels, that boxes `(n, 4)` and `(m, 4)` share on the circle of columns.

    B is laid against A where it is and one turn to either side, so boxes on both sides of the seam meet, and two very
    wide boxes may overlap at both ends. Raises `DetectionError` for what is no box.
    """
    a = wrapped_box(checked_boxes(boxes_a, width, "boxes_a"), width).reshape(-1, 1, 4)
    b = wrapped_box(checked_boxes(boxes_b, width, "boxes_b"), width).reshape(1, -1, 4)
    across = sum(
        np.maximum(0.0, np.minimum(a[..., 2], b[..., 2] + shift) - np.maximum(a[..., 0], b[..., 0] + shift))
        for shift in (-width, 0.0, width)
    )
    down = np.maximum(0.0, np.minimum(a[..., 3], b[..., 3]) - np.maximum(a[..., 1], b[..., 1]))
    return across * down


def box_area(box: np.ndarray) -> np.ndarray:
    """Areas `(...)` of boxes `(..., 4)`, square pixels."""
    return (box[..., 2] - box[..., 0]) * (box[..., 3] - box[..., 1])
