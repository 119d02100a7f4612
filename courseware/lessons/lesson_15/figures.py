"""Figures of lesson 15: the two centroids, the terms of eq. (1), the sofas."""

import numpy as np
from matplotlib.figure import Figure

from courseware.lessons.kit.display import described
from courseware.lessons.kit.room_data import MatchingScene, room_map
from courseware.lessons.lesson_15.scores import SOFAS
from courseware.plots import figures
from courseware.plots.panorama_drawing import class_style
from courseware.plots.room_figures import map_axes


def centroids_figure(scene: MatchingScene) -> Figure:
    """Draw the observed objects in the body frame and the map, each with its centroid and the distances to it."""
    figure, (body, world) = figures.new_figure(1, 2, size=(10.0, 4.4))
    observed = np.array([[one.y, one.x] for one in scene.observations])
    labels = np.array([one.label for one in scene.observations])
    for label in dict.fromkeys(labels):
        colour, marker = class_style(label)
        body.plot(*observed[labels == label].T, linestyle="none", marker=marker, color=colour, markersize=9)
    map_axes(world, room_map(), "The map, world frame")
    for axes, places, name in ((body, observed, "x_G.camera"), (world, room_map().positions, "x_G.map")):
        for place in places:
            axes.plot(*np.stack([places.mean(axis=0), place]).T, color="0.6", linewidth=0.9, zorder=1)
        style = {"color": figures.BLACK, "markersize": 16, "markeredgewidth": 2.2}
        axes.plot(*places.mean(axis=0), "+", **style, label=name)
    body.plot(0, 0, marker=(3, 0, 0), color=figures.BLACK, markersize=11, linestyle="none", label="camera")
    body.set(title="Observed, body frame (forward is up)", xlabel="y, left [m]", ylabel="x, forward [m]")
    body.set(aspect="equal")
    body.invert_xaxis()
    body.legend(loc="lower left", fontsize=8)
    world.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8, frameon=False)
    return described(
        figure,
        "Thirteen objects around the camera in its own frame, and the fourteen of the map; from each object a line to "
        "the centroid of its side. The two stars of lines look alike, but turned.",
    )


def terms_figure(scene: MatchingScene, terms: dict[str, np.ndarray]) -> Figure:
    """Draw four tables `(n_observations, n_landmarks)`, hatched from 10 on. The right landmarks have a dot."""
    figure, axes = figures.new_figure(2, 2, size=(9.6, 8.2))
    order = np.argsort(scene.true_landmarks)  # so that the right combinations lie near the diagonal
    shows = [scene.true_landmarks[i] for i in order]
    for k, (a, (title, table)) in enumerate(zip(axes.flat, terms.items(), strict=True)):
        shown = np.ma.masked_greater(table[order], 10)  # unlike classes, which would fill the table with one colour
        image = a.imshow(shown, cmap="plasma", vmin=0, vmax=1, interpolation="nearest", aspect="auto")
        a.patch.set(facecolor="white", edgecolor="0.7", hatch="////", linewidth=0)
        a.plot(shows, np.arange(len(table)), "o", color="white", markersize=4, mec="black", mew=0.6)
        a.grid(False)
        below, left, names = k >= 2, k % 2 == 0, short_names()
        a.set_xticks(range(len(names)), names if below else [""] * len(names), rotation=90, fontsize=9)
        a.set_yticks(range(len(shows)), [names[j] if left else "" for j in shows], fontsize=9)
        a.set(title=title, xlabel="landmark" if below else "", ylabel="observation" if left else "")
    figure.colorbar(image, ax=axes, label="penalty [-], yellow from 1 on, hatched for unlike classes", shrink=0.9)
    return described(
        figure,
        "Four heat maps, two by two: in hue and saturation the three sofas are all alike and dark; in distance bright "
        "columns for landmarks near the centroid; in the total only blocks of like classes are not hatched, "
        "the right darkest.",
    )


def sofas_figure(scene: MatchingScene) -> Figure:
    """Draw the distances to the centroid of the three sofas, of the map and as observed."""
    figure, axes = figures.new_figure(size=(7.4, 2.3))
    on_map, observed = room_map().positions, np.array([one[1:3] for one in scene.observations])
    far_map, far_seen = (np.hypot(*(places - places.mean(axis=0)).T) for places in (on_map, observed))
    for index, j in enumerate(SOFAS):
        style = figures.line_style(index) | {"linestyle": "none", "markersize": 9}
        axes.plot(far_map[j], 1, **style, label=f"sofa {j + 1}")
        axes.plot(far_seen[scene.true_landmarks.index(j)], 0, **style)
    axes.set(title="Sofas: how far from the centroid", xlabel="distance to the centroid [m]", ylim=(-0.5, 1.5))
    axes.set_yticks([0, 1], ["observed", "map"])
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return described(
        figure,
        "On a line of distances to the centroid: on the map sofa 2 at 2.35, sofa 1 at 2.63, sofa 3 at 3.44 metres; "
        "observed, sofas 1 and 2 lie nearly on one another at 2.3 metres.",
    )


def short_names() -> list[str]:
    """Return the names of the map's landmarks in a figure, numbered from 1, such as "sofa 2"."""
    short = {"television": "TV", "potted plant": "plant", "refrigerator": "fridge"}
    return [f"{short.get(label, label)} {j}" for j, label in enumerate(room_map().labels, start=1)]
