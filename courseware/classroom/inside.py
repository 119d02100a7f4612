"""The process in the sandbox: it reads a submission and runs its answers. Nothing here is secret, nothing here decides.

It first sends one line that says what the file holds. Then it takes orders, each a pickle of (number, function,
arguments, forbidden modules), forks a child for each, and sends a line for each call and one at the end.
"""

import ast
import contextlib
import copy
import hashlib
import json
import os
import pickle
import re
import resource
import signal
import struct
import sys
import time
import types
from pathlib import Path
from typing import BinaryIO

from courseware.classroom.exchange import encode
from courseware.lessons.kit.attempt import attempt
from courseware.lessons.kit.exercises import MAX_SHOWN, is_stub, same_values
from courseware.lessons.kit.forbidden import forbidden_module
from courseware.lessons.kit.hints import kind_of
from courseware.lessons.kit.statements import Cell, Statement, needed, read_statements

MAX_SENTENCE = 500  # characters
TRUSTED = ("numpy", "scipy", "course_lib", "courseware", "matplotlib", "cv2", "math")
"""What the process imports before it forks, if the notebook imports it, because imports are slow."""
TRY = re.compile(r"\(try (\d{1,4})\)")
RECALLED = re.compile(r"^\d+\. (.*)\n   you said: (.*)\n   measured: (.*)$", re.MULTILINE)
MIN_NODES = 40  # of a syntax tree: two students write a shorter answer alike by chance


def main(path: str, call_seconds: float, seconds: float) -> None:
    """Serve the grader on standard input and output."""
    orders, results = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb", buffering=0)
    nothing = os.open(os.devnull, os.O_RDWR)
    for number in (0, 1, 2):  # what students' code prints past Python goes nowhere
        os.dup2(nothing, number)
    try:
        cells, held = read_submission(Path(path))
        statements, problems = read_statements(cells)
    except ValueError as error:
        send(results, {"unreadable": str(error)})
        return
    functions = {one.node.name: one.node for one in statements if isinstance(one.node, ast.FunctionDef)}
    shapes = {name: shape for name, node in functions.items() if (shape := digest(node))}
    names = sorted({name for one in statements for name in one.binds})
    send(results, held | {"functions": names, "shapes": shapes, "problems": problems})
    prepare(statements)
    while size := orders.read(8):
        order = pickle.loads(orders.read(struct.unpack("=Q", size)[0]))
        child = os.fork()
        if child == 0:
            orders.close()
            try:
                answer(results, statements, *order, call_seconds)
            except BaseException as error:
                send(results, {"problems": [f"the answer's process: {type(error).__name__}: {error}"[:MAX_SENTENCE]]})
            finally:
                os._exit(0)
        send(results, {"end": wait(child, seconds)})


def send(results: BinaryIO, message: dict) -> None:
    results.write(json.dumps(message).encode("ascii") + b"\n")


def wait(child: int, seconds: float) -> str:
    """Return how the child ended, in words that follow "Your function", or "". Kill it after so many seconds."""
    deadline = time.monotonic() + seconds
    while (found := os.waitpid(child, os.WNOHANG))[0] == 0:
        if time.monotonic() > deadline:
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)
            return f"does not end within {seconds:g} seconds, all its calls together"
        time.sleep(0.005)
    code = os.waitstatus_to_exitcode(found[1])
    return "" if code == 0 else f"crashes its process ({signal.Signals(-code).name if code < 0 else f'exit {code}'})"


def read_submission(path: Path) -> tuple[list[Cell], dict]:
    """Return the code cells of a notebook or a Python file, and what the notebook's metadata and stored outputs tell.

    These are its exercises, the tries at each, and (question, predicted, measured) of each prediction. Raises
    `ValueError` with a sentence that follows "the file".
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
        if path.suffix.lower() == ".py":
            return [("the file", text)], {"exercises": [], "tries": {}, "recalled": []}
        cells = json.loads(text)["cells"]
        code = [(number, cell) for number, cell in enumerate(cells, start=1) if cell["cell_type"] == "code"]
        sources = [(f"cell {number}", "".join(cell["source"])) for number, cell in code]
        numbers = [str(cell["metadata"].get("exercise", "")) for _, cell in code]
        outputs = [[one for one in cell.get("outputs", []) if one.get("output_type") == "stream"] for _, cell in code]
        printed = ["".join("".join(one["text"]) for one in some)[:20_000] for some in outputs]
    except UnicodeDecodeError:
        raise ValueError("is not UTF-8 text") from None
    except (ValueError, RecursionError, KeyError, TypeError, AttributeError) as error:
        raise ValueError(f"is not a notebook that can be read ({type(error).__name__})") from None
    tries = {n: int(found[-1]) for n, text in zip(numbers, printed, strict=True) if n and (found := TRY.findall(text))}
    recalled = [found for text in printed for found in RECALLED.findall(text)]
    return sources, {"exercises": sorted(set(numbers) - {""}), "tries": tries, "recalled": recalled}


def digest(function: ast.FunctionDef) -> str:
    """Return a digest of a function's syntax tree without names of its own and docstring; "" for a short function."""
    try:
        function = ast.parse(ast.unparse(function)).body[0]  # a copy
        if ast.get_docstring(function) is not None:
            function.body = function.body[1:]
        nodes = list(ast.walk(function))
        own = {node.arg for node in nodes if isinstance(node, ast.arg)}
        own |= {node.id for node in nodes if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)}
        order: dict[str, str] = {}
        for node in nodes:
            for field in ("arg", "id"):
                if (name := getattr(node, field, None)) in own:
                    setattr(node, field, order.setdefault(name, f"v{len(order)}"))
        return hashlib.sha256(ast.dump(function).encode()).hexdigest()[:16] if len(nodes) >= MIN_NODES else ""
    except RecursionError:
        return ""


def prepare(statements: list[Statement]) -> None:
    """Import the libraries that the notebook imports, once for all answers."""
    for node in (one.node for one in statements if isinstance(one.node, ast.Import | ast.ImportFrom)):
        modules = [alias.name for alias in node.names] if isinstance(node, ast.Import) else [node.module or ""]
        if all(name.partition(".")[0] in TRUSTED for name in modules):
            with contextlib.suppress(Exception):
                exec(compile(ast.Module([node], []), "imports", "exec"), {})


def answer(
    results: BinaryIO, statements: list[Statement], number: str, function: str, arguments: bytes, forbidden: tuple,
    call_seconds: float,
) -> None:  # fmt: skip
    """Run what the function needs, then call it with each tuple of arguments; send the outcome of each call."""
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    names, problems = run(needed(statements, function), call_seconds)
    found = names.get(function)
    head = {"number": number, "problems": problems}
    if not callable(found) or is_stub(found):
        kind = "stub" if callable(found) else "missing" if found is None else kind_of(found)
        return send(results, head | {"none": kind})
    banned = forbidden_module(found, forbidden) if forbidden else None
    send(results, head | {"forbidden": banned})
    if banned:
        return
    for index, given in enumerate(pickle.loads(arguments)):
        kept = copy.deepcopy(given)
        call = attempt(found, given, call_seconds)
        message: dict = {"call": index, "printed": "" if index else call.printed[:MAX_SHOWN]}
        if call.failure is not None:
            send(results, message | {"failure": call.failure[:MAX_SENTENCE]})
            if call.failure.startswith(("does not end", "stops with MemoryError")):
                return  # the other inputs would cost as much again
        else:
            changed = "." in number and not same_values(given, kept)
            send(results, message | {"value": encode(call.value), "changed": changed})


def run(statements: list[Statement], seconds: float) -> tuple[dict, list[str]]:
    """Return the names that the statements define, and a sentence for each statement that failed."""
    sys.modules["handed_in"] = types.ModuleType("handed_in")
    names, problems = vars(sys.modules["handed_in"]), []
    for one in statements:
        code = compile(ast.Module([one.node], []), one.cell, "exec", dont_inherit=True)
        failure = attempt(lambda code=code: exec(code, names), (), seconds).failure
        if failure is not None:
            problems.append(f"{one.cell}, line {one.node.lineno} {failure}"[:MAX_SENTENCE])
    return names, problems
