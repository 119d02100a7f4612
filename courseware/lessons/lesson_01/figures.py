"""Figures of lesson 01, and its panel, in which six sliders drive a camera through the corridor."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from course_lib.geometry import optical_pose, pose_matrix, rotation_log
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer
from courseware.lessons.kit.corridor_data import corridor_map, draw_walls
from courseware.lessons.kit.display import described
from courseware.lessons.kit.live_figure import LiveFigure
from courseware.lessons.kit.panel import Drawing, Panel, Slider
from courseware.plots import figures
from courseware.plots.scenes import frustum

SCENE_ALT = "Three cameras in the corridor, each with its frustum and its axes, each turned by one angle."

AXES = ("forward", "left", "up")  # of the body, in the order of a pose matrix's columns
# How every figure of this lesson draws these axes, with the marker at the tip.
COLOURS = (figures.VERMILION, figures.GREEN, figures.BLUE)
STYLES = [
    {"color": colour, "linestyle": line, "marker": marker, "markevery": [1]}
    for colour, line, marker in zip(COLOURS, ("-", "--", ":"), "os^", strict=True)
]


def turns_figure() -> Figure:
    """Draw positive yaw, pitch and roll by 30 degrees, each seen along the axis that it turns about."""
    figure, axes = figures.new_figure(1, 3, size=(9.6, 3.4))
    views = (
        (5, (1, 0), "Yaw to the left, from above", "y [m] (grows to the left)", "x [m]"),
        (4, (0, 2), "Pitch down, from the right", "x [m]", "z [m]"),
        (3, (1, 2), "Roll, left side up, from behind", "y [m] (grows to the left)", "z [m]"),
    )
    for a, (angle, shown, title, x_label, y_label) in zip(axes, views, strict=True):
        turn = np.linspace(0, np.deg2rad(30), 20)[:, None] * np.eye(6)[angle]
        rotations = pose_matrix(turn)[:, list(shown), :3]
        for ends, how in ((rotations[0], {"color": "0.7", "linewidth": 1.2}), (rotations[-1], {"linewidth": 2.2})):
            for (x, y), style in zip(ends.T, STYLES, strict=True):
                if np.hypot(x, y) > 1e-6:
                    a.plot([0, x], [0, y], **(style | how))
        path = 0.72 * rotations[:, :, min(shown)]
        a.plot(*path.T, color=figures.BLACK, linewidth=1.2)
        a.annotate("", path[-1], path[-4], arrowprops={"arrowstyle": "->", "color": figures.BLACK})
        a.set(title=title, xlabel=x_label, ylabel=y_label, xlim=(-1.25, 1.25), ylim=(-1.25, 1.25), aspect="equal")
    for a in axes[[0, 2]]:
        a.invert_xaxis()  # the body's left is on the left
    for name, style in zip(AXES, STYLES, strict=True):
        axes[0].plot([], [], **(style | {"markevery": None}), linewidth=2.2, label=name)
    axes[0].plot([], [], color="0.7", label="before the turn")
    axes[0].legend(loc="lower right", fontsize=8, framealpha=0.95)
    alt = "Three turns by 30 degrees: yaw turns forward to the left, pitch turns it down, roll lifts the left side."
    return described(figure, alt)


def order_figure(images: np.ndarray) -> Figure:
    """Draw depth images after the same two angles in two orders."""
    titles = ["Yaw, then pitch: level", "Pitch, then yaw: crooked"]
    alt = "Two depth images of the corridor with the same two angles in two orders; in the second, edges of walls lean."
    return described(figures.depth_images(images, titles, limits=(1, 5)), alt)


def frames_figure() -> Figure:
    """Draw the three frames: the body frame in the world (left), the optical frame in the body (right)."""
    figure, _ = figures.new_figure(size=(9.4, 3.8))
    figure.clear()
    pose = pose_matrix(np.array([2.0, 1.0, 1.2, 0.0, np.deg2rad(15), np.deg2rad(25)]))
    world, inner = (figure.add_subplot(1, 2, place, projection="3d", computed_zorder=False) for place in (1, 2))
    _draw_frame(world, np.eye(4), "xyz", ["0.35"] * 3, "-")
    _draw_frame(world, pose, AXES, COLOURS, "--")
    world.plot(*np.outer(pose[:3, 3], [0, 1]), color="0.5", linestyle=":", linewidth=1.2)
    world.text(*(pose[:3, 3] / 2 + [0, 0, 0.2]), "position", color="0.3", fontsize=9, ha="right")
    world.set(title="Body frame in the world frame", xlim=(-0.3, 3.1), ylim=(-0.3, 2.3), zlim=(-0.2, 2.2))
    world.set(xlabel="x [m]", ylabel="y [m]", zlabel="z [m]")
    world.set_box_aspect((3.4, 2.6, 2.4), zoom=0.95)
    _draw_frame(inner, np.eye(4), AXES, COLOURS, "-")
    _draw_frame(inner, optical_pose(np.zeros(6)), ("X", "Y", "Z   "), [figures.PURPLE] * 3, "--", length=0.6)
    inner.set(title="Optical frame (X, Y, Z) in the body frame", xlim=(-1, 1), ylim=(-1, 1), zlim=(-1, 1))
    inner.set(xlabel="forward [m]", ylabel="left [m]", zlabel="up [m]")
    inner.set_box_aspect((1, 1, 1), zoom=0.9)
    for axes in (world, inner):
        axes.locator_params(nbins=3)
        axes.view_init(elev=20, azim=-68)
    alt = "Left, the body's axes at a place in the world; right, optical X to the right, Y down and Z forward."
    return described(figure, alt)


def _draw_frame(axes: Axes, matrix: np.ndarray, names, colours, line: str, length: float = 1.0) -> None:
    """Draw three axes of a frame in a 3D figure, with their names at the tips."""
    for name, colour, arrow in zip(names, colours, length * matrix[:3, :3].T, strict=True):
        axes.plot(*np.transpose([matrix[:3, 3], matrix[:3, 3] + arrow]), color=colour, linestyle=line, linewidth=2.4)
        beyond, above = 1.16, 0.13 if abs(arrow[2]) < 0.5 * length else 0
        if name == "forward":  # the longest name: above the tip it would lie on its axis and leave the box
            beyond, above = 0.8, -0.24
        place = matrix[:3, 3] + beyond * arrow + [0, 0, above]
        axes.text(*place, name, color=colour, ha="center", va="center", fontsize=9)


def mean_figure(headings: np.ndarray, as_numbers: float, on_circle: float) -> Figure:
    """Draw headings as points of the unit circle, with their mean as numbers and their mean direction."""
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


def turn_per_degree(pitch: float) -> tuple[float, float]:
    """Return the least and greatest turn for a small change of (roll, pitch, yaw) of length one; pitch in radians.

    They are the singular values of the Jacobian, whose columns are the turns that a small change of each angle makes.
    By hand they are sqrt(1 - |sin pitch|) and sqrt(1 + |sin pitch|).
    """
    base, step = np.array([0, 0, 0, 0.1, pitch, 0.2]), np.deg2rad(0.01)
    before, *after = pose_matrix(base + step * np.eye(6)[[0, 3, 4, 5]] * [0, 0, 0, 1, 1, 1])[:, :3, :3]
    greatest, _, least = np.linalg.svd(rotation_log(before.T @ np.array(after)) / step, compute_uv=False)
    return least, greatest


def lock_figure(pitch_deg: np.ndarray, turns: np.ndarray) -> Figure:
    """Draw the least and greatest turn per degree of change `(n, 2)` over pitch [degrees]."""
    figure, axes = figures.new_figure(size=(6.4, 3.0))
    axes.axvspan(-16, 16, color="0.9", label="pitch of the hand-held recording")
    for index, name in enumerate(("least turn", "greatest turn")):
        axes.plot(pitch_deg, turns[:, index], **figures.line_style(index), markevery=15, label=name)
    axes.set(title="How far one degree of angle change turns the camera", xlabel="pitch [degrees]")
    axes.set(ylabel="turn per change [degrees/degree]", ylim=(-0.05, 1.6), xticks=np.arange(-90, 91, 30))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8)
    alt = "Least and greatest turn over pitch: both 1 at pitch 0; the least falls to 0 at plus and minus 90 degrees."
    return described(figure, alt)


CAMERA = DepthCamera.sr4000(0.1, 45.0)  # draws as far as the corridor reaches
CONTROLS = [
    Slider("x", "x [m]", 8.5, 19.5, 10.0, 0.1),
    Slider("y", "y [m]", -1.0, 1.0, 0.0, 0.1),
    Slider("z", "z [m]", 0.3, 2.2, 1.2, 0.1),
    Slider("roll", "roll [degrees]", -180, 180, 0, 1),
    Slider("pitch", "pitch [degrees]", -90, 90, 0, 1),
    Slider("yaw", "yaw [degrees]", -180, 180, 0, 1),
]


def _matrix_texts(axes: Axes) -> np.ndarray:
    """Return the texts (3, 4) of the first rows of a pose matrix; each column has the colour of its axis."""
    axes.set(title="Pose matrix, body to world")
    axes.set(xlim=(0.5, 4.5), ylim=(4.5, 0.5), xticks=range(1, 5), yticks=range(1, 5))
    axes.set(xticklabels=[*AXES, "position"], yticklabels=["x", "y", "z", ""])
    axes.tick_params(length=0)
    axes.grid(False)
    for label, colour in zip(axes.get_xticklabels(), [*COLOURS, figures.BLACK], strict=True):
        label.set_color(colour)
    texts = [
        [axes.text(c, r, f"{c == 4:.2f}", color=colour, ha="center", va="center", fontsize=10) for r in range(1, 5)]
        for c, colour in enumerate([*COLOURS, figures.BLACK], start=1)
    ]
    return np.transpose(texts)[:3]  # the fourth row never changes


def drive_panel() -> Panel:
    """Drive a camera through the corridor with six sliders: its axes in two views, its pose matrix, its depth image."""
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
        a.set(xlim=(8.0, 20.5), aspect="equal")  # portal and side corridor (chosen)
        drawn += a.plot([], [], color="0.35", linewidth=0.9)
        for name, style in zip(AXES, STYLES, strict=True):
            drawn += a.plot([], [], **style, linewidth=2.4, markersize=5, label=name)
    plan.legend(loc="upper left", ncols=3, fontsize=8, framealpha=0.95)
    depth = figures.depth_image(screen, np.zeros(CAMERA.shape), "Depth image (yellow: 10 m and more)", (0, 10))
    figures.colour_bar(figure, depth, screen)
    texts = _matrix_texts(corner)
    live = LiveFigure(figure, [*drawn, depth, *texts.flat])

    def draw(x: float, y: float, z: float, roll: float, pitch: float, yaw: float) -> Drawing:
        state = np.array([x, y, z, *np.deg2rad([roll, pitch, yaw])])
        matrix, image = pose_matrix(state), renderer.render(state)[0]
        depth.set_data(np.ma.masked_invalid(image))
        # One line along all edges of the view, from the apex round the corners, and the three axes.
        lines = [frustum(CAMERA, state, far=1.6).points[[0, 5, 6, 0, 7, 8, 0, 8, 5, 6, 7]].T]
        lines += [np.column_stack([matrix[:3, 3], matrix[:3, 3] + 0.7 * axis]) for axis in matrix[:3, :3].T]
        for k, line in enumerate(lines):
            drawn[k].set_data(*line[[0, 1]])
            drawn[k + 4].set_data(*line[[0, 2]])
        rounded = np.round(matrix[:3], 2) + 0.0
        for text, value in zip(texts.flat, rounded.flat, strict=True):
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
