"""A room of plain boxes whose corners are known: what closed forms can be compared with."""

from __future__ import annotations

import numpy as np

from course_lib.simulation.room.scene import Lamp, Room, RoomObject
from course_lib.simulation.textures import TexturedMesh


def box_mesh(low, high, colour, inward=False) -> TexturedMesh:
    """An axis-parallel box with a plain colour (RGB), corners counter-clockwise seen from outside (or inside)."""
    low, high = np.asarray(low, float), np.asarray(high, float)
    vertices, faces = [], []
    for axis in range(3):
        first, second = (axis + 1) % 3, (axis + 2) % 3
        for side in (0, 1):
            start = len(vertices)
            for i, j in ((0, 0), (1, 0), (1, 1), (0, 1)):
                corner = low.copy()
                corner[axis], corner[first], corner[second] = (
                    (low, high)[side][axis],
                    (low, high)[i][first],
                    (low, high)[j][second],
                )
                vertices.append(corner)
            outward = side == 1
            order = (0, 1, 2, 0, 2, 3) if outward != inward else (0, 2, 1, 0, 3, 2)
            faces += [[start + k for k in order[:3]], [start + k for k in order[3:]]]
    texture = np.full((4, 4, 3), colour, np.uint8)
    return TexturedMesh(np.array(vertices), np.array(faces), np.zeros((len(vertices), 2)), texture)


def plain_object(label: str, x: float, y: float, width: float, height: float, colour) -> RoomObject:
    """A box with a square footprint on the floor."""
    half = width / 2
    return RoomObject(label, x, y, 0.0, (box_mesh((x - half, y - half, 0), (x + half, y + half, height), colour),))


def plain_room(*objects: RoomObject) -> Room:
    """A white room of 6 x 6 m around the origin."""
    walls = np.array([[-3.0, -3.0], [3.0, -3.0], [3.0, 3.0], [-3.0, 3.0]])
    shell = (box_mesh((-3, -3, 0), (3, 3, 2.5), (255, 255, 255), inward=True),)
    return Room(walls, 2.5, objects, shell, (Lamp((0.0, 0.0, 2.3), (1.0, 1.0, 1.0), 1.0),))
