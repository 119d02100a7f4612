"""Show a lesson's figure as one compressed picture with alternative text. A figure without labels is refused."""

import base64
import html
import io
import re
from typing import Literal

from IPython.display import display
from matplotlib.axis import Axis
from matplotlib.category import StrCategoryFormatter
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure
from matplotlib.ticker import FixedFormatter, FuncFormatter
from PIL import Image

from courseware.lessons.kit.compression import PIXEL_RATIO, png_bytes, svg_bytes, webp_bytes

PictureKind = Literal["png", "webp", "svg+xml"]

MAX_SVG_BYTES = 40_000  # a drawing of more points takes less as pixels


class FigureError(ValueError):
    """A figure without a title, labels with units, or alternative text. Every figure of the course has all three."""


def described(figure: Figure, alt: str) -> Figure:
    """Return the figure with its alternative text, which `show` uses: what it shows, for those who cannot see it."""
    figure.set_label(alt)
    return figure


def show(figure: Figure, caption: str = "", alt: str = "", photograph: bool = False) -> None:
    """Display a finished figure as one compressed picture with its caption and its alternative text.

    Lines stay lines (SVG), and images become a PNG. caption: a sentence, such as "Figure 6.1. Two particles." alt:
    default that of `described`. photograph: store a WebP, because a photograph in the few colours of a palette shows
    patches. Raises `FigureError` if the title, `alt` or an axis label with its unit (such as "depth Z [m]") is missing.
    """
    require_labels(figure)
    if photograph:
        data, kind = webp_bytes(figure), "webp"
    else:
        svg = b"" if has_images(figure) else svg_bytes(figure)
        data, kind = (svg, "svg+xml") if 0 < len(svg) <= MAX_SVG_BYTES else (png_bytes(figure), "png")
    ratio = 1 if kind == "svg+xml" else PIXEL_RATIO
    display(Picture(data, alt or str(figure.get_label()), kind, caption, ratio))


def has_images(figure: Figure) -> bool:
    """Return whether a figure shows pixels, which an SVG would only wrap."""
    return any(axes.images or any(isinstance(c, QuadMesh) for c in axes.collections) for axes in figure.axes)


def require_labels(figure: Figure) -> None:
    """Raise `FigureError` unless every axes has a title and labels with units in square brackets.

    A drawing, whose axes are off, has nothing to label, so it needs its title only. Categories have no unit.
    """
    for axes in figure.axes:
        x, y = axes.get_xlabel(), axes.get_ylabel()
        labels = {"x": x or figure.get_supxlabel(), "y": y or figure.get_supylabel()}
        if axes.get_label() == "<colorbar>":
            labels = {"colour bar": x or y}
        elif not (any(map(axes.get_title, ("left", "center", "right"))) or figure.get_suptitle()):
            raise FigureError("this figure has no title: set one with axes.set_title(...)")
        for name, label in labels.items() if axes.axison else ():
            if name in "xy" and shows_categories(getattr(axes, f"{name}axis")):
                continue
            if not re.search(r"\[[^\]]+\]", label):
                raise FigureError(f"the {name} label {label!r} has no unit: write it as 'depth Z [m]' or 'weight [-]'")


def shows_categories(axis: Axis) -> bool:
    """Return whether the ticks of an axis are names."""
    return isinstance(axis.get_major_formatter(), FixedFormatter | FuncFormatter | StrCategoryFormatter)


class Picture:
    """A PNG, WebP or SVG with alternative text and, below it, its caption.

    It is shown as the HTML `<img alt=...>`, because JupyterLab drops the alternative text of an `image/png` output.
    ratio: how many of its pixels, side by side, stand for one pixel on the page.
    """

    def __init__(self, data: bytes, alt: str, kind: PictureKind = "png", caption: str = "", ratio: int = 1) -> None:
        if len(alt.split()) < 4:
            raise FigureError(f"the alternative text must say what the picture shows, in a sentence; got {alt!r}")
        self.data, self.alt, self.kind, self.caption = data, " ".join(alt.split()), kind, " ".join(caption.split())
        self.ratio = ratio

    def html(self) -> str:
        """Return the `<img>` element. It contains the picture's bytes."""
        data = base64.b64encode(self.data).decode("ascii")
        size = f' width="{round(Image.open(io.BytesIO(self.data)).width / self.ratio)}"' if self.ratio > 1 else ""
        image = (
            f'<img alt="{html.escape(self.alt)}" src="data:image/{self.kind};base64,{data}"{size}'
            ' style="max-width: 100%; height: auto">'
        )
        return f"{image}<p><em>{html.escape(self.caption)}</em></p>" if self.caption else image

    def _repr_mimebundle_(self, include=None, exclude=None) -> dict:
        return {"text/plain": repr(self), "text/html": self.html()}

    def __repr__(self) -> str:
        return f"Picture: {self.alt}"
