"""Letterboxing: an image of any shape into a network's input without distortion, and boxes back again, exactly.

The image is scaled until it just fits and is set in the middle of a grey input. Whole pixels are needed, so the two
scales can differ by a rounding; both are kept, and boxes go back by the scale that was really used.
"""

from dataclasses import dataclass

import cv2
import numpy as np

PADDING_GREY = 127
"""Grey level of the padding: Darknet fills with 0.5."""


@dataclass(frozen=True)
class Letterbox:
    """Where an image lies inside a network's input. All in pixels; sizes are (width, height)."""

    image_size: tuple[int, int]
    """The image."""
    input_size: tuple[int, int]
    """The network's input."""
    inner_size: tuple[int, int]
    """The scaled image inside the input."""
    offset: tuple[int, int]
    """Columns of padding at the left, rows of padding at the top."""

    @property
    def has_padding(self) -> bool:
        """Whether any pixel of the input is padding."""
        return self.inner_size != self.input_size

    @property
    def scale(self) -> np.ndarray:
        """(2,) input pixels per image pixel, across and down."""
        return np.array(self.inner_size) / np.array(self.image_size)


def fit_letterbox(image_size: tuple[int, int], input_size: tuple[int, int]) -> Letterbox:
    """The letterbox that shows the whole image at the largest scale that fits.

        scale = min(input width / image width, input height / image height)

    Sizes are (width, height) in pixels. Raises ValueError: a size that is not two positive whole numbers.
    """
    for name, size in (("image_size", image_size), ("input_size", input_size)):
        if len(size) != 2 or any(int(pixels) != pixels or pixels < 1 for pixels in size):
            raise ValueError(f"{name} must be (width, height) in whole pixels, 1 or more; got {size}")
    scale = min(input_size[0] / image_size[0], input_size[1] / image_size[1])
    inner = tuple(
        max(1, min(round(pixels * scale), limit)) for pixels, limit in zip(image_size, input_size, strict=True)
    )
    offset = ((input_size[0] - inner[0]) // 2, (input_size[1] - inner[1]) // 2)
    return Letterbox(tuple(image_size), tuple(input_size), inner, offset)


def letterbox_image(image: np.ndarray, input_size: tuple[int, int]) -> tuple[np.ndarray, Letterbox]:
    """The image (H, W, 3) uint8 scaled and padded to `input_size` (width, height), and where it lies.

    Scaled down by area averaging (AKAZE-sized textures would alias otherwise), up linearly.
    """
    box = fit_letterbox((image.shape[1], image.shape[0]), input_size)
    if box.inner_size != box.image_size:
        shrinks = box.scale.max() < 1
        image = cv2.resize(image, box.inner_size, interpolation=cv2.INTER_AREA if shrinks else cv2.INTER_LINEAR)
    if not box.has_padding:
        return image, box
    padded = np.full((input_size[1], input_size[0], 3), PADDING_GREY, dtype=np.uint8)
    left, top = box.offset
    padded[top : top + box.inner_size[1], left : left + box.inner_size[0]] = image
    return padded, box


def boxes_to_input(boxes: np.ndarray, letterbox: Letterbox) -> np.ndarray:
    """Boxes (..., 4) in edge coordinates of the image -> of the network's input: u' = u * scale + offset."""
    return np.asarray(boxes, dtype=np.float64) * np.tile(letterbox.scale, 2) + np.tile(letterbox.offset, 2)


def boxes_to_image(boxes: np.ndarray, letterbox: Letterbox) -> np.ndarray:
    """Boxes (..., 4) in edge coordinates of the network's input -> of the image: u = (u' - offset) / scale."""
    return (np.asarray(boxes, dtype=np.float64) - np.tile(letterbox.offset, 2)) / np.tile(letterbox.scale, 2)
