"""Small panoramas for tests: textured walls and boards ray-cast in NumPy, seen by two cameras on one vertical axis.

Everything is a vertical plane, so a pixel's colour is exact and nothing depends on a graphics library. The world frame
is the upper camera's: origin at its centre, x forward, y left, z up. Two scenes: eight boards for the tests of matching
(`scene`), five and their map for poses (`mapped_scene`).
"""

import math
from collections import namedtuple
from dataclasses import dataclass, replace
from functools import cache

import cv2
import numpy as np

from course_lib.spherical_stereo.detection.detected_object import Detection
from course_lib.spherical_stereo.drawn_boxes import StereoBoxes
from course_lib.spherical_stereo.panorama import View, direction_to_pixel, open_view, pixel_to_direction
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D
from course_lib.spherical_stereo.semantic_map.semantic_map import Landmark, SemanticMap

WIDTH, HEIGHT = 512, 256
BASELINE = 0.3


@dataclass(frozen=True)
class Board:
    """A textured upright rectangle that faces the rig's axis: where it is and what is on it."""

    label: str
    azimuth: float  # of its middle, radians
    range: float  # of its middle from the axis, metres, horizontal
    width: float  # metres
    bottom: float  # z of its lower edge, metres
    top: float
    texture: np.ndarray

    def corners(self):
        across = np.array([-np.sin(self.azimuth), np.cos(self.azimuth), 0.0]) * self.width / 2
        middle = self.range * np.array([np.cos(self.azimuth), np.sin(self.azimuth), 0.0])
        return [middle + s * across + [0, 0, z] for s in (-1, 1) for z in (self.bottom, self.top)]


Seen = namedtuple("Seen", "label box")  # a detection as `match_objects` needs it


def blotches(rng, size=24, contrast=70):
    """A random texture without repetition, BGR float."""
    noise = rng.normal(size=(size, size, 3)).astype(np.float32)
    return np.clip(128 + contrast * cv2.resize(noise, (16 * size, 16 * size), interpolation=cv2.INTER_CUBIC), 0, 255)


def room_walls(texture, half=4.0, bottom=-1.5, top=1.5):
    """Four walls around the rig."""
    return [Board("wall", k * np.pi / 2, half, 2 * half, bottom, top, texture) for k in range(4)]


def pixel_directions(width, height):
    u, v = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
    return pixel_to_direction(np.stack([u, v], axis=-1), width, height)


def panorama(boards, camera_z=0.0):
    """What a camera on the axis at height `camera_z` sees, uint8 BGR; grey where there is nothing."""
    w, h = 2 * WIDTH, 2 * HEIGHT
    direction = pixel_directions(w, h)
    image = np.full((h, w, 3), 110, np.float32)
    nearest = np.full((h, w), np.inf)
    azimuth = np.arctan2(direction[0, :, 1], direction[0, :, 0])
    for board in boards:
        # Only the columns that can show the board: the whole scene then takes half a second.
        columns = np.cos(azimuth - board.azimuth) >= board.range / np.hypot(board.range, board.width / 2) - 1e-9
        part = direction[:, columns]
        facing = part[..., 0] * np.cos(board.azimuth) + part[..., 1] * np.sin(board.azimuth)
        t = board.range / facing
        across = t * (part[..., 1] * np.cos(board.azimuth) - part[..., 0] * np.sin(board.azimuth))
        s, r = 0.5 - across / board.width, (board.top - camera_z - t * part[..., 2]) / (board.top - board.bottom)
        hit = (s >= 0) & (s < 1) & (r >= 0) & (r < 1) & (t < nearest[:, columns])
        size = np.array(board.texture.shape[1::-1]) - 1
        grid = [np.where(hit, a, 0).astype(np.float32) for a in (s * size[0], r * size[1])]
        image[:, columns] = np.where(
            hit[..., None], cv2.remap(board.texture, *grid, cv2.INTER_LINEAR), image[:, columns]
        )
        nearest[:, columns] = np.where(hit, t, nearest[:, columns])
    return cv2.resize(image, (WIDTH, HEIGHT), interpolation=cv2.INTER_AREA).astype(np.uint8)


def seen_turned(image, turn):
    """What a camera turned by a small vector (radians about x, y, z) sees of a panorama, by resampling it."""
    rays = pixel_directions(WIDTH, HEIGHT) @ cv2.Rodrigues(np.array(turn, float))[0].T
    place = direction_to_pixel(rays, WIDTH, HEIGHT) - 0.5 + [8, 0]
    wide = np.concatenate([image[:, -8:], image, image[:, :8]], axis=1)  # across the seam
    maps = (place[..., i].astype(np.float32) for i in (0, 1))
    return cv2.remap(wide, *maps, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)


def box_of(board, camera_z=0.0):
    """The box around a board, edge coordinates; u_max passes the width at the seam."""
    edges = [np.asarray(c) - [0, 0, camera_z] for c in board.corners()]
    # A wide board bulges: its middle is nearer than its corners.
    middle = board.range * np.array([np.cos(board.azimuth), np.sin(board.azimuth), 0])
    edges += [np.add(middle, [0, 0, z - camera_z]) for z in (board.bottom, board.top)]
    u, v = direction_to_pixel(np.array(edges), WIDTH, HEIGHT).T
    centre = direction_to_pixel(middle, WIDTH, HEIGHT)[0]
    offset = (u - centre + WIDTH / 2) % WIDTH - WIDTH / 2
    u_min = (centre + offset.min()) % WIDTH
    return (float(u_min), float(v.min()), float(u_min + offset.max() - offset.min()), float(v.max()))


def detections(boards, camera_z=0.0):
    return [Seen(board.label, box_of(board, camera_z)) for board in boards]


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
        Board("chair", 1.30, 2.0, 0.9, -1.0, 0.0, np.tile(blotches(rng, 12)[::3, ::3], (3, 3, 1))),
        Board("table", np.pi - 0.05, 2.2, 1.5, -1.0, -0.2, blotches(rng)),
        Board("table", 2.10, 2.4, 1.2, -1.0, -0.2, blotches(rng)),
        Board("sofa", -0.90, 2.5, 1.3, -1.1, -0.2, alike),
        Board("sofa", -1.70, 2.0, 1.2, -1.1, -0.2, alike),
        Board("cabinet", -2.50, 2.3, 0.9, -1.2, 0.4, blotches(rng)),
    ]
    everything = boards + room_walls(blotches(rng, 40))
    upper, lower = panorama(everything), panorama(everything, -BASELINE)
    return boards, upper, lower, detections(boards), detections(boards, -BASELINE)[::-1]


ROOM = SemanticMap(
    [
        Landmark("sofa", 0.5, 0.5, 210, 55),
        Landmark("sofa", 5.5, 1.0, 30, 54),
        Landmark("chair", 3.0, 4.0, 30, 60),
        Landmark("television", 1.0, 5.5, math.nan, 3),
        Landmark("potted plant", 5.0, 5.5, 110, 65),
    ]
)
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
    """A board as a rig that was moved by (x, y) metres sees it: facing the rig."""
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


def boxes_of(upper: View, lower: View) -> StereoBoxes:
    """The detections of two views as boxes drawn by hand."""
    return StereoBoxes(upper.size, upper.detections, lower.detections)


class KnowingDetector:
    """Gives the detections of images that it was told; nothing in any other."""

    def __init__(self, *pairs):
        self._known = [(image, seen) for upper, lower, a, b in pairs for image, seen in ((upper, a), (lower, b))]

    def detect(self, image):
        return next((seen for known, seen in self._known if np.array_equal(known, image)), [])
