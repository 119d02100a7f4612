"""Measure the depth filter side by side with other renderers, in one run, and print one table.

The tools it is compared with (environment-bench.txt: Open3D with Embree) are installed by the first call into .bench, a
folder of their own. Times are of this machine at this hour; the ratios are what to compare. Other programs should rest.
`--lessons` measures something else instead: what a student's kernel costs in each lesson (lesson_costs.py); `--renders`
memory over very many renders, and whether the same pose gives the same image each time (bench_renders.py).
"""

from __future__ import annotations

import argparse
import hashlib
import itertools
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

from course_lib.child import python
from course_lib.child import run as run_child
from course_lib.commands.arguments import require_output_folder
from course_lib.files import run_folder

ROOT = Path(__file__).resolve().parents[1]
LOCK = ROOT / "environment-bench.txt"
TOOLS = ROOT / ".bench"
STAMP = "course-bench.txt"


class MeasurementError(RuntimeError):
    """The measurement's own process failed."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declares the options of `bench`."""
    parser.add_argument("--quick", action="store_true", help="fewer repeats and no figure: a few minutes")
    parser.add_argument("--no-tools", action="store_true", help="install nothing: only tools that are there already")
    parser.add_argument(
        "--recording",
        type=Path,
        metavar="FOLDER",
        help="measure on this recording, too, in six degrees of freedom: depth images, poses.txt and its map, map.ply",
    )
    parser.add_argument(
        "--out",
        type=Path,
        default=Path("results/bench"),
        metavar="FOLDER",
        help="where bench.json and bench.png go (default: results/bench)",
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of the table")
    parser.add_argument(
        "--lessons",
        nargs="*",
        metavar="NN",
        help="instead: memory and processor time of a student in these lessons and projects (default: all)",
    )
    parser.add_argument(
        "--server",
        nargs=2,
        type=float,
        default=(16.0, 4.0),
        metavar=("GIB", "PROCESSORS"),
        help="with --lessons: say how many students a server of this size carries (default: 16 4)",
    )
    parser.add_argument(
        "--renders",
        type=int,
        metavar="N",
        help="instead: memory over N renders of each backend, and whether images stay the same to the last bit",
    )
    parser.add_argument(
        "--renderers",
        type=int,
        default=300,
        metavar="N",
        help="with --renders: and over N new renderers (default: 300)",
    )
    parser.add_argument(
        "--backends",
        nargs="+",
        choices=["raster", "vtk", "ray"],
        default=["raster", "vtk", "ray"],
        help="with --renders: of these backends alone",
    )


def run(arguments: argparse.Namespace) -> int:
    """Measures what was asked for, and prints it."""
    if arguments.renders is not None:
        return run_renders(arguments)
    return run_tools(arguments) if arguments.lessons is None else run_lessons(arguments)


def run_renders(arguments: argparse.Namespace) -> int:
    """Renders very often, and prints what became of memory and of the images; nothing is stored."""
    from tools import bench_renders

    told = bench_renders.measure(
        ROOT / "tools/benchmarks" / "renders.py",
        tools_environment(),
        arguments.backends,
        arguments.renders,
        arguments.renderers,
    )
    if arguments.json:
        print(json.dumps(dict(told)))
        return 0
    first = next(told)  # what cannot be measured is said before any heading
    print(bench_renders.heading())
    for backend, row in itertools.chain([first], told):
        print(bench_renders.rows(backend, row), flush=True)
    return 0


def run_lessons(arguments: argparse.Namespace) -> int:
    """Runs lessons in kernels of their own, and prints what they take; nothing is stored."""
    from course_lib.commands import lesson_costs, lesson_costs_table
    from tools.refresh import select

    if not all(size > 0 for size in arguments.server):
        raise ValueError(f"--server must be two positive numbers, GiB and processors; got {arguments.server}")
    result = lesson_costs.measure(
        select(arguments.lessons),
        lambda cost: print(f"{cost.name}: {cost.peak_mb:.0f} MB, {cost.processor_s:.0f} s", file=sys.stderr),
    )
    print(json.dumps(result) if arguments.json else lesson_costs_table.text(result, *arguments.server))
    return 0


def run_tools(arguments: argparse.Namespace) -> int:
    """Installs what is missing, measures in a process of its own, prints and saves."""
    require_output_folder(arguments.out)
    if arguments.recording and not (arguments.recording / "map.ply").is_file():
        raise ValueError(f"--recording {arguments.recording} holds no map.ply: see data/README.md for the format")
    if not arguments.no_tools:
        why = install_tools()
        if why:
            print(f"The tools to compare with could not be installed, and are left out: {why}", file=sys.stderr)
    with run_folder(arguments.out, "bench") as out:
        return measure(arguments, out)


def measure(arguments: argparse.Namespace, out: Path) -> int:
    """Measures in a process of its own, prints, then saves into `out`; returns the exit code."""
    from tools.bench_table import table

    words = ["--quick"] if arguments.quick else ["--figure", str(out / "bench.png")]
    words += ["--recording", str(arguments.recording.resolve())] if arguments.recording else []
    done = run_child(
        python(ROOT / "tools/benchmarks" / "measure.py", *words),
        tools_environment(),
        stdout=subprocess.PIPE,
        text=True,
    )
    if done.returncode:
        raise MeasurementError(f"the measurement ended with code {done.returncode}; what it said stands above")
    result = json.loads(done.stdout.splitlines()[-1])
    print(json.dumps(result) if arguments.json else table(result), flush=True)
    (out / "bench.json").write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    return 0


def tools_environment() -> dict[str, str]:
    """What the environment of a process that finds tools/benchmarks/ and the tools in `.bench` has besides."""
    environment = {"PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "tools/benchmarks"), str(TOOLS)])}
    if sys.platform.startswith("linux"):
        environment["VTK_DEFAULT_OPENGL_WINDOW"] = "vtkEGLRenderWindow"
    return environment


def install_tools() -> str | None:
    """Brings `.bench` to what environment-bench.txt says; None, or why it could not be done."""
    wanted = hashlib.sha256(LOCK.read_bytes()).hexdigest()
    stamp = TOOLS / STAMP
    if stamp.is_file() and stamp.read_text(encoding="utf-8") == wanted:
        return None
    if TOOLS.exists() and any(TOOLS.iterdir()) and not stamp.is_file():
        return f"{TOOLS} was not made by this command; move it away"
    print("Installing the tools to compare with into .bench, a minute or two ...", file=sys.stderr)
    shutil.rmtree(TOOLS, ignore_errors=True)
    TOOLS.mkdir()
    stamp.write_text("unfinished", encoding="utf-8")
    pip = python("-m", "pip", "install", "--quiet", "--no-deps", "--disable-pip-version-check")
    done = run_child([*pip, "--target", str(TOOLS), "-r", str(LOCK)], capture_output=True, text=True)
    if done.returncode:
        lines = [line for line in done.stderr.splitlines() if line.startswith("ERROR")] or done.stderr.splitlines()
        return " / ".join(lines[-2:]) or f"pip ended with code {done.returncode}"
    stamp.write_text(wanted, encoding="utf-8")
    return None


if __name__ == "__main__":
    from course_lib.cli import tool

    sys.exit(tool("tools.bench"))
