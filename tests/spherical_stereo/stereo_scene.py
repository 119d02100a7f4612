"""Two small scenes, seen by both cameras: eight boards for the tests of matching, five and their map for poses."""

import math
from dataclasses import replace
from functools import cache

import numpy as np

from course_lib.spherical_stereo.detection.detected_object import Detection
from course_lib.spherical_stereo.panorama import View, open_view
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D
from course_lib.spherical_stereo.semantic_map.semantic_map import Landmark, SemanticMap
from tests.spherical_stereo.vertical_pair import (
    BASELINE,
    Board,
    blotches,
    box_of,
    detections,
    panorama,
    room_walls,
    tiled,
)


@cache
def scene():
    """(boards, upper image, lower image, upper detections, lower detections); the lower ones in another order.

    Two sofas look exactly alike, one chair's texture repeats itself, one table stands across the seam, and the chair
    behind the first is partly hidden by it.
    """
    rng = np.random.default_rng(7)
    alike = blotches(rng)
    boards = [
        Board("chair", 0.30, 1.6, 0.7, -1.0, -0.1, blotches(rng)),
        Board("chair", 0.52, 2.6, 0.9, -1.0, 0.2, blotches(rng)),
        Board("chair", 1.30, 2.0, 0.9, -1.0, 0.0, tiled(blotches(rng, 12), 3)),
        Board("table", np.pi - 0.05, 2.2, 1.5, -1.0, -0.2, blotches(rng)),
        Board("table", 2.10, 2.4, 1.2, -1.0, -0.2, blotches(rng)),
        Board("sofa", -0.90, 2.5, 1.3, -1.1, -0.2, alike),
        Board("sofa", -1.70, 2.0, 1.2, -1.1, -0.2, alike),
        Board("cabinet", -2.50, 2.3, 0.9, -1.2, 0.4, blotches(rng)),
    ]
    everything = boards + room_walls(blotches(rng, 40))
    upper, lower = panorama(everything), panorama(everything, -BASELINE)
    return boards, upper, lower, detections(boards), detections(boards, -BASELINE)[::-1]


MAPPED = [  # label, azimuth, horizontal range, width, bottom, top; the upper camera is the origin
    ("sofa", 0.2, 1.6, 1.2, -0.9, -0.2),
    ("sofa", 2.6, 2.2, 1.3, -0.9, -0.2),
    ("chair", 1.3, 1.4, 0.7, -0.9, -0.1),
    ("television", -1.2, 2.0, 1.1, -0.3, 0.5),
    ("potted plant", -2.3, 1.8, 0.8, -0.8, 0.2),
]
HUES = [210.0, 30.0, 60.0, math.nan, 110.0]
TRUE_POSE = Pose2D(3.0, 2.5, 0.7)


def displaced(board, x, y):
    """A board as a rig sees it that was moved by (x, y) metres; it turns to face the rig."""
    place = board.range * np.exp(1j * board.azimuth) - (x + 1j * y)
    return replace(board, azimuth=float(np.angle(place)), range=float(abs(place)))


@cache
def pair_from(x, y):
    """(upper image, lower image, upper detections, lower detections) of the rig moved by (x, y) metres."""
    rng = np.random.default_rng(3)
    boards = [Board(*one, blotches(rng)) for one in MAPPED]
    walls = room_walls(blotches(rng, size=48))
    boards, walls = ([displaced(one, x, y) for one in side] if x or y else side for side in (boards, walls))
    images, seen = [], []
    for camera in (0.0, -BASELINE):
        images.append(panorama([*walls, *boards], camera))
        boxes = [(board.label, box_of(board, camera)) for board in boards]
        seen.append([Detection(label, 0.9, box, hue, 50.0) for (label, box), hue in zip(boxes, HUES, strict=True)])
    return *images, *seen


@cache
def mapped_scene() -> tuple[View, View, SemanticMap]:
    """Two small panoramas of five textured boards with their exact boxes, and the map of the boards."""
    upper, lower, *seen = pair_from(0.0, 0.0)
    views = [open_view(image).replace(detections=found) for image, found in zip((upper, lower), seen, strict=True)]
    places = TRUE_POSE.apply([[one[2] * math.cos(one[1]), one[2] * math.sin(one[1])] for one in MAPPED])
    landmarks = [Landmark(one[0], *place, hue, 50.0) for one, place, hue in zip(MAPPED, places, HUES, strict=True)]
    return *views, SemanticMap(landmarks)


class KnowingDetector:
    """Gives the detections of images that it was told; nothing in any other."""

    def __init__(self, *pairs):
        self._known = [(image, seen) for upper, lower, a, b in pairs for image, seen in ((upper, a), (lower, b))]

    def detect(self, image):
        return next((seen for known, seen in self._known if np.array_equal(known, image)), [])
