"""The environment map of paper 1: a triangle mesh in the world frame, from a terrestrial laser scan (section 1)."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import trimesh

from course_lib.geometry import is_rotation
from course_lib.rendering.mesh_file import SceneMapError, read_mesh

_MIN_AREA = 1e-16  # square metres: a smaller triangle has no inside that a pixel centre could hit
MAX_COORDINATE = 2e7  # metres, half the Earth's circumference: no map has its zero farther away
MAX_DISTANCE = 5000.0  # metres: no part of a building lies farther from its middle
MAX_BUILDING = 200.0  # metres: a map that is larger in all three directions is doubtful; so is a part this far away
MAX_STEP = 1.5e-3  # metres between neighbouring numbers of a file in single precision; more is worth a warning
# Metres between the points that coordinates are taken from (`SceneMap.anchor`). Drawn 0.7 km from it a wall is wrong by
# 1 mm, at 80 m by 0.1 mm.
_ANCHOR_STEP = 100.0

_CURE = "To leave such triangles out: SceneMap.load(path, drop_far=True), or `localize --drop-far`"


class SceneMapWarning(UserWarning):
    """A map that can be used, but looks as if it were not meant so."""


class SceneMap:
    """Triangles in the world frame.

    vertices: `(V, 3)` float64 metres. faces: `(F, 3)` int32 vertex indices; both sides of a triangle are seen. bounds:
    `(2, 3)`. origin: `(3,)`, the median of the triangles' corners. Triangles without area are dropped. Raises
    `SceneMapError` (a `ValueError`) for vertices or faces that make no map.
    """

    def __init__(self, vertices: np.ndarray, faces: np.ndarray) -> None:
        # A copy: the map is frozen below, and the caller's array must neither freeze with it nor change it.
        vertices = np.array(vertices, dtype=np.float64)
        faces = np.asarray(faces)
        if vertices.ndim != 2 or vertices.shape[-1] != 3 or len(vertices) == 0:
            raise SceneMapError(f"the map needs vertices of shape (V, 3), V at least 3; got {vertices.shape}")
        if faces.ndim != 2 or faces.shape[-1] != 3 or len(faces) == 0:
            raise SceneMapError(
                f"the map needs triangles: faces of shape (F, 3), F at least 1; got {faces.shape}. "
                "A point cloud has none: mesh it first"
            )
        if not np.isfinite(vertices).all():
            n_bad = int((~np.isfinite(vertices)).any(axis=1).sum())
            raise SceneMapError(f"{n_bad} of {len(vertices)} vertices are NaN or infinite; remove them from the mesh")
        if not np.issubdtype(faces.dtype, np.integer) or faces.min() < 0 or faces.max() >= len(vertices):
            raise SceneMapError(
                f"faces must be whole numbers from 0 to {len(vertices) - 1} (the vertices); got {faces.dtype} from "
                f"{faces.min()} to {faces.max()}"
            )
        corners = vertices[faces]
        if np.abs(corners).max() > MAX_COORDINATE:
            raise SceneMapError(f"the map reaches beyond {MAX_COORDINATE:g} m: coordinates must be metres. {_CURE}")
        keep = trimesh.triangles.area(corners) > _MIN_AREA
        if not keep.any():
            raise SceneMapError(f"none of the {len(faces)} triangles has an area")
        self.vertices = vertices
        self.faces = np.ascontiguousarray(faces[keep], dtype=np.int32)
        used = corners[keep].reshape(-1, 3)
        self.bounds = np.stack([used.min(axis=0), used.max(axis=0)])
        self.origin = np.median(used, axis=0)
        for array in (self.vertices, self.faces, self.bounds, self.origin):
            array.setflags(write=False)

    @classmethod
    def load(cls, path: str | Path, drop_far: bool = False) -> SceneMap:
        """Return the map in any mesh file that trimesh reads (PLY, OBJ, STL, GLB, ...), its vertices in metres.

        drop_far: triangles farther than `MAX_DISTANCE` from the middle of the map are left out; else they are an error.
        Warns (`SceneMapWarning`) of what looks like millimetres or like a stray part. Raises `FileNotFoundError`, or
        `SceneMapError` for a file that cannot be read or holds fewer triangles than it announces. An OBJ announces
        nothing.
        """
        vertices, faces = read_mesh(path)
        try:
            found = cls(vertices, _of_one_building(vertices, faces, drop_far))
        except SceneMapError as error:
            raise SceneMapError(f"{path}: {error}") from None
        for doubt in _doubts(found):
            warnings.warn(f"{path}: {doubt}", SceneMapWarning, stacklevel=2)
        return found

    def transformed(self, matrix: np.ndarray) -> SceneMap:
        """The map moved by a rigid transform `(4, 4)`."""
        matrix = np.asarray(matrix, dtype=np.float64)
        if matrix.shape != (4, 4) or not np.isfinite(matrix).all() or not is_rotation(matrix[:3, :3]):
            raise ValueError("matrix must be a rigid transform (4, 4): finite, with a rotation in the upper left")
        return SceneMap(self.vertices @ matrix[:3, :3].T + matrix[:3, 3], self.faces)

    def anchor(self, positions: np.ndarray) -> np.ndarray:
        """Return the point `(3,)` that renderers subtract from vertices and cameras `(N, 3)` before anything becomes
        float32.

        The map's origin if the cameras are within some 50 m of it, else whole hundreds of metres from it, near them.
        """
        if len(positions) == 0:
            return self.origin
        middle = np.clip(np.median(positions, axis=0), *self.bounds)
        return self.origin + _ANCHOR_STEP * np.round((middle - self.origin) / _ANCHOR_STEP)

    def __reduce__(self) -> tuple[type[SceneMap], tuple[np.ndarray, np.ndarray]]:
        """For pickle and copy: made anew, since arrays that travel forget that they are read-only."""
        return SceneMap, (self.vertices, self.faces)

    def contains(self, positions: np.ndarray, margin: float = 0.0) -> np.ndarray:
        """Whether positions `(..., 3)` lie in the map's bounding box grown by `margin` metres: `(...)` bool."""
        positions = np.asarray(positions)
        low, high = self.bounds[0] - margin, self.bounds[1] + margin
        return ((positions >= low) & (positions <= high)).all(axis=-1)

    def __len__(self) -> int:
        return len(self.faces)

    def __repr__(self) -> str:
        size = self.bounds[1] - self.bounds[0]
        return f"SceneMap({len(self.faces)} triangles, {size[0]:.1f} x {size[1]:.1f} x {size[2]:.1f} m)"


def _of_one_building(vertices: np.ndarray, faces: np.ndarray, drop_far: bool) -> np.ndarray:
    """Return the faces without those absurdly far from the median of all corners. Raises `SceneMapError` unless
    dropped.
    """
    shapes = np.shape(vertices)[1:], np.shape(faces)[1:]
    if shapes != ((3,), (3,)) or not len(faces) or faces.min() < 0 or faces.max() >= len(vertices):
        return faces  # the map itself says what is wrong
    corners = vertices[faces]
    with np.errstate(invalid="ignore", over="ignore"):
        sound = (np.abs(corners) <= MAX_COORDINATE).all(axis=(1, 2))  # not what is NaN
        middle = np.median(corners[sound].reshape(-1, 3), axis=0) if sound.any() else np.zeros(3)
        distance = np.linalg.norm(corners - middle, axis=2)
        far_away = ~(distance <= MAX_DISTANCE).all(axis=1)
    if drop_far:
        return faces[~far_away]
    if far_away.any() and np.isfinite(corners).all():
        first = int(np.argmax(far_away))
        x, y, z = corners[first][distance[first].argmax()]
        raise SceneMapError(
            f"{int(far_away.sum())} of {len(corners)} triangles lie farther than {MAX_DISTANCE:g} m from the middle of "
            f"the map: triangle {first} has a corner at ({x:g}, {y:g}, {z:g}). Coordinates must be metres (are these "
            f"millimetres?). {_CURE}"
        )
    return faces


def _doubts(scene_map: SceneMap) -> Iterator[str]:
    """Why a map that can be used looks as if it were not meant."""
    corners = scene_map.vertices[scene_map.faces]
    size = scene_map.bounds[1] - scene_map.bounds[0]
    told = f"{size[0]:,.0f} x {size[1]:,.0f} x {size[2]:,.0f} m"
    if size.min() > MAX_BUILDING:
        yield f"the map is {told} large: are these millimetres? Coordinates must be metres"
    middles = corners.mean(axis=1)
    low, high = np.percentile(middles, (1, 99), axis=0)
    most = np.linalg.norm(high - low)
    if np.linalg.norm(size) > max(10 * most, MAX_BUILDING):
        away = np.linalg.norm(middles - scene_map.origin, axis=1)
        x, y, z = middles[away.argmax()]
        yield (
            f"the map is {told} large, but 98 % of its triangles lie within {most:,.0f} m: triangle {away.argmax()} at "
            f"({x:g}, {y:g}, {z:g}) is {away.max():,.0f} m from the middle. Does it belong to the building?"
        )
    step = float(np.spacing(np.float32(np.abs(corners).max())))
    if step > MAX_STEP and np.array_equal(corners, corners.astype(np.float32)):
        yield (
            f"coordinates of {np.abs(corners).max():,.0f} m in single precision have steps of {step * 1000:g} mm: "
            "move the map's zero into the building before saving it"
        )
