"""The panel of lesson 18: one pose after another, what each makes of the scene, and what its score is made of."""

import functools
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection

from course_lib.beyond.look_alikes.confidence import confidence_of
from course_lib.beyond.look_alikes.consistent import rank_poses
from course_lib.beyond.look_alikes.hypotheses import PoseHypothesis, Scene, scene_of
from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Choice, Drawing, Panel, Slider
from course_lib.lessons.kit.room_observations import MatchingScene, room_scenes
from course_lib.lessons.kit.room_photographs import room_map
from course_lib.lessons.lesson_18.figures import SIGMAS, laid_on_the_map
from course_lib.lessons.lesson_18.scenes import mirrored, thinned
from course_lib.lessons.lesson_18.terms import TERMS, residual_sigmas, score_terms, share_of_nothing
from course_lib.plots import figures
from course_lib.plots.panorama_drawing import class_style
from course_lib.plots.room_figures import map_axes

ROOM, MIRROR = "the room", "its mirror image"
ALL = 99
"""More distinct poses than there ever are."""
SHOWN_RANKS = 6
MAX_HIDDEN = 8
"""Of the eleven objects or more that each of the panel's pairs of photographs shows: two poses or more are left."""
PAIRS = ("08_a", "07_b", "06_a", "10_a")
_MIN_NATS, _MAX_NATS = -45.0, 130.0  # of the bars; what is beyond is drawn at the edge
_MAX_SIGMAS = 5.0
_AROUND = np.linspace(0, 2 * np.pi, 33)


class Ranked(NamedTuple):
    """A scene with its nearest objects left, and every pose that explains it, best first."""

    scene: MatchingScene
    arrays: Scene
    poses: tuple[PoseHypothesis, ...]


@functools.lru_cache(maxsize=64)
def ranked(photographs: str, map_name: str, hidden: int) -> Ranked:
    """All poses of a pair of photographs with its `hidden` farthest objects left out; at least two stay."""
    scene = room_scenes()[photographs]
    ranges = np.array([np.hypot(one.x, one.y) for one in scene.observations])
    kept = np.sort(np.argsort(ranges, kind="stable")[: max(2, len(ranges) - hidden)])
    scene = thinned(scene, kept)
    semantic_map = room_map() if map_name == ROOM else mirrored(room_map())
    return Ranked(
        scene, scene_of(scene.observations, semantic_map), rank_poses(scene.observations, semantic_map, n=ALL)
    )


def hypotheses_panel() -> Panel:
    """Sliders for the rank of the pose and for hidden objects; choices of photographs and of the map."""
    figure, axes = figures.new_figure(2, 2, size=(11.6, 5.0))
    grid = axes[0, 0].get_gridspec()
    grid.set_width_ratios([2.0, 1.0])
    for one in axes[:, 0]:
        one.remove()
    plan, (terms, residuals) = figure.add_subplot(grid[:, 0]), axes[:, 1]
    map_axes(plan, room_map(), "The map, and the objects (x) as this pose lays them on it")
    landmarks = {line.get_label(): line for line in plan.get_lines() if line.get_label() in room_map().labels}
    right_lines = LineCollection([], colors=figures.GREEN, linewidths=2.6)
    wrong_lines = LineCollection([], colors=figures.VERMILION, linewidths=2.0, linestyles="--")
    ellipses = LineCollection([], linewidths=1.1)
    heading = LineCollection([], colors=figures.BLACK, linewidths=2.4)
    for one in (right_lines, wrong_lines, ellipses, heading):
        plan.add_collection(one)
    (places,) = plan.plot([], [], "x", color="0.2", markersize=7, markeredgewidth=1.6)
    (missed,) = plan.plot([], [], "s", mfc="none", mec=figures.VERMILION, markersize=17, markeredgewidth=1.4)
    (truth,) = plan.plot([], [], "o", mfc="none", mec=figures.BLACK, markersize=14, markeredgewidth=1.6)
    (robot,) = plan.plot([], [], "o", color=figures.BLACK, markersize=8)
    plan.set(xlim=(-1.0, 6.2), ylim=(-1.1, 6.1))
    for name, style in (
        ("this pose", {"marker": "o", "color": figures.BLACK, "markersize": 8}),
        ("true pose", {"marker": "o", "mfc": "none", "mec": figures.BLACK, "markersize": 11}),
        ("should be seen, and is not", {"marker": "s", "mfc": "none", "mec": figures.VERMILION, "markersize": 11}),
    ):
        plan.plot([], [], linestyle="none", label=name, **style)
    plan.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), fontsize=8, frameon=False)
    term_bars = _bars(terms, [*TERMS, "score"])
    terms.set(title="What its score adds up from", xlabel="score [nats]", ylabel="evidence [-]")
    (right_dots,) = residuals.plot([], [], "o", color=figures.GREEN, markersize=6, label="right")
    (wrong_dots,) = residuals.plot([], [], "X", color=figures.VERMILION, markersize=8, label="wrong")
    residuals.axhline(SIGMAS, color="0.5", linewidth=0.8, linestyle=":")
    residuals.set(title="How far each match is off", xlabel="match [-]", ylabel="distance [sigmas]")
    residuals.set(xlim=(0.3, 14.7), ylim=(0, _MAX_SIGMAS))
    residuals.legend(loc="upper right", fontsize=7, ncols=2)
    on_map = [ellipses, right_lines, wrong_lines, *landmarks.values(), places, missed, truth, heading, robot]
    live = LiveFigure(figure, [*on_map, term_bars, right_dots, wrong_dots])

    def draw(rank: float, hidden: float, photographs: str, map_name: str) -> Drawing:
        found = ranked(photographs, map_name, int(hidden))
        semantic_map = found.arrays.semantic_map
        for label, line in landmarks.items():
            line.set_data(*semantic_map.positions[[one == label for one in semantic_map.labels]].T)
        k = min(int(rank), len(found.poses)) - 1
        chosen = found.poses[k]
        seen, spread = laid_on_the_map(found.arrays, chosen.pose)
        places.set_data(*seen.T)
        roots = np.linalg.cholesky(spread)
        circle = SIGMAS * np.stack([np.cos(_AROUND), np.sin(_AROUND)])
        ellipses.set_segments(list(np.swapaxes(roots @ circle, 1, 2) + seen[:, None]))
        # In the mirror no match is right: there the robot is nowhere.
        right = np.array([map_name == ROOM and found.scene.true_landmarks[i] == j for i, j in chosen.pairs])
        ends = [(seen[i], semantic_map.positions[j]) for i, j in chosen.pairs]
        ellipses.set_color([class_style(one.label)[0] for one in found.scene.observations])
        right_lines.set_segments([line for line, good in zip(ends, right, strict=True) if good])
        wrong_lines.set_segments([line for line, good in zip(ends, right, strict=True) if not good])
        missed.set_data(*semantic_map.positions[list(chosen.missed)].reshape(-1, 2).T)
        truth.set_data(*([[v] for v in found.scene.pose[:2]] if map_name == ROOM else ([], [])))
        x, y, theta = chosen.pose
        robot.set_data([x], [y])
        heading.set_segments([[(x, y), (x + 0.5 * np.cos(theta), y + 0.5 * np.sin(theta))]])
        values = score_terms(found.arrays, chosen)
        _set_bars(term_bars, [*values.values(), chosen.score])
        off = np.clip(residual_sigmas(found.arrays, chosen), 0, 0.97 * _MAX_SIGMAS)
        order = np.argsort(off)
        numbers = np.arange(1, len(off) + 1)
        right_dots.set_data(numbers[right[order]], off[order][right[order]])
        wrong_dots.set_data(numbers[~right[order]], off[order][~right[order]])
        summary = _summary(found, k, right, values)
        alt = (
            f"The map from above with {len(seen)} objects as one pose lays them on it, lines to the landmarks they are "
            f"taken for, bars of its score and a dot for every match's distance. {' '.join(summary.splitlines())}"
        )
        return Drawing(live.png(), alt, summary)

    def go(by: int):
        return lambda values: values | {"rank": float(np.clip(values["rank"] + by, 1, SHOWN_RANKS))}

    controls = [
        Slider("rank", "pose, by rank", 1, SHOWN_RANKS, 1, 1),
        Slider("hidden", "farthest objects hidden", 0, MAX_HIDDEN, 0, 1),
        Choice("photographs", "pair of photographs", PAIRS, PAIRS[0]),
        Choice("map_name", "map", (ROOM, MIRROR), ROOM),
    ]
    return Panel("18 poses by rank", controls, draw, actions={"Better": go(-1), "Worse": go(+1)})


def _bars(axes: Axes, names: list[str]) -> LineCollection:
    """Horizontal bars, the first name on top: thick lines, which a live figure moves cheaply."""
    axes.set(ylim=(len(names) - 0.4, -0.6), xlim=(_MIN_NATS, _MAX_NATS))
    axes.set_yticks(range(len(names)), names)
    axes.axvline(0, color="0.3", linewidth=0.8)
    colours = [figures.BLUE if name != "score" else figures.BLACK for name in names]
    drawn = LineCollection([], linewidths=9, capstyle="butt", colors=colours)
    axes.add_collection(drawn)
    return drawn


def _set_bars(drawn: LineCollection, values: list[float]) -> None:
    clipped = np.clip(values, _MIN_NATS, _MAX_NATS)
    drawn.set_segments([[(0, k), (value, k)] for k, value in enumerate(clipped)])


def _summary(found: Ranked, k: int, right: np.ndarray, values: dict[str, float]) -> str:
    chosen = found.poses[k]
    x, y, theta = chosen.pose
    terms = ", ".join(f"{name} {value:.1f}" for name, value in values.items() if value)
    return "\n".join(
        [
            f"pose {k + 1} of {len(found.poses)}: ({x:.2f}, {y:.2f}) m, {np.degrees(theta):.0f} degrees; "
            f"{len(right)} of {len(found.scene.observations)} objects matched, {int((~right).sum())} of them wrongly",
            f"score {chosen.score:.1f} = {terms}",
            f'share {chosen.share:.1%}, "none of these" {share_of_nothing(found.arrays, found.poses):.1%}; '
            f"confidence of pose 1: {confidence_of(found.poses[0]):.2f}, 0.80 is asked for",
        ]
    )


PANELS = {"18 poses by rank": hypotheses_panel}
