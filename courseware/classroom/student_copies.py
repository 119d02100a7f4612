"""Copies of lessons for students: no solution in them, all else as it is stored; and copies that are solved.

The folder works by itself: links between lessons, the glossary, pictures and scenes lead to files of the folder, and a
link to anything else becomes plain words. What stands between `<!-- solutions -->` and `<!-- /solutions -->` goes.
"""

import posixpath
import re
import shutil
from collections.abc import Callable
from pathlib import Path, PurePosixPath

import nbformat

from courseware.classroom.assignment_cells import Assignment, tag_of
from courseware.classroom.model_answers import model_answers
from courseware.paths import REPOSITORY
from courseware.working_copies import clear_answers

NOTEBOOKS = REPOSITORY / "notebooks"
FOLDERS = ("pictures", "scenes")
PAGES = ("README.md", "GLOSSARY.md", "projects/README.md")
ABOUT_SOLUTIONS = re.compile(r"\s?<!-- solutions -->.*?<!-- /solutions -->", re.DOTALL)
LINK = re.compile(r"(?<!!)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)")
ELSEWHERE = re.compile(r"[a-z]+:|#|//")

Resolve = Callable[[str], str | None]
"""Where a link to a file leads in the copies; None: the file is not there."""


def student_notebook(assignment: Assignment, resolve: Resolve | None = None) -> nbformat.NotebookNode:
    """Return a lesson without solutions and without measured answers, its counts from 1 to n."""
    notebook = unsolved_notebook(assignment, resolve)
    clear_answers(notebook.cells)
    return notebook


def unsolved_notebook(assignment: Assignment, resolve: Resolve | None = None) -> nbformat.NotebookNode:
    """Return a lesson without solutions, with all that it measured. `resolve` says where links lead."""
    notebook = assignment.notebook()
    notebook.cells = [cell for cell in notebook.cells if tag_of(cell) != "solution"]
    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            cell.source = student_text(cell.source, resolve)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    for count, cell in enumerate(code, start=1):
        cell.execution_count = count
        for output in cell.outputs:
            if "execution_count" in output:
                output["execution_count"] = count
    return notebook


def solved_notebook(assignment: Assignment, resolve: Resolve | None = None, canary: str = "") -> nbformat.NotebookNode:
    """Return a lesson with the model answers in the place of the stubs. canary: stands in every answer as a comment."""
    notebook, answers = unsolved_notebook(assignment, resolve), model_answers(assignment)
    for cell in notebook.cells:
        if tag_of(cell) in ("exercise", "submission"):
            cell.source = f"# {canary}\n{answers[cell.metadata.get('exercise', assignment.name)]}"
        elif tag_of(cell) == "check":
            text = f"{cell.metadata['exercise']}: right.\n"
            cell.outputs = [nbformat.v4.new_output("stream", name="stdout", text=text)]
        elif cell.cell_type == "code" and re.search(r"^score\(", cell.source, re.M):
            cell.outputs = []
    return notebook


def student_text(text: str, resolve: Resolve | None = None) -> str:
    """Return Markdown without the parts about solutions. `resolve` says where its links lead."""

    def one(match: re.Match) -> str:
        words, target = match.groups()
        if resolve is None or ELSEWHERE.match(target):
            return match[0]
        page, mark, part = target.partition("#")
        found = resolve(page)
        return words if found is None else f"[{words}]({found}{mark}{part})"

    return LINK.sub(one, ABOUT_SOLUTIONS.sub("", text))


def write_copies(folder: Path, assignments: list[Assignment], make: Callable = student_notebook) -> None:
    """Write lessons, pages, pictures and scenes into an empty folder; `make` is `student_notebook` or another."""
    for name in FOLDERS:
        shutil.copytree(NOTEBOOKS / name, folder / name, ignore=shutil.ignore_patterns("yours", ".*"))
    lessons = {PurePosixPath(one.path.relative_to(NOTEBOOKS).as_posix()): one for one in assignments}
    places = {*lessons, *map(PurePosixPath, PAGES), PurePosixPath("projects")}
    for page in PAGES:
        text = (NOTEBOOKS / page).read_text(encoding="utf-8")
        write(folder / page, student_text(text, within(places, PurePosixPath(page))))
    for place, assignment in lessons.items():
        write(folder / place, make(assignment, within(places, place)))


def within(places: set[PurePosixPath], page: PurePosixPath) -> Resolve:
    """Return the `Resolve` for links from `page`: the link if it leads to a file of the folder, else None."""

    def resolve(target: str) -> str | None:
        meant = PurePosixPath(posixpath.normpath(page.parent / target))
        return target if meant in places or meant.parts[0] in FOLDERS else None

    return resolve


def write(path: Path, content: str | nbformat.NotebookNode) -> None:
    """Write a text, or a notebook as the course stores it, in a folder that is made for it."""
    text = content if isinstance(content, str) else nbformat.writes(content) + "\n"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
