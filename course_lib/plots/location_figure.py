"""A localization as one figure: both panoramas with what was matched, and the map from above with pose and pairs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from course_lib.plots.figures import BLUE, ORANGE, VERMILION, new_figure
from course_lib.plots.panorama_drawing import add_list, class_style, draw_box, draw_numbers, panorama
from course_lib.plots.room_figures import draw_pose, map_axes
from course_lib.spherical_stereo.pose.localization import Localization
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

SIZE = (13.0, 14.5)  # inches
_DEVIATIONS = 2  # standard deviations of the ellipse around the place


def location_figure(
    images: Sequence[np.ndarray], semantic_map: SemanticMap, found: Localization, lines: Sequence[str], title: str
) -> Figure:
    """Draw both panoramas with numbered boxes, and below them the map.

    images: upper and lower, `(H, W, 3)` BGR. lines: one for each of `found.objects`, for the list of numbers. A
    pose that was rejected is drawn dashed.
    """
    figure, rows = new_figure(3, 1, size=SIZE)
    labels = [one.label for one in found.objects]
    _draw_map(rows[2], semantic_map, found, title)
    rows[2].legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8)
    for axes, image, side in zip(rows, images, ("upper", "lower"), strict=False):
        panorama(axes, image, f"{side.capitalize()} camera: {len(getattr(found, f'{side}_detections'))} objects")
    if lines:
        title = "number, object, matched features, azimuth, range [m], landmark at [m], off by [m]"
        add_list(figure, lines, 2, title, labels)
    for axes, image, side in zip(rows, images, ("upper", "lower"), strict=False):
        detections, width = getattr(found, f"{side}_detections"), image.shape[1]
        for one in detections:
            draw_box(axes, one.box, width, one.label)
        draw_numbers(axes, [detections[getattr(one, side)].box for one in found.objects], labels, width)
    return figure


def _draw_map(axes: Axes, semantic_map: SemanticMap, found: Localization, title: str) -> None:
    map_axes(axes, semantic_map, title)
    pose = found.pose or found.rejected_pose
    if pose is None:
        return
    colour, dashes = (ORANGE, "-") if found.pose else (VERMILION, "--")
    draw_pose(axes, *pose, colour, "pose" if found.pose else "rejected pose")
    if found.covariance is not None:
        values, axes_of = np.linalg.eigh(found.covariance[:2, :2])
        circle = np.linspace(0, 2 * np.pi, 60)
        ring = axes_of @ (np.sqrt(np.maximum(values, 0))[:, None] * np.stack([np.cos(circle), np.sin(circle)]))
        axes.plot(pose.x + _DEVIATIONS * ring[0], pose.y + _DEVIATIONS * ring[1], color=colour, linewidth=1.2)
    points = pose.apply([[one.x, one.y] for one in found.observations])
    landmark_of = dict(found.used_pairs)
    for index, (point, one) in enumerate(zip(points, found.observations, strict=True)):
        axes.plot(*zip(pose[:2], point, strict=True), color="0.75", linewidth=0.8, zorder=1)
        axes.plot(*point, "x", color=class_style(one.label)[0], markersize=7, markeredgewidth=1.6)
        if index in landmark_of:
            ends = zip(point, semantic_map.positions[landmark_of[index]], strict=True)
            axes.plot(*ends, color=BLUE, linestyle=dashes, linewidth=1.2)
    for number, one in enumerate(found.objects, start=1):
        if one.observation is not None:
            at = points[one.observation]
            axes.annotate(str(number), at, textcoords="offset points", xytext=(4, 4), fontsize=8)
    axes.plot([], [], "x", color="0.4", label="object as measured")
    axes.plot([], [], color=BLUE, linestyle=dashes, label="taken for this landmark")
