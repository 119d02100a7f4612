"""Which cells and anchors answer for which object, and which are neither object nor background.

As in YOLOv4, every anchor whose shape is near enough to the object's answers for it, on every map; as scale_x_y lets a
box centre reach over the border of its cell, the nearest neighbour in each direction answers too. More answers to each
object make a short training possible.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import torch

from tools.detector_training.network import YoloHead


class Targets(NamedTuple):
    """The objects of a batch; ignored ones count neither as hits nor as false alarms."""

    image: torch.Tensor  # (n,) which image of the batch, int64
    label: torch.Tensor  # (n,) class number, int64
    boxes: torch.Tensor  # (n, 4) u, v of the centre, width, height, pixels of the network input
    ignored_image: torch.Tensor  # (m,)
    ignored_boxes: torch.Tensor  # (m, 4)


class Assignment(NamedTuple):
    """Who answers on one map: n entries, each one box of the network and its object, its index in `Targets`."""

    image: torch.Tensor
    anchor: torch.Tensor
    row: torch.Tensor
    column: torch.Tensor
    target: torch.Tensor


def make_targets(samples: list[tuple[np.ndarray, np.ndarray, np.ndarray]]) -> Targets:
    """Targets of a batch from (labels (n,), boxes (n, 4) [u_min, v_min, u_max, v_max], ignored (n,)) of each sample."""
    image = np.concatenate([np.full(len(labels), i) for i, (labels, _, _) in enumerate(samples)]).astype(np.int64)
    labels = np.concatenate([s[0] for s in samples]).astype(np.int64)
    corners = np.concatenate([s[1].reshape(-1, 4) for s in samples]).astype(np.float32)
    ignored = np.concatenate([s[2] for s in samples]).astype(bool)
    boxes = np.concatenate([(corners[:, :2] + corners[:, 2:]) / 2, corners[:, 2:] - corners[:, :2]], axis=1)
    taught = ~ignored
    return Targets(
        *map(torch.from_numpy, (image[taught], labels[taught], boxes[taught], image[ignored], boxes[ignored]))
    )


def shape_iou(sizes: torch.Tensor, anchors: torch.Tensor) -> torch.Tensor:
    """IoU (n, a) of boxes of `sizes` (n, 2) and `anchors` (a, 2), width and height, laid centre on centre."""
    shared = torch.minimum(sizes[:, None], anchors[None]).prod(-1)
    return shared / (sizes.prod(-1)[:, None] + anchors.prod(-1)[None] - shared)


def assign(targets: Targets, heads: list[YoloHead], grids: list[tuple[int, int, float]]) -> list[Assignment]:
    """The assignment on each map; `grids` gives its (rows, columns, stride in pixels).

    An anchor answers when its shape IoU exceeds the head's threshold, or when it is the best of all maps. Where two
    objects ask for the same box, the smaller one gets it: it has fewer boxes to choose from.
    """
    shapes = [shape_iou(targets.boxes[:, 2:], head.anchors) for head in heads]
    everything = torch.cat(shapes, dim=1)
    best = torch.zeros_like(everything, dtype=torch.bool)
    if len(everything):
        best[torch.arange(len(best)), everything.argmax(dim=1)] = True
    # Large objects first, so that the smaller ones overwrite them.
    order = torch.argsort(targets.boxes[:, 2:].prod(-1), descending=True)
    result = []
    first = 0
    for head, shape, (rows, columns, stride) in zip(heads, shapes, grids, strict=True):
        chosen = (shape > head.iou_threshold) | best[:, first : first + shape.shape[1]]
        first += shape.shape[1]
        target, anchor = torch.nonzero(chosen[order], as_tuple=True)
        target = order[target]
        centre = targets.boxes[target, :2] / stride
        cell = centre.floor()
        neighbour = torch.where(centre - cell < 0.5, -1.0, 1.0)
        none = torch.zeros(len(cell))
        cells = [cell]
        if head.scale_xy >= 2.0:
            # The neighbours come first: where boxes collide, the cell with the centre inside keeps its object.
            beside = cell + torch.stack([neighbour[:, 0], none], dim=1)
            above = cell + torch.stack([none, neighbour[:, 1]], dim=1)
            cells = [beside, above, cell]
        column, row = torch.cat(cells).long().unbind(1)
        target, anchor = target.repeat(len(cells)), anchor.repeat(len(cells))
        inside = (column >= 0) & (column < columns) & (row >= 0) & (row < rows)
        target, anchor, row, column = target[inside], anchor[inside], row[inside], column[inside]
        image = targets.image[target]
        key = ((image * len(head.anchors) + anchor) * rows + row) * columns + column
        last = _last_of_each(key)
        result.append(Assignment(image[last], anchor[last], row[last], column[last], target[last]))
    return result


def _last_of_each(key: torch.Tensor) -> torch.Tensor:
    """Positions of the last occurrence of each value."""
    if len(key) == 0:
        return key
    sorted_key, position = torch.sort(key, stable=True)
    is_last = torch.ones(len(key), dtype=torch.bool)
    is_last[:-1] = sorted_key[1:] != sorted_key[:-1]
    return position[is_last]


def not_background(
    boxes: torch.Tensor, image: int, targets: Targets, ignore_threshold: float, ignored_share: float = 0.5
) -> torch.Tensor:
    """Which of one image's boxes (k, 4) [centre, size] must not be taught to be background, (k,) boolean.

    Those that overlap an object by an IoU above `ignore_threshold`, and those of whose area more than `ignored_share`
    lies in an ignored object.
    """
    keep = torch.zeros(len(boxes), dtype=torch.bool)
    objects = targets.boxes[targets.image == image]
    if len(objects):
        shared = intersection(boxes, objects)
        union = boxes[:, 2:].prod(-1)[:, None] + objects[:, 2:].prod(-1)[None] - shared
        keep |= (shared / union).amax(dim=1) > ignore_threshold
    ignored = targets.ignored_boxes[targets.ignored_image == image]
    if len(ignored):
        keep |= (intersection(boxes, ignored) / boxes[:, 2:].prod(-1)[:, None]).amax(dim=1) > ignored_share
    return keep


def intersection(a: torch.Tensor, b: torch.Tensor) -> torch.Tensor:
    """Area (n, m) shared by boxes (n, 4) and (m, 4), given as centre u, v, width, height."""
    low = torch.maximum((a[:, :2] - a[:, 2:] / 2)[:, None], (b[:, :2] - b[:, 2:] / 2)[None])
    high = torch.minimum((a[:, :2] + a[:, 2:] / 2)[:, None], (b[:, :2] + b[:, 2:] / 2)[None])
    return (high - low).clamp(min=0).prod(-1)
