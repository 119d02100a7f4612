"""What is no plain file, and small files that unpack to large ones or say that they do."""

from __future__ import annotations

import json
import os
import struct
import zlib
from collections.abc import Callable
from pathlib import Path

from course_lib.fuzzing.image_mutators import png

LINKS = (
    "missing",
    "dangling",
    "loop",
    "folder",
    "link to a folder",
    "/dev/zero",
    "/dev/full",
    "fifo",
    "link to a fifo",
    "link to itself whole",
)
"""Kinds of what stands in a file's place."""


def put_link(kind: str, path: Path, whole: bytes) -> None:
    """Puts such a thing at `path`, where nothing is; `whole`: what the valid file holds."""
    if kind == "missing":
        return
    if kind == "folder":
        path.mkdir()
    elif kind == "fifo":
        os.mkfifo(path)
    elif kind == "link to a fifo":
        os.mkfifo(path.with_name("elsewhere"))
        path.symlink_to("elsewhere")
    elif kind == "link to itself whole":
        path.with_name("elsewhere").write_bytes(whole)
        path.symlink_to("elsewhere")
    else:
        targets = {"dangling": "nowhere", "loop": path.name, "link to a folder": "."}
        path.symlink_to(targets.get(kind, kind))


def zeros(count: int) -> bytes:
    """About `count` zero bytes as zlib packs them, made without packing them all: one block, many times.

    Returns what unpacks to the next multiple of a million. Source: RFC 1950 (the checksum of zeros is known) and 1951.
    """
    packer = zlib.compressobj(9, zlib.DEFLATED, -15)
    block = packer.compress(bytes(10**6)) + packer.flush(zlib.Z_FULL_FLUSH)
    times = -(-count // 10**6)
    checksum = (times * 10**6 % 65521) << 16 | 1
    return b"\x78\xda" + block * times + b"\x03\x00" + struct.pack(">I", checksum)


def _png_of_zeros(width: int, bits: int, colour: int, height: int | None = None) -> bytes:
    """A PNG of zeros, square unless `height` is given; of 20,000 x 20,000 pixels of 16 bits it has 0.8 MB."""
    height = width if height is None else height
    channels = {0: 1, 2: 3, 6: 4}[colour]
    row = 1 + width * channels * bits // 8
    header = struct.pack(">IIBBBBB", width, height, bits, colour, 0, 0, 0)
    return png([(b"IHDR", header), (b"IDAT", zeros(height * row)), (b"IEND", b"")])


def _jpeg_without_data(side: int) -> bytes:
    """A JPEG that says how large it is, and ends."""
    frame = b"\x08" + struct.pack(">HH", side, side) + b"\x03\x01\x11\0\x02\x11\0\x03\x11\0"
    return b"\xff\xd8\xff\xc0\0\x11" + frame + b"\xff\xd9"


def _glb(accessor: dict, **more: object) -> bytes:
    content = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 4}]}],
        "accessors": [accessor],
        **more,
    }
    text = json.dumps(content).encode()
    text += b" " * (-len(text) % 4)
    return b"glTF" + struct.pack("<III", 2, 20 + len(text), len(text)) + b"JSON" + text


def make_bombs(of: str) -> dict[str, Callable[[], bytes]]:
    """What makes the bombs for a trait of a file ("text", "json", "ply", "png", ...), by name; the same every time."""
    ply = b"ply\nformat %s 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\n"
    faces = b"element face %d\nproperty list %s int vertex_indices\nend_header\n"
    huge_list = ply % (b"binary_little_endian", 3) + faces % (1, b"uint") + bytes(36) + b"\xff" * 4
    triples = {"componentType": 5126, "type": "VEC3"}
    makers = {
        "text": {
            "one line of 5 MB": lambda: b"1 " * 2_500_000,
            "five million empty lines": lambda: b"\n" * 5_000_000,
            "a word of 5 MB": lambda: b"a" * 5_000_000,
            "a number of 200,000 digits": lambda: b"1" * 200_000 + b"\n",
            "5 MB of brackets": lambda: b"(" * 5_000_000,
        },
        "json": {
            "100,000 levels of lists": lambda: b"[" * 100_000 + b"]" * 100_000,
            "levels that are never closed": lambda: b'{"a":' * 100_000,
            "a million empty objects": lambda: b"[" + b"{}," * 1_000_000 + b"{}]",
            "a text of 5 MB": lambda: b'{"version": 1, "name": "' + b"a" * 5_000_000 + b'"}',
            "a number of 200,000 digits": lambda: b'{"version": ' + b"1" * 200_000 + b"}",
            "an exponent of 9 digits": lambda: b'{"version": 1e999999999}',
            "200,000 quotation marks": lambda: b'"\\' * 100_000,
        },
        "numbers": {"300,000 rows": lambda: b"1 2 3 4 5 6 7 8\n" * 300_000},
        "ply": {
            "2^31 vertices": lambda: ply % (b"binary_little_endian", 2**31) + faces % (1, b"uchar") + bytes(100),
            "10^12 faces": lambda: ply % (b"ascii", 3) + faces % (10**12, b"uchar") + b"0 0 0\n" * 3,
            "a face of 2^32 corners": lambda: huge_list,
            "an element without properties": lambda: b"ply\nformat ascii 1.0\nelement vertex 1000000000\nend_header\n",
        },
        "stl": {"2^32 triangles": lambda: bytes(80) + b"\xff" * 4 + bytes(100)},
        "glb": {
            "zeros that need no bytes": lambda: _glb({**triples, "count": 300_000_000}),
            "2^40 vertices": lambda: _glb({**triples, "count": 2**40}),
            "10,000 nodes on each other": lambda: _glb(
                {**triples, "count": 3}, nodes=[{"children": [n + 1], "mesh": 0} for n in range(9_999)] + [{"mesh": 0}]
            ),
            "nodes in a ring": lambda: _glb({**triples, "count": 3}, nodes=[{"children": [0], "mesh": 0}]),
            "a mesh a thousand times": lambda: _glb(
                {**triples, "count": 300_000}, nodes=[{"children": list(range(1, 1001))}] + [{"mesh": 0}] * 1000
            ),
        },
        "png": {
            "20,000 x 20,000": lambda: _png_of_zeros(20_000, 16, 0),
            "9,900 x 9,900 in four channels of 16 bits": lambda: _png_of_zeros(9_900, 16, 6),
            "9,900 x 9,900 in grey of 16 bits": lambda: _png_of_zeros(9_900, 16, 0),
            "14,000 x 7,000 in three colours": lambda: _png_of_zeros(14_000, 8, 2, 7_000),
            "2^31 x 2^31": lambda: png(
                [(b"IHDR", struct.pack(">IIBBBBB", 2**31 - 1, 2**31 - 1, 16, 0, 0, 0, 0)), (b"IEND", b"")]
            ),
            "10,000 x 10,000 of no bytes": lambda: png(
                [(b"IHDR", struct.pack(">IIBBBBB", 10_000, 10_000, 16, 0, 0, 0, 0)), (b"IDAT", b""), (b"IEND", b"")]
            ),
            "a profile of 500 MB": lambda: png(
                [
                    (b"IHDR", struct.pack(">IIBBBBB", 32, 24, 16, 0, 0, 0, 0)),
                    (b"iCCP", b"x\0\0" + zeros(500_000_000)),
                    (b"IEND", b""),
                ]
            ),
        },
        "jpeg": {
            "65,000 x 65,000": lambda: _jpeg_without_data(65_000),
            "10,000 x 10,000 of no bytes": lambda: _jpeg_without_data(10_000),
        },
        "floats": {"8 MB of zeros": lambda: bytes(8_000_000), "8 MB of NaN": lambda: b"\xff" * 8_000_000},
        "onnx": {"2,000 messages inside each other": lambda: _nested(2_000)},
    }
    return makers.get(of, {})


def _nested(levels: int) -> bytes:
    inner = b""
    for _ in range(levels):
        size, length = b"", len(inner)
        while length > 127:
            size, length = size + bytes([length & 127 | 128]), length >> 7
        inner = b"\x3a" + size + bytes([length]) + inner
    return inner
