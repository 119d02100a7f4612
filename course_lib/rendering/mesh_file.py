"""A mesh file as vertices and faces: trimesh reads it, and this module looks at what trimesh takes on trust.

trimesh reads a part of a file that was cut off, and takes damaged rows of a text file together into other triangles. So
PLY, OFF and STL must hold what their headers announce, and every line of a text file must be a line of its format.
"""

from __future__ import annotations

import codecs
import io
import re
import struct
from collections.abc import Iterable
from pathlib import Path

import numpy as np
import trimesh

from course_lib.files import read_bytes

_NUMBER = rb"(?:[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?|[-+]?nan|[-+]?inf(?:inity)?)"
_NUMBERS = re.compile(rb"%b(?:\s+%b)*" % (_NUMBER, _NUMBER), re.I)

_TYPE = rb"(?:char|uchar|short|ushort|int|uint|float|double|u?int(?:8|16|32)|float(?:32|64))"
_PLY_LINE = re.compile(
    rb"ply|format (?:ascii|binary_little_endian|binary_big_endian) 1\.0|element \S+ \d+|"
    rb"property (?:list %b )?%b \S+|(?:comment|obj_info)(?: .*)?" % (_TYPE, _TYPE)
)
# A vertex whose word is damaged would be left out, and every face after it would take other vertices. A vertex has
# three numbers, with a weight or a colour or both. Source: Wavefront, Object Files (.obj), version 3.0.
_OBJ_LINE = re.compile(
    rb"v(?:\s+%b){3}(?:\s+%b)?(?:(?:\s+%b){3})?|f(?:\s+-?\d+(?:/-?\d*){0,2}){3,}|"
    rb"(?:vn|vt|vp|deg|bmat|step|cstype|p|l|curv|curv2|surf|parm|trim|hole|scrv|sp|end|con|g|s|mg|o|bevel|c_interp|"
    rb"d_interp|lod|usemap|maplib|usemtl|mtllib|shadow_obj|trace_obj|ctech|stech|call|csh)(?:\s.*)?"
    % (_NUMBER, _NUMBER, _NUMBER),
    re.I,
)
_STL_LOOP = re.compile(rb"outer\s+loop\s+(?:vertex\s+%b\s+%b\s+%b\s+){3}endloop" % (_NUMBER, _NUMBER, _NUMBER), re.I)


def mesh_endings() -> set[str]:
    """Endings of files that are read as meshes, such as "ply"; archives are not, which may hold anything."""
    return set(trimesh.available_formats()) - {"zip", "tar.gz", "tar.bz2"}


class SceneMapError(ValueError):
    """A map that cannot be used: unreadable, empty, or with values that are no geometry."""


def read_mesh(path: str | Path) -> tuple[np.ndarray, np.ndarray]:
    """Return the vertices `(V, 3)` and faces `(F, 3)` of a mesh file; its materials and textures are left alone.

    Raises `FileNotFoundError` for a missing file, `SceneMapError` for a file that cannot be read or is not complete.
    """
    path = Path(path)
    data = read_bytes(path, "map", SceneMapError, missing=FileNotFoundError)
    kind = path.suffix.lower().lstrip(".")
    if kind not in mesh_endings():
        raise SceneMapError(f"map {path} ends in {path.suffix!r}, which is no mesh: give PLY, OBJ, STL, OFF or GLB")
    if kind in _TEXTS:
        data = data.removeprefix(codecs.BOM_UTF8)  # with it trimesh would not know the first word
    try:
        _CHECKS.get(kind, len)(data)
        resolver = trimesh.resolvers.FilePathResolver(path)
        mesh = trimesh.load(io.BytesIO(data), kind, resolver=resolver, process=False, skip_materials=True)
        if isinstance(mesh, trimesh.Scene):
            mesh = mesh.to_mesh()
    except Exception as reason:  # trimesh's readers raise whatever their parsing stumbles on
        raise SceneMapError(
            f"map {path} cannot be read as a mesh ({type(reason).__name__}: {reason}). Is the file complete?"
        ) from reason
    return mesh.vertices, getattr(mesh, "faces", np.empty((0, 3), dtype=np.int64))


def _require_count(announced: int, there: int, what: str) -> None:
    if announced > there:
        raise ValueError(f"the file announces {announced:,} {what} and holds {there:,}")


def _require_lines(lines: Iterable[bytes], pattern: re.Pattern[bytes], kind: str) -> None:
    """Raise `ValueError` at the first line that the pattern does not match; empty lines are passed over."""
    for number, line in enumerate(lines, start=1):
        if line.strip() and not pattern.fullmatch(line.strip()):
            raise ValueError(f"line {number} is no line of {kind}: {line[:60]!r}")


def _numbers(row: bytes) -> list[bytes]:
    """The numbers of a row; none where something else stands in it."""
    return row.split() if _NUMBERS.fullmatch(row.strip()) else []


def _require_numbers(rows: list[bytes], count: int) -> None:
    for row in rows:
        if len(_numbers(row)) != count:
            raise ValueError(f"a row of {count} numbers is expected; found {row[:60]!r}")


def _require_faces(rows: list[bytes], may_have_more: bool) -> None:
    """Raise `ValueError` unless each row is a number of corners and as many vertices (and more, such as a colour)."""
    for row in rows:
        numbers = _numbers(row)
        n_corners = int(numbers[0]) if numbers and numbers[0].isdigit() else 0
        if n_corners < 3 or len(numbers) <= n_corners or (len(numbers) > n_corners + 1 and not may_have_more):
            raise ValueError(f"a face is its number of corners, 3 or more, and as many vertices; found {row[:60]!r}")


def _check_ply(data: bytes) -> None:
    header, end, body = data.partition(b"end_header")
    _require_count(1, len(end), "end of its header")
    lines = [b" ".join(line.split()) for line in header.splitlines()]
    _require_lines(lines, _PLY_LINE, "a PLY header")
    elements: list[tuple[bytes, int, list[bytes]]] = []
    for words in map(bytes.split, lines):
        if words[:1] == [b"element"]:
            elements.append((words[1], int(words[2]), []))
        elif words[:1] == [b"property"] and elements:
            elements[-1][2].append(b" ".join(words[1:]))
    for names in [
        [name for name, _, _ in elements],
        *([kind.split()[-1] for kind in kinds] for _, _, kinds in elements),
    ]:
        if len(set(names)) < len(names):
            raise ValueError(f"its header has one name twice among {b', '.join(names).decode('ascii', 'replace')}")
    is_text = b"format ascii 1.0" in lines
    rows = [row for row in body.splitlines() if row.strip()] if is_text else []
    # trimesh counts the bytes of a binary file itself; each element has one at least.
    total = sum(count for _, count, _ in elements)
    _require_count(total, len(rows) if is_text else len(body), "rows" if is_text else "elements")
    for name, count, kinds in elements if is_text else ():
        if not any(kind.startswith(b"list") for kind in kinds):
            _require_numbers(rows[:count], len(kinds))
        elif name == b"face" and len(kinds) == 1:
            _require_faces(rows[:count], may_have_more=False)
        rows = rows[count:]


def _check_off(data: bytes) -> None:
    rows = [row for line in data.splitlines() if (row := line.partition(b"#")[0].strip())]
    first = re.fullmatch(rb"C?OFF\b\s*(.*)", rows[0] if rows else b"")
    if not first:
        raise ValueError("its first word must be OFF")
    counts, *rows = [first[1], *rows[1:]] if first[1] else rows[1:]
    n_vertices, n_faces = (int(number) for number in counts.split()[:2])
    _require_count(n_vertices + n_faces, len(rows), "vertices and faces")
    _require_numbers([b" ".join(row.split()[:3]) for row in rows[:n_vertices]], 3)  # a colour may follow
    _require_faces(rows[n_vertices : n_vertices + n_faces], may_have_more=True)


def _check_stl(data: bytes) -> None:
    if data[:5] == b"solid" and b"facet" in data[:1000]:
        _, _, body = data.lower().partition(b"\n")  # without the solid's name
        _require_count(1, body.count(b"endsolid"), "end of its solid")
        _require_count(body.count(b"vertex"), 3 * len(_STL_LOOP.findall(body)), "corners in loops of three")
    else:
        _require_count(84, len(data), "bytes of its header")
        _require_count(struct.unpack("<I", data[80:84])[0], (len(data) - 84) // 50, "triangles")


def _check_obj(data: bytes) -> None:
    lines = data.replace(b"\\\r\n", b" ").replace(b"\\\n", b" ").splitlines()
    _require_lines((line.partition(b"#")[0] for line in lines), _OBJ_LINE, "an OBJ file")


_TEXTS = ("ply", "off", "obj")
_CHECKS = {"ply": _check_ply, "off": _check_off, "stl": _check_stl, "obj": _check_obj}
