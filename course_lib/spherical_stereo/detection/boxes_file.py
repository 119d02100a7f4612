"""Boxes drawn by hand on a stereo pair of panoramas, as JSON: detections for images that no network was trained on.

    {"version": 1, "width": 1024, "height": 512,
     "upper": [{"label": "chair", "box": [u_min, v_min, u_max, v_max], "name": "chair by the window"}, ...],
     "lower": [...]}

Boxes are in edge coordinates of images of that size. u_max passes the width if a box crosses the seam. `name` is what
tables call the object, and may be left out.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from course_lib.files import read_json
from course_lib.spherical_stereo.detection.colour import Box, mean_hue_saturation
from course_lib.spherical_stereo.detection.detected_object import (
    Detection,
    DetectionError,
    canonical_label,
    wrapped_box,
)
from course_lib.spherical_stereo.panorama import View, open_pair

VERSION = 1


class LabelledBox(NamedTuple):
    """One box of the file. Its label is canonical, and 0 <= u_min < width."""

    label: str
    box: Box
    name: str | None


@dataclass(frozen=True)
class StereoBoxes:
    """The boxes of both images, and the size (width, height) in pixels of the images that they were drawn on."""

    size: tuple[int, int]
    upper: list[LabelledBox]
    lower: list[LabelledBox]

    def on(self, upper_image: np.ndarray | View, lower_image: np.ndarray | View) -> tuple[View, View]:
        """Return both panoramas with the boxes as detections of score 1. Hue and saturation come from the images."""
        views = open_pair(upper_image, lower_image)
        if views[0].size != self.size:
            raise DetectionError(
                f"the boxes were drawn on images of {self.size} pixels, these have {views[0].size}: scale the images, "
                "or draw the boxes again"
            )
        filled = []
        for view, side in zip(views, (self.upper, self.lower), strict=True):
            found = [Detection(one.label, 1.0, one.box, *mean_hue_saturation(view.image, one.box)) for one in side]
            filled.append(view.replace(detections=found))
        return tuple(filled)


def read_stereo_boxes(path: str | Path) -> StereoBoxes:
    """Read a boxes file (format: see the module)."""
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
                box, name = wrapped_box(np.array(item["box"], dtype=np.float64).reshape(4), size[0]), item.get("name")
                if box[1] < 0 or box[3] > size[1]:
                    raise DetectionError(f"the box leaves the image at the top or bottom; got {item['box']}")
                if name is not None and not (isinstance(name, str) and name.strip()):
                    raise DetectionError(f"the name must be a text that is not empty; got {name!r}")
                sides[side].append(LabelledBox(canonical_label(item["label"]), tuple(box.tolist()), name))
    except (TypeError, ValueError, KeyError, AttributeError) as error:
        raise DetectionError(f"{path}: {where} does not have the format of a boxes file: {error!r}") from None
    return StereoBoxes(size, **sides)
