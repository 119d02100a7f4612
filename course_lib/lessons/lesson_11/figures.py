"""Figures of lesson 11: panorama and sphere, views cut out, the seam, bearings."""

import numpy as np
from matplotlib.figure import Figure

from course_lib.geometry import wrap_angle
from course_lib.lessons.kit.display import described
from course_lib.lessons.kit.room_photographs import room_recording
from course_lib.lessons.lesson_11.sphere_view import DrawnSphere
from course_lib.plots.figures import BLUE, VERMILION, line_style, new_figure
from course_lib.plots.panorama_drawing import draw_box, panorama
from course_lib.spherical_stereo import SemanticMap
from course_lib.spherical_stereo.detection.detected_object import box_centre
from course_lib.spherical_stereo.panorama import azimuth_elevation, pixel_to_direction
from course_lib.spherical_stereo.recording import TrueObject


def idea_figure(image_bgr: np.ndarray, points: dict[str, np.ndarray]) -> Figure:
    """The panorama and the sphere, with the same named points (edge coordinates) on both."""
    figure, (flat, ball) = new_figure(1, 2, size=(9.6, 3.5))
    flat.get_gridspec().set_width_ratios([2, 1])
    panorama(flat, image_bgr, "Equirectangular image")
    sphere = DrawnSphere(ball, image_bgr)
    for index, (name, uv) in enumerate(points.items()):
        style = line_style(index) | {"linestyle": "none", "markersize": 8, "markeredgecolor": "white"}
        x, y = sphere.on_screen(pixel_to_direction(uv, *image_bgr.shape[1::-1]))
        flat.plot(*uv, **style, label=name, clip_on=False)
        ball.plot(x, y, **style)
        ball.plot([0, x], [0, y], color=style["color"], linewidth=1.2)
    figure.legend(*flat.get_legend_handles_labels(), loc="outside lower center", ncols=len(points), frameon=False)
    alt = "Left, an equirectangular image of a room; right, the same picture inside a sphere. Four points lie on both."
    return described(figure, alt)


def views_figure(views: dict[str, np.ndarray]) -> Figure:
    """Views cut out of a panorama, `(300, 300, 3)` uint8 BGR each, by name."""
    figure, plots = new_figure(1, len(views), size=(3.1 * len(views), 3.4))
    for axes, (name, image) in zip(plots, views.items(), strict=True):
        axes.imshow(image[..., ::-1])
        axes.grid(False)
        axes.set(title=name, xlabel="column [pixels]", ylabel="row [pixels]")
    alt = "Three flat views out of one panorama: ahead, left, behind. Behind, the sofa that the seam cuts is whole."
    return described(figure, alt)


def seam_figure(image_bgr: np.ndarray, thing: TrueObject, naive_u: float) -> Figure:
    """The object's true box on both sides of the seam, the mean of its columns, and its true centre."""
    figure, axes = new_figure(size=(8.4, 3.5))
    width = image_bgr.shape[1]
    panorama(axes, image_bgr, "One sofa, its box across the seam, and two 'centres'")
    draw_box(axes, thing.visible_box, width, thing.label)
    u, v = box_centre(thing.visible_box)
    style = {"linestyle": "none", "markersize": 10, "markeredgecolor": "white"}
    axes.plot(naive_u, v, marker="X", color=VERMILION, label="mean of the columns: wrong", **style)
    axes.plot(u % width, v, marker="o", color=BLUE, label="centre on the circle", clip_on=False, **style)
    axes.legend(loc="upper center", framealpha=0.95)
    alt = "Panorama with the sofa's box in two pieces at the edges; the mean of its columns lies in mid image."
    return described(figure, alt)


def all_bearings(semantic_map: SemanticMap) -> tuple[np.ndarray, np.ndarray]:
    """Return the azimuths [rad], seen from the rig, of every object that is wholly visible: by box, and by the map."""
    record, bearings = room_recording(1), []
    for pair in record.pairs:
        for thing in filter(lambda thing: thing.visible_fraction > 0.95, pair.upper_objects):
            direction = pixel_to_direction(box_centre(thing.visible_box), record.width, record.height)
            x, y = semantic_map.positions[thing.number] - pair.pose[:2]
            bearings.append((azimuth_elevation(direction)[0], wrap_angle(np.arctan2(y, x) - pair.pose[2])))
    return tuple(np.array(bearings).T)


def bearings_figure(measured: np.ndarray, from_map: np.ndarray) -> Figure:
    """Measured azimuth over the map's, all objects of all pairs, from radians `(n,)`."""
    figure, axes = new_figure(size=(5.4, 3.6))
    axes.plot([-180, 180], [-180, 180], color="0.6", linewidth=1.0, label="equal")
    style = line_style(0) | {"linestyle": "none", "markersize": 4}
    axes.plot(np.degrees(from_map), np.degrees(measured), **style, label="one object")
    axes.set(title="Where objects are", xlabel="azimuth by map and true pose [degrees]")
    axes.set(ylabel="azimuth of the box centre [degrees]", xticks=range(-180, 181, 90), yticks=range(-180, 181, 90))
    axes.legend(loc="upper left", frameon=False)
    alt = "Azimuth of the box centres over the azimuth by map and true pose: all points lie close to the diagonal."
    return described(figure, alt)
