"""What is done to a valid file: one small function each, (bytes, generator) -> bytes, by what is in the file."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from course_lib.fuzzing import image_mutators, json_mutators, mesh_mutators, number_mutators
from course_lib.fuzzing import text_mutators as text

Mutator = Callable[[bytes, np.random.Generator], bytes]


def place(size: int, rng: np.random.Generator) -> int:
    """A place in `size` bytes; as often near the start, where headers are, as anywhere."""
    return int(rng.integers(0, max(1, size if rng.random() < 0.5 else min(size, 200))))


def flip_bits(data: bytes, rng: np.random.Generator) -> bytes:
    """One to eight bits become their opposite."""
    out = bytearray(data or b"\0")
    for _ in range(int(rng.integers(1, 9))):
        out[place(len(out), rng)] ^= 1 << int(rng.integers(0, 8))
    return bytes(out)


def overwrite(data: bytes, rng: np.random.Generator) -> bytes:
    """Some bytes become random ones, zeros or ones."""
    start, length = place(len(data), rng), int(rng.integers(1, 33))
    new = (rng.bytes(length), bytes(length), b"\xff" * length)[int(rng.integers(0, 3))]
    return data[:start] + new[: len(data) - start] + data[start + length :]


def truncate(data: bytes, rng: np.random.Generator) -> bytes:
    """The end is missing."""
    return data[: place(len(data), rng)]


def delete(data: bytes, rng: np.random.Generator) -> bytes:
    """Some bytes are missing."""
    start = place(len(data), rng)
    return data[:start] + data[start + int(rng.integers(1, 65)) :]


def repeat(data: bytes, rng: np.random.Generator) -> bytes:
    """Some bytes stand there twice."""
    start = place(len(data), rng)
    end = start + int(rng.integers(1, 257))
    return data[:end] + data[start:]


def insert(data: bytes, rng: np.random.Generator) -> bytes:
    """Random bytes in between."""
    start = place(len(data), rng)
    return data[:start] + rng.bytes(int(rng.integers(1, 33))) + data[start:]


def swap(data: bytes, rng: np.random.Generator) -> bytes:
    """Two pieces change places."""
    length = int(rng.integers(1, 33))
    first, second = sorted((place(len(data), rng), place(len(data), rng)))
    if second < first + length:
        return data[first:] + data[:first]
    middle = data[first + length : second]
    return (
        data[:first] + data[second : second + length] + middle + data[first : first + length] + data[second + length :]
    )


def append(data: bytes, rng: np.random.Generator) -> bytes:
    """Something follows the end: random bytes, zeros, or the file once more."""
    return data + (rng.bytes(40), bytes(100), data)[int(rng.integers(0, 3))]


def empty(data: bytes, rng: np.random.Generator) -> bytes:
    """Nothing is left, or white space."""
    return (b"", b"\n", b" \n\t\n", bytes(len(data)))[int(rng.integers(0, 4))]


def another_format(data: bytes, rng: np.random.Generator) -> bytes:
    """The start of another kind of file."""
    starts = (
        b"PK\x03\x04",
        b"\x89PNG\r\n\x1a\n",
        b"%PDF-1.7\n",
        b"\x80\x04\x95",
        b"glTF\x02\0\0\0",
        b"<html>",
        b"ply\n",
    )
    return starts[int(rng.integers(0, len(starts)))] + (data if rng.random() < 0.5 else rng.bytes(200))


BYTES: tuple[Mutator, ...] = (
    flip_bits, flip_bits, flip_bits, overwrite, overwrite, truncate, truncate, delete, repeat, insert, swap, append,
    empty, another_format,
)  # fmt: skip
"""For every file; what stands here twice is drawn more often."""

BY_TRAIT: dict[str, tuple[Mutator, ...]] = {
    "text": text.ENCODINGS + text.LINES,
    "numbers": text.NUMBERS * 2,
    "json": json_mutators.JSON * 3,
    "ply": mesh_mutators.PLY,
    "stl": mesh_mutators.STL,
    "png": image_mutators.PNG,
    "jpeg": image_mutators.JPEG,
    "glb": mesh_mutators.GLB * 2,
    "floats": number_mutators.FLOATS,
    "onnx": number_mutators.ONNX,
}
"""For files with something in them."""


def mutators_for(traits: frozenset[str]) -> tuple[Mutator, ...]:
    """Those that mean something for a file with these traits."""
    return tuple(mutator for trait, mutators in BY_TRAIT.items() if trait in traits for mutator in mutators)
