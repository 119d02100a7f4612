"""The environment map of paper 1: a triangle mesh in the world frame, from a terrestrial laser scan (section 1)."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import trimesh

from course_lib.geometry import is_rotation

# Below this area (square metres) a triangle has no inside that a pixel centre could hit.
_DEGENERATE_AREA = 1e-16

# No place on Earth lies farther than this many metres, half its circumference, from where a map could have its zero.
MAX_COORDINATE = 2e7

# Metres between the points that coordinates are taken from (`SceneMap.anchor`). Drawn 0.7 km from it a wall is wrong by
# 1 mm, at 80 m by 0.1 mm.
_ANCHOR_STEP = 100.0


class SceneMapError(ValueError):
    """A map that cannot be used: unreadable, empty, or with values that are no geometry."""


class SceneMap:
    """Triangles in the world frame.

    vertices: `(V, 3)` float64 metres. faces: `(F, 3)` int32 vertex indices; the winding does not matter, both sides of
    a triangle are seen. bounds: `(2, 3)`, least and greatest coordinates. origin: `(3,)` float64, the median of
    the triangles' corners: where most of the map is, however far away a stray triangle lies (`anchor`).
    Raises `SceneMapError` (a `ValueError`) for an empty mesh, no faces, vertices that are not finite, a triangle too
    far away to be part of a building, or indices out of range. Triangles without area are dropped.
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
        _require_places_on_earth(corners)
        keep = trimesh.triangles.area(corners) > _DEGENERATE_AREA
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
    def load(cls, path: str | Path) -> SceneMap:
        """Map from any mesh file that trimesh reads (PLY, OBJ, STL, GLB, ...), its vertices in metres.

        Raises `FileNotFoundError` where there is no file, `SceneMapError` where it cannot be read, holds no triangles,
        or fewer than its own header announces (PLY, OFF; an OBJ file has no header, so a truncated one goes unnoticed).
        """
        path = Path(path)
        if not path.is_file():
            raise FileNotFoundError(f"no map at {path}: give the path of a mesh file (PLY, OBJ, STL or GLB)")
        try:
            mesh = trimesh.load(path, process=False)
            if isinstance(mesh, trimesh.Scene):
                mesh = mesh.to_mesh() if mesh.geometry else None
            vertices = getattr(mesh, "vertices", np.empty((0, 3)))
            faces = getattr(mesh, "faces", np.empty((0, 3), dtype=np.int32))
        except Exception as error:  # trimesh's readers raise whatever their parsing stumbles on
            raise SceneMapError(
                f"{path} cannot be read as a mesh ({type(error).__name__}: {error}): is it complete, and PLY, OBJ, STL "
                "or GLB?"
            ) from error
        if len(vertices) == 0:
            raise SceneMapError(f"{path} holds neither vertices nor triangles: is the file complete?")
        if faces is None or len(faces) == 0:
            raise SceneMapError(f"{path} holds no triangles ({len(vertices)} vertices): mesh it first")
        announced = _announced_faces(path)
        if announced is not None and len(faces) < announced:
            raise SceneMapError(f"{path} announces {announced} faces and holds {len(faces)}: the file is not complete")
        try:
            return cls(vertices, faces)
        except SceneMapError as error:
            raise SceneMapError(f"{path}: {error}") from None

    def transformed(self, matrix: np.ndarray) -> SceneMap:
        """The map moved by a rigid transform `(4, 4)`."""
        matrix = np.asarray(matrix, dtype=np.float64)
        if matrix.shape != (4, 4) or not np.isfinite(matrix).all() or not is_rotation(matrix[:3, :3]):
            raise ValueError("matrix must be a rigid transform (4, 4): finite, with a rotation in the upper left")
        return SceneMap(self.vertices @ matrix[:3, :3].T + matrix[:3, 3], self.faces)

    def anchor(self, positions: np.ndarray) -> np.ndarray:
        """The point `(3,)` that renderers subtract from vertices and cameras before anything becomes float32.

        positions: `(N, 3)` of the cameras. The anchor is the map's origin where the cameras are within some 50 m
        of it, else whole hundreds of metres from it and near them: a millimetre there is still a millimetre, however
        far away other parts of the map lie.
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


def _require_places_on_earth(corners: np.ndarray) -> None:
    """Raises `SceneMapError` where one of the triangles `(F, 3, 3)` is too far away for a building."""
    far_away = (np.abs(corners) > MAX_COORDINATE).any(axis=(1, 2))
    if far_away.any():
        first = int(np.argmax(far_away))
        x, y, z = corners[first][np.abs(corners[first]).max(axis=1).argmax()]
        raise SceneMapError(
            f"{int(far_away.sum())} of {len(corners)} triangles lie beyond {MAX_COORDINATE:g} m, where no building is: "
            f"triangle {first} has a corner at ({x:g}, {y:g}, {z:g}). Coordinates must be metres. To drop such "
            "triangles: mesh = trimesh.load(path, process=False); "
            f"mesh.update_faces((abs(mesh.triangles) <= {MAX_COORDINATE:g}).all(axis=(1, 2))); mesh.export(path)"
        )


def _announced_faces(path: Path) -> int | None:
    """Number of faces that the header of a PLY or OFF file announces; None where there is no such header."""
    with path.open("rb") as file:
        header = file.read(1 << 16)
    if header.startswith(b"ply"):
        match = re.search(rb"^element face (\d+)", header.split(b"end_header")[0], re.M)
        return int(match.group(1)) if match else None
    if header.startswith(b"OFF"):
        numbers = re.findall(rb"\d+", re.sub(rb"#.*", b"", header[3:]))
        return int(numbers[1]) if len(numbers) > 1 else None
    return None
