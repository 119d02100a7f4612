"""Boxes drawn by hand on a stereo pair of panoramas, as JSON: detections for images that no network was trained on.

    {"version": 1, "width": 1024, "height": 512,
     "upper": [{"label": "chair", "box": [u_min, v_min, u_max, v_max], "name": "chair by the window"}, ...],
     "lower": [...]}

Boxes are in edge coordinates of images of that size; u_max passes the width when a box crosses the seam. `name` may be
left out; the same name in "upper" and "lower" says that the two boxes show one object, for checking a matcher.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from course_lib.files import read_json
from course_lib.spherical_stereo.detection.boxes import DetectionError, checked_boxes, wrapped_box
from course_lib.spherical_stereo.detection.colour import mean_hue_saturation
from course_lib.spherical_stereo.detection.detected_object import Detection
from course_lib.spherical_stereo.detection.labels import canonical_label
from course_lib.spherical_stereo.panorama import View, open_pair

VERSION = 1


@dataclass(frozen=True)
class LabelledBox:
    """A box drawn by hand."""

    label: str
    """Canonical label."""
    box: tuple[float, float, float, float]
    """(u_min, v_min, u_max, v_max), pixels, edge coordinates, 0 <= u_min < width."""
    name: str | None = None
    """Name of the object, one on each side; None: not given."""


@dataclass(frozen=True)
class StereoBoxes:
    """The boxes of both images."""

    width: int
    """Width of the images that the boxes were drawn on, pixels."""
    height: int
    """Their height, pixels."""
    upper: list[LabelledBox]
    """Boxes on the upper camera's image."""
    lower: list[LabelledBox]
    """Boxes on the lower camera's image."""

    def named_pairs(self) -> list[tuple[str, int, int]]:
        """(name, index in `upper`, index in `lower`) of every object named on both sides, in the order of `upper`."""
        lower = {item.name: index for index, item in enumerate(self.lower) if item.name is not None}
        return [(item.name, index, lower[item.name]) for index, item in enumerate(self.upper) if item.name in lower]

    def on(self, upper_image: np.ndarray | View, lower_image: np.ndarray | View) -> tuple[View, View]:
        """Both panoramas with the boxes as their detections of score 1, hue and saturation measured in the images.

        Raises DetectionError: images of another size than the boxes'; PanoramaError as `open_pair`.
        """
        views = open_pair(upper_image, lower_image)
        if views[0].size != (self.width, self.height):
            raise DetectionError(
                f"the boxes were drawn on images of {self.width} x {self.height}, these are {views[0].width} x "
                f"{views[0].height}: scale the images, or draw the boxes again"
            )
        upper, lower = (
            view.having(detections=[_detection(item, view) for item in items])
            for view, items in zip(views, (self.upper, self.lower), strict=True)
        )
        return upper, lower


def _detection(item: LabelledBox, view: View) -> Detection:
    return Detection(item.label, 1.0, item.box, *mean_hue_saturation(view.image, item.box))


def read_stereo_boxes(path: str | Path) -> StereoBoxes:
    """Read a boxes file (format: see the module).

    Raises DetectionError: the file is missing or not JSON, another version, a field that is missing or of the wrong
    kind, a box that is none or leaves the image, a name that is given twice on one side or to two classes.
    """
    path = Path(path)
    content = read_json(path, "boxes file", DetectionError)
    if not isinstance(content, dict) or content.get("version") != VERSION:
        version = content.get("version") if isinstance(content, dict) else None
        raise DetectionError(f"{path} must be an object with version {VERSION}; got version {version!r}")
    width, height = content.get("width"), content.get("height")
    if not (isinstance(width, int) and isinstance(height, int) and height > 0 and width == 2 * height):
        raise DetectionError(f"{path} must have whole numbers width = 2 height; got {width!r} and {height!r}")
    upper, lower = (_read_side(content, side, (width, height), path) for side in ("upper", "lower"))
    labels = {item.name: item.label for item in upper if item.name is not None}
    for item in lower:
        if labels.get(item.name, item.label) != item.label:
            raise DetectionError(f"{path}: {item.name!r} is a {labels[item.name]} above and a {item.label} below")
    return StereoBoxes(width, height, upper, lower)


def _read_side(content: dict, side: str, size: tuple[int, int], path: Path) -> list[LabelledBox]:
    items = content.get(side)
    if not isinstance(items, list):
        raise DetectionError(f'{path} must have a list "{side}"; got {type(items).__name__}')
    boxes = [_read_box(item, size, f"{path}, {side}[{index}]") for index, item in enumerate(items)]
    names = [item.name for item in boxes if item.name is not None]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise DetectionError(f"{path}: names must be given once a side; {side} has these twice: {', '.join(twice)}")
    return boxes


def _read_box(item: object, size: tuple[int, int], where: str) -> LabelledBox:
    if not isinstance(item, dict) or "label" not in item or "box" not in item:
        raise DetectionError(f"{where} must be an object with label and box; got {item!r}")
    name = item.get("name")
    if name is not None and not (isinstance(name, str) and name.strip()):
        raise DetectionError(f"{where}: name must be a text that is not empty, or be left out; got {name!r}")
    try:
        box = np.array(item["box"], dtype=np.float64)
        label = canonical_label(item["label"])
    except DetectionError:
        raise
    except (TypeError, ValueError) as error:
        raise DetectionError(f"{where}: {error}") from None
    if box.shape != (4,):
        raise DetectionError(
            f"{where}: box must be of the shape [u_min, v_min, u_max, v_max]; got {str(item['box'])[:80]}"
        )
    box = checked_boxes(box, size[0], where)
    if box[1] < 0 or box[3] > size[1]:
        raise DetectionError(
            f"{where}: box leaves the image at the top or bottom, v from 0 to {size[1]}; got {item['box']}"
        )
    return LabelledBox(label, tuple(wrapped_box(box, size[0]).tolist()), name)
