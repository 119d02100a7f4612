"""How a lesson shows a figure: as one compressed picture with its alternative text, and only where it is labelled."""

from __future__ import annotations

import base64
import html
import io
import re
from typing import Literal

from IPython.display import display
from matplotlib.figure import Figure
from PIL import Image

from course_lib.lessons.kit.compression import png_bytes, webp_bytes

# Pixels: in a narrow window a figure is scrolled rather than made smaller than this, or its labels could not be read.
LEAST_WIDTH = 640


class FigureError(ValueError):
    """A figure that lacks what every figure of the course has: title, labels with units, alternative text."""


def show(figure: Figure, alt: str, photograph: bool = False) -> None:
    """Display a finished figure as one compressed picture with its alternative text.

    photograph: for a figure that is mostly one, which the few colours of a palette would turn into patches.
    Raises `FigureError` where title, axis labels with units (such as "depth Z [m]") or `alt` are missing.
    """
    require_labels(figure)
    display(Picture(webp_bytes(figure), alt, "webp") if photograph else Picture(png_bytes(figure), alt))


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


class Picture:
    """A PNG or WebP with alternative text, shown as `<img alt=...>`.

    JupyterLab drops the alternative text of an `image/png` output, so the picture travels as HTML.
    """

    def __init__(self, data: bytes, alt: str, kind: Literal["png", "webp"] = "png") -> None:
        if len(alt.split()) < 4:
            raise FigureError(f"alternative text says what the picture shows, in a sentence; got {alt!r}")
        self.data, self.alt, self.kind = data, " ".join(alt.split()), kind

    def html(self) -> str:
        """The `<img>` element, its bytes inside."""
        data = base64.b64encode(self.data).decode("ascii")
        least = min(LEAST_WIDTH, Image.open(io.BytesIO(self.data)).width)
        return (
            f'<img alt="{html.escape(self.alt)}" src="data:image/{self.kind};base64,{data}"'
            f' style="max-width: 100%; min-width: {least}px">'
        )

    def _repr_mimebundle_(self, include=None, exclude=None) -> dict:
        return {"text/plain": repr(self), "text/html": self.html()}

    def __repr__(self) -> str:
        return f"Picture: {self.alt}"
