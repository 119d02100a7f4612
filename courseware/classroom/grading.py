"""Grade a folder: each submission in a process of its own, each result written as soon as it is there.

What was judged lies in OUT/judged/, a file for each submission, named by a digest of its content, the seed and the
limits. So a run that was ended goes on, and a second one looks only at what changed.
"""

import contextlib
import hashlib
import json
import multiprocessing
import os
import pickle
import re
import resource
import stat
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import asdict
from pathlib import Path

from course_lib.files import atomic_write, temporary_folder
from courseware.classroom.assignment_cells import function_names, read_assignments
from courseware.classroom.exchange import AnswerFormatError, one_line
from courseware.classroom.judge import Judged, Settings, from_json, judge
from courseware.classroom.results import Entry, Results, points_by_hand, what_counts
from courseware.classroom.sandbox import SYSTEM, Limits, Sandbox, SandboxError, copy_library, require_walls
from courseware.classroom.self_test import self_test
from courseware.classroom.submissions import Roster, Submission, collect
from courseware.paths import REPOSITORY, numbered_paths

FILE_ANSWERS, FILE_SECONDS = 4, 60.0
"""A file has the full time of so many answers, as most lessons have, and so many seconds to be read and compared."""
SCORE_SECONDS = 7200.0  # of a file with --scores
STUDENT_FILES = 3  # in one run, a student has the time of so many files
JUDGE_MEMORY_MB = 8000
MAX_FILE = 20 << 20
MAX_STOPPED = 5  # statements that stop, on a student's page
FORKS = multiprocessing.get_context("forkserver")  # a clean process that has imported the judge makes the others
FORKS.set_forkserver_preload(["courseware.classroom.judge"])
CANARY = re.compile(rb"not-for-students-[0-9a-f]{12}")


def grade_folder(
    folder: Path, out: Path, seed: int, limits: Limits, jobs: int = 1, trust: bool = False, scores: bool = False,
    roster: Roster | None = None, lessons: list[str] | None = None,
    progress: Callable[..., Iterable] = lambda found, total: found,
) -> Results:  # fmt: skip
    """Grade all submissions in a folder. `progress` wraps the iterator over results and is given its length.

    lessons: what was set; without them, what two students handed in. Raises `AssignmentError` for a lesson that is not
    there, and `SandboxError` if this machine has no walls and `trust` is not given.
    """
    roster = roster or Roster()
    asked = [one.name for one in read_assignments(lessons)] if lessons else []
    found, not_read = collect(folder, {name: path.stem for name, path in numbered_paths().items()}, roster)
    with temporary_folder() as library:
        tried, machine = prepare(library, limits, trust)
        (out / "judged").mkdir(parents=True, exist_ok=True)
        settings = Settings(function_names(), seed, library, limits, trust, scores)
        judged = sorted(progress(_all(found, out / "judged", settings, jobs), len(found)), key=lambda e: e.submission)
    entries, more = what_counts(judged, asked)
    by_hand = points_by_hand(out / "by_hand.csv", entries)
    return Results(entries, sorted([*not_read, *more]), roster, seed, tried, machine, asked, by_hand)


def prepare(library: Path, limits: Limits, trust: bool) -> tuple[list[str], str]:
    """Copy the library into an empty folder. Return what was tried against the walls in vain, and what this machine is.

    Raises `SandboxError` if the walls do not hold. With `trust`, nothing is tried.
    """
    if not trust:
        require_unseen(REPOSITORY)
        require_walls()
    copy_library(library)
    return ([], "") if trust else self_test(library, limits)


def require_unseen(*places: Path) -> None:
    """Raise `SandboxError` for a place in a folder that every submission can read, such as /usr."""
    for place in places:
        for seen in (*SYSTEM, sys.prefix, sys.base_prefix):
            if place.resolve().is_relative_to(Path(seen).resolve()):
                message = f"nothing was graded: {place} lies in {seen}, which students' code can read"
                raise SandboxError(f"{message}. Move it, for example into your home folder")


def _all(found: list[Submission], judged: Path, settings: Settings, jobs: int) -> Iterator[Entry]:
    spent: Counter[str] = Counter()  # seconds of each student
    with ThreadPoolExecutor(jobs) as pool:
        for future in as_completed([pool.submit(_one, one, judged, settings, spent) for one in found]):
            yield future.result()


def _one(one: Submission, judged: Path, settings: Settings, spent: Counter[str]) -> Entry:
    """Judge one submission in a process of its own, unless it was judged before."""
    try:
        content, changed = read_plain(one.path)
    except OSError as error:
        return Entry(one, Judged(why=f"the file cannot be read: {error.strerror or error}"))
    suffix = one.path.suffix.lower()
    key = repr((one.guess, settings._replace(library=Path()), suffix)).encode()
    path = judged / f"{hashlib.sha256(key + content).hexdigest()[:32]}.json"
    seconds = SCORE_SECONDS if settings.scores else FILE_SECONDS + FILE_ANSWERS * settings.limits.seconds
    if not path.is_file():
        if spent[one.student] > STUDENT_FILES * seconds:
            reason = f"the student's other files took {spent[one.student]:.0f} seconds"
            return Entry(one, Judged(why=f"was not judged yet, because {reason}. Grade the folder again to go on"))
        began = time.monotonic()
        copy = settings.library / "handed_in" / path.stem / f"submission{suffix}"  # what is judged is what was read
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_bytes(content)
        process = FORKS.Process(target=judge_to_file, args=(one._replace(path=copy), path, settings))
        process.start()
        process.join(seconds)
        if process.is_alive():
            process.kill()
            process.join()
            keep_no_verdict(path, f"{seconds:g} seconds")
        spent[one.student] += time.monotonic() - began
    try:
        found = from_json(json.loads(path.read_text(encoding="utf-8")))
    except (OSError, ValueError, TypeError, KeyError):
        found = Judged(why="could not be judged, because its judge ended. Grade the folder again")
    return Entry(one, found, bool(CANARY.search(content)), changed)


def read_plain(path: Path) -> tuple[bytes, int]:
    """Return a plain file's content and when it changed, whatever its name means by now. Raises `OSError`."""
    with os.fdopen(os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK), "rb") as file:
        kind = os.fstat(file.fileno())
        if not stat.S_ISREG(kind.st_mode) or kind.st_size > MAX_FILE:
            raise OSError(f"it is no plain file of at most {MAX_FILE >> 20} MB")
        return file.read(MAX_FILE), kind.st_mtime_ns


def judge_to_file(one: Submission, path: Path, settings: Settings) -> None:
    """Judge one submission and write the result. The process may take so much memory, and no more."""
    # The soft limit alone, because the sandbox sets its own limits, which may be higher.
    resource.setrlimit(resource.RLIMIT_AS, (JUDGE_MEMORY_MB << 20, resource.getrlimit(resource.RLIMIT_AS)[1]))
    try:
        judged = judge(one.path, settings, one.guess)
        judged.stopped = stopped_statements(judged, one.path, settings)
        atomic_write(path, json.dumps(asdict(judged)))
    except MemoryError:
        keep_no_verdict(path, f"{JUDGE_MEMORY_MB} MB")


def keep_no_verdict(path: Path, took: str) -> None:
    """Write that a file could not be judged, so that the next run does not try it again."""
    why = f"could not be judged: its answers together took more than {took} (kept in judged/{path.name})"
    atomic_write(path, json.dumps(asdict(Judged(why=why))))


def stopped_statements(judged: Judged, path: Path, settings: Settings) -> list[str]:
    """Return which statements of a file stop, and how, for the student.

    They run once more, in a sandbox to which no input was given. So no word of them can carry an input out.
    """
    stops = re.compile(r"cell \d+, line|the file, line")
    numbers = [one.number for one in judged.answers if any(stops.match(remark) for remark in one.remarks)]
    if not numbers:
        return []
    found: list[str] = []
    with contextlib.suppress(AnswerFormatError):
        with Sandbox(path, settings.library, settings.limits, settings.trust) as box:
            for number in numbers:
                head = box.run(number, settings.functions[number], pickle.dumps([])).head
                found += [one_line(text) for text in head.get("problems", [])]
    return list(dict.fromkeys(found))[:MAX_STOPPED]
