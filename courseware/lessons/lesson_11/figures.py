"""Figures and panel of lesson 11: panorama and sphere, views cut out, the seam, bearings."""

import numpy as np
from matplotlib.figure import Figure

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo import SemanticMap
from course_lib.spherical_stereo.detection.detected_object import box_centre
from course_lib.spherical_stereo.detection.seam import extend_seam
from course_lib.spherical_stereo.panorama import azimuth_elevation, direction_to_pixel, pixel_to_direction
from courseware.lessons.kit.display import described
from courseware.lessons.kit.live_figure import LiveFigure
from courseware.lessons.kit.panel import Drawing, Panel, Slider
from courseware.lessons.kit.room_data import room_recording, the_image
from courseware.lessons.lesson_11.sphere_view import LOOK, DrawnSphere, circle_around
from courseware.plots.figures import BLACK, BLUE, VERMILION, YELLOW, line_style, new_figure
from courseware.plots.panorama_drawing import draw_box, panorama
from courseware.simulation.room.stereo_recording import TrueObject


def idea_figure(image_bgr: np.ndarray, points: dict[str, np.ndarray]) -> Figure:
    """The panorama and the sphere, with the same named points (edge coordinates) on both."""
    figure, (flat, ball) = new_figure(1, 2, size=(9.6, 4.3))
    flat.get_gridspec().set_width_ratios([1.55, 1])
    panorama(flat, image_bgr, "Equirectangular image")
    sphere = DrawnSphere(ball, image_bgr)
    for index, (name, uv) in enumerate(points.items()):
        style = line_style(index) | {"linestyle": "none", "markersize": 8, "markeredgecolor": "white"}
        x, y = sphere.on_screen(pixel_to_direction(uv, *image_bgr.shape[1::-1]))
        flat.plot(*uv, **style, label=name, clip_on=False)
        ball.plot(x, y, **style)
        ball.plot([0, x], [0, y], color=style["color"], linewidth=1.2)
    ball.set(xlim=(-1.2, 1.2), ylim=(-1.2, 1.3))
    ball.set_axis_off()
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
    figure, axes = new_figure(size=(6.8, 4.3))
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


def sphere_panel() -> Panel:
    """A point on the panorama with its left quarter repeated, and on the sphere; the view on the sphere can turn."""
    image = the_image()
    height, width = image.shape[:2]
    end = 1.25 * width
    figure, (flat, ball) = new_figure(1, 2, size=(10.2, 3.3))
    flat.get_gridspec().set_width_ratios([2.3, 1])
    flat.imshow(extend_seam(image)[..., ::-1], extent=(0, end, height, 0))
    flat.grid(False)
    flat.axvspan(width, end, color="white", alpha=0.45, linewidth=0)
    flat.axvline(0, color=VERMILION, linewidth=2.2)
    flat.axvline(width, color=VERMILION, linewidth=2.2)
    flat.axhline(height / 2, color=BLUE, linestyle="--", linewidth=1.4)
    flat.set(title="Panorama, its left quarter once more", xlabel="column u [pixels]", ylabel="row v [pixels]")
    flat.set(xlim=(0, end), ylim=(height, 0), xticks=np.linspace(0, end, 6))
    sphere = DrawnSphere(ball, image)
    (ray,) = ball.plot([], [], color=BLACK, linewidth=2.4)
    rings = [axes.plot([], [], color=BLACK, linewidth=2.0)[0] for axes in (flat, ball)]
    dots = [axes.plot([], [], "o", markersize=8, mfc=YELLOW, mec=BLACK)[0] for axes in (flat, ball)]
    live = LiveFigure(figure, [*sphere.artists, rings[0], dots[0], ray, rings[1], dots[1]])

    def draw(u: float, v: float, look: float) -> Drawing:
        sphere.turn(look)
        direction = pixel_to_direction([u, v], width, height)
        circle = circle_around(direction)
        uv = direction_to_pixel(circle, width, height)
        uv[np.abs(np.diff(uv[:, 0], prepend=uv[0, 0])) > width / 2] = np.nan  # the line is torn at the seam
        rings[0].set_data(*np.concatenate([uv, [[np.nan] * 2], uv + np.array([width, 0])]).T)
        columns = [column for column in (u % width, u % width + width) if column <= end]
        dots[0].set_data(columns, [v] * len(columns))
        x, y = sphere.on_screen(direction)
        ray.set_data([0, x], [0, y])
        dots[1].set_data([x], [y])
        rings[1].set_data(*sphere.on_screen(circle).T)
        azimuth, elevation = np.degrees(azimuth_elevation(direction))
        back = direction_to_pixel(direction, width, height)
        half = "near half (taken away)" if sphere.is_near(direction) else "far half"
        place = f"u {u:.0f} px, v {v:.0f} px: azimuth {azimuth:.1f} deg, elevation {elevation:.1f} deg; {half}"
        x, y, z = direction
        numbers = f"unit vector x {x:.3f}, y {y:.3f}, z {z:.3f}; back again: u {back[0]:.0f} px, v {back[1]:.0f} px"
        alt = f"A point and a circle of 10 degrees on a panorama and on the unit sphere. {place}."
        return Drawing(live.png(), alt, f"{place}\n{numbers}")

    place = [Slider("u", "column u [pixels]", 0, 1600, 1200, 10), Slider("v", "row v [pixels]", 0, 640, 410, 10)]
    controls = [*place, Slider("look", "look towards [degrees]", -180, 180, LOOK, 15)]
    return Panel("11 panorama and sphere", controls, draw, photograph=True)


PANELS = {"11 panorama and sphere": sphere_panel}
