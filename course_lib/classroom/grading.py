"""Grade a folder: each submission in a process of its own, each result written as soon as it is there.

What was judged lies in OUT/judged/, a file for each submission, named by a digest of its content, the seed and the
limits. So a run that was ended goes on, and a second one looks only at what changed.
"""

import csv
import hashlib
import json
import multiprocessing
import os
import re
import resource
import stat
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import asdict, dataclass, field
from pathlib import Path

from course_lib.classroom.answers import harmless
from course_lib.classroom.assignment_cells import read_assignments
from course_lib.classroom.judge import Judged, from_json, judge
from course_lib.classroom.model_answers import function_name
from course_lib.classroom.points import BY_HAND, most_of
from course_lib.classroom.sandbox import Limits, library_copy, require_walls
from course_lib.classroom.self_test import self_test
from course_lib.classroom.submissions import NotRead, Roster, Submission, collect, shown
from course_lib.files import atomic_write, temporary_folder
from course_lib.lessons.kit.projects import project_names

JUDGE_SECONDS = 900  # of one submission, beyond its answers' own time; a slow machine needs some ten
SCORE_SECONDS = 7200
JUDGE_MEMORY_MB = 8000
MAX_FILE = 20 << 20
KEYS = ("right", "partly_right", "wrong", "not_attempted")
FORKS = multiprocessing.get_context("forkserver")  # a clean process that has imported the judge makes the others
FORKS.set_forkserver_preload(["course_lib.classroom.judge"])
CANARY = re.compile(rb"not-for-students-[0-9a-f]{12}")


@dataclass
class Entry:
    """One submission and what it came to. canary: whether it holds the words of a teacher's solutions."""

    submission: Submission
    judged: Judged
    canary: bool = False
    counts: bool = True

    @property
    def student(self) -> str:
        return self.submission.student

    @property
    def name(self) -> str:
        return shown(self.submission.path.name)


@dataclass
class Results:
    """What a folder's grading came to. by_hand: (student, project) -> points that the teacher gave."""

    entries: list[Entry]
    not_read: list[NotRead]
    roster: Roster
    seed: int
    walls: list[str]
    machine: str
    by_hand: dict[tuple[str, str], float] = field(default_factory=dict)

    @property
    def students(self) -> list[str]:
        """Return everybody in the class or in the folder, in order."""
        names = {one.student for one in self.entries} | {one.student for one in self.not_read if one.student}
        return sorted(names | set(self.roster.rows), key=str.casefold)

    @property
    def lessons(self) -> list[str]:
        return sorted({lesson for one in self.entries if one.counts for lesson in one.judged.lessons})

    def of(self, student: str) -> list[Entry]:
        return [one for one in self.entries if one.student == student and one.counts]

    def most(self, lesson: str) -> int:
        """Return the points that a lesson or project has."""
        answers = {a.number: a.most for one in self.entries for a in one.judged.answers if _lesson(a.number) == lesson}
        return sum(answers.values()) + (BY_HAND if lesson in project_names() else 0)

    def points(self, student: str, lesson: str) -> float | None:
        """Return a student's points in a lesson, or None if nothing of it was handed in."""
        answers = [a for one in self.of(student) for a in one.judged.answers if _lesson(a.number) == lesson]
        given = self.by_hand.get((student, lesson))
        return sum(a.points for a in answers) + (given or 0) if answers or given is not None else None

    def total(self, student: str) -> float:
        return sum(self.points(student, lesson) or 0 for lesson in self.lessons)

    def same_shape(self) -> list[tuple[str, list[str]]]:
        """Return (exercise, students) of answers that are the same but for names, if they are long enough to tell."""
        found: dict[tuple[str, str], set[str]] = {}
        for one in self.entries:
            for number, shape in one.judged.shapes.items():
                found.setdefault((number, shape), set()).add(one.student)
        return sorted((number, sorted(who)) for (number, _), who in found.items() if len(who) > 1)

    def per_exercise(self) -> list[dict]:
        """Return for each exercise: how many right, partly right, wrong, not attempted, the commonest hint, tries."""
        rows = []
        entries = [one for one in self.entries if one.counts]
        for number in sorted({a.number for one in entries for a in one.judged.answers}):
            answers = [a for one in entries for a in one.judged.answers if a.number == number]
            hints = Counter(a.sentence for a in answers if a.status in ("wrong", "partly right")).most_common(1)
            tries = sorted(one.judged.tries[number] for one in entries if number in one.judged.tries)
            rows.append({
                "number": number, "most": most_of(number), "mean": sum(a.points for a in answers) / len(answers),
                **dict.fromkeys(KEYS, 0), **Counter(a.status.replace(" ", "_") for a in answers),
                "hint": hints[0] if hints else None, "tries": tries[len(tries) // 2] if tries else None,
            })  # fmt: skip
        return rows

    def predictions(self) -> list[tuple[str, str, str, list[tuple[str, str]]]]:
        """Return (lesson, question, measured, [(student, predicted)]) of the whole class."""
        found: dict[tuple[str, str, str], list] = {}
        for one in self.entries:
            for question, said, measured in one.judged.recalled if one.counts else ():
                found.setdefault((one.judged.lessons[0], question, measured), []).append((one.student, said))
        return [(*key, who) for key, who in sorted(found.items())]


def _lesson(number: str) -> str:
    return number.partition(".")[0]


def grade_folder(
    folder: Path, out: Path, seed: int, limits: Limits, jobs: int = 1, trust: bool = False, scores: bool = False,
    roster: Roster | None = None, progress: Callable[..., Iterable] = lambda found, total: found,
) -> Results:  # fmt: skip
    """Grade all submissions in a folder. `progress` wraps the iterator over results and is given its length.

    Raises `SandboxError` if this machine has no walls and `trust` is not given.
    """
    roster = roster or Roster()
    stubs = function_names()
    found, not_read = collect(folder, {one.name: one.path.stem for one in read_assignments()}, roster)
    tried, machine = [], ""
    if not trust:
        require_walls()
    (out / "judged").mkdir(parents=True, exist_ok=True)
    with temporary_folder() as scratch, library_copy(scratch) as library:
        if not trust:
            tried, machine = self_test(library, limits)
        settings = (stubs, seed, library, limits, trust, scores)
        entries = sorted(progress(_all(found, out / "judged", settings, jobs), len(found)), key=lambda e: e.submission)
    entries, unread = _one_for_each(entries)
    not_read = sorted([*not_read, *unread])
    by_hand = points_by_hand(out / "by_hand.csv", entries)
    return Results(entries, not_read, roster, seed, tried, machine, by_hand)


def function_names() -> dict[str, str]:
    """Return the function that each exercise asks for, "06.1" -> "raw_score", and each project, "P1" -> "localize"."""
    assignments = read_assignments()
    stubs = {one.number: one.stub for each in assignments for one in each.exercises()}
    stubs |= {each.name: each.submission() for each in assignments if each.is_project}
    return {number: function_name(stub) for number, stub in stubs.items()}


def _all(found: list[Submission], judged: Path, settings: tuple, jobs: int) -> Iterator[Entry]:
    with ThreadPoolExecutor(jobs) as pool:
        for future in as_completed([pool.submit(_one, one, judged, settings) for one in found]):
            yield future.result()


def _one(one: Submission, judged: Path, settings: tuple) -> Entry:
    """Judge one submission in a process of its own, unless it was judged before."""
    try:
        content = read_plain(one.path)
    except OSError as error:
        return Entry(one, Judged(why=f"the file cannot be read: {error.strerror or error}"))
    stubs, seed, library, limits, trust, scores = settings
    suffix = one.path.suffix.lower()
    key = repr((one.guess, seed, limits, trust, scores, sorted(stubs.items()), suffix)).encode()
    name = hashlib.sha256(key + content).hexdigest()[:32]
    path = judged / f"{name}.json"
    if not path.is_file():
        copy = library / "handed_in" / name / f"submission{suffix}"  # what is judged is what was read
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_bytes(content)
        process = FORKS.Process(target=judge_to_file, args=(one._replace(path=copy), path, *settings))
        process.start()
        process.join(SCORE_SECONDS if scores else JUDGE_SECONDS)
        process.kill()
        process.join()
    try:
        found = from_json(json.loads(path.read_text(encoding="utf-8")))
    except (OSError, ValueError, TypeError, KeyError):
        found = Judged(why="it could not be judged: comparing its answers took too long or too much memory")
    return Entry(one, found, bool(CANARY.search(content)))


def read_plain(path: Path) -> bytes:
    """Return a plain file's content, whatever its name points to by now. Raises `OSError` for anything else."""
    with os.fdopen(os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK), "rb") as file:
        kind = os.fstat(file.fileno())
        if not stat.S_ISREG(kind.st_mode) or kind.st_size > MAX_FILE:
            raise OSError(f"it is no plain file of at most {MAX_FILE >> 20} MB")
        return file.read(MAX_FILE)


def judge_to_file(one: Submission, path: Path, stubs: dict, seed: int, library: Path, limits: Limits, trust: bool,
                  scores: bool) -> None:  # fmt: skip
    """Judge one submission and write the result. The process may take so much time and memory, and no more."""
    # The soft limit alone, because the sandbox sets its own limits, which may be higher.
    resource.setrlimit(resource.RLIMIT_AS, (JUDGE_MEMORY_MB << 20, resource.getrlimit(resource.RLIMIT_AS)[1]))
    judged = judge(one.path, stubs, seed, library, limits, one.guess, trust, scores)
    atomic_write(path, json.dumps(asdict(judged)))


def _one_for_each(entries: list[Entry]) -> tuple[list[Entry], list[NotRead]]:
    """Let the newest file of a student for a lesson count; return all that could be read, and why others were not."""
    not_read = [NotRead(e.student, e.name, e.judged.why) for e in entries if e.judged.why]
    read = [e for e in entries if not e.judged.why]
    newest: dict[tuple[str, str], Entry] = {}
    for entry in sorted(read, key=lambda e: (modified(e.submission.path), e.name)):
        for lesson in entry.judged.lessons:
            if (old := newest.get((entry.student, lesson))) is not None and old.counts:
                old.counts = False
                not_read.append(NotRead(old.student, old.name, f"is older than {entry.name}, which counts"))
            newest[entry.student, lesson] = entry
    return read, not_read


def modified(path: Path) -> int:
    try:
        return path.lstat().st_mtime_ns
    except OSError:  # it has gone meanwhile
        return 0


def points_by_hand(path: Path, entries: list[Entry]) -> dict[tuple[str, str], float]:
    """Read the points that the teacher gave in by_hand.csv; add a row for every project that has none yet.

    Raises `ValueError` if a row holds no number from 0 to `BY_HAND`.
    """
    rows = []
    if path.is_file():
        rows = list(csv.DictReader(path.read_text(encoding="utf-8-sig").splitlines()))
        rows = [{key: (value or "").removeprefix("'") for key, value in row.items() if key} for row in rows]
    known = {(row["student"], row["project"]) for row in rows}
    for one in entries:
        for lesson in one.judged.lessons if one.counts else ():
            if lesson in project_names() and (one.student, lesson) not in known:
                rows.append({"student": one.student, "project": lesson, "points": "", "remark": ""})
    if not rows:
        return {}
    with open(path, "w", encoding="utf-8-sig", newline="") as file:
        writer = csv.DictWriter(file, ["student", "project", "points", "remark"])
        writer.writeheader()
        writer.writerows({key: harmless(value) for key, value in row.items()} for row in rows)
    given = {}
    for row in rows:
        if row["points"].strip():
            points = float(row["points"].replace(",", "."))
            if not 0 <= points <= BY_HAND:
                raise ValueError(
                    f"{path}: {row['student']}, {row['project']}: points are from 0 to {BY_HAND}, not {points}"
                )
            given[row["student"], row["project"]] = points
    return given
