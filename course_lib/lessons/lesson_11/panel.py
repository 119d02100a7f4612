"""Lesson 11's panel: a point on the panorama and on the sphere."""

import functools

import numpy as np

from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Drawing, Panel, Slider
from course_lib.lessons.kit.room_photographs import the_image
from course_lib.lessons.lesson_11.figures import LOOK
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
from course_lib.spherical_stereo.detection.seam import extend_seam
from course_lib.spherical_stereo.panorama import azimuth_elevation, direction_to_pixel, pixel_to_direction


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
    view = SphereView(*LOOK)
    shown = ball.imshow(view.picture(image), extent=(-1, 1, -1, 1))
    lines, parts = draw_lines(ball, view), point_artists(flat, ball)
    live = LiveFigure(figure, [shown, *lines, *parts.values()])

    @functools.lru_cache(maxsize=32)
    def sphere_picture(look: float) -> np.ndarray:
        return SphereView(look, LOOK[1]).picture(image)

    def draw(u: float, v: float, look: float) -> Drawing:
        view = SphereView(look, LOOK[1])
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
    return Panel("11 panorama and sphere", controls, draw, photograph=True)


PANELS = {"11 panorama and sphere": sphere_panel}
