"""Read and check the environment map of paper 1: a triangle mesh in the world frame, from a laser scan (section 1).

trimesh reads the file. We count its triangles, because trimesh reads half a file without an error.
"""

from __future__ import annotations

import codecs
import io
import re
import warnings
from pathlib import Path

import numpy as np
import trimesh

from course_lib.files import read_bytes
from course_lib.geometry import is_rotation, rotation_to_z_up
from course_lib.rendering.errors import SceneMapError, SceneMapWarning

_MIN_AREA = 1e-16  # square metres: no pixel centre hits a smaller triangle
MAX_COORDINATE = 2e7  # metres, half the Earth's circumference: no map has its zero farther away
MAX_DISTANCE = 5000.0  # metres: no part of a building is farther from its middle
MAX_BUILDING = 200.0  # metres: a map that is larger in all three directions is doubtful
# Metres between possible anchors. A wall drawn 0.7 km from the anchor is wrong by 1 mm, at 80 m by 0.1 mm.
_ANCHOR_STEP = 100.0

_CURE = "To leave such triangles out: drop_far=True, or `localize --drop-far`"


class SceneMap:
    """Hold a map of triangles in the world frame.

    Both sides of a triangle are seen. Triangles without an area are left out. The attributes are read-only: `vertices`
    and `faces`, `bounds` `(2, 3)`, and `origin` `(3,)`, the median of the corners. Warns (`SceneMapWarning`) if the
    map looks like millimetres.

    Parameters
    ----------
    vertices : array `(V, 3)`
        Corners in metres.
    faces : array `(F, 3)` of integers
        Three indices into `vertices` for each triangle.
    up : "x", "y", "z", "-x", "-y" or "-z"
        The axis of the vertices that points up. It becomes z.
    drop_far : bool
        Whether triangles farther than `MAX_DISTANCE` from the middle are left out.

    Raises
    ------
    SceneMapError
        If the arrays hold no triangles, are not finite, or reach beyond `MAX_COORDINATE`.
    """

    def __init__(
        self, vertices: np.ndarray, faces: np.ndarray, *, up: str = "z", drop_far: bool = False, _name: str = ""
    ) -> None:
        # A copy, because the map is frozen below, and the caller's array must neither freeze with it nor change it.
        vertices = np.array(vertices, dtype=np.float64)
        faces = np.asarray(faces)
        if (vertices.shape[1:], faces.shape[1:]) != ((3,), (3,)) or not len(vertices) or not len(faces):
            raise SceneMapError(
                f"{_name}the map needs triangles: vertices of shape (V, 3), faces of shape (F, 3); got "
                f"{vertices.shape} and {faces.shape}. A point cloud has no faces: mesh it first"
            )
        if not np.isfinite(vertices).all():
            raise SceneMapError(f"{_name}vertices are NaN or infinite; remove them from the mesh")
        if not np.issubdtype(faces.dtype, np.integer) or faces.min() < 0 or faces.max() >= len(vertices):
            numbers = f"{faces.min()} to {faces.max()} ({faces.dtype})"
            raise SceneMapError(f"{_name}faces must be whole numbers from 0 to {len(vertices) - 1}; got {numbers}")
        vertices = vertices @ rotation_to_z_up(up)[:3, :3].T
        far, doubt = _far_triangles(vertices[faces])
        if drop_far:
            faces, doubt = faces[~far], ""
        elif doubt and _name:
            raise SceneMapError(_name + doubt)
        corners = vertices[faces]
        if np.abs(corners).max(initial=0.0) > MAX_COORDINATE:
            raise SceneMapError(f"{_name}the map reaches beyond {MAX_COORDINATE:g} m: are these metres? {_CURE}")
        keep = trimesh.triangles.area(corners) > _MIN_AREA
        if not keep.any():
            raise SceneMapError(f"{_name}none of the {len(faces)} triangles has an area")
        self.vertices = vertices
        self.faces = np.ascontiguousarray(faces[keep], dtype=np.int32)
        used = corners[keep].reshape(-1, 3)
        self.bounds = np.stack([used.min(axis=0), used.max(axis=0)])
        self.origin = np.median(used, axis=0)
        for array in (self.vertices, self.faces, self.bounds, self.origin):
            array.setflags(write=False)
        size = np.ptp(self.bounds, axis=0)
        if not doubt and size.min() > MAX_BUILDING:
            doubt = f"the map is {' x '.join(f'{x:,.0f}' for x in size)} m large: are these millimetres?"
        if doubt:
            warnings.warn(_name + doubt, SceneMapWarning, stacklevel=3 if _name else 2)

    @classmethod
    def load(cls, path: str | Path, drop_far: bool = False, *, up: str = "z") -> SceneMap:
        """Return the map in a mesh file.

        Parameters
        ----------
        path : str or Path
            Any mesh that trimesh reads (PLY, OBJ, STL, GLB, ...), its vertices in metres.
        drop_far, up
            As in the class.

        Raises
        ------
        FileNotFoundError
            If there is no such file.
        SceneMapError
            If the file cannot be read, holds fewer triangles than it announces (an OBJ announces nothing), or has
            triangles far away and drop_far is False.
        """
        return cls(*read_mesh(path), up=up, drop_far=drop_far, _name=f"{path}: ")

    @classmethod
    def from_trimesh(cls, mesh: trimesh.Trimesh | trimesh.Scene, *, up: str = "z", drop_far: bool = False) -> SceneMap:
        """Return the map of a mesh or scene in memory, its vertices in metres; arguments and errors as in the class."""
        return cls(*_triangles_of(mesh), up=up, drop_far=drop_far)

    def transformed(self, matrix: np.ndarray) -> SceneMap:
        """Return the map moved by a rigid transform `(4, 4)`. Raises `ValueError` for another matrix."""
        matrix = np.asarray(matrix, dtype=np.float64)
        if matrix.shape != (4, 4) or not np.isfinite(matrix).all() or not is_rotation(matrix[:3, :3]):
            raise ValueError("matrix must be a rigid transform (4, 4): finite, with a rotation in the upper left")
        return SceneMap(self.vertices @ matrix[:3, :3].T + matrix[:3, 3], self.faces)

    def anchor(self, positions: np.ndarray) -> np.ndarray:
        """Return the point `(3,)` near cameras `(N, 3)` that renderers subtract before anything becomes float32.

        It is the map's origin, or whole hundreds of metres from it, so that it rarely changes.
        """
        middle = np.clip(np.median(positions, axis=0), *self.bounds)
        return self.origin + _ANCHOR_STEP * np.round((middle - self.origin) / _ANCHOR_STEP)

    def __reduce__(self) -> tuple[type[SceneMap], tuple[np.ndarray, np.ndarray]]:
        """Return how pickle and copy build the map again, because copied arrays would not be read-only."""
        return SceneMap, (self.vertices, self.faces)

    def contains(self, positions: np.ndarray, margin: float = 0.0) -> np.ndarray:
        """Return whether positions `(..., 3)` lie in the map's bounding box grown by `margin` metres: `(...)` bool."""
        positions = np.asarray(positions)
        low, high = self.bounds[0] - margin, self.bounds[1] + margin
        return ((positions >= low) & (positions <= high)).all(axis=-1)

    def __len__(self) -> int:
        return len(self.faces)

    def __repr__(self) -> str:
        size = self.bounds[1] - self.bounds[0]
        return f"SceneMap({len(self.faces)} triangles, {size[0]:.1f} x {size[1]:.1f} x {size[2]:.1f} m)"


def _far_triangles(corners: np.ndarray) -> tuple[np.ndarray, str]:
    """Return which triangles `(F, 3, 3)` are over `MAX_DISTANCE` from the median of all corners, and a sentence."""
    sound = (np.abs(corners) <= MAX_COORDINATE).all(axis=(1, 2))
    middle = np.median(corners[sound].reshape(-1, 3), axis=0) if sound.any() else np.zeros(3)
    with np.errstate(over="ignore"):
        distance = np.linalg.norm(corners - middle, axis=2)
    far_away = (distance > MAX_DISTANCE).any(axis=1)
    if not far_away.any():
        return far_away, ""
    first = int(np.argmax(far_away))
    x, y, z = corners[first][distance[first].argmax()]
    return far_away, (
        f"{int(far_away.sum())} of {len(corners)} triangles lie over {MAX_DISTANCE:g} m from the map's middle: "
        f"triangle {first} has a corner at ({x:g}, {y:g}, {z:g}). Are these millimetres? {_CURE}"
    )


def mesh_endings() -> set[str]:
    """Return the endings of files that are read as meshes, such as "ply". Archives are not: they may hold anything."""
    return set(trimesh.available_formats()) - {"zip", "tar.gz", "tar.bz2"}


def read_mesh(path: str | Path) -> tuple[np.ndarray, np.ndarray]:
    """Return the vertices `(V, 3)` and faces `(F, 3)` of a mesh file; errors as in `SceneMap.load`."""
    path = Path(path)
    data = read_bytes(path, "map", SceneMapError, missing=FileNotFoundError)
    kind = path.suffix.lower().lstrip(".")
    if kind not in mesh_endings():
        raise SceneMapError(f"map {path} ends in {path.suffix!r}, which is no mesh: give PLY, OBJ, STL, OFF or GLB")
    if kind in ("ply", "off", "obj"):
        data = data.removeprefix(codecs.BOM_UTF8)  # with this mark trimesh would not know the first word
    try:
        n_vertices, n_faces = _announced(data, kind)
        resolver = trimesh.resolvers.FilePathResolver(path)  # of the parts of a .gltf
        mesh = trimesh.load(io.BytesIO(data), kind, resolver=resolver, process=False, skip_materials=True)
        vertices, faces = _triangles_of(mesh)
        if len(vertices) < n_vertices or len(faces) < n_faces:
            there = f"{len(vertices)} and {len(faces)} there"
            raise ValueError(f"{n_vertices} vertices and {n_faces} faces announced, {there}")
    except Exception as reason:  # trimesh's readers raise errors of all kinds
        reading = f"map {path} cannot be read as a mesh ({type(reason).__name__}: {reason}). Is the file complete?"
        raise SceneMapError(reading) from reason
    return vertices, faces


def _triangles_of(mesh: trimesh.Trimesh | trimesh.Scene) -> tuple[np.ndarray, np.ndarray]:
    """Return the vertices `(V, 3)` and faces `(F, 3)` of trimesh's object; a point cloud has no faces."""
    if isinstance(mesh, trimesh.Scene):
        mesh = mesh.to_mesh()
    if not hasattr(mesh, "vertices"):
        raise SceneMapError(f"mesh must be a trimesh.Trimesh or a trimesh.Scene; got {type(mesh).__name__}")
    return mesh.vertices, getattr(mesh, "faces", np.empty((0, 3), dtype=np.int64))


def _announced(data: bytes, kind: str) -> tuple[int, int]:
    """Return how many vertices and faces a file of this kind announces: at least so many a whole file holds."""
    if kind == "stl":
        return 0, 1  # trimesh reads nothing at all from half a file
    if kind == "off":
        rows = [row for line in data.splitlines() if (row := line.partition(b"#")[0].strip())]
        counts = re.match(rb"\S*OFF\s+(\d+)\s+(\d+)", b" ".join(rows[:2]))
        return (int(counts[1]), int(counts[2])) if counts else (0, 0)
    if kind != "ply":
        return 0, 0
    header, _, body = data.partition(b"end_header")
    counts = {name: int(count) for name, count in re.findall(rb"element\s+(\S+)\s+(\d+)", header)}
    if re.search(rb"format\s+ascii", header):
        rows = [line.split() for line in body.splitlines() if line.strip()]
        if len(rows) < sum(counts.values()):
            raise ValueError(f"it announces {sum(counts.values()):,} rows and holds {len(rows):,}")
        first, _, others = header.partition(b"element")[2].partition(b"element")
        n_words = len(re.findall(rb"property", first)) if b"list" not in first else 0
        if others and n_words and any(len(words) != n_words for words in rows[: int(first.split()[1])]):
            raise ValueError(f"a row of its element {first.split()[0].decode()} has not {n_words} numbers")
    return counts.get(b"vertex", 0), counts.get(b"face", 0)
