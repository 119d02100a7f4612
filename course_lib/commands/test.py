"""Run every test: those of tests/ and every lesson, as a strict nbval test of its stored outputs.

Arguments that are not listed here go on to pytest: `course.py test tests/test_geometry.py -k wrap`. Paths among them
choose what runs, in this one process; without a path everything does, on every processor.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import time
from collections.abc import Mapping
from pathlib import Path

from course_lib.child import JUPYTER
from course_lib.files import temporary_folder
from course_lib.processors import processors

ROOT = Path(__file__).resolve().parents[2]
PASSES_ARGUMENTS_ON = True

# pytest's exit code when it found no test: an empty run proves nothing, so it counts as a failure.
NO_TESTS = 5
# Only what hangs takes so long: no test may fail because the machine has other work to do.
HANGS_S = 1800

# Tests of what only the notebooks use; a quick run leaves them out with the lessons.
LESSON_TESTS = ("tests/lessons", "tests/notebooks")

# pytest's options whose value is the next word, which may have the look of a path: `-k data`.
OPTIONS_WITH_VALUE = (
    "-k",
    "-m",
    "-n",
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
    only.add_argument("--fast", action="store_true", help="no lessons nor their tests, no browser, nothing marked slow")
    only.add_argument("--no-notebooks", action="store_true", help="only tests/")
    only.add_argument("--only-notebooks", action="store_true", help="only the lessons")


def run(arguments: argparse.Namespace) -> int:
    started = time.monotonic()
    with temporary_folder() as home:
        words = pytest_arguments(
            arguments.passed_on, arguments.fast, arguments.no_notebooks, arguments.only_notebooks, processors()
        )
        write_offline_startup(home)
        environment = suite_environment(home) | one_thread_a_worker(words)
        code = subprocess.run([sys.executable, "-m", "pytest", *words], cwd=ROOT, env=environment).returncode
    return conclude(code, time.monotonic() - started)


def pytest_arguments(
    passed_on: list[str],
    fast: bool = False,
    no_notebooks: bool = False,
    only_notebooks: bool = False,
    workers: int = 1,
) -> list[str]:
    """pytest's arguments: what runs, how lessons are compared, and on how many processors.

    Raises `ValueError` where the lessons are wanted and there are none.
    """
    paths = chosen_paths(passed_on)
    words = [] if paths else default_paths(fast, no_notebooks, only_notebooks)
    if any(is_notebook(path) for path in paths or words):
        words += nbval_options()
    else:
        words += ["-p", "no:nbval"]  # whose import alone takes seconds
    if fast:
        words += ["-m", "not browser and not slow", *(f"--ignore={folder}" for folder in LESSON_TESTS)]
    if not paths and workers > 1:
        # A file stays on one processor, with its kernel, window and fixtures, in the order of tests/conftest.py.
        words += ["-n", str(workers), "--dist", "loadfile", "--no-loadscope-reorder"]
    return [*words, *passed_on]


def default_paths(fast: bool, no_notebooks: bool, only_notebooks: bool) -> list[str]:
    """What runs where no path is given."""
    if fast or no_notebooks:
        return ["tests"]
    if not any((ROOT / "notebooks").glob("*.ipynb")):
        raise ValueError(f"no lesson was found in {ROOT / 'notebooks'}: without them a run proves nothing")
    return ["notebooks"] if only_notebooks else ["notebooks", "tests"]


def chosen_paths(passed_on: list[str]) -> list[str]:
    """The words among pytest's arguments that name tests to run."""
    return [
        word
        for index, word in enumerate(passed_on)
        if looks_like_a_path(word) and (index == 0 or passed_on[index - 1] not in OPTIONS_WITH_VALUE)
    ]


def looks_like_a_path(word: str) -> bool:
    """Whether an argument has the look of tests to run."""
    path = word.split("::")[0]
    return not word.startswith("-") and (path.endswith((".py", ".ipynb")) or (ROOT / path).exists())


def is_notebook(path: str) -> bool:
    """Whether a path names a lesson or their folder."""
    return path.split("::")[0].endswith(".ipynb") or (ROOT / path) == ROOT / "notebooks"


def nbval_options() -> list[str]:
    """Strict comparison of stored outputs, with this environment's kernel; one file says what may differ everywhere, a
    plugin compares numbers with the tolerance that their cell declares."""
    options = ["--nbval", "--nbval-current-env", "-p", "course_lib.commands.nbval_tolerance"]
    options += [f"--nbval-cell-timeout={HANGS_S}", f"--nbval-kernel-startup-timeout={HANGS_S}"]
    sanitize = ROOT / "tests" / "nbval_sanitize.cfg"
    return options + (["--nbval-sanitize-with", str(sanitize)] if sanitize.exists() else [])


def write_offline_startup(home: Path) -> None:
    """Lets every kernel whose settings lie in `home` fail where a lesson reaches for the network."""
    from tools.refresh import OFFLINE_STARTUP

    startup = home / "ipython" / "profile_default" / "startup" / "00-offline.py"
    startup.parent.mkdir(parents=True)
    startup.write_text(OFFLINE_STARTUP, encoding="utf-8")


def suite_environment(home: Path, environment: Mapping[str, str] = os.environ) -> dict[str, str]:
    """Environment variables of a run: no display, off-screen OpenGL, and none of the user's own Jupyter settings."""
    dropped = ("DISPLAY", "WAYLAND_DISPLAY", "MPLBACKEND", *JUPYTER)
    result = {key: value for key, value in environment.items() if key not in dropped}
    if sys.platform.startswith("linux"):
        result["VTK_DEFAULT_OPENGL_WINDOW"] = "vtkEGLRenderWindow"
    result["PYVISTA_OFF_SCREEN"] = "true"
    for variable, folder in (("JUPYTER_CONFIG_DIR", "config"), ("JUPYTER_DATA_DIR", "data"), ("IPYTHONDIR", "ipython")):
        result[variable] = str(home / folder)
    result["JUPYTER_RUNTIME_DIR"] = str(home / "runtime")
    return result


def one_thread_a_worker(words: list[str]) -> dict[str, str]:
    """Where pytest runs in several processes, linear algebra starts no threads that wait for each other besides."""
    return {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS")} if "-n" in words else {}


def conclude(code: int, seconds: float) -> int:
    """Prints the closing line for pytest's exit code and returns it: 0 only if tests ran and none failed."""
    said = {0: "all tests passed.", NO_TESTS: "FAILED, because no test was found."}
    failed = f"FAILED (pytest's exit code {code}); not all tests passed."
    print(f"\n=== {seconds:.0f} s; {said.get(code, failed)}", flush=True)
    return code
