"""Arguments on their way into the sandbox: values go along; what can be called stays here, and is called over the line.

A function or an object of a lesson's may hold the answer: the score that a search climbs knows where the top is.
"""

import io
import pickle
from collections.abc import Callable

from course_lib.classroom.answers import AnswerFormatError, decode, encode, printable
from course_lib.classroom.sandbox_process import record

LONGEST_ERROR = 600
LESSONS = "course_lib.lessons."


def packed(arguments: list[tuple]) -> tuple[bytes, list[object]]:
    """The arguments as a pickle for the sandbox, and the same objects one after the other for `server`."""
    kept_here = [one for given in arguments for one in given]
    buffer = io.BytesIO()
    _Packer(buffer, {id(one): number for number, one in enumerate(kept_here) if _stays(one)}).dump(arguments)
    return buffer.getvalue(), kept_here


def _stays(value: object) -> bool:
    return callable(value) or (type(value).__module__.startswith(LESSONS) and not isinstance(value, tuple))


class _Packer(pickle.Pickler):
    """Leaves a number and public names in place of what stays here, and makes plain records of a lesson's tuples."""

    def __init__(self, buffer: io.BytesIO, numbers: dict[int, int]) -> None:
        super().__init__(buffer)
        self._numbers = numbers

    def persistent_id(self, value: object) -> tuple[int, tuple[str, ...], tuple[str, ...]] | None:
        number = self._numbers.get(id(value))
        if number is None:
            return None
        if callable(value):
            return number, (), ()
        methods = tuple(name for name in vars(type(value)) if not name.startswith("_"))
        return number, methods, tuple(name for name in vars(value) if not name.startswith("_"))

    def reducer_override(self, value: object) -> object:
        if isinstance(value, tuple) and type(value).__module__.startswith(LESSONS):
            return record, (type(value).__name__, type(value)._fields, tuple(value))
        return NotImplemented


def server(kept_here: list[object]) -> Callable[[dict], dict]:
    """Answers the calls of what stayed here; what the caller asks amiss is told as an error."""

    def serve(message: dict) -> dict:
        try:
            number, name, given, named = message["call"], message["name"], decode(message["given"]), message["named"]
            if type(number) is not int or not 0 <= number < len(kept_here) or not _stays(kept_here[number]):
                raise AnswerFormatError("nothing that can be called")
            called = kept_here[number]
            if not callable(called):
                if type(name) is not str or name.startswith("_"):
                    raise AnswerFormatError("nothing that can be called")
                called = getattr(called, name)
            if not callable(called):
                return {"value": encode(called)}
            return {"value": encode(called(*given, **{key: decode(value) for key, value in named.items()}))}
        except Exception as error:
            return {"error": [type(error).__name__, printable(error)[:LONGEST_ERROR]]}

    return serve
