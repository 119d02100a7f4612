"""What a furnished room is: its objects, its shell, its light, and how large it is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from course_lib.simulation.textures import TexturedMesh


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
