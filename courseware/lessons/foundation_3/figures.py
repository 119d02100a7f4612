"""Figures of F3: one update in the plane, normalized errors and their band, joined ellipses, exchanges; the panel."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from courseware.lessons.foundation_3.fusion import FRAMES, JOINS, band, join, sees
from courseware.lessons.kit.display import described
from courseware.lessons.kit.live_figure import LiveFigure
from courseware.lessons.kit.panel import Choice, Drawing, Panel, Slider
from courseware.plots import figures

CIRCLE = np.array([f(np.linspace(0, 2 * np.pi, 120)) for f in (np.cos, np.sin)])
STYLES = {
    "a": {"color": figures.BLUE, "linestyle": "--"},
    "b": {"color": figures.ORANGE, "linestyle": "-."},
    "claimed": {"color": figures.BLACK, "linewidth": 2.2},
    "actual": {"color": figures.VERMILION, "linestyle": ":", "linewidth": 2.6},
}


def ellipse(P: np.ndarray, x: np.ndarray = (0, 0)) -> np.ndarray:
    """Return the points (2, 120) of the one-sigma ellipse of covariance P about x."""
    return np.linalg.cholesky(P) @ CIRCLE + np.reshape(x, (2, 1))


def update_figure(before: tuple, z: float, sigma: float, after: tuple) -> Figure:
    """Draw place and speed: the predicted ellipse, the measured place as a band, and the ellipse after the update."""
    figure, axes = figures.new_figure(size=(7.4, 3.3))
    axes.axvspan(z - sigma, z + sigma, color="#F4D9A8", label="measured place, one sigma")
    styles = ({"color": figures.BLUE, "linestyle": "--"}, {"color": figures.VERMILION, "linestyle": "-"})
    for (x, P), style, name in zip((before, after), styles, ("prediction", "after the update"), strict=True):
        axes.plot(*ellipse(P, x), **style, linewidth=2, label=name)
        axes.plot(*x, "o", color=style["color"])
    axes.set(title="One update: only the place is measured", xlabel="place [m]", ylabel="speed [m/s]")
    axes.legend(**figures.BESIDE)
    alt = """Place and speed: a long tilted ellipse, the prediction; an upright band, the measured place; where both
        meet, a small ellipse, higher in speed than the prediction."""
    return described(figure, alt)


def honesty_figure(means: dict[str, np.ndarray], n: int) -> Figure:
    """Draw mean normalized errors over time for named filters, with the band of n honest runs of dimension two."""
    labels = {"title": f"Mean normalized error of {n} runs", "xlabel": "time [s]", "ylabel": "normalized error [-]"}
    figure, axes = figures.curves_figure(np.arange(1, FRAMES + 1), means, (7.6, 3.2), 5, **labels, yscale="log")
    axes.axhspan(*band(n, 2), color="0.82", label="95 % of honest filters", zorder=0)
    axes.legend(**figures.BESIDE)
    alt = """Normalized errors over 40 seconds: the filter with the right noise stays in a grey band about 1, the one
        with too little noise rises far above it, the one with too much falls below."""
    return described(figure, alt)


def joins_figure(found: dict) -> Figure:
    """Draw for each way of joining the ellipses of a, b, of what is claimed, and of what is true."""
    figure, axes = figures.new_figure(1, len(found), size=(3.1 * len(found), 3.7))
    for a, (name, one) in zip(axes, found.items(), strict=True):
        draw_plane(a, name, 2.6)
        for part, style in STYLES.items():
            a.plot(*ellipse(getattr(one, part)), **style, label=part)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=4, frameon=False)
    alt = """Three pairs of crossing ellipses: joined as if independent, the claimed ellipse is smaller than the actual
        one; by covariance intersection it is larger; with the start counted once both are the same."""
    return described(figure, alt)


def draw_plane(axes: Axes, title: str, size: float) -> None:
    axes.set(title=title, xlabel="error in x [cm]", ylabel="error in y [cm]", aspect="equal")
    axes.set(xlim=(-size, size), ylim=(-size, size))


def exchanges_figure(curves: dict[str, np.ndarray]) -> Figure:
    """Draw sigmas over the number of exchanges."""
    labels = {"title": "Two robots tell each other their estimate", "xlabel": "exchanges [-]", "ylabel": "sigma [cm]"}
    x = np.arange(len(next(iter(curves.values()))))
    figure, axes = figures.curves_figure(x, curves, (7.6, 3.0), 1, **labels)
    axes.set_ylim(0, None)
    alt = """Sigma over eight exchanges: the claim as if independent falls towards zero, the true error stays at
        7 cm, and covariance intersection claims 10 cm."""
    return described(figure, alt)


CONTROLS = [
    Choice("how", "join", JOINS, JOINS[0]),
    Slider("start", "sigma of the common start [cm]", 0.5, 10.0, 2.0, 0.5),
    Slider("angle", "directions of good sight differ by [degrees]", 0, 90, 90, 5),
    Slider("poor", "sigma where the sensors are poor [cm]", 2.0, 12.0, 8.0, 0.5),
]


def join_panel() -> Panel:
    """Join two estimates that began at the same start, and compare the claim with the truth."""
    figure, (plane, bars) = figures.new_figure(1, 2, size=(9.0, 4.3))
    draw_plane(plane, "One sigma of each", 7)
    lines = {part: plane.plot([], [], **style, label=part)[0] for part, style in STYLES.items()}
    plane.legend(loc="upper right", fontsize=8, framealpha=0.95)
    bars.set(xlim=(-0.6, 1.6), ylim=(0, 5), xticks=[0, 1], title="Sigma of the place, x and y together")
    bars.set_xticklabels(["claimed", "actual"])
    bars.set(xlabel="covariance [which]", ylabel="sigma [cm]")
    heights = bars.bar([0, 1], [0, 0], color=[STYLES[part]["color"] for part in ("claimed", "actual")], width=0.6)
    live = LiveFigure(figure, [*lines.values(), *heights])

    def draw(how: str, start: float, angle: float, poor: float) -> Drawing:
        found = join(np.eye(2) * start**2, sees(0, poor=poor), sees(angle, poor=poor), how)
        for part, line in lines.items():
            line.set_data(*ellipse(getattr(found, part)))
        claimed, actual = (np.sqrt(np.trace(P)) for P in (found.claimed, found.actual))
        for bar, height in zip(heights, (claimed, actual), strict=True):
            bar.set_height(height)
        summary = f"{how}: claimed sigma {claimed:.2f} cm, actual {actual:.2f} cm\nnormalized error {found.ratio:.2f}"
        alt = f"Two ellipses that share a start of {start:g} cm and see at {angle:g} degrees, and their join. {summary}"
        return Drawing(live.png(), alt, summary)

    return Panel("F3 two estimates, one past", CONTROLS, draw)


PANELS = {"F3 two estimates, one past": join_panel}
