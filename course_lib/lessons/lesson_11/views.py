"""Views out of a panorama, the object at its seam, and bearings of the objects against the map."""

from typing import NamedTuple

import cv2
import numpy as np

from course_lib.geometry import wrap_angle
from course_lib.lessons.kit.room_photographs import room_recording, the_pair
from course_lib.lessons.kit.scene import Scene
from course_lib.spherical_stereo.detection.detected_object import box_centre
from course_lib.spherical_stereo.panorama import azimuth_elevation, direction_to_pixel, pixel_to_direction
from course_lib.spherical_stereo.recording import StereoPair, TrueObject
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

SCENE = "scenes/11_sphere.html"
"""Where the scene lies, from the folder notebooks/; `write_sphere_scene` writes it."""


def object_at_the_seam() -> TrueObject:
    """The object whose box passes the width of the panorama."""
    return next(thing for thing in the_pair().upper_objects if thing.visible_box[2] > room_recording(1).width)


def scene() -> Scene:
    """The scene to be dragged in: panorama and sphere."""
    return Scene(SCENE, "A point on a panorama and on the unit sphere: drag it on either", 470)


def look_up(image_bgr: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """The panorama's colours in directions `(H, W, 3)`, also across the seam, `(H, W, 3)` uint8 BGR."""
    height, width = image_bgr.shape[:2]
    uv = (direction_to_pixel(directions, width, height) - 0.5).astype(np.float32)
    wrapped = np.concatenate([image_bgr, image_bgr[:, :1]], axis=1)  # one more column, to interpolate across the seam
    return cv2.remap(wrapped, uv[..., 0] % width, uv[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)


class Bearings(NamedTuple):
    """Azimuths of the map's objects as seen from where the rig stood, degrees, `(n,)` each."""

    labels: list[str]
    measured: np.ndarray
    """From the centre of the exact box on the panorama."""
    from_map: np.ndarray
    """From the map and the true pose."""

    @property
    def error(self) -> np.ndarray:
        """measured - from_map on the circle."""
        return np.degrees(wrap_angle(np.radians(self.measured - self.from_map)))


def bearings(pair: StereoPair, semantic_map: SemanticMap, width: int, height: int) -> Bearings:
    """Box centres on the upper panorama against map and true pose, for every object that is wholly visible."""
    things = [thing for thing in pair.upper_objects if thing.visible_fraction > 0.95]
    centres = box_centre([thing.visible_box for thing in things])
    measured, _ = azimuth_elevation(pixel_to_direction(centres, width, height))
    towards = semantic_map.positions[[thing.number for thing in things]] - pair.pose[:2]
    from_map = wrap_angle(np.arctan2(towards[:, 1], towards[:, 0]) - pair.pose[2])
    return Bearings([thing.label for thing in things], np.degrees(measured), np.degrees(from_map))


def all_bearings(semantic_map: SemanticMap) -> Bearings:
    """`bearings` of every pair of the experiment, one after the other."""
    record = room_recording(1)
    parts = [bearings(pair, semantic_map, record.width, record.height) for pair in record.pairs]
    labels = [label for part in parts for label in part.labels]
    return Bearings(labels, *(np.concatenate([getattr(p, name) for p in parts]) for name in ("measured", "from_map")))
