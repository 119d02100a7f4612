"""Find where a camera can be: clear of all surfaces, in front of enough of them, and on the side that was scanned.

A map of a real room is open, because the scanner did not see everything. So we do not ask whether a place is enclosed.
We ask whether a camera there could have seen what the map shows.
"""

from collections.abc import Iterator

import numpy as np
from scipy.stats import qmc

from course_lib.rendering.ray import EmbreeCaster
from course_lib.rendering.scene_map import SceneMap

# All chosen on development recordings (the kitchen, the rooms of a HoloLens, the shipped corridor).
CLEARANCE = 0.15  # metres to the nearest surface: no camera is nearer, and it would see nothing
NEAR_ENOUGH = 6.0  # metres: most depth cameras measure no farther
SEEN = 0.06  # share of all directions that must meet a surface near enough; a camera's image covers about as much
ACROSS = 0.3  # metres: surfaces that face each other across less free space than this do not count
CLEARLY = 2.0  # one side must face itself so many times as often as the other, or the normals tell nothing
MARGIN = 1.5  # metres about the map: it may show one side of a room, and the camera stood on the other
_DIRECTIONS = 64
_TRIES = 5_000  # positions tried at once
_MAX_ROUNDS = 40
_OFF = 0.01  # metres off a surface, where a ray starts


class FreeSpace:
    """Positions in a map where a camera can be.

    side: 1 if the normals of the map's triangles point to the side that was scanned, -1 if they point away from it, 0
    if they tell nothing. The scanned sides of a room face each other, so we count rays from triangle to triangle.
    seen_from: positions `(K, 3)` in metres where the scanner stood, if you know them; then what they see decides.
    """

    def __init__(self, scene_map: SceneMap, seen_from: np.ndarray | None = None) -> None:
        self._map = scene_map
        self.caster = EmbreeCaster(scene_map.vertices[scene_map.faces] - scene_map.origin)
        directions = np.random.default_rng(0).standard_normal((_DIRECTIONS, 3))  # the same for every position and seed
        self._directions = directions / np.linalg.norm(directions, axis=1, keepdims=True)
        self.bounds = scene_map.bounds + np.array([[-MARGIN], [MARGIN]])
        if seen_from is None:
            outer, inner = self._facing(1), self._facing(-1)
        else:
            outer, inner = ((self.look(np.atleast_2d(seen_from))[1] == side).sum() for side in (1, -1))
        self.side = 1 if outer > CLEARLY * inner else -1 if inner > CLEARLY * outer else 0

    def _facing(self, side: int) -> int:
        """Return how many rays that leave the map's triangles on this side (1 or -1) meet another on the same side."""
        rng, corners = np.random.default_rng(0), self._map.vertices[self._map.faces] - self._map.origin
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        areas = np.linalg.norm(normals, axis=1)
        chosen = rng.choice(len(corners), _TRIES, p=areas / areas.sum())
        normals = side * normals[chosen] / areas[chosen, None]
        starts = np.einsum("ni,nij->nj", rng.dirichlet(np.ones(3), _TRIES), corners[chosen]) + _OFF * normals
        turned = rng.standard_normal((_TRIES, 3))  # added to the normal: the cosine law
        directions = normals + 0.999 * turned / np.linalg.norm(turned, axis=1, keepdims=True)
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        distances, _, met = self.caster.cast(starts, directions)
        same = np.einsum("ij,ij->i", met, directions) * side < 0
        return int((np.isfinite(distances) & (distances > ACROSS) & same).sum())

    def contains(self, positions: np.ndarray) -> np.ndarray:
        """Return whether a camera can be at positions `(N, 3)`."""
        distances, sides = self.look(positions)
        seen = (sides * self.side >= 0) & (distances <= NEAR_ENOUGH)
        return (seen.mean(axis=1) >= SEEN) & (distances.min(axis=1) > CLEARANCE)

    def look(self, positions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return what positions `(N, 3)` see in 64 directions: distances and sides, `(N, 64)` each.

        A distance is in metres, `inf` where nothing is hit. A side is 1 if the triangle's normal points to the
        position, -1 if away from it, and 0 where nothing is hit.
        """
        origins = np.repeat(positions - self._map.origin, _DIRECTIONS, axis=0)
        directions = np.tile(self._directions, (len(positions), 1))
        distances, faces, normals = self.caster.cast(origins, directions)
        sides = -np.sign(np.einsum("ij,ij->i", normals, directions)) * (faces >= 0)
        return distances.reshape(-1, _DIRECTIONS), sides.reshape(-1, _DIRECTIONS)

    def draw(self, n: int, rng: np.random.Generator) -> np.ndarray:
        """Draw positions `(n, 3)` evenly from the free space. Raises `ValueError` if there is hardly any."""
        return self.spread_out(n, int(rng.integers(2**31)))[0]

    def spread_out(self, n: int, seed: int = 0) -> tuple[np.ndarray, float]:
        """Return n positions `(n, 3)`, more evenly than at random, and the free volume in cubic metres.

        They are a scrambled Halton sequence in the map's box, without the positions that are not free. Raises
        `ValueError` if hardly any is free.
        """
        found, tried = [], 0
        for positions in self._tries(seed):
            found.append(positions[self.contains(positions)])
            tried += len(positions)
            count = sum(map(len, found))
            if count >= n:
                return np.concatenate(found)[:n], float(np.prod(np.ptp(self.bounds, axis=0)) * count / tried)
        raise ValueError(
            f"{self._map!r} has hardly a place {CLEARANCE} m from all surfaces that sees some of them: is it in metres?"
        )

    def _tries(self, seed: int) -> Iterator[np.ndarray]:
        halton = qmc.Halton(3, seed=seed)
        for _ in range(_MAX_ROUNDS):
            yield qmc.scale(halton.random(_TRIES), *self.bounds)
