"""Lesson 11, the spherical camera: a panorama and its sphere side by side, a view cut out of it, what seams do."""

from __future__ import annotations

import functools
from typing import NamedTuple

import cv2
import numpy as np
from matplotlib.figure import Figure

from course_lib.geometry import wrap_angle
from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Drawing, Panel, Slider
from course_lib.lessons.kit.paths import data_path
from course_lib.lessons.lesson_11.sphere_scene import SCENE, Scene
from course_lib.lessons.lesson_11.sphere_view import (
    SphereView,
    circle_around,
    circle_on_panorama,
    draw_lines,
    move_lines,
    point_artists,
    sphere_axes,
)
from course_lib.plots import figures
from course_lib.plots.figures import BLUE, VERMILION
from course_lib.plots.panorama_drawing import draw_box, panorama
from course_lib.spherical_stereo.detection.boxes import box_centre
from course_lib.spherical_stereo.detection.seam import extend_seam
from course_lib.spherical_stereo.panorama import azimuth_elevation, direction_to_pixel, pixel_to_direction
from course_lib.spherical_stereo.recording import StereoPair, StereoRecording, TrueObject, read_stereo_recording
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

PAIR = 9  # of the room's experiment 1: a sofa lies across the seam
_LOOK = (150.0, -20.0)  # degrees: azimuth and elevation in which one looks at the sphere


@functools.cache
def recording() -> StereoRecording:
    """The room's experiment 1."""
    return read_stereo_recording(data_path("room/experiment_1"))


@functools.cache
def the_pair() -> StereoPair:
    """The pair of panoramas of this lesson."""
    return recording().pairs[PAIR]


@functools.cache
def the_image() -> np.ndarray:
    """Its upper panorama, `(640, 1280, 3)` uint8 BGR."""
    return the_pair().images()[0]


def object_at_the_seam() -> TrueObject:
    """The object whose box passes the width of the panorama."""
    return next(thing for thing in the_pair().upper_objects if thing.visible_box[2] > recording().width)


def scene() -> Scene:
    """The scene to be dragged in: panorama and sphere."""
    return Scene(SCENE, "A point on a panorama and on the unit sphere: drag it on either", 470)


def idea_figure(image_bgr: np.ndarray, points: dict[str, np.ndarray]) -> Figure:
    """The panorama and the sphere, with the same named points (edge coordinates) on both."""
    height, width = image_bgr.shape[:2]
    figure, (flat, ball) = figures.new_figure(1, 2, size=(9.6, 3.5))
    flat.get_gridspec().set_width_ratios([2, 1])
    panorama(flat, image_bgr, "Equirectangular image")
    view = SphereView(*_LOOK)
    sphere_axes(ball, "Unit sphere, looked into")
    ball.imshow(view.picture(image_bgr), extent=(-1, 1, -1, 1))
    draw_lines(ball, view)
    for index, (name, uv) in enumerate(points.items()):
        style = figures.line_style(index) | {"linestyle": "none", "markersize": 8, "markeredgecolor": "white"}
        direction = pixel_to_direction(uv, width, height)
        spot = view.on_screen(direction)
        flat.plot(*uv, **style, label=name, clip_on=False)
        ball.plot(*spot, **style)
        ball.plot([0, spot[0]], [0, spot[1]], color=style["color"], linewidth=1.2)
    figure.legend(*flat.get_legend_handles_labels(), loc="outside lower center", ncols=len(points), frameon=False)
    return figure


def look_up(image_bgr: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """The panorama's colours in directions `(H, W, 3)`, also across the seam, `(H, W, 3)` uint8 BGR."""
    height, width = image_bgr.shape[:2]
    uv = (direction_to_pixel(directions, width, height) - 0.5).astype(np.float32)
    wrapped = np.concatenate([image_bgr, image_bgr[:, :1]], axis=1)  # one more column, to interpolate across the seam
    return cv2.remap(wrapped, uv[..., 0] % width, uv[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)


def views_figure(views: dict[str, np.ndarray]) -> Figure:
    """Views cut out of a panorama, `(300, 300, 3)` uint8 BGR each, by name."""
    figure, axes = figures.new_figure(1, len(views), size=(3.1 * len(views), 3.4))
    for a, (name, image) in zip(np.atleast_1d(axes), views.items(), strict=True):
        a.imshow(image[..., ::-1])
        a.grid(False)
        a.set(title=name, xlabel="column [pixels]", ylabel="row [pixels]")
    return figure


def seam_figure(image_bgr: np.ndarray, thing: TrueObject, naive_u: float) -> Figure:
    """The object's true box on both sides of the seam, the mean of its columns, and its true centre."""
    figure, axes = figures.new_figure(size=(8.4, 3.5))
    width = image_bgr.shape[1]
    panorama(axes, image_bgr, "One sofa, its box across the seam, and two 'centres'")
    draw_box(axes, thing.visible_box, width, thing.label)
    u, v = box_centre(thing.visible_box)
    style = {"linestyle": "none", "markersize": 10, "markeredgecolor": "white"}
    axes.plot(naive_u, v, marker="X", color=VERMILION, label="mean of the columns: wrong", **style)
    axes.plot(u % width, v, marker="o", color=BLUE, label="centre on the circle", clip_on=False, **style)
    axes.legend(loc="upper center", framealpha=0.95)
    return figure


class Bearings(NamedTuple):
    """Azimuths of the map's objects as seen from where the rig stood, degrees, `(n,)` each."""

    labels: list[str]
    measured: np.ndarray
    """From the centre of the exact box on the panorama."""
    from_map: np.ndarray
    """From the map and the true pose."""

    @property
    def error(self) -> np.ndarray:
        """measured - from_map on the circle."""
        return np.degrees(wrap_angle(np.radians(self.measured - self.from_map)))


def bearings(pair: StereoPair, semantic_map: SemanticMap, width: int, height: int) -> Bearings:
    """Box centres on the upper panorama against map and true pose, for every object that is wholly visible."""
    things = [thing for thing in pair.upper_objects if thing.visible_fraction > 0.95]
    centres = box_centre([thing.visible_box for thing in things])
    measured, _ = azimuth_elevation(pixel_to_direction(centres, width, height))
    towards = semantic_map.positions[[thing.number for thing in things]] - pair.pose[:2]
    from_map = wrap_angle(np.arctan2(towards[:, 1], towards[:, 0]) - pair.pose[2])
    return Bearings([thing.label for thing in things], np.degrees(measured), np.degrees(from_map))


def bearings_figure(found: Bearings) -> Figure:
    """Measured azimuth over the map's, all objects of all pairs."""
    figure, axes = figures.new_figure(size=(5.4, 3.6))
    axes.plot([-180, 180], [-180, 180], color="0.6", linewidth=1.0, label="equal")
    style = figures.line_style(0) | {"linestyle": "none", "markersize": 4}
    axes.plot(found.from_map, found.measured, **style, label="one object")
    ticks = np.arange(-180, 181, 90)
    axes.set(title="Where objects are", xlabel="azimuth by map and true pose [degrees]", xticks=ticks, yticks=ticks)
    axes.set_ylabel("azimuth of the box centre [degrees]")
    axes.legend(loc="upper left", frameon=False)
    return figure


def all_bearings(semantic_map: SemanticMap) -> Bearings:
    """`bearings` of every pair of the experiment, one after the other."""
    record = recording()
    parts = [bearings(pair, semantic_map, record.width, record.height) for pair in record.pairs]
    labels = [label for part in parts for label in part.labels]
    return Bearings(labels, *(np.concatenate([getattr(p, name) for p in parts]) for name in ("measured", "from_map")))


def sphere_panel() -> Panel:
    """A point on the panorama with its left quarter repeated, and on the sphere; the view on the sphere can turn."""
    image = the_image()
    height, width = image.shape[:2]
    figure, (flat, ball) = figures.new_figure(1, 2, size=(10.2, 3.3))
    flat.get_gridspec().set_width_ratios([2.3, 1])
    flat.imshow(extend_seam(image)[..., ::-1], extent=(0, 1.25 * width, height, 0))
    flat.grid(False)
    flat.axvspan(width, 1.25 * width, color="white", alpha=0.45, linewidth=0)
    flat.axvline(width, color=VERMILION, linewidth=2.2)
    flat.axvline(0, color=VERMILION, linewidth=2.2)
    flat.axhline(height / 2, color=BLUE, linestyle="--", linewidth=1.4)
    flat.set(title="Panorama, its left quarter once more", xlabel="column u [pixels]", ylabel="row v [pixels]")
    flat.set(xlim=(0, 1.25 * width), ylim=(height, 0), xticks=np.arange(0, 1.26 * width, width / 4))
    sphere_axes(ball, "Unit sphere, looked into")
    view = SphereView(*_LOOK)
    shown = ball.imshow(view.picture(image), extent=(-1, 1, -1, 1))
    lines, parts = draw_lines(ball, view), point_artists(flat, ball)
    live = LiveFigure(figure, [shown, *lines, *parts.values()])

    @functools.lru_cache(maxsize=32)
    def sphere_picture(look: float) -> np.ndarray:
        return SphereView(look, _LOOK[1]).picture(image)

    def draw(u: float, v: float, look: float) -> Drawing:
        view = SphereView(look, _LOOK[1])
        shown.set_data(sphere_picture(look))
        move_lines(lines, view)
        direction = pixel_to_direction([u, v], width, height)
        ring = circle_around(direction)
        on_panorama = circle_on_panorama(ring, width, height)
        again = on_panorama + np.array([width, 0.0])
        parts["flat ring"].set_data(*np.concatenate([on_panorama, np.full((1, 2), np.nan), again]).T)
        columns = [c for c in (u % width, u % width + width) if c <= 1.25 * width]
        parts["flat"].set_data(columns, [v] * len(columns))
        spot, edge = view.on_screen(direction), view.on_screen(ring)
        parts["ray"].set_data([0, spot[0]], [0, spot[1]])
        parts["ring"].set_data(*edge.T)
        parts["point"].set_data([spot[0]], [spot[1]])
        azimuth, elevation = np.degrees(azimuth_elevation(direction))
        x, y, z = direction
        back = direction_to_pixel(direction, width, height)
        half = "near half (taken away)" if view.is_near(direction) else "far half"
        lines_of_text = [
            f"u {u:.0f} px, v {v:.0f} px: azimuth {azimuth:.1f} deg, elevation {elevation:.1f} deg; {half}",
            f"unit vector x {x:.3f}, y {y:.3f}, z {z:.3f}; back again: u {back[0]:.0f} px, v {back[1]:.0f} px",
        ]
        alt = f"A point and a circle of 10 degrees on a panorama and on the unit sphere. {lines_of_text[0]}."
        return Drawing(live.png(), alt, "\n".join(lines_of_text))

    controls = [
        Slider("u", "column u [pixels]", 0, 1600, 1200, 10),
        Slider("v", "row v [pixels]", 0, 640, 410, 10),
        Slider("look", "look towards [degrees]", -180, 180, 150, 15),
    ]
    return Panel("11 panorama and sphere", controls, draw)


PANELS = {"11 panorama and sphere": sphere_panel}
