"""Lesson 11's panel: a point on the panorama and on the sphere."""

import numpy as np

from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Drawing, Panel, Slider
from course_lib.lessons.kit.room_photographs import the_image
from course_lib.lessons.lesson_11.sphere_view import LOOK, DrawnSphere
from course_lib.plots.figures import BLACK, BLUE, VERMILION, YELLOW, new_figure
from course_lib.spherical_stereo.detection.seam import extend_seam
from course_lib.spherical_stereo.panorama import (
    azimuth_elevation,
    direction_from_angles,
    direction_to_pixel,
    pixel_to_direction,
)

CONTROLS = [
    Slider("u", "column u [pixels]", 0, 1600, 1200, 10),
    Slider("v", "row v [pixels]", 0, 640, 410, 10),
    Slider("look", "look towards [degrees]", -180, 180, LOOK, 15),
]


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

    return Panel("11 panorama and sphere", CONTROLS, draw, photograph=True)


def circle_around(direction: np.ndarray) -> np.ndarray:
    """Return directions `(73, 3)` of a circle of 10 degrees around a direction: round on the sphere."""
    left = direction_from_angles(azimuth_elevation(direction)[0] + np.pi / 2, 0.0)
    t, radius = np.linspace(0, 2 * np.pi, 73)[:, None], np.radians(10)
    return np.cos(radius) * direction + np.sin(radius) * (np.cos(t) * left + np.sin(t) * np.cross(direction, left))


PANELS = {"11 panorama and sphere": sphere_panel}
