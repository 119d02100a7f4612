"""Break the code in the ways of tools/faults.toml, one at a time, and tell which of them a test notices.

Each fault is made alone, in a copy of the tracked files; the tests named with it run there, once without the fault and
once with it. What survives is a hole in the tests: the exit code is 1 then.
"""

import argparse
import contextlib
import functools
import os
import shutil
import signal
import subprocess
import sys
import tomllib
from collections.abc import Iterator, Sequence
from pathlib import Path

from course_lib.files import temporary_folder

ROOT = Path(__file__).resolve().parents[1]
FAULTS = Path(__file__).with_suffix("").parent / "faults.toml"
HANGS_S = 600.0


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `mutants`."""
    parser.add_argument("names", nargs="*", metavar="NAME", help="parts of names of faults or files (default: all)")
    parser.add_argument("--list", action="store_true", help="only print the names")


def run(arguments: argparse.Namespace) -> int:
    """Try the faults; 1 where one survives."""
    faults = [one for one in read_faults() if not arguments.names or any(is_meant(one, n) for n in arguments.names)]
    if not faults:
        raise ValueError(f"no fault is called {', '.join(arguments.names)}; --list prints all names")
    if arguments.list:
        print("\n".join(f"{one['file']}: {one['name']}" for one in faults))
        return 0
    noticed = 0
    with copied_tree() as root:
        say = functools.cache(lambda tests: tests_say(root, tests, HANGS_S))
        for one in faults:
            outcome = say(tuple(one["tests"])).replace("killed", "fails as it is")
            if outcome == "survived":
                with broken(*edited(root, one)):
                    outcome = tests_say(root, one["tests"], HANGS_S)
                noticed += outcome != "survived"
            print(f"{outcome:8} {one['file']}: {one['name']}", flush=True)
    print(f"{noticed} of {len(faults)} noticed")
    return 1 if noticed < len(faults) else 0


def read_faults() -> list[dict]:
    """The faults of the list: name, file, old text, new text, and the tests that must notice it."""
    return tomllib.loads(FAULTS.read_text(encoding="utf-8"))["fault"]


def is_meant(fault: dict, name: str) -> bool:
    """Whether a name of the command line means a fault."""
    return name.lower() in fault["name"].lower() or name in fault["file"]


def edited(root: Path, fault: dict) -> tuple[Path, str]:
    """The file of a fault and its source with the fault in it; code that moved to another file is found there."""
    for paths in ([root / fault["file"]], sorted((root / "course_lib").rglob("*.py"))):
        sources = {path: path.read_text(encoding="utf-8") for path in paths if path.is_file()}
        holding = {path: source for path, source in sources.items() if fault["old"] in source}
        if len(holding) == 1:
            ((path, source),) = holding.items()
            if source.count(fault["old"]) == 1:
                return path, source.replace(fault["old"], fault["new"])
    raise ValueError(f"{fault['name']!r}: its old text must stand once in {fault['file']}, or in the library")


@contextlib.contextmanager
def copied_tree() -> Iterator[Path]:
    """Yield a folder with a copy of the tracked files."""
    tracked = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    with temporary_folder() as folder:
        for name in tracked.split("\0"):
            if name and (ROOT / name).is_file():
                (folder / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(ROOT / name, folder / name)
        yield folder


@contextlib.contextmanager
def broken(file: Path, source: str) -> Iterator[None]:
    """Put another source in the place of a file, and the file back at the end."""
    whole = file.read_bytes()
    file.write_text(source, encoding="utf-8")
    try:
        yield
    finally:
        file.write_bytes(whole)


def tests_say(root: Path, tests: Sequence[str | Path], seconds: float, *options: str) -> str:
    """What tests say of the code in `root`: "killed" (one fails), "survived", or "hung" after so many seconds."""
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", *options, *map(str, tests)]
    environment = os.environ | {"PYTHONPATH": str(root), "PYTHONDONTWRITEBYTECODE": "1"}
    silent = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    child = subprocess.Popen(command, cwd=root, env=environment, start_new_session=True, **silent)
    try:
        code = child.wait(timeout=seconds)
    except subprocess.TimeoutExpired:
        os.killpg(child.pid, signal.SIGKILL)
        child.wait()
        return "hung"
    return "survived" if code in (0, 5) else "killed"  # 5: no test was chosen


if __name__ == "__main__":
    from courseware.cli import tool

    sys.exit(tool("tools.mutants"))
