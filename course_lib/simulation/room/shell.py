"""What a room is apart from its listed furniture: floor, walls, windows, door, pictures, lamps, and small things.

The semantic map lists none of it; the small things (boxes, bins, rugs, curtains) are there so that a detector meets
objects that are not of its classes. Everything that stands on the floor stays within 0.45 m of a wall.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from course_lib.simulation.furniture.solids import box, cylinder, grid_faces, lathe, panel, rod, textured, turn
from course_lib.simulation.textures import Surface, TexturedMesh

WALL_CELL = 0.5  # metres: longest edge of a wall's cell
LIFT = 0.004  # metres between two faces that would otherwise lie in one plane


@dataclass(frozen=True)
class Wall:
    """One wall: start: its left end on the floor as seen from inside; along: unit vector to its right end; inward."""

    start: np.ndarray
    along: np.ndarray
    inward: np.ndarray
    length: float

    def pose(self, s: float, z: float = 0.0, out: float = 0.0) -> dict[str, float]:
        """Where turn() puts a thing whose front is +x: s metres along the wall, z up, out metres into the room."""
        x, y = self.start + s * self.along + out * self.inward
        return {"x": float(x), "y": float(y), "z": z, "yaw": float(np.arctan2(self.inward[1], self.inward[0]))}


def walls_of(low: Sequence[float], high: Sequence[float]) -> list[Wall]:
    """The four walls of the rectangle low to high: south (y = low), east, north, west, seen from inside."""
    (x0, y0), (x1, y1) = low, high
    corners = [
        ((x1, y0), (-1, 0), (0, 1)),
        ((x1, y1), (0, -1), (-1, 0)),
        ((x0, y1), (1, 0), (0, -1)),
        ((x0, y0), (0, 1), (1, 0)),
    ]
    lengths = [x1 - x0, y1 - y0, x1 - x0, y1 - y0]
    return [
        Wall(np.array(start, float), np.array(along, float), np.array(inward, float), float(length))
        for (start, along, inward), length in zip(corners, lengths, strict=True)
    ]


def bare_room(
    low: Sequence[float],
    high: Sequence[float],
    height: float,
    papers: Sequence[Surface],
    floor: Surface,
    ceiling: Surface,
    trim: Surface,
) -> list[TexturedMesh]:
    """Floor, ceiling, four walls (papers: one surface per wall) and skirting boards."""
    (x0, y0), (x1, y1) = low, high
    meshes = [
        panel((x0, y0, 0), (x1 - x0, 0, 0), (0, y1 - y0, 0), floor, cell=WALL_CELL),
        panel((x0, y1, height), (x1 - x0, 0, 0), (0, y0 - y1, 0), ceiling, cell=WALL_CELL),
    ]
    for wall, paper in zip(walls_of(low, high), papers, strict=True):
        start, along = np.append(wall.start, 0.0), np.append(wall.along * wall.length, 0.0)
        meshes.append(panel(start, along, (0, 0, height), paper, cell=WALL_CELL))
        board = box((0.014, wall.length, 0.09), (0.007, 0, 0.045), trim)
        meshes += turn(board, **wall.pose(wall.length / 2))
    return meshes


def window(
    wall: Wall, s: float, width: float, height: float, sill: float, view: Surface, frame: Surface
) -> list[TexturedMesh]:
    """A window with its middle s metres along the wall: a view that shines, a frame with a bar, a sill."""
    parts = [panel((LIFT, -width / 2, 0), (0, width, 0), (0, 0, height), view, fit=True)]
    for y in (-width / 2, 0.0, width / 2):
        parts += box((0.05, 0.05, height + 0.05), (0.02, y, height / 2), frame)
    for z in (0.0, height):
        parts += box((0.05, width + 0.05, 0.05), (0.021, 0, z), frame)
    parts += box((0.14, width + 0.14, 0.03), (0.07, 0, -0.03), frame)
    return turn(parts, **wall.pose(s, sill))


def curtain(wall: Wall, s: float, width: float, height: float, cover: Surface) -> list[TexturedMesh]:
    """A hanging curtain in folds, its middle s metres along the wall, from just above the floor to height."""
    folds = max(3, round(width / 0.09))
    y = np.linspace(-width / 2, width / 2, 4 * folds + 1)
    x = 0.09 + 0.025 * np.sin(np.linspace(0, 2 * np.pi * folds, 4 * folds + 1))
    rows = np.linspace(0.06, height, 6)
    parts = []
    for offset, order in ((0.006, 1), (0.0, -1)):
        vertices = np.stack([np.tile(x + offset, 6), np.tile(y, 6), np.repeat(rows, len(y))], 1)
        vertices = vertices.reshape(6, -1, 3)[:, ::order].reshape(-1, 3)
        metres = vertices[:, 1:] * (1.25, 1.0)
        parts.append(textured(vertices, grid_faces(6, len(y)), metres, cover))
    parts += rod([(0.09, -width / 2 - 0.08, height + 0.02), (0.09, width / 2 + 0.08, height + 0.02)], 0.012, cover)
    return turn(parts, **wall.pose(s))


def door(wall: Wall, s: float, leaf: Surface, frame: Surface, knob: Surface) -> list[TexturedMesh]:
    """A closed door of 0.85 x 2.0 m with panels, a frame and a handle."""
    parts = box((0.03, 0.85, 2.0), (0.015, 0, 1.0), leaf)
    for z, tall in ((0.5, 0.7), (1.4, 0.9)):
        parts += box((0.016, 0.55, tall), (0.034, 0, z), leaf)
    for y in (-0.465, 0.465):
        parts += box((0.05, 0.08, 2.09), (0.025, y, 1.045), frame)
    parts += box((0.05, 0.85, 0.08), (0.025, 0, 2.05), frame)
    parts += rod([(0.075, 0.25, 1.02), (0.075, 0.37, 1.02)], 0.012, knob) + rod(
        [(0.03, 0.37, 1.02), (0.075, 0.37, 1.02)], 0.01, knob
    )
    return turn(parts, **wall.pose(s))


def framed_picture(wall: Wall, s: float, z: float, print_: Surface, frame: Surface) -> list[TexturedMesh]:
    """A picture on the wall, its middle s metres along and z metres up; its size is the print's."""
    width, height = print_.size
    parts = box((0.025, width + 0.06, height + 0.06), (0.0125, 0, 0), frame)
    parts.append(panel((0.025 + LIFT, -width / 2, -height / 2), (0, width, 0), (0, 0, height), print_, fit=True))
    return turn(parts, **wall.pose(s, z))


def ceiling_lamp(
    x: float, y: float, height: float, radius: float, glow: Surface, drop: float = 0.12
) -> list[TexturedMesh]:
    """A bowl of light under the ceiling; drop: how far it hangs down, metres."""
    bowl = [(0.0, 0.0), (0.7 * radius, 0.02), (radius, 0.07), (0.9 * radius, 0.1), (0.0, 0.1)]
    meshes = lathe(bowl, (x, y, height - drop), glow, 20)
    return meshes + cylinder(0.012, drop - 0.09, (x, y, height - drop + 0.09), glow)


def rug(x: float, y: float, heading: float, length: float, width: float, cover: Surface) -> list[TexturedMesh]:
    """A flat rug on the floor."""
    return turn(box((length, width, 0.008), (0, 0, 0.005), cover), x=x, y=y, yaw=heading)


def carton(wall: Wall, s: float, size: Sequence[float], sides: Surface, face: Surface) -> list[TexturedMesh]:
    """A cardboard box by the wall, with a label on its front."""
    d, w, h = size
    parts = box(size, (d / 2 + 0.02, 0, h / 2), sides)
    across, up = 0.6 * w, 0.5 * h
    parts.append(panel((d + 0.02 + LIFT, -across / 2, 0.25 * h), (0, across, 0), (0, 0, up), face, fit=True))
    return turn(parts, **wall.pose(s))


def waste_bin(wall: Wall, s: float, radius: float, height: float, side: Surface) -> list[TexturedMesh]:
    """A round bin by the wall, wider at its top."""
    profile = [(0, 0), (0.8 * radius, 0), (radius, height), (0.9 * radius, height), (0.75 * radius, 0.05), (0, 0.05)]
    return turn(lathe(profile, (radius + 0.03, 0, 0), side, 18), **wall.pose(s))


def floor_lamp(wall: Wall, s: float, height: float, pole: Surface, shade: Surface) -> list[TexturedMesh]:
    """A standing lamp with a conical shade by the wall."""
    x = 0.22
    parts = cylinder(0.13, 0.03, (x, 0, 0), pole, n=18) + rod([(x, 0, 0.02), (x, 0, height - 0.1)], 0.012, pole)
    parts += lathe([(0, 0), (0.18, 0), (0.11, 0.25), (0, 0.25)], (x, 0, height - 0.25), shade, 20)
    return turn(parts, **wall.pose(s))
