"""Common mistakes of one exercise, written as edits of its solution.

A mistake is a line `old => new` and the hint below it:

    rotation(theta) => rotation(-theta)
    You turn by -theta: check the signs in R, or which side R stands on.

Every occurrence of `old` in the solution's text becomes `new`. `... => return x` puts a new body in place of the whole
one; the right function can be called there by its own name. ` and also ` joins edits that make one mistake together.
Several edits above one hint are several ways to make the same mistake.
"""

import inspect
import re
import textwrap
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

ARROW, JOINED, WHOLE_BODY = " =>", " and also ", "..."


class Mistake(NamedTuple):
    """A common mistake: each of `functions` makes it in its own way, and `hint` says what to look at."""

    functions: tuple[Callable, ...]
    hint: str


class EditError(ValueError):
    """An edit does not fit the solution's text, or a hint is missing."""


def read_hints(path: Path) -> dict[str, str]:
    """Return the mistakes of each exercise in a file of hints: the text below its heading `[06.1]`."""
    before, *parts = re.split(r"^\[(\w+\.\d+)\]$", path.read_text(encoding="utf-8"), flags=re.MULTILINE)
    found = dict(zip(parts[::2], parts[1::2], strict=True))
    if before.strip() or 2 * len(found) < len(parts):
        raise EditError(f"{path.name}: write one heading such as [06.1] for each exercise, and its mistakes below it")
    return found


def read_mistakes(solution: Callable, text: str) -> tuple[Mistake, ...]:
    """Return the mistakes that `text` describes as edits of `solution`. Raises `EditError`."""
    found, edits, hint = [], [], []
    for line in [*textwrap.dedent(text).strip().splitlines(), f"{ARROW} end"]:
        if ARROW not in line:
            hint.append(line.strip())
            continue
        if hint:
            if not edits:
                raise EditError(f"{solution.__name__}: the hint {' '.join(hint)!r} stands below no edit")
            found.append(Mistake(tuple(edited(solution, edit) for edit in edits), " ".join(hint).strip()))
            edits, hint = [], []
        edits.append(line)
    if len(edits) > 1:
        raise EditError(f"{solution.__name__}: write a hint below {edits[0].strip()!r}")
    return tuple(found)


def edited(solution: Callable, edit: str) -> Callable:
    """Return the function that an edit makes of the solution. Raises `EditError`."""
    return compiled(solution, edited_text(solution, edit))


def edited_text(solution: Callable, edit: str) -> str:
    """Return the text that an edit makes of the solution's. Raises `EditError` if its left side is not there."""
    source = textwrap.dedent(inspect.getsource(solution))
    for part in edit.split(JOINED):
        old, _, new = (piece.strip() for piece in part.partition(ARROW))
        if old == WHOLE_BODY:
            source = f"{source[: source.index('):') + 2]}\n    {new}"
        elif old in source:
            source = source.replace(old, new)
        else:
            raise EditError(f"{solution.__name__} does not contain {old!r}, so this edit changes nothing: {edit}")
    return source


def compiled(solution: Callable, source: str) -> Callable:
    """Return the function of a changed source text. Other calls of the solution's name still find the right one."""
    names = dict(solution.__globals__)
    try:
        exec(compile(source, f"<a mistake in {solution.__name__}>", "exec"), names)
    except SyntaxError as error:
        raise EditError(f"{solution.__name__}: an edit makes no Python: {error}\n{source}") from error
    function = names[solution.__name__]
    names[solution.__name__] = solution
    return function
