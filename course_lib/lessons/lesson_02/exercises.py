"""Exercises of lesson 02: from ranges and angles to points, from the scanner to the world, and the share of holes."""

from __future__ import annotations

import numpy as np

from course_lib.geometry import pose_matrix
from course_lib.lessons.kit.exercises import Exercise, Mistake

# 02.1: points in the scanner's frame


def scan_points(ranges: np.ndarray, azimuths: np.ndarray, elevations: np.ndarray) -> np.ndarray:
    """Points (n, 3) [m] of ranges [m], azimuths and elevations [rad], all (n,): x forward, y left, z up."""
    c = np.cos(elevations)
    return ranges[:, None] * np.stack([c * np.cos(azimuths), c * np.sin(azimuths), np.sin(elevations)], axis=1)


def _rays(rng: np.random.Generator) -> tuple:
    n = int(rng.integers(4, 9))
    return rng.uniform(0.6, 9, n), rng.uniform(-np.pi, np.pi, n), rng.uniform(-1.0, 1.4, n)


def _without_cosine(r: np.ndarray, a: np.ndarray, e: np.ndarray) -> np.ndarray:
    return np.stack([r * np.cos(a), r * np.sin(a), r * np.sin(e)], axis=1)


# 02.2: from the scanner's frame to the world


def to_world(points: np.ndarray, pose: np.ndarray) -> np.ndarray:
    """Points (n, 3) [m] of the scanner's frame in the world, by its pose (4, 4): p = R q + t."""
    return points @ pose[:3, :3].T + pose[:3, 3]


def _points_and_pose(rng: np.random.Generator) -> tuple:
    state = np.concatenate([rng.uniform(1, 9, 3), rng.uniform(-0.3, 0.3, 2), rng.uniform(0.3, 1.2, 1)])
    return rng.uniform(-5, 5, (int(rng.integers(4, 8)), 3)), pose_matrix(state)


def _yaw_alone(points: np.ndarray, pose: np.ndarray) -> np.ndarray:
    yaw = np.arctan2(pose[1, 0], pose[0, 0])
    return to_world(points, pose_matrix(np.array([*pose[:3, 3], 0, 0, yaw])))


# 02.3: the share of holes


def hole_share(seen: np.ndarray, mapped: np.ndarray, limit: float) -> float:
    """Share (0 to 1) of places (n, 3) with no point of the map (m, 3) within `limit` metres."""
    return float(np.mean(_nearest(seen, mapped) > limit))


def _nearest(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return _distances(a, b).min(axis=1)


def _distances(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.linalg.norm(a[:, None] - b[None], axis=2)


def _places_and_map(rng: np.random.Generator) -> tuple:
    """A map with a gap, whose points lie aslant beside the places, nearer and farther than the limit, and some points
    in mid-air that no place is near (mixed pixels)."""
    n, limit = int(rng.integers(30, 50)), rng.uniform(0.06, 0.25)
    seen = np.column_stack([rng.uniform(0, 4, n), rng.uniform(0, 2, n), np.zeros(n)])
    kept = seen[(seen[:, 0] < 2.6) | (seen[:, 0] > 3.4)]
    # Neither along an axis nor at 45 degrees: a distance that is not the root of a sum of squares comes out otherwise.
    aslant = np.pi / 2 * rng.integers(4, size=len(kept)) + np.deg2rad(rng.uniform(25, 65, len(kept)))
    away = rng.uniform(0, 1.6, len(kept)) * limit
    mapped = kept + np.column_stack([away * np.cos(aslant), away * np.sin(aslant), 0 * away])
    stray = np.column_stack([rng.uniform(0, 4, (9, 2)), rng.uniform(1, 2, 9)])
    return seen, np.concatenate([mapped, stray]), limit


EXERCISES = [
    Exercise(
        number="02.1",
        reference=scan_points,
        inputs=_rays,
        mistakes=(
            Mistake(
                _without_cosine,
                "Look steeply up: x and y must shrink. By which factor of the elevation do they?",
            ),
            Mistake(
                lambda r, a, e: scan_points(r, e, a),
                "Azimuth and elevation have changed places: elevation is the angle above the floor's plane.",
            ),
            Mistake(
                lambda r, a, e: scan_points(r, a, np.pi / 2 - e),
                "That counts from straight up. Here elevation 0 is level, and z = r sin(elevation).",
            ),
            Mistake(
                lambda r, a, e: scan_points(np.ones_like(r), a, e),
                "These are directions of length 1: multiply each by its range.",
            ),
            Mistake(
                lambda r, a, e: scan_points(r, -a, e),
                "Your scanner turns the wrong way: azimuth grows from x (forward) to y (left).",
            ),
            Mistake(
                lambda r, a, e: scan_points(r, np.deg2rad(a), np.deg2rad(e)),
                "The angles are in radians already; you convert them once more.",
            ),
            Mistake(
                lambda r, a, e: scan_points(r, a, e).T,
                "One point a row, please: (n, 3). Yours is (3, n).",
            ),
            Mistake(
                lambda r, a, e: scan_points(r, a, e)[:, [1, 0, 2]],
                "x and y have changed places. Azimuth 0 is forward, along x: so x has the cosine of the azimuth.",
            ),
            Mistake(
                lambda r, a, e: np.column_stack([scan_points(r, a, e)[:, :2], np.sin(e)]),
                "x and y are right. Your z is that of a ray of length 1: how far up does a ray of length r end?",
            ),
            Mistake(
                lambda r, a, e: np.stack([r * np.cos(a), r * np.sin(a), r * np.tan(e)], axis=1),
                "You take the range for a distance on the floor. It is measured along the ray, and that is longer.",
            ),
            Mistake(
                lambda r, a, e: np.stack([r * np.cos(e) * np.cos(a), r * np.sin(a), r * np.sin(e)], axis=1),
                "Your x shrinks with the elevation, your y does not. Both belong to the shadow, r cos e.",
            ),
            Mistake(
                lambda r, a, e: scan_points(r, a, e).T.reshape(-1, 3),
                "The numbers are right, in the wrong places: reshape does not turn rows into columns. Use .T.",
            ),
            Mistake(
                lambda r, a, e: scan_points(r, np.rad2deg(a), np.rad2deg(e)),
                "You turn the angles into degrees; np.sin and np.cos take radians.",
            ),
        ),
    ),
    Exercise(
        number="02.2",
        reference=to_world,
        inputs=_points_and_pose,
        mistakes=(
            Mistake(
                lambda points, pose: points @ pose[:3, :3] + pose[:3, 3],
                "You turn the other way. With one point a row, R q is written points @ R.T.",
            ),
            Mistake(
                lambda points, pose: points @ pose[:3, :3].T,
                "Turned rightly, but still about the origin: where does the scanner stand? Add its place.",
            ),
            Mistake(
                lambda points, pose: points + pose[:3, 3],
                "Moved, but not turned: the scanner's x axis does not point along the world's.",
            ),
            Mistake(
                lambda points, pose: (points + pose[:3, 3]) @ pose[:3, :3].T,
                "The place is given in the world: turn first, then add it.",
            ),
            Mistake(
                lambda points, pose: (points - pose[:3, 3]) @ pose[:3, :3],
                "That is the way back, from the world to the scanner.",
            ),
            Mistake(
                lambda points, pose: points @ pose[:3, :3].T - pose[:3, 3],
                "Turned rightly; then the place is added, not taken away.",
            ),
            Mistake(
                lambda points, pose: (points + pose[:3, 3]) @ pose[:3, :3],
                "Two slips: you add the place before you turn, and with one point a row R q is written points @ R.T.",
            ),
            Mistake(
                lambda points, pose: points @ pose[:3, :3],
                "Turned the other way, and not moved. For points as rows the pose has to be transposed, too.",
            ),
            Mistake(
                _yaw_alone,
                "You turn by the yaw alone. A tripod is never quite level: take the whole of R.",
            ),
        ),
    ),
    Exercise(
        number="02.3",
        reference=hole_share,
        inputs=_places_and_map,
        mistakes=(
            Mistake(
                lambda seen, mapped, limit: hole_share(mapped, seen, limit),
                "You ask which map points lie off the room. A hole is the other way: a place with no map near it.",
            ),
            Mistake(
                lambda seen, mapped, limit: 1 - hole_share(seen, mapped, limit),
                "That is the share that is mapped; the holes are the rest.",
            ),
            Mistake(
                lambda seen, mapped, limit: 100 * hole_share(seen, mapped, limit),
                "Yours is in percent. The task asks for a share from 0 to 1.",
            ),
            Mistake(
                lambda seen, mapped, limit: float((_nearest(seen, mapped) > limit).sum()),
                "That is how many places; divide by the number of all places.",
            ),
            Mistake(
                lambda seen, mapped, limit: float((_nearest(seen, mapped) > limit).sum() / len(mapped)),
                "You divide by the number of map points. The share is of the places that are seen.",
            ),
            Mistake(
                lambda seen, mapped, limit: float(_nearest(seen, mapped).mean()),
                "That is a mean distance in metres. Count the places that are farther than the limit.",
            ),
            Mistake(
                lambda seen, mapped, limit: float(np.mean(_distances(seen, mapped).mean(axis=1) > limit)),
                "You let far map points count: one near a place is enough. Only the nearest one decides.",
            ),
            Mistake(
                lambda seen, mapped, limit: float(np.mean(_distances(seen, mapped) > limit)),
                "You take the share of all pairs. First find the nearest map point of each place, then count places.",
            ),
            Mistake(
                lambda seen, mapped, limit: hole_share(seen[:, :2], mapped[:, :2], limit),
                "You measure on the floor: a map point high above a place is not near it. Take x, y *and* z.",
            ),
            Mistake(
                lambda seen, mapped, limit: float(np.mean(_nearest(seen, mapped) ** 2 > limit)),
                "You compare a squared distance with the limit: take the root.",
            ),
            Mistake(
                lambda seen, mapped, limit: hole_share(seen, mapped, 0.1),
                "Your limit is always 0.1 m: use the argument.",
            ),
            Mistake(
                lambda seen, mapped, limit: float(
                    np.mean(np.abs(seen[:, None] - mapped[None]).max(axis=2).min(axis=1) > limit)
                ),
                "You test x, y and z one by one: that is a cube about the place. The distance is a root of squares.",
            ),
        ),
    ),
]
