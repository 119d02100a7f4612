"""Boxes drawn by hand on a stereo pair of panoramas, as JSON: detections for images that no network was trained on.

    {"version": 1, "width": 1024, "height": 512,
     "upper": [{"label": "chair", "box": [u_min, v_min, u_max, v_max], "name": "chair by the window"}, ...],
     "lower": [...]}

Boxes are in edge coordinates of images of that size. u_max passes the width if a box crosses the seam. `name` may be
left out. The same name in "upper" and "lower" says that the two boxes show one object, for checking a matcher.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from course_lib.files import read_json
from course_lib.spherical_stereo.detection.colour import mean_hue_saturation
from course_lib.spherical_stereo.detection.detected_object import (
    Detection,
    DetectionError,
    canonical_label,
    checked_boxes,
    wrapped_box,
)
from course_lib.spherical_stereo.panorama import View, open_pair

VERSION = 1


@dataclass(frozen=True)
class LabelledBox:
    label: str  # canonical
    box: tuple[float, float, float, float]  # 0 <= u_min < width
    name: str | None = None


@dataclass(frozen=True)
class StereoBoxes:
    """The boxes of both images, and the size in pixels of the images that they were drawn on."""

    width: int
    height: int
    upper: list[LabelledBox]
    lower: list[LabelledBox]

    def named_pairs(self) -> list[tuple[str, int, int]]:
        """Return (name, index in `upper`, index in `lower`) of every object named on both sides."""
        lower = {item.name: index for index, item in enumerate(self.lower) if item.name is not None}
        return [(item.name, index, lower[item.name]) for index, item in enumerate(self.upper) if item.name in lower]

    def on(self, upper_image: np.ndarray | View, lower_image: np.ndarray | View) -> tuple[View, View]:
        """Return both panoramas with the boxes as detections of score 1; hue and saturation come from the images."""
        upper, lower = open_pair(upper_image, lower_image)
        if upper.size != (self.width, self.height):
            raise DetectionError(
                f"the boxes were drawn on images of {self.width} x {self.height}, these are {upper.width} x "
                f"{upper.height}: scale the images, or draw the boxes again"
            )

        def seen(view: View, items: list[LabelledBox]) -> View:
            found = [Detection(one.label, 1.0, one.box, *mean_hue_saturation(view.image, one.box)) for one in items]
            return view.replace(detections=found)

        return seen(upper, self.upper), seen(lower, self.lower)


def read_stereo_boxes(path: str | Path) -> StereoBoxes:
    """Read a boxes file (format: see the module)."""
    content = read_json(Path(path), "boxes file", DetectionError)
    if not isinstance(content, dict) or content.get("version") != VERSION:
        version = content.get("version") if isinstance(content, dict) else None
        raise DetectionError(f"{path} must be an object with version {VERSION}; got version {version!r}")
    width, height = content.get("width"), content.get("height")
    if not (isinstance(width, int) and isinstance(height, int) and height > 0 and width == 2 * height):
        raise DetectionError(f"{path} must have whole numbers width = 2 height; got {width!r} and {height!r}")
    sides = []
    for side in ("upper", "lower"):
        if not isinstance(content.get(side), list):
            raise DetectionError(f'{path} must have a list "{side}"')
        sides.append([_labelled_box(item, width, f"{path}, {side}[{i}]") for i, item in enumerate(content[side])])
        names = [item.name for item in sides[-1] if item.name is not None]
        if len(set(names)) < len(names):
            raise DetectionError(f"{path}: {side} has a name twice; names must be given once a side: {names}")
    boxes = StereoBoxes(width, height, *sides)
    for name, i, j in boxes.named_pairs():
        if boxes.upper[i].label != boxes.lower[j].label:
            raise DetectionError(
                f"{path}: {name!r} is a {boxes.upper[i].label} above and a {boxes.lower[j].label} below"
            )
    return boxes


def _labelled_box(item: object, width: int, where: str) -> LabelledBox:
    """Return one box of the file, from its entry."""
    try:
        box, label, name = np.array(item["box"], dtype=np.float64), canonical_label(item["label"]), item.get("name")
        if box.shape != (4,):
            raise ValueError("box must be of the shape [u_min, v_min, u_max, v_max]")
        if name is not None and not (isinstance(name, str) and name.strip()):
            raise ValueError("name must be a text that is not empty, or be left out")
        checked_boxes(box, width, "box")
        if box[1] < 0 or box[3] > width / 2:
            raise ValueError("box leaves the image at the top or bottom")
    except (TypeError, ValueError, KeyError, AttributeError) as error:
        raise DetectionError(f"{where} must be an object with label and box: {error}; got {str(item)[:80]}") from None
    return LabelledBox(label, tuple(wrapped_box(box, width).tolist()), name)
