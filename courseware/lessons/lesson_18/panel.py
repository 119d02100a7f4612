"""The panel of lesson 18: one pose after another, what each makes of the scene, and what its score is made of."""

import functools

import numpy as np
from matplotlib.collections import LineCollection

from course_lib.beyond.look_alikes import evidence
from course_lib.beyond.look_alikes.confidence import confidence_of
from course_lib.beyond.look_alikes.consistent import rank_poses
from course_lib.beyond.look_alikes.hypotheses import PoseHypothesis, Scene, scene_of
from courseware.lessons.kit.live_figure import LiveFigure
from courseware.lessons.kit.panel import Choice, Drawing, Panel, Slider
from courseware.lessons.kit.room_data import MatchingScene, room_map, room_scenes
from courseware.lessons.lesson_18.figures import RING, SIGMAS, laid_on_the_map
from courseware.lessons.lesson_18.scenes import mirrored, thinned
from courseware.plots import figures
from courseware.plots.panorama_drawing import class_style
from courseware.plots.room_figures import map_axes

ROOM, MIRROR = "the room", "its mirror image"
SHOWN_RANKS, MAX_HIDDEN = 6, 8  # each pair of photographs shows eleven objects or more
PAIRS = ("08_a", "07_b", "06_a", "10_a")
CONTROLS = [
    Slider("rank", "pose, by rank", 1, SHOWN_RANKS, 1, 1),
    Slider("hidden", "farthest objects hidden", 0, MAX_HIDDEN, 0, 1),
    Choice("photographs", "pair of photographs", PAIRS, PAIRS[0]),
    Choice("map_name", "map", (ROOM, MIRROR), ROOM),
]
TERMS = ("places", "colours", "seen", "missed", "free space")
MIN_NATS, MAX_NATS, MAX_SIGMAS = -45.0, 130.0, 5.0  # of the axes; what is beyond is drawn at the edge
CIRCLE = SIGMAS * np.stack([np.cos(np.linspace(0, 2 * np.pi, 33)), np.sin(np.linspace(0, 2 * np.pi, 33))])


@functools.lru_cache(maxsize=64)
def ranked(photographs: str, map_name: str, hidden: int) -> tuple[MatchingScene, Scene, tuple[PoseHypothesis, ...]]:
    """Return a scene without its farthest objects, the same as arrays, and every pose that explains it, best first."""
    scene = room_scenes()[photographs]
    ranges = [np.hypot(one.x, one.y) for one in scene.observations]
    scene = thinned(scene, np.sort(np.argsort(ranges, kind="stable")[: len(ranges) - hidden]))
    semantic_map = room_map() if map_name == ROOM else mirrored(room_map())
    poses = rank_poses(scene.observations, semantic_map, n=99)  # more than there ever are
    return scene, scene_of(scene.observations, semantic_map), poses


def score_terms(scene: Scene, found: PoseHypothesis) -> tuple[dict[str, float], np.ndarray]:
    """Return one of `TERMS` -> nats, which add up to the score, and how many sigmas each match is off."""
    pose, (i, j) = np.array(found.pose)[None], np.array(found.pairs).T
    squared, log_size = (values[0] for values in evidence.place_distances(scene, pose))
    places = (squared[i, j] + log_size[i]) / 2 + np.log(2 * np.pi * evidence.CLUTTER_DENSITY)
    chance = evidence.detection_probabilities(scene.semantic_map, pose)[0]
    missed = np.log(1 - np.delete(chance, j)).sum()
    colours = evidence.colour_costs(scene)[i, j].sum()
    blocked = evidence.free_space_costs(scene.semantic_map, pose)[0]
    values = (-places.sum(), -colours, np.log(chance[j]).sum(), missed, 0.0 - blocked)
    return dict(zip(TERMS, map(float, values), strict=True)), np.sqrt(squared[i, j])


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
    right_style, wrong_style = {"color": figures.GREEN}, {"color": figures.VERMILION}
    matches = [LineCollection([], **right_style, lw=2.6), LineCollection([], **wrong_style, lw=2.0, linestyles="--")]
    ellipses = LineCollection([], linewidths=1.1)
    for one in (*matches, ellipses):
        plan.add_collection(one)
    square = {"marker": "s", "mfc": "none", "mec": figures.VERMILION}
    dot = {"marker": "o", "color": figures.BLACK, "markersize": 8}
    (places,) = plan.plot([], [], "x", color="0.2", markersize=7, markeredgewidth=1.6)
    (missed,) = plan.plot([], [], linestyle="none", **square, markersize=17, markeredgewidth=1.4)
    (truth,) = plan.plot([], [], linestyle="none", **(RING | {"markersize": 14}), markeredgewidth=1.6)
    (robot,) = plan.plot([], [], **dot, linewidth=2.4, markevery=[0], solid_capstyle="butt")
    plan.set(xlim=(-1.0, 6.2), ylim=(-1.1, 6.1))
    for name, style in {"this pose": dot, "true pose": RING, "should be seen, and is not": square | {"ms": 11}}.items():
        plan.plot([], [], linestyle="none", label=name, **style)
    plan.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), fontsize=8, frameon=False)
    # Bars, the first name on top, as thick lines, which a live figure moves cheaply.
    names = [*TERMS, "score"]
    colours = [figures.BLUE] * len(TERMS) + [figures.BLACK]
    bars = terms.add_collection(LineCollection([], linewidths=9, capstyle="butt", colors=colours))
    terms.axvline(0, color="0.3", linewidth=0.8)
    terms.set(title="The parts of its score", xlabel="score [nats]", ylabel="evidence")
    terms.set(ylim=(len(names) - 0.4, -0.6), xlim=(MIN_NATS, MAX_NATS), yticks=range(len(names)), yticklabels=names)
    dots = residuals.plot([], [], "o", **right_style, markersize=6, label="right")
    dots += residuals.plot([], [], "X", **wrong_style, markersize=8, label="wrong")
    residuals.axhline(SIGMAS, color="0.5", linewidth=0.8, linestyle=":")
    residuals.set(title="How far each match is off", xlabel="match [-]", ylabel="distance [sigmas]")
    residuals.set(xlim=(0.3, 14.7), ylim=(0, MAX_SIGMAS))
    residuals.legend(loc="upper right", fontsize=7, ncols=2)
    live = LiveFigure(figure, [ellipses, *matches, *landmarks.values(), places, missed, truth, robot, bars, *dots])

    def draw(rank: float, hidden: float, photographs: str, map_name: str) -> Drawing:
        scene, arrays, poses = ranked(photographs, map_name, int(hidden))
        semantic_map, k = arrays.semantic_map, min(int(rank), len(poses)) - 1
        chosen, (x, y, theta) = poses[k], poses[k].pose
        for label, line in landmarks.items():
            line.set_data(*semantic_map.positions[[one == label for one in semantic_map.labels]].T)
        seen, spread = laid_on_the_map(arrays, chosen.pose)
        places.set_data(*seen.T)
        ellipses.set_segments(list(np.swapaxes(np.linalg.cholesky(spread) @ CIRCLE, 1, 2) + seen[:, None]))
        ellipses.set_color([class_style(one.label)[0] for one in scene.observations])
        missed.set_data(*semantic_map.positions[list(chosen.missed)].reshape(-1, 2).T)
        truth.set_data(*([[v] for v in scene.pose[:2]] if map_name == ROOM else ([], [])))
        robot.set_data([x, x + 0.5 * np.cos(theta)], [y, y + 0.5 * np.sin(theta)])
        values, off = score_terms(arrays, chosen)
        lengths = np.clip([*values.values(), chosen.score], MIN_NATS, MAX_NATS)
        bars.set_segments([[(0, row), (length, row)] for row, length in enumerate(lengths)])
        # In the mirror no match is right: there the robot is nowhere.
        right = np.array([map_name == ROOM and scene.true_landmarks[i] == j for i, j in chosen.pairs])
        ends = np.array([(seen[i], semantic_map.positions[j]) for i, j in chosen.pairs])
        for lines, points, shown in zip(matches, dots, (right, ~right), strict=True):
            lines.set_segments(list(ends[shown]))
            points.set_data(1 + np.argsort(np.argsort(off))[shown], np.minimum(off[shown], 0.97 * MAX_SIGMAS))
        sum_of_terms = ", ".join(f"{name} {value:.1f}" for name, value in values.items() if value)
        nothing = max(0.0, 1 - sum(one.share for one in poses))
        summary = (
            f"pose {k + 1} of {len(poses)}: ({x:.2f}, {y:.2f}) m, {np.degrees(theta):.0f} degrees; "
            f"{len(right)} of {len(seen)} objects matched, {int((~right).sum())} of them wrongly\n"
            f"score {chosen.score:.1f} = {sum_of_terms}\n"
            f'share {chosen.share:.1%}, "none of these" {nothing:.1%}; '
            f"confidence of pose 1 is {confidence_of(poses[0]):.2f}, and 0.80 is needed"
        )
        alt = (
            f"The map from above with {len(seen)} objects as one pose lays them on it, lines to the landmarks they are "
            f"taken for, bars of its score and a dot for every match's distance. {' '.join(summary.splitlines())}"
        )
        return Drawing(live.png(), alt, summary)

    def go(by: int):
        return lambda values: values | {"rank": float(np.clip(values["rank"] + by, 1, SHOWN_RANKS))}

    return Panel("18 poses by rank", CONTROLS, draw, actions={"Better": go(-1), "Worse": go(+1)})


PANELS = {"18 poses by rank": hypotheses_panel}
