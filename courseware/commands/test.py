"""Run the tests: those of tests/ and every lesson, as a strict nbval test of its stored outputs.

Other arguments go on to pytest: `course.py test tests/test_geometry.py -k wrap`. Paths among them choose what runs, in
this one process; without a path everything does, on every processor.
"""

import argparse
import os
import subprocess
import sys
import time
from collections.abc import Mapping
from pathlib import Path

from joblib import cpu_count

from course_lib.files import temporary_folder
from courseware.paths import REPOSITORY

PASSES_ARGUMENTS_ON = True

NO_TESTS = 5  # pytest's exit code when it found no test: an empty run proves nothing
HANGS_S = 1800  # only what hangs takes so long
LESSON_TESTS = ("tests/lessons", "tests/notebooks")  # a quick run leaves them out with the lessons

# Runs in the kernel before the first cell: a lesson that reaches for the network fails here, not at a student's.
OFFLINE_STARTUP = """
def _stay_on_this_computer():
    import socket
    connect = socket.socket.connect
    def connect_here_only(self, address):
        if self.family != getattr(socket, "AF_UNIX", None) and address[0] not in ("127.0.0.1", "::1", "localhost"):
            raise OSError(f"lessons run offline: no connection to {address[0]}")
        return connect(self, address)
    socket.socket.connect = connect_here_only
_stay_on_this_computer()
del _stay_on_this_computer
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--all", action="store_true", help="also what is marked release, for a new version")
    told = "no lessons nor their tests, no browser, nothing marked slow"
    parser.add_argument("--fast", action="store_true", help=told)


def run(arguments: argparse.Namespace) -> int:
    started = time.monotonic()
    with temporary_folder() as home:
        words = pytest_arguments(arguments, cpu_count())
        environment = suite_environment(home)
        code = subprocess.run([sys.executable, "-m", "pytest", *words], cwd=REPOSITORY, env=environment).returncode
    said = {0: "all tests passed.", NO_TESTS: "FAILED, because no test was found."}
    failed = f"FAILED (pytest's exit code {code}); not all tests passed."
    print(f"\n=== {time.monotonic() - started:.0f} s; {said.get(code, failed)}", flush=True)
    return code


def pytest_arguments(asked: argparse.Namespace, n_workers: int) -> list[str]:
    """Return pytest's arguments: what runs, how lessons are compared, and on how many processors."""
    paths = [word for word in asked.passed_on if names_tests(word)]
    words = [] if paths else ["tests"] if asked.fast else ["notebooks", "tests"]
    if any(path.startswith("notebooks") or ".ipynb" in path for path in paths or words):
        words += nbval_options()
    else:
        words += ["-p", "no:nbval"]  # whose import alone takes seconds
    left_out = [] if asked.all else ["release"]
    if asked.fast:
        left_out += ["browser", "slow"]
        words += [f"--ignore={folder}" for folder in LESSON_TESTS]
    if left_out:
        words += ["-m", " and ".join(f"not {mark}" for mark in left_out)]
    if not paths and n_workers > 1:
        # A file stays on one processor, with its kernel, window and fixtures, in the order of tests/conftest.py.
        words += ["-n", str(n_workers), "--dist", "loadfile", "--no-loadscope-reorder"]
    return [*words, *asked.passed_on]


def names_tests(word: str) -> bool:
    """Return whether an argument for pytest is a path: a file of tests, a lesson, or a folder of them."""
    path = word.split("::")[0]
    return path.endswith((".py", ".ipynb")) or path.split("/")[0] in ("tests", "notebooks")


def nbval_options() -> list[str]:
    """Strict comparison of stored outputs, with this environment's kernel; a plugin knows the cells' tolerances."""
    options = ["--nbval", "--nbval-current-env", "-p", "courseware.commands.nbval_tolerance"]
    options += [f"--nbval-cell-timeout={HANGS_S}", f"--nbval-kernel-startup-timeout={HANGS_S}"]
    return [*options, "--nbval-sanitize-with", str(REPOSITORY / "tests" / "nbval_sanitize.cfg")]


def suite_environment(home: Path, environment: Mapping[str, str] = os.environ) -> dict[str, str]:
    """Return the variables of a run: no display, no network in lessons, none of the user's own Jupyter settings."""
    startup = home / "ipython" / "profile_default" / "startup" / "00-offline.py"
    startup.parent.mkdir(parents=True)
    startup.write_text(OFFLINE_STARTUP, encoding="utf-8")
    dropped = ("DISPLAY", "WAYLAND_DISPLAY", "MPLBACKEND", "JUPYTER_PATH", "JUPYTER_CONFIG_PATH")
    result = {key: value for key, value in environment.items() if key not in dropped}
    if sys.platform.startswith("linux"):
        result["VTK_DEFAULT_OPENGL_WINDOW"] = "vtkEGLRenderWindow"
    result["PYVISTA_OFF_SCREEN"] = "true"
    # Tests run on every processor already: threads of linear algebra would wait for each other.
    result |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    folders = {"CONFIG_DIR": "config", "DATA_DIR": "data", "RUNTIME_DIR": "runtime"}
    result |= {f"JUPYTER_{name}": str(home / folder) for name, folder in folders.items()}
    return result | {"IPYTHONDIR": str(home / "ipython")}
