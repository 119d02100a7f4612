"""Figures of lesson 00: the idea, the hills of eq. (8), the filter at work, the second method on one pair."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from course_lib.depth_mcl.localizer import Estimate
from course_lib.lessons.lesson_00.recorded import Moment
from course_lib.plots import figures
from course_lib.plots.corridor_figures import floor_plan
from course_lib.plots.panorama_drawing import add_list, draw_box, draw_numbers, panorama
from course_lib.plots.room_figures import draw_pose, map_axes
from course_lib.rendering.scene_map import SceneMap
from course_lib.spherical_stereo.pose.localization import Localization
from course_lib.spherical_stereo.recording import StereoPair
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

DEPTH_LIMITS = (0.0, 10.0)  # metres: the range of the camera
UNITS = {"x": "m", "y": "m", "yaw": "degrees"}


def draw_camera(axes: Axes, state: np.ndarray, index: int, label: str) -> None:
    """A camera from above: its place and the edges of its view, 2 m long."""
    style = figures.line_style(index)
    half = np.deg2rad(21.8)  # half of the SR4000's 43.6 degrees
    ends = state[5] + np.array([half, -half])
    x, y = state[0] + 2.0 * np.cos(ends), state[1] + 2.0 * np.sin(ends)
    axes.plot([x[0], state[0], x[1]], [y[0], state[1], y[1]], **(style | {"marker": ""}))
    axes.plot(state[0], state[1], **(style | {"linestyle": "none", "markersize": 8}), label=label)


def draw_walls(axes: Axes, scene_map: SceneMap, height: float, around: np.ndarray, reach: float = 3.0) -> None:
    """The map, cut at camera height, near a point; sets limits and labels."""
    walls = floor_plan(scene_map.vertices, height)
    walls = walls[np.abs(walls[:, 0] - around[0]) < reach + 0.5]
    axes.plot(walls[:, 0], walls[:, 1], ".", color="0.6", markersize=1.2, zorder=1)
    axes.set(xlim=(around[0] - reach, around[0] + reach), ylim=(-2.2, 2.2), xlabel="x [m]", ylabel="y [m]")


def idea_figure(now: Moment, guess: np.ndarray) -> Figure:
    """The camera and a particle from above, what the camera measured, and what the particle would see."""
    figure, (plan, left, right) = figures.new_figure(1, 3, size=(9.8, 2.9))
    draw_walls(plan, now.renderer.scene_map, now.state[2], now.state)
    draw_camera(plan, now.state, 0, "camera (true)")
    draw_camera(plan, guess, 1, "particle (guess)")
    plan.set(title="From above", ylim=(-2.2, 3.4), aspect="equal")
    plan.legend(loc="upper center", fontsize=8, ncols=2, columnspacing=0.8, handletextpad=0.2)
    figures.depth_image(left, now.measured, "Measured by the camera", DEPTH_LIMITS)
    drawn = figures.depth_image(right, now.renderer.render(guess)[0], "Seen from the particle", DEPTH_LIMITS)
    figures.colour_bar(figure, drawn, [left, right])
    return figure


def hills_figure(now: Moment, offsets: dict[str, np.ndarray], shares: dict[str, np.ndarray]) -> Figure:
    """Equation (8) over the particle's distance from the true pose, one picture for each of x, y and yaw."""
    figure, axes = figures.new_figure(1, 3, size=(9.4, 2.7))
    for index, (a, name) in enumerate(zip(axes, offsets, strict=True)):
        a.plot(offsets[name], shares[name], **(figures.line_style(index) | {"markersize": 3.5}))
        a.axvline(0, color="black", linewidth=0.8, linestyle=(0, (4, 3)))
        a.set(title=f"{name} alone is wrong", xlabel=f"{name} - true {name} [{UNITS[name]}]", ylim=(0, 0.85))
        a.set_ylabel("l / m [-]")
    return figure


def covered_figure(offsets: np.ndarray, shares: dict[str, np.ndarray]) -> Figure:
    """Equation (8) along the corridor for several parts of one image."""
    figure, axes = figures.new_figure(size=(6.4, 2.9))
    for index, (name, share) in enumerate(shares.items()):
        axes.plot(offsets, share, **(figures.line_style(index) | {"markersize": 4}), label=name)
    axes.set(title="Equation (8) along the corridor", xlabel="x - true x [m]", ylabel="l / m [-]", ylim=(0, 1))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return figure


def filter_figure(estimates: list[Estimate], true: np.ndarray) -> Figure:
    """From above: the particles of every frame, the estimates and the true positions `(T, 2 or 3)`."""
    figure, axes = figures.new_figure(size=(8.6, 2.9))
    positions = np.array([estimate.state for estimate in estimates])
    cloud = np.concatenate([estimate.particles for estimate in estimates])
    axes.plot(cloud[:, 0], cloud[:, 1], ".", color=figures.SKY_BLUE, markersize=3, label="particles of all frames")
    axes.plot(true[:, 0], true[:, 1], **(figures.line_style(0) | {"markersize": 7}), label="true position")
    axes.plot(positions[:, 0], positions[:, 1], **(figures.line_style(3) | {"markersize": 5}), label="estimate")
    axes.set(title="The filter at work, seen from above (y enlarged)", xlabel="x [m]", ylabel="y [m]")
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return figure


def room_figure(pair: StereoPair, found: Localization, semantic_map: SemanticMap) -> Figure:
    """The second method on one pair: what was detected in the upper panorama, and the pose on the map."""
    image, _ = pair.images()
    figure, (view, plan) = figures.new_figure(1, 2, size=(10.4, 4.6))
    panorama(view, image, f"Upper camera: {len(found.upper_detections)} objects found")
    labels = [one.label for one in found.upper_detections]
    for index, (_, landmark) in enumerate(found.used_pairs):
        ends = np.stack([(found.pose.x, found.pose.y), semantic_map.positions[landmark]])
        plan.plot(*ends.T, color="0.6", linewidth=0.8, label=None if index else "used for the pose")
    draw_pose(plan, *pair.pose, figures.BLACK, "true pose")
    draw_pose(plan, found.pose.x, found.pose.y, found.pose.theta, figures.ORANGE, "estimated pose")
    map_axes(plan, semantic_map, "The semantic map, from above")
    plan.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=7, frameon=False)
    lines = [f"{number:2d} {label}" for number, label in enumerate(labels, start=1)]
    add_list(figure, lines, 7, "the numbers in the panorama", labels)
    boxes = [one.box for one in found.upper_detections]
    for box, label in zip(boxes, labels, strict=True):
        draw_box(view, box, image.shape[1], label)
    draw_numbers(view, boxes, labels, image.shape[1])
    return figure
