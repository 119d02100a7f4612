"""Figures of lesson 04, and its panel, which switches the sensor's faults on one by one."""

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from course_lib.rendering.camera import DepthCamera
from courseware.lessons.kit.display import described
from courseware.lessons.kit.live_figure import LiveFigure
from courseware.lessons.kit.panel import Choice, Drawing, Panel, Slider, Switch
from courseware.lessons.lesson_04.time_of_flight import FAULTS, MODEL, capture
from courseware.plots import figures

DEPTHS = np.linspace(-0.05, 13.15, 67)  # metres; the walls stand at whole decimetres, no edge of a bin does
ERRORS = np.linspace(-0.4, 0.4, 42)  # edges of an odd number of bins: one is centred at zero
SCENE_ALT = """The points of one frame in the corridor: blue ones lie on the grey true surfaces, red ones hang before
    the camera where nothing is, black ones float behind the edges of people and pillars."""


def idea_figure(points: np.ndarray, image: np.ndarray) -> Figure:
    """Draw the camera's points from above, and the depth image that they make."""
    figure, (plan, right) = figures.new_figure(1, 2, size=(9.2, 3.3))
    x, _, z = points[np.isfinite(points).all(axis=-1)].T
    plan.scatter(x, z, c=z, s=1.2, cmap="plasma", vmin=0, vmax=10)
    plan.plot(0, 0, "s", color=figures.BLACK, markersize=8)
    plan.text(0.25, -0.15, "camera")
    plan.plot([[0, 0], [-4, 4]], [[0, 0], [10, 10]], color="0.6", linewidth=0.8)
    plan.set(title="What the camera delivers: points, seen from above", xlim=(-4.2, 4.2), ylim=(-0.5, 10.3))
    plan.set(xlabel="X, to the right [m]", ylabel="Z, along the optical axis [m]")
    title = "The same points as a depth image, eq. (7)"
    figures.colour_bar(figure, figures.depth_image(right, image, title, (0, 10)), right)
    alt = "Left, the points of one frame from above: two walls of a corridor; right, the depth image made of them."
    return described(figure, alt)


def phase_figure(distances: tuple[float, ...]) -> Figure:
    """Draw the delays of light that comes back on one clock face, and the range that is read off."""
    figure, (left, right) = figures.new_figure(1, 2, size=(9.2, 3.2))
    angle, repeats = np.linspace(0, 2 * np.pi, 200), MODEL.unambiguous_range
    left.plot(np.cos(angle), np.sin(angle), color="0.75", linewidth=1)
    true = np.linspace(0, 2.2 * repeats, 2000)
    read = np.where(np.diff(true % repeats, prepend=0) < 0, np.nan, true % repeats)
    right.plot(true, read, color="0.4", linewidth=1.6)
    for index, distance in enumerate(distances):
        phase, style = 2 * np.pi * distance / repeats, figures.line_style(index) | {"markersize": 8}
        hand = 1 - 0.15 * index  # shorter and shorter, or two in one direction would hide each other
        left.plot([0, hand * np.cos(phase)], [0, hand * np.sin(phase)], **style, label=f"r = {distance:g} m")
        right.plot(distance, distance % repeats, **style | {"linestyle": "none"})
    left.set(xlabel="in step with the lamp [-]", ylabel="a quarter turn late [-]", aspect="equal")
    left.set(title="The phase of what comes back", xlim=(-1.35, 1.35), ylim=(-1.2, 1.2))
    left.legend(title="(lengths only for sight)", **figures.BESIDE)
    right.set(title="What the camera reads", xlabel="true range r [m]", ylabel="range that is read [m]")
    alt = """Left, hands of a clock for ranges of 2, 6 and 12 m: 2 and 12 m nearly coincide; right, the range read over
        the true range, a saw that falls back to zero every 10 m."""
    return described(figure, alt)


def recorded_figure(measured: np.ndarray, true: np.ndarray) -> Figure:
    """Draw one recorded frame, its truth, and the histogram of its errors."""
    figure, (left, middle, right) = figures.new_figure(1, 3, size=(10.0, 2.9))
    for axes, image, title in ((left, measured, "Measured"), (middle, true, "True")):
        drawn = figures.depth_image(axes, image, title, (0, 12))
    figures.colour_bar(figure, drawn, [left, middle])
    error_histogram(right).set_data(counts(measured - true, ERRORS))
    alt = """A recorded depth image, the true one, and the histogram of their difference: a narrow hill at zero and a
        bar of errors of many metres at its left end."""
    return described(figure, alt)


def two_surfaces_figure(shares: np.ndarray, curves: dict[str, np.ndarray]) -> Figure:
    """Draw the range that a pixel reads over the share of it that the nearer of two surfaces covers."""
    labels = {"xlabel": "share of the pixel on the nearer surface [-]", "ylabel": "range that is read [m]"}
    labels |= {"title": "One pixel, two surfaces", "ylim": (0, 10.2)}
    alt = """Range read over the pole's share of the pixel: for a wall at 4 or 6 m it falls to 2 m from above; for a
        wall at 8 m it rises beyond 8 m, jumps to zero, and comes to 2 m from below."""
    return described(figures.curves_figure(shares, curves, (6.6, 3.0), 10, **labels)[0], alt)


def counts(values: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Count in bins, at least 0.5 for a logarithmic axis. The outermost bins hold what lies beyond both ends."""
    return np.maximum(np.histogram(np.clip(values[np.isfinite(values)], edges[0], edges[-1]), edges)[0], 0.5)


def error_histogram(axes: Axes):
    axes.set(yscale="log", title="Histogram of the errors", ylim=(0.5, 3e4), xlim=(ERRORS[0], ERRORS[-1]))
    axes.set(ylabel="pixels [-]", xlabel="measured - true depth [m]\n(outermost bars: all beyond)")
    return axes.stairs(np.ones(len(ERRORS) - 1), ERRORS, fill=True, color=figures.BLUE)


FREQUENCIES = {"15 MHz (10 m model)": 15e6, "30 MHz (5 m model)": 30e6}
CONTROLS = [
    *[Switch(name, label) for name, (label, _) in FAULTS.items()],
    Slider("x", "camera at x [m]", 0.0, 8.0, 0.0, 0.1),
    Choice("frequency", "modulation", tuple(FREQUENCIES), "15 MHz (10 m model)"),
]


def faults_panel() -> Panel:
    """Show the depth image, its error, and the histograms of both, while switches add the sensor's faults."""
    camera = DepthCamera.sr4000().resized(88, 72)
    figure, ((seen, off), (depths, errors)) = figures.new_figure(2, 2, size=(9.4, 5.2))
    blank, ones = np.zeros(camera.shape), np.ones(len(DEPTHS) - 1)
    image = figures.depth_image(seen, blank, "Depth image, measured", (0, 12))
    error_image = figures.depth_image(off, blank, "Measured - true (hatched: no measurement)", (-0.1, 0.1))
    error_image.set_cmap(colormaps["PuOr"].with_extremes(bad=(1, 1, 1, 0)))  # white at zero, clear without error
    figures.colour_bar(figure, image, seen)
    figures.colour_bar(figure, error_image, off, "error [m], cut at 0.1")
    true_steps = depths.stairs(ones, DEPTHS, color=figures.BLACK, linewidth=1.4, label="true")
    steps = depths.stairs(ones, DEPTHS, fill=True, color=figures.ORANGE, label="measured", zorder=1)
    depths.set(title="Histogram of the depths", xlabel="depth Z [m]", ylabel="pixels [-]", yscale="log")
    depths.set(ylim=(0.5, 3e4), xlim=(0, 13.1))
    depths.legend(loc="upper right", ncols=2, fontsize=8)
    error_steps = error_histogram(errors)
    live = LiveFigure(figure, [image, error_image, steps, true_steps, error_steps])

    def draw(x: float, frequency: str, **switches: bool) -> Drawing:
        faults = {name for name, on in switches.items() if on}
        depth, true, _ = capture(x, faults, camera, FREQUENCIES[frequency])
        error = depth - np.where(np.isfinite(true), true, np.nan)
        image.set_data(np.ma.masked_invalid(depth))
        error_image.set_data(np.ma.masked_invalid(np.clip(error, -0.1, 0.1)))
        for stairs, values, edges in ((steps, depth, DEPTHS), (true_steps, true, DEPTHS), (error_steps, error, ERRORS)):
            stairs.set_data(counts(values, edges))
        amount = np.abs(error[np.isfinite(error)])
        summary = (
            f"no measurement: {np.isnan(depth).mean():.1%} of the pixels\n"
            f"of the others: error at most 5 cm: {(amount <= 0.05).mean():.1%}; more than 1 m: "
            f"{(amount > 1).mean():.1%}; median |error| {np.median(amount) * 1000:.1f} mm"
        )
        names = ", ".join(name.replace("_", "-") for name in FAULTS if name in faults) or "none"
        alt = f"""Depth image of a corridor from x = {x:.1f} m with these faults of the camera: {names}; its difference
            from the truth; histograms of depths and errors. {summary}"""
        return Drawing(live.png(), alt, summary)

    actions = {"All faults": lambda values: dict.fromkeys(FAULTS, True)}
    return Panel("04 the faults one by one", CONTROLS, draw, actions=actions)


PANELS = {"04 the faults one by one": faults_panel}
