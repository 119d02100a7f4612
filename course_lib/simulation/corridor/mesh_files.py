"""Meshes on disk and in VTK: binary PLY, float32, with colour and reflectivity where the mesh has them."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import course_lib.rendering.vtk_backend  # noqa: F401 - before pyvista: no display is needed
from course_lib.simulation.corridor.mesh_building import WorldMesh

_FACE = np.dtype([("count", "u1"), ("index", "<i4", 3)])


def to_polydata(vertices: np.ndarray, faces: np.ndarray):
    """pyvista mesh of vertices `(V, 3)` and triangles `(F, 3)`."""
    import pyvista

    return pyvista.PolyData.from_regular_faces(np.asarray(vertices), np.asarray(faces, dtype=np.int64))


def write_ply(path: str | Path, vertices: np.ndarray, faces: np.ndarray, comment: str) -> None:
    """Triangles as binary little-endian PLY: float32 vertices in metres, int32 indices."""
    table = np.zeros(len(vertices), dtype=[("x", "<f4"), ("y", "<f4"), ("z", "<f4")])
    table["x"], table["y"], table["z"] = np.asarray(vertices).T
    _write(path, table, {"x": "float", "y": "float", "z": "float"}, faces, comment)


def write_world_ply(path: str | Path, world: WorldMesh, comment: str) -> None:
    """A world as PLY with vertex colour (red, green, blue) and vertex property `reflectivity` (850 nm, 0 to 1).

    Solids do not share vertices, so a value per vertex is a value per face.
    """
    types = [("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("red", "u1"), ("green", "u1"), ("blue", "u1")]
    table = np.zeros(len(world.vertices), dtype=[*types, ("reflectivity", "<f4")])
    table["x"], table["y"], table["z"] = world.vertices.T
    colours, reflectivity = np.zeros((len(table), 3), np.uint8), np.zeros(len(table), np.float32)
    colours[world.faces] = world.colours[:, None]
    reflectivity[world.faces] = world.reflectivity[:, None]
    table["red"], table["green"], table["blue"] = colours.T
    table["reflectivity"] = reflectivity
    names = {"x": "float", "y": "float", "z": "float", "red": "uchar", "green": "uchar", "blue": "uchar"}
    _write(path, table, {**names, "reflectivity": "float"}, world.faces, comment)


def read_world_ply(path: str | Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Vertices `(V, 3)`, faces `(F, 3)` and reflectivity per face `(F,)` of a file by `write_world_ply`."""
    import trimesh

    mesh = trimesh.load(path, process=False)
    table = mesh.metadata["_ply_raw"]["vertex"]["data"]
    faces = np.asarray(mesh.faces)
    return np.asarray(mesh.vertices), faces, np.asarray(table["reflectivity"])[faces[:, 0]].ravel()


def _write(path: str | Path, table: np.ndarray, properties: dict[str, str], faces: np.ndarray, comment: str) -> None:
    rows = np.zeros(len(faces), dtype=_FACE)
    rows["count"], rows["index"] = 3, faces
    header = ["ply", "format binary_little_endian 1.0", f"comment {comment}", f"element vertex {len(table)}"]
    header += [f"property {kind} {name}" for name, kind in properties.items()]
    header += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header", ""]
    Path(path).write_bytes("\n".join(header).encode("ascii") + table.tobytes() + rows.tobytes())
