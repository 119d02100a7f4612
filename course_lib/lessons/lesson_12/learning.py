"""What the detector learned from: a picture of its training with the exact boxes, and the shapes that answer for one.

The training itself is `tools.detector_training`, which needs PyTorch; a lesson does not.
"""

import json
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from course_lib.lessons.kit.display import described
from course_lib.lessons.lesson_12.seam_cuts import brighter, class_legend
from course_lib.paths import data_path
from course_lib.plots import figures
from course_lib.plots.figures import BLACK, VERMILION, YELLOW
from course_lib.plots.panorama_drawing import class_style, draw_box, panorama
from course_lib.spherical_stereo.detection.darknet import read_cfg
from course_lib.spherical_stereo.panorama import read_panorama
from course_lib.spherical_stereo.recording import true_object

INPUT_SCALE = 0.8  # pixels of the network's input per pixel of a panorama 1280 wide


class TrainingPicture(NamedTuple):
    """A photograph `(H, W, 3)` uint8 BGR of a generated room, and what can be seen on it."""

    image: np.ndarray
    labels: list[str]
    boxes: np.ndarray  # `(n, 4)` exact boxes, pixels of the photograph


def training_picture() -> TrainingPicture:
    """Return the stored picture with the objects that the training asks for: at least half visible, largest first."""
    folder = data_path("detector/training_picture")
    (entry,) = json.loads((folder / "boxes.json").read_text(encoding="utf-8"))["images"]
    things = [thing for thing in map(true_object, entry["objects"]) if thing.visible_fraction >= 0.5]
    things.sort(key=lambda thing: -np.prod(np.subtract(thing.visible_box[2:], thing.visible_box[:2])))
    boxes = np.array([thing.visible_box for thing in things])
    return TrainingPicture(read_panorama(folder / entry["file"]), [thing.label for thing in things], boxes)


def anchors() -> tuple[np.ndarray, np.ndarray]:
    """Return the network's nine shapes `(9, 2)`, width and height in pixels of its input, and the stride of each."""
    heads = [s for s in read_cfg(next(data_path("detector").glob("*.cfg"))) if s.kind == "yolo"]
    shapes, strides = np.array(heads[0].integers("anchors")).reshape(-1, 2), np.zeros(9, dtype=int)
    for head, stride in zip(heads, (32, 16, 8), strict=True):
        strides[head.integers("mask")] = stride
    return shapes, strides


def training_figure(taught: TrainingPicture, chosen: int) -> Figure:
    """The picture with its exact boxes; close up, one object, the cells that answer for it, and their three shapes."""
    label, (low, high) = taught.labels[chosen], taught.boxes[chosen].reshape(2, 2)
    shapes, strides = anchors()
    shapes = shapes / INPUT_SCALE
    size, centre = high - low, (low + high) / 2
    shared = np.minimum(size, shapes).prod(axis=1)
    best = np.argmax(shared / (size.prod() + shapes.prod(axis=1) - shared))
    cell = strides[best] / INPUT_SCALE

    figure, (whole, close) = figures.new_figure(1, 2, size=(8.6, 3.4))
    whole.get_gridspec().set_width_ratios([2.2, 1])
    height, width = taught.image.shape[:2]
    panorama(whole, brighter(taught.image), "A picture of the training, and what is asked for")
    for other, name in zip(taught.boxes, taught.labels, strict=True):
        draw_box(whole, other, width, name)
    close.imshow(brighter(taught.image)[..., ::-1], extent=(0, width, height, 0))
    close.grid(False)
    for draw_line, middle in ((close.axvline, centre[0]), (close.axhline, centre[1])):
        for k in range(int((middle - 80) // cell), int((middle + 80) // cell) + 2):
            draw_line(k * cell, color="white", linewidth=0.4)
    close.set(xlim=centre[0] + [-80, 80], ylim=centre[1] + [80, -80], title=f"{label.capitalize()}: cells, shapes")
    close.set(xlabel="column u [pixels]", ylabel="row v [pixels]")
    own = np.floor(centre / cell)  # the cell of the centre, beside and above or below it the nearest ones
    beside, above = np.where(centre / cell - own < 0.5, -1, 1)
    for corner in own + [[0, 0], [beside, 0], [0, above]]:
        close.add_patch(Rectangle(corner * cell, cell, cell, color=YELLOW, alpha=0.55, linewidth=0))
    for k in np.flatnonzero(strides == strides[best]):
        look = {"edgecolor": VERMILION, "linewidth": 2.0} if k == best else {"edgecolor": BLACK, "linewidth": 1.2}
        close.add_patch(Rectangle(centre - shapes[k] / 2, *shapes[k], fill=False, linestyle="--", **look))
    close.add_patch(Rectangle(low, *size, edgecolor=class_style(label)[0], linewidth=2.4, fill=False))
    class_legend(figure, taught.labels)
    alt = (
        "A photograph of a generated room with the exact boxes of its furniture; close up, a plant over a grid of "
        "cells, three of them marked, and three dashed rectangles of different shape about its centre."
    )
    return described(figure, alt)
