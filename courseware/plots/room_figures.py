"""Figures of paper 2: detections on a panorama, matched pairs on both, and the room from above."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import cv2
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PathCollection
from matplotlib.figure import Figure

from course_lib.spherical_stereo.pose.localization import Localization
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap
from courseware.experiments.room_evaluation import CORRECT, NO_OBJECT
from courseware.plots.figures import BLACK, BLUE, GREEN, ORANGE, VERMILION, new_figure
from courseware.plots.panorama_drawing import add_list, class_style, draw_box, draw_numbers, draw_objects, panorama

if TYPE_CHECKING:
    from courseware.experiments.ambiguity import AmbiguityMap

ESTIMATE = "#7B2D8E"
"""Colour of an estimated pose: a dark violet, which no class of objects has (`class_style`)."""
DEVIATIONS = 2  # standard deviations of the ellipse around a place
CONFUSIONS_DRAWN = 6
LABEL_AT = 0.38  # of a line's length: at the middle two labels would cover each other where lines cross
MIN_SHARE = 0.01  # of the belief, below which a confusion is not drawn


def detections_figure(image_bgr: np.ndarray, detections: Sequence, title: str = "Detected objects") -> Figure:
    """Every detection on its panorama, numbered; below, its class, score, and hue (or that it is grey)."""
    figure, axes = new_figure(size=(10.0, 6.6))
    panorama(axes, image_bgr, f"{title}: {len(detections)}")
    labels = [one.label for one in detections]
    hues = ["grey" if one.is_grey else f"{one.hue:3.0f}°" for one in detections]
    lines = [f"{n:2d} {one.label:12} {one.score:.2f} {hues[n - 1]}" for n, one in enumerate(detections, start=1)]
    add_list(figure, lines, 4, "number, class, score, hue", labels)
    draw_objects(axes, [one.box for one in detections], labels, image_bgr.shape[1])
    return figure


def matches_figure(upper_bgr: np.ndarray, lower_bgr: np.ndarray, localization: Localization) -> Figure:
    """Both panoramas with the objects seen in both: one number an object, and its matched features."""
    figure, rows = new_figure(2, 1, size=(9.0, 10.6))
    width, matches = upper_bgr.shape[1], localization.matches
    labels = [localization.upper_detections[match.upper].label for match in matches]
    lines = [f"{n:2d} {label:12} {matches[n - 1].n_matches:3d}" for n, label in enumerate(labels, start=1)]
    for axes, image, side in zip(rows, (upper_bgr, lower_bgr), ("Upper", "Lower"), strict=True):
        faded = cv2.addWeighted(image, 0.6, np.full_like(image, 255), 0.4, 0)  # what is drawn on it stands out
        panorama(axes, faded, f"{side} camera: {len(matches)} matched objects, dots are AKAZE features")
    add_list(figure, lines, 4, "number, class, matched features", labels)
    for axes, side in zip(rows, ("upper", "lower"), strict=True):
        detections = getattr(localization, f"{side}_detections")
        for match, label in zip(matches, labels, strict=True):
            keypoints = getattr(match, f"keypoints_{side}")
            axes.plot(keypoints[:, 0] % width, keypoints[:, 1], ".", color=class_style(label)[0], markersize=2.5)
        draw_objects(axes, [detections[getattr(match, side)].box for match in matches], labels, width)
    return figure


def map_axes(axes: Axes, semantic_map: SemanticMap, title: str) -> None:
    """The semantic map from above: walls, and a marker of its class for every landmark."""
    if semantic_map.walls is not None:
        corners = np.vstack([semantic_map.walls, semantic_map.walls[:1]])
        axes.plot(corners[:, 0], corners[:, 1], color=BLACK, linewidth=2.0)
    for label in dict.fromkeys(semantic_map.labels):
        colour, marker = class_style(label)
        positions = semantic_map.positions[[one == label for one in semantic_map.labels]]
        axes.plot(*positions.T, linestyle="none", marker=marker, color=colour, markersize=9, label=label)
    axes.set(title=title, xlabel="x [m]", ylabel="y [m]", aspect="equal")


def draw_pose(axes: Axes, x: float, y: float, theta: float, colour: str, label: str | None = None) -> None:
    """A pose as a dot and an arrow half a metre long."""
    axes.plot(x, y, "o", color=colour, markersize=6, label=label, zorder=5)
    end, arrow = (x + 0.5 * np.cos(theta), y + 0.5 * np.sin(theta)), {"arrowstyle": "-|>", "linewidth": 1.6}
    axes.annotate("", end, (x, y), arrowprops=arrow | {"color": colour}, zorder=5)


def pose_figure(semantic_map: SemanticMap, result, title: str) -> Figure:
    """One pose on the map, true and estimated: rays to the objects used, and from each to what it was taken for."""
    figure, axes = new_figure(size=(7.6, 6.2))
    draw_pose(axes, *result.pair.pose, BLACK, "true pose")
    if result.localization.pose is not None:
        _draw_estimate(axes, semantic_map, result)
    map_axes(axes, semantic_map, title)
    _legend_beside(axes)
    return figure


def experiment_figure(semantic_map: SemanticMap, results: Sequence, title: str) -> Figure:
    """All poses of an experiment on the map: a line joins each true place to its estimate."""
    figure, axes = new_figure(size=(7.6, 6.2))
    map_axes(axes, semantic_map, title)
    named: set[str] = set()
    for result in results:
        (x, y, theta), pose, kind = result.pair.pose, result.localization.pose, result.outcome.kind
        draw_pose(axes, x, y, theta, BLACK, None if "true" in named else "true pose")
        named.add("true")
        if pose is None:
            continue
        colour = BLUE if kind == CORRECT else VERMILION
        axes.plot([x, pose.x], [y, pose.y], color=colour, linestyle="-" if kind == CORRECT else "--", linewidth=1.2)
        draw_pose(axes, *pose, colour, None if kind in named else f"estimate, {kind}")
        named.add(kind)
    _legend_beside(axes)
    return figure


def _draw_estimate(axes: Axes, semantic_map: SemanticMap, result) -> None:
    found, pose = result.localization, result.localization.pose
    draw_pose(axes, *pose, ESTIMATE, "estimated pose")
    points = pose.apply(np.array([[one.x, one.y] for one in found.observations]))
    named: set[bool] = set()
    for observation, landmark in found.used_pairs:
        right = result.true_landmarks[observation] == landmark != NO_OBJECT
        ray = np.stack([pose[:2], points[observation]])
        axes.plot(*ray.T, color="0.75", linewidth=0.8, zorder=1, label=None if named else "object used")
        # From where the object was measured to the landmark it was taken for: two that were swapped cross.
        ends = np.stack([points[observation], semantic_map.positions[landmark]]).T
        label = None if right in named else f"taken for, {'right' if right else 'wrong'}ly"
        colour, line = (GREEN, "-") if right else (VERMILION, "--")
        axes.plot(*ends, color=colour, linestyle=line, linewidth=1.1, label=label)
        named.add(right)
    for point, one in zip(points, found.observations, strict=True):
        axes.plot(*point, "x", color=class_style(one.label)[0], markersize=7, markeredgewidth=1.6)
    axes.plot([], [], "x", color="0.4", markersize=7, label="object as measured, in its class's colour")


def _legend_beside(axes: Axes) -> None:
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8)


def location_figure(
    images: Sequence[np.ndarray], semantic_map: SemanticMap, found: Localization, lines: Sequence[str], title: str
) -> Figure:
    """Draw both panoramas with numbered boxes, and below them the map.

    images: upper and lower, `(H, W, 3)` BGR. lines: one for each of `found.objects`, for the list of numbers. A
    pose that was rejected is drawn dashed.
    """
    figure, rows = new_figure(3, 1, size=(13.0, 14.5))
    labels = [one.label for one in found.objects]
    _draw_location(rows[2], semantic_map, found, title)
    _legend_beside(rows[2])
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


def _draw_location(axes: Axes, semantic_map: SemanticMap, found: Localization, title: str) -> None:
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
        axes.plot(pose.x + DEVIATIONS * ring[0], pose.y + DEVIATIONS * ring[1], color=colour, linewidth=1.2)
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


def ambiguity_figure(semantic_map: SemanticMap, found: AmbiguityMap, title: str = "Ambiguity") -> Figure:
    """The room from above: dark squares where the right pose is not sure, dashed lines between objects confused."""
    figure, axes = new_figure(size=(6.4, 5.2))
    squares = draw_ambiguity(axes, semantic_map, found, title)
    figure.colorbar(squares, ax=axes, label="doubt about the right pose (0: sure)", shrink=0.85)
    axes.legend(loc="upper left", bbox_to_anchor=(0.0, -0.12), ncols=4, fontsize=8)
    return figure


def draw_ambiguity(axes: Axes, semantic_map: SemanticMap, found: AmbiguityMap, title: str) -> PathCollection:
    """`ambiguity_figure` on axes that are there; returns the squares, for a colour bar."""
    map_axes(axes, semantic_map, title)
    squares = {"marker": "s", "s": (found.step * 46) ** 2, "zorder": 0}
    squares = axes.scatter(*found.places.T, c=1.0 - found.confidence, cmap="cividis_r", vmin=0.0, vmax=1.0, **squares)
    for i, j, share in found.most_confused(CONFUSIONS_DRAWN):
        if share >= MIN_SHARE:
            (x1, y1), (x2, y2) = semantic_map.positions[[i, j]]
            axes.plot([x1, x2], [y1, y2], "--", color=VERMILION, linewidth=0.8 + 5.0 * min(share, 0.6))
            at = x1 + LABEL_AT * (x2 - x1), y1 + LABEL_AT * (y2 - y1)
            ground = {"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 1.5}  # readable on dark squares
            axes.text(*at, f"{100 * share:.0f} %", color=VERMILION, fontsize=9, ha="center", va="center", bbox=ground)
    return squares
