"""Which statements of a notebook one answer needs. This is the one rule of every way of grading.

A statement runs if it defines a name that the answer needs, or may change its value: it assigns to a part of it, calls
a method of it (`table.update(...)`), or hands it to a function that the notebook defines. The names that such a
statement needs count too. Cells that only show or check something do not run.
"""

import ast
import dis
import types
from collections.abc import Iterator, Sequence
from typing import NamedTuple

Cell = tuple[str, str]
"""Name and source of one cell."""
PYTHON_MAGICS = ("time", "timeit", "capture", "prun")
"""Cell magics whose body is Python of the notebook."""
DEFINITIONS = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)


class Statement(NamedTuple):
    """One top-level statement. binds: names that it defines or changes. uses: names that it needs."""

    cell: str
    node: ast.stmt
    binds: frozenset[str]
    uses: frozenset[str]


def without_magics(source: str) -> str:
    """Return a cell's Python. IPython's magics, shell commands and questions become `pass`, line by line."""
    lines = source.splitlines()
    first = lines[0].split() if lines else []
    if first and first[0].startswith("%%"):
        return without_magics("\n".join(["", *lines[1:]])) if first[0][2:] in PYTHON_MAGICS else ""
    if not any(line.lstrip().startswith(("%", "!", "?")) or line.rstrip().endswith("?") for line in lines):
        return source
    try:
        ast.parse(source)  # "%" may begin a line of an expression
        return source
    except SyntaxError:
        is_magic = [line.lstrip().startswith(("%", "!", "?")) or line.rstrip().endswith("?") for line in lines]
        indents = [line[: len(line) - len(line.lstrip())] for line in lines]
        return "\n".join(f"{i}pass" if m else line for i, m, line in zip(indents, is_magic, lines, strict=True))


def read_statements(cells: Sequence[Cell]) -> tuple[list[Statement], list[str]]:
    """Return the statements of all cells, and a sentence for each cell that is not Python."""
    parsed, found, problems = [], [], []
    for name, source in cells:
        try:
            parsed += [(name, node) for node in ast.parse(without_magics(source)).body]
        except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
            problems.append(_unreadable(name, error))
    own = {node.name for _, node in parsed if isinstance(node, DEFINITIONS)}
    for name, node in parsed:
        try:
            found.append(Statement(name, node, *map(frozenset, _names(node, own))))
        except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
            problems.append(_unreadable(name, error))
    return found, problems


def _unreadable(cell: str, error: Exception) -> str:
    line = f", line {error.lineno}" if isinstance(error, SyntaxError) and error.lineno else ""
    return f"{cell}{line} is not Python that can be read: {getattr(error, 'msg', None) or error}"


def needed(statements: Sequence[Statement], function: str) -> list[Statement]:
    """Return the statements that `function` needs, in the order of the notebook."""
    by_name: dict[str, list[int]] = {}
    for place, statement in enumerate(statements):
        for name in statement.binds:
            by_name.setdefault(name, []).append(place)
    waiting, seen, chosen = [function, "*"], set(), set()
    while waiting:
        if (name := waiting.pop()) not in seen:
            seen.add(name)
            for place in by_name.get(name, ()):
                if place not in chosen:
                    chosen.add(place)
                    waiting += statements[place].uses
    return [statements[place] for place in sorted(chosen)]


def _names(node: ast.stmt, own: set[str]) -> tuple[set[str], set[str]]:
    """Return the names that a statement binds or changes, and the global names that it or a function in it loads."""
    if isinstance(node, ast.Import | ast.ImportFrom):
        return {(alias.asname or alias.name).partition(".")[0] for alias in node.names}, set()
    codes = [compile(ast.Module([node], []), "cell", "exec", dont_inherit=True)]
    binds, uses = set(), set()
    for code in codes:
        for one in dis.get_instructions(code):
            if one.opname in ("STORE_NAME", "DELETE_NAME") and code is codes[0]:
                binds.add(one.argval)
            elif one.opname.startswith(("LOAD_NAME", "LOAD_GLOBAL")):
                uses.add(one.argval)
        codes += [constant for constant in code.co_consts if isinstance(constant, types.CodeType)]
    return binds | set(_changed(node, own)) & uses, uses


def _changed(node: ast.AST, own: set[str]) -> Iterator[str]:
    """Yield the names whose values a statement changes from outside a function: by a part, a method, or a call."""
    if isinstance(node, DEFINITIONS):
        return
    if isinstance(node, ast.Subscript | ast.Attribute) and isinstance(node.ctx, ast.Store | ast.Del):
        yield _root(node)
    if isinstance(node, ast.Expr) and isinstance(node.value, ast.Call):
        call = node.value
        if isinstance(call.func, ast.Attribute):
            yield _root(call.func)
        elif _root(call.func) in own:
            yield from (_root(one) for one in [*call.args, *(keyword.value for keyword in call.keywords)])
    for child in ast.iter_child_nodes(node):
        yield from _changed(child, own)


def _root(node: ast.expr) -> str:
    while isinstance(node, ast.Subscript | ast.Attribute):
        node = node.value
    return node.id if isinstance(node, ast.Name) else ""
