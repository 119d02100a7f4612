"""Run every test: those of tests/ and then every lesson, as a strict nbval test of its stored outputs.

Arguments that are not listed here go on to pytest: `course.py test tests/test_geometry.py -k wrap`. Paths among them
choose what runs; without a path everything does.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PASSES_ARGUMENTS_ON = True

# pytest's exit code when it found no test: an empty run proves nothing, so it counts as a failure.
NO_TESTS = 5

# pytest's options whose value is the next word, which may have the look of a path: `-k data`.
OPTIONS_WITH_VALUE = (
    "-k",
    "-m",
    "-p",
    "-c",
    "-o",
    "-W",
    "--deselect",
    "--ignore",
    "--rootdir",
    "--durations",
    "--junitxml",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    only = parser.add_mutually_exclusive_group()
    only.add_argument("--no-notebooks", action="store_true", help="only tests/")
    only.add_argument("--only-notebooks", action="store_true", help="only the lessons")


def run(arguments: argparse.Namespace) -> int:
    parts = choose_parts(arguments.passed_on, arguments.no_notebooks, arguments.only_notebooks)
    # A -k that fits only one of the two parts leaves the other one without tests; that is meant.
    chosen = bool(arguments.passed_on)
    started = time.monotonic()
    codes = {}
    with tempfile.TemporaryDirectory(prefix="course-test-") as home:
        for name, pytest_arguments in parts.items():
            print(f"\n=== {name}", flush=True)
            runs = [pytest_arguments] if chosen or name != "notebooks" else in_two_halves(pytest_arguments)
            codes[name] = run_side_by_side(runs, part_environment(name, Path(home)))
    return conclude(codes, chosen, time.monotonic() - started)


def choose_parts(
    passed_on: list[str], no_notebooks: bool = False, only_notebooks: bool = False
) -> dict[str, list[str]]:
    """pytest's arguments for each part that runs: "tests" and "notebooks"; paths in `passed_on` decide which."""
    is_path = [
        looks_like_a_path(word) and (index == 0 or passed_on[index - 1] not in OPTIONS_WITH_VALUE)
        for index, word in enumerate(passed_on)
    ]
    paths = [word for word, chosen in zip(passed_on, is_path, strict=True) if chosen]
    options = [word for word, chosen in zip(passed_on, is_path, strict=True) if not chosen]
    is_notebook = {
        word: word.split("::")[0].endswith(".ipynb") or (ROOT / word) == ROOT / "notebooks" for word in paths
    }
    tests = [word for word in paths if not is_notebook[word]] if paths else ["tests"]
    notebooks = [word for word in paths if is_notebook[word]] if paths else ["notebooks"]
    parts = {}
    if tests and not only_notebooks:
        parts["tests"] = [*options, *tests]
    if notebooks and not no_notebooks:
        parts["notebooks"] = [*nbval_options(), *options, *notebooks]
    return parts


def in_two_halves(pytest_arguments: list[str], processors: int | None = os.cpu_count()) -> list[list[str]]:
    """The arguments of all lessons as two lists of every other lesson: a kernel keeps one processor busy, not two.

    With one processor, or a lesson alone, they stay one run.
    """
    lessons = sorted((ROOT / "notebooks").glob("*.ipynb"))
    if (processors or 1) < 2 or len(lessons) < 2:
        return [pytest_arguments]
    options = pytest_arguments[:-1]
    return [[*options, *(str(path.relative_to(ROOT)) for path in lessons[half::2])] for half in (0, 1)]


def run_side_by_side(runs: list[list[str]], environment: dict[str, str]) -> int:
    """Runs pytest once for each list of arguments, all at once; the first exit code that is not 0, or 0.

    The first run prints as it goes; what the others print follows when it has ended, so that lines do not mix.
    """
    commands = [[sys.executable, "-m", "pytest", *arguments] for arguments in runs]
    with contextlib.ExitStack() as stack:
        others = []
        for command in commands[1:]:
            printed = stack.enter_context(tempfile.TemporaryFile("w+"))
            process = subprocess.Popen(command, cwd=ROOT, env=environment, stdout=printed, stderr=subprocess.STDOUT)
            stack.callback(process.kill)
            others.append((process, printed))
        codes = [subprocess.run(commands[0], cwd=ROOT, env=environment).returncode]
        for process, printed in others:
            codes.append(process.wait())
            printed.seek(0)
            print(printed.read(), flush=True)
    return next((code for code in codes if code != 0), 0)


def looks_like_a_path(word: str) -> bool:
    """Whether an argument has the look of tests to run."""
    path = word.split("::")[0]
    return not word.startswith("-") and (path.endswith((".py", ".ipynb")) or (ROOT / path).exists())


def nbval_options() -> list[str]:
    """Strict comparison of stored outputs, with this environment's kernel; one file says what may differ."""
    sanitize = ROOT / "tests" / "nbval_sanitize.cfg"
    # No cell may take as long as a whole lesson may (60 s); nbval's own limit is 33 minutes.
    return ["--nbval", "--nbval-current-env", "--nbval-cell-timeout=60"] + (
        ["--nbval-sanitize-with", str(sanitize)] if sanitize.exists() else []
    )


def part_environment(name: str, home: Path, environment: Mapping[str, str] = os.environ) -> dict[str, str]:
    """Environment variables of one part: no display, off-screen OpenGL, and none of the user's own Jupyter settings."""
    result = {
        key: value for key, value in environment.items() if key not in ("DISPLAY", "WAYLAND_DISPLAY", "MPLBACKEND")
    }
    if sys.platform.startswith("linux"):
        result["VTK_DEFAULT_OPENGL_WINDOW"] = "vtkEGLRenderWindow"
    result["PYVISTA_OFF_SCREEN"] = "true"
    for variable, folder in (("JUPYTER_CONFIG_DIR", "config"), ("JUPYTER_DATA_DIR", "data"), ("IPYTHONDIR", "ipython")):
        result[variable] = str(home / folder)
    result["JUPYTER_RUNTIME_DIR"] = str(home / "runtime")
    if name == "tests":  # in a notebook the kernel chooses its own
        result["MPLBACKEND"] = "Agg"
    return result


def conclude(codes: dict[str, int], chosen: bool, seconds: float) -> int:
    """Prints the closing line and returns the exit code: 0 only if tests ran and none failed.

    codes: pytest's exit code of each part. chosen: whether the user chose tests, so that one part may be empty.
    """
    failures = {name: code for name, code in codes.items() if code not in (0, NO_TESTS)}
    empty = [name for name, code in codes.items() if code == NO_TESTS]
    allowed = chosen and any(code == 0 for code in codes.values())
    print(f"\n=== {seconds:.0f} s", end="; ")
    for name, code in failures.items():
        print(f"{name}: FAILED (pytest's exit code {code})", end="; ")
    if empty and not allowed:
        print(f"{' and '.join(empty)}: FAILED, because no test was found", end="; ")
    if not codes:
        print("FAILED, because nothing was chosen to run", end="; ")
    if failures or not codes or (empty and not allowed):
        print("not all tests passed.", flush=True)
        return next(iter(failures.values()), NO_TESTS)
    print("all tests passed.", flush=True)
    return 0
