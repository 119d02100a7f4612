"""The panel of lesson 15: the four weights of eq. (1), the penalty table as a heat map, the matching as it is built."""

from typing import NamedTuple

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import PowerNorm

from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Choice, Drawing, Panel, Slider
from course_lib.lessons.kit.room_observations import MatchingScene, room_scenes
from course_lib.lessons.kit.room_photographs import room_map
from course_lib.lessons.lesson_15.figures import short_name
from course_lib.plots import figures
from course_lib.plots.room_figures import map_axes
from course_lib.spherical_stereo.semantic_map.association import Association, PenaltyWeights, associate_greedy
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

WITH_ABSOLUTE, AS_PRINTED = "with absolute value", "as printed"
_TERMS = {WITH_ABSOLUTE: "absolute", AS_PRINTED: "as_printed"}
_MAX_PENALTY = 6.0  # penalty that the colours end at
_SHOWN = (-1.2, 2.6)  # penalties that the right plot shows; what is beyond is drawn at its edge
_MAX_HIDDEN = 8


class Matching(NamedTuple):
    """A scene, matched."""

    kept: tuple[int, ...]
    """Indices of the scene's observations that were not hidden."""
    shows: tuple[int, ...]
    """For every kept observation the landmark it shows."""
    association: Association


def match(
    scene: MatchingScene, semantic_map: SemanticMap, weights: PenaltyWeights, distance_term: str, n_hidden: int
) -> Matching:
    """The greedy matching with the `n_hidden` farthest objects left out."""
    ranges = np.array([np.hypot(one.x, one.y) for one in scene.observations])
    n_kept = max(2, len(ranges) - n_hidden)
    kept = tuple(int(k) for k in np.sort(np.argsort(ranges, kind="stable")[:n_kept]))
    seen = [scene.observations[k] for k in kept]
    found = associate_greedy(seen, semantic_map, weights, distance_term)
    return Matching(kept, tuple(scene.true_landmarks[k] for k in kept), found)


def next_best(matching: Matching) -> np.ndarray:
    """For every round: the least penalty that its observation had with another open landmark; NaN where none."""
    total, pairs = matching.association.table.total, matching.association.pairs
    least = np.full(len(pairs), np.nan)
    for k, (observation, _) in enumerate(pairs):
        others = sorted(set(range(total.shape[1])) - {landmark for _, landmark in pairs[: k + 1]})
        if others:
            least[k] = total[observation, others].min()
    return least


def penalty_panel(semantic_map: SemanticMap, scenes: dict[str, MatchingScene]) -> Panel:
    """Sliders for the weights, for the rounds done and for hidden objects; choices of photographs and distance term."""
    n = len(semantic_map)
    names = [short_name(label, j) for j, label in enumerate(semantic_map.labels)]
    figure, (heat, plan, rounds) = figures.new_figure(1, 3, size=(11.0, 4.3))
    heat.get_gridspec().set_width_ratios([1.25, 1.15, 0.8])
    image = heat.imshow(
        np.zeros((n, n)), cmap="cividis", norm=PowerNorm(0.5, 0.0, _MAX_PENALTY), interpolation="nearest", aspect="auto"
    )
    heat.patch.set(facecolor="white", edgecolor="0.7", hatch="////", linewidth=0)
    heat.grid(False)
    heat.set_xticks(range(n), names, rotation=90, fontsize=7)
    heat.set_yticks(range(n), names, fontsize=7)
    heat.set(title="Penalty of every combination", xlabel="landmark of the map [-]", ylabel="observed object [-]")
    bar = figure.colorbar(image, ax=heat, label="penalty [-]", shrink=0.9)
    bar.set_ticks([0, 0.1, 0.5, 1, 2, 4, 6])
    done = LineCollection([], colors="white", linewidths=0.7, alpha=0.8)
    heat.add_collection(done)
    (right_cells,) = heat.plot([], [], "o", mfc="none", mec="white", markersize=7, mew=1.8)
    (wrong_cells,) = heat.plot([], [], "X", color=figures.VERMILION, mec="white", markersize=9)
    map_axes(plan, semantic_map, "Object (x) to its landmark")
    for j, (x, y) in enumerate(semantic_map.positions):
        plan.annotate(str(j), (x, y), (5, 4), textcoords="offset points", fontsize=7)
    plan.plot(*semantic_map.centroid, "+", color=figures.BLACK, markersize=13, markeredgewidth=1.8)
    (places,) = plan.plot([], [], "x", color="0.25", markersize=6, markeredgewidth=1.4)
    right_lines = LineCollection([], colors=figures.GREEN, linewidths=2.2)
    wrong_lines = LineCollection([], colors=figures.VERMILION, linewidths=1.6, linestyles="--")
    plan.add_collection(right_lines)
    plan.add_collection(wrong_lines)
    (camera,) = plan.plot([], [], "o", color=figures.BLACK, markersize=7)
    (seen_centre,) = plan.plot([], [], "P", color=figures.PURPLE, mec="white", markersize=10)
    (chosen,) = rounds.plot([], [], "o", color=figures.BLUE, markersize=6, label="chosen, right")
    (mistaken,) = rounds.plot([], [], "X", color=figures.VERMILION, markersize=8, label="chosen, wrong")
    (second,) = rounds.plot([], [], "D", mfc="none", color="0.35", markersize=4, label="next best")
    rounds.set(title="Round by round", xlabel="round [-]", ylabel="penalty [-]", xlim=(0, n + 1), ylim=_SHOWN)
    rounds.legend(loc="lower left", fontsize=7, framealpha=0.95)
    on_table, on_map = [image, done, right_cells, wrong_cells], [right_lines, wrong_lines, places, camera, seen_centre]
    live = LiveFigure(figure, [*on_table, *on_map, second, chosen, mistaken])

    def draw(
        p_obj: float, p_h: float, p_s: float, p_d: float, done_rounds: float, hidden: float, term: str, pair: str
    ) -> Drawing:
        scene = scenes[pair]
        found = match(scene, semantic_map, PenaltyWeights(p_obj, p_h, p_s, p_d), _TERMS[term], int(hidden))
        table = np.full((n, n), np.nan)
        table[list(found.shows)] = found.association.table.total
        image.set_data(np.ma.masked_invalid(np.clip(table, 0, _MAX_PENALTY)))
        pairs = found.association.pairs
        k = min(int(done_rounds), len(pairs))
        rows, columns = [found.shows[i] for i, _ in pairs[:k]], [j for _, j in pairs[:k]]
        right = np.array([row == column for row, column in zip(rows, columns, strict=True)], dtype=bool)
        cells = np.array([columns, rows]).reshape(2, -1)
        right_cells.set_data(cells[:, right])
        wrong_cells.set_data(cells[:, ~right])
        across = [[(-0.5, row), (n - 0.5, row)] for row in rows]
        done.set_segments(across + [[(column, -0.5), (column, n - 0.5)] for column in columns])
        observed = scene.pose.apply(np.array([[scene.observations[q].x, scene.observations[q].y] for q in found.kept]))
        places.set_data(*observed.T)
        seen_centre.set_data(*observed.mean(axis=0)[:, None])
        camera.set_data([scene.pose.x], [scene.pose.y])
        lines = [(observed[i], semantic_map.positions[j]) for i, j in pairs[:k]]
        right_lines.set_segments([line for line, good in zip(lines, right, strict=True) if good])
        wrong_lines.set_segments([line for line, good in zip(lines, right, strict=True) if not good])
        costs = np.clip([one.total for one in found.association.penalties], *_SHOWN)
        numbers = np.arange(1, len(pairs) + 1)
        chosen.set_data(numbers[:k][right], costs[:k][right])
        mistaken.set_data(numbers[:k][~right], costs[:k][~right])
        second.set_data(numbers[:k], np.clip(next_best(found), *_SHOWN)[:k])
        summary = _summary(found, k, right, names)
        alt = (
            f"Penalty table of {len(found.kept)} objects and {n} landmarks as a heat map, the map with lines from each "
            f"object to the landmark it was taken for, and the penalties by round. {' '.join(summary.splitlines())}"
        )
        return Drawing(live.png(), alt, summary)

    most = max(len(scene.observations) for scene in scenes.values())

    def go(by: int):
        return lambda values: values | {"done_rounds": float(np.clip(values["done_rounds"] + by, 0, most))}

    controls = [
        Slider("p_obj", "p_obj (class) [-]", 0.0, 5.0, 3.0, 0.1),
        Slider("p_h", "p_h (hue) [-]", 0.0, 10.0, 1.0, 0.1),
        Slider("p_s", "p_s (saturation) [-]", 0.0, 10.0, 1.0, 0.1),
        Slider("p_d", "p_d (distance) [-]", 0.0, 5.0, 1.0, 0.1),
        Slider("done_rounds", "rounds done", 0, most, most, 1),
        Slider("hidden", "farthest objects hidden", 0, _MAX_HIDDEN, 0, 1),
        Choice("term", "distance term", tuple(_TERMS), WITH_ABSOLUTE),
        Choice("pair", "pair of photographs", tuple(scenes), next(iter(scenes))),
    ]
    actions = {"Back": go(-1), "Next round": go(+1), "From the start": lambda values: values | {"done_rounds": 0.0}}
    return Panel("15 penalty weights", controls, draw, actions=actions)


def _summary(found: Matching, k: int, right: np.ndarray, names: list[str]) -> str:
    pairs = found.association.pairs
    used = sum(found.association.same_class[:k])
    lines = [
        f"{k} of {len(pairs)} rounds: {int(right.sum())} pairs right, {k - int(right.sum())} wrong, {k - used} unlike"
    ]
    if k:
        i, j = pairs[k - 1]
        one = found.association.penalties[k - 1]
        colour = f"hue {one.hue:.3f} + saturation {one.saturation:.3f}"
        lines.append(f"last round: {names[found.shows[i]]} taken for {names[j]}, penalty {one.total:.3f}:")
        lines.append(f"class {one.object:.2f} + {colour} + distance {one.distance:.3f}")
    return "\n".join(lines)


def weights_panel() -> Panel:
    """The panel of this lesson: weights, the table, and the matching as it grows."""
    return penalty_panel(room_map(), {name: room_scenes()[name] for name in ("03_b", "06_a", "08_a", "10_a")})


PANELS = {"15 penalty weights": weights_panel}
