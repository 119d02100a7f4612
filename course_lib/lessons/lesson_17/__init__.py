"""Lesson 17, the room experiment: its places, which poses fail, and a panel that hides objects from the camera."""

from __future__ import annotations

import functools
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from course_lib.experiments.paper_tables import PAPER_TABLE_5
from course_lib.experiments.room import PairResult, run_experiment
from course_lib.experiments.room_evaluation import CORRECT, INCORRECT, UNABLE
from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Choice, Drawing, Panel, Slider
from course_lib.lessons.kit.paths import data_path
from course_lib.lessons.lesson_17.room_causes import Thinned, is_matched_rightly, thinned
from course_lib.lessons.lesson_17.room_runs import (
    StoredRoom,
    errors,
    rates,
    stored_rooms,
    table_3_or_4,
    table_5,
    used_pairs,
)
from course_lib.plots import figures
from course_lib.plots.room_figures import draw_pose, map_axes
from course_lib.simulation.room.measurement_places import MEASUREMENT_PLACES
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.recording import StereoRecording, read_stereo_recording
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

__all__ = [
    "errors",
    "rates",
    "stored_rooms",
    "table_3_or_4",
    "table_5",
    "used_pairs",
]  # for the notebook: read and print the seeds

EXPERIMENTS = (1, 2)
KINDS = (CORRECT, INCORRECT, UNABLE)
MOST_MISSED = 12  # objects that the panel can hide; 11 to 14 are measured in a pose
_LOOKS = {CORRECT: (figures.BLUE, "."), INCORRECT: (figures.VERMILION, "X"), UNABLE: (figures.BLACK, "_")}
_ARROW = 0.45  # metres


@functools.cache
def semantic_map() -> SemanticMap:
    """The map of the room."""
    return SemanticMap.load(data_path("room/semantic_map.json"))


@functools.cache
def recording(experiment: int) -> StereoRecording:
    """The 20 pairs of panoramas of experiment 1 or 2."""
    return read_stereo_recording(data_path(f"room/experiment_{experiment}"))


@functools.cache
def exact_results(experiment: int) -> tuple[PairResult, ...]:
    """All 20 poses from exact boxes; kept, since figure and panel ask again."""
    recorded = recording(experiment)
    return tuple(
        run_experiment(
            recorded, SemanticLocalizer(recorded.rig, semantic_map(), reject_implausible=False), "exact_boxes"
        )
    )


def table_1() -> str:
    """The paper's ten places, two headings at each, two places a line."""
    cells = [
        f"{p.place:2d}: ({p.x:.2f}, {p.y:.2f}) m {p.headings_deg[0]:4.0f}, {p.headings_deg[1]:4.0f} deg"
        for p in MEASUREMENT_PLACES
    ]
    return "\n".join(f"{left}   {right}" for left, right in zip(cells[:5], cells[5:], strict=True))


def places_figure() -> Figure:
    """The room from above: the map's objects, and table 1's places with their headings."""
    figure, axes = figures.new_figure(size=(7.2, 5.2))
    map_axes(axes, semantic_map(), "The room of the experiment: the map, and table 1's ten places")
    for p in MEASUREMENT_PLACES:
        for heading in np.radians(p.headings_deg):
            draw_pose(axes, p.x, p.y, float(heading), figures.BLACK)
        axes.annotate(str(p.place), (p.x, p.y), xytext=(7, 6), textcoords="offset points", fontsize=8)
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8, frameon=False)
    return figure


def outcomes_figure(runs: Sequence[StoredRoom], source: str) -> Figure:
    """Every stored seed and experiment (rows) against the 20 poses (columns): correct, incorrect or unable."""
    rows = [(experiment, run) for experiment in EXPERIMENTS for run in runs]
    names = [pair.name for pair in recording(1).pairs]
    figure, axes = figures.new_figure(size=(8.6, 1.5 + 0.22 * len(rows)))
    for kind, (colour, marker) in _LOOKS.items():
        spots = [
            (names.index(place), row)
            for row, (experiment, run) in enumerate(rows)
            for place, found in run.outcomes(experiment, source).items()
            if found == kind
        ]
        style = {"linestyle": "none", "marker": marker, "color": colour, "markersize": 9}
        axes.plot(*(np.array(spots).reshape(-1, 2).T), **style, label=kind)
    axes.set_xticks(range(len(names)), names, rotation=90, fontsize=8)
    axes.set_yticks(range(len(rows)), [f"experiment {e}, seed {run.seed}" for e, run in rows], fontsize=8)
    axes.set(title="Which poses fail", xlabel="pose: place of table 1 and heading a or b [-]", ylabel="run [-]")
    axes.set(ylim=(len(rows) - 0.5, -0.5))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return figure


def failing_places(runs: Sequence[StoredRoom], experiment: int, source: str) -> dict[str, int]:
    """Pose -> in how many seeds it was not correct, the most often first; poses that never failed are left out."""
    counts: dict[str, int] = {}
    for run in runs:
        for place, found in run.outcomes(experiment, source).items():
            counts[place] = counts.get(place, 0) + (found != CORRECT)
    return {place: n for place, n in sorted(counts.items(), key=lambda item: (-item[1], item[0])) if n}


def live_places(runs: Sequence[StoredRoom], experiment: int, most: int = 2) -> list[str]:
    """Poses to run from images: of the shipped photographs first those that failed when stored, then any others."""
    shipped = [run for run in runs if run.seed == recording(experiment).seed] or list(runs[:1])
    failing = failing_places(shipped, experiment, "images")
    others = [pair.name for pair in recording(experiment).pairs if pair.name not in failing]
    return [*failing, *others][:most]


def nearest_5(percent: float) -> str:
    """A percentage to the nearest five, so that one pose more or less does not change what is printed."""
    return f"{5 * round(percent / 5)} %"


def rates_figure(shares: Sequence[float], percent: dict[str, list[float]], error_m: Sequence[float]) -> Figure:
    """Rates of correct, incorrect and unable over the share of objects seen, and the incorrect poses' errors."""
    figure, (left, right) = figures.new_figure(1, 2, size=(9.4, 3.2))
    for index, kind in enumerate(KINDS):
        style = figures.line_style(index)
        left.plot(shares, percent[kind], **style, label=kind)
        left.axhline(PAPER_TABLE_5[1][f"{kind}_percent"], color=style["color"], linestyle=":", linewidth=1.0)
    left.set(
        title="Rates (dotted: the paper's)", xlabel="share of the objects that are seen, q [-]", ylabel="poses [%]"
    )
    left.legend(loc="upper center", bbox_to_anchor=(0.45, 1.0), fontsize=8)
    left.set(ylim=(0, 102))
    right.plot(shares, error_m, **figures.line_style(3))
    right.set(title="Position error of the incorrect poses", xlabel="share of the objects that are seen, q [-]")
    right.set(ylabel="mean error [m]", ylim=(0, None))
    return figure


def judge_panel() -> Panel:
    """One pose from exact boxes: hide some of its objects, and see its pairs, its pose and its kind change."""
    room = semantic_map()
    for experiment in EXPERIMENTS:
        exact_results(experiment)  # now, so that no slider waits for them
    figure, axes = figures.new_figure(size=(7.6, 5.0))
    map_axes(axes, room, "True and estimated pose; lines: what each object was taken for")
    true = _pose_lines(axes, figures.BLACK, "true pose")
    found = _pose_lines(axes, figures.ORANGE, "estimated pose")
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
        localizer = SemanticLocalizer(recording(int(experiment)).rig, room, reject_implausible=False)
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
        Slider("missed", "objects hidden [-]", 0, MOST_MISSED, 2, 1),
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
    return [
        f"{kind}; {seen} of {total} objects seen, {wrong} wrong pairs",
        f"dx {dx:.1f} m, dy {dy:.1f} m, dtheta {dtheta:.0f} degrees; with a true centroid all pairs right: {mended}",
    ]


PANELS = {"17 hide some objects": judge_panel}
