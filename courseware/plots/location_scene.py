"""A localization on the semantic map in three dimensions: landmarks, rays, the places they end at, and the pose."""

from __future__ import annotations

import unicodedata
from typing import TYPE_CHECKING

import numpy as np

from course_lib.spherical_stereo.pose.localization import Localization
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D, rotation_2d
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap
from courseware.plots.figures import BLACK, BLUE, ORANGE, VERMILION
from courseware.plots.panorama_drawing import class_style
from courseware.plots.scenes import body_axes, ellipsoid, new_plotter, path, post, text

if TYPE_CHECKING:
    import pyvista

_SIGMAS = 3
_BELOW = 1.2  # metres below the upper camera that are shown where no object was placed lower (chosen)
_LETTERS = 0.16  # metres
_LETTER_WIDTH = 0.75  # of a letter's height, in the mean
_AXES = 0.6


def location_scene(
    semantic_map: SemanticMap, found: Localization, true_pose: np.ndarray | None = None
) -> tuple[pyvista.Plotter, str]:
    """Return the scene, and in a sentence what it shows; heights are measured from the upper camera.

    Landmarks are posts, since the map says nothing of heights. true_pose: `(3,)` [x, y, theta], where it is known.
    """
    heights = [one.position[2] for one in found.objects if one.observation is not None]
    floor = min([-_BELOW, *heights])
    low, high = semantic_map.positions.min(axis=0), semantic_map.positions.max(axis=0)
    size = max(3.0, float((high - low).max()))
    focus = np.array([*(low + high) / 2, floor / 2])
    plotter = new_plotter(focus + size * np.array([-0.3, -1.5, 2.6]), focus)
    if semantic_map.walls is not None:
        corners = np.column_stack([semantic_map.walls, np.full(len(semantic_map.walls), floor)])
        plotter.add_mesh(path(np.vstack([corners, corners[:1]])), color="grey", line_width=2)
    labels = {label: _in_ascii(label, number) for number, label in enumerate(dict.fromkeys(semantic_map.labels), 1)}
    boxes: list[np.ndarray] = []  # of the names: low and high corner
    for landmark in sorted(semantic_map.landmarks, key=lambda one: -one.y):
        colour, name = class_style(landmark.label)[0], labels[landmark.label]
        foot = np.array([landmark.x, landmark.y, floor])
        plotter.add_mesh(post(foot, -floor), color=colour)
        # A name lies on top of its post, or as far before it as keeps it clear of the others.
        box = foot[:2] + np.array([[0.08, -0.5], [0.08 + _LETTER_WIDTH * len(name) * _LETTERS, 0.5]]) * [1, _LETTERS]
        while any((box[0] < high).all() and (low < box[1]).all() for low, high in boxes):
            box = box - [0.0, 0.25 * _LETTERS]
        boxes.append(box)
        plotter.add_mesh(text(name, np.array([*box[0], 0.02]), _LETTERS), color=BLACK)
    words = "Landmarks: posts with their class"
    if true_pose is not None:
        x, y, theta = true_pose
        plotter.add_mesh(body_axes(np.array([x, y, 0.0, 0.0, 0.0, theta]), 0.5 * _AXES), color=BLACK)
        words += "; true pose: short black axes"
    pose = found.pose or found.rejected_pose
    if pose is None:
        return plotter, f"{words}; no pose, {found.reason}"
    _add_places(plotter, semantic_map, found, pose)
    plotter.add_mesh(body_axes(np.array([pose.x, pose.y, 0.0, 0.0, 0.0, pose.theta]), _AXES), rgb=True)
    if found.covariance is not None:
        plotter.add_mesh(_disc([pose.x, pose.y, 0.0], found.covariance[:2, :2]), color=ORANGE, opacity=0.5)
    words += f"; {'pose' if found.pose else 'rejected pose'}: coloured axes; rays to the measured places, discs of "
    return plotter, f"{words}{_SIGMAS} standard deviations, blue lines to the landmarks they were taken for"


def _in_ascii(label: str, number: int) -> str:
    """A label in the letters that a scene's text has, without accents; a number in brackets for another script."""
    return unicodedata.normalize("NFKD", label).encode("ascii", "ignore").decode().strip() or f"[{number}]"


def _add_places(plotter: pyvista.Plotter, semantic_map: SemanticMap, found: Localization, pose: Pose2D) -> None:
    """Rays from a pose to the observed objects, their ellipses, and the lines to their landmarks."""
    camera, landmark_of = np.array([pose.x, pose.y, 0.0]), dict(found.used_pairs)
    for one in found.objects:
        if one.observation is None:
            continue
        observation = found.observations[one.observation]
        place = np.array([*pose.apply([[observation.x, observation.y]])[0], one.position[2]])
        colour = class_style(one.label)[0]
        plotter.add_mesh(path(np.stack([camera, place])), color="dimgrey", line_width=1)
        if observation.covariance is not None:
            turn = rotation_2d(pose.theta)
            plotter.add_mesh(_disc(place, turn @ observation.covariance @ turn.T), color=colour, opacity=0.5)
        if one.observation in landmark_of:
            landmark = np.array([*semantic_map.positions[landmark_of[one.observation]], place[2]])
            colour = BLUE if found.pose else VERMILION
            plotter.add_mesh(path(np.stack([place, landmark])), color=colour, line_width=4)


def _disc(middle: np.ndarray, covariance: np.ndarray) -> pyvista.PolyData:
    """The error ellipse of a place in the plane, `(2, 2)` square metres, at its height."""
    flat = np.zeros((3, 3))
    flat[:2, :2] = covariance
    return ellipsoid(middle, flat, _SIGMAS)
