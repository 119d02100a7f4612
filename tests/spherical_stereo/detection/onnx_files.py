"""The network of `blob_networks` as ONNX files."""

import numpy as np

from tests.spherical_stereo.detection.blob_networks import (
    BLOCK,
    INPUT_SIZE,
    SIZE,
    STRIDE,
    averaging_kernels,
    kernel,
    window_kernels,
)
from tests.spherical_stereo.detection.onnx_model import model, node


def blob_onnx(layout: str) -> bytes:
    """The network of `blob_networks` as an ONNX file with outputs in one of the three layouts."""
    width, height = INPUT_SIZE
    columns, rows = width // STRIDE, height // STRIDE
    cells = columns * rows
    x, y = np.meshgrid((np.arange(columns) + 0.5) * STRIDE, (np.arange(rows) + 0.5) * STRIDE)
    k = window_kernels()
    moments = [kernel(k["x"], 1, 1, -2), kernel(k["y"], 1, 1, -2)]
    if layout == "yolov4":
        box_kernels = [m / size for m, size in zip(moments * 2, (width, height) * 2, strict=True)]
        grid = np.array([(x - 16) / width, (y - 12) / height, (x + 16) / width, (y + 12) / height])
    else:
        box_kernels = [*moments, *np.zeros((2, 3, SIZE, SIZE))]
        grid = np.array([x, y, np.full_like(x, 32), np.full_like(y, 24)])
    match, colour = kernel(k["match"], 1, 1, -2) * 40, kernel(k["sum"], 1, -1, 0) * 30
    scores = np.array([match + colour, match - colour])
    biases = np.full(2, -12.0 - 30.0)
    if layout == "yolov5":
        scores, biases = np.array([match, colour, -colour]), np.array([-12.0, 0, 0])
    constants = {
        "averaging": averaging_kernels(),
        "box_kernels": np.array(box_kernels),
        "score_kernels": scores,
        "score_biases": biases,
        "grid": grid[None],
        "box_shape": np.array([1, 4, cells], dtype=np.int64),
        "score_shape": np.array([1, len(scores), cells], dtype=np.int64),
        "four_shape": np.array([1, cells, 1, 4], dtype=np.int64),
    }
    window = {"kernel_shape": [SIZE, SIZE], "strides": [STRIDE // BLOCK, STRIDE // BLOCK], "pads": [SIZE // 2] * 4}
    nodes = [
        node("Conv", ["image", "averaging"], "blocks", kernel_shape=[BLOCK, BLOCK], strides=[BLOCK, BLOCK]),
        node("Conv", ["blocks", "box_kernels"], "moments", **window),
        node("Add", ["moments", "grid"], "box_map"),
        node("Reshape", ["box_map", "box_shape"], "box_columns"),
        node("Conv", ["blocks", "score_kernels", "score_biases"], "score_map", **window),
        node("Sigmoid", ["score_map"], "probability_map"),
        node("Reshape", ["probability_map", "score_shape"], "score_columns"),
    ]
    if layout == "yolov4":
        nodes += [
            node("Transpose", ["box_columns"], "box_rows", perm=[0, 2, 1]),
            node("Reshape", ["box_rows", "four_shape"], "boxes"),
            node("Transpose", ["score_columns"], "confs", perm=[0, 2, 1]),
        ]
        outputs = {"boxes": (1, cells, 1, 4), "confs": (1, cells, 2)}
    elif layout == "yolov8":
        nodes += [node("Concat", ["box_columns", "score_columns"], "output", axis=1)]
        outputs = {"output": (1, 6, cells)}
    else:
        nodes += [
            node("Concat", ["box_columns", "score_columns"], "columns", axis=1),
            node("Transpose", ["columns"], "output", perm=[0, 2, 1]),
        ]
        outputs = {"output": (1, cells, 7)}
    if layout != "yolov4":
        constants.pop("four_shape")
    return model(nodes, constants, {"image": (1, 3, height, width)}, outputs)
