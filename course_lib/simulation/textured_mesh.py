"""Triangles with a picture on them: what the rooms are built of and what the panorama renderer draws."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class TexturedMesh:
    """Triangles that share one texture.

    vertices: `(n, 3)` float64, metres, world frame (or the frame of the piece of furniture while it is being built).
    faces: `(m, 3)` int64, corner indices, counter-clockwise seen from outside.
    texture_coordinates: `(n, 2)` float64, (s, t); the texture repeats beyond [0, 1], t = 0 is the texture's lowest row.
    texture: `(h, w, 3)` uint8, RGB.
    emission: 0 = lit by the lamps only, 1 = shows its texture at full brightness without any lamp (screens, windows).
    """

    vertices: np.ndarray
    faces: np.ndarray
    texture_coordinates: np.ndarray
    texture: np.ndarray
    emission: float = 0.0

    def __post_init__(self):
        vertices = np.asarray(self.vertices, float)
        coordinates = np.asarray(self.texture_coordinates, float)
        if vertices.ndim != 2 or vertices.shape[1] != 3 or coordinates.shape != (len(vertices), 2):
            raise ValueError(
                f"vertices of shape {vertices.shape} and texture coordinates of shape {coordinates.shape}: "
                "expected (n, 3) and (n, 2) with the same n."
            )
        texture = np.asarray(self.texture)
        if texture.ndim != 3 or texture.shape[2] != 3 or texture.dtype != np.uint8:
            raise ValueError(f"a texture of shape {texture.shape}, {texture.dtype}: expected (h, w, 3) uint8, RGB.")

    def moved(self, pose: np.ndarray) -> TexturedMesh:
        """The same mesh in another frame; pose: `(4, 4)`, old frame to new frame, a rotation and a translation."""
        vertices = np.asarray(self.vertices, float) @ pose[:3, :3].T + pose[:3, 3]
        return TexturedMesh(vertices, self.faces, self.texture_coordinates, self.texture, self.emission)
