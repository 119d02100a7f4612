"""An nbgrader course: source notebooks with solutions, points and hidden tests, a configuration; and the graded tests.

`source/06/06.ipynb`: every stub holds the model answer between nbgrader's comments (released, it is the stub again);
the check stays as it is, visible and not graded; after it comes a locked cell with the points, whose hidden region only
calls `points` of the module `course_grading`. That module holds the secret seed and stays in the teacher's folder.
"""

import hashlib
import re
import shutil
from collections.abc import Callable
from pathlib import Path

import nbformat

from course_lib.classroom.assignment_cells import Assignment, tag_of
from course_lib.classroom.model_answers import function_name, model_bodies, solved_stub
from course_lib.classroom.points import points_of
from course_lib.classroom.score_worlds import MAX_POINTS
from course_lib.classroom.student_copies import (
    FOLDERS,
    NOTEBOOKS,
    REWORDED,
    count_anew,
    relink_cells,
    reword_cells,
    write_notebook,
)
from course_lib.lessons.kit.exercises import find_exercise
from course_lib.lessons.kit.projects import find_project

SCHEMA = 3
"""Of nbgrader's cell metadata, since its version 0.6."""
BEGIN_HIDDEN, END_HIDDEN = "### BEGIN HIDDEN TESTS", "### END HIDDEN TESTS"
MODULE = "course_grading"

GRADING_MODULE = '''"""The graded tests of this class. FOR THE TEACHER ALONE: whoever knows the seed knows every input.

nbgrader's kernel imports it before a submission runs (nbgrader_config.py); the hidden region of each graded cell calls
`points`. {canary}
"""

from course_lib.classroom import graded_tests

SEED = {seed}
CANARY = "{canary}"


def points(number, function):
    """Points of an answer; prints what its feedback may say."""
    return graded_tests.points(number, function, SEED)
'''

CONFIGURATION = '''"""nbgrader's configuration of this course; run nbgrader in this folder, with the course's Python."""

from pathlib import Path

from course_lib.classroom.nbgrader_steps import configure

configure(get_config(), Path(__file__).resolve().parent)  # noqa: F821 - nbgrader gives it
'''


def canary_of(seed: int) -> str:
    """A word that stands in all that is the teacher's, and nowhere else."""
    return "not-for-students-" + hashlib.sha256(f"canary of {seed}".encode()).hexdigest()[:12]


def write_course(folder: Path, assignments: list[Assignment], canary: str) -> None:
    """Write `source/` and nbgrader_config.py into a folder."""
    names = {assignment.path.name: assignment.name for assignment in assignments}
    for assignment in assignments:
        place = folder / "source" / assignment.name
        notebook = source_notebook(assignment, canary, beside(names))
        write_notebook(place / f"{assignment.name}.ipynb", notebook)
        shutil.copyfile(NOTEBOOKS / "GLOSSARY.md", place / "GLOSSARY.md")
        for used in files_used(notebook):
            (place / used).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(NOTEBOOKS / used, place / used)
    (folder / "nbgrader_config.py").write_text(CONFIGURATION, encoding="utf-8")


def write_grading_module(folder: Path, seed: int, canary: str) -> None:
    """Write course_grading.py into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    text = GRADING_MODULE.format(seed=seed, canary=canary)
    (folder / f"{MODULE}.py").write_text(text, encoding="utf-8")


def beside(names: dict[str, str]) -> Callable[[str], str | None]:
    """For links of an assignment: other assignments lie beside its folder, the glossary in it; all else is no link."""

    def resolve(target: str) -> str | None:
        last = target.rsplit("/", 1)[-1]
        if last == "GLOSSARY.md":
            return last
        return f"../{names[last]}/{names[last]}.ipynb" if last in names else None

    return resolve


def files_used(notebook: nbformat.NotebookNode) -> list[str]:
    """Pictures and scenes that the cells of words, or stored outputs, show."""
    texts = [cell.source for cell in notebook.cells if cell.cell_type == "markdown"]
    texts += [
        str(output.get("data", {}).get("text/html", ""))
        for cell in notebook.cells
        for output in cell.get("outputs", [])
    ]
    found = re.findall(rf"(?<![\w/])((?:{'|'.join(FOLDERS)})/[\w.-]+)", "\n".join(texts))
    return sorted({name for name in found if (NOTEBOOKS / name).is_file()})


def source_notebook(
    assignment: Assignment, canary: str, resolve: Callable[[str], str | None] | None = None
) -> nbformat.NotebookNode:
    """A lesson as nbgrader's source: solution regions, visible checks, graded cells with hidden tests."""
    notebook = assignment.notebook()
    bodies = model_bodies(assignment)
    cells = []
    stub = ""
    for cell in notebook.cells:
        tag = tag_of(cell)
        if tag == "solution":
            continue
        if tag in ("exercise", "submission"):
            stub = function_name(cell.source)
            key = cell.metadata.get("exercise", assignment.name)
            cell.source = solved_stub(cell.source, f"# {canary}\n{bodies[stub]}", marked=True)
            cell.metadata["nbgrader"] = mark(f"answer-{key}", solution=True)
        cells.append(cell)
        if tag == "check":
            number = cell.metadata["exercise"]
            cells.append(graded_cell(number, stub, points_of(find_exercise(number))))
        elif tag == "submission":
            cells.append(graded_cell(assignment.name, find_project(assignment.name).function, MAX_POINTS))
    notebook.cells = cells
    reword_cells(notebook, REWORDED.get(assignment.name, ()))
    relink_cells(notebook, resolve)
    count_anew(notebook)
    return notebook


def graded_cell(number: str, function: str, most: int) -> nbformat.NotebookNode:
    """The locked cell that gives the points of one answer."""
    source = (
        f"# {number}: {most} points, given when it is handed in. Keep this cell; it does nothing here.\n"
        f'{BEGIN_HIDDEN}\nfrom {MODULE} import points\n\npoints("{number}", {function})\n{END_HIDDEN}'
    )
    cell = nbformat.v4.new_code_cell(source, id=f"graded-{number.replace('.', '-')}")
    cell.metadata["nbgrader"] = mark(f"points-{number}", grade=True, locked=True) | {"points": most}
    return cell


def mark(name: str, grade: bool = False, solution: bool = False, locked: bool = False) -> dict:
    """nbgrader's metadata of a cell; a grade id has no dots."""
    return {
        "grade": grade,
        "grade_id": name.replace(".", "-"),
        "locked": locked,
        "schema_version": SCHEMA,
        "solution": solution,
        "task": False,
    }
