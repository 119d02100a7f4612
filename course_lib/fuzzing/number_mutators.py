"""Damage to numbers in binary files: float32 in meshes and weights, the whole numbers and names of ONNX."""

from __future__ import annotations

import re
import struct

import numpy as np


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
