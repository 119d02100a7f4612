"""Grade a folder of submissions: points and hints as CSV and as a page; students' code runs in a sandbox."""

from __future__ import annotations

import argparse
import secrets
import sys
import time
from pathlib import Path

from course_lib.commands.arguments import require_output_folder, require_positive, require_processes, require_seed
from course_lib.commands.output import progress_bar
from course_lib.files import run_folder

TABLE, TOTALS, PAGE = "answers.csv", "totals.csv", "grades.html"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add(
        "folder",
        type=Path,
        metavar="FOLDER",
        help="what the students handed in: FOLDER/alice/06_....ipynb or FOLDER/alice_06.ipynb, notebooks or .py files",
    )
    add("--out", type=Path, metavar="DIR", help="where the results go (default: FOLDER with -grades after its name)")
    add(
        "--seed",
        type=int,
        help="draws the hidden inputs; keep it to yourself (default: a new one, which the page tells: with it the "
        "results come again)",
    )
    add("--jobs", type=int, metavar="N", help="answers at a time (default: one a processor)")
    add("--seconds", type=float, default=60.0, metavar="S", help="all calls of one answer (default: %(default)g)")
    add("--call-seconds", type=float, default=20.0, metavar="S", help="one call of an answer (default: %(default)g)")
    add("--memory", type=int, default=1000, metavar="MB", help="memory of one answer (default: %(default)d)")
    add("--scores", action="store_true", help="also run the projects' last functions: minutes for each submission")
    add(
        "--trusted",
        action="store_true",
        help="grade although this machine cannot keep strangers' code in: only where you trust every file",
    )


def run(arguments: argparse.Namespace) -> int:
    if sys.platform == "win32":
        raise RuntimeError("grading needs Linux; on Windows use the Windows Subsystem for Linux (WSL 2)")
    from joblib import cpu_count

    # Only here: they bring the lessons with them.
    from course_lib.classroom.confinement import Limits
    from course_lib.classroom.grade_page import grade_page
    from course_lib.classroom.grade_tables import answers_table, totals_table
    from course_lib.classroom.grading import grade_folder

    out = results_folder(arguments.folder, arguments.out)
    require_processes("--jobs", arguments.jobs)
    require_positive("--seconds", arguments.seconds, "seconds")
    require_positive("--memory", arguments.memory, "MB")
    seed = secrets.randbelow(2**48) if arguments.seed is None else arguments.seed
    require_seed(seed)
    require_output_folder(out)
    limits = Limits(arguments.call_seconds, arguments.seconds, arguments.memory)
    started = time.monotonic()
    jobs, trusted, scores = arguments.jobs or cpu_count(), arguments.trusted, arguments.scores
    bar = progress_bar("grading", "answer")
    results = grade_folder(arguments.folder, seed, jobs, limits, trusted, scores, bar)
    pages = {TABLE: answers_table(results), TOTALS: totals_table(results), PAGE: grade_page(results)}
    print(summary(results, time.monotonic() - started), flush=True)  # before the disk can be full
    with run_folder(out, "grade") as new:  # the table and the page are of one grading
        for name, text in pages.items():
            (new / name).write_bytes(text.encode("utf-8"))
    print("\n".join(f"{out / name}" for name in pages))
    return 0


def results_folder(folder: Path, out: Path | None) -> Path:
    """Where the results go. Raises `ValueError` for a place among the submissions."""
    found = Path(out) if out is not None else folder.resolve().with_name(f"{folder.resolve().name}-grades")
    if found.resolve().is_relative_to(folder.resolve()):
        raise ValueError(f"--out {found} lies among the submissions: results would be handed back as somebody's work")
    return found


def summary(results, seconds: float) -> str:
    """What the terminal says: how many, what was refused and not read, how long, and with which seed."""
    statuses = [one.status for one in results.graded]
    counts = ", ".join(f"{statuses.count(status)} {status}" for status in dict.fromkeys(sorted(statuses))) or "none"
    students = {one.student for one in results.graded}
    lines = [f"{len(students)} students, {len(statuses)} answers: {counts}; {seconds:.0f} s"]
    tried = [(one.student, one.number, what) for one in results.graded for what in one.refused]
    lines += [f"refused: {student}, {number}: tried to {what}" for student, number, what in tried[:20]]
    lines += [f"and {len(tried) - 20} more, on the page"] if len(tried) > 20 else []
    lines += [f"not read: {one.name}: {one.why}" for one in results.collection.not_read[:20]]
    held = "all walls about strangers' code held" if not results.missing else "--trusted, without: "
    lines.append(f"{held}{'; '.join(results.missing)}. Seed: {results.seed}")
    peak = max((one.peak_mb for one in results.graded), default=0.0)
    lines.append(f"memory of the largest answer's process: {peak:.0f} MB")
    return "\n".join(lines)
