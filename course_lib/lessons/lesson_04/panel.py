"""Lesson 04's panel: the sensor's faults one by one."""

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import Colormap

from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Choice, Drawing, Panel, Slider, Switch
from course_lib.lessons.lesson_04.figures import ERRORS, counts, error_axis
from course_lib.lessons.lesson_04.time_of_flight import FAULTS, LENGTH, capture
from course_lib.plots import figures
from course_lib.rendering.camera import DepthCamera

DEPTHS = np.linspace(-0.05, 13.15, 67)  # metres; the walls stand at whole decimetres, no edge of a bin does
_FREQUENCIES = {"15 MHz (10 m model)": 15e6, "30 MHz (5 m model)": 30e6}


def faults_panel() -> Panel:
    """Switch the sensor's faults on one by one; see the depth image, its error, and the histograms of both."""
    camera = DepthCamera.sr4000().resized(88, 72)
    figure, ((seen, off), (depths, errors)) = figures.new_figure(2, 2, size=(9.4, 5.2))
    blank = np.zeros(camera.shape)
    image = figures.depth_image(seen, blank, "Depth image, measured", (0, LENGTH))
    figures.colour_bar(figure, image, seen)
    error_image = figures.depth_image(off, blank, "Measured - true (hatched: no measurement)", (-0.1, 0.1))
    error_image.set_cmap(_two_sided())
    figures.colour_bar(figure, error_image, off, "error [m], cut at 0.1")
    true_steps = depths.stairs(np.ones(len(DEPTHS) - 1), DEPTHS, color=figures.BLACK, linewidth=1.4, label="true")
    steps = depths.stairs(np.ones(len(DEPTHS) - 1), DEPTHS, fill=True, color=figures.ORANGE, label="measured")
    steps.set_zorder(1)
    depths.set(title="Histogram of the depths", xlabel="depth Z [m]", ylabel="pixels [-]", yscale="log")
    depths.set(ylim=(0.5, 3e4), xlim=(0, 13.1))
    depths.legend(loc="upper right", ncols=2, fontsize=8)
    error_steps = errors.stairs(np.ones(len(ERRORS) - 1), ERRORS, fill=True, color=figures.BLUE)
    error_axis(errors, "Histogram of the errors")
    live = LiveFigure(figure, [image, error_image, steps, true_steps, error_steps])

    def draw(x: float, frequency: str, **switches: bool) -> Drawing:
        faults = {name for name, on in switches.items() if on}
        shot = capture(x, faults, camera, _FREQUENCIES[frequency])
        there = np.isfinite(shot.depth) & np.isfinite(shot.true)
        error = np.where(there, shot.depth - np.where(there, shot.true, 0), np.nan)
        image.set_data(np.ma.masked_invalid(shot.depth))
        error_image.set_data(np.ma.masked_invalid(np.clip(error, -0.1, 0.1)))
        steps.set_data(counts(shot.depth[np.isfinite(shot.depth)], DEPTHS))
        true_steps.set_data(counts(shot.true[np.isfinite(shot.true)], DEPTHS))
        error_steps.set_data(counts(error[there], ERRORS))
        lost, small = np.isnan(shot.depth).mean(), (np.abs(error[there]) <= 0.05).mean()
        far = (np.abs(error[there]) > 1).mean()
        lines = [
            f"no measurement: {lost:.1%} of the pixels",
            f"of the others: error at most 5 cm: {small:.1%}; more than 1 m: {far:.1%}; "
            f"median |error| {np.median(np.abs(error[there])) * 1000:.1f} mm",
        ]
        names = ", ".join(name.replace("_", "-") for name in FAULTS if name in faults) or "none"
        alt = (
            f"Depth image of a corridor from x = {x:.1f} m with these faults of the camera: {names}; its difference "
            f"from the truth; histograms of depths and errors. {' '.join(lines)}"
        )
        return Drawing(live.png(), alt, "\n".join(lines))

    controls = [
        Switch("noise", "noise"),
        Switch("mixing", "mixing: a pixel has an area, not one ray"),
        Switch("systematic", "systematic: offset, wiggling, a pattern of the pixels"),
        Switch("scattering", "scattering: light strays inside the camera"),
        Switch("drop_outs", "drop-outs: too little or too much light gives no measurement"),
        Switch("wrapping", "wrapping: ranges repeat after c / 2f"),
        Slider("x", "camera at x [m]", 0.0, 8.0, 0.0, 0.1),
        Choice("frequency", "modulation", tuple(_FREQUENCIES), next(iter(_FREQUENCIES))),
    ]
    everything = dict.fromkeys(FAULTS, True)
    return Panel("04 the faults one by one", controls, draw, actions={"All faults": lambda values: everything})


def _two_sided() -> Colormap:
    """Colours for errors of both signs, white at zero; clear where there is none."""
    return colormaps["PuOr"].with_extremes(bad=(1, 1, 1, 0))


PANELS = {"04 the faults one by one": faults_panel}
