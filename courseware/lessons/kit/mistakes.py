"""Common mistakes of one exercise, written as edits of its solution.

A mistake is a line `old => new` and the hint below it:

    rotation(theta) => rotation(-theta)
    You turn by -theta: check the signs in R, or which side R stands on.

`old` stands once below the solution's docstring, and becomes `new`. `everywhere old => new` changes every place, where
there are several. `... => return x` puts a new body in place of the whole one. The right function can be called there
by its own name. ` and also ` joins edits that make one mistake together. Several edits above one hint are several ways
to make the same mistake.
"""

import ast
import inspect
import re
import textwrap
from collections.abc import Callable
from importlib.resources.abc import Traversable
from typing import NamedTuple

ARROW, JOINED, EVERYWHERE, WHOLE_BODY = " =>", " and also ", "everywhere ", "..."


class Mistake(NamedTuple):
    """A common mistake: each of `functions` makes it in its own way, and `hint` says what to look at."""

    functions: tuple[Callable, ...]
    hint: str


class EditError(ValueError):
    """An edit does not fit the solution's text, or a hint is missing."""


def read_hints(path: Traversable) -> dict[str, str]:
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
    """Return the solution's text after an edit. Raises `EditError` if its left side does not stand there once."""
    source = textwrap.dedent(inspect.getsource(solution))
    function = ast.parse(source).body[0]
    lines, first = source.splitlines(), function.body[0]
    start = first.lineno - 1 if ast.get_docstring(function) is None else first.end_lineno
    code = "\n".join(lines[start:])
    for part in edit.split(JOINED):
        left, _, new = (piece.strip() for piece in part.partition(ARROW))
        old = left.removeprefix(EVERYWHERE)
        places = code.count(old)
        if old == WHOLE_BODY:
            code = f"    {new}"
        elif places == 0:
            raise EditError(f"{solution.__name__} does not contain {old!r}, so this edit changes nothing")
        elif places > 1 and old == left:
            raise EditError(
                f"{solution.__name__} contains {old!r} {places} times: write more of the line, or `everywhere`"
            )
        elif places == 1 and old != left:
            raise EditError(f"{solution.__name__} contains {old!r} once: leave `everywhere` out")
        else:
            code = code.replace(old, new)
    return "\n".join([*lines[:start], code])


def compiled(solution: Callable, source: str) -> Callable:
    """Return the function of a changed source text. It has another name, so a call by the old one is the right one."""
    name, names = f"{solution.__name__}_mistaken", dict(solution.__globals__)
    try:
        tree = ast.parse(source)
        tree.body[0].name = name
        exec(compile(tree, f"<a mistake in {solution.__name__}>", "exec"), names)
    except SyntaxError as error:
        raise EditError(f"{solution.__name__}: an edit makes no Python: {error}\n{source}") from error
    return names[name]
