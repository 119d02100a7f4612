"""Figures of lesson 02, and its panel, in which you plan a laser survey and see the map that it gives."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from course_lib.rendering.scene_map import SceneMap
from courseware.lessons.kit.display import described
from courseware.lessons.kit.live_figure import LiveFigure
from courseware.lessons.kit.panel import Choice, Drawing, Panel, Slider, Switch
from courseware.lessons.lesson_02 import small_room
from courseware.lessons.lesson_02.small_room import CAMERA, STATIONS, room
from courseware.plots import figures
from courseware.plots.corridor_figures import plane_cut
from courseware.simulation.sensors.laser_survey import Scan

SCENE_ALT = "A room without ceiling, dark where the map is right; behind the pillar a bright strip stands in the air."

ROOM_FROM_ABOVE = {"xlabel": "x [m]", "ylabel": "y [m]", "xlim": (-0.3, 5.3), "ylim": (-0.3, 4.3), "aspect": "equal"}


def draw_cut(axes: Axes, scene_map: SceneMap, colour: str, width: float, label: str, height: float = 1.2):
    """Draw where a map meets the horizontal plane at `height` [m]."""
    lines = plane_cut(scene_map.vertices, scene_map.faces, 2, height)
    return axes.add_collection(LineCollection(lines, colors=colour, linewidths=width, label=label))


def idea_figure(scan: Scan) -> Figure:
    """Draw a scanner in the room from above: some of its rays, what they meet, and the shadow of the pillar."""
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
    axes.set(title=f"One scan from above ({n_rays} points in this row)", **ROOM_FROM_ABOVE)
    axes.set(xlim=(-0.4, 5.4), ylim=(-0.4, 4.4))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    alt = """A room from above with a scanner in its lower left; rays end on walls, a table's edge and a pillar;
        behind the pillar and the cabinet no points are measured."""
    return described(figure, alt)


def registration_figure(stations: tuple[Scan, Scan]) -> Figure:
    """Draw points of two stations on one stretch of floor, by the true poses and by the believed ones."""
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
    """Draw signed distances of two stations along a row of voxels, their mean, and where it crosses zero."""
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
    """Draw maps of the room side by side, cut at 1.2 m, over the room itself."""
    figure, axes = figures.new_figure(1, len(maps), size=(3.3 * len(maps), 3.0))
    for a, (name, scene_map) in zip(axes, maps.items(), strict=True):
        draw_cut(a, room().mesh(), "0.75", 3.0, "room")
        draw_cut(a, scene_map, figures.BLUE, 1.3, "map")
        a.set(title=name, **ROOM_FROM_ABOVE)
    a.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    alt = """Maps from one and from three stations over the room, from above: with one, pieces of wall behind the
        pillar and beside the cabinet are missing."""
    return described(figure, alt)


def views_figure(images: dict[str, np.ndarray]) -> Figure:
    """Draw depth images of the room side by side."""
    alt = """Depth images from one place in the room: the room, the map from one station with hatched holes, and the map
        from three."""
    return described(figures.depth_images(list(images.values()), list(images), (0.0, 5.0)), alt)


def corridor_figure(scene_map: SceneMap, true_world: SceneMap) -> Figure:
    """Draw a stretch of the corridor's map over the corridor on the day of the run, both cut 1 m above the floor."""
    figure, axes = figures.new_figure(size=(9.4, 3.2))
    draw_cut(axes, true_world, figures.VERMILION, 1.0, "world, day of the run", height=1.0)
    draw_cut(axes, scene_map, figures.BLUE, 1.6, "map, surveyed another day", height=1.0)
    axes.set(title="The corridor, cut 1 m above the floor", xlabel="x along the corridor [m]", ylabel="y [m]")
    axes.set(xlim=(5.0, 18.0), ylim=(-1.9, 2.9))
    axes.legend(loc="upper left", ncols=2, framealpha=0.95)
    alt = """Thirteen metres of corridor from above: the map's walls cover the world's, but doors stand at other
        angles, and two people are in the world only."""
    return described(figure, alt)


CONTROLS = [
    Slider("stations", "number of stations", 1, 4, 3, 1),
    Slider("noise", "range noise, one sigma [mm]", 0, 50, 1, 1),
    Slider("registration", "registration error, one sigma [mm]", 0, 50, 0, 1),
    Choice("voxel", "size of a voxel", ("20 cm", "10 cm", "7 cm"), "10 cm"),
    Choice("keep", "triangles kept by decimation", ("all", "5 %", "1 %", "0.2 %"), "all"),
    Switch("door_open", "the door stood open on the survey day, too"),
]


def survey_panel() -> Panel:
    """Survey the room: stations, noise, registration, voxels, decimation, the door; see the map and its numbers."""
    figure, (plan, view, spread) = figures.new_figure(1, 3, size=(10.2, 3.3))
    world = draw_cut(plan, room().mesh(), "0.75", 3.5, "room, survey day")
    mapped = draw_cut(plan, room().mesh(), figures.BLUE, 1.2, "map")
    (spots,) = plan.plot([], [], "s", color=figures.VERMILION, markersize=7, label="stations")
    plan.set(title="From above, cut at 1.2 m", **ROOM_FROM_ABOVE)
    plan.legend(loc="upper center", bbox_to_anchor=(0.5, -0.22), ncols=3, fontsize=7, columnspacing=0.8, frameon=False)
    image = figures.depth_image(view, np.zeros(CAMERA.shape), "What a camera sees of the map", (0, 5))
    figures.colour_bar(figure, image, view)
    edges = np.linspace(0, 100, 41)
    steps = spread.stairs(np.ones(40), edges, fill=True, color=figures.BLUE)
    spread.set(title="Distance from map to room", xlabel="distance [mm] (last bar: all beyond)", ylabel="share [-]")
    spread.set(xlim=(0, 100), ylim=(0, 0.6))
    live = LiveFigure(figure, [world, mapped, spots, image, steps])

    def draw(stations: float, noise: float, registration: float, voxel: str, keep: str, door_open: bool) -> Drawing:
        n = int(stations)
        size, share = float(voxel.split()[0]) / 100, 1.0 if keep == "all" else float(keep.split()[0]) / 100
        day = {"noise_mm": noise, "registration_mm": registration, "door_open": door_open}
        scene_map = small_room.room_map(n, size, share, **day)
        for lines, shown in ((world, room(door_open).mesh()), (mapped, scene_map)):
            lines.set_segments(plane_cut(shown.vertices, shown.faces, 2, 1.2))
        spots.set_data(*np.array(STATIONS[:n]).T)
        seen = small_room.camera_view(scene_map)
        image.set_data(np.ma.masked_invalid(seen))
        counts = np.histogram(np.minimum(1000 * small_room.distances(scene_map, door_open), 99.9), edges)[0]
        steps.set_data(counts / counts.sum())
        changed = np.abs(np.where(np.isfinite(seen), seen, np.nan) - small_room.true_view(door_open=True)) > 0.1
        numbers = small_room.row(small_room.quality(scene_map, door_open))
        today = f"today the door is open: {changed.mean():.0%} of the camera's pixels are more than 10 cm off the map"
        alt = (
            f"Map of a room from {n} stations, cut from above; what a camera sees of it; its distances "
            f"from the room. Noise {noise:.0f} mm, registration {registration:.0f} mm, voxels {voxel}. {numbers}"
        )
        return Drawing(live.png(), alt, f"{numbers}\n{today}")

    return Panel("02 survey the room", CONTROLS, draw, continuous=False)


PANELS = {"02 survey the room": survey_panel}
