"""The exact boxes of a room's objects on a panorama, seen and unoccluded, from pictures of object numbers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from course_lib.simulation.sensors.panorama_renderer import BACKGROUND, PanoramaRenderer

Box = tuple[float, float, float, float]


@dataclass(frozen=True)
class ObjectBox:
    """Where one object is on a panorama.

    number: index into `room.objects`. visible_box: around the pixels that show it. unoccluded_box: around the pixels
    that would show it if nothing stood before it. visible_fraction: the first pixels' number over the second's. Boxes
    are (u_min, v_min, u_max, v_max) in edge coordinates, 0 <= u_min < width; u_max passes the width at the seam.
    """

    number: int
    label: str
    visible_box: Box
    unoccluded_box: Box
    visible_fraction: float

    def as_dict(self) -> dict:
        """For JSON: plain lists and numbers, boxes to a hundredth of a pixel."""
        return {
            "object": self.number,
            "label": self.label,
            "visible_box": [round(value, 2) for value in self.visible_box],
            "unoccluded_box": [round(value, 2) for value in self.unoccluded_box],
            "visible_fraction": round(self.visible_fraction, 4),
        }


def object_boxes(renderer: PanoramaRenderer, state: np.ndarray) -> list[ObjectBox]:
    """The boxes of all objects of which at least one pixel is seen, in the order of `room.objects`.

    state: `(6,)` pose of the camera, metres and radians.
    """
    numbers = renderer.render_objects(state)
    seen = np.flatnonzero(np.bincount(numbers.ravel(), minlength=BACKGROUND + 1)[:BACKGROUND])
    scale = numbers.shape[1] / renderer.width
    boxes = []
    for number in seen:
        visible = numbers == number
        whole = renderer.render_alone(state, int(number)) | visible
        boxes.append(
            ObjectBox(
                int(number),
                renderer.room.objects[number].label,
                box_around(visible, scale),
                box_around(whole, scale),
                float(visible.sum() / whole.sum()),
            )
        )
    return boxes


def box_around(mask: np.ndarray, scale: float = 1.0) -> Box:
    """The narrowest box around the True pixels of a panorama, across the seam where that is narrower.

    mask: `(h, w)` bool. scale: mask pixels per image pixel. Returns edge coordinates in image pixels.
    Raises `ValueError` when no pixel is True.
    """
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    if len(rows) == 0:
        raise ValueError("no pixel of the mask is True: there is nothing to put a box around.")
    width = mask.shape[1]
    # The box leaves out the widest run of empty columns on the circle.
    gaps = np.diff(columns, append=columns[0] + width)
    widest = int(np.argmax(gaps))
    u_min = columns[(widest + 1) % len(columns)]
    u_max = columns[widest] + 1
    if u_max <= u_min:
        u_max += width
    return (float(u_min / scale), float(rows[0] / scale), float(u_max / scale), float((rows[-1] + 1) / scale))
