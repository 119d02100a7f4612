"""A real network with weights set by hand: it finds rectangles of one size, red ones ("couch") and green ones ("tv").

One convolution averages blocks of 4 x 4 pixels, the next looks at a window around every cell of 8 x 8. Its objectness
is a matched filter (colour inside the rectangle's outline minus colour around it), its offsets are first moments, so
boxes are right to a fraction of a pixel while neighbouring cells all answer: suppression and seam have real work to do.
"""

import struct

import numpy as np

BLOCK, STRIDE, SIZE = 4, 8, 15  # pixels, pixels, blocks
OBJECT_WIDTH, OBJECT_HEIGHT = 32, 24
NAMES = ["couch", "tv"]
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
    names.write_text("\n".join(NAMES) + "\n")
    return cfg, weights, names


def panorama(rng, *objects) -> np.ndarray:
    """A panorama 256 x 128 of dull noise with objects (u_min, v_min, colour), which wrap around the seam."""
    image = rng.integers(100, 130, (128, 256, 3), dtype=np.uint8)
    for u_min, v_min, colour in objects:
        columns = (u_min + np.arange(OBJECT_WIDTH)) % 256
        image[v_min : v_min + OBJECT_HEIGHT, columns] = colour
    return image
