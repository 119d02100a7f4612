"""What a folder's grading came to: what counts, points, what a teacher wants to see of the whole class."""

import csv
import io
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from course_lib.files import atomic_write
from courseware.classroom.judge import Graded, Judged
from courseware.classroom.points import BY_HAND, lesson_of, most_of
from courseware.classroom.submissions import NotRead, Roster, Submission, read_table, shown
from courseware.lessons.kit.projects import project_names

FORMULA = re.compile(r"^[\s\u200b\ufeff]*[=+\-@\uff1d\ufe66\uff0b\uff0d\uff20\t\r]")
"""A spreadsheet takes a cell that begins so for a formula; some take full-width signs too."""


@dataclass
class Entry:
    """One submission and what it came to. canary: it holds the words of a teacher's solutions. changed: when, in ns."""

    submission: Submission
    judged: Judged
    canary: bool = False
    changed: int = 0

    @property
    def student(self) -> str:
        return self.submission.student

    @property
    def name(self) -> str:
        return shown(self.submission.path.name)


def answers_of(entries: list[Entry]) -> Iterator[Graded]:
    return (one for entry in entries for one in entry.judged.answers)


@dataclass
class Results:
    """What a folder's grading came to. entries: what counts. by_hand: (student, project) -> points of the teacher's."""

    entries: list[Entry]
    not_read: list[NotRead]
    roster: Roster
    seed: int
    walls: list[str]
    machine: str
    asked: list[str]
    by_hand: dict[tuple[str, str], float] = field(default_factory=dict)

    @property
    def students(self) -> list[str]:
        """Return everybody in the class or in the folder, in order."""
        names = {one.student for one in self.entries} | {one.student for one in self.not_read if one.student}
        return sorted(names | set(self.roster.rows), key=str.casefold)

    @property
    def lessons(self) -> list[str]:
        return sorted({lesson for one in self.entries for lesson in one.judged.lessons})

    @property
    def missing(self) -> list[str]:
        """Return who is in the class and has nothing that counts."""
        return [student for student in self.roster.rows if not self.of(student)]

    def of(self, student: str) -> list[Entry]:
        return [one for one in self.entries if one.student == student]

    def most(self, lesson: str) -> int:
        """Return the points that a lesson or project has."""
        numbers = {one.number for one in answers_of(self.entries) if lesson_of(one.number) == lesson}
        return sum(map(most_of, numbers)) + (BY_HAND if lesson in project_names() else 0)

    def points(self, student: str, lesson: str) -> float | None:
        """Return a student's points in a lesson, or None if nothing of it was handed in."""
        points = [one.points for one in answers_of(self.of(student)) if lesson_of(one.number) == lesson]
        points += [self.by_hand[student, lesson]] if (student, lesson) in self.by_hand else []
        return sum(points) if points else None

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
        for number in sorted({one.number for one in answers_of(self.entries)}):
            answers = [one for one in answers_of(self.entries) if one.number == number]
            hints = Counter(a.sentence for a in answers if a.status in ("wrong", "partly right")).most_common(1)
            tries = sorted(one.judged.tries[number] for one in self.entries if number in one.judged.tries)
            rows.append({
                "number": number, "most": most_of(number), "mean": sum(a.points for a in answers) / len(answers),
                "statuses": Counter(a.status for a in answers), "hint": hints[0] if hints else None,
                "tries": tries[len(tries) // 2] if tries else "",
            })  # fmt: skip
        return rows

    def predictions(self) -> list[tuple[str, str, str, list[tuple[str, str]]]]:
        """Return (lesson, question, measured, [(student, predicted)]) of the whole class."""
        found: dict[tuple[str, str, str], list] = {}
        for one in self.entries:
            for question, said, measured in one.judged.recalled:
                found.setdefault((one.judged.lessons[0], question, measured), []).append((one.student, said))
        return [(*key, who) for key, who in sorted(found.items())]


def what_counts(judged: list[Entry], asked: list[str]) -> tuple[list[Entry], list[NotRead]]:
    """Return what counts, and why the rest does not: the newest file of each student, for each lesson that was set.

    If `asked` is empty, a lesson counts if two students handed it in; if there is no such lesson, all count.
    """
    not_read = {NotRead(e.student, e.name, e.judged.why) for e in judged if e.judged.why}
    read = [entry for entry in judged if not entry.judged.why]
    handed_in = Counter(lesson for _, lesson in {(e.student, lesson) for e in read for lesson in e.judged.lessons})
    common = [lesson for lesson, students in handed_in.items() if students > 1] or list(handed_in)
    not_read |= {NotRead("", f"lesson {lesson}", "was handed in by nobody") for lesson in set(asked) - set(handed_in)}
    other = "was not asked for" if asked else "was handed in by nobody else. If it was set, name it with --lessons"
    newest: dict[tuple[str, str], str] = {}
    entries = []
    for entry in sorted(read, key=lambda e: (e.changed, e.name), reverse=True):
        mine = []
        for lesson in entry.judged.lessons:
            if lesson not in (asked or common):
                not_read.add(NotRead(entry.student, entry.name, f"holds lesson {lesson}, which {other}"))
            elif newer := newest.get((entry.student, lesson)):
                not_read.add(NotRead(entry.student, entry.name, f"is older than {newer}, which counts for {lesson}"))
            else:
                mine.append(lesson)
                newest[entry.student, lesson] = entry.name
        if mine:
            answers = [answer for answer in entry.judged.answers if lesson_of(answer.number) in mine]
            entries.append(replace(entry, judged=replace(entry.judged, lessons=mine, answers=answers)))
    return sorted(entries, key=lambda e: e.submission), sorted(not_read)


def points_by_hand(path: Path, entries: list[Entry]) -> dict[tuple[str, str], float]:
    """Read the points that the teacher gave in by_hand.csv; add a row for every project that has none yet.

    Raises `ValueError` if a row holds no number from 0 to `BY_HAND`.
    """
    projects = [(one.student, name) for one in entries for name in one.judged.lessons if name in project_names()]
    rows = {key: {"points": "", "remark": ""} for key in projects}
    for row in read_table(path) if path.is_file() else ():
        row = {heading: text.removeprefix("'") for heading, text in row.items()}
        rows[row["student"], row["project"]] = {"points": row["points"].strip(), "remark": row["remark"]}
    if rows:
        written = [[*key, row["points"], row["remark"]] for key, row in rows.items()]
        atomic_write(path, table_text([["student", "project", "points", "remark"], *written]))
    given = {key: float(row["points"].replace(",", ".")) for key, row in rows.items() if row["points"]}
    for (student, project), points in given.items():
        if not 0 <= points <= BY_HAND:
            raise ValueError(f"{path}: {student}, {project}: points are from 0 to {BY_HAND}, not {points}")
    return given


def table_text(rows: Iterable[Sequence[object]]) -> str:
    """Return rows as CSV with a byte order mark, every text quoted; an apostrophe stands before a formula's sign."""
    text = io.StringIO()
    writer = csv.writer(text, quoting=csv.QUOTE_ALL, lineterminator="\r\n")
    writer.writerows([f"'{cell}" if FORMULA.match(str(cell)) else cell for cell in row] for row in rows)
    return "\ufeff" + text.getvalue()
