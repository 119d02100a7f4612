"""What the network is trained to make small: YOLOv4's loss, box overlap (CIoU), objectness and class.

    L = (5 sum (1 - CIoU) + sum BCE(objectness) + sum BCE(class)) / number of assigned boxes

The sums of the first and last term run over the assigned boxes, the second over all that are objects or background.
The objectness of an assigned box is taught to be its CIoU, so that of two boxes on one object the better one scores
higher and non-maximum suppression keeps it.

As in YOLOv4, every anchor whose shape is near enough to the object's answers for it, on every map; as scale_x_y lets a
box centre reach over its cell's border, the nearest neighbour in each direction answers too: a short training suffices.
"""

import math
from typing import NamedTuple

import numpy as np
import torch
from torch.nn.functional import binary_cross_entropy_with_logits as cross_entropy

from tools.detector_training.network import YoloHead, decode_boxes

# How much the terms count (chosen: 5, 1, 1, all divided by the number of assigned boxes, as YOLOX does).
BOX_WEIGHT = 5.0
# A class is taught to have the chance 1 - s/2, the others s/2: nothing is certain in an image.
LABEL_SMOOTHING = 0.01


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

    An anchor answers when its shape IoU exceeds the head's threshold, or is the best of all maps. Where two objects
    ask for the same box, the smaller one gets it.
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
        last = len(key) - 1 - np.unique(key.flip(0).numpy(), return_index=True)[1]  # of each key
        result.append(Assignment(image[last], anchor[last], row[last], column[last], target[last]))
    return result


def not_background(boxes: torch.Tensor, image: int, targets: Targets, ignore_threshold: float) -> torch.Tensor:
    """Which of one image's boxes (k, 4) [centre, size] must not be taught to be background, (k,) boolean.

    Those that overlap an object by an IoU above `ignore_threshold`, and those that lie by half in an ignored object.
    """
    keep = torch.zeros(len(boxes), dtype=torch.bool)
    objects = targets.boxes[targets.image == image]
    if len(objects):
        shared = intersection(boxes, objects)
        union = boxes[:, 2:].prod(-1)[:, None] + objects[:, 2:].prod(-1)[None] - shared
        keep |= (shared / union).amax(dim=1) > ignore_threshold
    ignored = targets.ignored_boxes[targets.ignored_image == image]
    if len(ignored):
        keep |= (intersection(boxes, ignored) / boxes[:, 2:].prod(-1)[:, None]).amax(dim=1) > 0.5
    return keep


def intersection(a: torch.Tensor, b: torch.Tensor) -> torch.Tensor:
    """Area (n, m) shared by boxes (n, 4) and (m, 4), given as centre u, v, width, height."""
    low = torch.maximum((a[:, :2] - a[:, 2:] / 2)[:, None], (b[:, :2] - b[:, 2:] / 2)[None])
    high = torch.minimum((a[:, :2] + a[:, 2:] / 2)[:, None], (b[:, :2] + b[:, 2:] / 2)[None])
    return (high - low).clamp(min=0).prod(-1)


class Loss(NamedTuple):
    """The loss of one batch and its parts."""

    total: torch.Tensor
    box: float
    objectness: float
    classes: float


def complete_iou(boxes: torch.Tensor, targets: torch.Tensor) -> torch.Tensor:
    """CIoU (n,) of boxes and targets (n, 4), each u, v of the centre, width, height in pixels.

    CIoU = IoU - d^2 / c^2 - a v,   v = 4 / pi^2 (atan(w / h) - atan(w' / h'))^2,   a = v / (1 - IoU + v),

    where d is the distance of the centres and c the diagonal of the smallest box around both (Zheng et al. 2020, which
    YOLOv4 uses). It is 1 for equal boxes and falls with the distance of boxes that do not meet.
    """
    low_a, high_a = boxes[:, :2] - boxes[:, 2:] / 2, boxes[:, :2] + boxes[:, 2:] / 2
    low_b, high_b = targets[:, :2] - targets[:, 2:] / 2, targets[:, :2] + targets[:, 2:] / 2
    shared = (torch.minimum(high_a, high_b) - torch.maximum(low_a, low_b)).clamp(min=0).prod(-1)
    union = boxes[:, 2:].prod(-1) + targets[:, 2:].prod(-1) - shared
    iou = shared / union.clamp(min=1e-6)
    around = (torch.maximum(high_a, high_b) - torch.minimum(low_a, low_b)).square().sum(-1)
    apart = (boxes[:, :2] - targets[:, :2]).square().sum(-1)
    angle = torch.atan2(boxes[:, 2], boxes[:, 3]) - torch.atan2(targets[:, 2], targets[:, 3])
    v = (4.0 / math.pi**2) * angle.square()
    with torch.no_grad():
        a = v / (1.0 - iou + v).clamp(min=1e-6)
    return iou - apart / around.clamp(min=1e-6) - a * v


def yolo_loss(outputs: list[torch.Tensor], heads: list[YoloHead], targets: Targets, input_width: int) -> Loss:
    """The loss of the raw maps of a batch (as `TrainableNetwork` gives them) against its objects.

    Boxes that overlap an object well without being assigned to it, and boxes inside ignored objects, are left out of
    the objectness term. `input_width`: pixels.
    Source: paper 2, section 2.2 (its detector is YOLOv4).
    """
    grids = [(raw.shape[-2], raw.shape[-1], input_width / raw.shape[-1]) for raw in outputs]
    box_sum = objectness_sum = class_sum = torch.zeros(())
    n_assigned = 0
    for raw, head, grid, found in zip(outputs, heads, grids, assign(targets, heads, grids), strict=True):
        raw = raw.float()
        decoded = decode_boxes(raw, head, grid[2])
        wanted = torch.zeros_like(raw[:, :, 4])
        boxes = decoded.detach().flatten(1, 3)
        kept = [not_background(one, k, targets, head.ignore_threshold) for k, one in enumerate(boxes)]
        counts = ~torch.stack(kept).view(decoded.shape[:-1])  # boxes that the objectness term sees
        if len(found.target):
            where = (found.image, found.anchor, found.row, found.column)
            overlap = complete_iou(decoded[where], targets.boxes[found.target])
            box_sum = box_sum + (1.0 - overlap).sum()
            wanted[where] = overlap.detach().clamp(min=0)
            counts[where] = True
            chance = raw[found.image, found.anchor, 5:, found.row, found.column]
            labels = torch.full_like(chance, LABEL_SMOOTHING / 2)
            labels[torch.arange(len(labels)), targets.label[found.target]] = 1.0 - LABEL_SMOOTHING / 2
            class_sum = class_sum + cross_entropy(chance, labels, reduction="sum")
            n_assigned += len(found.target)
        objectness_sum = objectness_sum + (cross_entropy(raw[:, :, 4], wanted, reduction="none") * counts).sum()
    # A batch without objects still teaches what background is.
    n = max(n_assigned, 1)
    box, objectness, classes = BOX_WEIGHT * box_sum / n, objectness_sum / n, class_sum / n
    return Loss(box + objectness + classes, box.item(), objectness.item(), classes.item())
