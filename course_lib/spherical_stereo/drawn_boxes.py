"""Boxes drawn by hand on a pair of panoramas, and their file:

    {"version": 1, "width": 1024, "height": 512,
     "upper": [{"label": "chair", "box": [u_min, v_min, u_max, v_max], "name": "chair by the window"}, ...],
     "lower": [...]}

Boxes are in edge coordinates of images of that size. u_max passes the width if a box crosses the seam. `name` is the
object's name in tables, and may be left out.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from course_lib.files import read_json
from course_lib.spherical_stereo.detection.colour import Box, coloured
from course_lib.spherical_stereo.detection.detected_object import DetectionError, canonical_label, wrapped_box
from course_lib.spherical_stereo.panorama import View, open_pair

VERSION = 1


class LabelledBox(NamedTuple):
    """One box of the file. Its label is canonical, and 0 <= u_min < width."""

    label: str
    box: Box
    name: str | None


@dataclass(frozen=True)
class StereoBoxes:
    """The boxes of both images: anything with `label` and `box`."""

    size: tuple[int, int]  # (width, height) in pixels of the images that they were drawn on
    upper: Sequence[LabelledBox]
    lower: Sequence[LabelledBox]

    def on(self, upper_image: np.ndarray | View, lower_image: np.ndarray | View) -> tuple[View, View]:
        """Return both panoramas with the boxes as detections of score 1. Hue and saturation come from the images."""
        upper, lower = open_pair(upper_image, lower_image)
        if upper.size != self.size:
            raise DetectionError(
                f"the boxes were drawn on images of {self.size} pixels, these have {upper.size}: scale the images, or "
                "draw the boxes again"
            )
        return coloured(upper.replace(detections=self.upper)), coloured(lower.replace(detections=self.lower))


def read_stereo_boxes(path: str | Path) -> StereoBoxes:
    """Read a file of boxes drawn by hand (format: see the module)."""
    content = read_json(Path(path), "boxes file", DetectionError)
    where, sides = "the file", {}
    try:
        if content["version"] != VERSION:
            raise DetectionError(f"the version must be {VERSION}; got {content['version']!r}")
        size = View(content["width"], content["height"]).size
        for side in ("upper", "lower"):
            where, sides[side] = side, []
            for number, item in enumerate(content[side]):
                where = f"{side}[{number}]"
                box, name = wrapped_box(json_box(item["box"]), size[0]), item.get("name")
                if box[1] < 0 or box[3] > size[1]:
                    raise DetectionError(f"the box leaves the image at the top or bottom; got {item['box']}")
                if name is not None and not (isinstance(name, str) and name.strip()):
                    raise DetectionError(f"the name must be a text that is not empty; got {name!r}")
                sides[side].append(LabelledBox(canonical_label(item["label"]), tuple(box.tolist()), name))
    except (TypeError, ValueError, KeyError, AttributeError) as error:
        raise DetectionError(f"{path}: {where} does not have the format of a boxes file: {error!r}") from None
    return StereoBoxes(size, **sides)


def json_box(value: object) -> Box:
    """Return a box of a JSON file. Raises TypeError or ValueError for anything but four numbers."""
    u_min, v_min, u_max, v_max = map(json_number, value)
    return u_min, v_min, u_max, v_max


def json_number(value: object, kind: type = float):
    """Return a number of JSON as float or int. Raises TypeError for True, "3", and 3.5 where an int is expected."""
    if isinstance(value, bool) or not isinstance(value, (int, kind)):
        raise TypeError(f"a number of kind {kind.__name__} is expected, found {str(value)[:40]}")
    return kind(value)
