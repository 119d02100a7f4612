"""Count a student's progress in every lesson and project.

The notebooks say how many predictions and exercises there are. The student's record (`student_record`) says which of
them are done. `progress_page` shows the counts as a page, and `show_progress` prints them.
"""

import ast
import functools
import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from course_lib.lessons.kit.student_record import RecordError, read_record, record_folder
from course_lib.paths import notebook_paths, project_paths


@dataclass(frozen=True)
class Contents:
    """The contents of a lesson: its title, how many predictions it asks for, and its exercises' numbers ("03.1")."""

    title: str
    predictions: int
    exercises: tuple[str, ...]


@dataclass(frozen=True)
class Progress:
    """A student's progress in one lesson or project. `said` is a sentence if the record is damaged, else ""."""

    contents: Contents
    typed: int = 0
    right: tuple[str, ...] = ()
    attempted: tuple[str, ...] = ()
    said: str = ""

    @property
    def state(self) -> str:
        """Return the state as a word, also for readers who cannot see colours."""
        if not self.typed and not self.attempted:
            return "not begun"
        done = self.typed >= self.contents.predictions and len(self.right) == len(self.contents.exercises)
        return "done" if done else "begun"

    @property
    def not_yet_right(self) -> tuple[str, ...]:
        """Return the exercises that were attempted and are not right yet."""
        return tuple(number for number in self.attempted if number not in self.right)


@dataclass(frozen=True)
class Table:
    """A table of all lessons or all projects: headings, a row for each, and sums. The page adds a bar to column two."""

    name: str
    headings: tuple[str, ...]
    parts: tuple[Progress, ...]

    def cells(self, one: Progress) -> tuple[str, ...]:
        """Return the row of one lesson."""
        exercises = len(one.contents.exercises)
        checks = (f"{len(one.right)} of {exercises}", f"{len(one.attempted)} of {exercises}")
        typed = f"{one.typed} of {one.contents.predictions}" if one.contents.predictions else "none asked"
        return (
            one.contents.title,
            *checks,
            *([typed] if "predictions typed" in self.headings else []),
            one.state,
            ", ".join(one.not_yet_right) or "-",
        )

    def sums(self) -> tuple[str, ...]:
        """Return the last row."""
        exercises = sum(len(one.contents.exercises) for one in self.parts)
        typed = f"{sum(one.typed for one in self.parts)} of {sum(one.contents.predictions for one in self.parts)}"
        return (
            "together",
            f"{sum(len(one.right) for one in self.parts)} of {exercises}",
            f"{sum(len(one.attempted) for one in self.parts)} of {exercises}",
            *([typed] if "predictions typed" in self.headings else []),
            f"{sum(one.state == 'done' for one in self.parts)} of {len(self.parts)} done",
            "",
        )

    def as_text(self) -> str:
        """Return the table as text."""
        rows = [self.headings, *(self.cells(one) for one in self.parts), self.sums()]
        widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
        return "\n".join(
            "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows
        )


def tables() -> tuple[Table, Table]:
    """Return the progress in all lessons and in all projects. The exercises of a project are its stages."""
    lessons = ("lesson", "checks right", "attempted", "predictions typed", "state", "not right yet")
    projects = ("project", "stages right", "attempted", "state", "not right yet")
    return (
        Table("Lessons", lessons, progress_in(notebook_paths())),
        Table("Projects", projects, progress_in(project_paths())),
    )


def unknown_files() -> list[str]:
    """Return a sentence for each file in the folder of the records that belongs to no lesson."""
    folder, ours = record_folder(), {path.name[:2] for path in [*notebook_paths(), *project_paths()]}
    found = sorted(folder.glob("*")) if folder is not None else []
    return [
        f"{path} belongs to no lesson of this course; it is not changed."
        for path in found
        if path.stem.partition(".")[0] not in ours and not path.name.startswith(".")
    ]


def progress_in(paths: Sequence[Path]) -> tuple[Progress, ...]:
    """Return the student's progress in these notebooks."""
    return tuple(_progress(path) for path in paths)


def _progress(path: Path) -> Progress:
    asked = contents(path)
    try:
        record = read_record(path.name[:2])
    except (RecordError, OSError) as error:
        return Progress(asked, said=str(error))
    typed = [text for text in record["predictions"].values() if text.strip()]
    status = {number: entry["status"] for number, entry in record["checks"].items()}
    return Progress(
        asked,
        min(len(typed), asked.predictions),  # a question that a newer lesson no longer asks does not count
        tuple(number for number in asked.exercises if status.get(number) == "right"),
        tuple(number for number in asked.exercises if status.get(number, "not attempted") != "not attempted"),
    )


def contents(path: Path) -> Contents:
    """Return the contents of a lesson's notebook."""
    return _contents(path, path.stat().st_mtime_ns)


@functools.lru_cache(maxsize=100)
def _contents(path: Path, written: int) -> Contents:
    """Read the contents. The cache forgets them when the file was written again (`written`: its time in ns)."""
    try:
        cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
        heading = "".join(cells[0]["source"]).partition("\n")[0].lstrip("# ")
        checks = [cell["metadata"] for cell in cells if "check" in cell["metadata"].get("tags", [])]
        numbers = dict.fromkeys(metadata["exercise"] for metadata in checks)
        code = ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
        return Contents(heading.partition(":")[0], sum(map(_questions, code)), tuple(numbers))
    except (ValueError, KeyError, IndexError, TypeError, SyntaxError):  # for example in the middle of a git merge
        return Contents(f"{path.name[:2]} (its notebook cannot be read)", 0, ())


def _questions(source: str) -> int:
    """Return the number of questions in a cell's `predict(lesson, question, ...)`."""
    if "predict(" not in source:
        return 0
    calls = [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Call) and node.args]
    ours = [call for call in calls if isinstance(call.func, ast.Name) and call.func.id == "predict"]
    return sum(len(call.args) - 1 for call in ours if isinstance(call.args[0], ast.Constant))
