"""Lesson 09's panel: Gauss-Newton on one depth image, from any start, step by step."""

import functools

import numpy as np
from matplotlib import colormaps

from course_lib.beyond.six_dof.poses import retract
from course_lib.beyond.six_dof.refinement import gauss_newton_step, surface_normals
from course_lib.depth_mcl.evaluation import pose_errors
from courseware.lessons.kit.live_figure import LiveFigure
from courseware.lessons.kit.panel import Choice, Drawing, Panel, Slider
from courseware.lessons.lesson_09.trials import hand_run, levels
from courseware.plots import figures

FRAME, STEPS = 60, 12
SCALES = {"0.03": 0.03, "0.05": 0.05, "0.1": 0.1, "0.25": 0.25, "none": 1e6}  # metres; none: every pixel counts alike
SHOWN = 0.3  # metres of residual at the ends of the colours
CONTROLS = [
    Slider("forward", "start forward by [m]", -0.8, 0.8, 0.2, 0.05),
    Slider("left", "start left by [m]", -0.8, 0.8, 0.0, 0.05),
    Slider("turned", "start turned left by [degrees]", -40, 40, 6, 1),
    Choice("scale", "robust scale [m]", tuple(SCALES), "0.1"),
    Slider("step", "steps done", 0, STEPS, 0, 1),
]
ACTIONS = {
    "Next step": lambda values: {"step": min(values["step"] + 1, STEPS)},
    "Back": lambda values: {"step": max(values["step"] - 1, 0)},
}


@functools.lru_cache(maxsize=32)
def descend(forward: float, left: float, turned_deg: float, scale: float) -> tuple:
    """Step from the true pose, moved and turned about the camera's own axes (right, down, forward).

    Return, before the first step and after each of `STEPS`: images of the map `(n, H, W)` [m], how far each measured
    point lies from the surface seen in its pixel `(n, H, W)` [m], and the errors `(n,)` [m] and `(n,)` [degrees].
    """
    level, true = levels()[1], hand_run().camera_to_world[FRAME]
    level.measure(hand_run().depth(FRAME))
    camera = level.renderer.camera
    poses = [retract(true, np.array([-left, 0.0, forward, 0.0, -np.deg2rad(turned_deg), 0.0]))[None]]
    images = [level.renderer.render_poses(poses[0])]
    for _ in range(STEPS):
        poses.append(gauss_newton_step(level.measured, images[-1], camera, poses[-1], scale))
        images.append(level.renderer.render_poses(poses[-1]))
    images, poses = np.concatenate(images), np.concatenate(poses)
    q, n = surface_normals(images.astype(np.float64), camera)
    position, rotation = pose_errors(poses, np.tile(true, (STEPS + 1, 1, 1)))
    return images, np.sum(n * (camera.points(level.measured) - q), axis=-1), position, np.rad2deg(rotation)


def refinement_panel() -> Panel:
    """Move the start, choose how robust, and step."""
    figure, (seen, off, errors) = figures.new_figure(1, 3, size=(10.2, 3.0))
    blank = np.full(levels()[1].renderer.camera.shape, np.nan)
    drawn = figures.depth_image(seen, blank, "The map, from the pose now", (0, 8))
    figures.colour_bar(figure, drawn, seen)
    apart = figures.depth_image(off, blank, "Measured point off the surface", (-SHOWN, SHOWN))
    apart.set_cmap(colormaps["PuOr"].with_extremes(bad=(1, 1, 1, 0)))
    figures.colour_bar(figure, apart, off, "r [m]")
    steps = np.arange(STEPS + 1)
    lines = [
        errors.semilogy(steps, np.ones(STEPS + 1), **(figures.line_style(index) | {"markersize": 4}), label=name)[0]
        for index, name in enumerate(("position [m]", "rotation [10 degrees]"))
    ]
    (here,) = errors.plot([0], [1], "o", color=figures.VERMILION, markersize=10, fillstyle="none", markeredgewidth=2)
    errors.set(title="Error after each step", xlabel="step [-]", ylabel="error [m or 10 degrees]")
    errors.set(ylim=(1e-3, 10), xlim=(-0.5, STEPS + 0.5), xticks=steps[::2])
    errors.legend(loc="upper right", fontsize=8)
    live = LiveFigure(figure, [drawn, apart, *lines, here])

    def draw(forward: float, left: float, turned: float, scale: str, step: float) -> Drawing:
        images, residuals, position, rotation = descend(forward, left, turned, SCALES[scale])
        k = int(step)
        for image, values in ((drawn, images[k]), (apart, residuals[k])):
            image.set_data(np.ma.masked_invalid(values))
        for line, values in zip(lines, (position, rotation / 10), strict=True):
            line.set_ydata(np.maximum(values, 1e-3))
        here.set_data([k], [max(position[k], 1e-3)])
        alt = (
            f"The map as seen after {k} steps, how far measured points lie off its surface, and the error over "
            f"{STEPS} steps, from a start {forward:.2f} m forward, {left:.2f} m left, turned by {turned:.0f} degrees."
        )
        now = f"{position[k]:.3f} m and {rotation[k]:.1f} degrees off"
        now += f"; median |r| {1000 * np.nanmedian(np.abs(residuals[k])):.0f} mm"
        end = f"{position[-1]:.3f} m, {rotation[-1]:.1f} degrees"
        return Drawing(live.png(), alt, f"step {k}: {now};  after {STEPS} steps: {end}")

    return Panel("09 Gauss-Newton", CONTROLS, draw, actions=ACTIONS)


PANELS = {"09 Gauss-Newton": refinement_panel}
