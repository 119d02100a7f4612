"""Copies of lessons for students: no solution in them, all else as it is stored; and copies that are solved.

The folder works by itself: links between lessons, the glossary, pictures and scenes lead to files of the folder, and
what the folder does not hold is no link. Nothing tells that a cell was there: counts go from 1 to n.
"""

import re
import shutil
from collections.abc import Callable
from pathlib import Path, PurePosixPath

import nbformat

from course_lib.classroom.assignment_cells import Assignment, AssignmentError, tag_of
from course_lib.classroom.model_answers import function_name, model_bodies, solved_stub
from course_lib.commands.working_copies import clear_answers
from course_lib.paths import REPOSITORY

NOTEBOOKS = REPOSITORY / "notebooks"
FOLDERS = ("pictures", "scenes")
PAGES = ("README.md", "GLOSSARY.md", "projects/README.md")

# What the pages say of solutions, which are not in a student's folder: file -> (as it stands, as students read it).
REWORDED: dict[str, tuple[tuple[str, str], ...]] = {
    "README.md": (
        (
            " The solution is folded, too. It has a name of its own, so running all cells never overwrites your work.",
            "",
        ),
        (
            "Nothing is sent anywhere, nothing is marked.",
            "Nothing is sent anywhere: you hand the notebook in yourself.",
        ),
    ),
    "projects/README.md": (
        (
            "**For teachers.** `solutions/P1_model_solution.py` passes all stages and is scored like any file; it is "
            "one good way, not the best. Every stage knows typical mistakes and answers each with a hint of its own. "
            "What",
            "What",
        ),
        (
            " is stored in `data/projects/`, made again by `python -m course_lib.lessons.kit.score P1 --store`.",
            " is stored in the course's `data/projects/`.",
        ),
    ),
    "00": (
        (", hints to unfold, and a solution that stays folded until you want it.", ", and hints to unfold."),
        (" The solution is in the folded cell at the end: click on its first line.", ""),
    ),
    "P2": (
        (
            " A model solution is in `solutions/P2_model_solution.py`. Look at it after your own is scored: it is one "
            "way, and not the best.",
            "",
        ),
    ),
    "P3": (
        (
            " A model solution is in `solutions/P3_model_solution.py`: the five stages and nothing else. Look at it "
            "after your own is scored.",
            "",
        ),
    ),
}

Resolve = Callable[[str], str | None]
"""Where a link to a file leads in the copies; None: the file is not there."""

LINK = re.compile(r"(?<!!)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)")
ELSEWHERE = re.compile(r"[a-z]+:|#|//")


def student_notebook(assignment: Assignment, resolve: Resolve | None = None) -> nbformat.NotebookNode:
    """A lesson without its solution cells and measured answers, counts from 1 to n, links by `resolve` (`relinked`)."""
    notebook = unsolved_notebook(assignment, resolve)
    clear_answers(notebook.cells)
    return notebook


def unsolved_notebook(assignment: Assignment, resolve: Resolve | None = None) -> nbformat.NotebookNode:
    """A lesson without its solution cells, with all that it measured."""
    notebook = assignment.notebook()
    notebook.cells = [cell for cell in notebook.cells if tag_of(cell) != "solution"]
    reword_cells(notebook, REWORDED.get(assignment.name, ()))
    relink_cells(notebook, resolve)
    count_anew(notebook)
    return notebook


def solved_notebook(assignment: Assignment, resolve: Resolve | None = None, canary: str = "") -> nbformat.NotebookNode:
    """A lesson whose stubs hold the model answers; its checks say right, and a project's scores wait to be run.

    canary: stands in every answer as a comment.
    """
    notebook = unsolved_notebook(assignment, resolve)
    bodies = model_bodies(assignment)
    for cell in notebook.cells:
        if tag_of(cell) in ("exercise", "submission"):
            body = bodies[function_name(cell.source)]
            cell.source = solved_stub(cell.source, f"# {canary}\n{body}" if canary else body)
        elif tag_of(cell) == "check":
            number = cell.metadata["exercise"]
            cell.outputs = [nbformat.v4.new_output("stream", name="stdout", text=f"{number}: right.\n")]
        elif cell.cell_type == "code" and re.search(r"^score\(", cell.source, re.M):
            cell.outputs = []
    return notebook


def reword_cells(notebook: nbformat.NotebookNode, changes: tuple[tuple[str, str], ...]) -> None:
    """Each text once in the notebook, in one of its cells of words. Raises `AssignmentError` where it is not."""
    for old, new in changes:
        words = words_of(old)
        holding = [cell for cell in notebook.cells if cell.cell_type == "markdown" and words.search(cell.source)]
        if len(holding) != 1:
            raise AssignmentError(f"{len(holding)} cells hold {old!r}; mend REWORDED in {__name__}")
        holding[0].source = words.sub(new, holding[0].source)


def reworded_page(text: str, changes: tuple[tuple[str, str], ...]) -> str:
    """A page of the series as students read it. Raises `AssignmentError` where a text does not stand in it once."""
    for old, new in changes:
        text, count = words_of(old).subn(new, text)
        if count != 1:
            raise AssignmentError(f"a page holds {count} times {old!r}; mend REWORDED in {__name__}")
    return text


def words_of(text: str) -> re.Pattern:
    """Finds these words, whatever spaces and line ends stand between them."""
    return re.compile(r"\s+".join(re.escape(word) for word in text.split(" ")))


def relink_cells(notebook: nbformat.NotebookNode, resolve: Resolve | None) -> None:
    """Links in the cells of words lead where `resolve` says."""
    if resolve is not None:
        for cell in notebook.cells:
            if cell.cell_type == "markdown":
                cell.source = relinked(cell.source, resolve)


def relinked(text: str, resolve: Resolve) -> str:
    """Markdown whose links lead where `resolve(target)` says; its words without a link where that is None.

    Links to other sites, and within the page, stay as they are.
    """

    def one(match: re.Match) -> str:
        words, target = match.groups()
        if ELSEWHERE.match(target):
            return match[0]
        page, mark, part = target.partition("#")
        found = resolve(page)
        return words if found is None else f"[{words}]({found}{mark}{part})"

    return LINK.sub(one, text)


def count_anew(notebook: nbformat.NotebookNode) -> None:
    """Counts of the code cells from 1 to n, in their outputs too."""
    for count, cell in enumerate((cell for cell in notebook.cells if cell.cell_type == "code"), start=1):
        cell.execution_count = count
        for output in cell.outputs:
            if "execution_count" in output:
                output["execution_count"] = count


def place_of(assignment: Assignment) -> PurePosixPath:
    """Where a lesson lies in a folder of copies: as in notebooks/."""
    return PurePosixPath(assignment.path.relative_to(NOTEBOOKS).as_posix())


def write_copies(folder: Path, assignments: list[Assignment], make: Callable = student_notebook) -> None:
    """Write lessons, pages, pictures and scenes into an empty folder; `make` is `student_notebook` or another."""
    for name in FOLDERS:
        copy_folder(NOTEBOOKS / name, folder / name)
    places = {place_of(assignment) for assignment in assignments}
    places |= {PurePosixPath(name) for name in PAGES} | {PurePosixPath("projects")}
    for page in PAGES:
        path = folder / page
        path.parent.mkdir(parents=True, exist_ok=True)
        text = reworded_page((NOTEBOOKS / page).read_text(encoding="utf-8"), REWORDED.get(page, ()))
        path.write_text(relinked(text, within(places, PurePosixPath(page))), encoding="utf-8")
    for assignment in assignments:
        place = place_of(assignment)
        write_notebook(folder / place, make(assignment, within(places, place)))


def copy_folder(source: Path, target: Path) -> None:
    """A folder of pictures or scenes into a new one, without hidden files and the reader's own. Raises `OSError`.

    One by one, so that the first error is told: `copytree` would go on, and collect a full disk's file by file.
    """
    target.mkdir(parents=True)
    for path in sorted(source.iterdir()):
        if path.name == "yours" or path.name.startswith("."):
            continue
        if path.is_dir():
            copy_folder(path, target / path.name)
        else:
            shutil.copy2(path, target / path.name)


def within(places: set[PurePosixPath], page: PurePosixPath) -> Resolve:
    """For links from `page`: the link where a file of the folder is meant, pictures and scenes too; else None."""

    def resolve(target: str) -> str | None:
        parts: list[str] = list(page.parent.parts)
        for part in PurePosixPath(target).parts:
            parts = parts[:-1] if part == ".." else [*parts, part]
        meant = PurePosixPath(*parts)
        return target if meant in places or (parts and parts[0] in FOLDERS) else None

    return resolve


def write_notebook(path: Path, notebook: nbformat.NotebookNode) -> None:
    """Write a notebook as the course stores it, in a folder that is made for it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(nbformat.writes(notebook) + "\n", encoding="utf-8")
