"""What a furnished room is, and where things stand in it: footprints are rectangles on the floor."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from courseware.simulation.textures import TexturedMesh


@dataclass(frozen=True)
class Lamp:
    """A light that shines in all directions and loses strength with distance."""

    position: tuple[float, float, float]  # metres, world frame
    colour: tuple[float, float, float]  # RGB, 0 to 1
    strength: float  # brightness of a white surface one metre before it, 1 = full scale of an image with exposure 1


@dataclass(frozen=True)
class RoomObject:
    """One piece of furniture in its place."""

    label: str  # class name as in the semantic map
    x: float  # metres, world frame: its footprint's centre
    y: float
    heading: float  # radians, the direction its front faces
    meshes: tuple[TexturedMesh, ...]  # in the world frame

    def vertices(self) -> np.ndarray:
        """All corners `(n, 3)`, metres, world frame."""
        return np.concatenate([mesh.vertices for mesh in self.meshes])


@dataclass(frozen=True)
class Room:
    """A furnished room, floor at z = 0."""

    walls: np.ndarray  # `(k, 2)` corners of the floor in order, metres
    height: float  # of the ceiling, metres
    objects: tuple[RoomObject, ...]  # what the semantic map lists
    shell: tuple[TexturedMesh, ...]  # what it does not list: floor, walls, ceiling, windows, doors, pictures
    lamps: tuple[Lamp, ...]
    ambient: tuple[float, float, float] = (0.35, 0.35, 0.35)  # RGB, the light that comes from everywhere


def rectangle(x: float, y: float, heading: float, depth: float, width: float) -> np.ndarray:
    """Corners `(4, 2)`, metres, counter-clockwise; depth: along the heading (radians), width: across it."""
    forward = np.array([np.cos(heading), np.sin(heading)])
    left = np.array([-forward[1], forward[0]])
    signs = np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]]) / 2.0
    return np.array([x, y]) + signs[:, :1] * depth * forward + signs[:, 1:] * width * left


def footprint(item: RoomObject) -> np.ndarray:
    """The smallest rectangle `(4, 2)` along the object's heading that holds all of it, seen from above; metres."""
    forward = np.array([np.cos(item.heading), np.sin(item.heading)])
    axes = np.stack([forward, [-forward[1], forward[0]]], 1)
    along = item.vertices()[:, :2] @ axes
    low, high = along.min(axis=0), along.max(axis=0)
    corners = np.array([[high[0], high[1]], [low[0], high[1]], [low[0], low[1]], [high[0], low[1]]])
    return corners @ axes.T


def overlap(first: np.ndarray, second: np.ndarray, gap: float = 0.0) -> bool:
    """Whether two rectangles come closer than gap (metres) along every edge direction (separating axes)."""
    for corners in (first, second):
        for edge in (corners[1] - corners[0], corners[2] - corners[1]):
            axis = edge / np.linalg.norm(edge)
            a, b = first @ axis, second @ axis
            if a.max() + gap <= b.min() or b.max() + gap <= a.min():
                return False
    return True


def distance_to(corners: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Distances `(n,)` of places `(n, 2)` from a rectangle, 0 inside it; metres."""
    middle = corners.mean(axis=0)
    axes = np.stack([corners[0] - corners[1], corners[1] - corners[2]], 1)
    lengths = np.linalg.norm(axes, axis=0)
    along = np.abs((np.asarray(places, float) - middle) @ (axes / lengths)) - lengths / 2
    return np.linalg.norm(np.maximum(along, 0.0), axis=1)


class NoFreePlace(ValueError):
    """The room has not enough space where a rig can stand."""


def free_places(room: Room, n: int, rng: Generator, clearance: float = 0.3, wall: float = 0.5) -> np.ndarray:
    """Places `(n, 2)` at least clearance (m) from every footprint and wall from every wall. Raises `NoFreePlace`."""
    low, high = np.asarray(room.walls).min(axis=0) + wall, np.asarray(room.walls).max(axis=0) - wall
    places = rng.uniform(low, high, (500 * n, 2))
    free = clear_of([footprint(item) for item in room.objects], places, clearance)
    if free.sum() < n:
        raise NoFreePlace(f"{n} places {clearance} m clear: found {free.sum()} among {500 * n}; ask for less clearance")
    return places[free][:n]


def clear_of(footprints: Sequence[np.ndarray], places: np.ndarray, clearance: float) -> np.ndarray:
    """Whether each place `(n, 2)` keeps the clearance (metres) from every footprint: `(n,)` bool."""
    free = np.ones(len(places), bool)
    for corners in footprints:
        free &= distance_to(corners, places) >= clearance
    return free
