"""Figures of paper 2: detections on a panorama, matched pairs on both, and the room from above."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from course_lib.lessons.figures import BLACK, BLUE, GREEN, ORANGE, VERMILION, new_figure
from course_lib.spherical_stereo.evaluation import CORRECT, NO_OBJECT
from course_lib.spherical_stereo.semantic_map import SemanticMap

# Okabe and Ito's colours and a letter each, so that no class is told by colour alone.
CLASS_STYLES = {
    "sofa": ("#D55E00", "s"),
    "chair": ("#0072B2", "^"),
    "table": ("#009E73", "D"),
    "television": ("#CC79A7", "P"),
    "potted plant": ("#E69F00", "*"),
    "refrigerator": ("#56B4E9", "X"),
    "cabinet": ("#000000", "o"),
}
_OTHER = ("#666666", "h")


def class_style(label: str) -> tuple[str, str]:
    """Colour and marker of a class; grey hexagons for classes that the course's detector does not know."""
    return CLASS_STYLES.get(label, _OTHER)


def panorama(axes: Axes, image_bgr: np.ndarray, title: str) -> None:
    """Draw a panorama `(H, W, 3)` uint8 BGR in edge coordinates, with azimuth written along the top."""
    height, width = image_bgr.shape[:2]
    axes.imshow(image_bgr[..., ::-1], extent=(0, width, height, 0), interpolation="antialiased")
    axes.grid(False)
    axes.set(title=title, xlabel="column u [pixels]", ylabel="row v [pixels]", xlim=(0, width), ylim=(height, 0))
    above = axes.secondary_xaxis("top", functions=(lambda u: 180 - 360 * u / width, lambda a: (180 - a) * width / 360))
    above.set_xticks([180, 90, 0, -90, -180])
    above.set_xlabel("azimuth [degrees]", fontsize=8)


def draw_box(axes: Axes, box: Sequence[float], width: int, label: str, text: str | None = None) -> None:
    """One box on a panorama, on both sides where it crosses the seam, in its class's colour."""
    u_min, v_min, u_max, v_max = box
    colour, _ = class_style(label)
    for turn in (0, -width) if u_max > width else (0,):
        axes.add_patch(
            Rectangle((u_min + turn, v_min), u_max - u_min, v_max - v_min, fill=False, edgecolor=colour, linewidth=1.6)
        )
        if text and u_min + turn >= 0:
            axes.text(
                u_min + turn,
                v_min - 4,
                text,
                color="white",
                fontsize=6.5,
                bbox={"facecolor": colour, "edgecolor": "none", "pad": 0.8},
                clip_on=True,
            )


def detections_figure(image_bgr: np.ndarray, detections: Sequence, title: str = "Detected objects") -> Figure:
    """Every detection on its panorama: box, class, score, and hue (or that it is grey)."""
    figure, axes = new_figure(size=(10.0, 5.6))
    panorama(axes, image_bgr, f"{title}: {len(detections)}, with score and hue H")
    for one in detections:
        hue = "grey" if one.is_grey else f"H {one.hue:.0f}°"
        draw_box(axes, one.box, image_bgr.shape[1], one.label, f"{one.label} {one.score:.2f} {hue}")
    return figure


def matches_figure(upper_bgr: np.ndarray, lower_bgr: np.ndarray, localization) -> Figure:
    """Both panoramas with the objects seen in both: one number an object, and its matched features."""
    figure, (above, below) = new_figure(2, 1, size=(9.0, 9.6))
    width = upper_bgr.shape[1]
    for axes, image, name in ((above, upper_bgr, "Upper camera"), (below, lower_bgr, "Lower camera")):
        panorama(axes, _faded(image), f"{name}: {len(localization.matches)} matched objects, dots are AKAZE features")
    for number, match in enumerate(localization.matches):
        for axes, detections, index, keypoints in (
            (above, localization.upper_detections, match.upper, match.keypoints_upper),
            (below, localization.lower_detections, match.lower, match.keypoints_lower),
        ):
            one = detections[index]
            draw_box(axes, one.box, width, one.label, f"{number}: {one.label}, {match.n_matches}")
            axes.plot(keypoints[:, 0] % width, keypoints[:, 1], ".", color=class_style(one.label)[0], markersize=2.5)
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
    axes.annotate(
        "",
        (x + 0.5 * np.cos(theta), y + 0.5 * np.sin(theta)),
        (x, y),
        arrowprops={"arrowstyle": "-|>", "color": colour, "linewidth": 1.6},
        zorder=5,
    )


def pose_figure(semantic_map: SemanticMap, result, title: str) -> Figure:
    """One pose on the map: true and estimated, lines to the objects used, crosses where they were measured."""
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
    x, y, theta = result.pair.pose
    draw_pose(axes, x, y, theta, BLACK, "true pose")
    found = result.localization
    if found.pose is None:
        return
    draw_pose(axes, found.pose.x, found.pose.y, found.pose.theta, ORANGE, "estimated pose")
    points = found.pose.apply(np.array([[one.x, one.y] for one in found.observations]))
    named: set[bool] = set()
    for observation, landmark in found.used_pairs:
        right = result.true_landmarks[observation] == landmark != NO_OBJECT
        axes.plot(
            *zip((found.pose.x, found.pose.y), semantic_map.positions[landmark], strict=True),
            color=GREEN if right else VERMILION,
            linestyle="-" if right else "--",
            linewidth=1.0,
            label=None if right in named else ("right pair" if right else "wrong pair"),
        )
        named.add(right)
    axes.plot(*points.T, "x", color=ORANGE, markersize=7, label="objects as measured, put on the map")


def _faded(image_bgr: np.ndarray) -> np.ndarray:
    """The picture lighter, so that what is drawn on it stands out."""
    return cv2.addWeighted(image_bgr, 0.6, np.full_like(image_bgr, 255), 0.4, 0)
