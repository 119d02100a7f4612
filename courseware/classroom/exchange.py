"""Answers as JSON: numbers, texts, rows and arrays. Reading them runs nothing, whatever a student's process wrote.

`encode` runs in the student's process, `decode` in the grader's. A value of any other kind arrives as an `Unreadable`,
which is no number and therefore wrong. Arrays travel in NumPy's own file format, without pickles.
"""

import base64
import functools
import io
import json

import numpy as np

MAX_DEPTH = 8  # rows within rows
MAX_ROW = 100_000  # values in one list or tuple
MAX_TEXT = 10_000  # characters
MAX_ARRAY = 4 << 20  # bytes
KINDS = "biufc"  # of NumPy's types: numbers and booleans


class Unreadable:
    """Stands for an answer that holds no numbers. Its class has the name of what was returned."""


@functools.lru_cache(maxsize=100)
def unreadable(name: str) -> type:
    """Return the class that stands for values of this name."""
    return type(name or "object", (Unreadable,), {})


class AnswerFormatError(ValueError):
    """The line is not an answer in this format."""


def encode(value: object, depth: int = 0) -> object:
    """Return a value in the form that `json.dumps` takes."""
    if isinstance(value, float) and not isinstance(value, np.generic):
        return float.__float__(value)
    if value is None or type(value) is bool or (type(value) is str and len(value) <= MAX_TEXT):
        return value
    if isinstance(value, int) and abs(int.__int__(value)) < 1 << 64:
        return int.__int__(value)
    if value is ...:
        return {"ellipsis": True}
    if isinstance(value, np.ndarray | np.generic | complex):
        array = np.asarray(value)
        if array.dtype.kind in KINDS and array.nbytes <= MAX_ARRAY:
            buffer = io.BytesIO()
            np.save(buffer, array, allow_pickle=False)
            return {"array": base64.b64encode(buffer.getvalue()).decode(), "scalar": not isinstance(value, np.ndarray)}
    for row in (tuple, list):
        if isinstance(value, row) and depth < MAX_DEPTH and row.__len__(value) <= MAX_ROW:
            return {row.__name__: [encode(part, depth + 1) for part in row.__iter__(value)]}
    return {"kind": type(value).__name__[:60]}


def decode(written: object, depth: int = 0) -> object:
    """Return the value that `encode` wrote. Raises `AnswerFormatError` for anything else."""
    if written is None or type(written) in (bool, int, float, str):
        return written
    if type(written) is dict and len(written) <= 2 and depth <= MAX_DEPTH:
        for row in (tuple, list):
            if type(parts := written.get(row.__name__)) is list and len(parts) <= MAX_ROW:
                return row(decode(part, depth + 1) for part in parts)
        if "ellipsis" in written:
            return ...
        if "array" in written:
            return _decode_array(written)
        if "kind" in written:
            return unreadable(one_line(written["kind"], 60))()
    raise AnswerFormatError("what is not in the format of answers")


def _decode_array(written: dict) -> object:
    try:
        array = np.load(io.BytesIO(base64.b64decode(written["array"], validate=True)), allow_pickle=False)
    except Exception as error:  # NumPy raises many kinds for a damaged header
        raise AnswerFormatError("an array that cannot be read") from error
    if not isinstance(array, np.ndarray) or array.dtype.kind not in KINDS:
        raise AnswerFormatError("an array of an unknown type")
    return array[()] if written.get("scalar") is True and array.ndim == 0 else array


def load(line: bytes) -> dict:
    """Return the message in one line. Raises `AnswerFormatError` if there is none."""
    try:
        message = json.loads(line)
    except (ValueError, RecursionError):
        message = None
    if type(message) is not dict:
        raise AnswerFormatError("a line that is no message")
    return message


def one_line(text: object, length: int = 600) -> str:
    """Return a stranger's text as one line without control characters."""
    return "".join(letter if letter.isprintable() else " " for letter in str(text)[: 2 * length]).strip()[:length]
