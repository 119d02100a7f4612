"""Figures of lesson 01: turns, frames, optical frame, means of angles, gimbal lock."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from course_lib.geometry import optical_pose, pose_matrix
from course_lib.lessons.lesson_01.poses import AXES
from course_lib.plots import figures

# How each of the body's axes is drawn in every figure of this lesson: colour, line, marker at the tip.
STYLES = (
    {"color": figures.VERMILION, "linestyle": "-", "marker": "o"},
    {"color": figures.GREEN, "linestyle": "--", "marker": "s"},
    {"color": figures.BLUE, "linestyle": ":", "marker": "^"},
)
_SHOWN_TURN = np.deg2rad(30)


def draw_axes(axes: Axes, state: np.ndarray, shown: tuple[int, int], length: float = 1.0, **style) -> None:
    """The body's three axes, seen along one world axis; `shown` are the two world coordinates that are kept."""
    matrix = pose_matrix(state)
    start = matrix[list(shown), 3]
    for column, own in enumerate(STYLES):
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
    for name, style in zip(AXES, STYLES, strict=True):
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
        own = colour or STYLES[column]["color"]
        axes.plot(*zip(start, end, strict=True), color=own, linestyle=line, linewidth=2.4)
        beyond, above = 1.16, 0.13 if abs(matrix[2, column]) < 0.5 else 0
        if name == "forward":  # the longest name: above the tip it would lie on its axis and leave the box
            beyond, above = 0.8, -0.24
        place = start + beyond * (end - start) + [0, 0, above]
        axes.text(*place, name, color=own, ha="center", va="center", fontsize=9)


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
