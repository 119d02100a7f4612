"""A room of plain boxes whose corners are known: what closed forms can be compared with."""

import numpy as np
import trimesh

from courseware.simulation.room.scene import Lamp, Room, RoomObject
from courseware.simulation.textures import TexturedMesh


def box_mesh(low, high, colour, inward=False) -> TexturedMesh:
    """An axis-parallel box with a plain colour (RGB), corners counter-clockwise seen from outside (or inside)."""
    box = trimesh.creation.box(bounds=(low, high))
    faces = box.faces[:, ::-1] if inward else box.faces
    return TexturedMesh(box.vertices, faces, np.zeros((8, 2)), np.full((4, 4, 3), colour, np.uint8))


def plain_object(label: str, x: float, y: float, width: float, height: float, colour) -> RoomObject:
    half = width / 2
    return RoomObject(label, x, y, 0.0, (box_mesh((x - half, y - half, 0), (x + half, y + half, height), colour),))


def plain_room(*objects: RoomObject) -> Room:
    walls = np.array([[-3.0, -3.0], [3.0, -3.0], [3.0, 3.0], [-3.0, 3.0]])
    shell = (box_mesh((-3, -3, 0), (3, 3, 2.5), (255, 255, 255), inward=True),)
    return Room(walls, 2.5, objects, shell, (Lamp((0.0, 0.0, 2.3), (1.0, 1.0, 1.0), 1.0),))
