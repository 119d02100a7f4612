"""The process in which strangers' code runs: started clean, it forks a child for each answer, which raises its walls.

Started by `sandbox.Sandbox`, which sends over a socket, for each answer, three ends of pipes and a folder. This
process itself runs no stranger's code and never sees any: the child reads what it shall run from its own pipe, so that
nothing of one student's is left in the memory of the next one's child. It has imported the library (but no exercises:
there is no reference to be found in it) so that a child starts in milliseconds, and has opened no window of VTK's,
which would not live through a fork.
"""

from __future__ import annotations
import __future__

import ast
import builtins
import collections
import contextlib
import copy
import fcntl
import gc
import importlib
import io
import json
import os
import pickle
import socket
import struct
import sys
import threading
import time
import types
from pathlib import Path
from typing import NamedTuple

from course_lib.classroom.answers import decode, dump, encode, load
from course_lib.classroom.confinement import Limits, die_with_parent, raise_walls
from course_lib.classroom.refusals import refuse
from course_lib.lessons.kit.attempt import attempt
from course_lib.lessons.kit.exercises import MAX_SHOWN, is_stub, same_values
from course_lib.lessons.kit.hints import kind_of

PREPARED = (
    "course_lib.depth_mcl",
    "course_lib.lessons",
    "course_lib.spherical_stereo",
    "course_lib.plots.scenes",
    "cv2",
    "scipy.linalg",
    "scipy.ndimage",
    "scipy.optimize",
    "scipy.spatial",
    "scipy.stats",
)
"""Imported before the fork: what answers import, and slow to import."""
LONGEST_SENTENCE = 500


class Confinement(NamedTuple):
    """What holds for every answer of a run. Paths may be read, or their names listed; `trusted`: no walls needed."""

    readable: tuple[str, ...]
    listable: tuple[str, ...]
    trusted: bool = False


class Assignment(NamedTuple):
    """What one child runs.

    cells: (name, source, which of its top-level statements) of each cell that is needed. function: its name.
    arguments: a pickle of the list of tuples, made by the grader; remote objects in it by their number. limits: what it
    may use. keeps: arguments must not be changed.
    """

    cells: tuple[tuple[str, str, tuple[int, ...]], ...]
    function: str
    arguments: bytes
    limits: Limits = Limits()
    keeps: bool = True


def main(socket_number: int) -> None:
    """Serve until the other side closes the socket."""
    if sys.platform == "linux":
        die_with_parent()
    line = socket.socket(fileno=socket_number)
    confinement = Confinement(*json.loads(line.makefile("rb").readline()))
    for name in PREPARED:
        with contextlib.suppress(ImportError):
            importlib.import_module(name)
    gc.freeze()
    line.sendall(b"ready")
    while True:
        folder, descriptors, _, _ = socket.recv_fds(line, 1 << 16, 3)
        if not folder:
            return
        child = os.fork()
        if child == 0:
            line.close()
            run_child(confinement, Path(os.fsdecode(folder)), *descriptors)
        for descriptor in descriptors:
            os.close(descriptor)
        line.sendall(str(child).encode())
        line.recv(16)  # the grader has read all it wants, and has killed the child if need be
        _, status, used = os.wait4(child, 0)
        line.sendall(json.dumps([os.waitstatus_to_exitcode(status), used.ru_maxrss / 1024]).encode())


class Channel:
    """A child's line to the grader: it sends messages, and may be answered."""

    def __init__(self, orders: int, results: int) -> None:
        self._orders, self._results = os.fdopen(orders, "rb"), results
        self._lock = threading.RLock()

    def assignment(self) -> Assignment:
        """What the grader sent, which is trusted."""
        (length,) = struct.unpack("=Q", self._orders.read(8))
        return Assignment(*pickle.loads(self._orders.read(length)))

    def send(self, message: dict) -> None:
        line = memoryview(dump(message))
        with self._lock:
            while line:
                line = line[os.write(self._results, line) :]

    def ask(self, message: dict) -> dict:
        with self._lock:
            self.send(message)
            return load(self._orders.readline())


def run_child(confinement: Confinement, own_folder: Path, orders: int, results: int, printed: int) -> None:
    """All of a child's life; never returns."""
    try:
        if sys.platform == "linux":
            die_with_parent()
        os.setsid()
        channel = Channel(*_only_these_open(orders, results, printed))
        assignment = channel.assignment()
        os.chdir(own_folder)
        os.environ.update(HOME=str(own_folder), TMPDIR=str(own_folder), MPLCONFIGDIR=str(own_folder))
        readable, listable = ([Path(path) for path in paths] for paths in confinement[:2])
        missing = raise_walls(readable, listable, own_folder, assignment.limits)
        channel.send({"missing walls": missing})
        if not missing or confinement.trusted:
            listable += map(Path, sys.path)  # the importer asks, is refused by the kernel, and looks elsewhere
            refuse(readable, listable, own_folder, lambda what: channel.send({"refused": what}))
            answer(assignment, channel)
            channel.send({"done": True})
    except Exception as error:
        channel.send({"problem": f"the answer's process: {type(error).__name__}: {error}"[:LONGEST_SENTENCE]})
    finally:
        os._exit(0)


def _only_these_open(orders: int, results: int, printed: int) -> tuple[int, int]:
    """Nothing to read from, both outputs into `printed`, the two other pipes at 3 and 4; no other file is open."""
    nothing = os.open(os.devnull, os.O_RDONLY)
    wanted = [fcntl.fcntl(number, fcntl.F_DUPFD, 10) for number in (nothing, printed, printed, orders, results)]
    for number, descriptor in enumerate(wanted):
        os.dup2(descriptor, number, inheritable=False)
    os.closerange(5, os.sysconf("SC_OPEN_MAX"))
    for name, number in (("stdout", 1), ("stderr", 2)):
        stream = io.TextIOWrapper(os.fdopen(number, "wb", buffering=0), "utf-8", "replace", write_through=True)
        setattr(sys, name, stream)
    return 3, 4


# What a child does inside its walls


class Remote:
    """Stands for a function or an object of the grader's: a call asks the grader, who keeps what is inside.

    methods, values: names of an object that may be asked for; a function has none, and is called itself.
    """

    def __init__(self, channel: Channel, number: int, methods: tuple[str, ...], values: tuple[str, ...]) -> None:
        self._channel, self._number, self._methods, self._values = channel, number, methods, values

    def __call__(self, *given: object, **named: object) -> object:
        return self._ask("", given, named)

    def __getattr__(self, name: str) -> object:
        if name.startswith("_") or name not in (*self._methods, *self._values):
            raise AttributeError(name)
        if name in self._values:
            return self._ask(name, (), {})
        return lambda *given, **named: self._ask(name, given, named)

    def __deepcopy__(self, memo: dict) -> Remote:
        return self

    def _ask(self, name: str, given: tuple, named: dict) -> object:
        told = self._channel.ask(
            {
                "call": self._number,
                "name": name,
                "given": encode(tuple(given)),
                "named": {key: encode(value) for key, value in named.items()},
            }
        )
        if "error" in told:
            kind, text = told["error"]
            known = getattr(builtins, kind, None)
            raise (known if isinstance(known, type) and issubclass(known, Exception) else RuntimeError)(text)
        return decode(told["value"])


def record(name: str, fields: tuple[str, ...], values: tuple) -> tuple:
    """A named tuple of a lesson's, whose module is not to be read in here."""
    return collections.namedtuple(name, fields)(*values)


class _Arguments(pickle.Unpickler):
    """Reads the grader's arguments; what he keeps for himself becomes a `Remote`."""

    def __init__(self, content: bytes, channel: Channel) -> None:
        super().__init__(io.BytesIO(content))
        self._channel = channel

    def persistent_load(self, kept: tuple[int, tuple[str, ...], tuple[str, ...]]) -> Remote:
        return Remote(self._channel, *kept)


def answer(assignment: Assignment, channel: Channel) -> None:
    """Run what is needed of the notebook, then the function on every tuple of arguments; send what came of each."""
    limits = assignment.limits
    names = _run_cells(assignment.cells, channel, limits)
    function = names.get(assignment.function)
    if not callable(function) or is_stub(function):
        channel.send({"none": "stub" if callable(function) else "missing" if function is None else kind_of(function)})
        return
    for index, given in enumerate(_Arguments(assignment.arguments, channel).load()):
        kept = copy.deepcopy(given)
        started = time.monotonic()
        call = attempt(function, given, limits.call_seconds)
        message = {"printed": "" if index else call.printed[:MAX_SHOWN]}
        if call.failure is not None:
            channel.send(message | {"failure": call.failure[:LONGEST_SENTENCE]})
            if time.monotonic() - started >= limits.call_seconds or call.failure.startswith("stops with MemoryError"):
                return  # the other inputs would cost as much again
        else:
            channel.send(
                message | {"value": encode(call.value), "changed": assignment.keeps and not same_values(given, kept)}
            )


def _run_cells(cells: tuple, channel: Channel, limits: Limits) -> dict:
    """The names that the chosen statements of the cells define; what fails is told and the next statement runs."""
    module = types.ModuleType("handed_in")
    sys.modules[module.__name__] = module
    names = module.__dict__
    names["display"] = print
    flags = 0
    for cell, source, chosen in cells:
        body = ast.parse(source).body
        for node in (node for index in chosen for node in _one_by_one(body[index])):
            if isinstance(node, ast.ImportFrom) and node.module == "__future__":
                for feature in node.names:
                    flags |= getattr(getattr(__future__, feature.name, None), "compiler_flag", 0)
                continue
            code = compile(ast.Module([node], []), cell, "exec", flags, dont_inherit=True)
            failure = attempt(lambda code=code: exec(code, names), (), limits.call_seconds).failure
            if failure is not None:
                channel.send({"problem": f"{cell}: line {node.lineno} {failure}"[:LONGEST_SENTENCE]})
    return names


def _one_by_one(node: ast.stmt) -> list[ast.stmt]:
    """An import of several names as several imports: one that is refused takes no other one with it."""
    if isinstance(node, ast.Import):
        return [ast.copy_location(ast.Import([name]), node) for name in node.names]
    if isinstance(node, ast.ImportFrom):
        return [ast.copy_location(ast.ImportFrom(node.module, [name], node.level), node) for name in node.names]
    return [node]
