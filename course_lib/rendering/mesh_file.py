"""A mesh file as vertices and faces: trimesh reads it; we count what came, because trimesh reads half a file, too."""

import codecs
import io
import re
import struct
from pathlib import Path

import numpy as np
import trimesh

from course_lib.files import read_bytes


class SceneMapError(ValueError):
    """A map that cannot be used: unreadable, empty, or with values that are no geometry."""


def mesh_endings() -> set[str]:
    """Endings of files that are read as meshes, such as "ply"; archives are not, which may hold anything."""
    return set(trimesh.available_formats()) - {"zip", "tar.gz", "tar.bz2"}


def read_mesh(path: str | Path) -> tuple[np.ndarray, np.ndarray]:
    """Return the vertices `(V, 3)` and faces `(F, 3)` of a mesh file; its materials and textures are left alone.

    Raises `FileNotFoundError`, or `SceneMapError` for a file that cannot be read or holds less than it announces.
    """
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
        if isinstance(mesh, trimesh.Scene):
            mesh = mesh.to_mesh()
        vertices, faces = mesh.vertices, getattr(mesh, "faces", np.empty((0, 3), dtype=np.int64))
        if len(vertices) < n_vertices or len(faces) < n_faces:
            raise ValueError(
                f"it announces {n_vertices:,} vertices and {n_faces:,} faces and holds {len(vertices):,} and "
                f"{len(faces):,} triangles"
            )
    except Exception as reason:  # trimesh's readers raise whatever their parsing stumbles on
        raise SceneMapError(
            f"map {path} cannot be read as a mesh ({type(reason).__name__}: {reason}). Is the file complete?"
        ) from reason
    return vertices, faces


def _announced(data: bytes, kind: str) -> tuple[int, int]:
    """Return the numbers of vertices and faces that a PLY, OFF or STL announces, at least; (0, 0) for other formats."""
    n_vertices = n_faces = total = 0
    rows = [row for line in data.splitlines() if (row := line.partition(b"#")[0].strip())] if kind == "off" else []
    held = max(0, len(rows) - 1)
    if kind == "ply":
        header, _, body = data.partition(b"end_header")
        counts = {name: int(count) for name, count in re.findall(rb"element\s+(\S+)\s+(\d+)", header)}
        n_vertices, n_faces, total = counts.get(b"vertex", 0), counts.get(b"face", 0), sum(counts.values())
        is_text = re.search(rb"format\s+ascii", header)
        lines = [line.split() for line in body.splitlines() if line.strip()] if is_text else []
        held = len(lines) if is_text else len(body)
        first, _, others = header.partition(b"element")[2].partition(b"element")
        n_words = len(re.findall(rb"property", first)) if b"list" not in first else 0
        if others and n_words and any(len(words) != n_words for words in lines[: int(first.split()[1])]):
            raise ValueError(f"a row of its element {first.split()[0].decode()} has not {n_words} numbers")
    elif kind == "off" and (counts := re.match(rb"\S*OFF\s+(\d+)\s+(\d+)", b" ".join(rows[:2]))):
        n_vertices, n_faces = int(counts[1]), int(counts[2])
        total = n_vertices + n_faces
    elif kind == "stl" and data[:5] == b"solid" and b"facet" in data[:1000]:
        n_faces = total = data.lower().count(b"facet normal")
        held = n_faces if b"endsolid" in data.lower() else n_faces - 1
    elif kind == "stl" and len(data) >= 84:
        n_faces = total = struct.unpack("<I", data[80:84])[0]
        held = (len(data) - 84) // 50
    if total > held:
        raise ValueError(f"it announces {total:,} elements and holds {held:,}")
    return n_vertices, n_faces
