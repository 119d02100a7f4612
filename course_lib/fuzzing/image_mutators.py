"""Damage to PNG and JPEG: PNG with checksums that are right, JPEG with other markers, sizes and lengths."""

from __future__ import annotations

import re
import struct
import zlib

import numpy as np


def chunks(data: bytes) -> list[tuple[bytes, bytes]]:
    """Name and content of each chunk of a PNG, as far as they go."""
    found, at = [], 8
    while at + 12 <= len(data):
        (length,) = struct.unpack(">I", data[at : at + 4])
        found.append((data[at + 4 : at + 8], data[at + 8 : at + 8 + length]))
        at += 12 + length
    return found


def png(parts: list[tuple[bytes, bytes]]) -> bytes:
    """A PNG of such chunks, with right lengths and checksums."""
    packed = [
        struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body)) for name, body in parts
    ]
    return b"\x89PNG\r\n\x1a\n" + b"".join(packed)


def png_header(data: bytes, rng: np.random.Generator) -> bytes:
    """Another size, depth of bits or kind of colour, with a right checksum."""
    parts = chunks(data)
    if not parts or len(parts[0][1]) != 13:
        return data
    fields = list(struct.unpack(">IIBBBBB", parts[0][1]))
    at = int(rng.integers(0, 7))
    if at < 2:
        sizes = (0, 1, fields[at] - 1, fields[at] + 1, 2 * fields[at], 10**5, 2**31 - 1, 2**32 - 1)
        fields[at] = sizes[int(rng.integers(0, len(sizes)))]
    else:
        fields[at] = int(rng.choice([0, 1, 2, 3, 4, 6, 8, 16, 255]))
    return png([(b"IHDR", struct.pack(">IIBBBBB", *fields)), *parts[1:]])


def png_chunks(data: bytes, rng: np.random.Generator) -> bytes:
    """A chunk is missing, stands there twice, or another one comes in between; all checksums are right."""
    parts = chunks(data)
    extra = (
        (b"tRNS", rng.bytes(6)), (b"PLTE", rng.bytes(9)), (b"gAMA", rng.bytes(4)), (b"acTL", bytes(7) + b"\x02"),
        (b"iCCP", b"x\0\0" + zlib.compress(bytes(10**6))), (b"zTXt", b"x\0\0" + zlib.compress(bytes(10**6))),
        (b"eXIf", rng.bytes(30)), (b"ABCD", rng.bytes(9)), (b"IEND", b""), (b"sBIT", rng.bytes(3)),
        (b"IDAT", rng.bytes(20)),
    )  # fmt: skip
    at = int(rng.integers(0, max(1, len(parts))))
    kind = int(rng.integers(0, 4)) if parts else 2
    if kind == 0:
        del parts[at]
    elif kind == 1:
        parts.insert(at, parts[at])
    else:
        parts.insert(at, extra[int(rng.integers(0, len(extra)))])
    return png(parts)


def png_pixels(data: bytes, rng: np.random.Generator) -> bytes:
    """Some bytes of the unpacked pixels change, packed anew; or rows are missing, or too many."""
    parts = chunks(data)
    try:
        pixels = bytearray(zlib.decompress(b"".join(body for name, body in parts if name == b"IDAT")))
    except zlib.error:
        return data
    kind = int(rng.integers(0, 4))
    for _ in range(int(rng.integers(1, 6)) if pixels else 0):
        pixels[int(rng.integers(0, len(pixels)))] = int(rng.integers(0, 256))
    if kind == 2:
        pixels = pixels[: len(pixels) // 2]
    elif kind == 3:
        pixels += bytes(len(pixels))
    others = [one for one in parts if one[0] not in (b"IDAT", b"IEND")]
    return png([*others, (b"IDAT", zlib.compress(bytes(pixels))), (b"IEND", b"")])


def png_checksum(data: bytes, rng: np.random.Generator) -> bytes:
    """A bit inside a chunk's content changes, and no checksum."""
    at = int(rng.integers(8, max(9, len(data))))
    return data[:at] + bytes(byte ^ (1 << int(rng.integers(0, 8))) for byte in data[at : at + 1]) + data[at + 1 :]


PNG = (png_header, png_chunks, png_pixels, png_pixels, png_checksum)


def jpeg_size(data: bytes, rng: np.random.Generator) -> bytes:
    """Another height or width in the frame's header."""
    at = data.find(b"\xff\xc0")
    sizes = (0, 1, 63, 65, 127, 256, 10_000, 65_535)
    start = at + 5 + 2 * int(rng.integers(0, 2))
    return data if at < 0 else data[:start] + struct.pack(">H", sizes[int(rng.integers(0, 8))]) + data[start + 2 :]


def jpeg_marker(data: bytes, rng: np.random.Generator) -> bytes:
    """A marker becomes another one, or its segment's length."""
    found = [one.start() for one in re.finditer(rb"\xff[\xc0-\xfe]", data)]
    if not found:
        return data
    at = found[int(rng.integers(0, len(found)))]
    if rng.random() < 0.5:
        return data[: at + 1] + bytes([int(rng.integers(0xC0, 0xFF))]) + data[at + 2 :]
    return data[: at + 2] + rng.bytes(2) + data[at + 4 :]


JPEG = (jpeg_size, jpeg_marker)
