"""Figures of lesson 18: by colour or by geometry, every pose of two matches, ellipses, risk, where there is doubt."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse

from course_lib.beyond.look_alikes.confidence import MIN_CONFIDENCE
from course_lib.beyond.look_alikes.evidence import NOISE_FACTOR
from course_lib.beyond.look_alikes.hypotheses import MAP_SIGMA, PoseHypothesis, Scene, seen_from
from course_lib.experiments.ambiguity import AmbiguityMap
from course_lib.lessons.kit.room_observations import MatchingScene
from course_lib.plots import figures
from course_lib.plots.panorama_drawing import class_style
from course_lib.plots.room_figures import draw_ambiguity, draw_pose, map_axes
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

SIGMAS = 2.0
"""Standard deviations at which every ellipse of this lesson is drawn, but for that of a pose (`POSE_SIGMAS`)."""
POSE_SIGMAS = 3.0
_SHOWN = {"xlim": (-1.9, 6.4), "ylim": (-1.9, 6.5)}
"""Of the shipped room: metres beyond its walls, for what a wrong pose lays there; an ellipse may be cut."""


def ellipse_of(centre: np.ndarray, covariance: np.ndarray, sigmas: float = SIGMAS) -> dict:
    """xy, width, height and angle (degrees) of the curve on which (p - centre)^T C^-1 (p - centre) = sigmas^2."""
    variances, axes = np.linalg.eigh(covariance)
    width, height = 2 * sigmas * np.sqrt(np.maximum(variances, 0))
    return {
        "xy": tuple(map(float, centre)),
        "width": float(width),
        "height": float(height),
        "angle": float(np.degrees(np.arctan2(axes[1, 0], axes[0, 0]))),
    }


def laid_on_the_map(scene: Scene, pose: Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
    """Places `(n, 2)` of the observations as seen from a pose, and their covariances `(n, 2, 2)`, map frame."""
    places, _, spread = seen_from(np.array(pose, dtype=np.float64)[None], scene.places[None], scene.covariances[None])
    return places[0], NOISE_FACTOR**2 * spread[0] + MAP_SIGMA**2 * np.eye(2)


def matches_axes(
    axes: Axes,
    title: str,
    seen: tuple[MatchingScene, Scene],
    pose: Sequence[float],
    pairs: Sequence[tuple[int, int]],
    bold: Sequence[int] = (),
) -> None:
    """The map, the observations as a pose lays them on it with their ellipses, and a line from each to its landmark.

    Green: the right landmark; vermilion and dashed: a wrong one. bold: observations that the pose was made of.
    """
    scene, arrays = seen
    map_axes(axes, arrays.semantic_map, title)
    places, spread = laid_on_the_map(arrays, pose)
    for i, j in pairs:
        right = scene.true_landmarks[i] == j
        ends = np.stack([places[i], arrays.semantic_map.positions[j]])
        colour, style = (figures.GREEN, "-") if right else (figures.VERMILION, "--")
        axes.plot(*ends.T, style, color=colour, linewidth=1.8, zorder=4)
    for i, (place, covariance) in enumerate(zip(places, spread, strict=True)):
        colour = class_style(scene.observations[i].label)[0]
        axes.add_patch(
            Ellipse(**ellipse_of(place, covariance), fill=False, edgecolor=colour, linewidth=3.2 if i in bold else 1.1)
        )
        axes.plot(*place, "x", color=colour, markersize=7, markeredgewidth=1.7, zorder=5)
    draw_true_pose(axes, scene.pose)
    draw_pose(axes, *pose, figures.BLACK)
    axes.set(**_SHOWN)


def draw_true_pose(axes: Axes, pose: Sequence[float]) -> None:
    """A ring, so that a pose that is right is seen inside it, and a thin line ahead."""
    x, y, theta = pose
    axes.plot(x, y, "o", mfc="none", mec=figures.BLACK, markersize=14, markeredgewidth=1.5, zorder=5)
    axes.plot([x, x + 0.7 * np.cos(theta)], [y, y + 0.7 * np.sin(theta)], color="0.4", linewidth=1.0, zorder=4)


def _name_lines(figure: Figure, axes: Axes, extra: Sequence[tuple] = (), columns: int = 4) -> None:
    """Legend below: what lines, crosses and dots mean. extra: (marker or line, colour, name)."""
    entries = [
        ("-", figures.GREEN, "taken for the right landmark"),
        ("--", figures.VERMILION, "for a wrong one"),
        ("x", "0.3", f"object as seen from the pose, {SIGMAS:.0f}-sigma ellipse"),
        ("ring", figures.BLACK, "true pose"),
        ("o", figures.BLACK, "pose tried"),
        *extra,
    ]
    for style, colour, name in entries:
        look = {"x": {"marker": "x"}, "o": {"marker": "o"}, "ring": {"marker": "o", "mfc": "none", "markersize": 11}}
        look = {"linestyle": "none", **look[style]} if style in look else {"linestyle": style}
        axes.plot([], [], color=colour, label=name, **look)
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=columns, fontsize=8, frameon=False)


def two_ways_figure(
    seen: tuple[MatchingScene, Scene],
    by_colour: tuple[Sequence[float], Sequence[tuple[int, int]]],
    by_two: tuple[Sequence[float], Sequence[tuple[int, int]], Sequence[int]],
) -> Figure:
    """Left: matched by class and colour, then fitted. Right: two matches make a pose, and the others follow."""
    figure, (left, right) = figures.new_figure(1, 2, size=(10.0, 5.4))
    matches_axes(left, "By class and colour first, then the pose", seen, *by_colour)
    matches_axes(right, "Two matches (thick) make a pose: see the others", seen, *by_two)
    _name_lines(figure, right)
    figure.get_layout_engine().set(h_pad=0.1)  # else the titles touch the edge
    return figure


def matches_figure(seen: tuple[MatchingScene, Scene], found: dict[str, PoseHypothesis]) -> Figure:
    """Poses of one scene side by side, title -> pose, each with its matches and every object's ellipse."""
    figure, axes = figures.new_figure(1, len(found), size=(10.0, 5.4))
    for one, (title, hypothesis) in zip(axes, found.items(), strict=True):
        matches_axes(one, title, seen, hypothesis.pose, hypothesis.pairs)
    _name_lines(figure, axes[-1])
    figure.get_layout_engine().set(h_pad=0.1)
    return figure


def hypotheses_figure(semantic_map: SemanticMap, poses: np.ndarray, true_pose: Sequence[float]) -> Figure:
    """Every pose of two matches as an arrow on the map; most are nowhere, and some are together."""
    figure, axes = figures.new_figure(size=(7.4, 5.6))
    map_axes(axes, semantic_map, f"The poses of {len(poses)} pairs of matches")
    arrows = (*poses[:, :2].T, np.cos(poses[:, 2]), np.sin(poses[:, 2]))
    axes.quiver(*arrows, angles="xy", scale_units="xy", scale=2.2, width=0.004, color=figures.BLUE, alpha=0.7, zorder=3)
    axes.plot([], [], marker=">", linestyle="none", color=figures.BLUE, label="pose of two matches")
    axes.set(xlim=(-3.2, 8.6), ylim=(-3.2, 8.2))
    draw_true_pose(axes, true_pose)
    axes.plot([], [], "o", mfc="none", mec=figures.BLACK, markersize=11, label="true pose")
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8, frameon=False)
    return figure


def risk_figure(curves: dict[str, dict[str, list[float]]], dots: dict[str, tuple[float, float]]) -> Figure:
    """Share of the answers that are wrong over the share answered, and over the threshold; a line a name.

    curves: of `risk_coverage`. dots: coverage and risk of each at the library's threshold, percent.
    """
    figure, (over_coverage, over_threshold) = figures.new_figure(1, 2, size=(10.0, 3.9))
    for index, (name, curve) in enumerate(curves.items()):
        line = figures.line_style(index) | {"marker": ""}
        dot = figures.line_style(index) | {"linestyle": "none", "markersize": 9}
        risk = curve["risk_percent"]
        over_coverage.step(curve["coverage_percent"], risk, where="post", label=name, **line)
        over_coverage.plot(*dots[name], **dot, label=f"{name}, at {MIN_CONFIDENCE:g}")
        over_threshold.step(curve["threshold"], risk, where="pre", label=name, **line)
        over_threshold.plot(MIN_CONFIDENCE, dots[name][1], **dot)
    for axes, title in ((over_coverage, "Risk over coverage"), (over_threshold, "Risk over the threshold")):
        axes.set(title=title, ylabel="wrong, of the answers [%]", ylim=(-2, 60))
    over_coverage.set(xlabel="poses answered [%]", xlim=(0, 101))
    over_threshold.set(xlabel="threshold on the confidence [-]", xlim=(0, 1.01))
    over_coverage.legend(loc="upper left", fontsize=8)
    return figure


def ambiguities_figure(
    semantic_maps: Sequence[SemanticMap], found: Sequence[AmbiguityMap], titles: list[str]
) -> Figure:
    """Ambiguity maps side by side: dark where the right pose is not sure, dashed lines between objects confused."""
    figure, axes = figures.new_figure(1, len(found), size=(10.4, 4.7))
    for one, semantic_map, ambiguity, title in zip(axes, semantic_maps, found, titles, strict=True):
        squares = draw_ambiguity(one, semantic_map, ambiguity, title)
    figure.colorbar(squares, ax=axes, label="doubt about the right pose [-], 0: sure", shrink=0.8)
    handles, labels = axes[-1].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels), fontsize=8, frameon=False)
    return figure


def two_places_figure(
    semantic_maps: Sequence[SemanticMap],
    beliefs: Sequence[Sequence[tuple[Pose2D, float]]],
    true_poses: np.ndarray,
    titles: Sequence[str],
) -> Figure:
    """What is believed after each view: every pose that has a share, written beside it, and the true one."""
    figure, axes = figures.new_figure(1, len(beliefs), size=(10.4, 4.1))
    for one, semantic_map, belief, truth, title in zip(axes, semantic_maps, beliefs, true_poses, titles, strict=True):
        map_axes(one, semantic_map, title)
        draw_true_pose(one, truth)
        for pose, share in belief:
            if share > 0.01:
                draw_pose(one, *pose, figures.BLACK)
                one.annotate(f"{share:.0%}", pose[:2], (10, -13), textcoords="offset points", fontsize=10)
    axes[-1].plot([], [], "o", color=figures.BLACK, label="pose believed, and its share")
    axes[-1].plot([], [], "o", mfc="none", mec=figures.BLACK, markersize=11, label="true pose")
    handles, labels = axes[-1].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels), fontsize=8, frameon=False)
    return figure


def few_seen_figure(seen: tuple[MatchingScene, Scene], pose: Sequence[float], covariance: np.ndarray, pairs) -> Figure:
    """Few objects, all matched rightly; the pose, and the ellipse in which its covariance expects the true one."""
    figure, axes = figures.new_figure(size=(7.4, 6.4))
    matches_axes(axes, "Four objects, four right matches", seen, pose, pairs)
    axes.add_patch(
        Ellipse(**ellipse_of(pose[:2], covariance[:2, :2], POSE_SIGMAS), fill=False, edgecolor=figures.BLACK, lw=2.0)
    )
    _name_lines(figure, axes, [("-", figures.BLACK, f"{POSE_SIGMAS:.0f}-sigma ellipse of the pose")], 3)
    return figure
