"""Grade a folder of submissions: points and hints as CSV and as a page; students' code runs in a sandbox."""

import argparse
import secrets
import sys
import time
from pathlib import Path

from course_lib.commands import arguments as options
from course_lib.commands.output import progress_bar
from course_lib.files import run_folder


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    told = "what the students handed in: FOLDER/alice/06_....ipynb or FOLDER/alice_06.ipynb, notebooks or .py files"
    add("folder", type=Path, metavar="FOLDER", help=told)
    add("--out", type=Path, metavar="DIR", help="where the results go (default: FOLDER with -grades after its name)")
    told = (
        "draws the hidden inputs; keep it to yourself (default: a new one, which the page tells: with it the results "
    )
    add("--seed", type=int, help=told + "come again)")
    options.add_number(parser, "--jobs", "answers at a time (default: one a processor)")
    add("--seconds", type=float, default=60.0, metavar="S", help="all calls of one answer (default: %(default)g)")
    add("--call-seconds", type=float, default=20.0, metavar="S", help="one call of an answer (default: %(default)g)")
    add("--memory", type=int, default=1000, metavar="MB", help="memory of one answer (default: %(default)d)")
    options.add_flag(parser, "--scores", "also run the projects' last functions: minutes for each submission")
    told = "grade although this machine cannot keep strangers' code in: only where you trust every file"
    options.add_flag(parser, "--trusted", told)


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
    options.require_processes("--jobs", arguments.jobs)
    options.require_positive("--seconds", arguments.seconds, "seconds")
    options.require_positive("--memory", arguments.memory, "MB")
    seed = secrets.randbelow(2**48) if arguments.seed is None else arguments.seed
    options.require_seed(seed)
    options.require_output_folder(out)
    limits = Limits(arguments.call_seconds, arguments.seconds, arguments.memory)
    started, jobs, bar = time.monotonic(), arguments.jobs or cpu_count(), progress_bar("grading", "answer")
    results = grade_folder(arguments.folder, seed, jobs, limits, arguments.trusted, arguments.scores, bar)
    pages = {
        "answers.csv": answers_table(results),
        "totals.csv": totals_table(results),
        "grades.html": grade_page(results),
    }
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
    counts = ", ".join(f"{statuses.count(status)} {status}" for status in sorted(set(statuses))) or "none"
    students = {one.student for one in results.graded}
    lines = [f"{len(students)} students, {len(statuses)} answers: {counts}; {seconds:.0f} s"]
    tried = [(one.student, one.number, what) for one in results.graded for what in one.refused]
    lines += [f"refused: {student}, {number}: tried to {what}" for student, number, what in tried[:20]]
    lines += [f"and {len(tried) - 20} more, on the page"] if len(tried) > 20 else []
    lines += [f"not read: {one.name}: {one.why}" for one in results.collection.not_read[:20]]
    held = "all walls about strangers' code held" if not results.missing else "--trusted, without: "
    peak = max((one.peak_mb for one in results.graded), default=0.0)
    lines += [f"{held}{'; '.join(results.missing)}. Seed: {results.seed}"]
    return "\n".join([*lines, f"memory of the largest answer's process: {peak:.0f} MB"])
