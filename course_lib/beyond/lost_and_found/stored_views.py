"""Store how a map looks from some thousands of places, so that a frame can be compared with all of them.

Gravity is known, so a camera at a place can only be turned about the vertical. Therefore one image of all directions is
enough for all its headings: a heading shifts that image by whole columns. An image of the camera is compared with every
place in every heading by looking distances up, and nothing is rendered.
"""

from typing import NamedTuple

import numpy as np

from course_lib.beyond.lost_and_found.free_space import FreeSpace
from course_lib.geometry import rotation_exp
from course_lib.rendering.compiled import compiled

# All chosen on development recordings (the kitchen, the rooms of a HoloLens, the shipped corridor).
COLUMNS = 60  # pixels around the horizon, 6 degrees each; also the number of headings
ROWS = COLUMNS // 2
SPACING = 0.3  # metres, mean distance of stored places
MAX_PLACES = 4_000  # of which 14 MB and 7 million rays are made; a large map gets a wider spacing
_MM = 0.001  # metres; stored as whole numbers of 16 bits
_MISS = 65_535  # millimetres: no surface
_AT_ONCE = 250  # places whose rays are cast together


class Look(NamedTuple):
    """A camera's image on the sphere, upright and of heading 0: its P measured pixels."""

    rows: np.ndarray  # `(P,)` of the stored images
    columns: np.ndarray  # `(P,)` of the stored images
    ranges: np.ndarray  # `(P,)` metres from the camera, along the ray


class StoredViews:
    """Distances from places of a map's free space in all directions.

    places: `(N, 3)`. ranges: `(N, 30, 60)` whole millimetres; rows from straight up to straight down, columns turn from
    the world's x to its y.
    """

    def __init__(self, free_space: FreeSpace, origin: np.ndarray, max_places: int = MAX_PLACES) -> None:
        _, volume = free_space.spread_out(1)
        count = int(np.clip(volume / SPACING**3, 1, max_places))
        self.places, _ = free_space.spread_out(count)
        self.ranges = np.empty((count, ROWS, COLUMNS), dtype=np.uint16)
        directions = directions_of_pixels().reshape(-1, 3)
        for begin in range(0, count, _AT_ONCE):
            places = self.places[begin : begin + _AT_ONCE] - origin
            origins = np.repeat(places, len(directions), axis=0)
            metres = free_space.caster.cast(origins, np.tile(directions, (len(places), 1)))[0]
            stored = np.where(metres < 0.99 * _MISS * _MM, metres / _MM, _MISS).astype(np.uint16)
            self.ranges[begin : begin + _AT_ONCE] = stored.reshape(-1, ROWS, COLUMNS)

    def scores(self, look: Look, alpha: float) -> np.ndarray:
        """Return the raw scores `(N, 60)` of a look from every place in every heading.

        With d = measured - stored, a pixel counts as in eq. (8), but against the pose where it lies behind the map:

            alpha / (alpha + |d|) for d <= 0,    (alpha - d) / (alpha + d) for d > 0,    0 where the map shows nothing

        and the score is the mean over pixels. `readable_scores` gives the same numbers more slowly.
        """
        return _scores(self.ranges, look.rows, look.columns, look.ranges, np.float32(alpha))

    def poses(self, indices: np.ndarray, upright: np.ndarray) -> np.ndarray:
        """Return camera-to-world poses `(K, 4, 4)` of indices `(K,)` into `scores(...).ravel()`.

        upright: `(3, 3)`, as of `look_at`.
        """
        place, heading = np.unravel_index(indices, (len(self.places), COLUMNS))
        turn = np.zeros((len(indices), 3))
        turn[:, 2] = heading * 2 * np.pi / COLUMNS
        poses = np.tile(np.eye(4), (len(indices), 1, 1))
        poses[:, :3, :3] = rotation_exp(turn) @ upright
        poses[:, :3, 3] = self.places[place]
        return poses


def directions_of_pixels() -> np.ndarray:
    """Return the directions `(30, 60, 3)` of the stored pixels in the world, z up."""
    elevation = (0.5 - (np.arange(ROWS) + 0.5) / ROWS)[:, None] * np.pi
    azimuth = np.arange(COLUMNS) * 2 * np.pi / COLUMNS
    level = np.cos(elevation)
    return np.stack([level * np.cos(azimuth), level * np.sin(azimuth), np.sin(elevation) + 0 * azimuth], axis=-1)


def look_at(points: np.ndarray, upright: np.ndarray) -> Look:
    """Return which stored pixels a camera's points `(..., 3)` fall on at heading 0; NaN points are left out.

    upright: rotation `(3, 3)` from the camera's optical frame to the world with a heading of 0.
    """
    points = points.reshape(-1, 3)
    points = points[np.isfinite(points).all(axis=1)] @ upright.T
    ranges = np.linalg.norm(points, axis=1)
    elevation = np.arcsin(points[:, 2] / ranges)
    azimuth = np.arctan2(points[:, 1], points[:, 0])
    rows = np.clip(np.floor((0.5 - elevation / np.pi) * ROWS), 0, ROWS - 1).astype(np.int64)
    columns = np.round(azimuth / (2 * np.pi) * COLUMNS).astype(np.int64) % COLUMNS
    return Look(rows, columns, ranges.astype(np.float32))


def readable_scores(stored: np.ndarray, look: Look, alpha: float) -> np.ndarray:
    """Return what `StoredViews.scores` returns, for stored millimetres `(N, 30, 60)`; a test holds the two together."""
    metres = np.where(stored == _MISS, np.inf, stored * _MM)
    scores = []
    for heading in range(COLUMNS):
        behind = look.ranges - metres[:, look.rows, (look.columns + heading) % COLUMNS]  # (N, P); -inf at a miss
        with np.errstate(invalid="ignore"):
            terms = (alpha - np.maximum(behind, 0)) / (alpha + np.abs(behind))
        scores.append(terms.sum(axis=1) / max(len(look.rows), 1))
    return np.stack(scores, axis=1)


@compiled()
def _scores(stored, rows, columns, ranges, alpha):
    count, height, width = stored.shape
    scores = np.zeros((count, width), np.float32)
    twice = np.empty((height, 2 * width), np.float32)  # so that no heading needs a remainder
    for i in range(count):
        for y in range(height):
            for x in range(width):
                metres = np.float32(stored[i, y, x]) * np.float32(_MM)
                if stored[i, y, x] == _MISS:
                    metres = np.float32(1e6)
                twice[y, x] = twice[y, x + width] = metres
        one = scores[i]
        for k in range(len(rows)):
            line, first, measured = twice[rows[k]], columns[k], ranges[k]
            for heading in range(width):
                behind = measured - line[first + heading]
                one[heading] += (alpha - max(behind, np.float32(0))) / (alpha + abs(behind))
        for heading in range(width):
            one[heading] /= max(len(rows), 1)
    return scores
