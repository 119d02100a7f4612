"""Lesson 02, a map from a laser scan: what a camera sees of a small room's maps, the corridor's map, figures, panel."""

from __future__ import annotations

import functools
import json
from typing import NamedTuple

import numpy as np
import trimesh
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from course_lib.depth_mcl.camera import DepthCamera
from course_lib.depth_mcl.rendering.renderer import DepthRenderer
from course_lib.depth_mcl.scene_map import SceneMap
from course_lib.depth_mcl.sequence import read_sequence
from course_lib.geometry import BODY_FROM_OPTICAL, pose_matrix, state_from_optical_pose
from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Choice, Drawing, Panel, Slider, Switch
from course_lib.lessons.kit.paths import data_path
from course_lib.lessons.lesson_02.small_room import (
    STATIONS,
    MapQuality,
    distances,
    fusion,
    quality,
    room,
    room_map,
    scans,
)
from course_lib.plots import figures
from course_lib.simulation.sensors.laser_survey import Scan

# The lesson reaches the small room through this module, as every lesson reaches what is its own.
__all__ = [
    "PANELS",
    "camera_view",
    "corridor_difference",
    "corridor_figure",
    "cut",
    "distances",
    "fusion",
    "fusion_figure",
    "idea_figure",
    "maps_figure",
    "quality",
    "registration_figure",
    "room_map",
    "row",
    "scans",
    "shipped_numbers",
    "survey_panel",
    "true_view",
    "views_figure",
]

_EYE = np.array([1.2, 2.6, 1.2, 0.0, 0.05, np.deg2rad(8)])  # state of the camera that looks through the room
_CUT = 1.2  # metres, height of the cuts


def row(found: MapQuality) -> str:
    """The numbers of a map in one line, rounded so that they hold on any computer."""
    triangles = float(f"{found.triangles:.2g}")
    median, p90 = (_millimetres(value) for value in (found.median, found.p90))
    holes = "below 1 %" if found.holes < 0.01 else f"{100 * found.holes:.0f} %"
    return f"about {triangles:,.0f} triangles; map to room: median {median}, 90 % below {p90}; holes {holes}"


def _millimetres(value: float) -> str:
    return "< 5 mm" if value < 0.005 else f"{1000 * value:.0f} mm"


def cut(vertices: np.ndarray, faces: np.ndarray, height: float = _CUT) -> np.ndarray:
    """Segments `(n, 2, 2)` [m] in which triangles meet the horizontal plane at `height`."""
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    lines = trimesh.intersections.mesh_plane(mesh, plane_normal=[0, 0, 1.0], plane_origin=[0, 0, height])
    return np.asarray(lines)[:, :, :2]


@functools.cache
def _room_cut(door_open: bool) -> np.ndarray:
    mesh = room(door_open).mesh()
    return cut(mesh.vertices, mesh.faces)


@functools.lru_cache(maxsize=64)
def camera_view(scene_map: SceneMap) -> np.ndarray:
    """Depth image [m] of a map of the room from beside the table, looking past the pillar to the door."""
    with DepthRenderer(scene_map, _view_camera()) as renderer:
        return renderer.render(_EYE)[0]


@functools.cache
def true_view(door_open: bool = True) -> np.ndarray:
    """What a perfect camera there measures of the room itself."""
    pose = pose_matrix(_EYE)
    rays = _view_camera().rays() @ (pose[:3, :3] @ BODY_FROM_OPTICAL).T
    return room(door_open).cast(pose[:3, 3], rays).distance


@functools.cache
def _view_camera() -> DepthCamera:
    return DepthCamera.from_fov(132, 108, 70, 59)


def shipped_numbers() -> dict:
    """What was measured on the corridor's map when it was made (`python3 course.py make-data corridor`)."""
    return json.loads(data_path("corridor/summary.json").read_text(encoding="utf-8"))["measured"]["map"]


class CorridorDifference(NamedTuple):
    """What a perfect camera would see on the wagon's path on the day of the run, against the corridor's map."""

    holes: float
    """share of pixels where the world is hit and the map is not"""
    changed: float
    """share of pixels where the two differ by more than 10 cm"""
    median: float
    """of the difference in the other pixels [m]"""


def corridor_difference(scene_map: SceneMap, true_world: SceneMap, frames: range) -> CorridorDifference:
    """Map and true world drawn from the wagon's true poses of some frames, compared pixel by pixel up to 11 m."""
    recording = read_sequence(data_path("corridor/wagon"))
    states = state_from_optical_pose(recording.camera_to_world[list(frames)])
    images = []
    for scene in (scene_map, true_world):
        with DepthRenderer(scene, recording.camera()) as renderer:
            images.append(renderer.render(states))
    mapped, true = images
    there = np.isfinite(true)
    hole = there & ~np.isfinite(mapped)
    both = there & ~hole
    difference = np.abs(np.where(both, mapped, 0) - np.where(both, true, 0))
    changed = difference > 0.1
    same = both & ~changed
    return CorridorDifference(
        float(hole.sum() / there.sum()), float(changed.sum() / there.sum()), float(np.median(difference[same]))
    )


def idea_figure(scan: Scan) -> Figure:
    """A scanner in the room from above: some of its rays, what they meet, and the shadow of the pillar."""
    figure, axes = figures.new_figure(size=(7.4, 4.2))
    _draw_cut(axes, _room_cut(False), "black", 1.2, "room, cut at 1.2 m")
    station = scan.true_pose[:3, 3]
    level = int(np.abs(scan.elevations).argmin())
    row = scan.points(registered=False)
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
            p = scan.points(registered)
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
        _draw_cut(a, _room_cut(door_open), "0.75", 3.0, "room")
        _draw_cut(a, cut(scene_map.vertices, scene_map.faces), figures.BLUE, 1.3, "map")
        a.set(title=name, xlabel="x [m]", ylabel="y [m]", xlim=(-0.3, 5.3), ylim=(-0.3, 4.3), aspect="equal")
    return figure


def views_figure(images: dict[str, np.ndarray]) -> Figure:
    """Depth images of the room side by side."""
    figure, axes = figures.new_figure(1, len(images), size=(3.2 * len(images) + 0.7, 2.9))
    for a, (name, image) in zip(axes, images.items(), strict=True):
        drawn = figures.depth_image(a, image, name, (0, 6))
    figures.colour_bar(figure, drawn, axes)
    return figure


def corridor_figure(scene_map: SceneMap, true_world: SceneMap, x: tuple[float, float] = (5.0, 18.0)) -> Figure:
    """A stretch of the corridor's map over the corridor on the day of the run, both cut 1 m above the floor."""
    figure, axes = figures.new_figure(size=(9.4, 3.2))
    _draw_cut(axes, cut(true_world.vertices, true_world.faces, 1.0), figures.VERMILION, 1.0, "world, day of the run")
    _draw_cut(axes, cut(scene_map.vertices, scene_map.faces, 1.0), figures.BLUE, 1.6, "map, surveyed another day")
    axes.set(title="The corridor, cut 1 m above the floor", xlabel="x along the corridor [m]", ylabel="y [m]")
    axes.set(xlim=x, ylim=(-1.9, 2.9))
    axes.legend(loc="upper left", ncols=2, framealpha=0.95)
    return figure


def _draw_cut(axes: Axes, segments: np.ndarray, colour: str, width: float, label: str) -> LineCollection:
    return axes.add_collection(LineCollection(segments, colors=colour, linewidths=width, label=label))


_VOXELS = {"20 cm": 0.2, "10 cm": 0.1, "7 cm": 0.07}
_KEEP = {"all": 1.0, "5 %": 0.05, "1 %": 0.01, "0.2 %": 0.002}


def survey_panel() -> Panel:
    """Survey the room: stations, noise, registration, voxels, decimation, the door; see the map and its numbers."""
    figure, (plan, view, spread) = figures.new_figure(1, 3, size=(10.2, 3.3))
    world = _draw_cut(plan, _room_cut(False), "0.75", 3.5, "room, survey day")
    mapped = _draw_cut(plan, _room_cut(False), figures.BLUE, 1.2, "map")
    (spots,) = plan.plot([], [], "s", color=figures.VERMILION, markersize=7, label="stations")
    plan.set(title="From above, cut at 1.2 m", xlabel="x [m]", ylabel="y [m]", xlim=(-0.3, 5.3), ylim=(-0.3, 4.3))
    plan.set_aspect("equal")
    plan.legend(loc="upper center", bbox_to_anchor=(0.5, -0.22), ncols=3, fontsize=7, columnspacing=0.8, frameon=False)
    image = figures.depth_image(view, np.zeros(_view_camera().shape), "What a camera sees of the map", (0, 6))
    figures.colour_bar(figure, image, view)
    edges = np.linspace(0, 100, 41)
    steps = spread.stairs(np.ones(40), edges, fill=True, color=figures.BLUE)
    spread.set(title="Distance from map to room", xlabel="distance [mm] (last bar: all beyond)", ylabel="share [-]")
    spread.set(xlim=(0, 100), ylim=(0, 0.6))
    live = LiveFigure(figure, [world, mapped, spots, image, steps])

    def draw(stations: float, noise: float, registration: float, voxel: str, keep: str, door_open: bool) -> Drawing:
        n = int(stations)
        scene_map = room_map(n, noise, registration, _VOXELS[voxel], _KEEP[keep], door_open)
        world.set_segments(_room_cut(door_open))
        mapped.set_segments(cut(scene_map.vertices, scene_map.faces))
        spots.set_data(*np.array(STATIONS[:n]).T)
        seen = camera_view(scene_map)
        image.set_data(np.ma.masked_invalid(seen))
        found = quality(scene_map, door_open)
        counts = np.histogram(np.minimum(1000 * distances(scene_map, door_open), 99.9), edges)[0]
        steps.set_data(counts / counts.sum())
        with np.errstate(invalid="ignore"):
            changed = (np.abs(seen - true_view(True)) > 0.1) & np.isfinite(seen)
        lines = [
            row(found),
            f"today the door is open: {changed.mean():.0%} of the camera's pixels are more than 10 cm off the map",
        ]
        alt = (
            f"Map of a room from {n} stations, cut from above; what a camera sees of it; its distances "
            f"from the room. Noise {noise:.0f} mm, registration {registration:.0f} mm, voxels {voxel}. {lines[0]}"
        )
        return Drawing(live.png(), alt, "\n".join(lines))

    controls = [
        Slider("stations", "number of stations", 1, 4, 3, 1),
        Slider("noise", "range noise, one sigma [mm]", 0, 50, 1, 1),
        Slider("registration", "registration error, one sigma [mm]", 0, 50, 0, 1),
        Choice("voxel", "size of a voxel", tuple(_VOXELS), "10 cm"),
        Choice("keep", "triangles kept by decimation", tuple(_KEEP), "all"),
        Switch("door_open", "the door stood open on the survey day, too"),
    ]
    return Panel("02 survey the room", controls, draw, continuous=False)


PANELS = {"02 survey the room": survey_panel}
