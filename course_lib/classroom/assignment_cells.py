"""A lesson or a project as whoever hands it out sees it: its exercises, each with its cells by their tags."""

import copy
from dataclasses import dataclass
from pathlib import Path

import nbformat

from course_lib.paths import notebook_paths, project_paths

ID_LETTERS = 2
"""Letters of a notebook's name that say which it is: "06", "P1"."""


class AssignmentError(ValueError):
    """A lesson that is not there, or whose cells are not those of an exercise; the message names it."""


@dataclass(frozen=True)
class ExerciseCells:
    """The source of one exercise's cells.

    number: "06.1". title: its words, without number and level. solution: None for a project's stage, whose model
    solution stands apart.
    """

    number: str
    title: str
    task: str
    stub: str
    hints: str
    solution: str | None


@dataclass(frozen=True)
class Assignment:
    """One lesson or project: its name ("06", "P1"), its path, and its notebook as it is stored."""

    name: str
    path: Path
    stored: nbformat.NotebookNode

    def notebook(self) -> nbformat.NotebookNode:
        """A copy, to be changed by whoever asks."""
        return copy.deepcopy(self.stored)

    @property
    def is_project(self) -> bool:
        return self.name.startswith("P")

    @property
    def title(self) -> str:
        """The words of its first heading."""
        return self.stored.cells[0].source.splitlines()[0].removeprefix("# ")

    def exercises(self) -> list[ExerciseCells]:
        """The exercises in the order of the notebook. Raises `AssignmentError` where a cell of one is missing."""
        found: dict[str, dict[str, str]] = {}
        for cell in self.stored.cells:
            if "exercise" in cell.metadata:
                found.setdefault(cell.metadata["exercise"], {})[tag_of(cell)] = cell.source
        return [self._exercise(number, sources) for number, sources in found.items()]

    def _exercise(self, number: str, sources: dict[str, str]) -> ExerciseCells:
        missing = {"task", "exercise", "check", "hint"} - set(sources)
        if missing:
            raise AssignmentError(
                f"{self.path.name}: exercise {number} has no cell tagged {', '.join(sorted(missing))}"
            )
        heading = sources["task"].splitlines()[0]
        title = heading.removeprefix(f"### {number}").split("·")[0].strip()
        return ExerciseCells(
            number, title, sources["task"], sources["exercise"], sources["hint"], sources.get("solution")
        )

    def submission(self) -> str | None:
        """The stub of the function that a project is scored by; None for a lesson."""
        sources = [cell.source for cell in self.stored.cells if tag_of(cell) == "submission"]
        return sources[0] if sources else None


def tag_of(cell: nbformat.NotebookNode) -> str:
    """What a cell is to its exercise or project: task, exercise (the stub), check, hint, solution, ...; or ""."""
    tags = cell.metadata.get("tags", [])
    return tags[0] if tags else ""


def read_assignments(names: list[str] | None = None) -> list[Assignment]:
    """Lessons and projects of these names, all of them for none. Raises `AssignmentError` for a name without one."""
    paths = {path.name[:ID_LETTERS]: path for path in [*notebook_paths(), *project_paths()]}
    wanted = list(dict.fromkeys(name.zfill(ID_LETTERS) for name in names)) if names else list(paths)
    unknown = [name for name in wanted if name not in paths]
    if unknown:
        raise AssignmentError(f"there is no lesson {', '.join(unknown)}; there are: {', '.join(paths)}")
    return [Assignment(name, paths[name], nbformat.read(paths[name], as_version=4)) for name in wanted]
