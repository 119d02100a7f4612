"""Figures and pictures `(H, W, 3)` uint8 in few bytes, as a notebook stores them."""

import io
import re

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from PIL import Image

PIXEL_RATIO = 2  # pixels of a stored figure for each pixel of its size on the page: sharp on fine screens


def png_bytes(figure: Figure) -> bytes:
    """Return the figure as PNG with a palette of 128 colours: a third of the bytes of full colour."""
    return compress(_pixels(figure))


def webp_bytes(figure: Figure) -> bytes:
    """Return the figure as WebP. A photograph keeps all its colours, in fewer bytes than a palette PNG."""
    return compress_photograph(_pixels(figure))


def svg_bytes(figure: Figure) -> bytes:
    """Return the figure as SVG, sharp at any size; the same figure gives the same bytes."""
    buffer = io.BytesIO()
    with matplotlib.rc_context({"svg.hashsalt": "course", "svg.fonttype": "none"}):
        figure.savefig(buffer, format="svg", metadata={"Date": None, "Creator": None})
    text = re.sub(rb"\s*\n\s*", b" ", buffer.getvalue())
    text = re.sub(rb' d="[^"]*"', lambda path: re.sub(rb"(\d\.\d)\d+", rb"\1", path[0]), text)  # tenths of a point
    return re.sub(rb"<metadata>.*</metadata>|<!DOCTYPE[^>]*>|<\?xml[^>]*>", b"", text).strip()


def compress(rgb: np.ndarray) -> bytes:
    """Return a picture as PNG with a palette of 128 colours, which is smooth enough for a colour bar."""
    # Maximum coverage keeps the colour of a thin line, which the usual median cut gives up for one more shade of blue.
    picture = Image.fromarray(np.ascontiguousarray(rgb))
    return _encoded(picture.quantize(128, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE), "PNG", optimize=True)


def small_png(picture: Image.Image, width: int, max_bytes: int) -> bytes:
    """Return a picture as PNG, `width` pixels wide or, if it has too many bytes, smaller. Raises `ValueError`."""
    for wide in (width, width * 4 // 5, width * 3 // 5, width * 2 // 5):
        size = (wide, round(wide * picture.height / picture.width))
        png = compress(picture.resize(size, Image.Resampling.LANCZOS))
        if len(png) <= max_bytes:
            return png
    raise ValueError(f"{len(png)} bytes at {wide} pixels; at most {max_bytes} fit")


def compress_photograph(rgb: np.ndarray) -> bytes:
    """Return a picture as WebP. With this quality, the lines and letters of a figure stay clean."""
    return _encoded(Image.fromarray(np.ascontiguousarray(rgb)), "WEBP", quality=85)


def _pixels(figure: Figure) -> np.ndarray:
    dpi = figure.get_dpi()
    figure.set_dpi(PIXEL_RATIO * dpi)
    figure.canvas.draw()
    pixels = np.asarray(figure.canvas.buffer_rgba())[..., :3]
    figure.set_dpi(dpi)
    return pixels


def _encoded(picture: Image.Image, kind: str, **options) -> bytes:
    buffer = io.BytesIO()
    picture.save(buffer, kind, **options)
    return buffer.getvalue()
