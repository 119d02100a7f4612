"""Small panoramas for tests: textured walls and boards ray-cast in NumPy, seen by two cameras on one vertical axis.

Everything is a vertical plane, so a pixel's colour is exact and nothing depends on a graphics library. The world frame
is the upper camera's: origin at its centre, x forward, y left, z up.
"""

from dataclasses import dataclass

import cv2
import numpy as np

from course_lib.spherical_stereo.panorama import direction_to_pixel, pixel_to_direction

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


@dataclass(frozen=True)
class Seen:
    """A detection as `match_objects` needs it."""

    label: str
    box: tuple[float, float, float, float]


def blotches(rng, size=24, contrast=70):
    """A random texture without repetition, BGR float."""
    noise = rng.normal(size=(size, size, 3)).astype(np.float32)
    return np.clip(128 + contrast * cv2.resize(noise, (16 * size, 16 * size), interpolation=cv2.INTER_CUBIC), 0, 255)


def tiled(texture, times):
    """A texture repeated from left to right and from top to bottom."""
    return np.tile(
        cv2.resize(texture, None, fx=1 / times, fy=1 / times, interpolation=cv2.INTER_AREA), (times, times, 1)
    )


def room_walls(texture, half=4.0, bottom=-1.5, top=1.5):
    """Four walls around the rig."""
    return [Board("wall", k * np.pi / 2, half, 2 * half, bottom, top, texture) for k in range(4)]


def panorama(boards, camera_z=0.0, width=WIDTH, supersampling=2):
    """What a camera on the axis at height `camera_z` sees, uint8 BGR; grey where there is nothing."""
    w, h = width * supersampling, width // 2 * supersampling
    u, v = np.meshgrid(np.arange(w) + 0.5, np.arange(h) + 0.5)
    direction = pixel_to_direction(np.stack([u, v], axis=-1), w, h)
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
    return cv2.resize(image, (width, width // 2), interpolation=cv2.INTER_AREA).astype(np.uint8)


def seen_turned(image, turn):
    """What a camera turned by a small vector (radians about x, y, z) sees of a panorama, by resampling it."""
    height, width = image.shape[:2]
    u, v = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
    rays = pixel_to_direction(np.stack([u, v], axis=-1), width, height) @ cv2.Rodrigues(np.array(turn, float))[0].T
    place = direction_to_pixel(rays, width, height) - 0.5 + [8, 0]
    wide = np.concatenate([image[:, -8:], image, image[:, :8]], axis=1)  # across the seam
    maps = (place[..., i].astype(np.float32) for i in (0, 1))
    return cv2.remap(wide, *maps, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)


def box_of(board, camera_z=0.0, width=WIDTH):
    """The box around a board, edge coordinates; u_max passes the width at the seam."""
    edges = [np.asarray(c) - [0, 0, camera_z] for c in board.corners()]
    # A wide board bulges: its middle is nearer than its corners.
    middle = board.range * np.array([np.cos(board.azimuth), np.sin(board.azimuth), 0])
    edges += [np.add(middle, [0, 0, z - camera_z]) for z in (board.bottom, board.top)]
    u, v = direction_to_pixel(np.array(edges), width, width // 2).T
    centre = direction_to_pixel(middle, width, width // 2)[0]
    offset = (u - centre + width / 2) % width - width / 2
    u_min = (centre + offset.min()) % width
    return (float(u_min), float(v.min()), float(u_min + offset.max() - offset.min()), float(v.max()))


def detections(boards, camera_z=0.0, width=WIDTH):
    return [Seen(b.label, box_of(b, camera_z, width)) for b in boards if b.label != "wall"]
