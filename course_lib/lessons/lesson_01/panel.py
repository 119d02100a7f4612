"""Lesson 01's panel: six sliders drive a camera through the corridor."""

import functools

import numpy as np
from matplotlib.axes import Axes
from matplotlib.text import Text

from course_lib.geometry import optical_pose, pose_matrix
from course_lib.lessons.kit.corridor_views import corridor_map, draw_walls
from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Drawing, Panel, Slider
from course_lib.lessons.lesson_01.figures import STYLES
from course_lib.lessons.lesson_01.poses import AXES
from course_lib.plots import figures
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer

_STRETCH = (8.0, 20.5)  # x [m] of the corridor that the panel shows: portal, side corridor (chosen)
_AXIS_LENGTH = 0.7  # m, as drawn in the panel (chosen)
_VIEW_DEPTH = 1.6  # m, how far the drawn edges of the view reach (chosen)


def _camera() -> DepthCamera:
    """The SR4000, drawn as far as the corridor reaches."""
    return DepthCamera.sr4000().with_clip_planes(0.1, 45.0)


@functools.cache
def _renderer() -> DepthRenderer:
    camera = _camera()
    return DepthRenderer(corridor_map(), camera, exact=True, max_batch_pixels=camera.width * camera.height)


def _view_edges(camera: DepthCamera, pose: np.ndarray) -> np.ndarray:
    """World points `(3, 10)` of one line along the edges of the camera's view: apex, corners, and round them."""
    columns, rows = np.array([0, 1, 1, 0]) * camera.width - 0.5, np.array([0, 0, 1, 1]) * camera.height - 0.5
    ends = np.stack([(columns - camera.cx) / camera.fx, (rows - camera.cy) / camera.fy, np.ones(4)], axis=1)
    apex = np.zeros(3)
    line = [apex, ends[0], ends[1], apex, ends[2], ends[3], apex, ends[3], ends[0], ends[1], ends[2]]
    return pose[:3, :3] @ (_VIEW_DEPTH * np.array(line).T) + pose[:3, 3:]


def _matrix_texts(axes: Axes) -> list[Text]:
    """The texts of the first three rows of a 4 x 4 table, row by row; the fourth row never changes.

    Each column has the colour of the axis that it is.
    """
    axes.set(title="Pose matrix, body to world", xlabel="column [-]", ylabel="row [-]")
    axes.set(xlim=(0.5, 4.5), ylim=(4.5, 0.5), xticks=range(1, 5), yticks=range(1, 5))
    axes.set(xticklabels=[*AXES, "position"], yticklabels=["x", "y", "z", ""])
    axes.tick_params(length=0)
    axes.grid(False)
    colours = [*(style["color"] for style in STYLES), figures.BLACK]
    for label, colour in zip(axes.get_xticklabels(), colours, strict=True):
        label.set_color(colour)
    middle = {"ha": "center", "va": "center", "fontsize": 10}
    for c, value in enumerate(("0.00", "0.00", "0.00", "1.00")):
        axes.text(c + 1, 4, value, color=colours[c], **middle)
    return [axes.text(c + 1, r + 1, "", color=colours[c], **middle) for r in range(3) for c in range(4)]


def drive_panel() -> Panel:
    """Drive a camera through the corridor: six sliders, its axes in two views, its pose matrix, its depth image."""
    camera = _camera()
    figure, ((plan, screen), (side, corner)) = figures.new_figure(2, 2, size=(9.8, 4.6))
    plan.get_gridspec().set_width_ratios([1.25, 1])
    plan.get_gridspec().set_height_ratios([1.7, 1])
    moving, views = [], ((plan, (0, 1)), (side, (0, 2)))
    draw_walls(plan, 2, 1.2)
    draw_walls(side, 1, 0.0)
    plan.set(title="From above (walls at z = 1.2 m)", xlabel="x [m]", ylabel="y [m]", ylim=(-1.9, 3.4))
    side.set(title="From the right (cut at y = 0)", xlabel="x [m]", ylabel="z [m]", ylim=(-0.3, 2.9))
    for a, _ in views:
        a.set(xlim=_STRETCH, aspect="equal")
        moving += a.plot([], [], color="0.35", linewidth=0.9)
        for name, style in zip(AXES, STYLES, strict=True):
            moving += a.plot([], [], **style, linewidth=2.4, markersize=5, markevery=[1], label=name)
    plan.legend(loc="upper left", ncols=3, fontsize=8, framealpha=0.95)
    depth = figures.depth_image(screen, np.zeros(camera.shape), "Depth image (yellow: 10 m and more)", (0, 10))
    figures.colour_bar(figure, depth, screen)
    texts = _matrix_texts(corner)
    live = LiveFigure(figure, [*moving, depth, *texts])

    def draw(x: float, y: float, z: float, roll: float, pitch: float, yaw: float) -> Drawing:
        state = np.array([x, y, z, *np.deg2rad([roll, pitch, yaw])])
        matrix = pose_matrix(state)
        image = _renderer().render(state)[0]
        depth.set_data(np.ma.masked_invalid(image))
        edges = _view_edges(camera, optical_pose(state))
        for k, (_, (i, j)) in enumerate(views):
            moving[4 * k].set_data(edges[i], edges[j])
            for column in range(3):
                end = matrix[:3, 3] + _AXIS_LENGTH * matrix[:3, column]
                moving[4 * k + 1 + column].set_data([matrix[i, 3], end[i]], [matrix[j, 3], end[j]])
        for text, value in zip(texts, np.round(matrix[:3], 2).ravel(), strict=True):
            text.set_text(f"{value + 0.0:.2f}")
        middle = image[camera.height // 2, camera.width // 2]
        seen = f"{middle:.2f} m" if np.isfinite(middle) else "nothing hit"
        alt = (
            f"The camera at x {x:.1f}, y {y:.1f}, z {z:.1f} m with roll {roll:.0f}, pitch {pitch:.0f}, yaw {yaw:.0f} "
            f"degrees: its axes from above and from the right, its depth image, its pose matrix. Middle pixel: {seen}."
        )
        axes_text = ", ".join(f"{name} {np.round(matrix[:3, k], 2) + 0.0}" for k, name in enumerate(AXES))
        return Drawing(live.png(), alt, f"{axes_text}, position {matrix[:3, 3].round(2)} m\nmiddle pixel: {seen}")

    controls = [
        Slider("x", "x [m]", 8.5, 19.5, 10.0, 0.1),
        Slider("y", "y [m]", -1.0, 1.0, 0.0, 0.1),
        Slider("z", "z [m]", 0.3, 2.2, 1.2, 0.1),
        Slider("roll", "roll [degrees]", -180, 180, 0, 1),
        Slider("pitch", "pitch [degrees]", -90, 90, 0, 1),
        Slider("yaw", "yaw [degrees]", -180, 180, 0, 1),
    ]
    return Panel("01 drive the camera", controls, draw)


PANELS = {"01 drive the camera": drive_panel}
