"""One object of a panorama (paper 2, section 2.2): its class, its colour, and its box (u_min, v_min, u_max, v_max) in
edge coordinates, pixels, 0 <= u_min < width. If the box crosses the seam, u_max passes the width.
"""

import math
import re
from dataclasses import dataclass

import numpy as np

from course_lib.spherical_stereo.panorama import View

# Names that COCO, VOC and people use for the classes of our maps and network, in lower case with single spaces.
_OTHER_NAMES = {
    "sofa": ("couch", "settee"),
    "table": ("diningtable", "dining table", "desk"),
    "television": ("tv", "tvmonitor", "tv monitor"),
    "potted plant": ("pottedplant", "houseplant"),
    "refrigerator": ("fridge",),
    "cabinet": ("cupboard",),
}
ALIASES = {name: label for label, names in _OTHER_NAMES.items() for name in names}


class DetectionError(ValueError):
    """Boxes, colours, detections or matches of them that cannot be, or do not belong together."""


def canonical_label(label: str) -> str:
    """Return the map's label for a detector's class name: "couch" is "sofa". Case, "_" and "-" do not matter."""
    plain = " ".join(re.split(r"[\s_-]+", label.lower())).strip() if isinstance(label, str) else ""
    if not plain:
        raise DetectionError(f"a label is a text that is not empty; got {label!r}")
    return ALIASES.get(plain, plain)


@dataclass(frozen=True)
class Detection:
    """One object found in a panorama. Raises `DetectionError` for values outside their range.

    label: class, kept as its canonical label. score: confidence, 0 to 1. box: (u_min, v_min, u_max, v_max), pixels,
    edge coordinates. hue: degrees in [0, 360), NaN for grey, which has none. saturation: percent, 0 to 100; NaN with
    hue NaN if nobody measured the colour, which `coloured` then measures in the image.
    """

    label: str
    score: float
    box: tuple[float, float, float, float]
    hue: float = math.nan
    saturation: float = math.nan

    def __post_init__(self) -> None:
        object.__setattr__(self, "label", canonical_label(self.label))
        object.__setattr__(self, "box", tuple(float(edge) for edge in self.box))
        for name in ("score", "hue", "saturation"):
            object.__setattr__(self, name, float(getattr(self, name)))
        u_min, v_min, u_max, v_max = self.box if len(self.box) == 4 else 4 * (math.nan,)
        if not (0 <= u_min < u_max < math.inf and 0 <= v_min < v_max < math.inf):
            raise DetectionError(
                "box must be four finite numbers (u_min, v_min, u_max, v_max), 0 <= u_min < u_max and 0 <= v_min < "
                f"v_max; got {self.box}"
            )
        is_hue, has_none = self.is_grey or 0 <= self.hue < 360, self.is_grey and math.isnan(self.saturation)
        if not (0 <= self.score <= 1 and is_hue and (has_none or 0 <= self.saturation <= 100)):
            raise DetectionError(
                "score must be 0 to 1, hue in degrees, [0, 360), or NaN for grey, saturation in percent, 0 to 100; got "
                f"{self.score}, {self.hue} and {self.saturation}"
            )

    @property
    def is_grey(self) -> bool:
        """Return True if the object has no hue."""
        return math.isnan(self.hue)

    def describe(self) -> str:
        """Return one line for people: label, score, colour and place."""
        colour = "grey, no hue" if self.is_grey else f"hue {self.hue:.0f} deg"
        u, v = box_centre(self.box)
        return f"{self.label} {self.score:.2f}, {colour}, saturation {self.saturation:.0f} %, centre ({u:.0f}, {v:.0f})"


def checked_boxes(boxes: np.ndarray, width: float, name: str = "boxes") -> np.ndarray:
    """Return boxes `(..., 4)` as float64. Raise `DetectionError` for boxes that no panorama has."""
    array = np.asarray(boxes, dtype=np.float64)
    if array.size == 0:
        return array.reshape(0, 4)
    if array.ndim == 0 or array.shape[-1] != 4:
        raise DetectionError(f"{name} must have shape (..., 4) [u_min, v_min, u_max, v_max]; got {array.shape}")
    across, down = array[..., 2] - array[..., 0], array[..., 3] - array[..., 1]
    # A millionth of a pixel, because boxes come from sums and remainders, which round.
    good = np.isfinite(array).all(axis=-1) & (across > 0) & (across <= width + 1e-6) & (down > 0)
    if not good.all():
        raise DetectionError(
            f"{name} must be finite, with v_min < v_max and u_min < u_max <= u_min + {width:g}, the width; a box "
            f"across the seam has u_max above the width; got {array[~good][0].tolist()}"
        )
    return array


def boxes_on(view: View, name: str) -> np.ndarray:
    """Return the boxes `(n, 4)` of a panorama's detections."""
    boxes = checked_boxes([one.box for one in view.detections], view.width, f"boxes of the {name} image")
    low, right, bottom = -1e-6, view.width + 1e-6, view.height + 1e-6
    outside = (boxes[:, 0] < low) | (boxes[:, 0] >= right) | (boxes[:, 1] < low) | (boxes[:, 3] > bottom)
    if outside.any():
        raise DetectionError(
            f"{name} box {boxes[outside][0].tolist()} is not on a panorama of {view.width} x {view.height} pixels: "
            "give size=(width, height) of the image it comes from"
        )
    return boxes


def wrapped_box(box: np.ndarray, width: float) -> np.ndarray:
    """Return boxes `(..., 4)` moved by whole turns so that 0 <= u_min < width."""
    box = checked_boxes(box, width)
    moved = box - (np.floor(box[..., 0] / width) * width)[..., None] * np.array([1.0, 0.0, 1.0, 0.0])
    # The remainder of a tiny negative number rounds up to the width itself, which is one turn too far.
    over = moved[..., 0] >= width
    return moved - np.where(over, width, 0.0)[..., None] * np.array([1.0, 0.0, 1.0, 0.0])


def box_centre(box: np.ndarray) -> np.ndarray:
    """Return centres `(..., 2)` (u, v) of boxes `(..., 4)`, in pixels. u may pass the width."""
    box = np.asarray(box, dtype=np.float64)
    return 0.5 * (box[..., :2] + box[..., 2:])


def box_area(box: np.ndarray) -> np.ndarray:
    """Return areas `(...)` of boxes `(..., 4)`, square pixels."""
    return (box[..., 2] - box[..., 0]) * (box[..., 3] - box[..., 1])


def box_iou(boxes_a: np.ndarray, boxes_b: np.ndarray, width: float) -> np.ndarray:
    """Return |A and B| / |A or B| `(n, m)` of boxes `(n, 4)` and `(m, 4)` on the circle of columns."""
    shared = shared_area(boxes_a, boxes_b, width)
    areas_a, areas_b = (box_area(np.asarray(boxes, np.float64).reshape(-1, 4)) for boxes in (boxes_a, boxes_b))
    return shared / (areas_a[:, None] + areas_b[None, :] - shared)


def shared_area(boxes_a: np.ndarray, boxes_b: np.ndarray, width: float) -> np.ndarray:
    """Return the area `(n, m)`, square pixels, that boxes `(n, 4)` and `(m, 4)` share on the circle of columns."""
    a, b = wrapped_box(boxes_a, width).reshape(-1, 1, 4), wrapped_box(boxes_b, width).reshape(1, -1, 4)
    across = sum(
        np.maximum(0.0, np.minimum(a[..., 2], b[..., 2] + shift) - np.maximum(a[..., 0], b[..., 0] + shift))
        for shift in (-width, 0.0, width)
    )
    down = np.maximum(0.0, np.minimum(a[..., 3], b[..., 3]) - np.maximum(a[..., 1], b[..., 1]))
    return across * down
