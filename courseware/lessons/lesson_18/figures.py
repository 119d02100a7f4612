"""Figures of lesson 18: by colour or by geometry, every pose of two matches, ellipses, risk, where there is doubt.

The docstring of a public figure is its alternative text.
"""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse

from course_lib.beyond.look_alikes.confidence import MIN_CONFIDENCE
from course_lib.beyond.look_alikes.evidence import NOISE_FACTOR
from course_lib.beyond.look_alikes.hypotheses import MAP_SIGMA, PoseHypothesis, Scene, scene_of, seen_from
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap
from courseware.experiments.ambiguity import AmbiguityMap
from courseware.lessons.kit.display import described
from courseware.lessons.kit.room_data import MatchingScene, room_map
from courseware.plots import figures
from courseware.plots.panorama_drawing import class_style
from courseware.plots.room_figures import draw_ambiguity, draw_pose, map_axes

SIGMAS = 2.0
"""Standard deviations at which every ellipse of this lesson is drawn, but for that of a pose, which has three."""
DOUBTED = "The room", "Two equal ends", "The same with a plant"
RING = {"marker": "o", "mfc": "none", "mec": figures.BLACK, "markersize": 11}


def draw_ellipse(axes: Axes, centre: np.ndarray, covariance: np.ndarray, sigmas: float, **style) -> None:
    """Draw the curve on which (p - centre)^T C^-1 (p - centre) = sigmas^2."""
    variances, ways = np.linalg.eigh(covariance)
    size, angle = 2 * sigmas * np.sqrt(np.maximum(variances, 0)), np.degrees(np.arctan2(ways[1, 0], ways[0, 0]))
    axes.add_patch(Ellipse(centre, *size, angle=angle, fill=False, **style))


def laid_on_the_map(scene: Scene, pose: Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
    """Return places `(n, 2)` of the observations as seen from a pose, and their covariances `(n, 2, 2)`, map frame."""
    places, _, spread = seen_from(np.array(pose, dtype=np.float64)[None], scene.places[None], scene.covariances[None])
    return places[0], NOISE_FACTOR**2 * spread[0] + MAP_SIGMA**2 * np.eye(2)


def draw_matches(axes: Axes, title: str, scene: MatchingScene, pose: Sequence, pairs: Sequence, bold: Sequence = ()):
    """Draw the map, the observations as a pose lays them on it, and a line from each to its landmark.

    A line to the right landmark is green, and to a wrong one vermilion and dashed. bold: observations that the pose was
    made of.
    """
    map_axes(axes, room_map(), title)
    places, spread = laid_on_the_map(scene_of(scene.observations, room_map()), pose)
    for i, j in pairs:
        colour, style = (figures.GREEN, "-") if scene.true_landmarks[i] == j else (figures.VERMILION, "--")
        axes.plot(*np.stack([places[i], room_map().positions[j]]).T, style, color=colour, linewidth=1.8, zorder=4)
    for i, (place, covariance) in enumerate(zip(places, spread, strict=True)):
        colour = class_style(scene.observations[i].label)[0]
        draw_ellipse(axes, place, covariance, SIGMAS, edgecolor=colour, linewidth=3.2 if i in bold else 1.1)
        axes.plot(*place, "x", color=colour, markersize=7, markeredgewidth=1.7, zorder=5)
    draw_true_pose(axes, scene.pose)
    draw_pose(axes, *pose, figures.BLACK)
    axes.set(xlim=(-1.9, 6.4), ylim=(-1.9, 6.5))  # beyond the walls, for what a wrong pose lays there


def draw_true_pose(axes: Axes, pose: Sequence[float]) -> None:
    """Draw a ring, so that a pose that is right is seen inside it, and a thin line ahead."""
    x, y, theta = pose
    axes.plot(x, y, **(RING | {"markersize": 14}), markeredgewidth=1.5, zorder=5)
    axes.plot([x, x + 0.7 * np.cos(theta)], [y, y + 0.7 * np.sin(theta)], color="0.4", linewidth=1.0, zorder=4)


def legend_below(figure: Figure, axes: Axes, entries: dict[str, dict], columns: int = 9) -> None:
    """Name below the figure what is drawn on its axes, and `entries`: name -> style."""
    for name, style in entries.items():
        axes.plot([], [], **({"linestyle": "none"} | style), label=name)
    handles, labels = axes.get_legend_handles_labels()
    place = {"loc": "outside lower center", "ncols": min(columns, len(labels))}
    figure.legend(handles, labels, **place, fontsize=8, frameon=False)


MATCHES = {
    "taken for the right landmark": {"linestyle": "-", "color": figures.GREEN},
    "for a wrong one": {"linestyle": "--", "color": figures.VERMILION},
    f"object as seen from the pose, {SIGMAS:.0f}-sigma ellipse": {"marker": "x", "color": "0.3"},
    "true pose": RING,
    "pose tried": {"marker": "o", "color": figures.BLACK},
}


def two_ways_figure(scene: MatchingScene, *found: tuple) -> Figure:
    """Two plans of the room. Left: matched by colour, each sofa is taken for another one and the pose is beside the
    true one. Right: from the pose of two right matches every other object lies near its own landmark.
    """
    figure, axes = figures.new_figure(1, 2, size=(10.0, 5.4))
    titles = "By class and colour first, then the pose", "Two matches (thick) make a pose: see the others"
    for one, title, what in zip(axes, titles, found, strict=True):
        draw_matches(one, title, scene, *what)
    legend_below(figure, axes[-1], MATCHES, 4)
    figure.get_layout_engine().set(h_pad=0.1)  # else the titles touch the edge
    return described(figure, two_ways_figure.__doc__)


def hypotheses_figure(poses: np.ndarray, true_pose: Sequence[float]) -> Figure:
    """The room from above with more than two hundred small arrows scattered in and around it; a dense bundle of them
    lies at the true pose.
    """
    figure, axes = figures.new_figure(size=(7.4, 5.6))
    map_axes(axes, room_map(), f"The poses of {len(poses)} pairs of matches")
    arrows = (*poses[:, :2].T, np.cos(poses[:, 2]), np.sin(poses[:, 2]))
    axes.quiver(*arrows, angles="xy", scale_units="xy", scale=2.2, width=0.004, color=figures.BLUE, alpha=0.7, zorder=3)
    axes.plot([], [], marker=">", linestyle="none", color=figures.BLUE, label="pose of two matches")
    draw_true_pose(axes, true_pose)
    axes.plot([], [], linestyle="none", **RING, label="true pose")
    axes.set(xlim=(-3.2, 8.6), ylim=(-3.2, 8.2))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8, frameon=False)
    return described(figure, hypotheses_figure.__doc__)


def at_threshold(curve: dict[str, list[float]], threshold: float = MIN_CONFIDENCE) -> tuple[float, float]:
    """Return coverage and risk, percent, of a `risk_coverage` curve at a threshold; (0, 0) if nothing is that sure."""
    found = [(0.0, 0.0), *zip(curve["coverage_percent"], curve["risk_percent"], strict=True)]
    return found[sum(value >= threshold for value in curve["threshold"])]


def risk_figure(curves: dict[str, dict[str, list[float]]]) -> Figure:
    """Left, two curves of wrong answers over answered poses, nearly the same: 0 until almost half are answered, then
    rising to 50 percent. Right, over the threshold: with the gap alone the risk is 20 percent and more at most
    thresholds, with everything it is 0 above 0.5.
    """
    figure, (over_coverage, over_threshold) = figures.new_figure(1, 2, size=(10.0, 3.9))
    for index, (name, curve) in enumerate(curves.items()):
        line = figures.line_style(index) | {"marker": ""}
        dot = figures.line_style(index) | {"linestyle": "none", "markersize": 9}
        coverage, risk = at_threshold(curve)
        over_coverage.step(curve["coverage_percent"], curve["risk_percent"], where="post", label=name, **line)
        over_coverage.plot(coverage, risk, **dot, label=f"{name}, at {MIN_CONFIDENCE:g}")
        over_threshold.step(curve["threshold"], curve["risk_percent"], where="pre", label=name, **line)
        over_threshold.plot(MIN_CONFIDENCE, risk, **dot)
    y = {"ylabel": "wrong, of the answers [%]", "ylim": (-2, 60)}
    over_coverage.set(title="Risk over coverage", xlabel="poses answered [%]", xlim=(0, 101), **y)
    over_threshold.set(title="Risk over the threshold", xlabel="threshold on the confidence [-]", xlim=(0, 1.01), **y)
    over_coverage.legend(loc="upper left", fontsize=8)
    return described(figure, risk_figure.__doc__)


def doubt_figure(rooms: Sequence[SemanticMap], found: Sequence[AmbiguityMap]) -> Figure:
    """Three plans in squares. Nearly all squares of the room are light. In the symmetric room all are dark and equal
    objects are joined by dashed lines; with a plant in it most are light, and the lines are faint.
    """
    figure, axes = figures.new_figure(1, 3, size=(10.8, 4.1))
    for one, semantic_map, ambiguity, title in zip(axes, rooms, found, DOUBTED, strict=True):
        squares = draw_ambiguity(one, semantic_map, ambiguity, title)
    figure.colorbar(squares, ax=axes, label="doubt [-]", shrink=0.8)
    legend_below(figure, axes[0], {})
    return described(figure, doubt_figure.__doc__)


def beliefs_figure(semantic_map: SemanticMap, beliefs: Sequence[Sequence[tuple]], true_poses: np.ndarray) -> Figure:
    """Three plans of the symmetric room with a plant. After the first two views two poses, half a turn apart, share the
    belief; after the third, which shows the plant, only the true one is left.
    """
    figure, axes = figures.new_figure(1, 3, size=(10.4, 4.1))
    titles = ("After the first view", "the second", "the third")
    for one, belief, truth, title in zip(axes, beliefs, true_poses, titles, strict=True):
        map_axes(one, semantic_map, title)
        draw_true_pose(one, truth)
        for pose, share in belief:
            if share > 0.01:
                draw_pose(one, *pose, figures.BLACK)
                one.annotate(f"{share:.0%}", pose[:2], (10, -13), textcoords="offset points", fontsize=10)
    believed = {"marker": "o", "color": figures.BLACK}
    legend_below(figure, axes[-1], {"pose believed, and its share": believed, "true pose": RING})
    return described(figure, beliefs_figure.__doc__)


def few_seen_figure(scene: MatchingScene, found: PoseHypothesis) -> Figure:
    """Four objects with lines to the right landmarks; the pose lies a quarter of a metre from the true one, which is
    inside the three-sigma ellipse of the pose.
    """
    figure, axes = figures.new_figure(size=(7.4, 6.4))
    draw_matches(axes, "Four objects, four right matches", scene, found.pose, found.pairs)
    draw_ellipse(axes, found.pose[:2], found.covariance[:2, :2], 3.0, edgecolor=figures.BLACK, lw=2.0)
    of_pose = {"3-sigma ellipse of the pose": {"linestyle": "-", "color": figures.BLACK}}
    legend_below(figure, axes, MATCHES | of_pose, 3)
    return described(figure, few_seen_figure.__doc__)
