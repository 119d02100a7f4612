"""Large triangles cut into smaller ones, in float64, before anything becomes float32.

A corner that lies 10 km away is off by half a millimetre in float32, and the plane of its triangle, seen from near, by
centimetres. Edges are halved until none is longer than `LONGEST`; an edge that two triangles share is halved for both
at one and the same point, so no gap opens between them.
"""

from __future__ import annotations

import numpy as np

LONGEST = 32.0
"""Metres: up to here OpenGL's depth of a plane seen from 2 m above it is right within half a millimetre."""

FARTHEST = 20_000.0
"""Metres: an edge that is longer is not cut. Such a triangle belongs to no building; `SceneMap.load` refuses it."""

MOST_TRIANGLES = 5_000_000
"""More pieces than that are not made: such a map is no building."""


class LargeTrianglesError(ValueError):
    """A map whose triangles are so large and so many that drawing them exactly would take all memory."""


def cut_large_triangles(
    vertices: np.ndarray, faces: np.ndarray, longest: float = LONGEST
) -> tuple[np.ndarray, np.ndarray]:
    """Vertices `(V', 3)` and faces `(F', 3)` of the same surface, no edge longer than `longest` metres.

    vertices: `(V, 3)` float64. faces: `(F, 3)`. What is not too large comes back as it is, the same arrays where
    nothing is. Raises `LargeTrianglesError` above `MOST_TRIANGLES`.
    """
    done: list[np.ndarray] = []
    while True:
        corners = vertices[faces]
        edges = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2)  # 01, 12, 20
        long = (edges > longest) & (edges.max(axis=1, keepdims=True) <= FARTHEST)
        cut = long.any(axis=1)
        if not cut.any():
            return vertices, np.concatenate([*done, faces]) if done else faces
        done.append(faces[~cut])
        faces, long = faces[cut], long[cut]
        if 4 * len(faces) + sum(map(len, done)) > MOST_TRIANGLES:
            raise LargeTrianglesError(
                f"the map has triangles so large that more than {MOST_TRIANGLES:,} pieces of at most {longest:g} m "
                "would have to be drawn: are its coordinates metres? Remove what does not belong to the building"
            )
        vertices, faces = _halved(vertices, faces, long)


def _halved(vertices: np.ndarray, faces: np.ndarray, long: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Triangles `faces` cut at the middle of their edges marked `long` `(F, 3)`: each into two, three or four."""
    edges = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=-1), axis=-1)  # (F, 3, 2)
    unique, index = np.unique(edges[long], axis=0, return_inverse=True)
    middle = np.full(long.shape, -1)
    middle[long] = len(vertices) + index.ravel()
    vertices = np.concatenate([vertices, vertices[unique].mean(axis=1)])
    pieces = []
    for count in (1, 2, 3):
        chosen = long.sum(axis=1) == count
        if not chosen.any():
            continue
        # Turned so that edge 01 is long, and where two are long, 12 as well.
        first = long[chosen].argmax(axis=1) if count != 2 else (long[chosen].argmin(axis=1) + 1) % 3
        order = (first[:, None] + np.arange(3)) % 3
        (a, b, c), (ab, bc, ca) = (np.take_along_axis(x[chosen], order, axis=1).T for x in (faces, middle))
        rows = {
            1: [(a, ab, c), (ab, b, c)],
            2: [(a, ab, c), (ab, b, bc), (ab, bc, c)],
            3: [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)],
        }[count]
        pieces += [np.stack(row, axis=1) for row in rows]
    return vertices, np.concatenate(pieces).astype(faces.dtype)
