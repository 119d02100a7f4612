"""Figures of lesson 19: what the two sensors see, the error after each stage, how far off a start may be."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from courseware.experiments.finale import mean_score
from courseware.experiments.intervals import wilson_percent
from courseware.lessons.kit.display import described
from courseware.lessons.lesson_19.stages import Journey, state_error, world
from courseware.plots import figures
from courseware.plots.panorama_drawing import class_style, draw_box, panorama
from courseware.plots.room_figures import draw_pose

VIEW = np.deg2rad(21.8)  # half of the angle that the depth camera sees
SCENE_ALT = (
    "A furnished room cut open, its landmarks as posts with names; on the far wall a blue patch with the potted plant, "
    "on the same wall a tilted purple patch beside the refrigerator, and an orange one below the ceiling."
)
TRUE_PLACE = {"marker": "x", "color": figures.BLACK, "markersize": 9, "markeredgewidth": 2}


def draw_room(axes: Axes, title: str) -> None:
    """Draw the true room from above: walls, and every piece's footprint in its class's colour, with its name."""
    here = world()
    axes.plot(*np.vstack([here.room.walls, here.room.walls[:1]]).T, color=figures.BLACK, linewidth=2.0)
    labels = [item.label for item in here.room.objects]
    for corners, label in zip(here.footprints, labels, strict=True):
        colour, _ = class_style(label)
        axes.add_patch(Polygon(corners, facecolor=colour, alpha=0.35, edgecolor=colour))
    centres = np.array([corners.mean(axis=0) for corners in here.footprints])
    for names, k in named_together(labels, centres):
        across, along = np.ptp(here.footprints[k], axis=0)
        turned = 90 if along > 2 * across else 0  # a name is wider than a narrow piece, and would cross the wall
        words = {"rotation": turned, "fontsize": 6, "linespacing": 0.9, "clip_on": True}
        axes.text(*centres[k], "\n".join(names), ha="center", va="center", **words)
    axes.set(title=title, xlabel="x [m]", ylabel="y [m]", aspect="equal")


def named_together(labels: Sequence[str], places: np.ndarray) -> list[tuple[list[str], int]]:
    """Return (names, index of the first) of things within 0.3 m, so that no name covers another; places `(n, 2)`."""
    groups: dict[int, list[str]] = {}
    for k, label in enumerate(labels):
        first = next((one for one in groups if np.hypot(*(places[one] - places[k])) < 0.3), k)
        groups.setdefault(first, []).append(label)
    return [(names, first) for first, names in groups.items()]


def ellipse(covariance: np.ndarray, centre: Sequence[float]) -> np.ndarray:
    """Return the outline `(2, n)` of two standard deviations about a centre; covariance `(2, 2)`."""
    values, vectors = np.linalg.eigh(covariance)
    circle = np.linspace(0, 2 * np.pi, 73)
    ring = np.sqrt(np.maximum(values, 0))[:, None] * np.stack([np.cos(circle), np.sin(circle)])
    return np.asarray(centre)[:, None] + 2 * vectors @ ring


def sensors_figure(one: Journey) -> Figure:
    """Draw what both sensors see from one place: the upper panorama with its objects, the depth image, the plan."""
    figure = figures.new_figure(size=(8.2, 5.3))[0]
    figure.clear()
    above, image, plan = figure.subplot_mosaic("aa;ip", height_ratios=[1.0, 1.1]).values()
    small = one.images[0][::2, ::2]
    panorama(above, small, f"Upper panorama: {len(one.found.upper_detections)} objects found")
    above.set_ylim(0.80 * small.shape[0], 0.34 * small.shape[0])  # ceiling and tripod left out: the objects larger
    for detection in one.found.upper_detections:
        draw_box(above, np.array(detection.box) / 2, small.shape[1], detection.label, detection.label)
    _draw_depth(image, one.depths[0], "Depth image, 43 degrees wide")
    draw_room(plan, "The room from above, and the robot")
    draw_pose(plan, *one.pose, figures.BLACK)
    x, y, heading = one.pose
    for angle in (heading - VIEW, heading + VIEW):
        plan.plot([x, x + 2.5 * np.cos(angle)], [y, y + 2.5 * np.sin(angle)], color=figures.BLUE, linewidth=1.2)
    alt = "A panorama with twelve framed objects, a depth image of a wall and a plant, and the room from above."
    return described(figure, alt)


def _draw_depth(axes: Axes, depth: np.ndarray, title: str) -> None:
    """Draw a depth image and its colour bar, between limits [dm] that hold nearly all depths."""
    low, high = np.nanpercentile(depth, [1, 99])
    drawn = figures.depth_image(axes, depth, title, (float(np.floor(10 * low) / 10), float(np.ceil(10 * high) / 10)))
    figures.colour_bar(axes.figure, drawn, axes)


def stages_figure(one: Journey) -> Figure:
    """Draw the same place three times, each closer: the room, what the panoramas say, what the depth camera says."""
    figure, axes = figures.new_figure(1, 3, size=(10.4, 4.0))
    axes[0].get_gridspec().set_width_ratios([1.4, 1.0, 1.0])
    draw_room(axes[0], "Before, anywhere in here")
    for name in axes[0].texts:
        name.set_fontsize(7.5)
    axes[0].plot(*one.pose[:2], **TRUE_PLACE, linestyle="none")
    found, first = one.found, one.best[0]
    for a, half, title in ((axes[1], 20.0, "After the panoramas"), (axes[2], 15.0, "After the depth image")):
        place = 100 * (np.array(found.pose[:2]) - one.pose[:2])
        a.plot(0, 0, **TRUE_PLACE, linestyle="none", label="true place")
        a.plot(*place, "s", color=figures.ORANGE, label="semantic pose")
        a.plot(*ellipse(1e4 * found.covariance[:2, :2], place), color=figures.ORANGE, linestyle="--")
        if a is axes[2]:
            place = 100 * (first.state[:2] - one.states[0, :2])
            a.plot(*place, "o", color=figures.BLUE, label="depth filter")
            a.plot(*ellipse(1e4 * first.error_covariance[:2, :2], place), color=figures.BLUE)
        a.set(title=title, xlim=(-half, half), ylim=(-half, half), aspect="equal")
        a.set(xlabel="x from the true place [cm]", ylabel="y from the true place [cm]")
        a.legend(fontsize=8, loc="lower left")
    return described(
        figure, "Three plans, each closer. The room, the semantic pose and its ellipse, and the filter on the cross."
    )


def basin_figure(wrong: dict[tuple, Sequence[bool]], semantic: Sequence[tuple]) -> Figure:
    """Draw the share of filters that arrive over how far off they started, and how far off the semantic poses were.

    wrong: (metres, degrees) -> whether each filter arrived. semantic: metres and degrees of each semantic pose.
    """
    figure, axes = figures.new_figure(1, 2, size=(9.0, 3.4))
    for k, (a, name) in enumerate(zip(axes, ("start wrong by [m]", "start turned by [degrees]"), strict=True)):
        runs = {amount[k]: arrived for amount, arrived in wrong.items() if amount[k]}
        shares = [np.mean(reached) for reached in runs.values()]
        ends = [wilson_percent(int(np.sum(reached)), len(reached)) for reached in runs.values()]
        away = np.abs(np.array(ends).T / 100 - shares)
        a.errorbar(list(runs), shares, away, **figures.line_style(0), capsize=3, label="arrive, with 95 % intervals")
        errors = [one[k] for one in semantic]
        a.plot(errors, np.full(len(errors), 0.08), "|", color=figures.VERMILION, markersize=16, label="semantic poses")
        a.set(title="How far off may the start be?", xlabel=name, ylabel="share that arrives [-]", ylim=(-0.05, 1.05))
    axes[0].legend(fontsize=8, loc="upper right")
    alt = "All filters arrive from half a metre or 30 degrees, few from farther; semantic poses lie far left."
    return described(figure, alt)


def starts_figure(one: Journey) -> Figure:
    """Draw several starts of one depth filter: where each begins and ends, and how well it explains the images."""
    figure, (plan, bars) = figures.new_figure(1, 2, size=(9.4, 4.2))
    draw_room(plan, "Where each start begins (open) and ends (full)")
    draw_pose(plan, *one.pose, figures.BLACK, "true place")
    looks = ((figures.BLUE, "o", ""), (figures.ORANGE, "s", "//"), (figures.VERMILION, "D", ".."))
    for k, (start, run) in enumerate(zip(one.starts, one.runs, strict=True), start=1):
        (colour, marker, hatch), end, score = looks[k - 1], run[-1].state, mean_score(run)
        plan.plot(start.x, start.y, marker, markerfacecolor="none", color=colour, markersize=9)
        plan.plot([start.x, end[0]], [start.y, end[1]], ":", color=colour)
        plan.plot(*end[:2], marker, color=colour, markersize=5, label=f"start {k}")
        bars.bar(k, score, color=colour, hatch=hatch, edgecolor="white")
        told = f"{score:.3f}\noff by {state_error(end, one.states[-1])[0]:.2f} m"
        bars.text(k, score + 0.01, told, ha="center", fontsize=8)
    plan.legend(fontsize=7, loc="upper right", bbox_to_anchor=(0.94, 0.76))
    bars.set(title="How well it explains the depth images", ylabel="mean raw score [-]", ylim=(0, 1.15))
    bars.set_xticks(range(1, len(one.runs) + 1), [f"start {k + 1}" for k in range(len(one.runs))])
    alt = "Left, three starts in the room and where each ends, one at the robot; right, its bar is highest."
    return described(figure, alt)
