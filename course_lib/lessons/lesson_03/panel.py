"""Lesson 03's panel: move the virtual camera and its near plane."""

import functools

import numpy as np
from matplotlib.colors import LogNorm

from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Choice, Drawing, Panel, Slider
from course_lib.lessons.lesson_03.measurements import buffer_step
from course_lib.lessons.lesson_03.scenes import corridor
from course_lib.plots import figures
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer

_MIN_HALF_WIDTH = 0.5  # metres, of the near plane as it is drawn (chosen)
_NEAR_PLANES = ("1", "0.5", "0.1", "0.01", "0.001", "0.0001")


@functools.cache
def _renderer(near: float, backend: str) -> DepthRenderer:
    camera = DepthCamera.sr4000(near=near)
    return DepthRenderer(corridor(), camera, backend, exact=True, max_batch_pixels=camera.width * camera.height)


def camera_panel() -> Panel:
    """Move the virtual camera and its near plane; see the depth image and how far it is from ray casting."""
    figure, (plan, left, right) = figures.new_figure(1, 3, size=(9.8, 3.0))
    plan.plot([0, 8, 8, 0], [-1.5, -1.5, 1.5, 1.5], color=figures.BLACK)  # open behind
    for x, y, length, width in ((5.0, 0.5, 0.3, 0.3), (4.0, -0.8, 0.5, 0.5)):
        plan.plot([x, x + length, x + length, x, x], [y, y, y + width, y + width, y], color=figures.BLACK)
    (wedge,) = plan.plot([], [], color=figures.VERMILION, linewidth=1.6)
    (near_line,) = plan.plot([], [], color=figures.PURPLE, linestyle=":", linewidth=2, label="near plane")
    plan.legend(loc="upper left", fontsize=7)
    plan.set(xlim=(-0.5, 8.5), ylim=(-3, 3), title="From above", xlabel="x [m]", ylabel="y [m]", aspect="equal")
    camera = DepthCamera.sr4000()
    depth = figures.depth_image(left, np.zeros(camera.shape), "What the virtual camera sees", (0, 8))
    figures.colour_bar(figure, depth, left)
    error = figures.depth_image(right, np.ones(camera.shape), "Difference from ray casting", (0, 1))
    error.set_norm(LogNorm(0.001, 1000))
    figures.colour_bar(figure, error, right, "|difference| [mm]")
    live = LiveFigure(figure, [wedge, near_line, depth, error])
    half = np.arctan(camera.width / 2 / camera.fx)

    def draw(x: float, y: float, yaw: float, near: str) -> Drawing:
        plane, heading = float(near), np.deg2rad(yaw)
        state = np.array([x, y, 1.2, 0, 0, heading])
        image = _renderer(plane, "vtk").render(state)[0]
        truth = _renderer(plane, "ray").render(state)[0]
        with np.errstate(invalid="ignore"):
            off_mm = np.abs(image.astype(float) - truth) * 1000
        depth.set_data(np.ma.masked_invalid(image))
        error.set_data(np.ma.masked_invalid(np.clip(off_mm, 0.001, None)))
        ends = np.array([heading - half, heading, heading + half])
        reach = 1.6 / np.cos([half, 0, half])
        wedge.set_data([x, *(x + reach * np.cos(ends)), x], [y, *(y + reach * np.sin(ends)), y])
        # Drawn beyond the view where it would be too short to be seen: at 0.1 m only 8 cm of it are in view.
        across = max(plane * np.tan(half), _MIN_HALF_WIDTH) * np.array([1, -1])
        near_line.set_data(
            x + plane * np.cos(heading) - across * np.sin(heading),
            y + plane * np.sin(heading) + across * np.cos(heading),
        )
        middle = truth[camera.height // 2, camera.width // 2]
        step = buffer_step(middle, plane, camera.far) * 1000
        seen = (
            f"Z = {middle:.2f} m; one step of the z-buffer there: {step:.2g} mm" if middle < np.inf else "nothing hit"
        )
        missed, wrong = np.isinf(image).mean(), (off_mm > 1).mean()
        lines = [
            f"middle pixel: {seen}",
            f"pixels where nothing is hit: {missed:.0%}; pixels more than 1 mm off: {wrong:.0%}",
        ]
        alt = (
            f"Plan of the corridor with the camera at x {x:.1f} m, y {y:.1f} m, yaw {yaw:.0f} degrees; its depth "
            f"image; and the difference from ray casting with near plane {near} m. {' '.join(lines)}"
        )
        return Drawing(live.png(), alt, "\n".join(lines))

    controls = [
        Slider("x", "x [m]", 0.2, 7.8, 0.5, 0.1),
        Slider("y", "y [m]", -1.4, 1.4, 0.0, 0.1),
        Slider("yaw", "yaw [degrees]", -180, 180, 0, 1),
        Choice("near", "near plane [m]", _NEAR_PLANES, "0.1"),
    ]
    return Panel("03 the virtual camera", controls, draw)


PANELS = {"03 the virtual camera": camera_panel}
