"""The network of `blob_networks` as ONNX files, written by hand: the few fields of the format that it needs.

The format is protocol buffers.
A field is a key (number * 8 + wire type) and a value: type 0 a varint, type 2 a length and bytes, type 5 four bytes.
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
    out = b""
    while value > 127:
        out, value = out + bytes([value & 127 | 128]), value >> 7
    return out + bytes([value])


def number(field: int, value: int) -> bytes:
    return varint(field << 3) + varint(value)


def block(field: int, value: bytes | str) -> bytes:
    data = value.encode() if isinstance(value, str) else value
    return varint(field << 3 | 2) + varint(len(data)) + data


def tensor(name: str, values: np.ndarray) -> bytes:
    kind = INT64 if values.dtype == np.int64 else FLOAT
    values = values if kind == INT64 else values.astype("<f4")
    dims = b"".join(number(1, size) for size in values.shape)
    return dims + number(2, kind) + block(8, name) + block(9, values.tobytes())


def attribute(name: str, value: int | list[int]) -> bytes:
    if isinstance(value, int):
        return block(1, name) + number(3, value) + number(20, INT_ATTRIBUTE)
    return block(1, name) + b"".join(number(8, item) for item in value) + number(20, INTS_ATTRIBUTE)


def node(operation: str, inputs: list[str], output: str, **attributes: int | list[int]) -> bytes:
    data = b"".join(block(1, name) for name in inputs) + block(2, output) + block(3, output) + block(4, operation)
    return data + b"".join(block(5, attribute(name, value)) for name, value in attributes.items())


def value_info(name: str, shape: tuple[int, ...]) -> bytes:
    dims = b"".join(block(1, number(1, size)) for size in shape)
    return block(1, name) + block(2, block(1, number(1, FLOAT) + block(2, dims)))


def model(nodes: list[bytes], constants: dict[str, np.ndarray], inputs: dict, outputs: dict) -> bytes:
    graph = b"".join(block(1, item) for item in nodes) + block(2, "blobs")
    graph += b"".join(block(5, tensor(name, values)) for name, values in constants.items())
    graph += b"".join(block(11, value_info(name, shape)) for name, shape in inputs.items())
    graph += b"".join(block(12, value_info(name, shape)) for name, shape in outputs.items())
    opset = block(1, "") + number(2, 11)
    return number(1, 7) + block(8, opset) + block(7, graph)


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
    return model(nodes, constants, {"image": (1, 3, height, width)}, {"output": (1, 6, columns * rows)})
