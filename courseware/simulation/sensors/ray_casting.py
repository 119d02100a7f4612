"""Rays through the true world, with what they meet: distance, incidence and reflectivity."""

from dataclasses import dataclass

import numpy as np

from course_lib.rendering.ray import EmbreeCaster

# Rays per call, so that the results of one call stay below about 100 MB.
_BATCH = 1_000_000


@dataclass(frozen=True)
class Hits:
    """What rays met, arrays of the rays' shape."""

    distance: np.ndarray  # in units of the direction's length, inf = nothing
    cosine: np.ndarray  # of incidence, 0 to 1
    face: np.ndarray  # index, -1 = nothing


class WorldCaster:
    """Casts rays at triangles: vertices `(V, 3)` metres, faces `(F, 3)`; reflectivity `(F,)` or one number."""

    def __init__(self, vertices: np.ndarray, faces: np.ndarray, reflectivity: np.ndarray | float = 1.0) -> None:
        self._caster = EmbreeCaster(vertices[faces])
        self.reflectivity = np.broadcast_to(np.asarray(reflectivity, dtype=np.float64), (len(faces),))

    def cast(self, origins: np.ndarray, directions: np.ndarray) -> Hits:
        """First hits of rays; origins and directions broadcast to `(..., 3)`, directions need not have length one."""
        origins, directions = np.broadcast_arrays(np.float32(origins), np.float32(directions))
        shape = directions.shape[:-1]
        origins, directions = origins.reshape(-1, 3), directions.reshape(-1, 3)
        n = len(directions)
        distance, cosine, face = np.empty(n, np.float32), np.empty(n, np.float32), np.empty(n, np.int32)
        for start in range(0, n, _BATCH):
            part = slice(start, start + _BATCH)
            d = directions[part]
            distance[part], face[part], normal = self._caster.cast(origins[part], d)
            length = np.linalg.norm(normal, axis=1) * np.linalg.norm(d, axis=1)
            slant = np.abs(np.einsum("ij,ij->i", normal, d)) / np.where(length > 0, length, 1)
            cosine[part] = np.where(face[part] >= 0, slant, 0)
        return Hits(distance.reshape(shape), cosine.reshape(shape), face.reshape(shape))
