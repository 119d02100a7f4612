"""The loss: its overlap, who answers for an object, and what is neither object nor background."""

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="PyTorch, which only the training of the detector needs, is not installed")

from tools.detector_training.loss import assign, complete_iou, make_targets, yolo_loss  # noqa: E402
from tools.detector_training.network import YoloHead  # noqa: E402

WIDTH, ROWS, COLUMNS, STRIDE, CLASSES = 160, 4, 10, 16.0, 7
HEAD = YoloHead(
    anchors=torch.tensor([[20.0, 20.0], [40.0, 20.0], [60.0, 50.0]]),
    classes=CLASSES,
    scale_xy=2.0,
    iou_threshold=0.213,
    ignore_threshold=0.7,
)


def targets(boxes, labels=None, ignored=None):
    boxes = np.array(boxes, float).reshape(-1, 4)
    labels = np.zeros(len(boxes), int) if labels is None else np.array(labels)
    return make_targets([(labels, boxes, np.zeros(len(boxes), bool) if ignored is None else np.array(ignored))])


def empty_map(requires_grad=False):
    raw = torch.zeros(1, 3, 5 + CLASSES, ROWS, COLUMNS)
    raw[:, :, 4:] = -4.0
    return raw.requires_grad_(requires_grad)


def random_boxes(n, seed=0):
    generator = torch.Generator().manual_seed(seed)
    return torch.rand(n, 4, generator=generator) * torch.tensor([100.0, 50.0, 40.0, 30.0]) + 5.0


def test_complete_iou_is_one_for_equal_boxes_symmetric_and_never_above_one():
    a, b = random_boxes(200, 1), random_boxes(200, 2)
    torch.testing.assert_close(complete_iou(a, a), torch.ones(200))
    torch.testing.assert_close(complete_iou(a, b), complete_iou(b, a))
    assert float(complete_iou(a, b).max()) <= 1.0


def test_the_cell_of_the_centre_and_its_two_nearest_neighbours_answer():
    # Centre (70, 36): cell column 4, row 2; nearer to column 3 than 5 (70 / 16 = 4.4) and to row 1 than 3.
    (found,) = assign(targets([[60, 26, 80, 46]]), [HEAD], [(ROWS, COLUMNS, STRIDE)])
    cells = set(zip(found.column[found.anchor == 0].tolist(), found.row[found.anchor == 0].tolist(), strict=True))
    assert cells == {(4, 2), (3, 2), (4, 1)}


def test_where_two_objects_collide_the_smaller_one_is_answered_for():
    (found,) = assign(targets([[58, 24, 82, 48], [60, 26, 80, 46]]), [HEAD], [(ROWS, COLUMNS, STRIDE)])
    centre = (found.column == 4) & (found.row == 2) & (found.anchor == 0)
    assert found.target[centre].tolist() == [1]


def test_the_gradient_raises_the_right_class_and_the_objectness_of_the_object():
    raw = empty_map(requires_grad=True)
    yolo_loss([raw], [HEAD], targets([[60, 26, 80, 46]], labels=[3]), WIDTH).total.backward()
    gradient = raw.grad[0, 0, :, 2, 4]
    assert gradient[4] < 0
    assert gradient[5 + 3] < 0
    assert (np.delete(gradient[5:].numpy(), 3) > 0).all()
    # Far away is background: objectness is pushed down, and box and class are left alone.
    far = raw.grad[0, 0, :, 0, 9]
    assert far[4] > 0
    assert far[:4].abs().sum() == 0
    assert far[5:].abs().sum() == 0


def test_boxes_in_an_ignored_object_are_not_taught_to_be_background():
    raw = empty_map(requires_grad=True)
    yolo_loss([raw], [HEAD], targets([[90, 0, 160, 40]], ignored=[True]), WIDTH).total.backward()
    assert raw.grad[0, 0, 4, 1, 7] == 0
    assert raw.grad[0, 0, 4, 3, 1] > 0
