"""Of a notebook's cells, the statements that one function needs: its own, and whatever they in turn make use of.

So one answer does not wait for the lesson's experiments, and a cell that fails does no harm to another cell's
function. Statements that only do something, such as calls and checks, never run.
"""

import ast
import symtable
from collections.abc import Sequence
from typing import NamedTuple

Cell = tuple[str, str]
"""Name and source of one cell."""
Chosen = tuple[str, str, tuple[int, ...]]
"""Name and source of a cell, and which of its top-level statements are needed."""


DEFINITIONS = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)
SIMPLE = (*DEFINITIONS, ast.Assign, ast.AnnAssign, ast.AugAssign, ast.Import, ast.ImportFrom)


class NeededCode(NamedTuple):
    """What to run for a function. problems: cells that could not be read, in words."""

    cells: tuple[Chosen, ...]
    problems: tuple[str, ...]


class _Statement(NamedTuple):
    cell: int
    index: int
    bound: frozenset[str]
    used: frozenset[str]
    defines: str
    """The function or class that it defines, or ""."""
    compound: bool


def needed_code(cells: Sequence[Cell], function: str) -> NeededCode:
    """The statements that `function` needs, cell by cell in the order of the notebook."""
    sources = [(name, _without_magics(source)) for name, source in cells]
    statements, problems = [], []
    for number, (name, source) in enumerate(sources):
        try:
            statements += _statements(number, source)
        except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
            line = f", line {error.lineno}" if isinstance(error, SyntaxError) and error.lineno else ""
            text = error.msg if isinstance(error, SyntaxError) else str(error)
            problems.append(f"{name}{line} is no Python that can be read: {type(error).__name__}: {text}")
    last_definitions = {s.defines: place for place, s in enumerate(statements) if s.defines}
    needed, chosen = {function, "*", "__future__"}, set()
    while True:
        more = [
            s
            for place, s in enumerate(statements)
            if s not in chosen and any(_counts(s, place, name, last_definitions) for name in s.bound & needed)
        ]
        if not more:
            break
        chosen.update(more)
        needed.update(*(s.used | s.bound for s in more))
    picked = [
        (name, source, tuple(s.index for s in statements if s.cell == number and s in chosen))
        for number, (name, source) in enumerate(sources)
    ]
    return NeededCode(tuple(cell for cell in picked if cell[2]), tuple(problems))


def _counts(statement: _Statement, place: int, name: str, last_definitions: dict[str, int]) -> bool:
    """Whether a statement has a say in what a name is: of a function, its last definition and what is assigned after.

    A loop whose variable happens to have a function's name would otherwise bring in half the lesson.
    """
    if name not in last_definitions:
        return True
    return place >= last_definitions[name] and not statement.compound


def _without_magics(source: str) -> str:
    """A cell without lines for IPython; nothing of a cell that is all for another program (`%%bash`)."""
    if source.lstrip().startswith("%%"):
        return ""
    return "\n".join("pass" if line.startswith(("%", "!", "?")) else line for line in source.splitlines())


def _statements(number: int, source: str) -> list[_Statement]:
    """The top-level statements of a cell that bind a name, with what they bind and use."""
    found = []
    for index, node in enumerate(ast.parse(source).body):
        if not isinstance(node, ast.Expr):
            bound, used = _names(node)
            if bound:
                defines = node.name if isinstance(node, DEFINITIONS) else ""
                compound = not isinstance(node, SIMPLE)
                found.append(_Statement(number, index, frozenset(bound), frozenset(used), defines, compound))
    return found


def _names(node: ast.stmt) -> tuple[set[str], set[str]]:
    """Names that a statement binds or changes, and global names that it, or a function in it, uses."""
    if isinstance(node, ast.Import | ast.ImportFrom):
        if isinstance(node, ast.ImportFrom) and node.module == "__future__":
            return {"__future__"}, set()
        return {(name.asname or name.name).partition(".")[0] for name in node.names}, set()
    table = symtable.symtable(ast.unparse(node), "cell", "exec")
    bound = {symbol.get_name() for symbol in table.get_symbols() if symbol.is_assigned() or symbol.is_imported()}
    used = {symbol.get_name() for symbol in table.get_symbols() if symbol.is_referenced()}
    inner = list(table.get_children())
    while inner:
        scope = inner.pop()
        used |= {symbol.get_name() for symbol in scope.get_symbols() if symbol.is_global()}
        inner += scope.get_children()
    bound |= {_root(part) for part in ast.walk(node) if _changes(part)} & used
    return bound, used


def _changes(node: ast.AST) -> bool:
    """Whether a part of a statement changes something inside of a name: `table["a"] = 1`, `colour.red = 2`."""
    return isinstance(node, ast.Subscript | ast.Attribute) and isinstance(node.ctx, ast.Store)


def _root(node: ast.expr) -> str:
    while isinstance(node, ast.Subscript | ast.Attribute):
        node = node.value
    return node.id if isinstance(node, ast.Name) else ""
