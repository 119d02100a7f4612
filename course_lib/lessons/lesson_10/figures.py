"""Figures of lesson 10: the hotel from above, scores and errors over time, free space, KLD-sampling, alarms."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator

from course_lib.beyond.lost_and_found.adaptive_count import kld_count
from course_lib.beyond.lost_and_found.global_search import PoseCandidates
from course_lib.lessons.lesson_10.hotel import ALIKE, Recording, boxes_on_the_plan
from course_lib.lessons.lesson_10.narrowing import Round, shares
from course_lib.lessons.lesson_10.trials import GOALS, Trace, alarm_counts, evidence_near
from course_lib.plots import figures

_NAMES = {"101": (1.2, 2.75), "102": (5.2, 2.75), "103": (10.7, 2.1), "corridor": (5.35, 1.2)}


def draw_hotel(axes: Axes, title: str) -> None:
    """The map from above: walls dark, what stands in the rooms light, with the rooms' numbers."""
    for colour, boxes in zip(("0.35", "0.86"), boxes_on_the_plan(), strict=True):
        for (x0, y0, _), (x1, y1, _) in boxes:
            axes.add_patch(Rectangle((x0, y0), x1 - x0, y1 - y0, facecolor=colour, edgecolor="0.5", linewidth=0.4))
    around = [withStroke(linewidth=3, foreground="white")]  # particles may lie under a name
    for name, (x, y) in _NAMES.items():
        axes.text(x, y, name, fontsize=8, color="0.25", ha="center", va="center", zorder=6, path_effects=around)
    axes.set(xlim=(-0.2, 12.2), ylim=(-0.2, 5.9), aspect="equal", title=title, xlabel="x [m]", ylabel="y [m]")
    axes.grid(False)


def draw_poses(axes: Axes, states: np.ndarray, colour: str, label: str, every: int = 1) -> None:
    """States `(N, 6)` from above: dots with a short line in the direction of view."""
    shown = states[::every]
    ahead = shown[:, :2] + 0.3 * np.column_stack([np.cos(shown[:, 5]), np.sin(shown[:, 5])])
    axes.plot(shown[:, 0], shown[:, 1], "o", color=colour, markersize=4, label=label)
    for a, b in zip(shown[:, :2], ahead, strict=True):
        axes.plot([a[0], b[0]], [a[1], b[1]], color=colour, linewidth=1.3)


def hotel_figure(recording: Recording, uncovered: int) -> Figure:
    """The hotel, and a camera that is carried away: its walk before and after."""
    figure, axes = figures.new_figure(size=(8.4, 4.3))
    draw_hotel(axes, "A hotel floor from above, and a kidnapping")
    draw_poses(axes, recording.states[:uncovered], figures.BLUE, "before")
    draw_poses(axes, recording.states[uncovered:], figures.VERMILION, "after, seen again", every=2)
    start, end = recording.states[uncovered - 1, :2], recording.states[uncovered, :2]
    arrow = {"arrowstyle": "->", "linestyle": "--", "color": "black", "connectionstyle": "arc3,rad=-0.25", "lw": 1.5}
    axes.annotate("", end, start, arrowprops=arrow | {"shrinkA": 5, "shrinkB": 5})
    axes.plot([], [], color="black", linestyle="--", label="carried, covered")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=3, frameon=False)
    return figure


def carried_figure(errors: np.ndarray, scores: np.ndarray, weights: np.ndarray, uncovered: int) -> Figure:
    """Error, raw score and greatest weight over the frames of runs `(runs, T)`; the kidnapping is a line."""
    figure, axes = figures.new_figure(1, 3, size=(10.2, 2.9))
    for a, rows, title, label in zip(
        axes,
        (errors, scores, weights),
        ("How far off it is", "Raw score of the best particle", "Weight of the best particle"),
        ("distance from the truth [m]", "raw score [-]", "weight [-]"),
        strict=True,
    ):
        for k, row in enumerate(rows):
            a.plot(row, **(figures.line_style(k) | {"markersize": 3, "linewidth": 1.1}), label=f"run {k + 1}")
        a.axvline(uncovered - 0.5, color="black", linestyle=":", linewidth=1.2)
        a.set(title=title, xlabel="frame [-]", ylabel=label, ylim=(0, None))
    axes[2].set_ylim(0, 1.05)
    axes[0].legend(loc="center left", fontsize=8)
    return figure


def free_space_figure(tried: np.ndarray, free: np.ndarray) -> Figure:
    """Places `(N, 3)` drawn in the map's box, from above and from the front; free ones are dots, others crosses."""
    figure, axes = figures.new_figure(size=(8.4, 4.2))
    draw_hotel(axes, "Where can a camera be? (from above; all heights)")
    axes.plot(*tried[~free, :2].T, "x", color=figures.VERMILION, markersize=3.5, mew=0.8, label="no camera can be here")
    axes.plot(*tried[free, :2].T, ".", color=figures.BLUE, markersize=4, label="free")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=2, frameon=False)
    return figure


def first_scores_figure(states: np.ndarray, scores: np.ndarray, true: np.ndarray) -> Figure:
    """Particles `(N, 6)` from above, coloured by score; the best thirty as arrows."""
    figure, axes = figures.new_figure(size=(8.4, 4.8))
    draw_hotel(axes, "One frame, particles anywhere: who sees what the camera sees?")
    order = np.argsort(scores)
    dots = axes.scatter(*states[order, :2].T, c=scores[order], s=7, cmap="cividis", linewidths=0)
    draw_poses(axes, states[order[-20:]], figures.VERMILION, "the 20 best")
    draw_camera(axes, true)
    figure.colorbar(dots, ax=axes, label="score of a coarse image [-]", shrink=0.8)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=3, frameon=False)
    return figure


def draw_camera(axes: Axes, true: np.ndarray) -> None:
    """The camera, and its double next door."""
    axes.plot(*true[:2], "*", color="white", mec="black", markersize=15, label="camera")
    axes.plot(*(true + np.r_[ALIKE, 0, 0, 0])[:2], "D", color="none", mec="black", markersize=9, label="its double")


def kld_figure(rounds: Sequence[Round]) -> Figure:
    """Left: particles against bins, for three errors; right: bins and particles over the frames of a run."""
    figure, (left, right) = figures.new_figure(1, 2, size=(9.6, 3.2))
    bins = np.unique(np.geomspace(2, 1000, 60).astype(int))
    for k, error in enumerate((0.02, 0.05, 0.2)):
        n = [kld_count(int(b), 1, 10**7, error) for b in bins]
        left.loglog(bins, n, **(figures.line_style(k) | {"marker": ""}), label=f"error {error} nats")
    left.set(title="How many particles?", xlabel="occupied bins k [-]", ylabel="particles n [-]")
    left.legend(fontsize=8)
    frames = np.arange(len(rounds))
    counts = [len(one.particles) for one in rounds]
    right.semilogy(frames, counts, **(figures.line_style(0) | {"markersize": 4}), label="particles n")
    bins_style = figures.line_style(1) | {"markersize": 4}
    right.semilogy(frames, [one.bins for one in rounds], **bins_style, label="bins k")
    right.set(title="As the search narrows", xlabel="frame [-]", ylabel="number [-]")
    right.legend(fontsize=8)
    return figure


def chance_figure(runs: Sequence[list[Round]]) -> Figure:
    """Weight near the camera's true place over the frames of several runs."""
    figure, axes = figures.new_figure(size=(7.6, 2.9))
    for k, rounds in enumerate(runs):
        axes.plot(shares(rounds)[0], **(figures.line_style(k) | {"markersize": 3.5}), label=f"run {k + 1}")
    axes.set(
        title="Weight of the particles in the right room", xlabel="frame [-]", ylabel="weight [-]", xlim=(-0.3, 9.3)
    )
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8)
    return figure


def evidence_figure(run: Sequence[PoseCandidates]) -> Figure:
    """Evidence of the true place and of its double over the frames, and what the search says."""
    figure, (top, axes) = figures.new_figure(2, 1, size=(8.4, 4.2))
    top.get_gridspec().set_height_ratios([0.5, 1.0])
    levels = {"searching": 0, "several": 1, "found": 2}
    top.plot([levels[places.status] for places in run], "s", color=figures.BLACK, markersize=5)
    top.set_yticks(list(levels.values()), list(levels))
    top.set(title="What the search says", ylabel="status [-]", xlabel="frame [-]", ylim=(-0.5, 2.5))
    for k, (offset, name) in enumerate(((np.zeros(3), "at the camera (101)"), (ALIKE, "at its double (102)"))):
        axes.plot(evidence_near(list(run), offset), **(figures.line_style(k) | {"markersize": 4}), label=name)
    axes.set(title="Evidence of the two places", xlabel="frame [-]", ylabel="evidence [-]")
    axes.legend(loc="lower left", fontsize=8)
    return figure


def trade_off_figure(ratios: np.ndarray) -> tuple[Figure, list[tuple[float, float, float, list[int | None]]]]:
    """False alarms, and how late kidnappings are noticed, for ratios of the alarm; and the rows drawn: ratio, false
    alarms [%] by the score alone and with the second condition, delays [frames] of the three kidnappings."""
    figure, (left, right) = figures.new_figure(1, 2, size=(9.4, 3.0))
    alone, both = ([alarm_counts(float(c), cannot_be_right=asked) for c in ratios] for asked in (False, True))
    for k, (name, counts) in enumerate((("the score alone", alone), ("and the pose cannot be right", both))):
        left.plot(ratios, [false for false, _ in counts], **(figures.line_style(k) | {"markersize": 4}), label=name)
    for k, goal in enumerate(GOALS):
        late = [np.nan if delays[k] is None else delays[k] for _, delays in both]
        right.plot(ratios, late, **(figures.line_style(k + 2) | {"markersize": 4}), label=f"kidnapped {goal}")
    left.set(title="Frames in peace with an alarm", xlabel="ratio c [-]", ylabel="false alarms [%]")
    right.set(title="How late the alarm comes (no dot: never)", xlabel="ratio c [-]", ylabel="delay [frames]")
    right.set(xlim=left.get_xlim(), ylim=(-0.3, 4.2))
    left.legend(fontsize=8)
    right.legend(fontsize=8)
    return figure, [(float(c), one[0], two[0], two[1]) for c, one, two in zip(ratios, alone, both, strict=True)]


def trace_axes(axes: Axes, trace: Trace) -> None:
    """The raw score of a trace, and when the person and the kidnapping came."""
    axes.plot(trace.scores, ".", color="0.45", markersize=5, label="raw score")
    axes.axvspan(trace.person.start - 0.5, trace.person.stop - 0.5, color=figures.YELLOW, alpha=0.3, label="person")
    axes.axvline(trace.kidnapped - 0.5, color="black", linestyle=":", linewidth=1.4, label="kidnapped")


def told_figure(errors: np.ndarray, statuses: Sequence[str], title: str, happened: int, what: str) -> Figure:
    """Error over the frames, marked by what the filter says of itself."""
    figure, axes = figures.new_figure(size=(8.0, 2.8))
    axes.plot(errors, color="0.7", linewidth=1.0, zorder=1)
    for k, status in enumerate(("tracked", "doubtful", "lost", "searching")):
        style = figures.line_style((0, 1, 3, 4)[k]) | {"linestyle": "none", "markersize": 7}
        chosen = [frame for frame, one in enumerate(statuses) if one == status]
        axes.plot(chosen, errors[chosen], **style, label=f"it says: {status}")
    axes.axvline(happened - 0.5, color="black", linestyle=":", linewidth=1.4, label=what)
    axes.set(title=title, xlabel="frame [-]", ylabel="distance from the truth [m]", ylim=(-0.3, None))
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8)
    return figure
