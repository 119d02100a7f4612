"""Panoramas in figures: the picture with its angles, boxes in the colours of their classes, numbers that stay apart."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from matplotlib.patheffects import withStroke

from courseware.plots.figures import OTHER_FONTS

# Okabe and Ito's colours and a marker each, so that no class is told by colour alone.
CLASS_STYLES = {
    "sofa": ("#D55E00", "s"),
    "chair": ("#0072B2", "^"),
    "table": ("#009E73", "D"),
    "television": ("#CC79A7", "P"),
    "potted plant": ("#E69F00", "*"),
    "refrigerator": ("#56B4E9", "X"),
    "cabinet": ("#5C5C5C", "p"),
}
_OTHER = ("#9A9A9A", "h")
_NUMBER_SIZE = 6.5  # points
_STEPS = 9  # places tried along an edge of a box


def class_style(label: str) -> tuple[str, str]:
    """Colour and marker of a class; grey hexagons for classes that the course's detector does not know."""
    return CLASS_STYLES.get(label, _OTHER)


def panorama(axes: Axes, image_bgr: np.ndarray, title: str) -> None:
    """Draw a panorama `(H, W, 3)` uint8 BGR in edge coordinates, with azimuth written along the top."""
    height, width = image_bgr.shape[:2]
    axes.imshow(image_bgr[..., ::-1], extent=(0, width, height, 0), interpolation="antialiased")
    axes.grid(False)
    axes.set(title=title, xlabel="column u [pixels]", ylabel="row v [pixels]", xlim=(0, width), ylim=(height, 0))
    above = axes.secondary_xaxis("top", functions=(lambda u: 180 - 360 * u / width, lambda a: (180 - a) * width / 360))
    above.set_xticks([180, 90, 0, -90, -180])
    above.set_xlabel("azimuth [degrees]", fontsize=8)


def draw_box(axes: Axes, box: Sequence[float], width: int, label: str, text: str | None = None) -> None:
    """One box on a panorama, on both sides where it crosses the seam, in its class's colour."""
    u_min, v_min, u_max, v_max = box
    colour, _ = class_style(label)
    for turn in (0, -width) if u_max > width else (0,):
        frame = Rectangle(
            (u_min + turn, v_min), u_max - u_min, v_max - v_min, fill=False, edgecolor=colour, linewidth=1.6
        )
        frame.set_path_effects([withStroke(linewidth=2.8, foreground="white")])  # else lost on a ground of its colour
        axes.add_patch(frame)
        if text and u_min + turn >= 0:
            _write(axes, u_min + turn, v_min - 4, text, colour, "baseline")


def draw_objects(axes: Axes, boxes: Sequence[Sequence[float]], labels: Sequence[str], width: int) -> None:
    """Boxes and their numbers (`draw_numbers`)."""
    for box, label in zip(boxes, labels, strict=True):
        draw_box(axes, box, width, label)
    draw_numbers(axes, boxes, labels, width)


def draw_numbers(axes: Axes, boxes: Sequence[Sequence[float]], labels: Sequence[str], width: int) -> None:
    """Number boxes from 1 on, each number on an edge of its box, where it covers no other.

    Call it when the figure is otherwise finished: how many pixels a number covers follows from the layout.
    """
    axes.figure.draw_without_rendering()
    (left, bottom), (right, top) = axes.transData.transform([(0.0, 1.0), (1.0, 0.0)])
    point = axes.figure.dpi / 72
    high = 1.35 * _NUMBER_SIZE * point / abs(top - bottom)
    taken: list[tuple[float, float, float, float]] = []
    for number, (box, label) in enumerate(zip(boxes, labels, strict=True), start=1):
        wide = (0.75 * len(str(number)) + 0.35) * _NUMBER_SIZE * point / abs(right - left)
        spots = _spots(box, wide, high, width)
        covered = [sum(_common_area((u, v, u + wide, v + high), other) for other in taken) for u, v in spots]
        u, v = spots[int(np.argmin(covered))]  # the first of the best
        taken.append((u, v, u + wide, v + high))
        _write(axes, u + wide / 2, v + high / 2, str(number), class_style(label)[0], "center", "center")


def add_list(
    figure: Figure, lines: Sequence[str], columns: int, title: str, labels: Sequence[str] | None = None
) -> None:
    """A list below everything else of a figure, a line an object; labels: with their classes' colours and markers."""
    styles = [class_style(label) for label in labels] if labels is not None else [("none", "")] * len(lines)
    handles = [Line2D([], [], linestyle="none", color=colour, marker=marker) for colour, marker in styles]
    letters = {"prop": {"family": ["DejaVu Sans Mono", *OTHER_FONTS], "size": 7.5}, "title_fontsize": 8}
    space = {"handletextpad": 0.2, "handlelength": None if labels is not None else 0, "columnspacing": 1.4}
    place = {"loc": "outside lower center", "ncols": columns, "frameon": False}
    figure.legend(handles, lines, title=title, **place, **letters, **space)


def _spots(box: Sequence[float], wide: float, high: float, width: int) -> list[tuple[float, float]]:
    """Places (left, top) for a number on a box, the best first: above it, below it, inside its upper edge."""
    u_min, v_min, u_max, v_max = box
    along = np.clip(np.linspace(u_min, max(u_min, min(u_max, width) - wide), _STEPS), 0, width - wide)
    return [(float(u), float(v)) for v in (v_min - high, v_max, v_min) for u in along]


def _common_area(a: Sequence[float], b: Sequence[float]) -> float:
    return max(0.0, min(a[2], b[2]) - max(a[0], b[0])) * max(0.0, min(a[3], b[3]) - max(a[1], b[1]))


def _write(axes: Axes, u: float, v: float, text: str, colour: str, vertical: str, horizontal: str = "left") -> None:
    ground = {"facecolor": colour, "edgecolor": "none", "pad": 0.8}
    style = {"verticalalignment": vertical, "horizontalalignment": horizontal, "bbox": ground, "clip_on": True}
    axes.text(u, v, text, color="white", fontsize=_NUMBER_SIZE, **style)
