"""Damage to text files: other encodings, lines in another order, and numbers that are none or far too large."""

from __future__ import annotations

import re

import numpy as np

NUMBER = re.compile(rb"[-+]?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?")

STRANGE_NUMBERS = (
    "nan", "NaN", "-nan", "inf", "-inf", "Infinity", "1e300", "-1e300", "1e-300", "1e999", "-1", "0", "-0.0", "1",
    "4294967296", "2147483647", "-2147483648", "9223372036854775808", "1" + 400 * "0", "1,5", "0x10", "１２", "1_000",
    "1e5", "1000000", "0.1.2", "--1", "", "None", "1/0", "2**99", "३", "99999", "1e20", "3.5e38", "0.5", "360", "12",
)  # fmt: skip


def strange_number(data: bytes, rng: np.random.Generator) -> bytes:
    """A number becomes one that is none, or is negative or huge."""
    return _other_number(data, rng, STRANGE_NUMBERS[int(rng.integers(0, len(STRANGE_NUMBERS)))])


def other_number(data: bytes, rng: np.random.Generator) -> bytes:
    """A number becomes another one that may well be meant."""
    value = rng.choice([rng.normal(0, 1), rng.integers(0, 10), rng.normal(0, 100)])
    return _other_number(data, rng, f"{value:.6g}")


def nudged_number(data: bytes, rng: np.random.Generator) -> bytes:
    """The last digit of a number is another one."""
    found = list(NUMBER.finditer(data))
    if not found:
        return data
    at = found[int(rng.integers(0, len(found)))].end() - 1
    return data[:at] + b"%d" % rng.integers(0, 10) + data[at + 1 :]


def _other_number(data: bytes, rng: np.random.Generator, new: str) -> bytes:
    found = list(NUMBER.finditer(data))
    if not found:
        return data
    one = found[int(rng.integers(0, len(found) if rng.random() < 0.7 else min(len(found), 8)))]
    return data[: one.start()] + new.encode() + data[one.end() :]


def swapped_fields(data: bytes, rng: np.random.Generator) -> bytes:
    """Two words of a line change places."""
    lines = data.split(b"\n")
    at = int(rng.integers(0, len(lines)))
    words = lines[at].split(b" ")
    if len(words) > 1:
        one, other = rng.choice(len(words), 2, replace=False)
        words[one], words[other] = words[other], words[one]
        lines[at] = b" ".join(words)
    return b"\n".join(lines)


def missing_field(data: bytes, rng: np.random.Generator) -> bytes:
    """A word of a line is missing, or stands there twice."""
    lines = data.split(b"\n")
    at = int(rng.integers(0, len(lines)))
    words = lines[at].split(b" ")
    one = int(rng.integers(0, len(words)))
    words[one : one + 1] = [] if rng.random() < 0.5 else [words[one]] * 2
    lines[at] = b" ".join(words)
    return b"\n".join(lines)


def swapped_lines(data: bytes, rng: np.random.Generator) -> bytes:
    """Two lines change places."""
    lines = data.split(b"\n")
    one, other = rng.integers(0, len(lines), 2)
    lines[one], lines[other] = lines[other], lines[one]
    return b"\n".join(lines)


def missing_line(data: bytes, rng: np.random.Generator) -> bytes:
    """A line is missing."""
    lines = data.split(b"\n")
    del lines[int(rng.integers(0, len(lines)))]
    return b"\n".join(lines)


def repeated_line(data: bytes, rng: np.random.Generator) -> bytes:
    """A line stands there twice."""
    lines = data.split(b"\n")
    at = int(rng.integers(0, len(lines)))
    return b"\n".join(lines[: at + 1] + lines[at:])


def strange_line(data: bytes, rng: np.random.Generator) -> bytes:
    """A line that means nothing, or is very long, in between."""
    strange = (
        b"# comment",
        b"//",
        b"[section]",
        b"key=value",
        b"=",
        b",,,,",
        b"1 2 3",
        b"\x00",
        b"1 " * 50_000,
        b"x" * 10**5,
    )
    lines = data.split(b"\n")
    lines.insert(int(rng.integers(0, len(lines) + 1)), strange[int(rng.integers(0, len(strange)))])
    return b"\n".join(lines)


def another_encoding(data: bytes, rng: np.random.Generator) -> bytes:
    """As another system may save it: UTF-16, Latin-1, with a byte order mark, with other line ends."""
    kind = int(rng.integers(0, 9))
    words = data.decode("utf-8", "replace")
    if kind in (0, 1, 2):
        return words.encode(("utf-16", "utf-16-le", "utf-16-be")[kind])
    if kind == 3:
        at = int(rng.integers(0, len(words) + 1))
        return (words[:at] + "é" + words[at:]).encode("latin-1", "replace")
    if kind == 4:
        return b"\xef\xbb\xbf" + data
    if kind == 5:
        return b"\xef\xbb\xbf\xef\xbb\xbf" + data
    if kind == 6:
        return words.encode("utf-32")
    return data.replace(b"\n", b"\r\n" if kind == 7 else b"\r")


def strange_letters(data: bytes, rng: np.random.Generator) -> bytes:
    """Letters that are no letters: a zero byte, half a surrogate, invisible spaces, other line ends, right to left."""
    strange = (
        b"\x00",
        b"\xed\xa0\x80",
        b"\xc2\xa0",
        b"\xe2\x80\x8b",
        b"\xe2\x80\xa8",
        b"\xc2\x85",
        b"\x0c",
        b"\x1c",
        b"\xe2\x80\xae",
    )
    at = int(rng.integers(0, len(data) + 1))
    return data[:at] + strange[int(rng.integers(0, len(strange)))] + data[at:]


NUMBERS = (strange_number, strange_number, other_number, nudged_number, swapped_fields, missing_field)
LINES = (swapped_lines, missing_line, repeated_line, strange_line)
ENCODINGS = (another_encoding, strange_letters)
