"""Damage to meshes that keeps their outer form: counts, headers, the JSON inside of a GLB with right lengths."""

from __future__ import annotations

import re
import struct

import numpy as np

from course_lib.fuzzing.json_mutators import JSON

COUNTS = (0, 1, 2, 3, 255, 65536, 10**6, 2**31 - 1, 2**31, 2**32 - 1, 2**32, 2**63, 10**30)


def ply_count(data: bytes, rng: np.random.Generator) -> bytes:
    """A count in the header becomes another one, negative ones too."""
    found = list(re.finditer(rb"element \w+ (\d+)", data))
    if not found:
        return data
    one = found[int(rng.integers(0, len(found)))]
    old = int(one[1])
    counts = (*COUNTS, -1, -(2**31), old - 1, old + 1)
    return data[: one.start(1)] + b"%d" % counts[int(rng.integers(0, len(counts)))] + data[one.end(1) :]


def ply_header(data: bytes, rng: np.random.Generator) -> bytes:
    """A line of the header is missing, stands there twice, or has another type or format."""
    header, end, body = data.partition(b"end_header\n")
    lines = header.splitlines(keepends=True)
    at = int(rng.integers(0, len(lines))) if lines else 0
    kind = int(rng.integers(0, 4))
    if kind == 0:
        lines[at : at + 1] = []
    elif kind == 1:
        lines[at:at] = lines[at : at + 1]
    else:
        types = (b"float", b"double", b"uchar", b"char", b"int", b"uint", b"short", b"list uchar int", b"float128", b"")
        old, new = (types[int(index)] for index in rng.integers(0, len(types), 2))
        if kind == 3:
            old, new = b"binary_little_endian", (b"binary_big_endian", b"ascii", b"utf8")[int(rng.integers(0, 3))]
        lines = [line.replace(old, new) if old else line for line in lines]
    return b"".join(lines) + end + body


PLY = (ply_count, ply_header)


def stl_count(data: bytes, rng: np.random.Generator) -> bytes:
    """The count of triangles becomes another one, below 2^32."""
    count = COUNTS[int(rng.integers(0, 10))]
    return data[:80] + struct.pack("<I", count) + data[84:]


def stl_solid(data: bytes, rng: np.random.Generator) -> bytes:
    """A binary file that begins as an ASCII one does."""
    return b"solid facet" + data[11:] if rng.random() < 0.5 else b"solid" + data[5:]


STL = (stl_count, stl_solid)


def _glb(content: bytes, rest: bytes) -> bytes:
    content += b" " * (-len(content) % 4)
    total = 20 + len(content) + len(rest)
    return b"glTF" + struct.pack("<III", 2, total, len(content)) + b"JSON" + content + rest


def glb_json(data: bytes, rng: np.random.Generator) -> bytes:
    """The JSON of a GLB is damaged as other JSON is; all lengths are right."""
    if len(data) < 20:
        return data
    (length,) = struct.unpack("<I", data[12:16])
    mutator = JSON[int(rng.integers(0, len(JSON)))]
    return _glb(mutator(data[20 : 20 + length].rstrip(b" \0"), rng), data[20 + length :])


def glb_count(data: bytes, rng: np.random.Generator) -> bytes:
    """A count, length or offset in the JSON of a GLB becomes another one."""
    if len(data) < 20:
        return data
    (length,) = struct.unpack("<I", data[12:16])
    content = data[20 : 20 + length].rstrip(b" \0")
    found = list(
        re.finditer(rb'"(?:count|byteLength|byteOffset|bufferView|buffer|componentType)"\s*:\s*(\d+)', content)
    )
    if not found:
        return data
    one = found[int(rng.integers(0, len(found)))]
    old = int(one[1])
    counts = (*COUNTS, -1, old - 1, old + 1, 2 * old, 5121, 5126)
    new = b"%d" % counts[int(rng.integers(0, len(counts)))]
    return _glb(content[: one.start(1)] + new + content[one.end(1) :], data[20 + length :])


def glb_lengths(data: bytes, rng: np.random.Generator) -> bytes:
    """A length in the header becomes another one."""
    at = int(rng.choice([4, 8, 12]))
    return data[:at] + struct.pack("<I", COUNTS[int(rng.integers(0, 10))]) + data[at + 4 :]


GLB = (glb_json, glb_json, glb_count, glb_lengths)
