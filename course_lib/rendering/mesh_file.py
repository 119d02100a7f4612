"""A mesh file as vertices and faces: bounded before memory is taken, complete, its materials and textures left alone.

PLY, OFF, STL and OBJ say or show how much they hold, and are read by trimesh in this process once that fits the file.
Every other format that trimesh knows (GLB, glTF, 3MF, ...) may unpack to any size: it is read in a process of its own,
with bounded memory.
"""

from __future__ import annotations

import codecs
import io
import re
import struct
from pathlib import Path

import numpy as np
import trimesh

from course_lib.child import ChildError, run_apart
from course_lib.files import MEGABYTE, read_bytes
from course_lib.rendering.mesh_rows import row_fault

MOST_TIMES = 40
"""Times the size of a file that its triangles may take in memory."""

LEAST_MEMORY = 600 * MEGABYTE
"""What a small file may take at most."""

_READ_APART = """
import sys
import numpy as np
import trimesh

mesh = trimesh.load(sys.argv[1], process=False, skip_materials=True)
if isinstance(mesh, trimesh.Scene):
    mesh = mesh.to_mesh() if mesh.geometry else None
vertices = np.asarray(getattr(mesh, "vertices", np.empty((0, 3))), dtype=np.float64)
faces = getattr(mesh, "faces", None)
faces = np.empty((0, 3), np.int64) if faces is None else np.asarray(faces, dtype=np.int64)
np.savez(sys.argv[2], vertices=vertices, faces=faces)
"""


def mesh_endings() -> set[str]:
    """Endings of files that are read as meshes, such as "ply"; archives are not, which may hold anything."""
    return set(trimesh.available_formats()) - {"zip", "tar.gz", "tar.bz2"}


def read_mesh(path: str | Path, error: type[Exception]) -> tuple[np.ndarray, np.ndarray]:
    """Vertices `(V, 3)` float64 and faces `(F, 3)` of a mesh file.

    Raises `FileNotFoundError` for a missing file, `error` for one that cannot be read, is not complete, or holds no
    triangles.
    """
    path = Path(path)
    data = read_bytes(path, "map", error, missing=FileNotFoundError)
    kind = path.suffix.lower().lstrip(".")
    if kind not in mesh_endings():
        raise error(f"map {path} ends in {path.suffix!r}, which is no mesh: PLY, OBJ, STL, OFF or GLB is expected")
    data = _without_mark(data, kind)
    _require_complete(data, kind, path, error)
    if fault := row_fault(data, kind):
        raise error(f"map {path}, {fault}")
    read = _read_here if kind in _SIZED else _read_apart
    try:
        vertices, faces = read(path, data, kind)
    except ChildError as reason:
        raise error(f"map {path} cannot be read as a mesh: reading it {reason}") from None
    except Exception as reason:  # trimesh's readers raise whatever their parsing stumbles on
        raise error(
            f"map {path} cannot be read as a mesh ({type(reason).__name__}: {reason}): is it complete, and PLY, OBJ, "
            "STL, OFF or GLB?"
        ) from reason
    if len(vertices) == 0:
        raise error(f"map {path} holds neither vertices nor triangles: is the file complete?")
    if len(faces) == 0:
        raise error(f"map {path} holds no triangles ({len(vertices)} vertices): mesh it first")
    for what, array in (("vertices", vertices), ("faces", faces)):
        if np.ndim(array) != 2 or np.shape(array)[1] != 3:
            raise error(f"map {path} has {what} that are no rows of three numbers: got {np.shape(array)}")
    return vertices, faces


def _without_mark(data: bytes, kind: str) -> bytes:
    """The file without a byte order mark, with which trimesh would not know its first word."""
    text = data.removeprefix(codecs.BOM_UTF8)
    binary = kind not in _SIZED or (kind == "stl" and text[:5] != b"solid")  # their first bytes may be any
    return data if binary else text


def _read_here(path: Path, data: bytes, kind: str) -> tuple[np.ndarray, np.ndarray]:
    options = {"skip_materials": True} if kind == "obj" else {}
    mesh = trimesh.load(io.BytesIO(data), file_type=kind, process=False, **options)
    if isinstance(mesh, trimesh.Scene):
        mesh = mesh.to_mesh() if mesh.geometry else None
    faces = getattr(mesh, "faces", None)
    return getattr(mesh, "vertices", np.empty((0, 3))), np.empty((0, 3), np.int64) if faces is None else faces


def _read_apart(path: Path, data: bytes, kind: str) -> tuple[np.ndarray, np.ndarray]:
    found = run_apart(_READ_APART, str(path.resolve()), memory=max(LEAST_MEMORY, MOST_TIMES * len(data)))
    with np.load(io.BytesIO(found), allow_pickle=False) as arrays:
        return arrays["vertices"], arrays["faces"]


def _require_complete(data: bytes, kind: str, path: Path, error: type[Exception]) -> None:
    """Raises `error` where a file announces more than it holds: it was cut off, or would take all memory."""
    announced = _SIZED[kind](data) if kind in _SIZED else None
    if announced is not None and announced[0] > announced[1]:
        wanted, there, what = announced
        raise error(f"map {path} announces {wanted:,} {what} and holds {there:,}: the file is not complete")


def _ply(data: bytes) -> tuple[int, int, str] | None:
    header, end, body = data.partition(b"end_header")
    if not end:
        return 1, 0, "ends of its header"
    counts = [int(n) for n in re.findall(rb"^\s*element\s+\S+\s+(\d+)", header, re.M)]
    if re.search(rb"^\s*format\s+ascii", header, re.M):
        return sum(counts), sum(bool(line.strip()) for line in body.splitlines()), "rows"
    return sum(counts), len(body), "elements, of a byte or more,"  # trimesh counts the bytes of binary ones itself


def _off(data: bytes) -> tuple[int, int, str] | None:
    rows = [row for line in data.splitlines() if (row := line.partition(b"#")[0].split())]
    if rows and rows[0][0].upper().endswith(b"OFF"):
        rows[0] = rows[0][1:]
        rows = rows if rows[0] else rows[1:]
    if not rows or len(rows[0]) < 2 or not all(number.isdigit() for number in rows[0][:2]):
        return None  # trimesh says what is wrong with it
    return int(rows[0][0]) + int(rows[0][1]), len(rows) - 1, "rows"


def _stl(data: bytes) -> tuple[int, int, str] | None:
    if data[:5] == b"solid" and b"facet" in data[:1000]:
        return data.count(b"endsolid") == 0, 0, "end of its solid"
    if len(data) < 84:
        return 84, len(data), "bytes of its header"
    return struct.unpack("<I", data[80:84])[0], (len(data) - 84) // 50, "triangles"


_SIZED = {"ply": _ply, "off": _off, "stl": _stl, "obj": lambda data: None}
