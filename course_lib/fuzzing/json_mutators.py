"""Damage to JSON that leaves it JSON, or nearly: other values, members twice or missing, parts in other places."""

from __future__ import annotations

import json
import re

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
    places = _places(_load(data))
    if rng.random() < 0.3 or not places:
        return b"[" + data + b"]"
    container, key = places[int(rng.integers(0, len(places)))]
    return json.dumps(container[key], ensure_ascii=False).encode()


JSON = (
    json_value,
    json_value,
    json_other_number,
    json_without_key,
    json_key_twice,
    json_other_key,
    json_swapped,
    json_wrapped,
)
