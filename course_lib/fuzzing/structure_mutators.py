"""Damage that keeps the outer form: JSON with other values, images whose checksums are right, counts that are not."""

from __future__ import annotations

import json
import re
import struct
import zlib

import numpy as np

STRANGE_VALUES = (
    "null", "true", "false", '""', '"text"', "[]", "{}", "[[]]", "0", "-1", "1", "1e300", "-1e300", "1e999", "NaN",
    "Infinity", "-0.0", "4294967296", "9223372036854775808", "1" + 400 * "0", "0.5", "360", "100", "[1, 2]", "[null]",
    '{"a": 1}', '"NaN"', '"1.5"', '"\\ud800"', '"\\u0000"', '"___"', '" "', '"../../etc/passwd"', '"/dev/zero"', "1.5",
    '"' + 2000 * "x" + '"', "[" * 60 + "]" * 60, "2", "128", '"couch"', "3.25",
)  # fmt: skip


def _places(value: object) -> list[tuple[object, object]]:
    """Every (container, key) in a JSON value."""
    found: list[tuple[object, object]] = []
    pairs = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in pairs:
        found += [(value, key), *_places(inner)]
    return found


def _load(data: bytes) -> object:
    try:
        return json.loads(data)
    except (ValueError, RecursionError):  # damaged already
        return None


def json_value(data: bytes, rng: np.random.Generator) -> bytes:
    """A value becomes another one, of any kind."""
    places = _places(content := _load(data))
    if not places:
        return data
    container, key = places[int(rng.integers(0, len(places)))]
    mark = "\x01here\x01"
    container[key] = mark
    new = STRANGE_VALUES[int(rng.integers(0, len(STRANGE_VALUES)))]
    return json.dumps(content, ensure_ascii=False).replace(json.dumps(mark), new).encode("utf-8", "surrogatepass")


def json_other_number(data: bytes, rng: np.random.Generator) -> bytes:
    """A number becomes another one."""
    content = _load(data)
    places = [(c, k) for c, k in _places(content) if isinstance(c[k], int | float) and not isinstance(c[k], bool)]
    if not places:
        return data
    container, key = places[int(rng.integers(0, len(places)))]
    container[key] = [float(rng.normal(0, 1)), int(rng.integers(0, 10)), float(rng.normal(0, 100))][rng.integers(0, 3)]
    return json.dumps(content, ensure_ascii=False).encode()


def json_without_key(data: bytes, rng: np.random.Generator) -> bytes:
    """A member or an item is missing."""
    places = _places(content := _load(data))
    if places:
        container, key = places[int(rng.integers(0, len(places)))]
        del container[key]
    return json.dumps(content, ensure_ascii=False).encode()


def json_key_twice(data: bytes, rng: np.random.Generator) -> bytes:
    """A member stands there twice, with the same value or another."""
    found = list(re.finditer(rb'"(\w+)"\s*:\s*', data))
    if not found:
        return data
    one = found[int(rng.integers(0, len(found)))]
    value = (b"1", b"null", b'"text"')[int(rng.integers(0, 3))]
    return data[: one.start()] + b'"' + one[1] + b'": ' + value + b", " + data[one.start() :]


def json_other_key(data: bytes, rng: np.random.Generator) -> bytes:
    """A member has another name, or a strange one."""
    found = list(re.finditer(rb'"(\w+)"\s*:', data))
    if not found:
        return data
    one, other = (found[int(index)] for index in rng.integers(0, len(found), 2))
    new = (other[1], b"", one[1].upper(), b"__class__")[int(rng.integers(0, 4))]
    return data[: one.start(1)] + new + data[one.end(1) :]


def json_swapped(data: bytes, rng: np.random.Generator) -> bytes:
    """Two values change places."""
    places = _places(content := _load(data))
    if len(places) < 2:
        return data
    (one, key), (other, other_key) = (places[int(index)] for index in rng.choice(len(places), 2, replace=False))
    one[key], other[other_key] = other[other_key], one[key]
    try:
        return json.dumps(content, ensure_ascii=False).encode()
    except (ValueError, RecursionError):  # one of them is inside the other
        return data


def json_wrapped(data: bytes, rng: np.random.Generator) -> bytes:
    """The whole in a list, or one of its parts alone."""
    places = _places(content := _load(data))
    if rng.random() < 0.3 or not places:
        return b"[" + data + b"]"
    container, key = places[int(rng.integers(0, len(places)))]
    return json.dumps(container[key], ensure_ascii=False).encode()


JSON = (json_value, json_value, json_other_number, json_without_key, json_key_twice, json_other_key, json_swapped, json_wrapped)

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


def strange_float(data: bytes, rng: np.random.Generator) -> bytes:
    """Four bytes become a float32 that is none, or is huge, tiny or negative."""
    values = (np.nan, np.inf, -np.inf, 1e38, -1e38, 1e20, 1e6, 6000.0, 3000.0, -50.0, 1e-40, 0.0, -0.0, 2.5)
    value = values[int(rng.integers(0, len(values)))]
    at = 4 * int(rng.integers(0, max(1, len(data) // 4))) + int(rng.integers(0, 4))
    return data[:at] + struct.pack("<f", value) + data[at + 4 :]


def nudged_float(data: bytes, rng: np.random.Generator) -> bytes:
    """The low bits of four bytes change: as a float32, the number hardly does."""
    at = 4 * int(rng.integers(0, max(1, len(data) // 4))) + int(rng.integers(0, 4))
    return data[:at] + bytes(byte ^ int(rng.integers(0, 8)) for byte in data[at : at + 1]) + data[at + 1 :]


FLOATS = (strange_float, nudged_float)


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
        (b"eXIf", rng.bytes(30)), (b"ABCD", rng.bytes(9)), (b"IEND", b""), (b"sBIT", rng.bytes(3)), (b"IDAT", rng.bytes(20)),
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
    found = list(re.finditer(rb'"(?:count|byteLength|byteOffset|bufferView|buffer|componentType)"\s*:\s*(\d+)', content))
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


def onnx_varint(data: bytes, rng: np.random.Generator) -> bytes:
    """A byte becomes a large number of several bytes, or a number that never ends."""
    at = int(rng.integers(0, max(1, len(data) if rng.random() < 0.3 else min(len(data), 120))))
    new = (b"\xff\xff\xff\xff\x07", b"\xff" * 9 + b"\x01", b"\x80" * 12, b"\x00", b"\x7f")[int(rng.integers(0, 5))]
    return data[:at] + new + data[at + 1 :]


def onnx_name(data: bytes, rng: np.random.Generator) -> bytes:
    """The name of an operation or a tensor becomes another one of the same length."""
    found = list(re.finditer(rb"[A-Za-z_]{4,}", data[:600] + data[-400:]))
    if not found:
        return data
    one, other = (found[int(index)][0] for index in rng.integers(0, len(found), 2))
    new = (other + one)[: len(one)] if rng.random() < 0.7 else b"\xff" * len(one)
    return data.replace(one, new, 1)


ONNX = (onnx_varint, onnx_varint, onnx_name)
