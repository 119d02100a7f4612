"""Lesson 15, semantic map matching: the room's objects from exact boxes, what the penalty makes of them, figures."""

from __future__ import annotations

import functools
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from course_lib.experiments.room import PairResult, run_experiment
from course_lib.geometry import wrap_angle
from course_lib.lessons.kit.paths import data_path
from course_lib.lessons.lesson_15.penalty_panel import MatchingScene, penalty_panel, short_name
from course_lib.plots import figures
from course_lib.plots.panorama_drawing import class_style
from course_lib.plots.room_figures import map_axes
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D, RigidFitError, fit_rigid_2d
from course_lib.spherical_stereo.recording import read_stereo_recording
from course_lib.spherical_stereo.semantic_map.association import Observation, PenaltyWeights, associate_greedy
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

PAIR = "03_b"  # thirteen of fourteen objects in view, nothing special (chosen)
SOFAS = (0, 1, 2)  # their lines in the map


class Score(NamedTuple):
    """How a matcher did on all pairs of photographs of an experiment."""

    poses_right: int
    """Pairs of photographs in which every observation got its landmark."""
    poses: int
    pairs_right: int
    pairs: int
    sofas_right: int
    sofas: int
    unlike: int
    """Pairs of unlike classes."""


class HiddenScore(NamedTuple):
    """How the matcher did with some of the objects hidden at random."""

    share_right: float
    """Share of trials in which every observation got its landmark."""
    wrong: int
    """Wrong pairs in all trials."""
    wrong_sofas: int
    """Of them, those that took a sofa for another."""
    error_right: float
    """Metres: median error of the fitted position where all pairs were right."""
    error_wrong: float
    """Metres: the same where not."""


@functools.cache
def room_map() -> SemanticMap:
    """The map of the experiment's room."""
    return SemanticMap.load(data_path("room/semantic_map.json"))


@functools.cache
def room_scenes(experiment: int = 1) -> dict[str, MatchingScene]:
    """Name of a pair of photographs -> its observations, from exact boxes: no network takes part."""
    recording = read_stereo_recording(data_path(f"room/experiment_{experiment}"))
    results = run_experiment(
        recording, SemanticLocalizer(recording.rig, room_map(), reject_implausible=False), "exact_boxes"
    )
    rng = np.random.default_rng(15)
    return {result.pair.name: _scene(result, rng) for result in results}


def _scene(result: PairResult, rng: np.random.Generator) -> MatchingScene:
    # Exact boxes come in the order of the map. Among equal penalties the matcher takes the first: it would be told.
    order = rng.permutation(len(result.true_landmarks))
    seen, shows = result.localization.observations, result.true_landmarks
    pose = Pose2D(*(float(value) for value in result.pair.pose))
    return MatchingScene(tuple(seen[k] for k in order), tuple(int(shows[k]) for k in order), pose)


def score(weights: PenaltyWeights, distance_term: str = "absolute") -> Score:
    """The greedy matcher with these weights on the twenty pairs of photographs of experiment 1."""
    poses_right = pairs_right = pairs = sofas_right = sofas = unlike = 0
    scenes = room_scenes().values()
    for scene in scenes:
        found = associate_greedy(scene.observations, room_map(), weights, distance_term)
        right = [scene.true_landmarks[i] == j for i, j in found.pairs]
        of_sofas = [one for one, (i, _) in zip(right, found.pairs, strict=True) if scene.true_landmarks[i] in SOFAS]
        poses_right += all(right)
        pairs_right, pairs = pairs_right + sum(right), pairs + len(right)
        sofas_right, sofas = sofas_right + sum(of_sofas), sofas + len(of_sofas)
        unlike += len(found.pairs) - len(found.usable_pairs)
    return Score(poses_right, len(scenes), pairs_right, pairs, sofas_right, sofas, unlike)


def hidden_score(n_hidden: int, n_trials: int, rng: np.random.Generator) -> HiddenScore:
    """The matcher where `n_hidden` of the objects in view, drawn at random, stay unseen; n_trials a photograph pair."""
    right_trials, wrong_pairs, wrong_sofas = [], 0, 0
    errors: dict[bool, list[float]] = {True: [], False: []}
    for scene in room_scenes().values():
        for _ in range(n_trials):
            kept = np.sort(rng.permutation(len(scene.observations))[n_hidden:])
            seen = [scene.observations[k] for k in kept]
            pairs = associate_greedy(seen, room_map()).usable_pairs
            wrong = [j for i, j in pairs if scene.true_landmarks[kept[i]] != j]
            right_trials.append(not wrong)
            wrong_pairs += len(wrong)
            wrong_sofas += sum(j in SOFAS for j in wrong)
            pose = fitted_pose(seen, pairs)
            if pose is not None:
                errors[not wrong].append(float(np.hypot(pose.x - scene.pose.x, pose.y - scene.pose.y)))
    medians = (float(np.median(errors[kind])) if errors[kind] else np.nan for kind in (True, False))
    return HiddenScore(float(np.mean(right_trials)), wrong_pairs, wrong_sofas, *medians)


def fitted_pose(observations: list[Observation], pairs: tuple) -> Pose2D | None:
    """The pose that these pairs give (lesson 16), or None where they give none."""
    source = np.array([[observations[i].x, observations[i].y] for i, _ in pairs]).reshape(-1, 2)
    try:
        return fit_rigid_2d(source, room_map().positions[[j for _, j in pairs]])
    except RigidFitError:
        return None


def pose_error(scene: MatchingScene, pairs: tuple) -> tuple[float, float]:
    """How far the pose of these pairs is from the true one: metres, degrees."""
    pose = fitted_pose(list(scene.observations), pairs)
    off = np.hypot(pose.x - scene.pose.x, pose.y - scene.pose.y)
    return float(off), float(np.rad2deg(abs(wrap_angle(pose.theta - scene.pose.theta))))


def centroids_figure(scene: MatchingScene) -> Figure:
    """The observed objects in the body frame and the map, each with its centroid and the distances to it."""
    figure, (body, world) = figures.new_figure(1, 2, size=(10.0, 4.4))
    observed = np.array([[one.x, one.y] for one in scene.observations])
    for one in dict.fromkeys(observation.label for observation in scene.observations):
        colour, marker = class_style(one)
        its = np.array([place for place, o in zip(observed, scene.observations, strict=True) if o.label == one])
        body.plot(-its[:, 1], its[:, 0], linestyle="none", marker=marker, color=colour, markersize=9)
    _spokes(body, np.column_stack([-observed[:, 1], observed[:, 0]]), "x_G.camera")
    body.plot(0, 0, marker=(3, 0, 0), color=figures.BLACK, markersize=11, linestyle="none", label="camera")
    body.set(title="Observed, body frame (forward is up)", xlabel="to the right, -y [m]", ylabel="forward, x [m]")
    body.set(aspect="equal")
    body.legend(loc="lower left", fontsize=8)
    map_axes(world, room_map(), "The map, world frame")
    _spokes(world, room_map().positions, "x_G.map")
    world.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8, frameon=False)
    return figure


def _spokes(axes, places: np.ndarray, name: str) -> None:
    centre = places.mean(axis=0)
    for place in places:
        axes.plot(*np.stack([centre, place]).T, color="0.6", linewidth=0.9, zorder=1)
    axes.plot(*centre, "+", color=figures.BLACK, markersize=16, markeredgewidth=2.2, label=name)


def terms_figure(scene: MatchingScene, terms: dict[str, np.ndarray]) -> Figure:
    """Tables `(n_observations, n_landmarks)` side by side; the right landmark of every observation has a dot."""
    figure, axes = figures.new_figure(1, len(terms), size=(10.4, 3.5))
    names = [short_name(label, j) for j, label in enumerate(room_map().labels)]
    order = np.argsort(scene.true_landmarks)  # so that the right combinations lie near the diagonal
    shows = [scene.true_landmarks[i] for i in order]
    for k, (a, (title, table)) in enumerate(zip(axes, terms.items(), strict=True)):
        image = a.imshow(table[order], cmap="cividis", vmin=0, vmax=1, interpolation="nearest", aspect="auto")
        a.plot(shows, np.arange(len(table)), ".", color=figures.VERMILION, markersize=5)
        a.grid(False)
        a.set(title=title, xlabel="landmark [-]", ylabel="observation [-]" if k == 0 else "")
        a.set_xticks(range(len(names)), names, rotation=90, fontsize=6)
        rows = [names[j] for j in shows] if k == 0 else []
        a.set_yticks(range(len(rows)), rows, fontsize=6)
    figure.supylabel(" [-]", fontsize=1, color="white")  # the rows are named once, at the left
    figure.colorbar(image, ax=axes, label="penalty [-], 1 and more: yellow", shrink=0.9)
    return figure


def sofas_figure(scene: MatchingScene) -> Figure:
    """Distance to the centroid: the three sofas of the map, and the observed ones."""
    figure, axes = figures.new_figure(size=(7.4, 2.3))
    on_map, observed = room_map().positions, np.array([[one.x, one.y] for one in scene.observations])
    far_map = np.hypot(*(on_map - room_map().centroid).T)
    far_seen = np.hypot(*(observed - observed.mean(axis=0)).T)
    for index, j in enumerate(SOFAS):
        style = figures.line_style(index) | {"linestyle": "none", "markersize": 9}
        axes.plot(far_map[j], 1, **style, label=f"sofa {j}")
        for i, landmark in enumerate(scene.true_landmarks):
            if landmark == j:
                axes.plot(far_seen[i], 0, **style)
    axes.set(title="Sofas: how far from the centroid", xlabel="distance to the centroid [m]", ylim=(-0.5, 1.5))
    axes.set_yticks([0, 1], ["observed", "map"])
    axes.set_ylabel("side [-]")
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return figure


def weights_panel():
    """The panel of this lesson: weights, the table, and the matching as it grows."""
    return penalty_panel(room_map(), {name: room_scenes()[name] for name in ("03_b", "06_a", "08_a", "10_a")})


PANELS = {"15 penalty weights": weights_panel}
