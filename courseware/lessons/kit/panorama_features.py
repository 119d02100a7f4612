"""Load pairs of panoramas of the room with exact boxes and features, for lessons 13 and 14."""

import functools
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from course_lib.spherical_stereo.detection.detected_object import Detection
from course_lib.spherical_stereo.matching.features import PanoramaFeatures, detect_features
from course_lib.spherical_stereo.panorama import StereoRig, View, open_view
from courseware.experiments.room import exact_detections
from courseware.lessons.kit.room_photographs import pair_of, room_recording


class Side(NamedTuple):
    """One panorama `(H, W, 3)` uint8 BGR, its objects with exact boxes, their rows in the map, and its features."""

    image: np.ndarray
    objects: list[Detection]
    numbers: list[int]
    features: PanoramaFeatures

    def view(self, objects: Sequence[Detection] | None = None) -> View:
        """Return the panorama in the library's form. objects: detections that replace its own."""
        chosen = self.objects if objects is None else objects
        return open_view(self.image).replace(detections=chosen, features=self.features)


class Scene(NamedTuple):
    """The two panoramas of one place."""

    upper: Side
    lower: Side
    rig: StereoRig


@functools.lru_cache(maxsize=8)
def scene(name: str = "09_a") -> Scene:
    """Return one place of the room with its features. The first call takes half a second.

    In 09_a, a chair stands before another, and a table lies across the seam.
    """
    recording = room_recording(2)
    pair = pair_of(recording, name)
    views = [
        Side(image, *exact_detections(things, image), detect_features(image))
        for image, things in zip(pair.images(), (pair.upper_objects, pair.lower_objects), strict=True)
    ]
    return Scene(*views, recording.rig)
