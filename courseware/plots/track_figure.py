"""A localized recording: its path over the map's floor plan, and the score of every frame, lost stretches marked."""

from collections.abc import Sequence
from itertools import groupby

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from course_lib.depth_mcl.status import TrackStatus
from course_lib.rendering.scene_map import SceneMap
from courseware.plots.corridor_figures import plane_cut
from courseware.plots.figures import BLUE, ORANGE, VERMILION, new_figure

_MARGIN = 2.0  # metres that are drawn around the paths (chosen: what a room's walls need)
_MIN_SHAPE = 0.5  # of the plan: its shorter side over its longer one (chosen)
_STYLES = {
    "tracked": {"color": BLUE, "marker": "o", "markersize": 3},
    "doubtful": {"color": ORANGE, "marker": "s", "markersize": 4},
    "lost": {"color": VERMILION, "marker": "x", "markersize": 5},
    "no measurement": {"color": "0.4", "marker": ".", "markersize": 4},
}


def track_figure(
    scene_map: SceneMap,
    frames: Sequence[int],
    estimated: np.ndarray,
    scores: np.ndarray,
    statuses: Sequence[TrackStatus],
    up: str | None,
    true: np.ndarray | None = None,
) -> Figure:
    """The path over a cut through the map, and the raw score of every frame.

    estimated, true: positions `(T, 3)` in the map's own world, metres. scores: `(T,)`, NaN where nothing was measured.
    up: the axis that points up; None: unknown: cut across the axis along which the camera moved least.
    """
    figure, (plan, score) = new_figure(1, 2, size=(11.0, 4.4))
    paths = estimated if true is None else np.concatenate([estimated, true])
    across = int(np.ptp(paths, axis=0).argmin()) if up is None else "xyz".index(up[-1])
    _draw_plan(plan, scene_map, paths, across)
    shown = [axis for axis in range(3) if axis != across]
    if true is not None:
        plan.plot(*true[:, shown].T, color="black", linewidth=1.1, label="truth")
    plan.plot(*estimated[:, shown].T, color="0.5", linewidth=0.6, zorder=2)
    _draw_statuses(plan, estimated[:, shown].T, statuses)
    plan.plot(*estimated[0, shown], marker="*", markersize=11, color="black", linestyle="none", label="first frame")
    unknown = ", up unknown" if up is None else ""
    plan.set(title=f"Estimated path, map cut at {'xyz'[across]} = {np.median(paths[:, across]):.2f} m{unknown}")
    plan.set(xlabel=f"{'xyz'[shown[0]]} [m]", ylabel=f"{'xyz'[shown[1]]} [m]")
    plan.legend(fontsize=8, framealpha=0.9, loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=3)
    score.plot(frames, scores, color="0.5", linewidth=0.6)
    _draw_statuses(score, np.stack([frames, scores]), statuses)
    for status, group in groupby(range(len(frames)), key=lambda index: statuses[index]):
        if status == "lost":
            indices = list(group)
            score.axvspan(frames[indices[0]] - 0.5, frames[indices[-1]] + 0.5, color=VERMILION, alpha=0.12, hatch="//")
    score.set(title="Raw score of every frame (1: image and map agree)", ylim=(0.0, 1.0))
    score.set(xlabel="frame [-]", ylabel="score of the best particle [-]")
    return figure


def _draw_plan(axes: Axes, scene_map: SceneMap, paths: np.ndarray, across: int) -> None:
    """The map's walls where a plane cuts them, at the median of the paths, and the view around the paths."""
    walls = plane_cut(scene_map.vertices, scene_map.faces, across, np.median(paths[:, across]))
    axes.add_collection(LineCollection(walls, colors="0.65", linewidths=0.8, label="map"))
    seen = np.delete(paths, across, axis=1)
    low, high = seen.min(axis=0) - _MARGIN, seen.max(axis=0) + _MARGIN
    # The shorter side grows, or a path along a corridor would be drawn as a thread.
    grow = np.maximum(0, 0.5 * ((high - low).max() * _MIN_SHAPE - (high - low)))
    (left, bottom), (right, top) = low - grow, high + grow
    axes.set(xlim=(left, right), ylim=(bottom, top), aspect="equal")


def _draw_statuses(axes: Axes, points: np.ndarray, statuses: Sequence[TrackStatus]) -> None:
    """Points `(2, T)`, marked by status."""
    for status, style in _STYLES.items():
        chosen = np.array([s == status for s in statuses])
        if chosen.any():
            axes.plot(*points[:, chosen], linestyle="none", label=f"{status}: {chosen.sum()} frames", **style)
