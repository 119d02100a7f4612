"""Make random faults in a room of the library, one at a time, and tell which of them the tests notice.

A fault is an operator exchanged, a comparison made strict or not, an absolute value or a minus dropped, a number raised
by a tenth or by one, an index exchanged, a condition negated, a line dropped, or the first argument returned at once.
Each is made alone, in a copy of the tracked files. First the module's own test file runs (test_MODULE.py of the room),
then those that import the module; where a module has no file of its own, those of its folder too. Of other rooms'
tests the slow ones are left out. What survives is to be read: some faults change nothing that matters.
"""

import argparse
import ast
import copy
import random
import re
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from tools.mutants import ROOT, broken, copied_tree, tests_say

SWAP = {ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.And: ast.Or, ast.Or: ast.And}
SWAP |= {ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq}
LEFT_ALONE = (ast.Raise, ast.JoinedStr, ast.Assert, ast.Import, ast.ImportFrom)
ANNOTATIONS = ("annotation", "returns", "decorator_list")


class Fault(NamedTuple):
    """One place of one file, and what stands there before and after."""

    path: Path
    kind: str
    line: int
    before: str
    after: str
    source: str  # of the whole file, with the fault


def changes(node: ast.AST) -> Iterator[tuple[str, ast.AST]]:
    """What may stand in the place of a node: kinds of faults and new nodes."""
    new = copy.copy(node)
    if isinstance(node, ast.FunctionDef) and len(node.body) > 1 and "return " in ast.unparse(node):
        arguments = [a.arg for a in node.args.posonlyargs + node.args.args if a.arg not in ("self", "cls")]
        if arguments:
            new.body = [ast.Return(ast.Name(arguments[0])), *node.body]
            yield "return at once", new
    elif isinstance(node, ast.AugAssign) or (isinstance(node, ast.Expr) and not isinstance(node.value, ast.Constant)):
        yield "line dropped", ast.Pass()
    elif isinstance(node, ast.Call) and ast.unparse(node.func) in ("abs", "np.abs"):
        yield "abs dropped", node.args[0]
    elif isinstance(node, (ast.BinOp, ast.BoolOp)) and type(node.op) in SWAP:
        new.op = SWAP[type(node.op)]()
        yield "operator", new
    elif isinstance(node, ast.Compare) and type(node.ops[0]) in SWAP:
        new.ops = [SWAP[type(node.ops[0])](), *node.ops[1:]]
        yield "comparison", new
    elif isinstance(node, (ast.If, ast.IfExp)):
        new.test = ast.UnaryOp(ast.Not(), node.test)
        yield "condition negated", new
    elif isinstance(node, ast.Subscript) and isinstance(getattr(node.slice, "value", None), int):
        new.slice = ast.Constant({0: 1, 1: 0}.get(node.slice.value, node.slice.value - 1))
        yield "index", new
    elif isinstance(node, ast.Constant) and type(node.value) in (int, float) and node.value:
        new.value = node.value + 1 if type(node.value) is int else node.value * 1.1
        yield "number", new
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        yield "minus dropped", node.operand


def faults_of(path: Path, tree: ast.Module, node: ast.AST) -> Iterator[Fault]:
    """Every fault below a node, each with the whole file as it is then."""
    for field, value in ast.iter_fields(node):
        children = value if isinstance(value, list) else [value]
        for index, child in enumerate(children):
            if field in ANNOTATIONS or isinstance(child, LEFT_ALONE) or not isinstance(child, ast.AST):
                continue
            for kind, new in changes(child):
                others = [*children[:index], new, *children[index + 1 :]]
                setattr(node, field, others if isinstance(value, list) else new)
                first = [ast.unparse(one).partition("\n")[0] for one in (child, new)]
                yield Fault(path, kind, child.lineno, *first, ast.unparse(ast.fix_missing_locations(tree)))
                setattr(node, field, value)
            yield from faults_of(path, tree, child)


def choose(root: Path, package: str, number: int, seed: int) -> tuple[list[Fault], int]:
    """So many faults of a room, every kind as often, and of how many they were chosen."""
    by_kind: dict[str, list[Fault]] = {}
    for path in sorted((root / "course_lib" / package).rglob("*.py")):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        for fault in faults_of(path.relative_to(root), tree, tree):
            by_kind.setdefault(fault.kind, []).append(fault)
    rng, chosen = random.Random(seed), set()
    total = sum(map(len, by_kind.values()))
    while len(chosen) < min(number, total // 2):
        chosen.add(rng.choice(by_kind[rng.choice(sorted(by_kind))]))
    return sorted(chosen), total


def tests_of(root: Path, module: Path) -> tuple[list[Path], ...]:
    """The module's own test files; those of its room, then of others, that import it; without its own its folder's."""
    folder = root / "tests" / module.parts[1]
    every = sorted((root / "tests").rglob("test_*.py"), key=lambda test: (folder not in test.parents, test))
    own = [t for t in every if t.stem == f"test_{module.stem}" and (folder in t.parents or not folder.is_dir())]
    dotted = re.escape(".".join(module.with_suffix("").parts)) + r"\b"
    importing = [t for t in every if t not in own and re.search(dotted, t.read_text(encoding="utf-8"))]
    beside = [t for t in every if t.parent == folder.joinpath(*module.parts[2:-1]) and t not in importing]
    here = [t for t in importing if folder in t.parents]
    return own, here, [t for t in importing if t not in here], [] if own else beside


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
        for path, kind, line, before, after, source in faults:
            told = f"{path}:{line}: {kind}: {before}  =>  {after}"
            if arguments.list:
                print(told)
                continue
            begun, outcome = time.monotonic(), "survived"
            with broken(root / path, source):
                for tests, speed in zip(tests_of(root, path), ("release", "release", "slow", "release"), strict=True):
                    if tests and outcome == "survived":
                        left = max(arguments.seconds - (time.monotonic() - begun), 5.0)
                        outcome = tests_say(root, tests, left, "-m", f"not {speed} and not browser")
            counts[outcome] += 1
            print(f"{outcome:8} {told}", flush=True)
    if not arguments.list:
        noticed, share = counts["killed"] + counts["hung"], 100 / max(len(faults), 1)
        summary = f"{noticed} of {len(faults)} noticed ({noticed * share:.0f} %), {counts['survived']} survived"
        print(f"{arguments.package}, seed {arguments.seed}: {summary}; {total} faults to choose from")
    return 0


if __name__ == "__main__":
    from courseware.cli import tool

    sys.exit(tool("tools.random_mutants"))
