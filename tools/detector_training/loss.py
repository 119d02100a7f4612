"""What the network is trained to make small: YOLOv4's loss, box overlap (CIoU), objectness and class.

    L = (5 sum (1 - CIoU) + sum BCE(objectness) + sum BCE(class)) / number of assigned boxes

The sums of the first and last term run over the assigned boxes, the second over all that are objects or background.
The objectness of an assigned box is taught to be its CIoU, so that of two boxes on one object the better one scores
higher and non-maximum suppression keeps it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import torch
from torch.nn.functional import binary_cross_entropy_with_logits as cross_entropy

from tools.detector_training.assignment import Targets, assign, not_background
from tools.detector_training.network import YoloHead, decode_boxes

# How much the terms count (chosen: 5, 1, 1, all divided by the number of assigned boxes, as YOLOX does).
BOX_WEIGHT = 5.0
# A class is taught to have the chance 1 - s/2, the others s/2: nothing is certain in an image.
LABEL_SMOOTHING = 0.01


@dataclass(frozen=True)
class Loss:
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
        counts = _counts_as_background(decoded, head, targets)
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


@torch.no_grad()
def _counts_as_background(decoded: torch.Tensor, head: YoloHead, targets: Targets) -> torch.Tensor:
    """Boxes (b, a, rows, columns), boolean, that the objectness term sees."""
    flat = decoded.flatten(1, 3)
    kept = [not_background(flat[image], image, targets, head.ignore_threshold) for image in range(len(flat))]
    return ~torch.stack(kept).view(decoded.shape[:-1])
