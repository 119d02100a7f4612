"""Lesson 02, a map from a laser scan: a small room, its survey, figures and panel."""

from __future__ import annotations

import dataclasses
import functools
import json
from typing import NamedTuple

import numpy as np
import trimesh
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from course_lib.depth_mcl.camera import DepthCamera
from course_lib.depth_mcl.experiment import sequence_camera
from course_lib.depth_mcl.renderer import DepthRenderer
from course_lib.depth_mcl.scene_map import SceneMap
from course_lib.depth_mcl.sequence import read_sequence
from course_lib.geometry import BODY_FROM_OPTICAL, pose_matrix, state_from_optical_pose
from course_lib.lessons import figures
from course_lib.lessons.box_world import Box, BoxWorld
from course_lib.lessons.live_figure import LiveFigure
from course_lib.lessons.panel import Choice, Drawing, Panel, Slider, Switch
from course_lib.lessons.paths import data_path
from course_lib.worlds.laser_survey import Scan, ScannerModel, survey
from course_lib.worlds.mesh_files import to_polydata
from course_lib.worlds.surface_fusion import FusionModel, fuse, simplify

SIZE = (5.0, 4.0, 2.5)  # metres, the room's inside from the origin
# Where the scanner stands, in this order; x, y in metres.
STATIONS = ((1.0, 1.0), (4.0, 2.6), (1.2, 3.4), (3.2, 0.6))
# A survey in a second: 0.75 degrees between rays (the corridor's has 0.15).
SCANNER = ScannerModel(step_deg=0.75, registration_position=0.0, registration_tilt_deg=0.0, registration_heading_deg=0)
HOLE_DISTANCE = 0.10  # metres: what has no map within it counts as a hole
_EYE = np.array([1.2, 2.6, 1.2, 0.0, 0.05, np.deg2rad(8)])  # state of the camera that looks through the room
_CUT = 1.2  # metres, height of the cuts


@functools.cache
def room(door_open: bool = False) -> BoxWorld:
    """A room of 5 x 4 x 2.5 m with a pillar, a cabinet, a table and a door, and a bit of corridor behind the door."""
    (x, y, z), w = SIZE, 0.2
    paint, wood = 0.72, 0.55
    boxes = [
        Box((-w, -w, -w), (x + w, y + 2.0, 0.0), 0.4),  # floor
        Box((-w, -w, z), (x + w, y + 2.0, z + w), paint),  # ceiling
        Box((-w, -w, 0.0), (0.0, y + 2.0, z), paint),
        Box((x, -w, 0.0), (x + w, y + 2.0, z), paint),
        Box((0.0, -w, 0.0), (x, 0.0, z), paint),
        Box((0.0, y, 0.0), (3.2, y + w, z), paint),  # the wall with the door
        Box((4.1, y, 0.0), (x, y + w, z), paint),
        Box((3.2, y, 2.05), (4.1, y + w, z), paint),
        Box((-w, y + 1.8, 0.0), (x + w, y + 2.0, z), paint),  # the corridor's far wall
        Box((2.3, 1.7, 0.0), (2.7, 2.1, z), paint),  # pillar
        Box((4.2, 0.0, 0.0), (x, 1.0, 1.8), wood),  # cabinet
        Box((0.3, 1.9, 0.70), (0.9, 3.0, 0.74), wood),  # table top
    ]
    for along in (0.32, 0.84):
        boxes += [Box((along, across, 0.0), (along + 0.04, across + 0.04, 0.7), wood) for across in (1.92, 2.94)]
    leaf = (
        Box((4.06, y - 0.9, 0.0), (4.1, y, 2.05), wood)
        if door_open
        else Box((3.2, y, 0.0), (4.1, y + 0.05, 2.05), wood)
    )
    return BoxWorld([*boxes, leaf])


def scanner(noise_mm: float = 1.0, registration_mm: float = 0.0) -> ScannerModel:
    """The lesson's scanner with this range noise and this error of each station's believed position, one sigma each."""
    return dataclasses.replace(
        SCANNER, noise_constant=noise_mm / 1000, noise_per_metre=0.0, registration_position=registration_mm / 1000
    )


def scans(
    n_stations: int, noise_mm: float = 1.0, registration_mm: float = 0.0, door_open: bool = False
) -> tuple[Scan, ...]:
    """The room scanned from the first `n_stations` of `STATIONS`; kept, since a panel asks again and again."""
    return _scans(n_stations, float(noise_mm), float(registration_mm), door_open)


@functools.lru_cache(maxsize=16)
def _scans(n_stations: int, noise_mm: float, registration_mm: float, door_open: bool) -> tuple[Scan, ...]:
    model, rng = scanner(noise_mm, registration_mm), np.random.default_rng(2)
    return tuple(survey(room(door_open), model, rng, STATIONS[:n_stations]))


def fusion(voxel: float, triangles: int = 10**9) -> FusionModel:
    """How the room's scans are fused: voxels of this size [m], signed distances cut at three of them."""
    pieces = max(4, round(0.1 / voxel**2))  # loose pieces below a tenth of a square metre are removed
    return FusionModel(voxel=voxel, truncation=3 * voxel, slab=8.0, least_component=pieces, triangles=triangles)


def room_map(
    n_stations: int,
    noise_mm: float = 1.0,
    registration_mm: float = 0.0,
    voxel: float = 0.1,
    keep: float = 1.0,
    door_open: bool = False,
) -> SceneMap:
    """Scans of the room, fused and decimated to the share `keep` of the triangles; kept like `scans`."""
    return _decimated((n_stations, float(noise_mm), float(registration_mm), door_open), voxel, keep)


@functools.lru_cache(maxsize=12)
def _fused(survey_day: tuple, voxel: float) -> tuple[np.ndarray, np.ndarray]:
    return fuse(list(_scans(*survey_day)), fusion(voxel))


@functools.lru_cache(maxsize=32)
def _decimated(survey_day: tuple, voxel: float, keep: float) -> SceneMap:
    vertices, faces = _fused(survey_day, voxel)
    return SceneMap(*simplify(vertices, faces, fusion(voxel, max(20, round(keep * len(faces))))))


class MapQuality(NamedTuple):
    """How good a map of the room is."""

    triangles: int
    median: float
    """of the distance from points on the map to the surveyed room [m]"""
    p90: float
    """nine in ten of these distances are below it [m]"""
    holes: float
    """share of what eyes in the room see that has no map within `HOLE_DISTANCE`"""


@functools.lru_cache(maxsize=64)
def quality(scene_map: SceneMap, door_open: bool = False) -> MapQuality:
    """Distances from the map to the room as it was on the survey day, and the share of holes."""
    distance = distances(scene_map, door_open)
    holes = float((gaps(scene_map, door_open) > HOLE_DISTANCE).mean())
    return MapQuality(len(scene_map), float(np.median(distance)), float(np.percentile(distance, 90)), holes)


def distances(scene_map: SceneMap, door_open: bool = False, n: int = 4000) -> np.ndarray:
    """Distances [m] from `n` places on the map, drawn by area, to the nearest surface of the room."""
    corners = scene_map.vertices[scene_map.faces]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    rng = np.random.default_rng(0)
    face = rng.choice(len(area), n, p=area / area.sum())
    # Equal chances all over a triangle: Dirichlet shares of its corners.
    points = np.einsum("nk,nkd->nd", rng.dirichlet(np.ones(3), n), corners[face])
    low, high = room(door_open).low, room(door_open).high
    off = np.maximum(low - points[:, None], points[:, None] - high)  # beyond each box's sides, negative inside
    outside = np.linalg.norm(np.maximum(off, 0), axis=2)
    return np.abs(outside + np.minimum(off.max(axis=2), 0)).min(axis=1)


def row(found: MapQuality) -> str:
    """The numbers of a map in one line, rounded so that they hold on any computer."""
    triangles = float(f"{found.triangles:.2g}")
    median, p90 = (_millimetres(value) for value in (found.median, found.p90))
    holes = "below 1 %" if found.holes < 0.01 else f"{100 * found.holes:.0f} %"
    return f"about {triangles:,.0f} triangles; map to room: median {median}, 90 % below {p90}; holes {holes}"


def _millimetres(value: float) -> str:
    return "< 5 mm" if value < 0.005 else f"{1000 * value:.0f} mm"


def gaps(scene_map: SceneMap, door_open: bool = False) -> np.ndarray:
    """Distance [m] to the nearest place of the map from each of 3,000 places of the room that eyes in it see."""
    mesh = to_polydata(scene_map.vertices, scene_map.faces)
    seen = seen_places(door_open)
    return np.linalg.norm(seen - mesh.find_closest_cell(seen, return_closest_point=True)[1], axis=1)


@functools.cache
def seen_places(door_open: bool = False, n: int = 3000) -> np.ndarray:
    """Places `(n, 3)` on the room's surfaces: what rays in all directions from eyes all over the room meet."""
    rng, places = np.random.default_rng(5), []
    while sum(map(len, places)) < n:
        eyes = rng.uniform([0.1, 0.1, 0.9], [SIZE[0] - 0.1, SIZE[1] - 0.1, 1.9], (4 * n, 3))
        free = ~((eyes[:, :2] > [2.2, 1.6]) & (eyes[:, :2] < [2.8, 2.2])).all(axis=1)  # not in the pillar
        free &= ~((eyes[:, :2] > [4.0, -1]) & (eyes[:, :2] < [9, 1.1])).all(axis=1)  # nor in the cabinet
        eyes = eyes[free]
        directions = rng.normal(size=eyes.shape)
        distance = room(door_open).cast(eyes, directions).distance
        hit = np.isfinite(distance)
        places.append(eyes[hit] + directions[hit] * distance[hit][:, None])
    return np.concatenate(places)[:n]


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
        with DepthRenderer(scene, sequence_camera(recording)) as renderer:
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
    plan.set(title="From above, cut at 1.2 m", xlabel="x [m]", ylabel="y [m]", xlim=(-0.3, 5.3), ylim=(-0.3, 5.6))
    plan.set_aspect("equal")
    plan.legend(loc="upper center", ncols=3, fontsize=7, columnspacing=0.8, handletextpad=0.3, framealpha=0.95)
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
