"""Places of the room with a turned lower camera, a lower photograph that is a negative, or a plain object."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from course_lib.lessons.kit.panorama_features import Scene
from course_lib.spherical_stereo.detection.detected_object import Detection, wrapped_box
from course_lib.spherical_stereo.matching.features import PanoramaFeatures, detect_features


def turned(features: PanoramaFeatures, columns: float) -> PanoramaFeatures:
    """Move features by so many columns [pixels] around the seam, as a camera that turns about its axis sees them."""
    return replace(features, keypoints=(features.keypoints + np.array([columns, 0.0])) % [features.width, np.inf])


def turned_objects(objects: Sequence[Detection], columns: float, width: int) -> list[Detection]:
    shift = np.array([columns % width, 0, columns % width, 0])
    return [replace(one, box=tuple(wrapped_box(one.box + shift, width))) for one in objects]


def turned_scene(one: Scene, columns: float) -> Scene:
    """Return the same place with its lower camera turned about its axis by so many columns [pixels]."""
    side = one.lower
    objects = turned_objects(side.objects, columns, side.features.width)
    image = np.roll(side.image, round(columns), axis=1)
    return one._replace(lower=side._replace(image=image, objects=objects, features=turned(side.features, columns)))


def negative_scene(one: Scene) -> Scene:
    """Return the same place with a negative below: everything where it was, and nothing looks the same."""
    image = 255 - one.lower.image
    return one._replace(lower=one.lower._replace(image=image, features=detect_features(image)))


def plain_object(image: np.ndarray, box: Sequence[float], margin: int = 25) -> np.ndarray:
    """Return the panorama with a box and a margin [pixels] around it painted in the box's mean colour.

    The margin keeps the edge of the paint, which has features, out of the box. Not for boxes at the seam.
    """
    u_min, v_min, u_max, v_max = (round(edge) for edge in box)
    painted, colour = image.copy(), image[v_min:v_max, u_min:u_max].mean(axis=(0, 1))
    painted[v_min - margin : v_max + margin, u_min - margin : u_max + margin] = colour
    return painted
