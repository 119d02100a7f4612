"""Lesson 00's panel: move a particle until eq. (8) is at its peak."""

import numpy as np

from course_lib.depth_mcl.likelihood import ALPHA, likelihood, valid_pixels
from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Drawing, Panel, Slider, Switch
from course_lib.lessons.lesson_00.recorded import DEPTH_LIMITS, UNITS, moment, moved
from course_lib.plots import figures

RANGES = {"x": (1.5, 0.05), "y": (0.6, 0.01), "yaw": (15.0, 0.1)}  # m, m, degrees: to each side, and a step
WRONG_START = -1.2  # metres along x, where the panel begins


def pose_panel() -> Panel:
    """Move a particle until what it would see agrees with what the camera measured: eq. (8) is greatest there."""
    now = moment()
    n_measured = valid_pixels(now.measured).sum()
    truth = {"x": now.state[0], "y": now.state[1], "yaw": np.rad2deg(now.state[5])}
    goal = {name: round(round(truth[name] / step) * step, 2) for name, (_, step) in RANGES.items()}
    figure, ((measured_axes, seen_axes, term_axes), hill_axes) = figures.new_figure(2, 3, size=(9.8, 5.0))
    figures.depth_image(measured_axes, now.measured, "Measured by the camera", DEPTH_LIMITS)
    blank = np.zeros(now.measured.shape)
    seen = figures.depth_image(seen_axes, blank, "Seen from the particle", DEPTH_LIMITS)
    figures.colour_bar(figure, seen, [measured_axes, seen_axes])
    terms = figures.depth_image(term_axes, blank, "Every pixel's term of eq. (8)", (0, 1))
    figures.colour_bar(figure, terms, term_axes, "agreement [-]")
    markers, hills = [], []
    for index, (a, (name, (half, _))) in enumerate(zip(hill_axes, RANGES.items(), strict=True)):
        offsets = np.linspace(-half, half, 31)
        shares = now.share(moved(now.state, name, offsets))
        hills += a.plot(truth[name] + offsets, shares, **(figures.line_style(index) | {"marker": ""}))
        markers += a.plot([], [], "o", color=figures.VERMILION, markersize=9)
        a.set(title=f"l / m over {name}", xlabel=f"{name} of the particle [{UNITS[name]}]", ylabel="l / m [-]")
        a.set(xlim=(truth[name] - half, truth[name] + half), ylim=(0, 0.9))
    live = LiveFigure(figure, [seen, terms, *hills, *markers])

    def draw(x: float, y: float, yaw: float, hills_shown: bool) -> Drawing:
        state = now.state.copy()
        state[[0, 1, 5]] = x, y, np.deg2rad(yaw)
        simulated = now.renderer.render(state)
        difference = np.abs(now.measured - simulated[0])
        share = likelihood(now.measured, simulated)[0] / n_measured
        seen.set_data(np.ma.masked_invalid(simulated[0]))
        terms.set_data(np.ma.masked_invalid(ALPHA / (ALPHA + difference)))
        for hill, marker, value in zip(hills, markers, (x, y, yaw), strict=True):
            marker.set_data([value], [share])
            hill.set_visible(hills_shown)
        near = (difference < ALPHA).sum() / n_measured
        summary = f"eq. (8): l / m = {share:.2f} of 1;  measured pixels that agree to 0.1 m: {near:.0%}"
        alt = (
            f"Depth image of the camera; depth image seen from a particle at x {x:.2f} m, y {y:.2f} m, yaw {yaw:.1f} "
            f"degrees; agreement of every pixel; and three plots of l / m with the particle's value, {share:.2f}."
        )
        return Drawing(live.png(), alt, summary)

    start = goal | {"x": round(goal["x"] + WRONG_START, 2)}
    sliders = [
        Slider(name, f"{name} [{UNITS[name]}]", round(at - half, 2), round(at + half, 2), start[name], step)
        for (name, at), (half, step) in zip(goal.items(), RANGES.values(), strict=True)
    ]
    controls = [*sliders, Switch("hills_shown", "show the hills")]
    return Panel("00 find the pose", controls, draw, actions={"Show the true pose": lambda values: dict(goal)})


PANELS = {"00 find the pose": pose_panel}
