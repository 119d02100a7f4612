"""Refuse a second call while a filter is in one: two at once would mix their images, and no answer would show it."""

import threading
from collections.abc import Callable
from functools import wraps
from typing import TypeVar

Method = TypeVar("Method", bound=Callable)


class _Turn:
    """The lock of one object. It is not copied with the object: a copy or an unpickled one gets a free lock."""

    def __init__(self) -> None:
        self.lock = threading.RLock()  # reentrant, because a method may call another one of the same object

    def __reduce__(self) -> tuple:
        return _Turn, ()


def one_at_a_time(method: Method) -> Method:
    """Return a method that refuses a call while another thread is in one of the object's methods marked so.

    It does not wait, because a queue of old images would only hide the mistake. Raises `RuntimeError`.
    """

    @wraps(method)
    def called(self: object, *arguments: object, **named: object) -> object:
        turn = vars(self).setdefault("_turn", _Turn())
        if not turn.lock.acquire(blocking=False):
            raise RuntimeError(
                f"two threads called {method.__name__} of one {type(self).__name__} at once, whose images would mix. "
                "Make one localizer for each thread, or put one lock around all its calls"
            )
        try:
            return method(self, *arguments, **named)
        finally:
            turn.lock.release()

    return called
