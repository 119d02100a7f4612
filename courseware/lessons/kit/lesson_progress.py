"""Count a student's progress in every lesson and project.

The notebooks say how many predictions and exercises there are. The student's record (`student_record`) says which of
them are done. `show_progress` shows the counts.
"""

import ast
import functools
import json
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from courseware.lessons.kit.student_record import RecordError, read_record, record_folder
from courseware.paths import foundation_paths, notebook_paths, numbered_paths, project_paths


@dataclass(frozen=True)
class Progress:
    """A student's progress in one lesson or project: what it asks for, and what the student has done.

    questions: how many predictions it asks for. exercises: their numbers ("03.1"). said: a sentence if the record is
    damaged, else "".
    """

    title: str
    questions: int = 0
    exercises: tuple[str, ...] = ()
    typed: int = 0
    right: tuple[str, ...] = ()
    attempted: tuple[str, ...] = ()
    said: str = ""

    @property
    def state(self) -> str:
        """Return the state as a word, also for readers who cannot see colours."""
        if not self.typed and not self.attempted:
            return "not begun"
        return "done" if self.typed >= self.questions and len(self.right) == len(self.exercises) else "begun"


@dataclass(frozen=True)
class Table:
    """A table of all lessons, all foundations or all projects, whose exercises are their stages."""

    name: str
    headings: tuple[str, ...]
    parts: tuple[Progress, ...]

    def rows(self) -> list[tuple[str, ...]]:
        """Return a row for each part, and a last row with the sums."""
        rows = []
        for one in self.parts:
            wrong = [number for number in one.attempted if number not in one.right]
            rows.append((one.title, *self._counts([one]), one.state, ", ".join(wrong) or "-"))
        done = sum(one.state == "done" for one in self.parts)
        return [*rows, ("together", *self._counts(self.parts), f"{done} of {len(self.parts)} done", "")]

    def _counts(self, parts: Sequence[Progress]) -> list[str]:
        asked = sum(len(one.exercises) for one in parts)
        right, attempted = sum(len(one.right) for one in parts), sum(len(one.attempted) for one in parts)
        counts = [f"{right} of {asked}", f"{attempted} of {asked}"]
        if "predictions typed" in self.headings:
            questions = sum(one.questions for one in parts)
            counts.append(f"{sum(one.typed for one in parts)} of {questions}" if questions else "none asked")
        return counts


def tables() -> tuple[Table, Table, Table]:
    """Return the progress in all lessons, in all foundations and in all projects."""
    lessons = ("lesson", "checks right", "attempted", "predictions typed", "state", "not right yet")
    foundations = ("foundation", *lessons[1:])
    projects = ("project", "stages right", "attempted", "state", "not right yet")
    return (
        Table("Lessons", lessons, tuple(map(progress_in, notebook_paths()))),
        Table("Foundations", foundations, tuple(map(progress_in, foundation_paths()))),
        Table("Projects", projects, tuple(map(progress_in, project_paths()))),
    )


def unknown_files() -> list[str]:
    """Return a sentence for each file in the folder of the records that belongs to no lesson."""
    folder, ours = record_folder(), numbered_paths()
    found = sorted(folder.glob("*")) if folder is not None else []
    return [
        f"{path} belongs to no lesson of this course; it is not changed."
        for path in found
        if path.stem.partition(".")[0] not in ours and not path.name.startswith(".")
    ]


def progress_in(path: Path) -> Progress:
    """Return the student's progress in this notebook."""
    asked = _asked(path, path.stat().st_mtime_ns)
    try:
        record = read_record(path.name[:2])
    except (RecordError, OSError) as error:
        return replace(asked, said=str(error))
    typed = [text for text in record["predictions"].values() if text.strip()]
    status = {number: record["checks"].get(number, {"status": "not attempted"})["status"] for number in asked.exercises}
    return replace(
        asked,
        typed=min(len(typed), asked.questions),  # a question that a newer lesson no longer asks does not count
        right=tuple(number for number, one in status.items() if one == "right"),
        attempted=tuple(number for number, one in status.items() if one != "not attempted"),
    )


@functools.lru_cache(maxsize=100)
def _asked(path: Path, written: int) -> Progress:
    """Return what a notebook asks for. `written` is its time [ns], so the cache forgets a file that was changed."""
    try:
        cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
        heading = "".join(cells[0]["source"]).partition("\n")[0].lstrip("# ")
        checks = [cell["metadata"] for cell in cells if "check" in cell["metadata"].get("tags", [])]
        numbers = dict.fromkeys(metadata["exercise"] for metadata in checks)
        code = ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
        return Progress(heading.partition(":")[0], sum(map(_questions, code)), tuple(numbers))
    except (ValueError, KeyError, IndexError, TypeError, SyntaxError):  # for example in the middle of a git merge
        return Progress(f"{path.name[:2]} (its notebook cannot be read)")


def _questions(source: str) -> int:
    """Return the number of questions in a cell's `predict("06", question, ...)`."""
    found = 0
    for node in ast.walk(ast.parse(source)) if "predict(" in source else ():
        match node:
            case ast.Call(func=ast.Name("predict"), args=[ast.Constant(), *questions]):
                found += len(questions)
    return found
