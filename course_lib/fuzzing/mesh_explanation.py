"""Why a changed map is right: its corners stand in the file, no triangle is one too many, and its depths are exact.

The second reading of a mesh file knows only as much of each format as the samples use of it.
"""

from __future__ import annotations

import json
import re
import struct

import numpy as np

from course_lib.fuzzing.depth_oracle import depths_agree
from course_lib.fuzzing.readings import Reading, same

PAYLOAD = "payload: what the file says"
SMALL = "payload within 10 mm, the map's own noise"
NOISE = 0.01
"""Metres: the noise of the surveyed maps (data/corridor/PARAMETERS.md has 8 mm and more)."""

PLY_TYPES = {
    b"char": "i1", b"int8": "i1", b"uchar": "u1", b"uint8": "u1", b"short": "i2", b"int16": "i2", b"ushort": "u2",
    b"uint16": "u2", b"int": "i4", b"int32": "i4", b"uint": "u4", b"uint32": "u4", b"float": "f4", b"float32": "f4",
    b"double": "f8", b"float64": "f8",
}  # fmt: skip


def of_map(data: bytes, found: Reading, original: Reading, kind: str) -> str | None:
    """The reason why a changed map is right, or None. kind: the file's ending."""
    vertices, faces = np.asarray(found["vertices"]), np.asarray(found["faces"])
    points, most = second_reading(data, kind)
    if len(faces) > most or (points is not None and not _stand_in(vertices, points)):
        return None
    if kind in ("ply", "off") and len(vertices) != len(points):
        return None  # of the other kinds, corners may be joined, and vertices without a triangle left out
    if not depths_agree(vertices, faces):
        return None
    before = np.asarray(original["vertices"])
    moved = vertices.shape == before.shape and same(found["faces"], original["faces"])
    return SMALL if moved and np.abs(vertices - before).max() <= NOISE else PAYLOAD


def _stand_in(vertices: np.ndarray, points: np.ndarray) -> bool:
    """Whether all `vertices` `(V, 3)` are among the points `(n, 3)`, in float32."""
    known = {row.tobytes() for row in points.astype(np.float32) + np.float32(0)}
    return all(row.tobytes() in known for row in vertices.astype(np.float32) + np.float32(0))


def second_reading(data: bytes, kind: str) -> tuple[np.ndarray | None, int]:
    """The points `(n, 3)` of a mesh file, and how many triangles it has at most. Of a GLB, which may move and repeat
    its points, there are none."""
    if kind != "glb" and re.match(rb"\xef\xbb\xbf(ply|solid|OFF|[#v])", data):
        data = data[3:]
    with np.errstate(all="ignore"):
        return {"ply": _ply, "off": _off, "obj": _obj, "stl": _stl, "glb": _glb}[kind](data)


def _numbers(rows: list[list[bytes]]) -> np.ndarray:
    return np.array([[float(part) for part in row[:3]] for row in rows], dtype=np.float64).reshape(-1, 3)


def _ply(data: bytes) -> tuple[np.ndarray, int]:
    header, _, body = data.partition(b"end_header")
    elements: list[tuple[bytes, int, list]] = []
    for words in (line.split() for line in header.splitlines()):
        if words[:1] == [b"element"]:
            elements.append((words[1], int(words[2]), []))
        elif words[:1] == [b"property"]:
            elements[-1][2].append(words[1:])
    assert [name for name, _, _ in elements][:2] == [b"vertex", b"face"]
    (_, vertices, properties), (_, faces, _) = elements[:2]
    columns = [[words[-1] for words in properties].index(axis) for axis in (b"x", b"y", b"z")]
    if b"format ascii" in header:
        rows = [line.split() for line in body.splitlines() if line.strip()]
        triangles = sum(int(float(row[0])) - 2 for row in rows[vertices : vertices + faces])
        return _numbers([[row[column] for column in columns] for row in rows[:vertices]]), triangles
    order = ">" if b"binary_big_endian" in header else "<"
    row = np.dtype([(f"{n}", order + PLY_TYPES[words[0]]) for n, words in enumerate(properties)])
    table = np.frombuffer(body[body.index(b"\n") + 1 :], dtype=row, count=vertices)
    return np.stack([table[f"{column}"].astype(np.float64) for column in columns], axis=1), faces


def _off(data: bytes) -> tuple[np.ndarray, int]:
    rows = [part.split() for line in data.splitlines() if (part := line.partition(b"#")[0]).strip()]
    rows = rows[1:] if rows[0] == [b"OFF"] else [rows[0][1:] or rows[0], *rows[1:]]
    vertices, faces = int(rows[0][0]), int(rows[0][1])
    triangles = sum(int(row[0]) - 2 for row in rows[1 + vertices : 1 + vertices + faces])
    return _numbers(rows[1 : 1 + vertices]), triangles


def _obj(data: bytes) -> tuple[np.ndarray, int]:
    rows = [line.split() for line in data.replace(b"\\\n", b" ").splitlines() if line.strip()]
    points = _numbers([row[1:] for row in rows if row[0] == b"v"])
    return points, sum(max(0, len(row) - 3) for row in rows if row[0] == b"f")


def _stl(data: bytes) -> tuple[np.ndarray, int]:
    if data[:5] == b"solid" and b"facet" in data[:1000]:
        found = re.findall(rb"\bvertex\s+(\S+)\s+(\S+)\s+(\S+)", data, re.I)
        return _numbers([list(row) for row in found]), len(found) // 3
    (triangles,) = struct.unpack("<I", data[80:84])
    row = np.dtype([("normal", "<f4", 3), ("corners", "<f4", 9), ("attribute", "<u2")])
    return np.frombuffer(data[84:], dtype=row, count=triangles)["corners"].reshape(-1, 3), triangles


def _glb(data: bytes) -> tuple[None, int]:
    (length,) = struct.unpack("<I", data[12:16])
    content = json.loads(data[20 : 20 + length].rstrip(b"\0 "))
    counts = [one["count"] for one in content["accessors"] if one.get("type") in ("SCALAR", "VEC3")]
    uses = sum("mesh" in node for node in content.get("nodes", [])) or 1
    return None, uses * max(counts) // 3
