"""What the detector learned from: a picture of its training with the exact boxes, and the shapes that answer for one.

The training itself is `tools.detector_training`, which needs PyTorch; a lesson does not.
"""

import json
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from course_lib.lessons.lesson_12.figures import brighter, class_legend
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
    boxes: np.ndarray
    """`(n, 4)` exact boxes, pixels of the photograph."""


def training_picture() -> TrainingPicture:
    """The stored picture with the objects that the training asks for: at least half visible, largest first."""
    folder = data_path("detector/training_picture")
    (entry,) = json.loads((folder / "boxes.json").read_text(encoding="utf-8"))["images"]
    things = [thing for thing in map(true_object, entry["objects"]) if thing.visible_fraction >= 0.5]
    things.sort(key=lambda thing: -np.prod(np.subtract(thing.visible_box[2:], thing.visible_box[:2])))
    boxes = np.array([thing.visible_box for thing in things])
    return TrainingPicture(read_panorama(folder / entry["file"]), [thing.label for thing in things], boxes)


def anchors() -> tuple[np.ndarray, np.ndarray]:
    """The network's nine shapes `(9, 2)`, width and height in pixels of its input, and the grid (stride) of each."""
    heads = [s for s in read_cfg(next(data_path("detector").glob("*.cfg"))) if s.kind == "yolo"]
    shapes, strides = np.array(heads[0].integers("anchors")).reshape(-1, 2), np.zeros(9, dtype=int)
    for head, stride in zip(heads, (32, 16, 8), strict=True):
        strides[head.integers("mask")] = stride
    return shapes, strides


def training_figure(taught: TrainingPicture, chosen: int) -> Figure:
    """The picture with its exact boxes; close up, one object, the cells that answer for it, and their three shapes."""
    shapes, strides = anchors()
    box = taught.boxes[chosen]
    size, centre = box[2:] - box[:2], (box[:2] + box[2:]) / 2
    best = np.argmax(shape_overlap(INPUT_SCALE * size[None], shapes)[0])
    cell = strides[best] / INPUT_SCALE
    figure, (whole, close) = figures.new_figure(1, 2, size=(8.6, 3.4))
    whole.get_gridspec().set_width_ratios([2.2, 1])
    panorama(whole, brighter(taught.image), "A picture of the training, and what is asked for")
    for other, label in zip(taught.boxes, taught.labels, strict=True):
        draw_box(whole, other, taught.image.shape[1], label)
    low, high = centre - 80, centre + 80
    close.imshow(brighter(taught.image)[..., ::-1], extent=(0, taught.image.shape[1], taught.image.shape[0], 0))
    close.set(xlim=(low[0], high[0]), ylim=(high[1], low[1]), xlabel="column u [pixels]", ylabel="row v [pixels]")
    close.set_title(f"{taught.labels[chosen].capitalize()}: cells, shapes")
    close.grid(False)
    for edge in np.arange(np.floor(low.min() / cell), np.ceil(high.max() / cell) + 1) * cell:
        close.axvline(edge, color="white", linewidth=0.4)
        close.axhline(edge, color="white", linewidth=0.4)
    for corner in answering_cells(centre / cell) * cell:
        close.add_patch(Rectangle(corner, cell, cell, color=YELLOW, alpha=0.55, linewidth=0))
    for k in np.flatnonzero(strides == strides[best]):
        width, height = shapes[k] / INPUT_SCALE
        corner = centre - [width / 2, height / 2]
        look = {"edgecolor": VERMILION if k == best else BLACK, "linewidth": 2.0 if k == best else 1.2}
        close.add_patch(Rectangle(corner, width, height, fill=False, linestyle="--", **look))
    frame = {"edgecolor": class_style(taught.labels[chosen])[0], "linewidth": 2.4, "fill": False}
    close.add_patch(Rectangle(box[:2], *size, **frame))
    class_legend(figure, taught.labels)
    return figure


def shape_overlap(sizes: np.ndarray, shapes: np.ndarray) -> np.ndarray:
    """IoU `(n, m)` of boxes of sizes `(n, 2)` and `(m, 2)`, laid centre on centre."""
    shared = np.minimum(sizes[:, None], shapes).prod(axis=-1)
    return shared / (sizes.prod(axis=-1)[:, None] + shapes.prod(axis=-1) - shared)


def answering_cells(centre: np.ndarray) -> np.ndarray:
    """The three cells `(3, 2)` (column, row) that answer for a centre in cells: its own and its nearest neighbours."""
    own = np.floor(centre)
    beside, above = np.where(centre - own < 0.5, -1, 1)
    return own + np.array([[0, 0], [beside, 0], [0, above]])
