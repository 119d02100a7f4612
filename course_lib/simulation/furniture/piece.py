"""A piece of furniture before it stands anywhere: x forward (its front), y to its left, z up, floor at z = 0."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from course_lib.simulation.furniture.solids import joined
from course_lib.simulation.room.scene import RoomObject
from course_lib.simulation.textured_mesh import TexturedMesh


@dataclass(frozen=True)
class Piece:
    """label: class name. meshes: one per texture, in the piece's frame, the footprint's centre at the origin."""

    label: str
    meshes: tuple[TexturedMesh, ...]

    @classmethod
    def of(cls, label: str, meshes: Sequence[TexturedMesh]) -> Piece:
        """A piece from its parts, shifted so that the footprint's centre is the origin."""
        vertices = np.concatenate([mesh.vertices for mesh in meshes])
        shift = np.eye(4)
        shift[:2, 3] = -(vertices[:, :2].min(axis=0) + vertices[:, :2].max(axis=0)) / 2
        return cls(label, tuple(mesh.moved(shift) for mesh in joined(meshes)))

    @property
    def size(self) -> np.ndarray:
        """`(3,)` depth, width, height in metres."""
        vertices = np.concatenate([mesh.vertices for mesh in self.meshes])
        return np.append(np.ptp(vertices[:, :2], axis=0), vertices[:, 2].max())

    def at(self, x: float, y: float, heading: float, z: float = 0.0) -> RoomObject:
        """The piece standing in the room, its front towards heading (radians); z: metres above the floor."""
        cosine, sine = np.cos(heading), np.sin(heading)
        pose = np.eye(4)
        pose[:2, :2] = [[cosine, -sine], [sine, cosine]]
        pose[:3, 3] = x, y, z
        return RoomObject(self.label, float(x), float(y), float(heading), tuple(m.moved(pose) for m in self.meshes))
