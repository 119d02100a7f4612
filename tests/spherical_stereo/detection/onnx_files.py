"""The network of `blob_networks` as ONNX files, written by hand: the few fields of the format that it needs.

The format is protocol buffers: a field is a key (number * 8 + wire type) and a value, type 0 a varint, type 2 a length
and bytes.
"""

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

FLOAT, INT64 = 1, 7  # TensorProto.DataType
INTS_ATTRIBUTE, INT_ATTRIBUTE = 7, 2  # AttributeProto.AttributeType


def varint(value: int) -> bytes:
    return bytes([value]) if value < 128 else bytes([value & 127 | 128]) + varint(value >> 7)


def message(*fields: tuple[int, int | bytes | str]) -> bytes:
    """Return the bytes of fields (number, value)."""
    out = b""
    for number, value in fields:
        if isinstance(value, int):
            out += varint(number << 3) + varint(value)
        else:
            data = value.encode() if isinstance(value, str) else value
            out += varint(number << 3 | 2) + varint(len(data)) + data
    return out


def tensor(name: str, values: np.ndarray) -> bytes:
    kind, data = (INT64, values) if values.dtype == np.int64 else (FLOAT, values.astype("<f4"))
    return message(*((1, size) for size in values.shape), (2, kind), (8, name), (9, data.tobytes()))


def attribute(name: str, value: int | list[int]) -> bytes:
    if isinstance(value, int):
        return message((1, name), (3, value), (20, INT_ATTRIBUTE))
    return message((1, name), *((8, item) for item in value), (20, INTS_ATTRIBUTE))


def node(operation: str, inputs: list[str], output: str, **attributes: int | list[int]) -> bytes:
    options = ((5, attribute(name, value)) for name, value in attributes.items())
    return message(*((1, name) for name in inputs), (2, output), (3, output), (4, operation), *options)


def value_info(name: str, *shape: int) -> bytes:
    tensor_type = message((1, FLOAT), (2, message(*((1, message((1, size))) for size in shape))))
    return message((1, name), (2, message((1, tensor_type))))


def blob_onnx() -> bytes:
    width, height = INPUT_SIZE
    columns, rows = width // STRIDE, height // STRIDE
    x, y = np.meshgrid((np.arange(columns) + 0.5) * STRIDE, (np.arange(rows) + 0.5) * STRIDE)
    k = window_kernels()
    match, colour = kernel(k["match"], 1, 1, -2) * 40, kernel(k["sum"], 1, -1, 0) * 30
    constants = {
        "averaging": averaging_kernels(),
        "box_kernels": np.array([kernel(k["x"], 1, 1, -2), kernel(k["y"], 1, 1, -2), *np.zeros((2, 3, SIZE, SIZE))]),
        "score_kernels": np.array([match + colour, match - colour]),
        "score_biases": np.full(2, -12.0 - 30.0),
        "grid": np.array([[x, y, np.full_like(x, 32), np.full_like(y, 24)]]),
        "box_shape": np.array([1, 4, columns * rows], dtype=np.int64),
        "score_shape": np.array([1, 2, columns * rows], dtype=np.int64),
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
        node("Concat", ["box_columns", "score_columns"], "output", axis=1),
    ]
    tensors = ((5, tensor(name, values)) for name, values in constants.items())
    ends = (11, value_info("image", 1, 3, height, width)), (12, value_info("output", 1, 6, columns * rows))
    graph = message(*((1, item) for item in nodes), (2, "blobs"), *tensors, *ends)
    return message((1, 7), (8, message((1, ""), (2, 11))), (7, graph))
