"""One style for every figure that lessons and commands draw.

Colours are those of Okabe and Ito ("Color Universal Design", 2008), for readers with any common form of colour
blindness; marker and line style change along with the colour. Depth is coloured with plasma, whose steps are easy to
tell apart. Figures are drawn with Agg and never through matplotlib's global state.
"""

from collections.abc import Sequence

import numpy as np
from matplotlib import colormaps, font_manager, rcParams
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.image import AxesImage

BLACK, ORANGE, SKY_BLUE, GREEN = "#000000", "#E69F00", "#56B4E9", "#009E73"
YELLOW, BLUE, VERMILION, PURPLE = "#F0E442", "#0072B2", "#D55E00", "#CC79A7"
_ORDER = (BLUE, ORANGE, GREEN, VERMILION, PURPLE, SKY_BLUE, BLACK)
_MARKERS = ("o", "s", "^", "D", "v", "P", "X")
_LINES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (3, 3)), (0, (1, 1)))

# Fonts that have the letters that matplotlib's own lacks, such as Japanese ones: object names are the reader's.
_OTHER_SCRIPTS = (
    "Noto Sans CJK JP", "Noto Sans JP", "IPAexGothic", "Hiragino Sans", "Yu Gothic", "PingFang SC", "Microsoft YaHei",
    "Malgun Gothic", "Noto Sans", "Arial Unicode MS",
)  # fmt: skip
_INSTALLED = {font.name for font in font_manager.fontManager.ttflist}
OTHER_FONTS = [name for name in _OTHER_SCRIPTS if name in _INSTALLED]
"""Those that this machine has: matplotlib takes letters from them that the first font of a text lacks."""

rcParams.update({"font.size": 9, "axes.titlesize": 10, "axes.titlelocation": "left"})
rcParams["font.family"] = ["DejaVu Sans", *OTHER_FONTS]


def line_style(index: int) -> dict:
    """Colour, marker and line style of the index-th series, for `axes.plot(x, y, **line_style(0))`."""
    k = index % len(_ORDER)
    return {"color": _ORDER[k], "marker": _MARKERS[k], "linestyle": _LINES[k], "markersize": 5, "linewidth": 1.6}


def new_figure(rows: int = 1, columns: int = 1, size: tuple[float, float] = (6.4, 3.6)) -> tuple[Figure, np.ndarray]:
    """A figure of `size` inches and its axes: one `Axes` for 1 x 1, else an array of them."""
    figure = Figure(figsize=size, dpi=100, layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots(rows, columns)
    for a in np.atleast_1d(axes).flat:
        a.spines[["top", "right"]].set_visible(False)
        a.grid(alpha=0.25)
    return figure, axes


def depth_image(axes: Axes, depth: np.ndarray, title: str, limits: tuple[float, float]) -> AxesImage:
    """Draw a depth image `(H, W)` in metres, coloured between `limits`; hatched where nothing was hit (inf or nan)."""
    colours = colormaps["plasma"].with_extremes(bad=(1, 1, 1, 0))  # clear: the hatched ground shows through
    axes.patch.set(facecolor="white", edgecolor="0.55", hatch="////", linewidth=0)
    drawn = np.ma.masked_invalid(depth)
    image = axes.imshow(drawn, cmap=colours, vmin=limits[0], vmax=limits[1], interpolation="nearest")
    axes.grid(False)
    axes.spines[["top", "right"]].set_visible(True)
    axes.set(title=title, xlabel="column u [pixels]", ylabel="row v [pixels]")
    return image


def depth_images(
    images: Sequence[np.ndarray],
    titles: Sequence[str],
    limits: tuple[float, float],
    size: tuple[float, float] | None = None,
) -> Figure:
    """Depth images in metres side by side, with one colour bar; size in inches, None: what their number needs."""
    figure, axes = new_figure(1, len(images), size or (3.3 * len(images) + 0.9, 2.9))
    for a, image, title in zip(np.atleast_1d(axes), images, titles, strict=True):
        drawn = depth_image(a, image, title, limits)
    colour_bar(figure, drawn, axes)
    return figure


def colour_bar(figure: Figure, image: AxesImage, axes: Axes | np.ndarray, label: str = "depth Z [m]") -> None:
    """The colour bar that goes with `depth_image`."""
    figure.colorbar(image, ax=axes, label=label, shrink=0.85)


BESIDE = {"loc": "center left", "bbox_to_anchor": (1.0, 0.5), "frameon": False}
"""Arguments of `axes.legend` that put the legend to the right of the axes."""


def curves_figure(
    x: np.ndarray, curves: dict[str, np.ndarray], size: tuple[float, float], markevery: float, **labels
) -> tuple[Figure, Axes]:
    """Draw named curves over x, with the legend beside the axes; labels: arguments of `axes.set`."""
    figure, axes = new_figure(size=size)
    for index, (name, values) in enumerate(curves.items()):
        axes.plot(x, values, **(line_style(index) | {"markevery": markevery}), label=name)
    axes.set(**labels)
    axes.legend(**BESIDE)
    return figure, axes
