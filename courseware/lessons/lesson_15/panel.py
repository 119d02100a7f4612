"""The panel of lesson 15: the four weights of eq. (1), the penalty table as a heat map, the matching as it is built."""

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import PowerNorm

from course_lib.spherical_stereo.semantic_map.association import PenaltyWeights, associate_greedy
from courseware.lessons.kit.live_figure import LiveFigure
from courseware.lessons.kit.panel import Choice, Drawing, Panel, Slider
from courseware.lessons.kit.room_data import room_map, room_scenes
from courseware.lessons.lesson_15.figures import short_names
from courseware.plots import figures
from courseware.plots.room_figures import map_axes

TERMS = {"with absolute value": "absolute", "as printed": "as_printed"}
PAIRS = ("03_b", "06_a", "08_a", "10_a")
N_ROUNDS = 14  # as many as objects in view, at most
CONTROLS = [
    Slider("p_obj", "p_obj (class) [-]", 0.0, 5.0, 3.0, 0.1),
    Slider("p_h", "p_h (hue) [-]", 0.0, 10.0, 1.0, 0.1),
    Slider("p_s", "p_s (saturation) [-]", 0.0, 10.0, 1.0, 0.1),
    Slider("p_d", "p_d (distance) [-]", 0.0, 5.0, 1.0, 0.1),
    Slider("done_rounds", "rounds done", 0, N_ROUNDS, N_ROUNDS, 1),
    Slider("hidden", "farthest objects hidden", 0, 8, 0, 1),
    Choice("term", "distance term", tuple(TERMS), "with absolute value"),
    Choice("pair", "pair of photographs", PAIRS, PAIRS[0]),
]
MAX_PENALTY = 6.0  # penalty that the colours end at
SHOWN = (-1.2, 2.6)  # penalties that the right plot shows; what is beyond is drawn at its edge


def weights_panel() -> Panel:
    """Sliders for the weights, for the rounds done and for hidden objects; choices of photographs and distance term."""
    room, n, names = room_map(), len(room_map()), short_names()
    figure, (heat, plan, rounds) = figures.new_figure(1, 3, size=(11.0, 4.3))
    heat.get_gridspec().set_width_ratios([1.25, 1.15, 0.8])
    scale = PowerNorm(0.5, 0.0, MAX_PENALTY)
    image = heat.imshow(np.zeros((n, n)), cmap="plasma", norm=scale, interpolation="nearest", aspect="auto")
    heat.patch.set(facecolor="white", edgecolor="0.7", hatch="////", linewidth=0)
    heat.grid(False)
    heat.set_xticks(range(n), names, rotation=90, fontsize=7)
    heat.set_yticks(range(n), names, fontsize=7)
    heat.set(title="Penalty of every combination", xlabel="landmark of the map", ylabel="observed object")
    figure.colorbar(image, ax=heat, label="penalty [-]", shrink=0.9).set_ticks([0, 0.1, 0.5, 1, 2, 4, 6])
    done = heat.add_collection(LineCollection([], colors="white", linewidths=0.7, alpha=0.8))
    cells = heat.plot([], [], "o", mfc="none", mec="white", markersize=7, mew=1.8)
    cells += heat.plot([], [], "X", color=figures.VERMILION, mec="white", markersize=9)
    map_axes(plan, room, "Object (x) to its landmark")
    for j, place in enumerate(room.positions, start=1):
        plan.annotate(str(j), place, (5, 4), textcoords="offset points", fontsize=7)
    plan.plot(*room.centroid, "+", color=figures.BLACK, markersize=13, markeredgewidth=1.8)
    (places,) = plan.plot([], [], "x", color="0.25", markersize=6, markeredgewidth=1.4)
    looks = {"colors": figures.GREEN, "linewidths": 2.2}, {"colors": figures.VERMILION, "lw": 1.6, "linestyles": "--"}
    lines = [plan.add_collection(LineCollection([], **look)) for look in looks]
    (camera,) = plan.plot([], [], "o", color=figures.BLACK, markersize=7)
    (seen_centre,) = plan.plot([], [], "P", color=figures.PURPLE, mec="white", markersize=10)
    chosen = rounds.plot([], [], "o", color=figures.BLUE, markersize=6, label="chosen, right")
    chosen += rounds.plot([], [], "X", color=figures.VERMILION, markersize=8, label="chosen, wrong")
    (second,) = rounds.plot([], [], "D", mfc="none", color="0.35", markersize=4, label="next best")
    rounds.set(title="Round by round", xlabel="round [-]", ylabel="penalty [-]", xlim=(0, n + 1), ylim=SHOWN)
    rounds.legend(loc="lower left", fontsize=7, framealpha=0.95)
    live = LiveFigure(figure, [image, done, *cells, *lines, places, camera, seen_centre, second, *chosen])

    def draw(p_obj, p_h, p_s, p_d, done_rounds, hidden, term, pair) -> Drawing:
        scene = room_scenes()[pair]
        ranges = [np.hypot(one.x, one.y) for one in scene.observations]
        kept = np.sort(np.argsort(ranges, kind="stable")[: len(ranges) - int(hidden)])
        seen, shows = ([values[k] for k in kept] for values in (scene.observations, scene.true_landmarks))
        found = associate_greedy(seen, room, PenaltyWeights(p_obj, p_h, p_s, p_d), TERMS[term])
        table, total, pairs = np.full((n, n), np.nan), found.table.total, found.pairs[: int(done_rounds)]
        table[shows] = total
        image.set_data(np.ma.masked_invalid(np.clip(table, 0, MAX_PENALTY)))
        rows, columns = [shows[i] for i, _ in pairs], [j for _, j in pairs]
        across = [[(-0.5, row), (n - 0.5, row)] for row in rows]
        done.set_segments(across + [[(column, -0.5), (column, n - 0.5)] for column in columns])
        observed = scene.pose.apply(np.array([one[1:3] for one in seen]))
        places.set_data(*observed.T)
        seen_centre.set_data(*observed.mean(axis=0)[:, None])
        camera.set_data([scene.pose.x], [scene.pose.y])
        others = [np.delete(total[i], columns[: k + 1]) for k, (i, _) in enumerate(pairs)]  # the landmarks still open
        next_best = [one.min() if one.size else np.nan for one in others]
        second.set_data(range(1, len(pairs) + 1), np.clip(next_best, *SHOWN))
        right = np.equal(rows, columns)
        for k, of_kind in enumerate((right, ~right)):
            which = np.flatnonzero(of_kind)
            cells[k].set_data([columns[m] for m in which], [rows[m] for m in which])
            lines[k].set_segments([(observed[i], room.positions[j]) for i, j in np.array(pairs)[which]])
            chosen[k].set_data(which + 1, np.clip([found.penalties[m].total for m in which], *SHOWN))
        k, n_right, n_like = len(pairs), int(right.sum()), sum(found.same_class[: len(pairs)])
        summary = f"{k} of {len(seen)} rounds: {n_right} pairs right, {k - n_right} wrong, {k - n_like} unlike"
        if k:
            one, colours = found.penalties[k - 1], "hue {0.hue:.3f} + saturation {0.saturation:.3f}"
            summary += f"\nlast round: {names[rows[-1]]} taken for {names[columns[-1]]}, penalty {one.total:.3f}:"
            summary += f"\nclass {one.object:.2f} + {colours.format(one)} + distance {one.distance:.3f}"
        alt = (
            f"Penalty table of {len(kept)} objects and {n} landmarks as a heat map, the map with lines from each "
            f"object to the landmark it was taken for, and the penalties by round. {' '.join(summary.splitlines())}"
        )
        return Drawing(live.png(), alt, summary)

    def go(by: int):
        return lambda values: values | {"done_rounds": float(np.clip(values["done_rounds"] + by, 0, N_ROUNDS))}

    actions = {"Back": go(-1), "Next round": go(+1), "From the start": lambda values: values | {"done_rounds": 0.0}}
    return Panel("15 penalty weights", CONTROLS, draw, actions=actions)


PANELS = {"15 penalty weights": weights_panel}
