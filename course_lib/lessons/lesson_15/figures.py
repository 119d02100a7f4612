"""Figures of lesson 15: the two centroids, the terms of eq. (1), the sofas."""

import numpy as np
from matplotlib.figure import Figure

from course_lib.lessons.kit.display import described
from course_lib.lessons.kit.room_observations import MatchingScene
from course_lib.lessons.kit.room_photographs import room_map
from course_lib.lessons.lesson_15.scores import SOFAS
from course_lib.plots import figures
from course_lib.plots.panorama_drawing import class_style
from course_lib.plots.room_figures import map_axes


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
    return described(
        figure,
        "Thirteen objects around the camera in its own frame, and the fourteen of the map; from each object a line to "
        "the centroid of its side. The two stars of lines look alike, but turned.",
    )


def _spokes(axes, places: np.ndarray, name: str) -> None:
    centre = places.mean(axis=0)
    for place in places:
        axes.plot(*np.stack([centre, place]).T, color="0.6", linewidth=0.9, zorder=1)
    axes.plot(*centre, "+", color=figures.BLACK, markersize=16, markeredgewidth=2.2, label=name)


def terms_figure(scene: MatchingScene, terms: dict[str, np.ndarray]) -> Figure:
    """Four tables `(n_observations, n_landmarks)`; the right landmark of every observation has a dot."""
    figure, axes = figures.new_figure(2, 2, size=(9.6, 8.2))
    names = [short_name(label, j) for j, label in enumerate(room_map().labels)]
    order = np.argsort(scene.true_landmarks)  # so that the right combinations lie near the diagonal
    shows = [scene.true_landmarks[i] for i in order]
    for k, (a, (title, table)) in enumerate(zip(axes.flat, terms.items(), strict=True)):
        image = a.imshow(table[order], cmap="cividis", vmin=0, vmax=1, interpolation="nearest", aspect="auto")
        a.plot(shows, np.arange(len(table)), ".", color=figures.VERMILION, markersize=5)
        a.grid(False)
        a.set(title=title, xlabel="landmark [-]", ylabel="observation [-]")
        columns, rows = (names if k >= 2 else [], [names[j] for j in shows] if k % 2 == 0 else [])
        a.set_xticks(range(len(columns)), columns, rotation=90, fontsize=9)
        a.set_yticks(range(len(rows)), rows, fontsize=9)
    figure.colorbar(image, ax=axes, label="penalty [-], 1 and more: yellow", shrink=0.9)
    return described(
        figure,
        "Four heat maps, two by two: in hue and saturation the three sofas are all alike and dark; in distance bright "
        "columns for landmarks near the centroid; in the total only blocks of like classes are dark, "
        "the right darkest.",
    )


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
    return described(
        figure,
        "On a line of distances to the centroid: on the map sofa 1 at 2.35, sofa 0 at 2.63, sofa 2 at 3.44 metres; "
        "observed, sofas 0 and 1 lie nearly on one another at 2.3 metres.",
    )


_SHORT = {"television": "TV", "potted plant": "plant", "refrigerator": "fridge"}


def short_name(label: str, number: int) -> str:
    """Name of a landmark in a figure, such as "sofa 2"."""
    return f"{_SHORT.get(label, label)} {number}"
