"""Figures of lesson 17: the places, which poses fail, rates over the share of objects seen; and its panel."""

from collections.abc import Sequence

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from course_lib.spherical_stereo.localizer import SemanticLocalizer
from courseware.experiments.room_evaluation import KINDS, PAPER_TABLE_5, UNABLE
from courseware.lessons.kit.display import described
from courseware.lessons.kit.live_figure import LiveFigure
from courseware.lessons.kit.panel import Choice, Drawing, Panel, Slider
from courseware.lessons.kit.room_data import room_map, room_recording
from courseware.lessons.lesson_17.room_runs import StoredRoom, exact_results, is_matched_rightly, thinned
from courseware.plots import figures
from courseware.plots.room_figures import ESTIMATE, draw_pose, map_axes
from courseware.simulation.room.measurement_places import MEASUREMENT_PLACES


def places_figure() -> Figure:
    """Draw the room from above: the map's objects, and table 1's places with their headings."""
    figure, axes = figures.new_figure(size=(7.2, 5.2))
    map_axes(axes, room_map(), "The map, and the ten places of table 1")
    for p in MEASUREMENT_PLACES:
        for heading in np.radians(p.headings_deg):
            draw_pose(axes, p.x, p.y, float(heading), figures.BLACK)
        axes.annotate(str(p.place), (p.x, p.y), xytext=(7, 6), textcoords="offset points", fontsize=8)
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8, frameon=False)
    alt = "A room of six by six metres from above with fourteen objects and ten numbered places, two arrows at each."
    return described(figure, alt)


def outcomes_figure(runs: Sequence[StoredRoom]) -> Figure:
    """Draw every stored seed and experiment (rows) against the 20 poses from images (columns)."""
    rows = [(experiment, run) for experiment in (1, 2) for run in runs]
    names = [pair.name for pair in room_recording(1).pairs]
    figure, axes = figures.new_figure(size=(8.6, 1.5 + 0.22 * len(rows)))
    kinds = [[run.outcomes(experiment, "images")[name] for name in names] for experiment, run in rows]
    looks = ((figures.BLUE, "."), (figures.VERMILION, "X"), (figures.BLACK, "_"))
    for kind, (colour, marker) in zip(KINDS, looks, strict=True):
        row, column = np.nonzero(np.array(kinds) == kind)
        axes.plot(column, row, linestyle="none", marker=marker, color=colour, markersize=9, label=kind)
    axes.set_xticks(range(len(names)), names, rotation=90, fontsize=8)
    axes.set_yticks(range(len(rows)), [f"experiment {e}, seed {run.seed}" for e, run in rows], fontsize=8)
    axes.set(title="Which poses fail", xlabel="pose (place of table 1, heading a or b)")
    axes.set(ylim=(len(rows) - 0.5, -0.5))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    alt = "A grid of runs and poses: dots where the pose was correct, crosses where it was incorrect."
    return described(figure, alt)


def rates_figure(shares: Sequence[float], percent: dict[str, list[float]], error_m: Sequence[float]) -> Figure:
    """Draw the rates of table 5 over the share of objects seen, and the errors of the incorrect poses."""
    figure, (left, right) = figures.new_figure(1, 2, size=(9.4, 3.2))
    for index, kind in enumerate(KINDS):
        style = figures.line_style(index)
        left.plot(shares, percent[kind], **style, label=kind)
        left.axhline(PAPER_TABLE_5[1][f"{kind}_percent"], color=style["color"], linestyle=":", linewidth=1.0)
    right.plot(shares, error_m, **figures.line_style(3))
    seen = "share of the objects that are seen, q [-]"
    left.set(title="Rates (dotted: the paper's)", xlabel=seen, ylabel="poses [%]", ylim=(0, 102))
    right.set(title="Position error of the incorrect poses", xlabel=seen, ylabel="mean error [m]", ylim=(0, None))
    left.legend(loc="upper center", bbox_to_anchor=(0.45, 1.0), fontsize=8)
    alt = "Left, rates: poses become unable where less than 0.4 of the objects are seen. Right: errors of metres there."
    return described(figure, alt)


CONTROLS = [
    Choice("experiment", "experiment", ("1", "2"), "1"),
    Slider("pose", "pose (of 20)", 1, 20, 3, 1),
    Slider("missed", "objects hidden", 0, 12, 2, 1),  # 11 to 14 are measured in a pose
    Slider("choice", "which ones (seed)", 1, 30, 5, 1),
]


def judge_panel() -> Panel:
    """Show one pose from exact boxes: hide some of its objects, and see its pairs, its pose and its kind change."""
    room, localizer = room_map(), SemanticLocalizer(room_recording(1).rig, room_map(), reject_implausible=False)
    figure, axes = figures.new_figure(size=(7.6, 5.0))
    map_axes(axes, room, "Lines show what each object was taken for")
    looks = ((figures.BLACK, "true pose"), (ESTIMATE, "estimated pose"))
    style = {"marker": "o", "markersize": 8, "linewidth": 2.2, "markevery": [0]}
    poses = [axes.plot([], [], color=colour, label=name, **style)[0] for colour, name in looks]
    looks = (("-", figures.GREEN, "taken for the right one"), ("--", figures.VERMILION, "taken for a wrong one"))
    matches = [LineCollection([], linestyles=dash, colors=colour, label=name, lw=1.6) for dash, colour, name in looks]
    for lines in matches:
        axes.add_collection(lines)
    (measured,) = axes.plot([], [], "x", color="0.35", markersize=7, label="object as measured")
    (rings,) = axes.plot([], [], "o", color="0.35", markersize=13, markerfacecolor="none", label="hidden object")
    axes.set(xlim=(-1.0, 6.4), ylim=(-1.1, 6.1))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8, frameon=False)
    live = LiveFigure(figure, [*matches, measured, rings, *poses])

    def draw(experiment: str, pose: float, missed: float, choice: float) -> Drawing:
        result = exact_results(int(experiment))[int(pose) - 1]
        total, shown = len(result.true_landmarks), np.array(result.true_landmarks)
        hidden, seen = np.split(np.random.default_rng(int(choice)).permutation(total), [int(missed)])
        one = thinned(result, np.sort(seen), localizer)
        found, (kind, dx, dy, dtheta) = one.localization, one.outcome
        for line, its_pose in zip(poses, (one.pair.pose, found.pose), strict=True):
            x, y, theta = (np.nan, np.nan, np.nan) if its_pose is None else its_pose
            line.set_data([x, x + 0.45 * np.cos(theta)], [y, y + 0.45 * np.sin(theta)])
        used = [] if found.pose is None else found.used_pairs
        pairs = [(one.true_landmarks[i] == j, found.pose.apply([found.observations[i][1:3]])[0], j) for i, j in used]
        for lines, wanted in zip(matches, (True, False), strict=True):
            lines.set_segments([(place, room.positions[j]) for right, place, j in pairs if right == wanted])
        measured.set_data(*np.reshape([place for _, place, _ in pairs], (-1, 2)).T)
        rings.set_data(*room.positions[shown[hidden]].T)
        text = f"{kind}; {len(seen)} of {total} objects seen"
        more = "a pose needs at least two pairs"
        if kind != UNABLE:
            text += f", {sum(not right for right, *_ in pairs)} wrong pairs"
            mended = "every pair is right" if is_matched_rightly(one, "true centroid") else "wrong pairs remain"
            more = f"dx {dx:.1f} m, dy {dy:.1f} m, dtheta {dtheta:.0f} degrees; with a true centroid {mended}"
        alt = f"Pose {result.pair.name} of experiment {experiment} on the map, {len(hidden)} objects hidden. {text}"
        return Drawing(live.png(), alt, f"{result.pair.name}: {text}\n{more}")

    return Panel("17 hide some objects", CONTROLS, draw)


PANELS = {"17 hide some objects": judge_panel}
