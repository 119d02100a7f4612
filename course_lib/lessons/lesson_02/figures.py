"""Figures of lesson 02: the idea, registration, fusion, maps, views, the corridor."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from course_lib.lessons.kit.display import described
from course_lib.lessons.lesson_02.small_room import room
from course_lib.plots import figures
from course_lib.plots.corridor_figures import plane_cut
from course_lib.rendering.scene_map import SceneMap
from course_lib.simulation.sensors.laser_survey import Scan


def cut(scene_map: SceneMap, height: float = 1.2) -> np.ndarray:
    """Segments `(n, 2, 2)` [m] in which a map meets the horizontal plane at `height` [m]."""
    return plane_cut(scene_map.vertices, scene_map.faces, 2, height)


def draw_cut(axes: Axes, scene_map: SceneMap, colour: str, width: float, label: str, height: float = 1.2):
    """Draw where a map meets the horizontal plane at `height` [m]."""
    lines = LineCollection(cut(scene_map, height), colors=colour, linewidths=width, label=label)
    return axes.add_collection(lines)


def idea_figure(scan: Scan) -> Figure:
    """A scanner in the room from above: some of its rays, what they meet, and the shadow of the pillar."""
    figure, axes = figures.new_figure(size=(7.4, 4.2))
    draw_cut(axes, room().mesh(), "black", 1.2, "room, cut at 1.2 m")
    x, y, z = scan.true_pose[:3, 3]
    n_rays = np.isfinite(scan.ranges[np.abs(scan.elevations).argmin()]).sum()
    points = scan.points(scan.true_pose)
    level = points[np.abs(points[:, 2] - z) < 0.02]
    for ends in level[::6]:
        axes.plot([x, ends[0]], [y, ends[1]], color="0.8", linewidth=0.6, zorder=1)
    axes.plot(*level[:, :2].T, ".", color=figures.VERMILION, markersize=3, label="measured points")
    axes.plot(x, y, "s", color=figures.BLUE, markersize=10, label="scanner")
    axes.text(3.25, 2.62, "shadow of\nthe pillar", ha="center", fontsize=9)
    axes.set(title=f"One scan from above ({n_rays} points in this row)", aspect="equal")
    axes.set(xlabel="x [m]", ylabel="y [m]", xlim=(-0.4, 5.4), ylim=(-0.4, 4.4))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    alt = """A room from above with a scanner in its lower left; rays end on walls, a table's edge and a pillar;
        behind the pillar and the cabinet no points are measured."""
    return described(figure, alt)


def registration_figure(stations: tuple[Scan, Scan]) -> Figure:
    """Points of two stations on one stretch of floor, by the true poses and by the believed ones."""
    figure, axes = figures.new_figure(1, 2, size=(9.0, 2.9))
    for a, pose in zip(axes, ("true", "believed"), strict=True):
        for index, scan in enumerate(stations):
            p = scan.points(scan.true_pose if pose == "true" else scan.registered_pose)
            p = p[(np.abs(p - [2.9, 0.9, 0]) < [0.7, 0.1, 0.15]).all(axis=1)]
            style = figures.line_style(index) | {"linestyle": "none", "markersize": 4}
            a.plot(p[:, 0], 1000 * p[:, 2], **style, label=f"station {index + 1}")
        a.axhline(0, color="black", linewidth=1)
        a.set(title=f"By the {pose} poses", xlabel="x [m]", ylabel="height above the floor [mm]", ylim=(-70, 70))
    axes[1].legend(loc="upper right")
    alt = """Points of two stations on the floor: by the true poses at one height, by the believed poses about five
        centimetres apart."""
    return described(figure, alt)


def fusion_figure(places: np.ndarray, distances: list[np.ndarray], mean: np.ndarray, crossing: float) -> Figure:
    """Signed distances of two stations along a row of voxels, their mean, and where it crosses zero."""
    figure, axes = figures.new_figure(size=(7.6, 3.0))
    for index, distance in enumerate(distances):
        axes.plot(places, distance, **(figures.line_style(index) | {"linewidth": 1}), label=f"station {index + 1}")
    axes.plot(places, mean, **(figures.line_style(3) | {"linewidth": 2.4, "marker": ""}), label="mean")
    axes.axhline(0, color="black", linewidth=0.8)
    axes.axvline(crossing, color="0.4", linestyle=":", label="the mean crosses zero")
    axes.set(title="A row of voxels that runs into a wall", xlabel="place along the row [m]")
    axes.set(ylabel="signed distance [m]")
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    alt = "Signed distances of two stations along a row of voxels, both falling through zero near 4 m, and their mean."
    return described(figure, alt)


def maps_figure(maps: dict[str, SceneMap]) -> Figure:
    """Maps of the room side by side, cut at 1.2 m, over the room itself."""
    figure, axes = figures.new_figure(1, len(maps), size=(3.3 * len(maps), 3.0))
    for a, (name, scene_map) in zip(axes, maps.items(), strict=True):
        draw_cut(a, room().mesh(), "0.75", 3.0, "room")
        draw_cut(a, scene_map, figures.BLUE, 1.3, "map")
        a.set(title=name, xlabel="x [m]", ylabel="y [m]", xlim=(-0.3, 5.3), ylim=(-0.3, 4.3), aspect="equal")
    a.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    alt = """Maps from one and from three stations over the room, from above: with one, pieces of wall behind the
        pillar and beside the cabinet are missing."""
    return described(figure, alt)


def views_figure(images: dict[str, np.ndarray]) -> Figure:
    """Depth images of the room side by side."""
    alt = (
        "Depth images from one place in the room: the room, the map from one station with hatched holes, and the map "
        "from three."
    )
    return described(figures.depth_images(list(images.values()), list(images), (0.0, 6.0)), alt)


def corridor_figure(scene_map: SceneMap, true_world: SceneMap) -> Figure:
    """A stretch of the corridor's map over the corridor on the day of the run, both cut 1 m above the floor."""
    figure, axes = figures.new_figure(size=(9.4, 3.2))
    draw_cut(axes, true_world, figures.VERMILION, 1.0, "world, day of the run", height=1.0)
    draw_cut(axes, scene_map, figures.BLUE, 1.6, "map, surveyed another day", height=1.0)
    axes.set(title="The corridor, cut 1 m above the floor", xlabel="x along the corridor [m]", ylabel="y [m]")
    axes.set(xlim=(5.0, 18.0), ylim=(-1.9, 2.9))
    axes.legend(loc="upper left", ncols=2, framealpha=0.95)
    alt = """Thirteen metres of corridor from above: the map's walls cover the world's, but doors stand at other
        angles, and two people are in the world only."""
    return described(figure, alt)
