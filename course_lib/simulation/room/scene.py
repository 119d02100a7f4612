"""What a furnished room is: its objects, its shell, its light, and how large it is."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from course_lib.simulation.textures import TexturedMesh


@dataclass(frozen=True)
class Lamp:
    """A light that shines in all directions and loses strength with distance.

    position: `(3,)` metres, world frame. colour: `(3,)` RGB, 0 to 1. strength: brightness of a white surface that
    faces the lamp from one metre, 1 = full scale of an image with exposure 1.
    """

    position: tuple[float, float, float]
    colour: tuple[float, float, float]
    strength: float


@dataclass(frozen=True)
class RoomObject:
    """One piece of furniture in its place.

    label: class name as in the semantic map. x, y: its footprint's centre in the world, metres. heading: radians, the
    direction its front faces. meshes: in the world frame.
    """

    label: str
    x: float
    y: float
    heading: float
    meshes: tuple[TexturedMesh, ...]

    def vertices(self) -> np.ndarray:
        """All corners `(n, 3)`, metres, world frame."""
        return np.concatenate([mesh.vertices for mesh in self.meshes])


@dataclass(frozen=True)
class Room:
    """A furnished room, floor at z = 0.

    walls: `(k, 2)` corners of the floor in order, metres. height: of the ceiling, metres. objects: what the semantic
    map lists. shell: floor, walls, ceiling, windows, doors, pictures, lamps: what it does not list. lamps: the light;
    ambient: `(3,)` RGB, the light that comes from everywhere.
    """

    walls: np.ndarray
    height: float
    objects: tuple[RoomObject, ...]
    shell: tuple[TexturedMesh, ...]
    lamps: tuple[Lamp, ...]
    ambient: tuple[float, float, float] = field(default=(0.35, 0.35, 0.35))
