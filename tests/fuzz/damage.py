"""What happens to files: bytes change, lines and words change places, values are none or far too large."""

import json
import re
import struct
import zlib
from collections.abc import Callable

from hypothesis import strategies as st

STRANGE = [
    "nan", "-inf", "1e300", "1e999", "-1", "0", "-0.0", "4294967296", "-2147483648", "9223372036854775808", "1,5",
    "1" + 400 * "0", "0x10", "１２", "1_000", "0.1.2", "--1", "", "None", "३", "3.5e38", "360", "#", "[a]", "=", "\x00",
    "\u00a0", "\u2028", "x" * 5000, "1 " * 5000,
]  # fmt: skip
STRANGE_JSON = [
    "null", "true", '""', '"text"', "[]", "{}", "[[]]", "0", "-1", "1", "1e300", "1e999", "NaN", "Infinity", "0.5",
    "1" + 400 * "0", "[1, 2]", '{"a": 1}', '"1.5"', '"\\ud800"', '"\\u0000"', '"../../etc/passwd"', '"/dev/zero"',
    '"' + 2000 * "x" + '"', "[" * 60 + "]" * 60, "4294967296", "128", '"couch"',
]  # fmt: skip


@st.composite
def damaged(draw: st.DrawFn, whole: bytes, kind: str) -> bytes:
    """The bytes of a file of this kind ("text", "json", "bytes"), damaged once or twice."""
    data = whole
    for _ in range(draw(st.integers(1, 2))):
        do = draw(st.sampled_from(BY_KIND[kind]))
        data = do(draw, data)
    return with_checksums(data) if data.startswith(PNG) and draw(st.booleans()) else data


def bytes_changed(draw: st.DrawFn, data: bytes) -> bytes:
    """Some bytes are others, missing, more, twice, in another place; or the rest is missing."""
    start = draw(st.integers(0, len(data) if draw(st.booleans()) else min(len(data), 100)))
    end = min(len(data), start + draw(st.integers(0, 40)))
    new = draw(st.one_of(st.binary(max_size=40), st.sampled_from([b"\x00" * 8, b"\xff", data[start:end] * 2, data])))
    rest = draw(st.sampled_from([data[end:], data[start:], b""]))
    return data[:start] + new + rest


def number_changed(draw: st.DrawFn, data: bytes) -> bytes:
    """Four bytes are a number that is none, or is huge."""
    at = 4 * draw(st.integers(0, len(data) // 4)) + draw(st.integers(0, 3))
    number = st.sampled_from([float("nan"), float("inf"), 1e38, -1e38, 1e20, 6000.0, -50.0, 1e-40, 0.0])
    count = st.sampled_from([0, 1, 2, 255, 65536, 2**31 - 1, 2**31, 2**32 - 1])
    new = struct.pack("<f", draw(number)) if draw(st.booleans()) else struct.pack("<I", draw(count))
    return data[:at] + new + data[at + 4 :]


def lines_changed(draw: st.DrawFn, data: bytes) -> bytes:
    """A line is missing, stands there twice, or stands elsewhere."""
    lines = data.split(b"\n")
    line = lines.pop(draw(st.integers(0, len(lines) - 1)))
    for _ in range(draw(st.integers(0, 2))):
        lines.insert(draw(st.integers(0, len(lines))), line)
    return b"\n".join(lines)


def word_changed(draw: st.DrawFn, data: bytes) -> bytes:
    """A word, or a piece of one, is missing, strange, or another word of the file."""
    words = list(re.finditer(rb"[^\s,=\"]+|[A-Za-z]+|\d+", data))
    if not words:
        return data
    one, other = draw(st.sampled_from(words)), draw(st.sampled_from(words))
    new = draw(
        st.one_of(st.just(other[0]), st.sampled_from(STRANGE).map(str.encode), st.integers(-9, 99).map(b"%d".__mod__))
    )
    return data[: one.start()] + new + data[one.end() :]


def saved_otherwise(draw: st.DrawFn, data: bytes) -> bytes:
    """Another encoding, other line ends."""
    if draw(st.booleans()):
        return data.decode("utf-8", "replace").encode(draw(st.sampled_from(["utf-16", "utf-32", "utf-8-sig"])))
    return data.replace(b"\n", draw(st.sampled_from([b"\r\n", b"\r", b" \n", b"\n\n"])))


def value_changed(draw: st.DrawFn, data: bytes) -> bytes:
    """A value of the JSON is another one, is missing, or is there twice."""
    try:
        content = json.loads(data)
    except (ValueError, RecursionError):  # damaged before
        return bytes_changed(draw, data)
    places = list(_places(content))
    if not places:
        return data
    container, key = draw(st.sampled_from(places))
    if draw(st.integers(0, 4)) == 0:
        del container[key]
        return json.dumps(content).encode()
    container[key] = "\x01here\x01"
    new = draw(st.sampled_from(STRANGE_JSON))
    if isinstance(key, str) and draw(st.integers(0, 4)) == 0:
        new = f'{new}, "{key}": {new}'
    return json.dumps(content).replace(json.dumps("\x01here\x01"), new).encode()


def _places(value: object):
    for key, inner in value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ():
        yield value, key
        yield from _places(inner)


TEXT = [lines_changed, word_changed, word_changed, word_changed, saved_otherwise, bytes_changed]
BY_KIND: dict[str, list[Callable[[st.DrawFn, bytes], bytes]]] = {
    "text": TEXT,
    "json": [value_changed, value_changed, value_changed, *TEXT],
    "bytes": [bytes_changed, bytes_changed, number_changed, word_changed],
}

PNG = b"\x89PNG\r\n\x1a\n"


def png(*parts: tuple[bytes, bytes]) -> bytes:
    """A PNG of these parts (name, content), with their checksums."""
    packed = (
        struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body)) for name, body in parts
    )
    return PNG + b"".join(packed)


def with_checksums(data: bytes) -> bytes:
    """A PNG whose parts have right checksums, as far as they can be told apart: else no other damage is looked at."""
    parts, at = [], len(PNG)
    while at + 8 <= len(data):
        length = int.from_bytes(data[at : at + 4], "big")
        parts.append((data[at + 4 : at + 8], data[at + 8 : at + 8 + length]))
        at += 12 + length
    return png(*parts)
