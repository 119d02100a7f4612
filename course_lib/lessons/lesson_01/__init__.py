"""Lesson 01, poses and frames: its figures, and a camera that six sliders drive through the corridor."""

from __future__ import annotations

import functools

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text

from course_lib.depth_mcl.camera import DepthCamera
from course_lib.depth_mcl.rendering.renderer import DepthRenderer
from course_lib.geometry import optical_pose, pose_matrix, rotation_log
from course_lib.lessons.kit.corridor_views import corridor_map, draw_walls
from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Drawing, Panel, Slider
from course_lib.plots import figures

# The body's axes and how each is drawn in every figure of this lesson: colour, line, marker at the tip.
AXES = ("forward", "left", "up")
_STYLES = (
    {"color": figures.VERMILION, "linestyle": "-", "marker": "o"},
    {"color": figures.GREEN, "linestyle": "--", "marker": "s"},
    {"color": figures.BLUE, "linestyle": ":", "marker": "^"},
)
_SHOWN_TURN = np.deg2rad(30)
_STRETCH = (8.0, 20.5)  # x [m] of the corridor that the panel shows: portal, side corridor (chosen)
_AXIS_LENGTH = 0.7  # m, as drawn in the panel (chosen)
_VIEW_DEPTH = 1.6  # m, how far the drawn edges of the view reach (chosen)


def draw_axes(axes: Axes, state: np.ndarray, shown: tuple[int, int], length: float = 1.0, **style) -> None:
    """The body's three axes, seen along one world axis; `shown` are the two world coordinates that are kept."""
    matrix = pose_matrix(state)
    start = matrix[list(shown), 3]
    for column, own in enumerate(_STYLES):
        end = start + length * matrix[list(shown), column]
        if np.linalg.norm(end - start) > 1e-6:
            axes.plot(*zip(start, end, strict=True), **(own | {"linewidth": 2.2, "markevery": [1]} | style))


def turns_figure() -> Figure:
    """Positive yaw, pitch and roll, each seen along the axis that it turns about."""
    figure, axes = figures.new_figure(1, 3, size=(9.6, 3.4))
    views = (
        (5, (0, 1), "Yaw, from above: to the left", "x [m]", "y [m]"),
        (4, (0, 2), "Pitch, from its right: down", "x [m]", "z [m]"),
        (3, (1, 2), "Roll, from behind: left side up", "y [m] (grows to the left)", "z [m]"),
    )
    for a, (component, shown, title, x_label, y_label) in zip(axes, views, strict=True):
        state = np.zeros(6)
        draw_axes(a, state, shown, color="0.7", linewidth=1.2)
        state[component] = _SHOWN_TURN
        draw_axes(a, state, shown)
        moving = 0 if shown[0] == 0 else 1
        arc = np.zeros((20, 6))
        arc[:, component] = np.linspace(0, _SHOWN_TURN, 20)
        path = 0.72 * pose_matrix(arc)[:, list(shown), moving]
        a.plot(path[:, 0], path[:, 1], color=figures.BLACK, linewidth=1.2)
        a.annotate("", path[-1], path[-4], arrowprops={"arrowstyle": "->", "color": figures.BLACK})
        a.set(title=title, xlabel=x_label, ylabel=y_label, xlim=(-1.25, 1.25), ylim=(-1.25, 1.25), aspect="equal")
    axes[2].invert_xaxis()
    for name, style in zip(AXES, _STYLES, strict=True):
        axes[0].plot([], [], **style, linewidth=2.2, label=name)
    axes[0].plot([], [], color="0.7", label="before the turn")
    axes[0].legend(loc="lower left", fontsize=8, framealpha=0.95)
    return figure


def frames_figure() -> Figure:
    """The three frames: the body frame in the world (left), the optical frame in the body (right)."""
    figure = figures.new_figure(size=(9.4, 3.8))[0]
    figure.clear()
    state = np.array([2.0, 1.0, 1.2, 0.0, np.deg2rad(15), np.deg2rad(25)])
    world, inner = (figure.add_subplot(1, 2, place, projection="3d", computed_zorder=False) for place in (1, 2))
    _triad(world, np.eye(4), "xyz", "0.35", 1.0, "-")
    _triad(world, pose_matrix(state), AXES, None, 1.0, "--")
    world.plot(*np.array([np.zeros(3), state[:3]]).T, color="0.5", linestyle=":", linewidth=1.2)
    world.text(*(state[:3] / 2 + [0, 0, 0.2]), "position", color="0.3", fontsize=9, ha="right")
    world.set(title="Body frame in the world frame", xlim=(-0.3, 3.1), ylim=(-0.3, 2.3), zlim=(-0.2, 2.2))
    world.set(xlabel="x [m]", ylabel="y [m]", zlabel="z [m]")
    world.set_box_aspect((3.4, 2.6, 2.4), zoom=0.95)
    _triad(inner, np.eye(4), AXES, None, 1.0, "-")
    _triad(inner, optical_pose(np.zeros(6)), ("X", "Y", "Z   "), figures.PURPLE, 0.6, "--")
    inner.set(title="Optical frame (X, Y, Z) in the body frame", xlim=(-1, 1), ylim=(-1, 1), zlim=(-1, 1))
    inner.set(xlabel="forward [m]", ylabel="left [m]", zlabel="up [m]")
    inner.set_box_aspect((1, 1, 1), zoom=0.9)
    for axes in (world, inner):
        axes.locator_params(nbins=3)
        axes.view_init(elev=20, azim=-68)
    return figure


def _triad(axes, matrix: np.ndarray, names, colour: str | None, length: float, line: str) -> None:
    """Three axes of a frame in a 3D figure, with their names at the tips."""
    start = matrix[:3, 3]
    for column, name in enumerate(names):
        end = start + length * matrix[:3, column]
        own = colour or _STYLES[column]["color"]
        axes.plot(*zip(start, end, strict=True), color=own, linestyle=line, linewidth=2.4)
        above = [0, 0, 0.13 if abs(matrix[2, column]) < 0.5 else 0]
        axes.text(*(start + 1.16 * (end - start) + above), name, color=own, ha="center", va="center", fontsize=9)


def depth_figure(images: list[np.ndarray], titles: list[str], greatest: float = 10.0) -> Figure:
    """Depth images in metres side by side, with one colour bar."""
    figure, axes = figures.new_figure(1, len(images), size=(3.3 * len(images) + 0.9, 2.9))
    for a, image, title in zip(np.atleast_1d(axes), images, titles, strict=True):
        drawn = figures.depth_image(a, image, title, (0, greatest))
    figures.colour_bar(figure, drawn, axes)
    return figure


def mean_figure(headings: np.ndarray, as_numbers: float, on_circle: float) -> Figure:
    """Headings as points of the unit circle, with their mean as numbers and their mean direction."""
    figure, axes = figures.new_figure(size=(5.6, 3.4))
    around = np.linspace(-np.pi, np.pi, 200)
    axes.plot(np.cos(around), np.sin(around), color="0.8")
    axes.plot(np.cos(headings), np.sin(headings), ".", color=figures.BLUE, markersize=4, label="headings")
    for angle, name, index in ((as_numbers, "mean of the numbers", 1), (on_circle, "mean direction", 3)):
        style = figures.line_style(index) | {"markevery": [1], "markersize": 8, "linewidth": 2.2}
        axes.plot([0, np.cos(angle)], [0, np.sin(angle)], **style, label=name)
    axes.plot([-1.3, -1], [0, 0], color=figures.BLACK, linewidth=1)
    axes.text(-1.33, 0, "the wrap,\n±180°", ha="right", va="center", fontsize=8)
    axes.set(title="A wagon on its way back, seen from above", xlabel="x [-]", ylabel="y [-]", aspect="equal")
    axes.set(xlim=(-2.1, 1.3), ylim=(-1.2, 1.2))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return figure


def turn_per_degree(pitch: float, step: float = np.deg2rad(0.01)) -> tuple[float, float]:
    """Least and greatest turn of the camera for a small change of (roll, pitch, yaw) of length one.

    The columns of the Jacobian are the turns, in the body's frame, that a small change of each angle makes; its
    singular values are the extremes. By hand: sqrt(1 - |sin pitch|) and sqrt(1 + |sin pitch|).
    """
    base = np.array([0, 0, 0, 0.1, pitch, 0.2])
    rotations = pose_matrix(base + step * np.eye(6)[3:])[:, :3, :3]
    before = pose_matrix(base)[:3, :3]
    jacobian = rotation_log(before.T @ rotations).T / step
    values = np.linalg.svd(jacobian, compute_uv=False)
    return float(values[-1]), float(values[0])


def lock_figure(pitch_deg: np.ndarray, turns: np.ndarray) -> Figure:
    """Least and greatest turn per degree of change, over pitch."""
    figure, axes = figures.new_figure(size=(6.4, 3.0))
    axes.axvspan(-18, 18, color="0.9", label="pitch of the hand-held recording")
    for index, name in enumerate(("least turn", "greatest turn")):
        style = figures.line_style(index) | {"markevery": 15}
        axes.plot(pitch_deg, turns[:, index], **style, label=name)
    axes.set(title="How far one degree of angle change turns the camera", xlabel="pitch [degrees]")
    axes.set(ylabel="turn per change [degrees/degree]", ylim=(-0.05, 1.6), xticks=np.arange(-90, 91, 30))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8)
    return figure


def _camera() -> DepthCamera:
    """The SR4000, drawn as far as the corridor reaches."""
    return DepthCamera.sr4000().with_clip_planes(0.1, 45.0)


@functools.cache
def _renderer() -> DepthRenderer:
    camera = _camera()
    return DepthRenderer(corridor_map(), camera, max_batch_pixels=camera.width * camera.height)


def _view_edges(camera: DepthCamera, pose: np.ndarray) -> np.ndarray:
    """World points `(3, 10)` of one line along the edges of the camera's view: apex, corners, and round them."""
    columns, rows = np.array([0, 1, 1, 0]) * camera.width - 0.5, np.array([0, 0, 1, 1]) * camera.height - 0.5
    ends = np.stack([(columns - camera.cx) / camera.fx, (rows - camera.cy) / camera.fy, np.ones(4)], axis=1)
    apex = np.zeros(3)
    line = [apex, ends[0], ends[1], apex, ends[2], ends[3], apex, ends[3], ends[0], ends[1], ends[2]]
    return pose[:3, :3] @ (_VIEW_DEPTH * np.array(line).T) + pose[:3, 3:]


def matrix_text(matrix: np.ndarray) -> str:
    """A pose matrix in columns: the body's axes and its position, in the world frame."""
    heads = "".join(f"{name:>10}" for name in (*AXES, "position"))
    rows = ["".join(f"{value + 0.0:10.2f}" for value in row) for row in np.round(matrix, 2)]
    return "\n".join(
        [f"pose matrix{heads}", *(f"{name:11}{row}" for name, row in zip(("x", "y", "z", ""), rows, strict=True))]
    )


def _matrix_texts(axes: Axes) -> list[Text]:
    """The texts of the first three rows of a 4 x 4 table, row by row; the fourth row never changes.

    Each column has the colour of the axis that it is.
    """
    axes.set(title="Pose matrix, body to world", xlabel="column [-]", ylabel="row [-]")
    axes.set(xlim=(0.5, 4.5), ylim=(4.5, 0.5), xticks=range(1, 5), yticks=range(1, 5))
    axes.set(xticklabels=[*AXES, "position"], yticklabels=["x", "y", "z", ""])
    axes.tick_params(length=0)
    axes.grid(False)
    colours = [*(style["color"] for style in _STYLES), figures.BLACK]
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
        for name, style in zip(AXES, _STYLES, strict=True):
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
