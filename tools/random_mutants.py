"""Make random faults in a room of the library, one at a time, and tell which of them the tests notice.

A fault is an operator exchanged, a comparison made strict or not, an absolute value or a minus dropped, a number raised
by a tenth or by one, an index exchanged, a condition negated, a line dropped, or the first argument returned at once.
Each is made alone, in a copy of the tracked files. First the module's own test file runs (test_MODULE.py of the room),
then those that import the module; where a module has no file of its own, those of its folder too. Slow tests and
browsers are left out. What survives is to be read: some faults change nothing that matters.
"""

from __future__ import annotations

import argparse
import ast
import random
import re
import sys
import time
from pathlib import Path

from tools.mutants import ROOT, broken, copied_tree, tests_say

SWAP = {ast.Add: ("+", "-"), ast.Sub: ("-", "+"), ast.Mult: ("*", "/"), ast.Div: ("/", "*")}
COMPARE = {
    ast.Lt: ("<", "<="),
    ast.LtE: ("<=", "<"),
    ast.Gt: (">", ">="),
    ast.GtE: (">=", ">"),
    ast.Eq: ("==", "!="),
    ast.NotEq: ("!=", "=="),
}
TYPES = {"Literal", "Callable", "tuple", "list", "dict", "type", "Sequence", "Iterator", "Iterable"}
Fault = tuple[Path, str, int, int, str]
"""File, kind, start and end in the source, and the new text."""


class Sites(ast.NodeVisitor):
    """Places in a source where one fault can be made: `found`, a list of (kind, start, end, new text)."""

    def __init__(self, source: str) -> None:
        self.source, self.lines, self.found = source, source.split("\n"), []
        self.visit(ast.parse(source))

    def at(self, line: int, column: int) -> int:
        text = self.lines[line - 1].encode()[:column].decode()
        return sum(len(one) + 1 for one in self.lines[: line - 1]) + len(text)

    def span(self, node: ast.AST) -> tuple[int, int]:
        return self.at(node.lineno, node.col_offset), self.at(node.end_lineno, node.end_col_offset)

    def add(self, kind: str, start: int, end: int, new: str) -> None:
        if self.source[start:end] != new:
            self.found.append((kind, start, end, new))

    def visit_FunctionDef(self, node):
        if node.name in ("__repr__", "__str__", "__reduce__"):
            return
        arguments = [a.arg for a in node.args.posonlyargs + node.args.args if a.arg not in ("self", "cls")]
        body = [x for x in node.body if not (isinstance(x, ast.Expr) and isinstance(x.value, ast.Constant))]
        returns = any(isinstance(x, ast.Return) and x.value is not None for x in ast.walk(node))
        if arguments and len(body) > 1 and returns:
            start = self.span(body[0])[0]
            self.add("return at once", start, start, f"return {arguments[0]}\n" + " " * body[0].col_offset)
        for x in [d for d in node.args.defaults + node.args.kw_defaults if d is not None] + body:
            self.visit(x)

    def visit_Expr(self, node):
        if not isinstance(node.value, ast.Constant):
            self.add("line dropped", *self.span(node), "pass")
            self.generic_visit(node)

    def skip(self, node):
        return

    visit_Raise = visit_JoinedStr = visit_Assert = visit_Import = visit_ImportFrom = skip

    def visit_AnnAssign(self, node):
        if node.value is not None:
            self.visit(node.value)

    def visit_AugAssign(self, node):
        self.add("line dropped", *self.span(node), "pass")
        self.generic_visit(node)

    def visit_Call(self, node):
        if ast.unparse(node.func) in ("abs", "np.abs") and len(node.args) == 1:
            start, end = self.span(node.args[0])
            self.add("abs dropped", *self.span(node), f"({self.source[start:end]})")
        self.generic_visit(node)

    def visit_BinOp(self, node):
        start, end = self.span(node.left)[1], self.span(node.right)[0]
        pair, middle = SWAP.get(type(node.op)), self.source[start:end]
        is_text = isinstance(node.left, ast.JoinedStr) or isinstance(getattr(node.left, "value", None), str)
        if pair and middle.count(pair[0]) == 1 and not is_text:
            self.add("operator", start, end, middle.replace(*pair))
        self.generic_visit(node)

    def visit_Compare(self, node):
        left = node.left
        for operator, right in zip(node.ops, node.comparators, strict=True):
            start, end = self.span(left)[1], self.span(right)[0]
            if pair := COMPARE.get(type(operator)):
                self.add("comparison", start, end, self.source[start:end].replace(*pair, 1))
            left = right
        self.generic_visit(node)

    def visit_BoolOp(self, node):
        start, end = self.span(node.values[0])[1], self.span(node.values[1])[0]
        if len(node.values) == 2:
            new = re.sub(r"\b(and|or)\b", lambda m: "or" if m[0] == "and" else "and", self.source[start:end])
            self.add("and, or", start, end, new)
        self.generic_visit(node)

    def negate(self, node):
        start, end = self.span(node.test)
        if ast.unparse(node.test) != "TYPE_CHECKING":
            self.add("condition negated", start, end, f"not ({self.source[start:end]})")
        self.generic_visit(node)

    visit_If = visit_IfExp = negate

    def visit_Subscript(self, node):
        if isinstance(node.value, ast.Name) and node.value.id in TYPES:
            return
        for e in node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]:
            if isinstance(e, ast.Constant) and type(e.value) is int and e.value in (0, 1, 2):
                self.add("index", *self.span(e), {0: "1", 1: "0", 2: "1"}[e.value])
            else:
                self.visit(e)
        self.visit(node.value)

    def visit_Constant(self, node):
        if type(node.value) is float and node.value:
            self.add("a tenth more", *self.span(node), repr(node.value * 1.1))
        elif type(node.value) is int and node.value:
            self.add("one more", *self.span(node), str(node.value + 1))

    def visit_UnaryOp(self, node):
        if isinstance(node.op, ast.USub) and not isinstance(node.operand, ast.Constant):
            start, end = self.span(node.operand)
            self.add("minus dropped", *self.span(node), self.source[start:end])
        self.generic_visit(node)


def choose(root: Path, package: str, number: int, seed: int) -> tuple[list[Fault], int]:
    """So many faults of a room, every kind as often, and of how many they were chosen."""
    by_kind: dict[str, list[Fault]] = {}
    for path in sorted((root / "course_lib" / package).rglob("*.py")):
        if path.name == "__init__.py":
            continue
        source = path.read_text(encoding="utf-8")
        for kind, start, end, new in Sites(source).found:
            try:
                compile(source[:start] + new + source[end:], "x", "exec")
            except SyntaxError:
                continue
            by_kind.setdefault(kind, []).append((path.relative_to(root), kind, start, end, new))
    rng, chosen, seen = random.Random(seed), [], set()
    total = sum(map(len, by_kind.values()))
    while len(chosen) < min(number, total // 2):
        one = rng.choice(by_kind[rng.choice(sorted(by_kind))])
        if one[:1] + one[2:3] not in seen:
            seen.add(one[:1] + one[2:3])
            chosen.append(one)
    return chosen, total


def tests_of(root: Path, module: Path) -> tuple[list[Path], list[Path], list[Path]]:
    """The module's own test files, those anywhere that import it, and without its own those of its folder."""
    folder = root / "tests" / module.parts[1]
    every = sorted((root / "tests").rglob("test_*.py"), key=lambda test: (folder not in test.parents, test))
    own = [t for t in every if t.stem == f"test_{module.stem}" and (folder in t.parents or not folder.is_dir())]
    dotted = re.escape(".".join(module.with_suffix("").parts)) + r"\b"
    importing = [t for t in every if t not in own and re.search(dotted, t.read_text(encoding="utf-8"))]
    beside = [t for t in every if t.parent == folder.joinpath(*module.parts[2:-1]) and t not in importing]
    return own, importing, [] if own else beside


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `random_mutants`."""
    parser.add_argument("package", help="a room of course_lib, such as depth_mcl or beyond")
    parser.add_argument("--number", type=int, default=30, metavar="N", help="how many faults (default: 30)")
    parser.add_argument("--seed", type=int, default=1, metavar="N", help="of their choice (default: 1)")
    parser.add_argument("--seconds", type=float, default=240, help="for the tests of one fault (default: 240)")
    parser.add_argument("--list", action="store_true", help="only say what would be tried")


def run(arguments: argparse.Namespace) -> int:
    """Try the faults, a line each, and a summary."""
    if not (ROOT / "course_lib" / arguments.package).is_dir():
        raise ValueError(f"there is no room {arguments.package!r} in course_lib")
    counts = dict.fromkeys(("killed", "survived", "hung"), 0)
    with copied_tree() as root:
        faults, total = choose(root, arguments.package, arguments.number, arguments.seed)
        for path, kind, start, end, new in faults:
            source = (root / path).read_text(encoding="utf-8")
            text, line = source[:start] + new + source[end:], source[:start].count("\n")
            before, after = (one.split("\n")[line].strip() for one in (source, text))
            told = f"{path}:{line + 1}: {kind}: {before}  =>  {after}"
            if arguments.list:
                print(told)
                continue
            begun, outcome = time.monotonic(), "survived"
            with broken(root / path, text):
                for tests in tests_of(root, path):
                    if tests and outcome == "survived":
                        left = max(arguments.seconds - (time.monotonic() - begun), 5.0)
                        outcome = tests_say(root, tests, left, "-m", "not slow and not browser")
            counts[outcome] += 1
            print(f"{outcome:8} {told}", flush=True)
    if not arguments.list:
        noticed, share = counts["killed"] + counts["hung"], 100 / max(len(faults), 1)
        summary = f"{noticed} of {len(faults)} noticed ({noticed * share:.0f} %), {counts['survived']} survived"
        print(f"{arguments.package}, seed {arguments.seed}: {summary}; {total} faults to choose from")
    return 0


if __name__ == "__main__":
    from course_lib.cli import tool

    sys.exit(tool("tools.random_mutants"))
