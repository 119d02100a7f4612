"""Figures of lesson 02: the idea, registration, fusion, maps, views, the corridor."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from course_lib.lessons.lesson_02.views import cut, room_cut
from course_lib.plots import figures
from course_lib.rendering.scene_map import SceneMap
from course_lib.simulation.sensors.laser_survey import Scan


def idea_figure(scan: Scan) -> Figure:
    """A scanner in the room from above: some of its rays, what they meet, and the shadow of the pillar."""
    figure, axes = figures.new_figure(size=(7.4, 4.2))
    draw_cut(axes, room_cut(False), "black", 1.2, "room, cut at 1.2 m")
    station = scan.true_pose[:3, 3]
    level = int(np.abs(scan.elevations).argmin())
    row = scan.points(scan.true_pose)
    row = row[np.abs(row[:, 2] - station[2]) < 0.02]
    for x, y, _ in row[::6]:
        axes.plot([station[0], x], [station[1], y], color="0.8", linewidth=0.6, zorder=1)
    axes.plot(row[:, 0], row[:, 1], ".", color=figures.VERMILION, markersize=3, label="measured points")
    axes.plot(*station[:2], "s", color=figures.BLUE, markersize=10, label="scanner")
    axes.text(3.25, 2.62, "shadow of\nthe pillar", ha="center", fontsize=9)
    axes.set(title=f"One scan from above ({np.isfinite(scan.ranges[level]).sum()} points in this row)", aspect="equal")
    axes.set(xlabel="x [m]", ylabel="y [m]", xlim=(-0.4, 5.4), ylim=(-0.4, 4.4))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return figure


def registration_figure(stations: tuple[Scan, ...]) -> Figure:
    """Points of two stations on one stretch of floor, by the true poses and by the believed ones."""
    figure, axes = figures.new_figure(1, 2, size=(9.0, 2.9))
    for a, registered in zip(axes, (False, True), strict=True):
        for index, scan in enumerate(stations[:2]):
            p = scan.points(scan.registered_pose if registered else scan.true_pose)
            p = p[(np.abs(p[:, 2]) < 0.15) & (np.abs(p[:, 0] - 2.9) < 0.7) & (np.abs(p[:, 1] - 0.9) < 0.1)]
            style = figures.line_style(index) | {"linestyle": "none", "markersize": 4}
            a.plot(p[:, 0], 1000 * p[:, 2], **style, label=f"station {index + 1}")
        a.axhline(0, color="black", linewidth=1)
        a.set(title="By the believed poses" if registered else "By the true poses", xlabel="x [m]", ylim=(-70, 70))
        a.set_ylabel("height above the floor [mm]")
    axes[1].legend(loc="upper right")
    return figure


def fusion_figure(places: np.ndarray, distances: list[np.ndarray], mean: np.ndarray, crossing: float) -> Figure:
    """Signed distances of two stations along a row of voxels, their mean, and where it crosses zero."""
    figure, axes = figures.new_figure(size=(7.6, 3.0))
    for index, d in enumerate(distances):
        axes.plot(places, d, **(figures.line_style(index) | {"linewidth": 1}), label=f"station {index + 1}")
    axes.plot(places, mean, **(figures.line_style(3) | {"linewidth": 2.4, "marker": ""}), label="mean")
    axes.axhline(0, color="black", linewidth=0.8)
    axes.axvline(crossing, color="0.4", linestyle=":", label="the mean crosses zero")
    axes.set(title="A row of voxels that runs into a wall", xlabel="place along the row [m]")
    axes.set(ylabel="signed distance [m]")
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return figure


def maps_figure(maps: dict[str, SceneMap], door_open: bool = False) -> Figure:
    """Maps of the room side by side, cut at 1.2 m, over the room itself."""
    figure, axes = figures.new_figure(1, len(maps), size=(3.3 * len(maps), 3.0))
    for a, (name, scene_map) in zip(np.atleast_1d(axes), maps.items(), strict=True):
        draw_cut(a, room_cut(door_open), "0.75", 3.0, "room")
        draw_cut(a, cut(scene_map.vertices, scene_map.faces), figures.BLUE, 1.3, "map")
        a.set(title=name, xlabel="x [m]", ylabel="y [m]", xlim=(-0.3, 5.3), ylim=(-0.3, 4.3), aspect="equal")
    a.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return figure


def views_figure(images: dict[str, np.ndarray]) -> Figure:
    """Depth images of the room side by side."""
    return figures.depth_images(list(images.values()), list(images), (0.0, 6.0))


def corridor_figure(scene_map: SceneMap, true_world: SceneMap, x: tuple[float, float] = (5.0, 18.0)) -> Figure:
    """A stretch of the corridor's map over the corridor on the day of the run, both cut 1 m above the floor."""
    figure, axes = figures.new_figure(size=(9.4, 3.2))
    draw_cut(axes, cut(true_world.vertices, true_world.faces, 1.0), figures.VERMILION, 1.0, "world, day of the run")
    draw_cut(axes, cut(scene_map.vertices, scene_map.faces, 1.0), figures.BLUE, 1.6, "map, surveyed another day")
    axes.set(title="The corridor, cut 1 m above the floor", xlabel="x along the corridor [m]", ylabel="y [m]")
    axes.set(xlim=x, ylim=(-1.9, 2.9))
    axes.legend(loc="upper left", ncols=2, framealpha=0.95)
    return figure


def draw_cut(axes: Axes, segments: np.ndarray, colour: str, width: float, label: str) -> LineCollection:
    return axes.add_collection(LineCollection(segments, colors=colour, linewidths=width, label=label))
