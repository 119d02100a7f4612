"""A real network with weights set by hand, in Darknet files and ONNX: it finds red ("couch") and green ("tv") boxes.

One convolution averages blocks of 4 x 4 pixels, the next looks at a window around every cell of 8 x 8. Its objectness
is a matched filter (colour inside the rectangle's outline minus colour around it), its offsets are first moments, so
boxes are right to a fraction of a pixel while neighbouring cells all answer: suppression and seam have real work to do.
"""

import struct

import numpy as np

BLOCK, STRIDE, SIZE = 4, 8, 15  # pixels, pixels, blocks
OBJECT_WIDTH, OBJECT_HEIGHT = 32, 24
RED, GREEN = (0, 0, 255), (0, 255, 0)  # BGR
INPUT_SIZE = (320, 128)  # a panorama of 256 x 128 with its left quarter appended

CFG = f"""[net]
width={INPUT_SIZE[0]}
height={INPUT_SIZE[1]}
channels=3

[convolutional]
filters=3
size={BLOCK}
stride={BLOCK}
pad=0
activation=linear

[convolutional]
filters=7
size={SIZE}
stride={STRIDE // BLOCK}
pad=1
activation=linear

[yolo]
mask=0
anchors={OBJECT_WIDTH},{OBJECT_HEIGHT}
classes=2
num=1
scale_x_y=2.0
"""


def window_kernels() -> dict[str, np.ndarray]:
    """Kernels (SIZE, SIZE) on a colour of 0 or 1: share of the object in its outline minus outside, and its offsets."""
    offset = BLOCK * (np.arange(SIZE) - SIZE // 2 + 0.5) - STRIDE / 2  # of a block's centre from the cell's centre
    x, y = np.meshgrid(offset, offset)
    inside = (abs(x) < OBJECT_WIDTH / 2) & (abs(y) < OBJECT_HEIGHT / 2)
    near = (abs(x) < OBJECT_WIDTH / 2 + STRIDE) & (abs(y) < OBJECT_HEIGHT / 2 + STRIDE)
    area = OBJECT_WIDTH * OBJECT_HEIGHT / BLOCK**2
    return {"match": np.where(inside, 1.0, -1.0) / area, "x": near * x / area, "y": near * y / area, "sum": near / area}


def kernel(kernel: np.ndarray, red: float, green: float, blue: float) -> np.ndarray:
    return np.array([red, green, blue])[:, None, None] * kernel


def averaging_kernels() -> np.ndarray:
    """Kernels (3, 3, BLOCK, BLOCK) that average every colour over a block."""
    return np.eye(3)[:, :, None, None] * np.full((BLOCK, BLOCK), BLOCK**-2)


def darknet_weights() -> np.ndarray:
    """Biases and kernels of both convolutions, in the order of the file."""
    k = window_kernels()
    kernels = [
        kernel(k["x"], 1, 1, -2) * 2 / STRIDE,  # 2 sigmoid(t) - 1/2 is about 1/2 + t/2 cells
        kernel(k["y"], 1, 1, -2) * 2 / STRIDE,
        *np.zeros((2, 3, SIZE, SIZE)),
        kernel(k["match"], 1, 1, -2) * 40,
        kernel(k["sum"], 1, -1, 0) * 10,
        kernel(k["sum"], -1, 1, 0) * 10,
    ]
    parts = [0, 0, 0], averaging_kernels(), [0, 0, 0, 0, -40 * 0.3, 0, 0], kernels
    return np.concatenate([np.ravel(part) for part in parts]).astype("<f4")


def write_darknet(folder) -> tuple:
    """Paths of the cfg, the weights and the names."""
    folder.mkdir(exist_ok=True)
    cfg, weights, names = (folder / f"blobs.{ending}" for ending in ("cfg", "weights", "names"))
    cfg.write_text(CFG)
    weights.write_bytes(struct.pack("<3iq", 0, 2, 5, 0) + darknet_weights().tobytes())
    names.write_text("couch\ntv\n")
    return cfg, weights, names


def panorama(rng, *objects) -> np.ndarray:
    """A panorama 256 x 128 of dull noise with objects (u_min, v_min, colour), which wrap around the seam."""
    image = rng.integers(100, 130, (128, 256, 3), dtype=np.uint8)
    for u_min, v_min, colour in objects:
        columns = (u_min + np.arange(OBJECT_WIDTH)) % 256
        image[v_min : v_min + OBJECT_HEIGHT, columns] = colour
    return image


# The few fields of the ONNX format that it needs. The format is protocol buffers: a field is a key (number * 8 + wire
# type) and a value, type 0 a varint, type 2 a length and bytes.
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
