"""Figures and panel of lesson 14: the triangle, the ellipse of its error, objects from above, errors over the range."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Polygon

from course_lib.spherical_stereo.outcomes import ObjectOutcome
from course_lib.spherical_stereo.panorama import direction_from_angles
from course_lib.spherical_stereo.ranging import triangulation
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap
from courseware.lessons.kit.display import described
from courseware.lessons.kit.live_figure import LiveFigure
from courseware.lessons.kit.panel import Drawing, Panel, Slider
from courseware.plots.figures import BLUE, ORANGE, VERMILION, line_style, new_figure
from courseware.plots.panorama_drawing import class_style

SCENE_ALT = (
    "Two cameras on one axis, rays to twelve objects, thin green ellipsoids that point at the rig, and black balls at "
    "the true places: near ones beside small ellipsoids, far ones inside long ones."
)

PIXEL = 2 * np.pi / 1280  # radians of one pixel of the room's panoramas, in azimuth and in elevation alike
# Standard normal draws for azimuth, upper and lower elevation, the same for every setting, so that nothing flickers.
SAMPLES = np.random.default_rng(14).standard_normal((400, 3))


def places_figure(semantic_map: SemanticMap, pose: np.ndarray, labels: Sequence[str], places: np.ndarray) -> Figure:
    """Return the map of the room with the rig at `pose` and the places `(n, 2)` [m] of objects with these labels."""
    figure, axes = new_figure(size=(6.4, 4.8))
    axes.plot(*np.vstack([semantic_map.walls, semantic_map.walls[:1]]).T, color="black", linewidth=2)
    for label, (x, y) in zip(semantic_map.labels, semantic_map.positions, strict=True):
        colour, marker = class_style(label)
        axes.plot(x, y, marker, color=colour, markersize=10, alpha=0.45)
    for label, (x, y) in zip(labels, places, strict=True):
        axes.plot([pose[0], x], [pose[1], y], color="0.8", linewidth=0.8, zorder=1)
        axes.plot(x, y, "x", color=class_style(label)[0], markersize=8, markeredgewidth=2)
    for label in dict.fromkeys(semantic_map.labels):
        colour, marker = class_style(label)
        axes.plot([], [], marker, linestyle="none", color=colour, alpha=0.45, label=f"{label}, map")
    axes.plot([], [], "x", linestyle="none", color="0.3", label="from two boxes")
    axes.plot(*pose[:2], "o", color="black", label="rig")
    axes.set(title="Objects from above", xlabel="x [m]", ylabel="y [m]", aspect="equal")
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8, frameon=False)
    alt = "The room from above: the rig, pale markers where the map has the objects, and crosses where two boxes put "
    return described(figure, alt + "them, most of them close to their markers.")


def growth_figure(ranges: np.ndarray, curves: dict[str, np.ndarray]) -> Figure:
    """Return the standard deviation of the range over the range, on logarithmic axes: squares are straight lines."""
    figure, axes = new_figure(size=(6.4, 3.4))
    for index, (name, values) in enumerate(curves.items()):
        axes.plot(ranges, values, **(line_style(index) | {"markevery": 6}), label=name)
    axes.set(title="One pixel of error", xlabel="horizontal range [m]", ylabel="sigma of the range [m]")
    axes.set(xscale="log", yscale="log")
    axes.set_xticks([0.5, 1, 2, 4, 8], ["0.5", "1", "2", "4", "8"])
    axes.set_yticks([0.001, 0.01, 0.1, 1], ["0.001", "0.01", "0.1", "1"])
    axes.minorticks_off()
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    alt = "Sigma of the range over the range on logarithmic axes: three parallel straight lines, lower for longer "
    return described(figure, alt + "baselines.")


def errors_figure(true: np.ndarray, errors: dict[str, np.ndarray]) -> Figure:
    """Return measured minus true range over the true range, one small plot for each way to measure."""
    figure, plots = new_figure(1, len(errors), size=(9.4, 3.2))
    for index, (axes, (name, error)) in enumerate(zip(plots, errors.items(), strict=True)):
        style = line_style(index)
        axes.axhline(0, color="0.5", linewidth=0.9)
        axes.plot(true, np.clip(error, -2, 2), style["marker"], color=style["color"], markersize=3.5, alpha=0.7)
        axes.set(title=name, xlabel="true range [m]", ylabel="measured - true [m]", ylim=(-2.05, 2.05))
    alt = "Errors over the true range with boxes off by three pixels: box centres scatter by up to two metres beyond 4 "
    return described(figure, alt + "m, features stay within about half a metre everywhere.")


def directions_to(point: np.ndarray, baseline: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the unit vectors `(3,)` from the upper and the lower camera to a point in the upper camera's frame."""
    return tuple(ray / np.linalg.norm(ray) for ray in (point, np.add(point, [0.0, 0.0, baseline])))


def noisy_directions(point: np.ndarray, baseline: float, sigma: float) -> tuple[np.ndarray, np.ndarray]:
    """Return 400 directions `(400, 3)` to one point, with noise of sigma radians on azimuth and both elevations."""
    (x, y, z), (turned, *lifted), end = point, sigma * SAMPLES.T, np.pi / 2 - 1e-6
    elevations = (np.arctan2(height, np.hypot(x, y)) for height in (z, z + baseline))
    pairs = zip(elevations, lifted, strict=True)
    return tuple(direction_from_angles(np.arctan2(y, x) + turned, np.clip(e + n, -end, end)) for e, n in pairs)


def sampled_places(point: np.ndarray, baseline: float, sigma: float) -> tuple[np.ndarray, np.ndarray]:
    """Return places `(k, 3)` [m] of the noisy directions that have one, and the outcomes `(400,)` of all."""
    upper, lower = noisy_directions(point, baseline, sigma)
    outcomes = triangulation.triangulation_outcome(upper, lower)
    ok = outcomes == ObjectOutcome.OK
    return triangulation.object_position(upper[ok], lower[ok], baseline) if ok.any() else np.zeros((0, 3)), outcomes


def ellipse(covariance: np.ndarray, centre: np.ndarray, n_sigma: float = 2.0) -> np.ndarray:
    """Return the outline `(60, 2)` of points n_sigma standard deviations from the centre; covariance `(2, 2)`."""
    values, vectors = np.linalg.eigh(covariance)
    turn = np.linspace(0, 2 * np.pi, 60)
    axes = n_sigma * np.sqrt(np.maximum(values, 0))[:, None] * np.stack([np.cos(turn), np.sin(turn)])
    return centre + (vectors @ axes).T


def triangle_figure(horizontal_range: float, height: float, upper_height: float, baseline: float) -> Figure:
    """Return the vertical plane through both cameras and a point, with the angles and lengths of the text [m]."""
    figure, axes = new_figure(size=(7.4, 3.9))
    cameras = ("upper", upper_height, BLUE, "-", "o"), ("lower", upper_height - baseline, ORANGE, "--", "s")
    for name, z, colour, line, marker in cameras:
        axes.plot([0, horizontal_range], [z, height], line, color=colour, linewidth=1.8)
        axes.plot([0, 1.1], [z, z], color="0.7", linewidth=0.8)
        angle = np.degrees(np.arctan2(height - z, horizontal_range))
        axes.add_patch(Arc((0, z), 1.7, 1.7, theta1=min(angle, 0), theta2=max(angle, 0), color=colour, linewidth=1.4))
        axes.text(0.92, z + 0.43 * np.radians(angle), f"$e_{name[0]}$", color=colour, fontsize=11, va="center")
        axes.plot(0, z, marker, color=colour, markersize=8)
        axes.text(-0.1, z, name, ha="right", va="center", fontsize=9)
    axes.plot([0, 0], [upper_height, upper_height - baseline], color="black", linewidth=3)
    axes.text(0.07, upper_height - 0.6 * baseline, "$B$", fontsize=11, va="center")
    axes.plot(horizontal_range, height, "*", color=VERMILION, markersize=14)
    axes.text(horizontal_range + 0.1, height, "$\\mathbf{X}$", fontsize=12, va="center")
    middle = upper_height + (height - upper_height) * 0.55 + 0.09
    axes.text(horizontal_range * 0.55, middle, "$d$", color=BLUE, fontsize=12)
    axes.annotate("", (0, -0.12), (horizontal_range, -0.12), arrowprops={"arrowstyle": "<->", "color": "0.3"})
    axes.text(horizontal_range / 2, -0.06, r"$\rho$", fontsize=12, ha="center", va="bottom")
    axes.plot([horizontal_range, horizontal_range], [-0.12, height], color="0.7", linewidth=0.8)
    axes.set(title="Seen from the side: two cameras and a point", xlabel="horizontal range [m]", ylabel="height [m]")
    axes.set(xlim=(-0.75, horizontal_range + 0.4), ylim=(-0.2, upper_height + 0.3), aspect="equal")
    alt = "A triangle of the upper camera, the lower camera and a point. The baseline B is its left side; the ray d "
    alt += "from the upper camera drops by the angle e_u, that from the lower camera by the smaller e_l."
    return described(figure, alt)


def ellipse_figure(place, covariance: np.ndarray, samples: np.ndarray, ways: np.ndarray, sigmas: np.ndarray) -> Figure:
    """Return the error ellipse from above, in the room and drawn large, with its two axes.

    place: `(3,)`, covariance: `(3, 3)` of it, samples: `(n, 3)` noisy measurements, metres in the upper camera's frame.
    ways: `(2, 2)`, the axes' unit vectors in its columns, sigmas: `(2,)` metres along them, the smaller first.
    """
    figure, (room, large) = new_figure(1, 2, size=(9.4, 4.4))
    room.plot([0, 1.25 * place[1]], [0, 1.25 * place[0]], color="0.6", linewidth=0.9, label="ray")
    room.plot(0, 0, "o", color="black", label="rig")
    room.plot(*ellipse(covariance[:2, :2], place[:2]).T[::-1], color=BLUE, linewidth=1.6, label="two sigma")
    room.set(title="From above, forward is up", xlabel="y, left [m]", ylabel="x, forward [m]", aspect="equal")
    room.invert_xaxis()
    room.legend(fontsize=8)
    ray, left = place[:2], np.array([-place[1], place[0]])
    turn = np.stack([way * np.sign(way @ side) for way, side in zip(ways.T[::-1], (ray, left), strict=True)])
    scattered = 100 * (samples[:, :2] - place[:2]) @ turn.T
    large.plot(*scattered.T, ".", color="0.6", markersize=2.5, label=f"{len(samples)} noisy measurements")
    for n_sigma, line in ((1, "-"), (2, "--")):
        outline = ellipse(1e4 * turn @ covariance[:2, :2] @ turn.T, np.zeros(2), n_sigma)
        large.plot(*outline.T, line, color=BLUE, linewidth=1.6, label=f"{n_sigma} sigma")
    ends = 100 * np.diag(sigmas[::-1])
    for end, colour, name in zip(ends, (VERMILION, ORANGE), ("along", "across"), strict=True):
        large.annotate("", end, (0, 0), arrowprops={"arrowstyle": "-|>", "color": colour, "linewidth": 2})
        large.plot([], [], color=colour, linewidth=2, label=f"{name}: {end.max():.1f} cm")
    large.set(title="Turned, and stretched across the ray", xlabel="along the ray, away from the rig [cm]")
    large.set(ylabel="across it, left [cm]", xlim=(-330 * sigmas[1], 330 * sigmas[1]))
    large.set(ylim=(-400 * sigmas[0], 550 * sigmas[0]))
    large.legend(loc="upper center", fontsize=8, ncols=2)
    alt = "From above: a ray from the rig to the sofa, and around the sofa a needle along the ray. Drawn large: 400 "
    alt += "dots, the ellipses of one and two sigma, and their two axes, along the ray and across it."
    return described(figure, alt)


def triangulation_panel() -> Panel:
    """Sliders for the object, the rig and the noise; the triangle from the side, and from above the error ellipse."""
    figure, (side, above) = new_figure(1, 2, size=(9.8, 3.9))
    side.set(title="From the side: rays, one sigma wide", xlabel="horizontal range [m]", ylabel="height [m]")
    side.set(xlim=(-0.3, 10), ylim=(-0.1, 3.1))
    above.set(title="From above: where the object may be", xlabel="y, left [m]", ylabel="x, forward [m]")
    above.set(xlim=(4.2, -4.2), ylim=(-0.5, 10))
    wedges = [side.add_patch(Polygon(np.zeros((3, 2)), color=colour, alpha=0.35)) for colour in (BLUE, ORANGE)]
    (cameras,) = side.plot([], [], "o", color="black", markersize=6)
    clouds = [axes.plot([], [], ".", color="0.45", markersize=2)[0] for axes in (side, above)]
    objects = [axes.plot([], [], "*", color=VERMILION, markersize=8)[0] for axes in (side, above)]
    above.plot(0, 0, "o", color="black", markersize=6, label="rig")
    (ray,) = above.plot([], [], color="0.6", linewidth=0.8)
    (outline,) = above.plot([], [], color=BLUE, linewidth=1.8, label="two sigma, first order")
    above.plot([], [], ".", color="0.45", label="400 noisy measurements")
    above.legend(loc="upper left", fontsize=7.5)
    live = LiveFigure(figure, [*wedges, cameras, ray, *clouds, outline, *objects])

    def draw(x: float, y: float, z: float, camera: float, baseline: float, sigma: float) -> Drawing:
        point, noise = np.array([x, y, z - camera]), sigma * PIXEL
        upper, lower = directions_to(point, baseline)
        covariance = triangulation.triangulation_covariance(upper, lower, baseline, noise, noise)
        rho, d = np.hypot(x, y), float(np.linalg.norm(point))
        ways = np.array([[x, y], [-y, x]]) / rho  # along the ray and across it
        along_sigma, across_sigma = (np.sqrt(way @ covariance[:2, :2] @ way) for way in ways)
        cloud, outcomes = sampled_places(point, baseline, noise)
        for wedge, height in zip(wedges, (camera, camera - baseline), strict=True):
            e = np.arctan2(z - height, rho) + np.array([-noise, noise])
            wedge.set_xy([(0, height), *((12 * np.cos(a), height + 12 * np.sin(a)) for a in e)])
        cameras.set_data([0, 0], [camera, camera - baseline])
        clouds[0].set_data(np.hypot(*cloud[:, :2].T), cloud[:, 2] + camera)
        clouds[1].set_data(cloud[:, 1], cloud[:, 0])
        objects[0].set_data([rho], [z])
        objects[1].set_data([y], [x])
        ray.set_data([0, y], [0, x])
        outline.set_data(*ellipse(covariance[:2, :2], np.array([x, y])).T[::-1])
        parallax = np.diff([np.arcsin(v[2]) for v in (upper, lower)])[0] / PIXEL
        place = f"d {d:.2f} m, horizontal range {rho:.2f} m, parallax e_l - e_u {parallax:.1f} pixels"
        lost = f"no distance (parallel or diverging): {(outcomes != ObjectOutcome.OK).mean():.0%} of the measurements"
        errors = f"sigma along the ray {along_sigma:.2f} m, across {across_sigma:.3f} m; {lost}"
        alt = f"Two rays from the side and the error ellipse from above. {place} {errors}"
        return Drawing(live.png(), alt, f"{place}\n{errors}")

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
