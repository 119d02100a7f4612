"""Lesson 14's panel: the triangle from the side, and from above the ellipse of the error."""

import numpy as np
from matplotlib.patches import Polygon

from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Drawing, Panel, Slider
from course_lib.lessons.lesson_14.noise import PIXEL, directions_to, ellipse, sampled_places
from course_lib.plots import figures
from course_lib.spherical_stereo.ranging.triangulation import OK, triangulation_covariance


def triangulation_panel() -> Panel:
    """Sliders for the object, the rig and the noise; the triangle from the side, and from above the error ellipse."""
    figure, (side, above) = figures.new_figure(1, 2, size=(9.8, 3.9))
    names = {"title": "From the side: rays, one sigma wide", "xlabel": "horizontal range [m]", "ylabel": "height [m]"}
    side.set(**names, xlim=(-0.3, 10), ylim=(-0.1, 3.1))
    names = {"title": "From above: where the object may be", "xlabel": "x, forward [m]", "ylabel": "y, left [m]"}
    above.set(**names, xlim=(-0.5, 10), ylim=(-4.2, 4.2))
    colours = (figures.BLUE, figures.ORANGE)
    wedges = [side.add_patch(Polygon(np.zeros((3, 2)), color=colour, alpha=0.35)) for colour in colours]
    (cameras,) = side.plot([], [], "o", color="black", markersize=6)
    clouds = [axes.plot([], [], ".", color="0.45", markersize=2)[0] for axes in (side, above)]
    objects = [axes.plot([], [], "*", color=figures.VERMILION, markersize=8)[0] for axes in (side, above)]
    above.plot(0, 0, "o", color="black", markersize=6, label="rig")
    (ray,) = above.plot([], [], color="0.6", linewidth=0.8)
    (outline,) = above.plot([], [], color=figures.BLUE, linewidth=1.8, label="two sigma, first order")
    above.plot([], [], ".", color="0.45", label="400 noisy measurements")
    above.legend(loc="upper left", fontsize=7.5)
    live = LiveFigure(figure, [*wedges, cameras, ray, *clouds, outline, *objects])

    def draw(x: float, y: float, z: float, camera: float, baseline: float, sigma: float) -> Drawing:
        point, noise = np.array([x, y, z - camera]), sigma * PIXEL
        upper, lower = directions_to(point, baseline)
        covariance = triangulation_covariance(upper, lower, baseline, noise, noise)
        rho, d = np.hypot(x, y), float(np.linalg.norm(point))
        towards = np.array([x, y]) / rho
        across = np.array([-towards[1], towards[0]])
        along_sigma, across_sigma = (np.sqrt(way @ covariance[:2, :2] @ way) for way in (towards, across))
        cloud, outcomes = sampled_places(point, baseline, noise)
        for wedge, height in zip(wedges, (camera, camera - baseline), strict=True):
            e = np.arctan2(z - height, rho) + np.array([-noise, noise])
            wedge.set_xy([(0, height), *((12 * np.cos(a), height + 12 * np.sin(a)) for a in e)])
        cameras.set_data([0, 0], [camera, camera - baseline])
        clouds[0].set_data(np.hypot(cloud[:, 0], cloud[:, 1]), cloud[:, 2] + camera)
        clouds[1].set_data(cloud[:, 0], cloud[:, 1])
        objects[0].set_data([rho], [z])
        objects[1].set_data([x], [y])
        ray.set_data([0, x], [0, y])
        outline.set_data(*ellipse(covariance[:2, :2], np.array([x, y])).T)
        parallax = np.diff([np.arcsin(v[2]) for v in (upper, lower)])[0] / PIXEL
        lines = [
            f"d {d:.2f} m, horizontal range {rho:.2f} m, parallax e_l - e_u {parallax:.1f} pixels",
            f"sigma along the ray {along_sigma:.2f} m, across {across_sigma:.3f} m; "
            f"no distance (parallel or diverging): {(outcomes != OK).mean():.0%} of the measurements",
        ]
        alt = f"Two rays from the side and the error ellipse from above. {' '.join(lines)}"
        return Drawing(live.png(), alt, "\n".join(lines))

    controls = [
        Slider("x", "object: x, forward [m]", 0.5, 9.0, 5.0, 0.1),
        Slider("y", "object: y, left [m]", -3.0, 3.0, 1.0, 0.1),
        Slider("z", "object: height of its centre [m]", 0.0, 2.5, 0.5, 0.1),
        Slider("camera", "upper camera: height [m]", 1.0, 2.5, 1.44, 0.02),
        Slider("baseline", "baseline B [m]", 0.05, 0.9, 0.3, 0.05),
        Slider("sigma", "noise of every angle [pixels]", 0.0, 4.0, 1.0, 0.25),
    ]
    return Panel("14 distance and error ellipse", controls, draw)


PANELS = {"14 distance and error ellipse": triangulation_panel}
