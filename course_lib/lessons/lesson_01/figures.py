"""Figures of lesson 01: turns, frames, optical frame, means of angles, gimbal lock."""

import numpy as np
from matplotlib.figure import Figure

from course_lib.geometry import optical_pose, pose_matrix
from course_lib.lessons.kit.display import described
from course_lib.lessons.lesson_01.poses import AXES
from course_lib.plots import figures

# How each of the body's axes is drawn in every figure of this lesson: colour, line, marker at the tip.
STYLES = (
    {"color": figures.VERMILION, "linestyle": "-", "marker": "o"},
    {"color": figures.GREEN, "linestyle": "--", "marker": "s"},
    {"color": figures.BLUE, "linestyle": ":", "marker": "^"},
)


def turns_figure() -> Figure:
    """Positive yaw, pitch and roll by 30 degrees, each seen along the axis that it turns about."""
    figure, axes = figures.new_figure(1, 3, size=(9.6, 3.4))
    views = (
        (5, (0, 1), "Yaw, from above: to the left", "x [m]", "y [m]"),
        (4, (0, 2), "Pitch, from its right: down", "x [m]", "z [m]"),
        (3, (1, 2), "Roll, from behind: left side up", "y [m] (grows to the left)", "z [m]"),
    )
    for a, (angle, shown, title, x_label, y_label) in zip(axes, views, strict=True):
        turn = np.linspace(0, np.deg2rad(30), 20)[:, None] * np.eye(6)[angle]
        rotations = pose_matrix(turn)[:, list(shown), :3]
        for ends, how in ((rotations[0], {"color": "0.7", "linewidth": 1.2}), (rotations[-1], {"linewidth": 2.2})):
            for (x, y), style in zip(ends.T, STYLES, strict=True):
                if np.hypot(x, y) > 1e-6:
                    a.plot([0, x], [0, y], **(style | {"markevery": [1]} | how))
        path = 0.72 * rotations[:, :, shown[0]]
        a.plot(*path.T, color=figures.BLACK, linewidth=1.2)
        a.annotate("", path[-1], path[-4], arrowprops={"arrowstyle": "->", "color": figures.BLACK})
        a.set(title=title, xlabel=x_label, ylabel=y_label, xlim=(-1.25, 1.25), ylim=(-1.25, 1.25), aspect="equal")
    axes[2].invert_xaxis()
    for name, style in zip(AXES, STYLES, strict=True):
        axes[0].plot([], [], **style, linewidth=2.2, label=name)
    axes[0].plot([], [], color="0.7", label="before the turn")
    axes[0].legend(loc="lower left", fontsize=8, framealpha=0.95)
    alt = "Three turns by 30 degrees: yaw turns forward to the left, pitch turns it down, roll lifts the left side."
    return described(figure, alt)


def order_figure(images: np.ndarray) -> Figure:
    """Depth images after the same two angles in two orders."""
    titles = ["Yaw, then pitch: level", "Pitch, then yaw: crooked"]
    alt = "Two depth images of the corridor with the same two angles in two orders; in the second, edges of walls lean."
    return described(figures.depth_images(images, titles, limits=(1, 5)), alt)


def frames_figure() -> Figure:
    """The three frames: the body frame in the world (left), the optical frame in the body (right)."""
    figure, _ = figures.new_figure(size=(9.4, 3.8))
    figure.clear()
    pose = pose_matrix(np.array([2.0, 1.0, 1.2, 0.0, np.deg2rad(15), np.deg2rad(25)]))
    world, inner = (figure.add_subplot(1, 2, place, projection="3d", computed_zorder=False) for place in (1, 2))
    colours, start = [style["color"] for style in STYLES], pose[:3, 3]
    _draw_frame(world, np.eye(4), "xyz", ["0.35"] * 3, "-")
    _draw_frame(world, pose, AXES, colours, "--")
    world.plot(*np.outer(start, [0, 1]), color="0.5", linestyle=":", linewidth=1.2)
    world.text(*(start / 2 + [0, 0, 0.2]), "position", color="0.3", fontsize=9, ha="right")
    world.set(title="Body frame in the world frame", xlim=(-0.3, 3.1), ylim=(-0.3, 2.3), zlim=(-0.2, 2.2))
    world.set(xlabel="x [m]", ylabel="y [m]", zlabel="z [m]")
    world.set_box_aspect((3.4, 2.6, 2.4), zoom=0.95)
    _draw_frame(inner, np.eye(4), AXES, colours, "-")
    _draw_frame(inner, optical_pose(np.zeros(6)), ("X", "Y", "Z   "), [figures.PURPLE] * 3, "--", length=0.6)
    inner.set(title="Optical frame (X, Y, Z) in the body frame", xlim=(-1, 1), ylim=(-1, 1), zlim=(-1, 1))
    inner.set(xlabel="forward [m]", ylabel="left [m]", zlabel="up [m]")
    inner.set_box_aspect((1, 1, 1), zoom=0.9)
    for axes in (world, inner):
        axes.locator_params(nbins=3)
        axes.view_init(elev=20, azim=-68)
    alt = "Left, the body's axes at a place in the world; right, optical X to the right, Y down and Z forward."
    return described(figure, alt)


def _draw_frame(axes, matrix: np.ndarray, names, colours: list[str], line: str, length: float = 1.0) -> None:
    """Three axes of a frame in a 3D figure, with their names at the tips."""
    for name, colour, arrow in zip(names, colours, length * matrix[:3, :3].T, strict=True):
        axes.plot(*np.transpose([matrix[:3, 3], matrix[:3, 3] + arrow]), color=colour, linestyle=line, linewidth=2.4)
        beyond, above = 1.16, 0.13 if abs(arrow[2]) < 0.5 * length else 0
        if name == "forward":  # the longest name: above the tip it would lie on its axis and leave the box
            beyond, above = 0.8, -0.24
        place = matrix[:3, 3] + beyond * arrow + [0, 0, above]
        axes.text(*place, name, color=colour, ha="center", va="center", fontsize=9)


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
    alt = "Headings on a circle near 180 degrees; the mean of the numbers points away, the mean direction to them."
    return described(figure, alt)


def lock_figure(pitch_deg: np.ndarray, turns: np.ndarray) -> Figure:
    """Least and greatest turn per degree of change `(n, 2)`, over pitch [degrees]."""
    figure, axes = figures.new_figure(size=(6.4, 3.0))
    axes.axvspan(-18, 18, color="0.9", label="pitch of the hand-held recording")
    for index, name in enumerate(("least turn", "greatest turn")):
        axes.plot(pitch_deg, turns[:, index], **figures.line_style(index), markevery=15, label=name)
    axes.set(title="How far one degree of angle change turns the camera", xlabel="pitch [degrees]")
    axes.set(ylabel="turn per change [degrees/degree]", ylim=(-0.05, 1.6), xticks=np.arange(-90, 91, 30))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8)
    alt = "Least and greatest turn over pitch: both 1 at pitch 0; the least falls to 0 at plus and minus 90 degrees."
    return described(figure, alt)
