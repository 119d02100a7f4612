"""Figures of paper 2: detections on a panorama, matched pairs on both, and the room from above."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from course_lib.experiments.room_evaluation import CORRECT, NO_OBJECT
from course_lib.plots.figures import BLACK, BLUE, GREEN, VERMILION, new_figure
from course_lib.plots.panorama_drawing import add_list, class_style, draw_box, draw_numbers, panorama
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

ESTIMATE = "#7B2D8E"
"""Colour of an estimated pose: a dark violet, which no class of objects has (`class_style`)."""


def detections_figure(image_bgr: np.ndarray, detections: Sequence, title: str = "Detected objects") -> Figure:
    """Every detection on its panorama, numbered; below, its class, score, and hue (or that it is grey)."""
    figure, axes = new_figure(size=(10.0, 6.6))
    panorama(axes, image_bgr, f"{title}: {len(detections)}")
    labels = [one.label for one in detections]
    hues = ["grey" if one.is_grey else f"{one.hue:3.0f}°" for one in detections]
    lines = [f"{n:2d} {one.label:12} {one.score:.2f} {hues[n - 1]}" for n, one in enumerate(detections, start=1)]
    add_list(figure, lines, 4, "number, class, score, hue", labels)
    for one in detections:
        draw_box(axes, one.box, image_bgr.shape[1], one.label)
    draw_numbers(axes, [one.box for one in detections], labels, image_bgr.shape[1])
    return figure


def matches_figure(upper_bgr: np.ndarray, lower_bgr: np.ndarray, localization) -> Figure:
    """Both panoramas with the objects seen in both: one number an object, and its matched features."""
    figure, rows = new_figure(2, 1, size=(9.0, 10.6))
    width = upper_bgr.shape[1]
    matches = localization.matches
    labels = [localization.upper_detections[match.upper].label for match in matches]
    lines = [f"{n:2d} {label:12} {matches[n - 1].n_matches:3d}" for n, label in enumerate(labels, start=1)]
    for axes, image, side in zip(rows, (upper_bgr, lower_bgr), ("Upper", "Lower"), strict=True):
        panorama(axes, _faded(image), f"{side} camera: {len(matches)} matched objects, dots are AKAZE features")
    add_list(figure, lines, 4, "number, class, matched features", labels)
    for axes, side in zip(rows, ("upper", "lower"), strict=True):
        detections = getattr(localization, f"{side}_detections")
        boxes = [detections[getattr(match, side)].box for match in matches]
        for match, box, label in zip(matches, boxes, labels, strict=True):
            keypoints = getattr(match, f"keypoints_{side}")
            draw_box(axes, box, width, label)
            axes.plot(keypoints[:, 0] % width, keypoints[:, 1], ".", color=class_style(label)[0], markersize=2.5)
        draw_numbers(axes, boxes, labels, width)
    return figure


def map_axes(axes: Axes, semantic_map: SemanticMap, title: str) -> None:
    """The semantic map from above: walls, and a marker of its class for every landmark."""
    if semantic_map.walls is not None:
        corners = np.vstack([semantic_map.walls, semantic_map.walls[:1]])
        axes.plot(corners[:, 0], corners[:, 1], color=BLACK, linewidth=2.0)
    for label in dict.fromkeys(semantic_map.labels):
        colour, marker = class_style(label)
        positions = np.array(
            [place for place, its in zip(semantic_map.positions, semantic_map.labels, strict=True) if its == label]
        )
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
    _draw_result(axes, semantic_map, result)
    map_axes(axes, semantic_map, title)
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8)
    return figure


def experiment_figure(semantic_map: SemanticMap, results: Sequence, title: str) -> Figure:
    """All poses of an experiment on the map: a line joins each true place to its estimate."""
    figure, axes = new_figure(size=(7.6, 6.2))
    map_axes(axes, semantic_map, title)
    named: set[str] = set()
    for result in results:
        x, y, theta = result.pair.pose
        draw_pose(axes, x, y, theta, BLACK, None if "true" in named else "true pose")
        named.add("true")
        if result.localization.pose is None:
            continue
        pose = result.localization.pose
        kind = result.outcome.kind
        colour = BLUE if kind == CORRECT else VERMILION
        axes.plot([x, pose.x], [y, pose.y], color=colour, linestyle="-" if kind == CORRECT else "--", linewidth=1.2)
        draw_pose(axes, pose.x, pose.y, pose.theta, colour, None if kind in named else f"estimate, {kind}")
        named.add(kind)
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8)
    return figure


def _draw_result(axes: Axes, semantic_map: SemanticMap, result) -> None:
    draw_pose(axes, *result.pair.pose, BLACK, "true pose")
    found = result.localization
    if found.pose is None:
        return
    draw_pose(axes, found.pose.x, found.pose.y, found.pose.theta, ESTIMATE, "estimated pose")
    points = found.pose.apply(np.array([[one.x, one.y] for one in found.observations]))
    named: set[bool] = set()
    for observation, landmark in found.used_pairs:
        right = result.true_landmarks[observation] == landmark != NO_OBJECT
        ray = np.stack([(found.pose.x, found.pose.y), points[observation]])
        axes.plot(*ray.T, color="0.75", linewidth=0.8, zorder=1, label=None if named else "object used")
        # From where the object was measured to the landmark it was taken for: two that were swapped cross.
        ends = np.stack([points[observation], semantic_map.positions[landmark]]).T
        label = None if right in named else f"taken for, {'right' if right else 'wrong'}ly"
        colour, line = (GREEN, "-") if right else (VERMILION, "--")
        axes.plot(*ends, color=colour, linestyle=line, linewidth=1.1, label=label)
        named.add(right)
    for point, observation in zip(points, found.observations, strict=True):
        axes.plot(*point, "x", color=class_style(observation.label)[0], markersize=7, markeredgewidth=1.6)
    axes.plot([], [], "x", color="0.4", markersize=7, label="object as measured, in its class's colour")


def _faded(image_bgr: np.ndarray) -> np.ndarray:
    """The picture lighter, so that what is drawn on it stands out."""
    return cv2.addWeighted(image_bgr, 0.6, np.full_like(image_bgr, 255), 0.4, 0)
