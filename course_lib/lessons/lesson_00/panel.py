"""Lesson 00's panel: move a particle until eq. (8) is at its peak."""

import numpy as np

from course_lib.depth_mcl.likelihood import ALPHA, likelihood, valid_pixels
from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Drawing, Panel, Slider, Switch
from course_lib.lessons.lesson_00.figures import DEPTH_LIMITS, UNITS
from course_lib.lessons.lesson_00.recorded import moment, moved
from course_lib.plots import figures

_HALF_WIDTHS = {"x": 1.5, "y": 0.6, "yaw": 15.0}  # metres, metres, degrees about the true pose
_STEPS = {"x": 0.05, "y": 0.01, "yaw": 0.1}
_WRONG_START = -1.2  # metres along x, where the panel begins


def _settable(name: str, value: float) -> float:
    """The value that a slider of this name can be set to, nearest to `value`."""
    return round(round(value / _STEPS[name]) * _STEPS[name], 2)


def pose_panel() -> Panel:
    """Move a particle until what it would see agrees with what the camera measured: eq. (8) is greatest there."""
    now = moment()
    truth = {"x": now.state[0], "y": now.state[1], "yaw": np.rad2deg(now.state[5])}
    goal = {name: _settable(name, value) for name, value in truth.items()}
    figure, axes = figures.new_figure(2, 3, size=(9.8, 5.0))
    (measured_axes, seen_axes, term_axes), hill_axes = axes
    figures.depth_image(measured_axes, now.measured, "Measured by the camera", DEPTH_LIMITS)
    blank = np.zeros(now.measured.shape)
    seen = figures.depth_image(seen_axes, blank, "Seen from the particle", DEPTH_LIMITS)
    figures.colour_bar(figure, seen, [measured_axes, seen_axes])
    terms = figures.depth_image(term_axes, blank, "Every pixel's term of eq. (8)", (0, 1))
    figures.colour_bar(figure, terms, term_axes, "agreement [-]")
    moving = [seen, terms]
    markers, hills = {}, []
    for index, (name, a) in enumerate(zip(truth, hill_axes, strict=True)):
        offsets = np.linspace(-_HALF_WIDTHS[name], _HALF_WIDTHS[name], 31)
        values = truth[name] + offsets
        style = figures.line_style(index) | {"marker": ""}
        hills += a.plot(values, now.share(moved(now.state, name, offsets)), **style)
        (markers[name],) = a.plot([], [], "o", color=figures.VERMILION, markersize=9)
        a.set(title=f"l / m over {name}", xlabel=f"{name} of the particle [{UNITS[name]}]", ylabel="l / m [-]")
        a.set(xlim=(values[0], values[-1]), ylim=(0, 0.9))
    live = LiveFigure(figure, [*moving, *hills, *markers.values()])

    def draw(x: float, y: float, yaw: float, hills_shown: bool) -> Drawing:
        state = now.state.copy()
        state[[0, 1, 5]] = x, y, np.deg2rad(yaw)
        simulated = now.renderer.render(state)
        difference = np.abs(now.measured - simulated[0])
        share = likelihood(now.measured, simulated)[0] / valid_pixels(now.measured).sum()
        seen.set_data(np.ma.masked_invalid(simulated[0]))
        terms.set_data(np.ma.masked_invalid(ALPHA / (ALPHA + difference)))
        for name, value in (("x", x), ("y", y), ("yaw", yaw)):
            markers[name].set_data([value], [share])
        for hill in hills:
            hill.set_visible(hills_shown)
        near = (difference < ALPHA).sum() / valid_pixels(now.measured).sum()
        summary = f"eq. (8): l / m = {share:.2f} of 1;  measured pixels that agree to 0.1 m: {near:.0%}"
        alt = (
            f"Depth image of the camera; depth image seen from a particle at x {x:.2f} m, y {y:.2f} m, yaw {yaw:.1f} "
            f"degrees; agreement of every pixel; and three plots of l / m with the particle's value, {share:.2f}."
        )
        return Drawing(live.png(), alt, summary)

    controls = [
        Slider(
            name,
            f"{name} [{UNITS[name]}]",
            round(goal[name] - _HALF_WIDTHS[name], 2),
            round(goal[name] + _HALF_WIDTHS[name], 2),
            _settable(name, goal[name] + _WRONG_START) if name == "x" else goal[name],
            _STEPS[name],
        )
        for name in truth
    ]
    controls.append(Switch("hills_shown", "show the hills"))
    return Panel("00 find the pose", controls, draw, actions={"Show the true pose": lambda values: dict(goal)})


PANELS = {"00 find the pose": pose_panel}
