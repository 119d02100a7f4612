"""Figures of lesson 03, and its panel, which moves the virtual camera and its near plane."""

import functools

import numpy as np
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer
from courseware.lessons.kit.display import described
from courseware.lessons.kit.live_figure import LiveFigure
from courseware.lessons.kit.opengl import vtk
from courseware.lessons.kit.panel import Choice, Drawing, Panel, Slider
from courseware.lessons.lesson_03.scenes import buffer_step, corridor
from courseware.plots import figures

SCENE_ALT = "A corridor of boxes, the camera's frustum in it, and its depth image as a torn surface."

SURFACES = (((3.0, -0.75), (3.4, 0.35)), ((5.2, -1.5), (5.2, 1.6)))  # both ends as depth, height [m]
SLOPES = np.linspace(-0.24, 0.24, 7)  # of the rays of seven pixels, from the side


def side_view() -> dict[str, list[tuple[float, float]]]:
    """Return depth and height [m] where the rays meet the surfaces: each ray's nearest is kept, others are hidden."""
    hits = {"kept": [], "hidden": []}
    for slope in SLOPES:
        depths = []
        for (z0, h0), (z1, h1) in SURFACES:
            share = (slope * z0 - h0) / (h1 - h0 - slope * (z1 - z0))
            depths += [z0 + share * (z1 - z0)] if 0 <= share <= 1 else []
        kept, *hidden = [(z, z * slope) for z in sorted(depths)]
        hits["kept"].append(kept)
        hits["hidden"] += hidden
    return hits


def idea_figure(hits: dict[str, list[tuple[float, float]]]) -> Figure:
    """Draw eq. (6) from the side: rays through pixel centres, the nearest hit of each kept, the others hidden."""
    figure, axes = figures.new_figure(size=(8.2, 3.1))
    for index, surface in enumerate(SURFACES):
        style = figures.line_style(index) | {"marker": "", "linewidth": 3}
        axes.plot(*zip(*surface, strict=True), **style, label=f"surface {index + 1}")
    axes.plot([0, 6.5], np.outer([0, 6.5], SLOPES), color="0.7", linewidth=0.8, zorder=1)
    axes.plot([1, 1], [-0.28, 0.28], color=figures.BLACK, linewidth=1.5)
    axes.annotate("screen: one ray\nper pixel centre", (1, 0.28), (0.75, 0.95), arrowprops={"arrowstyle": "-"})
    kept, hidden = (np.transpose(hits[name]) for name in ("kept", "hidden"))
    axes.plot(*kept, "o", color=figures.VERMILION, markersize=8, label="kept: the least Z of its ray")
    axes.plot(*hidden, "o", color=figures.VERMILION, mfc="white", label="hidden: a larger Z")
    for plane, name in ((0.6, "near"), (6.5, "far")):
        axes.axvline(plane, color=figures.PURPLE, linestyle=":", linewidth=1.6)
        axes.text(plane + 0.05, -1.62, name, color=figures.PURPLE)
    axes.plot(0, 0, "s", color=figures.BLACK, markersize=9)
    axes.text(-0.1, -0.35, "virtual\ncamera", va="top")
    axes.set(xlabel="depth Z along the optical axis [m]", ylabel="height [m]", xlim=(-0.2, 7), ylim=(-1.75, 1.75))
    axes.set_title("What a z-buffer keeps, seen from the side")
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8, frameon=False)
    alt = (
        "Side view: seven rays leave a virtual camera; each keeps its first hit on a surface and drops the later ones."
    )
    return described(figure, alt)


def triangle_figure(images: list[np.ndarray]) -> Figure:
    """Draw a triangle's depth images, by mixing 1/Z and by mixing Z."""
    figure = figures.depth_images(images, ["Mixing 1/Z: right", "Mixing Z: wrong"], limits=(2, 6))
    alt = "Two depth images of one triangle that leans away from the camera; mixing Z makes its middle too far away."
    return described(figure, alt)


def agree_figure(images: list[np.ndarray]) -> Figure:
    """Draw the corridor's end by hand and by VTK."""
    figure = figures.depth_images(images, ["By hand, in NumPy", "By VTK's z-buffer"], limits=(0, 8))
    alt = "Two equal depth images of a corridor's end: a wall at 7.5 m, in front of it a pillar (left) and a crate."
    return described(figure, alt)


def window_figure(images: np.ndarray, columns: int) -> Figure:
    """Draw depth images `(N, H, W)` [m] as the tiles of one window, N a multiple of `columns`."""
    n, height, width = images.shape
    window = images.reshape(-1, columns, height, width).swapaxes(1, 2).reshape(-1, columns * width)
    figure, axes = figures.new_figure(size=(7.4, 4.3))
    drawn = figures.depth_image(axes, window, f"One window, {n} tiles: one view per particle", (0, 15))
    across, down = np.arange(columns + 1) * width, np.arange(n // columns + 1) * height
    axes.set(xticks=across - 0.5, yticks=down - 0.5, xticklabels=across, yticklabels=down)
    axes.set(xlabel="window column [pixels]", ylabel="window row [pixels]")
    axes.grid(color="white", linewidth=1.2, alpha=1)
    figures.colour_bar(figure, drawn, axes)
    alt = "Twenty small depth images of the corridor in five columns and four rows, each from a slightly other pose."
    return described(figure, alt)


def buffer_figure() -> Figure:
    """Draw the depth buffer's value over depth for three near planes, and far = 30 m."""
    figure, axes = figures.new_figure(size=(6.4, 3.0))
    for index, near in enumerate((1.0, 0.1, 0.01)):
        z, style = np.geomspace(near, 30.0, 200), figures.line_style(index) | {"markevery": 12}
        axes.plot(z, 30.0 * (z - near) / (z * (30.0 - near)), **style, label=f"near = {near:g} m")
    axes.set(xlabel="depth Z [m]", ylabel="buffer value b [-]", xlim=(-0.2, 10), ylim=(-0.02, 1.03))
    axes.set_title("The depth buffer's value is not linear in Z")
    axes.legend(loc="lower right")
    alt = "Buffer value over depth for near planes at 1, 0.1 and 0.01 m: steep at first, then close to 1 for good."
    return described(figure, alt)


def time_figure(counts: list[int], tiled: np.ndarray, single: np.ndarray) -> Figure:
    """Draw the time of a view [ms], from seconds, over the number of views."""
    figure, axes = figures.new_figure(size=(5.4, 2.8))
    for index, (seconds, name) in enumerate(((tiled, "tiles of one window"), (single, "one after the other"))):
        axes.plot(counts, seconds * 1000, **figures.line_style(index), label=name)
    axes.set(title="Time for one view, on this computer", xlabel="views [-]", ylabel="time per view [ms]")
    axes.set(xscale="log", xticks=counts, xticklabels=counts, ylim=(0, None))
    axes.minorticks_off()
    axes.legend()
    alt = "Time per view over the number of views, on this computer: as tiles of one window and one after the other."
    return described(figure, alt)


CONTROLS = [
    Slider("x", "x [m]", 0.2, 7.8, 0.5, 0.1),
    Slider("y", "y [m]", -1.4, 1.4, 0.0, 0.1),
    Slider("yaw", "yaw [degrees]", -180, 180, 0, 1),
    Choice("near", "near plane [m]", ("1", "0.5", "0.1", "0.01", "0.001", "0.0001"), "0.1"),
]
CAMERA = DepthCamera.sr4000()


@functools.cache
def renderer_of(near: float, backend: str) -> DepthRenderer:
    return DepthRenderer(corridor(), DepthCamera.sr4000(near=near), backend, exact=True, max_batch_pixels=176 * 144)


def camera_panel() -> Panel:
    """Move the virtual camera and its near plane. See the depth image and how far it is from ray casting."""
    figure, (plan, left, right) = figures.new_figure(1, 3, size=(9.8, 3.0))
    plan.plot([0, 8, 8, 0], [-1.5, -1.5, 1.5, 1.5], color=figures.BLACK)  # open behind
    for x, y, size in ((5.0, 0.5, 0.3), (4.0, -0.8, 0.5)):
        plan.plot([x, x + size, x + size, x, x], [y, y, y + size, y + size, y], color=figures.BLACK)
    (wedge,) = plan.plot([], [], color=figures.VERMILION, linewidth=1.6)
    (near_line,) = plan.plot([], [], color=figures.PURPLE, linestyle=":", linewidth=2, label="near plane")
    plan.legend(loc="upper left", fontsize=7)
    plan.set(xlim=(-0.5, 8.5), ylim=(-3, 3), title="From above", xlabel="x [m]", ylabel="y [m]", aspect="equal")
    depth = figures.depth_image(left, np.zeros(CAMERA.shape), "What the virtual camera sees", (0, 8))
    error = figures.depth_image(right, np.ones(CAMERA.shape), "Difference from ray casting", (0, 1))
    error.set_norm(LogNorm(0.001, 1000))
    figures.colour_bar(figure, depth, left)
    figures.colour_bar(figure, error, right, "|difference| [mm]")
    live = LiveFigure(figure, [wedge, near_line, depth, error])

    def draw(x: float, y: float, yaw: float, near: str) -> Drawing:
        plane, heading = float(near), np.deg2rad(yaw)
        state = np.array([x, y, 1.2, 0, 0, heading])
        image, truth = (renderer_of(plane, backend).render(state)[0] for backend in (vtk(), "ray"))
        with np.errstate(invalid="ignore"):
            off_mm = np.abs(image.astype(float) - truth) * 1000
        depth.set_data(np.ma.masked_invalid(image))
        error.set_data(np.ma.masked_invalid(np.clip(off_mm, 0.001, None)))
        ahead, aside = np.array([[np.cos(heading), np.sin(heading)], [-np.sin(heading), np.cos(heading)]])
        slope = CAMERA.width / 2 / CAMERA.fx
        half = max(plane * slope, 0.5)  # drawn beyond the view: at 0.1 m only 8 cm of the plane are in view
        view = [(0, 0), (1.6, -1.6 * slope), (1.6, 1.6 * slope), (0, 0)]
        for line, points in ((wedge, view), (near_line, [(plane, half), (plane, -half)])):
            line.set_data(*(state[:2] + np.array(points) @ [ahead, aside]).T)
        middle = truth[CAMERA.height // 2, CAMERA.width // 2]
        step_mm, hit_nothing = buffer_step(middle, plane, CAMERA.far) * 1000, np.isinf(image).mean()
        seen = f"Z = {middle:.2f} m; one step of the z-buffer there: {step_mm:.2g} mm"
        lines = [
            f"middle pixel: {seen if middle < np.inf else 'nothing hit'}",
            f"pixels where nothing is hit: {hit_nothing:.0%}; pixels more than 1 mm off: {(off_mm > 1).mean():.0%}",
        ]
        alt = f"""Plan of the corridor with the camera at x {x:.1f} m, y {y:.1f} m, yaw {yaw:.0f} degrees; its depth
            image; and the difference from ray casting with near plane {near} m. {" ".join(lines)}"""
        return Drawing(live.png(), alt, "\n".join(lines))

    return Panel("03 the virtual camera", CONTROLS, draw)


PANELS = {"03 the virtual camera": camera_panel}
