"""One style for every figure of the lessons, and pictures that carry their alternative text.

Colours are those of Okabe and Ito ("Color Universal Design", 2008), told apart by readers with any common form of
colour blindness; marker and line style change along with the colour. Depth is coloured with cividis (Nunez, Anderton,
Renslow, PLOS ONE 13(7), 2018), which runs evenly from dark to light. Figures are drawn with Agg and never through
matplotlib's global state, so no lesson leaves a window or an open figure behind.
"""

from __future__ import annotations

import base64
import html
import io
import re

import numpy as np
from IPython.display import display
from matplotlib import colormaps, rcParams
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from PIL import Image

BLACK, ORANGE, SKY_BLUE, GREEN = "#000000", "#E69F00", "#56B4E9", "#009E73"
YELLOW, BLUE, VERMILION, PURPLE = "#F0E442", "#0072B2", "#D55E00", "#CC79A7"
_ORDER = (BLUE, ORANGE, GREEN, VERMILION, PURPLE, SKY_BLUE, BLACK)
_MARKERS = ("o", "s", "^", "D", "v", "P", "X")
_LINES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (3, 3)), (0, (1, 1)))
_DOTS_PER_INCH = 100
_COLOURS_IN_PNG = 128  # smooth enough for a colour bar, a third of the bytes of full colour

rcParams.update({"font.size": 9, "axes.titlesize": 10, "axes.titlelocation": "left"})


class FigureError(ValueError):
    """A figure that lacks what every figure of the course has: title, labels with units, alternative text."""


def line_style(index: int) -> dict:
    """Colour, marker and line style of the index-th series, for `axes.plot(x, y, **line_style(0))`."""
    k = index % len(_ORDER)
    return {"color": _ORDER[k], "marker": _MARKERS[k], "linestyle": _LINES[k], "markersize": 5, "linewidth": 1.6}


def new_figure(rows: int = 1, columns: int = 1, size: tuple[float, float] = (6.4, 3.6)) -> tuple[Figure, np.ndarray]:
    """A figure of `size` inches and its axes: one `Axes` for 1 x 1, else an array of them."""
    figure = Figure(figsize=size, dpi=_DOTS_PER_INCH, layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots(rows, columns)
    for a in np.atleast_1d(axes).flat:
        a.spines[["top", "right"]].set_visible(False)
        a.grid(alpha=0.25)
    return figure, axes


def depth_image(axes: Axes, depth: np.ndarray, title: str, limits: tuple[float, float]) -> AxesImage:
    """Draw a depth image `(H, W)` in metres, coloured between `limits`; hatched where nothing was hit (inf or nan)."""
    colours = colormaps["cividis"].with_extremes(bad=(1, 1, 1, 0))  # clear: the hatched ground shows through
    axes.patch.set(facecolor="white", edgecolor="0.55", hatch="////", linewidth=0)
    drawn = np.ma.masked_invalid(depth)
    image = axes.imshow(drawn, cmap=colours, vmin=limits[0], vmax=limits[1], interpolation="nearest")
    axes.grid(False)
    axes.spines[["top", "right"]].set_visible(True)
    axes.set(title=title, xlabel="column u [pixels]", ylabel="row v [pixels]")
    return image


def colour_bar(figure: Figure, image: AxesImage, axes: Axes | np.ndarray, label: str = "depth Z [m]") -> None:
    """The colour bar that goes with `depth_image`."""
    figure.colorbar(image, ax=axes, label=label, shrink=0.85)


def show(figure: Figure, alt: str) -> None:
    """Display a finished figure as one compressed picture with its alternative text.

    Raises `FigureError` where title, axis labels with units (such as "depth Z [m]") or `alt` are missing.
    """
    require_labels(figure)
    display(Picture(png_bytes(figure), alt))


def require_labels(figure: Figure) -> None:
    """Raise `FigureError` unless every axes has a title and labels with units in square brackets."""
    shared = {"x": figure.get_supxlabel(), "y": figure.get_supylabel()}
    for axes in figure.axes:
        labels = {"x": axes.get_xlabel() or shared["x"], "y": axes.get_ylabel() or shared["y"]}
        if axes.get_label() == "<colorbar>":
            labels = {"colour bar": axes.get_xlabel() or axes.get_ylabel()}
        elif not (any(axes.get_title(loc) for loc in ("left", "center", "right")) or figure.get_suptitle()):
            raise FigureError("this figure has no title: set one with axes.set_title(...)")
        for name, label in labels.items():
            if not re.search(r"\[[^\]]+\]", label):
                raise FigureError(f"the {name} label {label!r} has no unit: write it as 'depth Z [m]' or 'weight [-]'")


def png_bytes(figure: Figure) -> bytes:
    """The figure as PNG with a palette of 128 colours: a third of the size of full colour."""
    figure.canvas.draw()
    return compress(np.asarray(figure.canvas.buffer_rgba())[..., :3])


def compress(rgb: np.ndarray) -> bytes:
    """Picture `(H, W, 3)` uint8 as a palette PNG."""
    # Maximum coverage keeps the colour of a thin line, which the usual median cut gives up for one more shade of blue.
    picture = Image.fromarray(np.ascontiguousarray(rgb))
    reduced = picture.quantize(_COLOURS_IN_PNG, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
    buffer = io.BytesIO()
    reduced.save(buffer, format="PNG", optimize=True)
    return buffer.getvalue()


class Picture:
    """A PNG with alternative text, shown as `<img alt=...>`.

    JupyterLab drops the alternative text of an `image/png` output, so the picture travels as HTML.
    """

    def __init__(self, png: bytes, alt: str) -> None:
        if len(alt.split()) < 4:
            raise FigureError(f"alternative text says what the picture shows, in a sentence; got {alt!r}")
        self.png, self.alt = png, " ".join(alt.split())

    def html(self) -> str:
        """The `<img>` element, its bytes inside."""
        data = base64.b64encode(self.png).decode("ascii")
        return f'<img alt="{html.escape(self.alt)}" src="data:image/png;base64,{data}" style="max-width: 100%">'

    def _repr_mimebundle_(self, include=None, exclude=None) -> dict:
        return {"text/plain": repr(self), "text/html": self.html()}

    def __repr__(self) -> str:
        return f"Picture: {self.alt}"
