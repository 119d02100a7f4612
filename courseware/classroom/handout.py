"""A class's folder, made at once: what students get, and what is the teacher's alone (`templates/teacher.md` lists it).

The folder appears only when it is whole and nothing of the teacher's is found in what students get. The same seed makes
the same folder, letter by letter.
"""

import ast
import hashlib
import io
import json
import zipfile
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path

from course_lib.files import staging_dir
from courseware import PACKED
from courseware.classroom.assignment_cells import Assignment, tag_of
from courseware.classroom.leaks import LeakError, find_leaks, solutions, teachers_words
from courseware.classroom.model_answers import model_solution_path
from courseware.classroom.nbgrader_course import write_course
from courseware.classroom.rubric import rubric
from courseware.classroom.student_copies import solved_notebook, write, write_copies
from courseware.classroom.templates import PAGES
from courseware.paths import REPOSITORY

MARKER = "handout.json"
MADE_BY = "course.py handout"
MADE_FOR_NBGRADER = {"source", "nbgrader_config.py", "README.md"}
"""What we put into teacher/nbgrader; whatever else lies there is the teacher's work."""
READMES = {".": "handout.md", "teacher": "teacher.md", "teacher/nbgrader": "nbgrader.md", "student": "student.md"}
FOR_STUDENTS = (".gitignore", "LICENSE", "README.md", "RESULTS.md", "course.py", "course_lib", "courseware", "data")
FOR_STUDENTS += ("results-in-detail", *(f"environment{part}.txt" for part in ("", "-bench", "-test")), "pyproject.toml")
ANSWERS, CLASSROOM = "courseware/answers", "courseware/classroom"
"""What course.zip does not hold as it is here: the answers are packed into one file, and the classroom is left out."""


class HandoutError(ValueError):
    """A place where no handout can be put; the message names it, and what to do."""


def canary_of(seed: int) -> str:
    """Return a word that stands in all that is the teacher's, and nowhere else."""
    return "not-for-students-" + hashlib.sha256(f"canary of {seed}".encode()).hexdigest()[:12]


def make_handout(
    out: Path, assignments: list[Assignment], seed: int, solved: bool = False, package: bool = False,
    progress: Callable[[list], Iterable] = iter,
) -> Path:  # fmt: skip
    """Make a class's folder at `out`, in one step; an older one of ours is replaced as a whole.

    seed: secret, draws the graded tests. solved: with the solved copies. package: with course.zip. progress: wraps the
    list of what is to be done. Raises `HandoutError` for a place that is not ours and `LeakError` if something of the
    teacher's would be handed out; nothing is changed then.
    """
    out, canary = out.absolute(), canary_of(seed)
    require_place(out)
    with staging_dir(out, [path.name for path in out.glob("*")]) as made:
        teacher = made / "teacher"
        steps: list[Callable] = [partial(write_copies, made / "student", assignments)]
        steps += [partial(write_teachers_pages, teacher, one, canary) for one in assignments]
        steps += [partial(write_course, teacher / "nbgrader", assignments, canary)]
        if solved:
            steps += [partial(write_copies, teacher / "solved", assignments, partial(solved_notebook, canary=canary))]
        if package:
            steps += [partial(write_package, made / "course.zip", made / "student")]
        for step in progress([*steps, partial(write_readmes, made, assignments, seed)]):
            step()
        leaks = find_leaks(made / "student", teachers_words(seed, canary) | solutions(assignments))
        if leaks:
            raise LeakError(f"nothing is handed out: {leaks[0]}" + (f", and {len(leaks) - 1} more" * (len(leaks) > 1)))
        teacher.chmod(0o700)
        require_place(out)  # somebody may have begun to work there while it was made
    return out


def write_teachers_pages(teacher: Path, assignment: Assignment, canary: str) -> None:
    """Write the solutions and the rubric of one lesson."""
    if assignment.is_project:
        text = model_solution_path(assignment.name).read_text(encoding="utf-8")
    else:
        sources = [cell.source for cell in assignment.stored.cells if tag_of(cell) == "solution"]
        text = "\n\n\n".join([f"# {assignment.title}\n\n{imports_of(assignment)}", *sources]) + "\n"
    write(teacher / "solutions" / f"{assignment.name}.py", f"# {canary}\n{text}")
    write(teacher / "rubric" / f"{assignment.name}.md", rubric(assignment, canary))


def imports_of(assignment: Assignment) -> str:
    """Return the lesson's import statements, which its solutions use."""
    code = [cell.source for cell in assignment.stored.cells if cell.cell_type == "code" and tag_of(cell) != "solution"]
    nodes = [node for source in code for node in ast.parse(source).body]
    return "\n".join(dict.fromkeys(ast.unparse(n) for n in nodes if isinstance(n, ast.Import | ast.ImportFrom)))


def write_readmes(made: Path, assignments: list[Assignment], seed: int) -> None:
    """Write a page for every folder, the secret seed, and the mark by which the folder is known as ours."""
    names, canary = [assignment.name for assignment in assignments], canary_of(seed)
    for folder, name in READMES.items():
        path = made / folder / ("HANDOUT.md" if folder == "student" else "README.md")
        write(path, PAGES.get_template(name).render(names=", ".join(names), canary=canary))
    write(made / "teacher" / "grading" / "seed.json", json.dumps({"seed": seed, "canary": canary}) + "\n")
    write(made / MARKER, json.dumps({"made_by": MADE_BY, "lessons": names}) + "\n")


def write_package(path: Path, student: Path) -> None:
    """Write the course for students as a zip file: no tests, no grader, no history, students' copies as notebooks/."""
    course = [place for name in FOR_STUDENTS for place in (REPOSITORY / name, *(REPOSITORY / name).rglob("*"))]
    files = {one.relative_to(REPOSITORY).as_posix(): one for one in course if not one.is_symlink()}
    files |= {f"notebooks/{one.relative_to(student).as_posix()}": one for one in student.rglob("*")}
    files = {name: one for name, one in files.items() if one.is_file() and "__pycache__" not in one.parts}
    answers = {name: one for name, one in files.items() if name.startswith(f"{ANSWERS}/")}
    others = {name: one for name, one in files.items() if not name.startswith((f"{ANSWERS}/", f"{CLASSROOM}/"))}
    packed = archive({name.removeprefix("courseware/"): (one.read_bytes(), 0o644) for name, one in answers.items()})
    contents = {f"course/{name}": (one.read_bytes(), one.stat().st_mode) for name, one in others.items()}
    path.write_bytes(archive(contents | {f"course/courseware/{PACKED}": (packed, 0o644)}))


def archive(contents: dict[str, tuple[bytes, int]]) -> bytes:
    """Return a zip file of contents and modes by their names. The same contents make the same archive."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as file:
        for name, (content, mode) in sorted(contents.items()):
            info = zipfile.ZipInfo(name, (2026, 1, 1, 0, 0, 0))
            info.external_attr, info.compress_type = mode << 16, zipfile.ZIP_DEFLATED
            file.writestr(info, content)
    return buffer.getvalue()


def require_place(out: Path) -> None:
    """Raise `HandoutError` for a place that holds something else, or a handout in which somebody has worked."""
    if not out.exists() and not out.is_symlink():
        return
    if out.is_symlink() or not out.is_dir():
        raise HandoutError(f"--out {out} is no folder: name one that is new, or a handout to be replaced")
    if any(not path.name.startswith(".") for path in out.iterdir()) and not is_handout(out):
        raise HandoutError(f"--out {out} holds something that is no handout of ours: name a new folder")
    course = out / "teacher" / "nbgrader"
    if kept := sorted({path.name for path in course.glob("*")} - MADE_FOR_NBGRADER):
        message = f"{course} holds {', '.join(kept)}, which would be lost"
        raise HandoutError(f"{message}: name another --out, or move them away first")


def is_handout(folder: Path) -> bool:
    """Return whether a folder bears our mark."""
    try:
        return json.loads((folder / MARKER).read_text(encoding="utf-8"))["made_by"] == MADE_BY
    except (OSError, ValueError, KeyError, TypeError):
        return False
