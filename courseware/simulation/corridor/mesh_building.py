"""The solids from which the corridor is put together, each set into the world by a `Placement`; PLY files. Metres."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import trimesh
from scipy.spatial import ConvexHull

from courseware.simulation.corridor.materials import Material

_UNIT_CORNERS = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
_BOX_FACES = np.array(
    [[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4], [2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6],
     [1, 3, 5], [3, 7, 5]]
)  # fmt: skip


@dataclass(frozen=True)
class WorldMesh:
    """One state of the world as triangles."""

    vertices: np.ndarray  # `(V, 3)` metres
    faces: np.ndarray  # `(F, 3)`
    reflectivity: np.ndarray  # `(F,)` at 850 nm, 0 to 1
    colours: np.ndarray  # `(F, 3)` 0 to 255


@dataclass(frozen=True)
class Placement:
    """A local frame in the world: origin `(3,)`, and the directions of its axes as rows of `axes` `(3, 3)`."""

    origin: np.ndarray = field(default_factory=lambda: np.zeros(3))
    axes: np.ndarray = field(default_factory=lambda: np.eye(3))

    def __call__(self, points: np.ndarray) -> np.ndarray:
        return self.origin + np.asarray(points, dtype=np.float64) @ self.axes

    def moved(self, along: float = 0.0, into: float = 0.0, up: float = 0.0, turn_deg: float = 0.0) -> Placement:
        """The frame moved by local steps in metres, then turned about its own up axis (first axis to second)."""
        c, s = np.cos(np.deg2rad(turn_deg)), np.sin(np.deg2rad(turn_deg))
        turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        return Placement(self([along, into, up]), turn @ self.axes)


class MeshBuilder:
    """Collects solids; `build` gives the `WorldMesh`."""

    def __init__(self, bow: Callable[[np.ndarray], np.ndarray] | None = None) -> None:
        """bow: displacement in metres of large panels at world points `(N, 3)`, along the panel's normal."""
        self._pieces: list[tuple[np.ndarray, np.ndarray, Material]] = []
        self._bow = bow or (lambda points: np.zeros(len(points)))

    def add(self, vertices: np.ndarray, faces: np.ndarray, material: Material, closed: bool = True) -> None:
        """Add triangles given in world coordinates; those of a closed solid are turned to face outward."""
        vertices, faces = np.asarray(vertices, dtype=np.float64), np.asarray(faces)
        if closed:
            signed_volume = trimesh.Trimesh(vertices - vertices.mean(axis=0), faces, process=False).volume
            faces = faces if signed_volume > 0 else faces[:, ::-1]
        self._pieces.append((vertices, faces, material))

    def box(self, place: Placement, low: tuple, high: tuple, material: Material, bevel: float = 0.0) -> None:
        """Box between two local corners; `bevel` metres are cut off every edge."""
        low, high = np.minimum(low, high).astype(float), np.maximum(low, high).astype(float)
        if bevel <= 0 or (high - low).min() <= 2.1 * bevel:
            self.add(place(low + _UNIT_CORNERS * (high - low)), _BOX_FACES, material)
        else:
            self.add(place(low + _bevelled_corners(high - low, bevel)), _bevelled_faces(), material)

    def panel(self, place: Placement, corner: tuple, u: tuple, v: tuple, material: Material, step: float = 0.5) -> None:
        """Large rectangle from a local corner along u and v, in cells of about `step` metres, bowed like a wall."""
        corner, u, v = (np.asarray(a, dtype=float) for a in (corner, u, v))
        n_u, n_v = (max(1, int(np.ceil(np.linalg.norm(a) / step))) for a in (u, v))
        i, j = np.meshgrid(np.arange(n_u + 1), np.arange(n_v + 1), indexing="ij")
        points = place(corner + (i / n_u).reshape(-1, 1) * u + (j / n_v).reshape(-1, 1) * v)
        normal = np.cross(u, v) / np.linalg.norm(np.cross(u, v)) @ place.axes
        points += self._bow(points)[:, None] * np.abs(normal)
        index = (i * (n_v + 1) + j)[:-1, :-1].ravel()
        first = np.stack([index, index + n_v + 1, index + 1], axis=1)
        second = np.stack([index + 1, index + n_v + 1, index + n_v + 2], axis=1)
        self.add(points, np.concatenate([first, second]), material, closed=False)

    def tube(self, place: Placement, start: tuple, end: tuple, radius: float, material: Material, n: int = 12) -> None:
        """Closed cylinder of n sides between two local points."""
        mesh = trimesh.creation.cylinder(radius=radius, segment=np.array([place(start), place(end)]), sections=n)
        self.add(mesh.vertices, mesh.faces, material)

    def ellipsoid(self, place: Placement, centre: tuple, radii: tuple, material: Material, level: int = 2) -> None:
        """Ellipsoid with its axes along the local axes."""
        ball = trimesh.creation.icosphere(subdivisions=level)
        self.add(place(np.asarray(centre) + ball.vertices * np.asarray(radii)), ball.faces, material)

    def cone(self, place: Placement, at: tuple, bottom: float, top: float, height: float, material: Material) -> None:
        """Frustum standing on a local point: bottom and top radius, height; closed."""
        angle = np.linspace(0, 2 * np.pi, 24, endpoint=False)
        ring = np.stack([np.cos(angle), np.sin(angle), np.zeros(24)], axis=1)
        points = np.concatenate([ring * bottom, ring * top + [0, 0, height], [[0, 0, 0], [0, 0, height]]])
        i, k = np.arange(24), (np.arange(24) + 1) % 24
        sides = np.concatenate([np.stack([i, k, i + 24], 1), np.stack([k, k + 24, i + 24], 1)])
        caps = np.concatenate([np.stack([k, i, np.full(24, 48)], 1), np.stack([i + 24, k + 24, np.full(24, 49)], 1)])
        self.add(place(np.asarray(at) + points), np.concatenate([sides, caps]), material)

    def take(self, other: MeshBuilder) -> None:
        """Add all solids of another builder."""
        self._pieces += other._pieces

    def build(self) -> WorldMesh:
        """All solids as one mesh."""
        vertices, faces, materials = zip(*self._pieces, strict=True)
        counts = [len(each) for each in faces]
        return WorldMesh(
            *trimesh.util.append_faces(vertices, faces),
            reflectivity=np.repeat([material.reflectivity for material in materials], counts),
            colours=np.repeat(np.array([material.colour for material in materials], np.uint8), counts, axis=0),
        )


def _bevelled_corners(size: np.ndarray, bevel: float) -> np.ndarray:
    """Corners `(24, 3)` of a box from the origin with bevelled edges: each of its 8 corners becomes three."""
    outward = np.where(_UNIT_CORNERS > 0, bevel, -bevel)
    inner = _UNIT_CORNERS * size - outward
    return np.concatenate([inner + outward * np.eye(3)[axis] for axis in range(3)])


@functools.cache
def _bevelled_faces() -> np.ndarray:
    """Triangles `(44, 3)` of `_bevelled_corners`, outward: the hull of one such box serves boxes of all sizes."""
    points = _bevelled_corners(np.ones(3), 0.2)
    faces = ConvexHull(points).simplices
    corners = points[faces]
    inward = np.einsum("ij,ij->i", trimesh.triangles.cross(corners), corners.mean(axis=1) - 0.5) < 0
    return np.where(inward[:, None], faces[:, ::-1], faces)


def to_polydata(vertices: np.ndarray, faces: np.ndarray):
    """pyvista mesh of vertices `(V, 3)` and triangles `(F, 3)`."""
    import course_lib.rendering.vtk_backend  # noqa: F401, I001 - before pyvista: no display is needed
    import pyvista

    return pyvista.PolyData.from_regular_faces(np.asarray(vertices), np.asarray(faces, dtype=np.int64))


def write_ply(
    path: str | Path, vertices: np.ndarray, faces: np.ndarray, comment: str, columns: Sequence[tuple] = ()
) -> None:
    """Triangles as binary PLY, metres; columns: what else a vertex has, (name, NumPy's type, PLY's type, values)."""
    columns = [*((name, "<f4", "float", values) for name, values in zip("xyz", vertices.T, strict=True)), *columns]
    table = np.zeros(len(vertices), dtype=[(name, kind) for name, kind, _, _ in columns])
    for name, _, _, values in columns:
        table[name] = values
    rows = np.zeros(len(faces), dtype=[("count", "u1"), ("index", "<i4", 3)])
    rows["count"], rows["index"] = 3, faces
    header = ["ply", "format binary_little_endian 1.0", f"comment {comment}", f"element vertex {len(table)}"]
    header += [f"property {kind} {name}" for name, _, kind, _ in columns]
    header += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header", ""]
    Path(path).write_bytes("\n".join(header).encode("ascii") + table.tobytes() + rows.tobytes())


def write_world_ply(path: str | Path, world: WorldMesh, comment: str) -> None:
    """A world as PLY, colour and reflectivity at its vertices: solids share none, so they are values of faces."""
    colours, reflectivity = np.zeros((len(world.vertices), 3), np.uint8), np.zeros(len(world.vertices), np.float32)
    colours[world.faces] = world.colours[:, None]
    reflectivity[world.faces] = world.reflectivity[:, None]
    columns = [(name, "u1", "uchar", one) for name, one in zip(("red", "green", "blue"), colours.T, strict=True)]
    columns.append(("reflectivity", "<f4", "float", reflectivity))
    write_ply(path, world.vertices, world.faces, comment, columns)
