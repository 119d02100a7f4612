"""A lesson or a project as the person who hands it out sees it: its exercises, each with its cells by their tags."""

import ast
import copy
import functools
from pathlib import Path
from typing import NamedTuple

import nbformat

from courseware.paths import numbered_paths


class AssignmentError(ValueError):
    """A lesson that is not there, or a cell that is missing or is not what its tag says; the message names it."""


class ExerciseCells(NamedTuple):
    """The source of one exercise's cells. title: without number and level. solution: "" for a project's stage."""

    number: str
    title: str
    task: str
    hints: str
    solution: str


class Assignment(NamedTuple):
    """One lesson or project: its name ("06", "F1", "P1"), its path, and its notebook as it is stored."""

    name: str
    path: Path
    stored: nbformat.NotebookNode

    def notebook(self) -> nbformat.NotebookNode:
        """Return a copy that the caller may change."""
        return copy.deepcopy(self.stored)

    @property
    def is_project(self) -> bool:
        return self.name.startswith("P")

    @property
    def title(self) -> str:
        return self.stored.cells[0].source.splitlines()[0].removeprefix("# ")

    def exercises(self) -> list[ExerciseCells]:
        """Return the exercises in the order of the notebook. Raises `AssignmentError` if a cell of one is missing."""
        found: dict[str, dict[str, str]] = {}
        for cell in self.stored.cells:
            if "exercise" in cell.metadata:
                found.setdefault(cell.metadata["exercise"], {})[tag_of(cell)] = cell.source
        exercises = []
        for number, cells in found.items():
            if missing := {"task", "exercise", "check", "hint"} - set(cells):
                message = f"{self.path.name}: exercise {number} has no cell tagged {', '.join(sorted(missing))}"
                raise AssignmentError(message)
            title = cells["task"].splitlines()[0].removeprefix(f"### {number}").split("·")[0].strip()
            parts = (cells["task"], cells["hint"], cells.get("solution", ""))
            exercises.append(ExerciseCells(number, title, *parts))
        return exercises

    def functions(self) -> dict[str, str]:
        """Return the function that each exercise asks for, "06.1" -> "raw_score", and a project, "P1" -> "localize"."""
        stubs = [cell for cell in self.stored.cells if tag_of(cell) in ("exercise", "submission")]
        return {cell.metadata.get("exercise", self.name): function_name(cell.source) for cell in stubs}


def tag_of(cell: nbformat.NotebookNode) -> str:
    """Return what a cell is to its exercise: task, exercise (the stub), check, hint, solution, ...; or ""."""
    return next(iter(cell.metadata.get("tags", [])), "")


def function_name(source: str) -> str:
    """Return the name of the function that a stub's or a solution's cell defines. Raises `AssignmentError`."""
    functions = [node.name for node in ast.parse(source).body if isinstance(node, ast.FunctionDef)]
    if not functions:
        raise AssignmentError(f"a stub or a solution defines a function; this cell defines none: {source[:60]!r}")
    return functions[-1]


@functools.cache
def function_names() -> dict[str, str]:
    """Return the function that each exercise and project of the course asks for: "06.1" -> "raw_score"."""
    return {number: name for one in read_assignments() for number, name in one.functions().items()}


def read_assignments(names: list[str] | None = None) -> list[Assignment]:
    """Return the lessons and projects of these names (default: all). Raises `AssignmentError` for an unknown name."""
    paths = numbered_paths()
    wanted = list(dict.fromkeys(name.zfill(2) for name in names)) if names else list(paths)
    if unknown := [name for name in wanted if name not in paths]:
        raise AssignmentError(f"there is no lesson {', '.join(unknown)}; there are: {', '.join(paths)}")
    return [Assignment(name, paths[name], nbformat.read(paths[name], as_version=4)) for name in wanted]
