"""Lesson 03, GPU scene simulation: its small scenes, figures and panel."""

from __future__ import annotations

import functools
import time

import numpy as np
import trimesh
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from course_lib.depth_mcl.camera import DepthCamera
from course_lib.depth_mcl.rendering.renderer import DepthRenderer
from course_lib.depth_mcl.scene_map import SceneMap
from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Choice, Drawing, Panel, Slider
from course_lib.lessons.kit.progress_bar import progress
from course_lib.plots import figures

# Bits that tell depths apart in a depth buffer, whether 24-bit whole numbers or float32 just below 1.
DEPTH_BUFFER_BITS = 24
# The side view of the idea: two surfaces (ends as depth, height in metres) and the slopes of seven rays.
_SURFACES = (((3.0, -0.75), (3.4, 0.35)), ((5.2, -1.5), (5.2, 1.6)))
SLOPES = np.linspace(-0.24, 0.24, 7)
_NEAR_PLANES = ("1", "0.5", "0.1", "0.01", "0.001", "0.0001")


def box_map(*boxes: tuple[tuple, tuple]) -> SceneMap:
    """A map of boxes, each given by two opposite corners (x, y, z) in metres."""
    meshes = [trimesh.creation.box(bounds=np.array(corners, dtype=float)) for corners in boxes]
    mesh = trimesh.util.concatenate(meshes)
    return SceneMap(mesh.vertices, mesh.faces)


def corridor_end() -> SceneMap:
    """What stands ahead at the end of a corridor: the end wall (8 m), a pillar (5 m) and a crate (4 m)."""
    return box_map(
        ((8.0, -1.5, 0.0), (8.2, 1.5, 2.6)),
        ((5.0, 0.5, 0.0), (5.3, 0.8, 2.6)),
        ((4.0, -0.8, 0.0), (4.5, -0.3, 0.7)),
    )


def corridor() -> SceneMap:
    """The same with floor, ceiling and side walls: 3 m wide, 2.6 m high, 8 m long."""
    ahead = corridor_end()
    shell = box_map(
        ((0.0, -1.5, -0.1), (8.2, 1.5, 0.0)),
        ((0.0, -1.5, 2.6), (8.2, 1.5, 2.7)),
        ((0.0, 1.5, 0.0), (8.2, 1.6, 2.6)),
        ((0.0, -1.6, 0.0), (8.2, -1.5, 2.6)),
    )
    faces = np.concatenate([ahead.faces, shell.faces + len(ahead.vertices)])
    return SceneMap(np.concatenate([ahead.vertices, shell.vertices]), faces)


def side_view() -> dict[str, list[tuple[float, float]]]:
    """Rays of seven pixels against two surfaces, from the side: depth and height [m] of the kept and hidden hits."""
    hits = {"kept": [], "hidden": []}
    for slope in SLOPES:
        depths = sorted(z for z in (_crossing(slope, start, end) for start, end in _SURFACES) if z is not None)
        hits["kept"].append((depths[0], depths[0] * slope))
        hits["hidden"] += [(z, z * slope) for z in depths[1:]]
    return hits


def slanted_wall_error(near: float) -> np.ndarray:
    """|z-buffer - exact depth| [m] at every pixel, for a wall about 7.5 m ahead, turned by 30 degrees."""
    camera = DepthCamera.sr4000(near=near)
    turn = np.deg2rad(30)
    along, up = np.array([np.sin(turn), np.cos(turn), 0.0]), np.array([0.0, 0.0, 1.0])
    middle = np.array([7.5, 0.0, 0.0])
    corners = [middle + a * along + b * up for a, b in ((-9, -9), (9, -9), (9, 9), (-9, 9))]
    with DepthRenderer(SceneMap(np.array(corners), np.array([[0, 1, 2], [0, 2, 3]])), camera) as renderer:
        image = renderer.render(np.zeros(6))[0]
    # Plane n . p = d in the body frame (x forward, y left): with p = Z (1, -ray x, -ray y), Z = d / (n . (1, ...)).
    normal = np.cross(along, up)
    rays = camera.rays()
    exact = (normal @ middle) / (normal[0] - normal[1] * rays[..., 0] - normal[2] * rays[..., 1])
    return np.abs(image - exact)


def seconds_per_view(
    scene_map: SceneMap, camera: DepthCamera, states: np.ndarray, counts: list[int], repeats: int = 4
) -> tuple[np.ndarray, np.ndarray]:
    """Seconds a view for each count, the best of a few repeats: as tiles of one window, and one after the other."""
    tiled, single = np.full((2, len(counts)), np.inf)
    with DepthRenderer(scene_map, camera) as window, DepthRenderer(scene_map, camera) as alone:
        for _ in progress(range(repeats), "measuring times"):
            for index, count in enumerate(counts):
                started = time.perf_counter()
                window.render(states[:count])
                between = time.perf_counter()
                for state in states[:count]:
                    alone.render(state)
                tiled[index] = min(tiled[index], (between - started) / count)
                single[index] = min(single[index], (time.perf_counter() - between) / count)
    return tiled, single


def pole_ahead(distance: float, width: float) -> SceneMap:
    """A pole of square section, `width` metres thick, `distance` metres ahead of the origin."""
    half = width / 2
    return box_map(((distance, -half, -1.0), (distance + width, half, 1.0)))


def views_that_see(scene_map: SceneMap, n_views: int = 200) -> float:
    """Share of views, turned a little from one to the next, in which at least one pixel hits the map."""
    camera = DepthCamera(width=176, height=1, fx=220.0, fy=231.2, cx=87.5, cy=0.0)
    states = np.zeros((n_views, 6))
    states[:, 5] = np.linspace(-0.1, 0.1, n_views)
    with DepthRenderer(scene_map, camera) as renderer:
        return np.isfinite(renderer.render(states)).any(axis=(1, 2)).mean()


def wall_with_hole(radius: float) -> SceneMap:
    """A wall of small triangles 4 m ahead, 6 m by 6 m, with a hole: none within `radius` metres of its middle."""
    n = 121
    y, z = np.meshgrid(np.linspace(-3, 3, n), np.linspace(-3, 3, n))
    vertices = np.stack([np.full(n * n, 4.0), y.ravel(), z.ravel()], axis=1)
    first = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    faces = np.concatenate([first[:, None] + [0, 1, n], first[:, None] + [1, n + 1, n]])
    centres = vertices[faces].mean(axis=1)
    return SceneMap(vertices, faces[np.hypot(centres[:, 1], centres[:, 2]) > radius])


def idea_figure(hits: dict[str, list[tuple[float, float]]]) -> Figure:
    """Side view of eq. (6): rays through pixel centres, the nearest hit of each kept, the others hidden."""
    figure, axes = figures.new_figure(size=(8.2, 3.1))
    near, far = 0.6, 6.5
    for index, (start, end) in enumerate(_SURFACES):
        style = figures.line_style(index) | {"marker": "", "linewidth": 3}
        axes.plot(*zip(start, end, strict=True), **style, label=f"surface {index + 1}")
    for slope in SLOPES:
        axes.plot([0, far], [0, far * slope], color="0.7", linewidth=0.8, zorder=1)
    axes.plot([1, 1], [-0.28, 0.28], color=figures.BLACK, linewidth=1.5)
    axes.annotate("screen: one ray\nper pixel centre", (1, 0.28), (0.75, 0.95), arrowprops={"arrowstyle": "-"})
    kept, hidden = (list(zip(*hits[name], strict=True)) for name in ("kept", "hidden"))
    axes.plot(*kept, "o", color=figures.VERMILION, markersize=8, label="kept: the least Z of its ray")
    axes.plot(*hidden, "o", mfc="white", color=figures.VERMILION, label="hidden: a larger Z")
    for position, name in ((near, "near"), (far, "far")):
        axes.axvline(position, color=figures.PURPLE, linestyle=":", linewidth=1.6)
        axes.text(position + 0.05, -1.62, name, color=figures.PURPLE)
    axes.plot(0, 0, "s", color=figures.BLACK, markersize=9)
    axes.text(-0.1, -0.35, "virtual\ncamera", va="top")
    axes.set(xlim=(-0.2, 7), ylim=(-1.75, 1.75), title="What a z-buffer keeps, seen from the side")
    axes.set(xlabel="depth Z along the optical axis [m]", ylabel="height [m]")
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8, frameon=False)
    return figure


def _crossing(slope: float, start: tuple, end: tuple) -> float | None:
    """Depth at which the ray height = slope * depth meets the segment; None where it passes by."""
    (z0, h0), (z1, h1) = start, end
    share = (slope * z0 - h0) / ((h1 - h0) - slope * (z1 - z0))
    return z0 + share * (z1 - z0) if 0 <= share <= 1 else None


def depth_figure(images: list[np.ndarray], titles: list[str], limits: tuple[float, float]) -> Figure:
    """Depth images in metres side by side, with one colour bar."""
    figure, axes = figures.new_figure(1, len(images), size=(3.3 * len(images) + 0.9, 2.9))
    axes = np.atleast_1d(axes)
    for a, image, title in zip(axes, images, titles, strict=True):
        drawn = figures.depth_image(a, image, title, limits)
    figures.colour_bar(figure, drawn, axes)
    return figure


def window_figure(images: np.ndarray, columns: int, limits: tuple[float, float]) -> Figure:
    """Depth images `(N, H, W)` as the tiles of one window, N a multiple of `columns`."""
    n, height, width = images.shape
    window = images.reshape(n // columns, columns, height, width).swapaxes(1, 2).reshape(-1, columns * width)
    figure, axes = figures.new_figure(size=(7.4, 4.3))
    drawn = figures.depth_image(axes, window, f"One window, {n} tiles: one view per particle", limits)
    axes.set(xticks=np.arange(columns + 1) * width - 0.5, yticks=np.arange(n // columns + 1) * height - 0.5)
    axes.set(xticklabels=np.arange(columns + 1) * width, yticklabels=np.arange(n // columns + 1) * height)
    axes.grid(color="white", linewidth=1.2, alpha=1)
    axes.set(xlabel="window column [pixels]", ylabel="window row [pixels]")
    figures.colour_bar(figure, drawn, axes)
    return figure


def buffer_figure(far: float = 30.0) -> Figure:
    """The depth buffer's value over depth for three near planes."""
    figure, axes = figures.new_figure(size=(6.4, 3.0))
    for index, near in enumerate((1.0, 0.1, 0.01)):
        z = np.geomspace(near, far, 200)
        style = figures.line_style(index) | {"markevery": 12}
        axes.plot(z, far * (z - near) / (z * (far - near)), **style, label=f"near = {near:g} m")
    axes.set(title="The depth buffer's value is not linear in Z", xlabel="depth Z [m]", ylabel="buffer value b [-]")
    axes.set(xlim=(-0.2, 10), ylim=(-0.02, 1.03))
    axes.legend(loc="lower right")
    return figure


def time_figure(counts: list[int], tiled: np.ndarray, single: np.ndarray) -> Figure:
    """Milliseconds a view over the number of views, as tiles of one window and one after the other."""
    figure, axes = figures.new_figure(size=(5.4, 2.8))
    axes.plot(counts, tiled * 1000, **figures.line_style(0), label="tiles of one window")
    axes.plot(counts, single * 1000, **figures.line_style(1), label="one after the other")
    axes.set(title="Time for one view, on this computer", xlabel="views [-]", ylabel="time per view [ms]")
    axes.set(xscale="log", xticks=counts, xticklabels=counts, ylim=(0, None))
    axes.minorticks_off()
    axes.legend()
    return figure


def buffer_step(z: np.ndarray | float, near: float, far: float) -> np.ndarray | float:
    """Depth in metres between two neighbouring values of the depth buffer at depth z: dZ/db 2^-24."""
    return z**2 * (far - near) / (near * far) * 2.0**-DEPTH_BUFFER_BITS


@functools.cache
def _renderer(near: float, backend: str) -> DepthRenderer:
    camera = DepthCamera.sr4000(near=near)
    return DepthRenderer(corridor(), camera, backend, max_batch_pixels=camera.width * camera.height)


def camera_panel() -> Panel:
    """Move the virtual camera and its near plane; see the depth image and how far it is from ray casting."""
    figure, (plan, left, right) = figures.new_figure(1, 3, size=(9.8, 3.0))
    walls = [(0, -1.5, 8, 3), (5.0, 0.5, 0.3, 0.3), (4.0, -0.8, 0.5, 0.5)]
    for x, y, length, width in walls:
        plan.plot([x, x + length, x + length, x, x], [y, y, y + width, y + width, y], color=figures.BLACK)
    (wedge,) = plan.plot([], [], color=figures.VERMILION, linewidth=1.6)
    (near_line,) = plan.plot([], [], color=figures.PURPLE, linestyle=":", linewidth=2)
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
        cut = plane / np.cos(half)
        near_line.set_data(x + cut * np.cos(ends[::2]), y + cut * np.sin(ends[::2]))
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
