"""Figures and pictures in few bytes, as a notebook stores them."""

import io

import numpy as np
from matplotlib.figure import Figure
from PIL import Image

_COLOURS_IN_PNG = 128  # smooth enough for a colour bar, a third of the bytes of full colour
_WEBP_QUALITY = 85  # lines and letters of a figure stay clean; two thirds of the bytes of JPEG (chosen)


def png_bytes(figure: Figure) -> bytes:
    """The figure as PNG with a palette of 128 colours: a third of the size of full colour."""
    figure.canvas.draw()
    return compress(np.asarray(figure.canvas.buffer_rgba())[..., :3])


def webp_bytes(figure: Figure) -> bytes:
    """The figure as WebP, for one that is mostly a photograph: all its colours, in fewer bytes than a palette PNG."""
    figure.canvas.draw()
    return compress_photograph(np.asarray(figure.canvas.buffer_rgba())[..., :3])


def compress(rgb: np.ndarray) -> bytes:
    """Picture `(H, W, 3)` uint8 as a palette PNG."""
    # Maximum coverage keeps the colour of a thin line, which the usual median cut gives up for one more shade of blue.
    picture = Image.fromarray(np.ascontiguousarray(rgb))
    reduced = picture.quantize(_COLOURS_IN_PNG, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
    buffer = io.BytesIO()
    reduced.save(buffer, format="PNG", optimize=True)
    return buffer.getvalue()


def compress_photograph(rgb: np.ndarray) -> bytes:
    """Picture `(H, W, 3)` uint8 as WebP."""
    buffer = io.BytesIO()
    picture = Image.fromarray(np.ascontiguousarray(rgb))
    picture.save(buffer, format="WEBP", quality=_WEBP_QUALITY)
    return buffer.getvalue()
