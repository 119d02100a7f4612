"""A small world of boxes for the sensors of `courseware.simulation`. NumPy alone computes its ray hits, exactly.

The corridor's world needs a ray caster that can be installed on some processors only. The lessons must run everywhere,
so their worlds consist of boxes along the axes. `BoxWorld.cast` returns the same as `WorldCaster.cast`.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import trimesh

from course_lib.rendering.scene_map import SceneMap
from courseware.simulation.sensors.ray_casting import Hits


def box_map(*boxes: tuple[tuple, tuple]) -> SceneMap:
    """Return a map of boxes. Each box is a pair of opposite corners (x, y, z) [m]."""
    mesh = trimesh.util.concatenate([trimesh.creation.box(bounds=np.array(corners, dtype=float)) for corners in boxes])
    return SceneMap(mesh.vertices, mesh.faces)


class Box(NamedTuple):
    """One box along the axes: opposite corners [m] and a reflectivity.

    Each coordinate of `high` is larger than that of `low`. reflectivity [-]: 0 to 1 for a surface that scatters light
    evenly, above 1 for retroreflective tape.
    """

    low: tuple[float, float, float]
    high: tuple[float, float, float]
    reflectivity: float


class BoxWorld:
    """Boxes with reflectivities. It replaces a `WorldCaster`, and the index of a face is the index of its box.

    Raises `ValueError` if there are no boxes, or if a box's `high` is not above its `low`.
    """

    def __init__(self, boxes: Sequence[Box]) -> None:
        self.boxes = tuple(boxes)
        self.low, self.high = (np.array([box[k] for box in self.boxes], dtype=np.float64) for k in (0, 1))
        if not self.boxes or (self.high <= self.low).any():
            raise ValueError("a box world needs boxes, and every coordinate of a box's `high` must be above its `low`")
        self.reflectivity = np.array([box.reflectivity for box in self.boxes], dtype=np.float64)

    def cast(self, origins: np.ndarray, directions: np.ndarray) -> Hits:
        """Return the first hit of each ray. Origins [m] and directions broadcast to `(..., 3)`.

        The origins must lie outside the boxes. A ray is inside a box while it is between both planes of all three axes,
        so from t = max_k min(t_k) to t = min_k max(t_k). It hits the face of the axis that it enters last.
        """
        directions = np.asarray(directions, dtype=np.float32)
        origins = np.asarray(origins, dtype=np.float32)
        shape = np.broadcast_shapes(origins.shape, directions.shape)[:-1]
        # One contiguous array per axis, because reductions over a last axis of length three are slow.
        o = [np.ascontiguousarray(np.broadcast_to(origins[..., k], shape)) for k in range(3)]
        d = [np.ascontiguousarray(np.broadcast_to(directions[..., k], shape)) for k in range(3)]
        with np.errstate(divide="ignore"):
            inverse = [1 / axis for axis in d]
        distance = np.full(shape, np.inf, np.float32)
        face, entered = np.full(shape, -1, np.int32), np.zeros(shape, np.int8)
        for number, (low, high) in enumerate(zip(self.low, self.high, strict=True)):
            enters, leaves = np.full(shape, -np.inf, np.float32), np.full(shape, np.inf, np.float32)
            axis = np.zeros(shape, np.int8)
            for k in range(3):
                with np.errstate(invalid="ignore"):
                    a, b = (np.float32(low[k]) - o[k]) * inverse[k], (np.float32(high[k]) - o[k]) * inverse[k]
                first = np.minimum(a, b)
                axis[first > enters] = k
                enters, leaves = np.maximum(enters, first), np.minimum(leaves, np.maximum(a, b))
            hit = (enters <= leaves) & (enters > 0) & (enters < distance)
            distance[hit], face[hit], entered[hit] = enters[hit], number, axis[hit]
        length = np.sqrt(d[0] ** 2 + d[1] ** 2 + d[2] ** 2)
        cosine = np.abs(np.choose(entered, d)) / length
        return Hits(distance, np.where(face >= 0, cosine, 0).astype(np.float32), face)

    def mesh(self) -> SceneMap:
        """Return the surfaces of the boxes as triangles."""
        return box_map(*((box.low, box.high) for box in self.boxes))
