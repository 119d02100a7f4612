"""Measure the depth filter side by side with other renderers, in one run, and print one table.

The tools it is compared with (environment-bench.txt: Open3D with Embree) are installed by the first call into .bench, a
folder of their own. Times are of this machine at this hour; the ratios are what to compare. Other programs should rest.
"""

import argparse
import hashlib
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

from courseware.commands.arguments import require_output_folder
from courseware.run_folder import run_folder
from tools.bench_tables import bench_table, capacity_sentence, lessons_rows

ROOT = Path(__file__).resolve().parents[1]
LOCK = ROOT / "environment-bench.txt"
TOOLS = ROOT / ".bench"
STAMP = "course-bench.txt"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `bench`."""
    add = parser.add_argument
    add("--quick", action="store_true", help="fewer repeats: a few minutes")
    add("--no-tools", action="store_true", help="install nothing: only tools that are there already")
    what = "measure on this recording, too, in six degrees of freedom: depth images, poses.txt and its map, map.ply"
    add("--recording", type=Path, metavar="FOLDER", help=what)
    what = "where bench.json goes (default: results/bench)"
    add("--out", type=Path, default=Path("results/bench"), metavar="FOLDER", help=what)
    add("--json", action="store_true", help="print one JSON object instead of the table")
    what = "instead: memory and processor time of a student in these lessons and projects (default: all)"
    add("--lessons", nargs="*", metavar="NN", help=what)
    what = "with --lessons: say how many students a server of this size carries (default: 16 4)"
    add("--server", nargs=2, type=float, default=(16.0, 4.0), metavar=("GIB", "PROCESSORS"), help=what)


def run(arguments: argparse.Namespace) -> int:
    """Measure what was asked for, and print it."""
    return run_tools(arguments) if arguments.lessons is None else run_lessons(arguments)


def run_tools(arguments: argparse.Namespace) -> int:
    """Install what is missing, measure in a process of its own, print and save."""
    require_output_folder(arguments.out)
    if arguments.recording and not (arguments.recording / "map.ply").is_file():
        raise ValueError(f"--recording {arguments.recording} holds no map.ply: see data/README.md for the format")
    why = None if arguments.no_tools else install_beside(LOCK, TOOLS)
    if why:
        print(f"The tools to compare with could not be installed, and are left out: {why}", file=sys.stderr)
    with run_folder(arguments.out, "bench") as out:
        words = ["--quick"] if arguments.quick else []
        words += ["--recording", str(arguments.recording.resolve())] if arguments.recording else []
        result = measured("measure", *words)
        print(json.dumps(result) if arguments.json else bench_table(result), flush=True)
        (out / "bench.json").write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    return 0


def run_lessons(arguments: argparse.Namespace) -> int:
    """Run lessons in kernels of their own, and print what they take; nothing is stored."""
    from tools import lesson_costs
    from tools.refresh import select

    if not all(size > 0 for size in arguments.server):
        raise ValueError(f"--server must be two positive numbers, GiB and processors; got {arguments.server}")
    result = lesson_costs.measure(select(arguments.lessons))
    table = [*lessons_rows(result), "", capacity_sentence(result, *arguments.server)]
    print(json.dumps(result) if arguments.json else "\n".join(table))
    return 0


def measured(program: str, *words: str) -> dict:
    """What a program of tools/benchmarks finds, in a process of its own. Raises `RuntimeError` if it fails."""
    command = [sys.executable, "-P", "-m", f"tools.benchmarks.{program}", *words]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(ROOT), str(TOOLS)])}
    if sys.platform.startswith("linux"):
        environment["VTK_DEFAULT_OPENGL_WINDOW"] = "vtkEGLRenderWindow"
    done = subprocess.run(command, env=environment, stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"the measurement ended with code {done.returncode}; what it said stands above")
    return json.loads(done.stdout.splitlines()[-1])


def install_beside(lock: Path, folder: Path) -> str | None:
    """Bring a folder beside the environment to what `lock` says; None, or why it could not be done."""
    wanted = hashlib.sha256(lock.read_bytes()).hexdigest()
    stamp = folder / STAMP
    if stamp.is_file() and stamp.read_text(encoding="utf-8") == wanted:
        return None
    if folder.exists() and any(folder.iterdir()) and not stamp.is_file():
        return f"{folder} was not made by this command; move it away"
    print(f"Installing what {lock.name} names into {folder.name}, a minute or two ...", file=sys.stderr)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    stamp.write_text("unfinished", encoding="utf-8")
    pip = [sys.executable, "-P", "-m", "pip", "install", "--quiet", "--no-deps", "--disable-pip-version-check"]
    command = [*pip, "--target", str(folder), "-r", str(lock)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        lines = [line for line in done.stderr.splitlines() if line.startswith("ERROR")] or done.stderr.splitlines()
        return " / ".join(lines[-2:]) or f"pip ended with code {done.returncode}"
    stamp.write_text(wanted, encoding="utf-8")
    return None


if __name__ == "__main__":
    from courseware.cli import tool

    sys.exit(tool("tools.bench"))
