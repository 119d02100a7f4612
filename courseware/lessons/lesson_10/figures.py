"""Figures of lesson 10: the hotel from above, scores and errors over time, free space, KLD-sampling, alarms."""

from collections.abc import Sequence

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator

from course_lib.beyond.lost_and_found.global_search import PoseCandidates
from courseware.lessons.kit.display import described
from courseware.lessons.lesson_10.adaptive_count import kld_count
from courseware.lessons.lesson_10.hotel_floor import ALIKE, FURNITURE, WALLS, Recording, leaving_101
from courseware.lessons.lesson_10.narrowing import Round
from courseware.lessons.lesson_10.trials import GOALS, KIDNAPPED, alarms, traces
from courseware.plots.figures import BLACK, BLUE, VERMILION, line_style, new_figure

NAMES = {"101": (1.2, 2.75), "102": (5.2, 2.75), "103": (10.7, 2.1), "corridor": (5.35, 1.2)}
BELOW = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.14), "frameon": False}  # places of a legend
BESIDE = {"loc": "center left", "bbox_to_anchor": (1.0, 0.5), "frameon": False, "fontsize": 8}
EVENT = {"color": "black", "linestyle": ":"}
LIGHT_TO_DARK = ListedColormap(colormaps["Blues"](np.linspace(0.3, 1.0, 128)))  # the higher, the darker, on white


def style(index: int, size: float, **others: object) -> dict:
    """Return `line_style(index)` with markers of this size."""
    return line_style(index) | {"markersize": size} | others


def draw_hotel(axes: Axes, title: str) -> None:
    """Draw the map from above: dark walls, light furniture, and the names of the rooms."""
    for colour, boxes in (("0.35", WALLS), ("0.86", FURNITURE)):
        for (x0, y0, _), (x1, y1, _) in boxes:
            axes.add_patch(Rectangle((x0, y0), x1 - x0, y1 - y0, facecolor=colour, edgecolor="0.5", linewidth=0.4))
    around = [withStroke(linewidth=3, foreground="white")]  # particles may lie under a name
    for name, (x, y) in NAMES.items():
        axes.text(x, y, name, fontsize=8, color="0.25", ha="center", va="center", zorder=6, path_effects=around)
    axes.set(xlim=(-0.2, 12.2), ylim=(-0.2, 5.9), aspect="equal", title=title, xlabel="x [m]", ylabel="y [m]")
    axes.grid(False)


def draw_poses(axes: Axes, states: np.ndarray, colour: str, label: str) -> None:
    """Draw states `(N, 6)` from above: dots with a short line in the direction of view."""
    ahead = states[:, :2] + 0.3 * np.column_stack([np.cos(states[:, 5]), np.sin(states[:, 5])])
    axes.plot(*states[:, :2].T, "o", color=colour, markersize=4, label=label)
    axes.plot(*np.array([states[:, :2], ahead]).transpose(2, 0, 1), color=colour, linewidth=1.3)


def draw_camera(axes: Axes, true: np.ndarray) -> list:
    """Draw the camera, and its double next door, and return both artists."""
    camera = axes.plot(*true[:2], "*", color="none", mec="black", markersize=15, label="camera")
    return camera + axes.plot(*true[:2] + ALIKE[:2], "D", color="none", mec="black", markersize=9, label="its double")


def hotel(recording: Recording, uncovered: int) -> Figure:
    """The hotel, and the walk of a camera before it is carried away and after."""
    figure, axes = new_figure(size=(8.4, 4.3))
    draw_hotel(axes, "A hotel floor from above, and a kidnapping")
    draw_poses(axes, recording.states[:uncovered], BLUE, "before")
    draw_poses(axes, recording.states[uncovered::2], VERMILION, "after, seen again")
    start, end = recording.states[[uncovered - 1, uncovered], :2]
    line = {"color": "black", "linestyle": "--"}
    arrow = line | {"arrowstyle": "->", "connectionstyle": "arc3,rad=-0.25", "lw": 1.5, "shrinkA": 5, "shrinkB": 5}
    axes.annotate("", end, start, arrowprops=arrow)
    axes.plot([], [], **line, label="carried, covered")
    axes.legend(ncols=3, **BELOW)
    alt = """A hotel floor from above: three rooms over a corridor, 101 and 102 furnished alike. A camera walks along
        the corridor below 101; a dashed arrow carries it into 103, where it looks around."""
    return described(figure, alt)


def carried(errors: np.ndarray, scores: np.ndarray, weights: np.ndarray, uncovered: int) -> Figure:
    """Error, raw score and greatest weight over the frames of runs `(runs, T)`. The kidnapping is a line."""
    figure, axes = new_figure(1, 3, size=(10.2, 2.9))
    for a, rows, title, label, top in (
        (axes[0], errors, "How far off it is", "distance from the truth [m]", None),
        (axes[1], scores, "Raw score of the best particle", "raw score [-]", None),
        (axes[2], weights, "Weight of the best particle", "weight [-]", 1.05),
    ):
        for k, row in enumerate(rows):
            a.plot(row, **style(k, 3, linewidth=1.1), label=f"run {k + 1}")
        a.axvline(uncovered - 0.5, linewidth=1.2, **EVENT)
        a.set(title=title, xlabel="frame [-]", ylabel=label, ylim=(0, top))
    axes[0].legend(loc="center left", fontsize=8)
    alt = """Three panels over 30 frames. The error jumps to 6 m at the kidnapping and stays above 5 m. The score
        falls to 0.2 there and climbs back to 0.6. The best weight goes up and down before and after."""
    return described(figure, alt)


def first_scores(states: np.ndarray, scores: np.ndarray, true: np.ndarray) -> Figure:
    """Particles `(N, 6)` from above, coloured by score. The best twenty are arrows."""
    figure, axes = new_figure(size=(8.4, 4.8))
    draw_hotel(axes, "One frame, particles anywhere: who sees what the camera sees?")
    order = np.argsort(scores)
    dots = axes.scatter(*states[order, :2].T, c=scores[order], s=7, cmap=LIGHT_TO_DARK, linewidths=0)
    draw_poses(axes, states[order[-20:]], VERMILION, "the 20 best")
    draw_camera(axes, true)
    figure.colorbar(dots, ax=axes, label="score of a coarse image [-]", shrink=0.8)
    axes.legend(ncols=3, **BELOW)
    alt = """The hotel from above, full of dots, dark where the score is high. The twenty best have arrows. Seven lie
        near the camera in 101 or near its double in 102, the others elsewhere in the three rooms."""
    return described(figure, alt)


def kld(rounds: Sequence[Round]) -> Figure:
    """Left: particles against bins, for three errors. Right: bins and particles over the frames of a run."""
    figure, (left, right) = new_figure(1, 2, size=(9.6, 3.2))
    bins = np.unique(np.geomspace(2, 1000, 60).astype(int))
    for k, error in enumerate((0.02, 0.05, 0.2)):
        n = [kld_count(int(b), 1, 10**7, error) for b in bins]
        left.loglog(bins, n, **style(k, 5, marker=""), label=f"error {error} nats")
    left.set(title="How many particles?", xlabel="occupied bins k [-]", ylabel="particles n [-]")
    right.semilogy([len(one.particles) for one in rounds], **style(0, 4), label="particles n")
    right.semilogy([one.bins for one in rounds], **style(1, 4), label="bins k")
    right.set(title="As the search narrows", xlabel="frame [-]", ylabel="number [-]")
    for axes in (left, right):
        axes.legend(fontsize=8)
    alt = """Left: particles needed grow nearly as the occupied bins do; a smaller error needs more. Right: over the
        frames of a run bins fall from about a hundred to a few, and particles from 3000 to 100."""
    return described(figure, alt)


def evidence(run: Sequence[PoseCandidates]) -> Figure:
    """What the search says over the frames, and the evidence of the best pose near the true place and its double."""
    figure, (top, axes) = new_figure(2, 1, size=(8.4, 4.2))
    top.get_gridspec().set_height_ratios([0.5, 1.0])
    levels = ["searching", "several", "found"]
    top.plot([levels.index(places.status) for places in run], "s", color=BLACK, markersize=5)
    top.set_yticks(range(3), levels)
    top.set(title="What the search says", ylabel="status", xlabel="frame [-]", ylim=(-0.5, 2.5))
    for k, (offset, name) in enumerate(((0 * ALIKE, "at the camera (101)"), (ALIKE, "at its double (102)"))):
        best = np.full(len(run), np.nan)
        for frame, found in enumerate(run):
            place = leaving_101().states[frame, :3] + offset
            near = [one.evidence for one in found.poses if np.linalg.norm(one.state[:3] - place) < 0.5]
            best[frame] = max(near, default=np.nan)
        axes.plot(best, **style(k, 4), label=name)
    axes.set(title="Evidence of the two places", xlabel="frame [-]", ylabel="evidence [-]")
    axes.legend(loc="lower left", fontsize=8)
    alt = """Above: searching for three frames, then several, then found from frame 21 on. Below: evidence of the place
        in 101 and of its double in 102 are both near 1 until frame 20, when the double's falls and ends."""
    return described(figure, alt)


def trade_off(ratios: np.ndarray) -> tuple[Figure, list[tuple[float, float, float, list[int | None]]]]:
    """False alarms, and how late kidnappings are noticed, for ratios of the alarm; and the rows that are drawn.

    A row: ratio, false alarms [%] by the score alone and with the second condition, delays of the kidnappings [frames].
    """
    figure, (left, right) = new_figure(1, 2, size=(9.4, 3.0))
    rows = []
    for c in ratios:
        alone, both = (
            [alarms(trace, c, cannot_be_right=asked)[1:] for trace in traces().values()] for asked in (False, True)
        )
        false = (100 * np.mean([n for n, _ in found]) / KIDNAPPED for found in (alone, both))
        rows.append((c, *false, [late for _, late in both]))
    for k, name in ((1, "the score alone"), (2, "and the pose cannot be right")):
        left.plot(ratios, [row[k] for row in rows], **style(k - 1, 4), label=name)
    delays = np.array([row[3] for row in rows], dtype=float)  # None becomes NaN
    for k, goal in enumerate(GOALS):
        right.plot(ratios, delays[:, k], **style(k + 2, 4), label=f"kidnapped {goal}")
    left.set(title="Frames in peace with an alarm", xlabel="ratio c [-]", ylabel="false alarms [%]")
    right.set(title="How late the alarm comes (no dot: never)", xlabel="ratio c [-]", ylabel="delay [frames]")
    right.set(xlim=left.get_xlim(), ylim=(-0.3, 4.2), yticks=range(5))
    for axes in (left, right):
        axes.legend(fontsize=8)
    alt = """Left: false alarms rise from 0 at a ratio of 0.7 to over 30 percent by the score alone, and stay 0 with the
        second condition. Right: the delay falls from three frames at 0.5 to none from 0.85 on. No alarm comes on
        the way to the lift."""
    return described(figure, alt), rows


TOLD = {  # title, frame, what happens in it, alternative text
    "next door": ("Put into the room next door", 8, "put into 102", """The error jumps to 4 m at frame 8. The filter
        says tracked for 14 frames, then doubtful and lost when the camera reaches the corridor. It searches from
        frame 25 to the end."""),
    "door": ("An open door that is shut on the map", 10, "looks at the door", """The filter is right until frame 13,
        though it says lost from frame 9 on. It searches in frames 11 to 14, and from frame 15 on it says tracked at 4 m
        from the truth."""),
}  # fmt: skip


def told(errors: np.ndarray, statuses: Sequence[str], name: str) -> Figure:
    """Error over the frames of one of `TOLD`, marked by what the filter says of itself."""
    title, happened, what, alt = TOLD[name]
    figure, axes = new_figure(size=(8.0, 2.8))
    axes.plot(errors, color="0.7", linewidth=1.0, zorder=1)
    for k, status in ((0, "tracked"), (1, "doubtful"), (3, "lost"), (4, "searching")):
        chosen = [frame for frame, one in enumerate(statuses) if one == status]
        axes.plot(chosen, errors[chosen], **style(k, 7, linestyle="none"), label=f"it says: {status}")
    axes.axvline(happened - 0.5, linewidth=1.4, label=what, **EVENT)
    axes.set(title=title, xlabel="frame [-]", ylabel="distance from the truth [m]", ylim=(-0.3, None))
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.legend(**BESIDE)
    return described(figure, alt)
