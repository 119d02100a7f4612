"""Where in a closed building a camera can be: not inside a wall, and not outside.

The library's own `FreeSpace` also knows maps of real rooms, which are open.
"""

import numpy as np

from course_lib.rendering.ray import EmbreeCaster
from course_lib.rendering.scene_map import SceneMap

CLEARANCE = 0.15  # metres to the nearest surface (chosen: no camera is nearer, and it would see nothing)
ENCLOSED = 0.65  # share of directions that must meet the map of a building (chosen: just outside a wall it is half)
_DIRECTIONS = 32
_TRIES = 20_000  # positions drawn at once
_MAX_ROUNDS = 30


class EnclosedSpace:
    """Positions in a closed building where a camera can be."""

    def __init__(self, scene_map: SceneMap) -> None:
        self._map = scene_map
        self._caster = EmbreeCaster(scene_map.vertices[scene_map.faces] - scene_map.origin)
        directions = np.random.default_rng(0).standard_normal((_DIRECTIONS, 3))  # the same for every position and seed
        self._directions = directions / np.linalg.norm(directions, axis=1, keepdims=True)

    def contains(self, positions: np.ndarray) -> np.ndarray:
        """Return whether positions `(N, 3)` are clear of surfaces and enclosed by them."""
        distances = self.distances(positions)
        return (distances.min(axis=1) > CLEARANCE) & (np.isfinite(distances).mean(axis=1) >= ENCLOSED)

    def distances(self, positions: np.ndarray) -> np.ndarray:
        """Return the distances `(N, 32)` in metres from positions `(N, 3)` to the map in 32 directions; `inf`: none."""
        origins = np.repeat(positions - self._map.origin, _DIRECTIONS, axis=0)
        distances = self._caster.cast(origins, np.tile(self._directions, (len(positions), 1)))[0]
        return distances.reshape(len(positions), _DIRECTIONS)

    def draw(self, n: int, rng: np.random.Generator) -> np.ndarray:
        """Draw positions `(n, 3)` evenly from the free space. Raises `ValueError` if there is hardly any."""
        found: list[np.ndarray] = []
        low, high = self._map.bounds
        for _ in range(_MAX_ROUNDS):
            if sum(len(positions) for positions in found) >= n:
                return np.concatenate(found)[:n]
            tried = rng.uniform(low, high, (_TRIES, 3))
            found.append(tried[self.contains(tried)])
        raise ValueError(
            f"{self._map!r} has hardly a free place {CLEARANCE} m from all surfaces: is it closed, and in metres?"
        )
