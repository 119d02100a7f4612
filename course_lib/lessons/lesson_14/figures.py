"""Figures of lesson 14: the triangle of two cameras and a point, objects from above, the ellipse, errors over range."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Arc

from course_lib.lessons.lesson_14.noise import ellipse
from course_lib.plots.figures import BLUE, ORANGE, VERMILION, line_style, new_figure
from course_lib.plots.panorama_drawing import class_style
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap


def triangle_figure(horizontal_range: float, height: float, upper_height: float, baseline: float) -> Figure:
    """The vertical plane through both cameras and a point, with the angles and lengths of the text; metres."""
    figure, axes = new_figure(size=(7.4, 3.9))
    point = np.array([horizontal_range, height])
    for name, z, colour, line in (("u", upper_height, BLUE, "-"), ("l", upper_height - baseline, ORANGE, "--")):
        axes.plot([0, point[0]], [z, point[1]], color=colour, linestyle=line, linewidth=1.8)
        axes.plot([0, 1.1], [z, z], color="0.7", linewidth=0.8)
        angle = np.degrees(np.arctan2(point[1] - z, point[0]))
        axes.add_patch(Arc((0, z), 1.7, 1.7, theta1=min(angle, 0), theta2=max(angle, 0), color=colour, linewidth=1.4))
        axes.text(0.92, z + 0.43 * np.radians(angle), f"$e_{name}$", color=colour, fontsize=11, va="center")
        axes.plot(0, z, "o" if name == "u" else "s", color=colour, markersize=8)
        axes.text(-0.1, z, "upper" if name == "u" else "lower", ha="right", va="center", fontsize=9)
    axes.plot([0, 0], [upper_height, upper_height - baseline], color="black", linewidth=3)
    axes.text(0.07, upper_height - 0.6 * baseline, "$B$", fontsize=11, va="center")
    axes.plot(*point, "*", color=VERMILION, markersize=14)
    axes.text(point[0] + 0.1, point[1], "$\\mathbf{X}$", fontsize=12, va="center")
    axes.text(point[0] * 0.55, upper_height + (height - upper_height) * 0.55 + 0.09, "$d$", color=BLUE, fontsize=12)
    axes.annotate("", (0, -0.12), (point[0], -0.12), arrowprops={"arrowstyle": "<->", "color": "0.3"})
    axes.text(point[0] / 2, -0.06, r"$\rho$", fontsize=12, ha="center", va="bottom")
    axes.plot([point[0], point[0]], [-0.12, point[1]], color="0.7", linewidth=0.8)
    axes.set(
        title="Seen from the side: two cameras and a point",
        xlabel="horizontal range [m]",
        ylabel="height [m]",
        xlim=(-0.75, horizontal_range + 0.4),
        ylim=(-0.2, upper_height + 0.3),
        aspect="equal",
    )
    return figure


def places_figure(
    semantic_map: SemanticMap, pose: Sequence[float], labels: Sequence[str], places: np.ndarray
) -> Figure:
    """Objects on the map of the room: where the map has them, and where the two boxes put them.

    pose: [x, y, heading] of the rig. places: `(n, 2)` metres, in the room, of objects with these labels.
    """
    figure, axes = new_figure(size=(6.4, 4.8))
    corners = np.vstack([semantic_map.walls, semantic_map.walls[:1]])
    axes.plot(*corners.T, color="black", linewidth=2)
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
    return figure


def growth_figure(ranges: np.ndarray, curves: dict[str, np.ndarray]) -> Figure:
    """Standard deviation of the range over the range, on logarithmic axes: squares are straight lines."""
    figure, axes = new_figure(size=(6.4, 3.4))
    for index, (name, values) in enumerate(curves.items()):
        axes.plot(ranges, values, **(line_style(index) | {"markevery": 6}), label=name)
    axes.set(title="One pixel of error", xlabel="horizontal range [m]", ylabel="sigma of the range [m]")
    _logarithmic(axes, (0.5, 1, 2, 4, 8), (0.001, 0.01, 0.1, 1))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return figure


def errors_figure(true: np.ndarray, errors: dict[str, np.ndarray]) -> Figure:
    """Measured minus true range over the true range, one small plot for each way to measure."""
    figure, plots = new_figure(1, len(errors), size=(9.4, 3.2))
    for index, (axes, (name, error)) in enumerate(zip(np.atleast_1d(plots), errors.items(), strict=True)):
        style = line_style(index)
        axes.axhline(0, color="0.5", linewidth=0.9)
        axes.plot(true, np.clip(error, -2, 2), style["marker"], color=style["color"], markersize=3.5, alpha=0.7)
        axes.set(title=name, xlabel="true range [m]", ylabel="measured - true [m]", ylim=(-2.05, 2.05))
    return figure


def _logarithmic(axes: Axes, x_ticks: Sequence[float], y_ticks: Sequence[float]) -> None:
    axes.set(xscale="log", yscale="log")
    axes.set_xticks(x_ticks, [f"{tick:g}" for tick in x_ticks])
    axes.set_yticks(y_ticks, [f"{tick:g}" for tick in y_ticks])
    axes.minorticks_off()


def ellipse_figure(
    place: np.ndarray, covariance: np.ndarray, samples: np.ndarray, ways: np.ndarray, sigmas: np.ndarray
) -> Figure:
    """The error ellipse from above, in the room and drawn large, with its two axes.

    place: `(3,)`, covariance: `(3, 3)` of it, samples: `(n, 3)` noisy measurements, metres in the upper camera's frame.
    ways: `(2, 2)`, the axes' unit vectors in its columns, sigmas: `(2,)` metres along them, the smaller first.
    """
    figure, (room, large) = new_figure(1, 2, size=(9.4, 4.4))
    room.plot([0, 1.25 * place[0]], [0, 1.25 * place[1]], color="0.6", linewidth=0.9, label="ray")
    room.plot(0, 0, "o", color="black", label="rig")
    room.plot(*ellipse(covariance[:2, :2], place[:2]).T, color=BLUE, linewidth=1.6, label="two sigma")
    room.set(title="From above", xlabel="x, forward [m]", ylabel="y, left [m]", aspect="equal")
    room.legend(fontsize=8)
    along, across = (way * np.sign(way @ side) for way, side in zip(ways.T[::-1], _ray_and_left(place), strict=True))
    turn = np.stack([along, across])
    q = 100 * (samples[:, :2] - place[:2]) @ turn.T
    large.plot(*q.T, ".", color="0.6", markersize=2.5, label=f"{len(samples)} noisy measurements")
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
    return figure


def _ray_and_left(place: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """From above: the direction away from the rig, and the one to the left of it."""
    ray = place[:2] / np.linalg.norm(place[:2])
    return ray, np.array([-ray[1], ray[0]])
