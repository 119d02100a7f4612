"""Show a lesson's figure as one compressed picture with alternative text. A figure without labels is refused."""

import base64
import html
import io
import re
from typing import Literal

from IPython.display import display
from matplotlib.figure import Figure
from PIL import Image

from course_lib.lessons.kit.compression import png_bytes, webp_bytes

# Pixels. In a narrower window the reader scrolls the figure, because in a smaller picture the labels are unreadable.
MIN_WIDTH = 640


class FigureError(ValueError):
    """A figure without a title, labels with units, or alternative text. Every figure of the course has all three."""


def described(figure: Figure, alt: str) -> Figure:
    """Return the figure with its alternative text, which `show` uses: what it shows, for those who cannot see it."""
    figure.set_label(alt)
    return figure


def show(figure: Figure, alt: str = "", photograph: bool = False) -> None:
    """Display a finished figure as one compressed picture with its alternative text (default: of `described`).

    photograph: store a WebP, because a photograph in the few colours of a palette shows patches.
    Raises `FigureError` if the title, `alt` or an axis label with its unit (such as "depth Z [m]") is missing.
    """
    require_labels(figure)
    alt = alt or str(figure.get_label())
    display(Picture(webp_bytes(figure), alt, "webp") if photograph else Picture(png_bytes(figure), alt))


def require_labels(figure: Figure) -> None:
    """Raise `FigureError` unless every axes has a title and labels with units in square brackets.

    A drawing, whose axes are off, has nothing to label: it needs its title only.
    """
    for axes in figure.axes:
        x, y = axes.get_xlabel(), axes.get_ylabel()
        labels = {"x": x or figure.get_supxlabel(), "y": y or figure.get_supylabel()}
        if axes.get_label() == "<colorbar>":
            labels = {"colour bar": x or y}
        elif not (any(map(axes.get_title, ("left", "center", "right"))) or figure.get_suptitle()):
            raise FigureError("this figure has no title: set one with axes.set_title(...)")
        for name, label in labels.items() if axes.axison else ():
            if not re.search(r"\[[^\]]+\]", label):
                raise FigureError(f"the {name} label {label!r} has no unit: write it as 'depth Z [m]' or 'weight [-]'")


class Picture:
    """A PNG or WebP with alternative text.

    It is shown as the HTML `<img alt=...>`, because JupyterLab drops the alternative text of an `image/png` output.
    """

    def __init__(self, data: bytes, alt: str, kind: Literal["png", "webp"] = "png") -> None:
        if len(alt.split()) < 4:
            raise FigureError(f"the alternative text must say what the picture shows, in a sentence; got {alt!r}")
        self.data, self.alt, self.kind = data, " ".join(alt.split()), kind

    def html(self) -> str:
        """Return the `<img>` element. It contains the picture's bytes."""
        data = base64.b64encode(self.data).decode("ascii")
        min_width = min(MIN_WIDTH, Image.open(io.BytesIO(self.data)).width)
        return (
            f'<img alt="{html.escape(self.alt)}" src="data:image/{self.kind};base64,{data}"'
            f' style="max-width: 100%; min-width: {min_width}px">'
        )

    def _repr_mimebundle_(self, include=None, exclude=None) -> dict:
        return {"text/plain": repr(self), "text/html": self.html()}

    def __repr__(self) -> str:
        return f"Picture: {self.alt}"
