"""Figures of F2: a turn about an axis, the tangent space, a lever, errors of means; and the panel with a cloud."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from course_lib.geometry import pose_matrix, rotation_angle, rotation_exp, rotation_log
from courseware.lessons.foundation_2.clouds import MEANS, cloud_about, means_of
from courseware.lessons.kit.display import described
from courseware.lessons.kit.live_figure import LiveFigure
from courseware.lessons.kit.panel import Drawing, Panel, Slider
from courseware.plots import figures

BLUE, ORANGE, GREEN, VERMILION = figures.BLUE, figures.ORANGE, figures.GREEN, figures.VERMILION


def _beside_3d(size: tuple[float, float]) -> tuple[Figure, Axes, Axes]:
    """Return a figure with a 3D drawing on the left and a flat one on the right, both with axes of equal scale."""
    figure, (left, right) = figures.new_figure(1, 2, size=size)
    left.remove()
    space = figure.add_subplot(1, 2, 1, projection="3d", computed_zorder=False)
    space.locator_params(nbins=3)
    right.set_aspect("equal")
    return figure, space, right


def _arrow(axes: Axes, end: np.ndarray, name: str, colour: str, start=None, line: str = "-", at: float = 1.1) -> None:
    """Draw an arrow from `start` (default: the origin) to `end` in two or three dimensions, with its name."""
    start = np.zeros(len(end)) if start is None else start
    axes.plot(*np.transpose([start, end]), color=colour, linestyle=line, linewidth=2.2, marker="o", markevery=[1], ms=4)
    axes.text(*(start + at * (end - start)), name, color=colour, fontsize=10, ha="center", va="center")


def turn_figure(axis: np.ndarray, vector: np.ndarray, angle: float) -> Figure:
    """Draw a vector that turns about a unit axis: in space, and seen against the axis, where only a circle is left."""
    figure, space, seen = _beside_3d((9.4, 4.2))
    along = axis * (axis @ vector)
    across, third = vector - along, np.cross(axis, vector)
    turned = rotation_exp(angle * axis) @ vector
    circle = along + np.array([np.cos(s) * across + np.sin(s) * third for s in np.linspace(0, 2 * np.pi, 90)])
    space.plot(*circle.T, color="0.6", linestyle=":")
    space.plot(*np.transpose([-0.2 * axis, 1.25 * axis]), color="0.3", linewidth=1.2)
    space.text(*(1.33 * axis), "axis k", color="0.3")
    _arrow(space, vector, "v", BLUE)
    _arrow(space, turned, "v'", VERMILION)
    _arrow(space, along, "v∥      ", GREEN, line="--", at=0.75)
    for end in (vector, turned):
        space.plot(*np.transpose([along, end]), color="0.5", linestyle="--", linewidth=1)
    space.set(title="In space: the tip runs along a circle", xlabel="x [-]", ylabel="y [-]")
    space.set(xlim=(-0.9, 0.9), ylim=(-0.9, 0.9), zlim=(0, 1.3))
    space.set_box_aspect((1.8, 1.8, 1.3), zoom=1.1)
    space.view_init(elev=22, azim=-50)
    r = np.linalg.norm(across)
    around = np.linspace(0, 2 * np.pi, 90)
    seen.plot(r * np.cos(around), r * np.sin(around), color="0.6", linestyle=":")
    _arrow(seen, np.array([r, 0.0]), "  v⊥", BLUE)
    _arrow(seen, np.array([0.0, r]), "k × v", GREEN)
    tip = r * np.array([np.cos(angle), np.sin(angle)])
    _arrow(seen, tip, "v'⊥", VERMILION, at=1.16)
    seen.plot(*np.transpose([[tip[0], 0], tip, [0, tip[1]]]), color="0.5", linestyle="--", linewidth=1)
    seen.text(tip[0] / 2, -0.1, "cos θ · v⊥", color=BLUE, ha="center")
    seen.text(-0.05, tip[1] / 2, "sin θ · k × v", color=GREEN, ha="right")
    seen.plot(0.25 * r * np.cos(around[:90] * angle / 6.284), 0.25 * r * np.sin(around * angle / 6.284), color="0.3")
    seen.text(0.3 * np.cos(angle / 2) * r, 0.3 * np.sin(angle / 2) * r, "θ", va="center")
    seen.set(title="Seen from the tip of the axis", xlabel="along v⊥ [-]", ylabel="along k × v [-]")
    seen.set(xlim=(-1.15, 1.15), ylim=(-1.0, 1.15))
    alt = (
        "A vector turns about an axis. Its part along the axis stays, and its part across the axis runs along a circle."
    )
    return described(figure, alt)


def tangent_figure(sigma: float) -> Figure:
    """Draw a tangent: of a circle, on which a turn is a length that is rolled up; and of a sphere, with noise."""
    figure, space, flat = _beside_3d((9.4, 4.2))
    around = np.linspace(-np.pi, np.pi, 200)
    flat.plot(np.cos(around), np.sin(around), color="0.6")
    flat.plot([1, 1], [-1.5, 1.5], color=BLUE, linewidth=1.4)
    flat.text(1.05, -1.5, "tangent: plain numbers ω", color=BLUE)
    for omega, style in ((0.5, "o"), (1.2, "s")):
        flat.plot(1, omega, style, color=BLUE)
        flat.plot(np.cos(omega), np.sin(omega), style, color=VERMILION)
        flat.plot(np.linspace(1, np.cos(omega), 2), [omega, np.sin(omega)], ":", color="0.3")
        flat.text(1.06, omega, f"ω = {omega}", color=BLUE, va="center")
        flat.text(0.9 * np.cos(omega), 0.9 * np.sin(omega), "Exp(ω)", color=VERMILION, ha="right", va="center")
    flat.plot([1, -1], [0, 0], "X", color=figures.BLACK, markersize=8, linestyle="none")
    flat.text(0.9, 0, "no turn", ha="right", va="center", fontsize=8)
    flat.text(-0.9, 0, "half a turn: ω = ±π", va="center", fontsize=8)
    flat.set(title="Turns in the plane are a circle", xlabel="cosine [-]", ylabel="sine [-]")
    flat.set(xlim=(-1.3, 2.4), ylim=(-1.65, 1.65))
    u, v = np.mgrid[0 : 2 * np.pi : 40j, 0 : np.pi : 20j]
    ball = np.cos(u) * np.sin(v), np.sin(u) * np.sin(v), np.cos(v)
    space.plot_surface(*ball, color="0.85", alpha=0.35, linewidth=0)
    base = rotation_exp(np.array([0.0, 0.35, -0.45]))  # its first axis is the point where the plane touches
    corners = 0.75 * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]])
    space.plot(*(base[:, :1] + base[:, 1:] @ corners.T), color=BLUE, linewidth=1.2)
    noise = sigma * np.random.default_rng(2).standard_normal((60, 2))
    space.plot(*(base[:, :1] + base[:, 1:] @ noise.T), "o", color=BLUE, ms=3, label="noise, drawn on the plane")
    turned = rotation_exp(np.column_stack([np.zeros(60), -noise[:, 1], noise[:, 0]]))[:, :, 0] @ base.T
    space.plot(*turned.T, "^", color=VERMILION, ms=3, label="the same, rolled onto the sphere")
    space.set(title="A sphere and the plane that touches it", xlabel="x [-]", ylabel="y [-]")
    space.set(xlim=(-1, 1), ylim=(-1, 1), zlim=(-1, 1))
    space.set_box_aspect((1, 1, 1), zoom=1.15)
    space.view_init(elev=7, azim=-52)
    space.legend(loc="upper left", bbox_to_anchor=(-0.15, 1.0), fontsize=8)
    alt = (
        "A plane touches a sphere, with dots on both. A line touches a circle: its lengths become angles on the circle."
    )
    return described(figure, alt)


def lever_figure(v: np.ndarray, omega: float, arm: float) -> Figure:
    """Draw, from above, a step (straight) and a screw (arc) with the same numbers, and a hand on an arm that turns."""
    figure, (paths, lever) = figures.new_figure(1, 2, size=(9.4, 3.4))
    s = np.linspace(0, 1, 40)[:, None] * omega
    arc = v[0] / omega * np.column_stack([np.sin(s), 1 - np.cos(s)])
    paths.plot([0, v[0]], [0, 0], **(figures.line_style(0) | {"markevery": [1]}), label="step: retract")
    paths.plot(*arc.T, **(figures.line_style(3) | {"markevery": [39]}), label="screw: Exp")
    for place in ((v[0], 0), arc[-1]):
        paths.annotate("", np.add(place, 0.5 * np.array([np.cos(omega), np.sin(omega)])), place,
                       arrowprops={"arrowstyle": "->", "linewidth": 1.6})  # fmt: skip
    paths.plot(0, 0, "D", color=figures.BLACK)
    paths.set(title="The same six numbers, two motions", xlabel="forward [m]", ylabel="left [m]", aspect="equal")
    paths.set(xlim=(-0.2, 2.6), ylim=(-0.3, 2.0))
    paths.legend(loc="upper left")
    turn = np.deg2rad(10)
    for angle, colour, line in ((0.0, BLUE, "-s"), (turn, VERMILION, "--s")):
        lever.plot([0, arm * np.cos(angle)], [0, arm * np.sin(angle)], line, color=colour, lw=2, ms=9, markevery=[1])
    lever.plot(0, 0, "o", color=figures.BLACK, markersize=10)
    lever.text(0, -0.22, "camera: turns", ha="center")
    lever.text(arm, -0.22, "hand: turns and moves", ha="center")
    lever.annotate("", arm * np.array([np.cos(turn), np.sin(turn)]), (arm, 0), arrowprops={"arrowstyle": "->"})
    lever.set(title="A turn here is a turn and a move there", xlabel="forward [m]", ylabel="left [m]", aspect="equal")
    lever.set(xlim=(-0.7, 2.9), ylim=(-0.5, 0.9))
    alt = "From above: a straight step and an arc of the same numbers; a hand that swings when the camera turns."
    return described(figure, alt)


def mean_figure(pitch_deg: np.ndarray, errors_deg: np.ndarray) -> Figure:
    """Draw the error of three means `(n, 3)` over pitch, all in degrees."""
    curves = {name: errors_deg[:, k] for k, name in enumerate(MEANS)}
    labels = {"title": "How far the mean is from the middle of its cloud", "xlabel": "pitch [degrees]"}
    figure, axes = figures.curves_figure(
        pitch_deg, curves, (7.4, 3.0), 1, **labels, ylabel="error [degrees]", yscale="log"
    )
    axes.set_yticks([0.5, 1, 2, 5, 10, 20], ["0.5", "1", "2", "5", "10", "20"])
    alt = (
        "Error over pitch: the mean of rotations stays at half a degree, both means of angles rise from 75 degrees on."
    )
    return described(figure, alt)


CONTROLS = [
    Slider("pitch", "pitch of the middle [degrees]", 0, 90, 0, 1),
    Slider("sigma", "spread about each axis [degrees]", 1, 20, 5, 1),
    Slider("yaw", "yaw of the middle [degrees]", -180, 180, 0, 5),
    Slider("seed", "seed of the noise", 0, 9, 0, 1),
]


def cloud_panel() -> Panel:
    """Move a cloud of 200 orientations: its roll and yaw as numbers, the same cloud in its tangent space, its means."""
    figure, (numbers, tangent) = figures.new_figure(1, 2, size=(9.8, 4.2))
    style = {"color": "0.45", "markersize": 3, "linestyle": "none", "marker": "o"}
    lines = [axes.plot([], [], **style)[0] for axes in (numbers, tangent)]
    numbers.set(title="Roll and yaw, as numbers", xlabel="roll [degrees]", ylabel="yaw [degrees]")
    numbers.set(xlim=(-180, 180), ylim=(-180, 180), xticks=range(-180, 181, 90), yticks=range(-180, 181, 90))
    tangent.set(title="In the tangent space of the middle", xlabel="turn about forward [degrees]")
    tangent.set(ylabel="turn about up [degrees]", xlim=(-60, 60), ylim=(-60, 60), aspect="equal")
    marks = []
    for k, name in enumerate(MEANS):
        look = figures.line_style(k) | {"linestyle": "none", "markersize": 9, "label": f"mean of {name}"}
        marks.append([axes.plot([], [], **look)[0] for axes in (numbers, tangent)])
    tangent.legend(loc="upper left", fontsize=8)
    live = LiveFigure(figure, [*lines, *(mark for pair in marks for mark in pair)])

    def draw(pitch: float, sigma: float, yaw: float, seed: float) -> Drawing:
        middle = np.deg2rad([0.0, pitch, yaw])
        states = cloud_about(middle, np.deg2rad(sigma), seed=int(seed))
        means = means_of(states)
        rotation = pose_matrix(np.concatenate([np.zeros(3), middle]))[:3, :3]
        off = rotation.T @ pose_matrix(np.vstack([states, means]))[:, :3, :3]
        turns = np.rad2deg(rotation_log(off))
        lines[0].set_data(*np.rad2deg(states[:, [3, 5]]).T)
        lines[1].set_data(*turns[: len(states), [0, 2]].T)
        for mean, turn, pair in zip(np.rad2deg(means[:, [3, 5]]), turns[len(states) :, [0, 2]], marks, strict=True):
            pair[0].set_data(*mean[:, None])
            pair[1].set_data(*turn[:, None])
        errors = np.rad2deg(rotation_angle(off[len(states) :]))
        said = ", ".join(f"{name} {error:.1f}" for name, error in zip(MEANS, errors, strict=True))
        roll_spread, yaw_spread = np.rad2deg(states[:, [3, 5]].std(axis=0))
        summary = (
            f"spread [degrees]: roll {roll_spread:.0f}, yaw {yaw_spread:.0f}, about the body's own axes "
            f"{turns[: len(states)].std():.0f}\nerror [degrees] of the mean of: {said}"
        )
        alt = (
            f"A cloud about pitch {pitch:.0f} degrees, as numbers and in the tangent space. {' '.join(summary.split())}"
        )
        return Drawing(live.png(), alt, summary)

    return Panel("F2 a cloud of orientations", CONTROLS, draw)


PANELS = {"F2 a cloud of orientations": cloud_panel}
