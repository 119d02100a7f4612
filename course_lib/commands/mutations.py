"""Mutations: faults that the tests must notice, each tried in a scratch copy of the repository.

`course.py test --mutations` reads them from tests/mutations.toml, one entry a fault:

    [[mutation]]
    name = "colour from the lower image"     # what is broken, in words
    file = "course_lib/spherical_stereo/..." # one file
    old = "exact text that stands in the file once"
    new = "what it becomes"
    tests = ["tests/spherical_stereo/..."]   # files (or file::test) that must fail under it

The tests of all of them must pass on the unbroken code first, or a test that always fails would seem to notice it.
"""

from __future__ import annotations

import concurrent.futures
import contextlib
import os
import queue
import re
import shutil
import signal
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, fields
from pathlib import Path

from course_lib.commands import test as suite
from course_lib.scratch import scratch_folder

# Folders of the first level.
NOT_COPIED = (".git", ".venv", "results", "work", "build", ".pytest_cache", ".ruff_cache", ".hypothesis")
NO_PLUGINS = ("-p", "no:cacheprovider", "-p", "no:nbval")  # nbval's import alone takes seconds
# A crash of the code's own making: OpenGL used from two threads may end so before it draws anything wrong. A process
# that somebody else killed (SIGKILL where memory ran out, SIGTERM) proves nothing.
CRASHES = tuple(-number for number in (signal.SIGSEGV, signal.SIGABRT, signal.SIGFPE, signal.SIGILL))
PASSED, FAILED, INTERRUPTED = 0, 1, 2  # pytest's exit codes; interrupted: a file could not even be imported


class MutationError(ValueError):
    """A list of mutations that cannot be read, or an entry that does not fit the code: the message names it."""


@dataclass(frozen=True)
class Mutation:
    """One fault: what is broken, where, the text before and after, and the tests that must fail under it."""

    name: str
    file: str
    old: str
    new: str
    tests: tuple[str, ...]


def read_mutations(root: Path) -> list[Mutation]:
    """All mutations of the repository `root`, in order. Raises `MutationError` for an entry that is not well formed."""
    path = root / "tests" / "mutations.toml"
    mutations = list(read_file(path)) if path.exists() else []
    names = [mutation.name for mutation in mutations]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise MutationError(f"two mutations have the same name: {', '.join(twice)}")
    return mutations


def read_file(path: Path) -> Iterator[Mutation]:
    """The mutations of one file."""
    try:
        entries = tomllib.loads(path.read_text(encoding="utf-8"))["mutation"]
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, KeyError) as error:
        raise MutationError(f"{path.name} is no list of [[mutation]] entries: {error}") from error
    wanted = {field.name for field in fields(Mutation)}
    for number, entry in enumerate(entries, start=1):
        if set(entry) != wanted:
            raise MutationError(
                f"{path.name}, mutation {number}: wanted the keys {sorted(wanted)}; got {sorted(entry)}"
            )
        tests = entry["tests"]
        texts = [value for key, value in entry.items() if key != "tests"]
        if not isinstance(tests, list) or not tests or not all(isinstance(value, str) for value in [*texts, *tests]):
            raise MutationError(f"{path.name}, mutation {number}: tests is a list of texts, not empty; the rest texts")
        yield Mutation(**(entry | {"tests": tuple(tests)}))


def misfit(mutation: Mutation, root: Path) -> str | None:
    """Why a mutation cannot be applied to the repository `root`, or None: it can."""
    path = root / mutation.file
    if not path.is_file():
        return f"there is no file {mutation.file}"
    if mutation.file.startswith("tests/"):
        return f"{mutation.file} is a test; break what it tests"
    text = path.read_text(encoding="utf-8")
    count = text.count(mutation.old)
    if count != 1:
        return f"its old text stands {count} times in {mutation.file}, not once"
    if mutation.new == mutation.old:
        return "its new text is its old text"
    if path.suffix == ".py":
        try:
            compile(mutate(mutation, text), mutation.file, "exec")
        except SyntaxError as error:
            return f"{mutation.file} would be no Python any more: {error}"
    return next((why for test in mutation.tests if (why := missing_test(test, root))), None)


def missing_test(test: str, root: Path) -> str | None:
    """Why `test` ("tests/test_a.py", or that with "::test_name[case]") cannot be run, or None."""
    file, *names = test.split("::")
    if not (root / file).exists():
        return f"there is no test {file}"
    text = (root / file).read_text(encoding="utf-8") if names else ""
    for name in names:
        if not re.search(rf"\b(def|class) {re.escape(name.split('[')[0])}\b", text):
            return f"{file} has no {name}"
    return None


def mutate(mutation: Mutation, text: str) -> str:
    """The text of a file with its fault."""
    return text.replace(mutation.old, mutation.new)


def run(root: Path, names: list[str]) -> int:
    """Tries the mutations whose name contains one of `names` (none: all), prints what became of each; 0 if all died."""
    mutations = choose(read_mutations(root), names)
    misfits = {mutation.name: why for mutation in mutations if (why := misfit(mutation, root))}
    for name, why in misfits.items():
        print(f"DOES NOT APPLY  {name}: {why}", flush=True)
    fitting = [mutation for mutation in mutations if mutation.name not in misfits]
    with scratch_copies(root, min(suite.processors(), max(len(fitting), 1))) as copies:
        broken = baseline(fitting, copies)
        if broken:
            print(f"\nThe tests of the mutations fail on the unbroken code:\n{broken}", flush=True)
            return 1
        verdicts = spread(fitting, copies, try_out, lambda m, verdict: print(f"{verdict:<14}  {m.name}", flush=True))
    killed = sum(verdict == "killed" for verdict in verdicts)
    survived = [mutation for mutation, verdict in zip(fitting, verdicts, strict=True) if verdict == "SURVIVED"]
    for mutation in survived:
        print(f"\nSURVIVED: {mutation.name} ({mutation.file}); not noticed by {', '.join(mutation.tests)}")
    others = len(mutations) - killed - len(survived)
    tail = f", {others} could not be tried" if others else ""
    print(f"\n{len(mutations)} mutations, {killed} killed, {len(survived)} survived{tail}", flush=True)
    return 0 if killed == len(mutations) else 1


def choose(mutations: list[Mutation], names: list[str]) -> list[Mutation]:
    """The mutations whose name contains one of `names`, whatever the case. Raises `ValueError` where one fits none."""
    for name in names:
        if not any(name.lower() in mutation.name.lower() for mutation in mutations):
            raise ValueError(f"no mutation has {name!r} in its name; see tests/mutations.toml")
    if not mutations:
        raise ValueError("there are no mutations: tests/mutations.toml is missing or empty")
    return [m for m in mutations if not names or any(name.lower() in m.name.lower() for name in names)]


@contextlib.contextmanager
def scratch_copies(root: Path, count: int) -> Iterator[list[Path]]:
    """`count` copies of the repository; each is checked to be what Python imports when it stands there."""
    with scratch_folder() as folder:
        copies = [folder.resolve() / str(number) / "course" for number in range(count)]
        for copy in copies:
            shutil.copytree(root, copy, ignore=lambda folder, names: not_copied(Path(folder) == root, names))
            if (root.parent / "shared").is_dir():  # recordings beside the repository
                (copy.parent / "shared").symlink_to(root.parent / "shared")
            suite.write_offline_startup(copy.parent / "home")
            where = "import course_lib; print(course_lib.__file__)"
            done = subprocess.run(
                [sys.executable, "-c", where], cwd=copy, env=copy_environment(copy), capture_output=True, text=True
            )
            if not done.stdout.startswith(str(copy)):
                raise MutationError(f"Python imports {done.stdout.strip() or done.stderr} instead of the copy {copy}")
        yield copies


def not_copied(first_level: bool, names: list[str]) -> list[str]:
    """Which of the `names` in a folder a scratch copy does without; data/*/results, of the same name, is data."""
    return [name for name in names if name == "__pycache__" or (first_level and name in NOT_COPIED)]


def copy_environment(copy: Path) -> dict[str, str]:
    """Environment variables of a test run in a copy: the copy's modules come first."""
    environment = suite.suite_environment(copy.parent / "home")
    rest = environment.get("PYTHONPATH")
    # Bytecode is trusted by the second and the size of its source; a mutation may keep both. So each process compiles.
    return environment | {
        "PYTHONPATH": os.pathsep.join([str(copy), *([rest] if rest else [])]),
        "PYTHONDONTWRITEBYTECODE": "1",
    }


def baseline(mutations: list[Mutation], copies: list[Path]) -> str:
    """What the tests of these mutations say on the unbroken code; empty if all pass."""
    tests = sorted({test for mutation in mutations for test in mutation.tests})
    shares = [share for number in range(len(copies)) if (share := tests[number :: len(copies)])]
    outputs = spread(shares, copies, lambda share, copy: run_tests(share, copy), lambda share, result: None)
    return "\n".join(output for code, output in outputs if code != PASSED)


def try_out(mutation: Mutation, copy: Path) -> str:
    """What became of a mutation in `copy`, which is left as it was: "killed", "SURVIVED" or pytest's exit code."""
    path = copy / mutation.file
    original = path.read_bytes()
    path.write_text(mutate(mutation, original.decode("utf-8")), encoding="utf-8", newline="")
    try:
        code, _ = run_tests(["-x", *mutation.tests], copy)
    finally:
        path.write_bytes(original)
    if code is None or code in (FAILED, INTERRUPTED, *CRASHES):
        return "killed"
    return "SURVIVED" if code == PASSED else f"EXIT CODE {code}"


def run_tests(words: list[str], copy: Path) -> tuple[int | None, str]:
    """pytest's exit code (None: it hung) and its last lines, run in `copy`."""
    command = [sys.executable, "-m", "pytest", "-q", "--tb=short", *NO_PLUGINS, *words]
    try:
        done = subprocess.run(
            command,
            cwd=copy,
            env=copy_environment(copy),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            timeout=suite.HANGS_S,
        )
    except subprocess.TimeoutExpired:
        return None, ""
    return done.returncode, done.stdout.decode("utf-8", "replace")[-6000:]


def spread(jobs: list, copies: list[Path], work, report) -> list:
    """`work(job, copy)` of every job, in order, one at a time in each copy; `report(job, result)` as each comes."""
    free: queue.Queue[Path] = queue.Queue()
    for copy in copies:
        free.put(copy)

    def take_one(job):
        copy = free.get()
        try:
            result = work(job, copy)
        finally:
            free.put(copy)
        report(job, result)
        return result

    with concurrent.futures.ThreadPoolExecutor(len(copies)) as pool:
        return list(pool.map(take_one, jobs))
