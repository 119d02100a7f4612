"""Two small scenes, seen by both cameras: eight boards for the tests of matching, five and their map for poses."""

import math
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


@cache
def mapped_scene() -> tuple[View, View, SemanticMap]:
    """Two small panoramas of five textured boards with their exact boxes, and the map of the boards."""
    rng = np.random.default_rng(3)
    boards = [Board(*one, blotches(rng)) for one in MAPPED]
    everything = [*room_walls(blotches(rng, size=48)), *boards]
    views = []
    for camera in (0.0, -BASELINE):
        found = [
            Detection(board.label, 0.9, box_of(board, camera), hue, 50.0)
            for board, hue in zip(boards, HUES, strict=True)
        ]
        views.append(open_view(panorama(everything, camera)).replace(detections=found))
    places = TRUE_POSE.apply([[b.range * math.cos(b.azimuth), b.range * math.sin(b.azimuth)] for b in boards])
    landmarks = [Landmark(b.label, *place, hue, 50.0) for b, place, hue in zip(boards, places, HUES, strict=True)]
    return *views, SemanticMap(landmarks)
