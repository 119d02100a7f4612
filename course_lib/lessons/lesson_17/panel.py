"""Lesson 17's panel: hide objects from the camera and judge the pose."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from course_lib.experiments.room_evaluation import UNABLE
from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Choice, Drawing, Panel, Slider
from course_lib.lessons.kit.room_photographs import room_map, room_recording
from course_lib.lessons.lesson_17.experiments import EXPERIMENTS, exact_results
from course_lib.lessons.lesson_17.room_causes import Thinned, is_matched_rightly, thinned
from course_lib.plots import figures
from course_lib.plots.room_figures import ESTIMATE, map_axes
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

MAX_MISSED = 12  # objects that the panel can hide; 11 to 14 are measured in a pose
_ARROW = 0.45  # metres


def judge_panel() -> Panel:
    """One pose from exact boxes: hide some of its objects, and see its pairs, its pose and its kind change."""
    room = room_map()
    for experiment in EXPERIMENTS:
        exact_results(experiment)  # now, so that no slider waits for them
    figure, axes = figures.new_figure(size=(7.6, 5.0))
    map_axes(axes, room, "True and estimated pose; lines: what each object was taken for")
    true = _pose_lines(axes, figures.BLACK, "true pose")
    found = _pose_lines(axes, ESTIMATE, "estimated pose")
    (right,) = axes.plot([], [], color=figures.GREEN, linewidth=1.6, label="taken for the right one")
    (wrong,) = axes.plot([], [], color=figures.VERMILION, linewidth=1.6, linestyle="--", label="taken for a wrong one")
    (measured,) = axes.plot([], [], "x", color="0.35", markersize=7, label="object as measured")
    (rings,) = axes.plot([], [], "o", color="0.35", markersize=13, markerfacecolor="none", label="hidden object")
    axes.set(xlim=(-1.0, 6.4), ylim=(-1.1, 6.1))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8, frameon=False)
    live = LiveFigure(figure, [right, wrong, measured, rings, *true, *found])

    def draw(experiment: str, pose: float, missed: float, choice: float) -> Drawing:
        result = exact_results(int(experiment))[int(pose) - 1]
        total = len(result.localization.observations)
        hidden = np.random.default_rng(int(choice)).permutation(total)[: int(missed)]
        keep = np.setdiff1d(np.arange(total), hidden)
        localizer = SemanticLocalizer(room_recording(int(experiment)).rig, room, reject_implausible=False)
        one = thinned(result, keep, localizer)
        _set_pose(true, one.true_pose)
        _set_pose(found, one.found.pose)
        ends, is_right = _pair_ends(one, room)
        for line, chosen in ((right, is_right), (wrong, ~is_right)):
            line.set_data(*_broken(ends[chosen]))
        rings.set_data(*room.positions[[result.true_landmarks[index] for index in hidden]].T)
        measured.set_data(*(ends[:, 0].T if len(ends) else ([], [])))
        text = _judgement(one, room, total)
        alt = f"Pose {result.pair.name} of experiment {experiment} on the map, {len(hidden)} objects hidden. {text[0]}"
        return Drawing(live.png(), alt, f"{result.pair.name}: " + "\n".join(text))

    controls = [
        Choice("experiment", "experiment", tuple(map(str, EXPERIMENTS)), "1"),
        Slider("pose", "pose (of 20) [-]", 1, 20, 3, 1),
        Slider("missed", "objects hidden [-]", 0, MAX_MISSED, 2, 1),
        Slider("choice", "which ones (seed) [-]", 1, 30, 5, 1),
    ]
    return Panel("17 hide some objects", controls, draw)


def _pose_lines(axes: Axes, colour: str, label: str) -> list:
    """A dot and a line of `_ARROW` metres: a pose that can be moved."""
    (dot,) = axes.plot([], [], "o", color=colour, markersize=8, label=label)
    (line,) = axes.plot([], [], color=colour, linewidth=2.2)
    return [line, dot]


def _set_pose(lines: list, pose: Sequence[float] | None) -> None:
    line, dot = lines
    if pose is None:
        line.set_data([], [])
        dot.set_data([], [])
        return
    x, y, theta = pose
    dot.set_data([x], [y])
    line.set_data([x, x + _ARROW * np.cos(theta)], [y, y + _ARROW * np.sin(theta)])


def _pair_ends(one: Thinned, room: SemanticMap) -> tuple[np.ndarray, np.ndarray]:
    """Where each used object was measured and the landmark it was taken for `(n, 2, 2)`, and which are right `(n,)`."""
    if one.found.pose is None:
        return np.empty((0, 2, 2)), np.empty(0, bool)
    places = one.found.pose.apply(np.array([[o.x, o.y] for o in one.found.observations]))
    pairs = one.found.used_pairs
    ends = np.array([(places[i], room.positions[j]) for i, j in pairs])
    return ends, np.array([one.true_landmarks[i] == j for i, j in pairs])


def _broken(ends: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Lines `(n, 2, 2)` as one curve with gaps between them."""
    gaps = np.full((len(ends), 1, 2), np.nan)
    return tuple(np.concatenate([ends, gaps], axis=1).reshape(-1, 2).T)


def _judgement(one: Thinned, room: SemanticMap, total: int) -> list[str]:
    """Kind, errors, and whether a true centroid would have mended the matching; two lines."""
    seen = len(one.true_landmarks)
    if one.outcome.kind == UNABLE:
        return [f"unable; {seen} of {total} objects seen", "two pairs at least are needed for a pose"]
    wrong = sum(one.true_landmarks[i] != j for i, j in one.found.used_pairs)
    kind, dx, dy, dtheta = one.outcome
    mended = is_matched_rightly(one.found.observations, one.true_landmarks, one.true_pose, room, "true centroid")
    with_centroid = "every pair right" if mended else "wrong pairs still"
    return [
        f"{kind}; {seen} of {total} objects seen, {wrong} wrong pairs",
        f"dx {dx:.1f} m, dy {dy:.1f} m, dtheta {dtheta:.0f} degrees; with a true centroid: {with_centroid}",
    ]


PANELS = {"17 hide some objects": judge_panel}
