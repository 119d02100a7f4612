"""The colour of a box: the hues of its pixels, boxes close up, and how far measured colours are from the map's."""

from collections.abc import Sequence

import cv2
import numpy as np
from matplotlib.figure import Figure

from course_lib.lessons.kit.display import described
from course_lib.lessons.kit.room_photographs import room_map, room_recording
from course_lib.lessons.lesson_12.seam_cuts import outline
from course_lib.plots import figures
from course_lib.spherical_stereo.detection.colour import mean_hue_saturation

MIN_HEIGHT = 30  # pixels: smaller boxes are not measured
CROP = 220  # pixels of the square in which a box is shown


def part_of(box: Sequence[float], share: float) -> np.ndarray:
    """Return the box about the same centre with `share` of the width and of the height."""
    low, high = np.reshape(box, (2, 2))
    return np.concatenate([low + high - share * (high - low), low + high + share * (high - low)]) / 2


def hues_and_saturations(image_bgr: np.ndarray, box: Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
    """Return hue [degrees] and saturation [0 to 1] `(n,)` of every pixel with its centre in a box, also across the seam."""
    height, width = image_bgr.shape[:2]
    u_min, v_min, u_max, v_max = np.ceil(np.subtract(box, 0.5)).astype(int)
    rows, columns = (
        np.arange(max(v_min, 0), min(max(v_max, v_min + 1), height)),
        np.arange(u_min, max(u_max, u_min + 1)),
    )
    pixels = image_bgr[np.ix_(rows, columns % width)].astype(np.float32) / 255
    hsv = cv2.cvtColor(pixels, cv2.COLOR_BGR2HSV).reshape(-1, 3).astype(np.float64)
    return hsv[:, 0], hsv[:, 1]


def crop_of(image_bgr: np.ndarray, box: Sequence[float]) -> tuple[np.ndarray, np.ndarray, float]:
    """Return a square around a box `(CROP, CROP, 3)` RGB, its corner (u, v) and its side, pixels of the panorama.

    Columns go around the seam, rows beyond the image are white.
    """
    low, high = np.reshape(box, (2, 2))
    side = 1.25 * max(high - low)
    corner = (low + high - side) / 2
    height, width = image_bgr.shape[:2]
    columns, rows = np.floor(corner[:, None] + (np.arange(CROP) + 0.5) * side / CROP).astype(int)
    crop = image_bgr[np.ix_(np.clip(rows, 0, height - 1), columns % width, [2, 1, 0])]
    crop[(rows < 0) | (rows >= height)] = 255
    return crop, corner, side


def crops_figure(image_bgr: np.ndarray, boxes: dict[str, Sequence[float]]) -> Figure:
    """Some boxes close up, each with the central half in which its colour is measured."""
    figure, axes = figures.new_figure(1, len(boxes), size=(2.5 * len(boxes), 2.8))
    for a, (name, box) in zip(np.atleast_1d(axes), boxes.items(), strict=True):
        crop, corner, side = crop_of(image_bgr, box)
        a.imshow(crop, extent=(0, side, side, 0))
        for frame, dashes in ((box, "-"), (part_of(box, 0.5), "--")):
            a.plot(*(outline(frame) - corner).T, color="white", linewidth=3.2)
            a.plot(*(outline(frame) - corner).T, dashes, color=figures.BLACK, linewidth=1.6)
        a.grid(False)
        a.set(title=name, xlabel="columns [pixels]", ylabel="rows [pixels]")
    alt = "Three red sofas close up, each with its central half marked; a blue table covers much of the second one."
    return described(figure, alt)


def colours_against_map() -> np.ndarray:
    """Return rows (3, n): how far the hue of an exact box [degrees, NaN for grey] and its saturation [%] are from the
    map's, and the share of the object that is visible; of every object of experiment 1 that is large enough."""
    rows = []
    for pair in room_recording(1).pairs:
        image = pair.images()[0]
        for thing in pair.upper_objects:
            if thing.visible_box[3] - thing.visible_box[1] >= MIN_HEIGHT:
                hue, saturation = mean_hue_saturation(image, thing.visible_box)
                landmark = room_map().landmarks[thing.number]
                gap = abs((hue - landmark.hue + 180) % 360 - 180)
                rows.append((gap, abs(saturation - landmark.saturation), thing.visible_fraction))
    return np.array(rows).T
