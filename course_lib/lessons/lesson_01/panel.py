"""Lesson 01's panel: six sliders drive a camera through the corridor."""

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

CAMERA = DepthCamera.sr4000(0.1, 45.0)  # draws as far as the corridor reaches
STRETCH = (8.0, 20.5)  # x [m] of the corridor that the panel shows: portal, side corridor (chosen)
AXIS_LENGTH, VIEW_DEPTH = 0.7, 1.6  # m, how long the axes and the edges of the view are drawn (chosen)
CONTROLS = [
    Slider("x", "x [m]", 8.5, 19.5, 10.0, 0.1),
    Slider("y", "y [m]", -1.0, 1.0, 0.0, 0.1),
    Slider("z", "z [m]", 0.3, 2.2, 1.2, 0.1),
    Slider("roll", "roll [degrees]", -180, 180, 0, 1),
    Slider("pitch", "pitch [degrees]", -90, 90, 0, 1),
    Slider("yaw", "yaw [degrees]", -180, 180, 0, 1),
]


def _view_edges(pose: np.ndarray) -> np.ndarray:
    """World points `(3, 11)` of one line along the edges of the camera's view, from its apex round the corners."""
    u, v = np.array([0, 1, 1, 0]) * CAMERA.width - 0.5, np.array([0, 0, 1, 1]) * CAMERA.height - 0.5
    corners = np.stack([(u - CAMERA.cx) / CAMERA.fx, (v - CAMERA.cy) / CAMERA.fy, np.ones(4)])
    line = np.column_stack([np.zeros(3), corners])[:, [0, 1, 2, 0, 3, 4, 0, 4, 1, 2, 3]]
    return pose[:3, :3] @ (VIEW_DEPTH * line) + pose[:3, 3:]


def _matrix_texts(axes: Axes) -> list[Text]:
    """The texts of the first three rows of a 4 x 4 table, row by row; each column has the colour of its axis."""
    axes.set(title="Pose matrix, body to world", xlabel="column [-]", ylabel="row [-]")
    axes.set(xlim=(0.5, 4.5), ylim=(4.5, 0.5), xticks=range(1, 5), yticks=range(1, 5))
    axes.set(xticklabels=[*AXES, "position"], yticklabels=["x", "y", "z", ""])
    axes.tick_params(length=0)
    axes.grid(False)
    texts = []
    for c, colour in enumerate([*(style["color"] for style in STYLES), figures.BLACK]):
        axes.get_xticklabels()[c].set_color(colour)
        middle = {"color": colour, "ha": "center", "va": "center", "fontsize": 10}
        axes.text(c + 1, 4, "1.00" if c == 3 else "0.00", **middle)  # the fourth row never changes
        texts.append([axes.text(c + 1, r + 1, "", **middle) for r in range(3)])
    return [text for row in zip(*texts, strict=True) for text in row]


def drive_panel() -> Panel:
    """Drive a camera through the corridor: six sliders, its axes in two views, its pose matrix, its depth image."""
    renderer = DepthRenderer(corridor_map(), CAMERA, exact=True, max_batch_pixels=CAMERA.width * CAMERA.height)
    figure, ((plan, screen), (side, corner)) = figures.new_figure(2, 2, size=(9.8, 4.6))
    plan.get_gridspec().set_width_ratios([1.25, 1])
    plan.get_gridspec().set_height_ratios([1.7, 1])
    draw_walls(plan, 2, 1.2)
    draw_walls(side, 1, 0.0)
    plan.set(title="From above (walls at z = 1.2 m)", xlabel="x [m]", ylabel="y [m]", ylim=(-1.9, 3.4))
    side.set(title="From the right (cut at y = 0)", xlabel="x [m]", ylabel="z [m]", ylim=(-0.3, 2.9))
    drawn = []
    for a in (plan, side):
        a.set(xlim=STRETCH, aspect="equal")
        drawn += a.plot([], [], color="0.35", linewidth=0.9)
        for name, style in zip(AXES, STYLES, strict=True):
            drawn += a.plot([], [], **style, linewidth=2.4, markersize=5, markevery=[1], label=name)
    plan.legend(loc="upper left", ncols=3, fontsize=8, framealpha=0.95)
    depth = figures.depth_image(screen, np.zeros(CAMERA.shape), "Depth image (yellow: 10 m and more)", (0, 10))
    figures.colour_bar(figure, depth, screen)
    texts = _matrix_texts(corner)
    live = LiveFigure(figure, [*drawn, depth, *texts])

    def draw(x: float, y: float, z: float, roll: float, pitch: float, yaw: float) -> Drawing:
        state = np.array([x, y, z, *np.deg2rad([roll, pitch, yaw])])
        matrix, image = pose_matrix(state), renderer.render(state)[0]
        depth.set_data(np.ma.masked_invalid(image))
        axes = [np.column_stack([matrix[:3, 3], matrix[:3, 3] + AXIS_LENGTH * column]) for column in matrix[:3, :3].T]
        lines = [_view_edges(optical_pose(state)), *axes]
        for moved, line in zip(
            drawn, [*(line[[0, 1]] for line in lines), *(line[[0, 2]] for line in lines)], strict=True
        ):
            moved.set_data(*line)
        rounded = np.round(matrix[:3], 2) + 0.0
        for text, value in zip(texts, rounded.ravel(), strict=True):
            text.set_text(f"{value:.2f}")
        middle = image[CAMERA.height // 2, CAMERA.width // 2]
        seen = f"{middle:.2f} m" if np.isfinite(middle) else "nothing hit"
        alt = (
            f"The camera at x {x:.1f}, y {y:.1f}, z {z:.1f} m with roll {roll:.0f}, pitch {pitch:.0f}, yaw {yaw:.0f} "
            f"degrees: its axes from above and from the right, its depth image, its pose matrix. Middle pixel: {seen}."
        )
        axes_text = ", ".join(f"{name} {rounded[:, k]}" for k, name in enumerate(AXES))
        return Drawing(live.png(), alt, f"{axes_text}, position {matrix[:3, 3].round(2)} m\nmiddle pixel: {seen}")

    return Panel("01 drive the camera", CONTROLS, draw)


PANELS = {"01 drive the camera": drive_panel}
