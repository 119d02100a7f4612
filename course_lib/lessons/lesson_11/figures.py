"""Figures of lesson 11: panorama and sphere, views cut out, the seam, bearings."""

import numpy as np
from matplotlib.figure import Figure

from course_lib.lessons.lesson_11.sphere_view import SphereView, draw_lines, sphere_axes
from course_lib.lessons.lesson_11.views import Bearings
from course_lib.plots import figures
from course_lib.plots.figures import BLUE, VERMILION
from course_lib.plots.panorama_drawing import draw_box, panorama
from course_lib.spherical_stereo.detection.detected_object import box_centre
from course_lib.spherical_stereo.panorama import pixel_to_direction
from course_lib.spherical_stereo.recording import TrueObject

LOOK = (150.0, -20.0)  # degrees: azimuth and elevation in which one looks at the sphere


def idea_figure(image_bgr: np.ndarray, points: dict[str, np.ndarray]) -> Figure:
    """The panorama and the sphere, with the same named points (edge coordinates) on both."""
    height, width = image_bgr.shape[:2]
    figure, (flat, ball) = figures.new_figure(1, 2, size=(9.6, 3.5))
    flat.get_gridspec().set_width_ratios([2, 1])
    panorama(flat, image_bgr, "Equirectangular image")
    view = SphereView(*LOOK)
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
