"""Grade a folder of submissions in a sandbox: points, hints and the class as a page, feedback pages, CSV tables."""

import argparse
import json
import secrets
import time
from pathlib import Path

from courseware.commands import arguments as options
from courseware.commands.output import progress_bar


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    text = "what the students handed in: a folder for each student, files as alice_06.ipynb, or an LMS's download"
    add("folder", type=Path, metavar="FOLDER", help=text)
    text = "where the results go (default: FOLDER with -grades after its name); a second run looks only at what changed"
    add("--out", type=Path, metavar="DIR", help=text)
    text = "the class list, as your LMS exports it: who is missing, and its columns come back beside the points"
    add("--roster", type=Path, metavar="CSV", help=text)
    text = "what you set, such as 06 07 P1; the rest is not graded (default: what more than one student handed in)"
    add("--lessons", nargs="+", default=[], metavar="NN", help=text)
    text = "draws the hidden inputs; keep it to yourself (default: that of DIR, else a new one)"
    add("--seed", type=int, help=text)
    options.add_number(parser, "--jobs", "submissions at a time (default: one a processor)")
    text = (
        "all calls of one answer; one call has a third of it, a whole file four times that and a minute (default: 60)"
    )
    add("--seconds", type=float, default=60.0, metavar="S", help=text)
    add("--memory", type=int, default=1500, metavar="MB", help="memory of one submission (default: %(default)d)")
    options.add_flag(parser, "--scores", "also run the projects' last functions: minutes for each submission")
    text = "grade without walls, with your rights: only if you have read every file"
    options.add_flag(parser, "--trust", text)


def run(arguments: argparse.Namespace) -> int:
    from joblib import cpu_count

    # Only here: they bring the lessons with them.
    from courseware.classroom.grading import grade_folder, require_unseen
    from courseware.classroom.pages import write_results
    from courseware.classroom.sandbox import Limits
    from courseware.classroom.submissions import read_roster

    out = results_folder(arguments.folder, arguments.out)
    options.require_processes("--jobs", arguments.jobs)
    options.require_positive("--seconds", arguments.seconds, "seconds")
    options.require_positive("--memory", arguments.memory, "MB")
    if not arguments.trust:
        require_unseen(arguments.folder, out)
    seed = kept_seed(out, arguments.seed)
    options.require_seed(seed)
    roster = read_roster(arguments.roster) if arguments.roster else None
    limits = Limits(arguments.seconds / 3, arguments.seconds, arguments.memory)
    jobs, started = arguments.jobs or cpu_count(), time.monotonic()
    results = grade_folder(
        arguments.folder, out, seed, limits, jobs, arguments.trust, arguments.scores, roster, arguments.lessons,
        progress_bar("grading", "file"),
    )  # fmt: skip
    names = write_results(results, out)
    print(summary(results, time.monotonic() - started))
    print("\n".join(f"{out / name}" for name in names))
    return 0


def results_folder(folder: Path, out: Path | None) -> Path:
    """Return where the results go. Raises `ValueError` for a place among the submissions."""
    found = Path(out) if out is not None else folder.resolve().with_name(f"{folder.resolve().name}-grades")
    if found.resolve().is_relative_to(folder.resolve()):
        raise ValueError(f"--out {found} lies among the submissions: results would be handed back as somebody's work")
    return found


def kept_seed(out: Path, seed: int | None) -> int:
    """Return the seed that was given, else that of an earlier run in this folder, else a new one; keep it there."""
    path = out / "run.json"
    if seed is None and path.is_file():
        seed = json.loads(path.read_text(encoding="utf-8"))["seed"]
    seed = secrets.randbelow(2**48) if seed is None else seed
    out.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps({"command": "grade", "seed": seed}) + "\n", encoding="utf-8")
    return seed


def summary(results, seconds: float) -> str:
    """Return what the terminal says: how many, what was not read, how long, the walls, and the seed."""
    statuses = [a.status for one in results.entries for a in one.judged.answers]
    counts = ", ".join(f"{statuses.count(status)} {status}" for status in sorted(set(statuses))) or "none"
    handed_in = {one.student for one in results.entries}
    lines = [f"{len(handed_in)} students, {len(statuses)} answers: {counts}; {seconds:.0f} s"]
    lines += [f"not read: {one.name}: {one.why}" for one in results.not_read[:20]]
    if missing := results.missing:
        lines.append(f"nothing from {len(missing)} of the class: {', '.join(missing[:20])}")
    tried = f"{len(results.walls)} ways through the walls tried, all failed"
    return "\n".join([*lines, f"{tried if results.walls else 'WITHOUT WALLS (--trust)'}. Seed: {results.seed}"])
