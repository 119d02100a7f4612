"""Answers as text that can be read without running anything: numbers, texts, rows of such, arrays; nothing else.

The process that runs a student's function writes them with `encode`; the grader reads them with `decode`, which builds
plain values of its own whatever is written. What is no such value arrives as an `Unreadable` of the same name, which
is no number and therefore wrong. Objects, classes and pickles are never sent this way.
"""

import base64
import json
import math

import numpy as np

LARGEST_ARRAY = 32 << 20
"""Bytes of one array; right answers hold some kilobytes."""
LARGEST_ROW = 100_000
"""Values in one list or tuple."""
LONGEST_TEXT = 10_000
DEEPEST = 8
"""Rows within rows."""
KINDS = "biufc"
TYPES = {
    np.dtype(name).str for name in ("?", "i1", "i2", "i4", "i8", "u1", "u2", "u4", "u8", "f2", "f4", "f8", "c8", "c16")
}


class Unreadable:
    """Stands for an answer that holds no numbers; its class has the name of what was returned."""


class AnswerFormatError(ValueError):
    """What was written is no answer in this format."""


def encode(value: object, depth: int = 0) -> object:
    """A value as what `json.dumps` takes; of a class of the student's own, the number or row that it is underneath."""
    if value is None or value is ... or type(value) is bool:
        return {"ellipsis": True} if value is ... else value
    if isinstance(value, np.ndarray | np.generic | complex):
        return _encode_array(value)
    if isinstance(value, float):
        number = float.__float__(value)
        return number if math.isfinite(number) else {"float": repr(number)}
    if isinstance(value, int) and abs(int.__int__(value)) < 1 << 64:
        return int.__int__(value)
    if type(value) is str and len(value) <= LONGEST_TEXT:
        return value
    row = tuple if isinstance(value, tuple) else list if isinstance(value, list) else None
    if row is not None and row.__len__(value) <= LARGEST_ROW and depth < DEEPEST:
        return {row.__name__: [encode(part, depth + 1) for part in row.__iter__(value)]}
    return {"kind": str(type(value).__name__)[:60]}


def _encode_array(value: object) -> dict:
    array = np.asarray(value)
    if array.dtype.kind not in KINDS:
        return {"kind": "ndarray of " + str(array.dtype)[:40]}
    if array.dtype.itemsize > 8 and array.dtype.kind == "f":
        array = array.astype(np.float64) if array.size * 8 <= LARGEST_ARRAY else array
    if array.nbytes > LARGEST_ARRAY:  # before a byte is copied: a view may stand for more than there is memory
        return {"kind": f"{'x'.join(str(side) for side in array.shape)} array, which is too large"}
    array = array.astype(array.dtype.newbyteorder("="), copy=False)
    if array.dtype.str not in TYPES:
        return {"kind": "ndarray of " + str(array.dtype)[:40]}
    return {
        "array": base64.b64encode(np.ascontiguousarray(array).tobytes()).decode("ascii"),
        "type": array.dtype.str,
        "shape": list(array.shape),
        "scalar": not isinstance(value, np.ndarray),
    }


def decode(written: object, depth: int = 0) -> object:
    """The value that `encode` wrote. Raises `AnswerFormatError` for anything else, which only a forger writes."""
    if written is None or type(written) in (bool, float):
        return written
    if (type(written) is int and abs(written) < 1 << 64) or (type(written) is str and len(written) <= LONGEST_TEXT):
        return written
    if type(written) is dict and depth <= DEEPEST:
        if written == {"ellipsis": True}:
            return ...
        if written.keys() == {"float"} and written["float"] in ("inf", "-inf", "nan"):
            return float(written["float"])
        for row in (tuple, list):
            parts = written.get(row.__name__)
            if written.keys() == {row.__name__} and type(parts) is list and len(parts) <= LARGEST_ROW:
                return row(decode(part, depth + 1) for part in parts)
        if written.keys() == {"array", "type", "shape", "scalar"}:
            return _decode_array(written)
        if written.keys() == {"kind"} and type(written["kind"]) is str:
            return type(printable(written["kind"])[:60] or "object", (Unreadable,), {})()
    raise AnswerFormatError("not in the format of answers")


def _decode_array(written: dict) -> object:
    shape, kind = written["shape"], written["type"]
    if type(shape) is not list or not all(type(side) is int and side >= 0 for side in shape) or len(shape) > 32:
        raise AnswerFormatError("an array's shape is not a row of whole numbers")
    if type(kind) is not str or kind not in TYPES or type(written["array"]) is not str:
        raise AnswerFormatError("an array of an unknown type")
    try:
        content = base64.b64decode(written["array"], validate=True)
    except ValueError as error:
        raise AnswerFormatError("an array whose content cannot be read") from error
    if len(content) != math.prod(shape) * np.dtype(kind).itemsize:
        raise AnswerFormatError("an array whose shape does not fit its content")
    try:
        array = np.frombuffer(content, dtype=kind).reshape(shape).copy()
    except (ValueError, OverflowError) as error:  # no value at all, but a side longer than there are numbers for
        raise AnswerFormatError("an array's shape is too large") from error
    return array[()] if written["scalar"] is True and array.ndim == 0 else array


def dump(message: dict) -> bytes:
    """One message as one line."""
    return json.dumps(message).encode("ascii") + b"\n"


def load(line: bytes) -> dict:
    """The message in one line. Raises `AnswerFormatError` for what is none."""
    try:
        message = json.loads(line)
    except (ValueError, RecursionError) as error:
        raise AnswerFormatError("a line that is no message") from error
    if type(message) is not dict:
        raise AnswerFormatError("a line that is no message")
    return message


def printable(text: object) -> str:
    """One line of text without control characters, for messages and names that a stranger chose."""
    return "".join(letter if letter.isprintable() else " " for letter in str(text)).strip()
