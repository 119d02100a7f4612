"""A course for nbgrader: source notebooks, and a configuration in which the judge gives the points.

`source/06/06.ipynb`: every stub is followed by the model answer between nbgrader's comments, which a release omits;
the check stays as it is, visible and not graded; after it comes a locked cell with the points. When nbgrader grades, no
cell runs: `Judge` hands the notebook to the same judge as `course.py grade`, and writes its points into these cells.
"""

import re
import shutil
from collections.abc import Callable
from pathlib import Path

import nbformat

from courseware.classroom.assignment_cells import Assignment, tag_of
from courseware.classroom.model_answers import model_answers
from courseware.classroom.points import most_of
from courseware.classroom.student_copies import FOLDERS, NOTEBOOKS, unsolved_notebook, write

SCHEMA = 3
"""Of nbgrader's cell metadata, since its version 0.6."""
BEGIN, END = "### BEGIN SOLUTION", "### END SOLUTION"
CONFIGURATION = '''"""nbgrader's configuration of this course; run nbgrader in this folder, with the course's Python."""

from pathlib import Path

from courseware.classroom.nbgrader_judge import configure

configure(get_config(), Path(__file__).resolve().parent)  # noqa: F821 - nbgrader gives it
'''


def write_course(folder: Path, assignments: list[Assignment], canary: str) -> None:
    """Write `source/` and nbgrader_config.py into a folder."""
    names = {assignment.path.name: assignment.name for assignment in assignments}

    def resolve(target: str) -> str | None:
        last = target.rsplit("/", 1)[-1]
        return last if last == "GLOSSARY.md" else f"../{names[last]}/{names[last]}.ipynb" if last in names else None

    for assignment in assignments:
        place = folder / "source" / assignment.name
        notebook = source_notebook(assignment, canary, resolve)
        write(place / f"{assignment.name}.ipynb", notebook)
        for used in ["GLOSSARY.md", *files_used(notebook)]:
            (place / used).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(NOTEBOOKS / used, place / used)
    write(folder / "nbgrader_config.py", CONFIGURATION)


def files_used(notebook: nbformat.NotebookNode) -> list[str]:
    """Return the pictures and scenes that a notebook shows."""
    found = re.findall(rf"(?<![\w/])((?:{'|'.join(FOLDERS)})/[\w.-]+)", nbformat.writes(notebook))
    return sorted({name for name in found if (NOTEBOOKS / name).is_file()})


def source_notebook(assignment: Assignment, canary: str, resolve: Callable | None = None) -> nbformat.NotebookNode:
    """Return a lesson as nbgrader's source: solution regions, visible checks, locked cells with points."""
    notebook, answers, cells = unsolved_notebook(assignment, resolve), model_answers(assignment), []
    for cell in notebook.cells:
        cells.append(cell)
        number = cell.metadata.get("exercise", assignment.name)
        if tag_of(cell) in ("exercise", "submission"):
            cell.source += f"\n{BEGIN}\n# {canary}\n{answers[number]}\n{END}"
            cell.metadata["nbgrader"] = mark(f"answer-{number}", solution=True)
        if tag_of(cell) in ("check", "submission"):
            most = most_of(number)
            source = f"# {number}: {most} points, given when it is handed in. Keep this cell; it does nothing."
            graded = nbformat.v4.new_code_cell(source, id=f"points-{number.replace('.', '-')}")
            graded.metadata["nbgrader"] = mark(f"points-{number}", grade=True, locked=True, points=most)
            cells.append(graded)
    notebook.cells = cells
    return notebook


def mark(name: str, **kind: bool | int) -> dict:
    """Return nbgrader's metadata of a cell; a grade id has no dots."""
    named = {"grade_id": name.replace(".", "-"), "schema_version": SCHEMA}
    return {"grade": False, "solution": False, "locked": False, "task": False} | kind | named
