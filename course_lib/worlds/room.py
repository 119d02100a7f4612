"""Rooms from a seed: a rectangle, 9 to 16 pieces of furniture, a shell with windows and lamps.

The detector is trained on these rooms; the room of the experiment is another (experiment_room.py).
"""

from __future__ import annotations

import numpy as np

from course_lib.worlds.footprints import clear_of, footprint, free_places, overlap, rectangle
from course_lib.worlds.furniture import RANDOM_PIECES
from course_lib.worlds.furniture.cabinet import random_cabinet
from course_lib.worlds.furniture.piece import Piece
from course_lib.worlds.furniture.television import random_television
from course_lib.worlds.random_shell import random_shell
from course_lib.worlds.room_scene import Room, RoomObject
from course_lib.worlds.room_shell import Wall, walls_of

__all__ = ["footprint", "free_places", "make_room"]

GAP = 0.06  # metres between two footprints
# How likely each class is to be drawn, and how many of it a room has at most.
SHARES = {
    "sofa": (0.13, 3),
    "chair": (0.24, 5),
    "table": (0.13, 3),
    "television": (0.1, 2),
    "potted plant": (0.17, 4),
    "refrigerator": (0.09, 2),
    "cabinet": (0.14, 3),
}
# How likely each class stands with its back to a wall.
AGAINST_WALL = {
    "sofa": 0.8,
    "chair": 0.3,
    "table": 0.3,
    "television": 0.85,
    "potted plant": 0.75,
    "refrigerator": 1.0,
    "cabinet": 0.97,
}


def _draw_labels(rng: np.random.Generator, n: int) -> list[str]:
    names = list(SHARES)
    share = np.array([SHARES[name][0] for name in names])
    # Every class but two is sure to be there, so that no room teaches only chairs.
    labels = [names[index] for index in rng.permutation(len(names))[: int(rng.integers(5, 8))]]
    while len(labels) < n:
        name = names[int(rng.choice(len(names), p=share / share.sum()))]
        if labels.count(name) < SHARES[name][1]:
            labels.append(name)
    order = ["television", "refrigerator", "sofa", "cabinet", "table", "potted plant", "chair"]
    return sorted(labels, key=order.index)


def _spot(
    rng: np.random.Generator, piece: Piece, walls: list[Wall], low: np.ndarray, high: np.ndarray, at_wall: bool
) -> tuple[float, float, float]:
    """A random place and heading for the piece: with its back to a wall, or anywhere."""
    depth, width, _ = piece.size
    if at_wall:
        wall = walls[int(rng.integers(4))]
        room = wall.length - width - 0.06
        out = depth / 2 + 0.02 + rng.choice([0.0, rng.uniform(0.0, 0.15)])
        pose = wall.pose(0.03 + width / 2 + rng.uniform(0.0, max(room, 0.0)), out=out)
        turned = rng.normal(0.0, 0.05) if rng.random() < 0.3 else 0.0
        return pose["x"], pose["y"], pose["yaw"] + turned
    reach = 0.5 * np.hypot(depth, width)
    x, y = rng.uniform(low + reach + 0.05, np.maximum(high - reach - 0.05, low + reach + 0.06))
    heading = rng.uniform(-np.pi, np.pi) if rng.random() < 0.6 else rng.integers(4) * np.pi / 2
    return float(x), float(y), float(heading)


def _place(
    rng: np.random.Generator,
    piece: Piece,
    walls: list[Wall],
    taken: list[np.ndarray],
    low: np.ndarray,
    high: np.ndarray,
) -> tuple[float, float, float] | None:
    """Where the piece fits between what stands already, or None after 60 tries."""
    depth, width, _ = piece.size
    at_wall = rng.random() < AGAINST_WALL[piece.label]
    for attempt in range(60):
        x, y, heading = _spot(rng, piece, walls, low, high, at_wall if attempt < 40 else True)
        corners = rectangle(x, y, heading, depth, width)
        inside = (corners.min(axis=0) >= low + 0.005).all() and (corners.max(axis=0) <= high - 0.005).all()
        if inside and not any(overlap(corners, other, GAP) for other in taken):
            return x, y, heading
    return None


def _stand_television(rng: np.random.Generator, stand: str) -> tuple[Piece, Piece | None, float]:
    """A television, the low cabinet under it if it has one, and the height at which it stands."""
    piece = random_television(rng, stand)
    if stand == "wall":
        return piece, None, float(rng.uniform(0.7, 1.1))
    if stand == "floor":
        return piece, None, 0.0
    low = random_cabinet(rng, "sideboard")
    return (piece, low, float(low.size[2])) if low.size[2] < 0.85 else (random_television(rng, "floor"), None, 0.0)


def make_room(seed: int | np.random.Generator) -> Room:
    """A furnished rectangular room, 4.5 to 7.5 m a side, with its south-west corner at the origin.

    seed: the same seed gives the same room, byte for byte. At least one free place in 40 is kept for a rig.
    """
    rng = np.random.default_rng(seed)
    sides = rng.uniform(4.5, 7.5, 2)
    height = float(rng.uniform(2.4, 3.0))
    low, high = np.zeros(2), sides
    walls = walls_of(low, high)
    shell, lamps, ambient, kept_free = random_shell(rng, low, high, height)
    probes = rng.uniform(low + 0.5, high - 0.5, (400, 2))
    objects: list[RoomObject] = []
    taken = list(kept_free)
    n = int(np.clip(round(rng.normal(6 + sides.prod() / 6.0, 1.5)), 9, 16))
    for label in _draw_labels(rng, n):
        if len(objects) >= 16:
            break
        under, z = None, 0.0
        if label == "television":
            piece, under, z = _stand_television(rng, str(rng.choice(["floor", "wall", "foot", "foot"])))
        else:
            piece = RANDOM_PIECES[label](rng)
        found = _place(rng, under or piece, walls, taken, low, high)
        if found is None:
            continue
        x, y, heading = found
        if label == "television" and z > 0.0 and under is None:
            wall = walls[int(rng.integers(4))]
            out = piece.size[0] / 2 + 0.01
            pose = wall.pose(rng.uniform(0.8, wall.length - 0.8), out=out)
            x, y, heading = pose["x"], pose["y"], pose["yaw"]
        corners = rectangle(x, y, heading, *(under or piece).size[:2])
        if any(overlap(corners, other, GAP) for other in taken) or clear_of([*taken, corners], probes, 0.35).sum() < 10:
            continue
        if under is not None:
            objects.append(under.at(x, y, heading))
        objects.append(piece.at(x, y, heading, z))
        taken.append(corners)
    return Room(
        walls=np.array([low, [high[0], low[1]], high, [low[0], high[1]]], float),
        height=height,
        objects=tuple(objects),
        shell=shell,
        lamps=lamps,
        ambient=ambient,
    )
