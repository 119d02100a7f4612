"""A class's folder, made at once: what students get, and what is the teacher's alone.

    OUT/student/            lessons and projects without their solutions
    OUT/teacher/solutions/  the model answers
    OUT/teacher/rubric/     a page for each lesson: tasks, points, typical mistakes, what to talk about
    OUT/teacher/grading/    the graded tests with their secret seed
    OUT/teacher/nbgrader/   a course for nbgrader
    OUT/teacher/solved/     the lessons with the model answers in their stubs, where asked for

It is made beside its place and put there when it is whole and nothing of the teacher's is found in what students get.
The same seed makes the same folder, letter by letter.
"""

import ast
import json
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path

from course_lib.classroom.assignment_cells import Assignment, tag_of
from course_lib.classroom.leaks import LeakError, find_leaks, solutions, teachers_words
from course_lib.classroom.model_answers import model_solution_path
from course_lib.classroom.nbgrader_course import canary_of, write_course, write_grading_module
from course_lib.classroom.rubric import rubric
from course_lib.classroom.student_copies import solved_notebook, write_copies
from course_lib.files import staging_dir

MARKER = "handout.json"
MADE_BY = "course.py handout"
MADE_FOR_NBGRADER = {"source", "nbgrader_config.py", "README.md"}
"""What we put into teacher/nbgrader; whatever else lies there is the teacher's work."""

READMES = {
    ".": """# A class's folder

Made by `python3 course.py handout`; never edited, never committed. Lessons: {names}.

* `student/` goes to the students.
* `teacher/` is the teacher's alone: solutions, rubrics, the graded tests and their secret seed.

Do not share this folder as a whole. Making it anew replaces it as a whole; that is refused while `teacher/nbgrader/`
holds submissions or grades.
""",
    "teacher": """# For the teacher alone

| folder | what |
|---|---|
| `solutions/` | the model answers, one file a lesson |
| `rubric/` | a page a lesson: tasks, points, typical mistakes with the hint that answers each, what to talk about |
| `grading/` | the graded tests, with the secret seed that draws their inputs |
| `nbgrader/` | a course for nbgrader |
| `solved/` | the lessons with the model answers in place (`--solved`): to be shown on the screen, not to be sent |

Two ways to grade, one rule (`rubric/`), points of the same seed:

    python3 course.py grade FOLDER      submissions in, a table out; every answer in a process of its own, walled in
    nbgrader/README.md                  nbgrader: releases, collects, grades, gives feedback

Students put `student/` into the course's folder as `work/`. Whoever sets up their computers can put it in place of
`notebooks/` as well, which holds the solutions, folded; and remove `notebooks/projects/solutions/`.

The students' own checks stay in their copies: they are there to learn from, and who digs finds their reference in the
course's library. So nothing is graded by them: the graded tests draw other inputs, from the seed in `grading/`.
Every file in here holds the words `{canary}`; should you ever find them in a student's folder, something leaked.
""",
    "teacher/grading": """# The graded tests

`course_grading.py` holds the secret seed ({canary}). nbgrader's kernel imports it before a submission runs; students
never get it. The tests themselves are the course's (`course_lib.classroom.graded_tests`), on inputs that it draws.
""",
    "teacher/nbgrader": """# An nbgrader course

In this folder, with the course's Python (nbgrader must be there: `.venv/bin/python -m pip install nbgrader`):

    python -m nbgrader generate_assignment 06         # release/06: the student's version
    # ... put each submission into submitted/STUDENT/06/06.ipynb ...
    python -m nbgrader autograde 06
    python -m nbgrader generate_feedback 06           # feedback/STUDENT/06/06.html
    python -m nbgrader export                         # grades.csv

`autograde 06 --RunWhatCounts.answers_only=True` runs imports, definitions and answers alone, in a fifth of the time.
Keep `grading/` beside this folder; `nbgrader_config.py` finds it there. Its settings: an untouched stub is "not
attempted"; a line on the error stream fails nobody; the feedback shows the kind of a mistake, no input and no value.

nbgrader runs a student's whole notebook with your rights, in one process with the graded tests. Do that in a container
or on an account of its own, and where points matter compare with `course.py grade`. ({canary})
""",
    "teacher/solutions": """# Model answers

One file a lesson. A project's passes all its stages and is scored like any file. ({canary})
""",
    "teacher/rubric": """# Rubrics

One page a lesson. {canary}
""",
}
STUDENT_README = """# Your copies of the lessons

Give this folder the name `work` and put it into the course's folder, beside `notebooks/`, before you call
`python3 course.py lab` for the first time: that command opens what is in `work/` and never writes over it. Then begin
with [README.md](README.md).

Work in these notebooks, and hand them in as your teacher says. Every exercise has a check that answers at once: it is
there to learn from, and is not what is graded.
"""


class HandoutError(ValueError):
    """A place where no handout can be put; the message names it, and what to do."""


def make_handout(
    out: Path,
    assignments: list[Assignment],
    seed: int,
    solved: bool = False,
    progress: Callable[[list], Iterable] = iter,
) -> Path:
    """Make a class's folder at `out`, in one step; an older one of ours is replaced as a whole.

    seed: secret, draws the graded tests. solved: with the solved copies. progress: wraps the list of what is to be
    done. Raises `HandoutError` for a place that is not ours, `LeakError` where something of the teacher's would be
    handed out; nothing is changed then.
    """
    out = out.absolute()
    require_place(out)
    canary = canary_of(seed)
    with staging_dir(out, [path.name for path in out.glob("*")]) as made:
        for step in progress(steps(made, assignments, seed, canary, solved)):
            step()
        leaks = find_leaks(made / "student", teachers_words(seed, canary) | solutions(assignments))
        if leaks:
            raise LeakError(f"nothing is handed out: {leaks[0]}" + (f", and {len(leaks) - 1} more" * (len(leaks) > 1)))
        (made / "teacher").chmod(0o700)
        require_place(out)  # somebody may have begun to work there while it was made
    return out


def steps(made: Path, assignments: list[Assignment], seed: int, canary: str, solved: bool) -> list[Callable]:
    """What is to be done, each a call."""
    teacher = made / "teacher"
    parts: list[Callable] = [partial(write_student, made / "student", assignments)]
    parts += [partial(write_teachers_pages, teacher, one, canary) for one in assignments]
    parts += [
        partial(write_grading_module, teacher / "grading", seed, canary),
        partial(write_course, teacher / "nbgrader", assignments, canary),
    ]
    if solved:
        parts.append(partial(write_copies, teacher / "solved", assignments, partial(solved_notebook, canary=canary)))
    return [*parts, partial(write_readmes, made, assignments, canary)]


def write_student(folder: Path, assignments: list[Assignment]) -> None:
    """The students' folder."""
    write_copies(folder, assignments)
    (folder / "HANDOUT.md").write_text(STUDENT_README, encoding="utf-8")


def write_teachers_pages(teacher: Path, assignment: Assignment, canary: str) -> None:
    """Solutions and rubric of one lesson."""
    for name in ("solutions", "rubric"):
        (teacher / name).mkdir(parents=True, exist_ok=True)
    if assignment.is_project:
        text = model_solution_path(assignment.name).read_text(encoding="utf-8")
    else:
        sources = [cell.source for cell in assignment.stored.cells if tag_of(cell) == "solution"]
        text = "\n\n\n".join([f"# {assignment.title}\n\n{imports_of(assignment)}", *sources]) + "\n"
    (teacher / "solutions" / f"{assignment.name}.py").write_text(f"# {canary}\n{text}", encoding="utf-8")
    (teacher / "rubric" / f"{assignment.name}.md").write_text(rubric(assignment, canary), encoding="utf-8")


def imports_of(assignment: Assignment) -> str:
    """The lesson's import statements, which its solutions use."""
    found: list[str] = []
    for cell in assignment.stored.cells:
        if cell.cell_type == "code" and tag_of(cell) != "solution":
            nodes = [node for node in ast.parse(cell.source).body if isinstance(node, ast.Import | ast.ImportFrom)]
            found += [ast.unparse(node) for node in nodes]
    return "\n".join(dict.fromkeys(found))


def write_readmes(made: Path, assignments: list[Assignment], canary: str) -> None:
    """A page for every folder, and the mark by which the folder is known as ours."""
    names = [assignment.name for assignment in assignments]
    for folder, text in READMES.items():
        words = text.format(names=", ".join(names), canary=canary)
        (made / folder / "README.md").write_text(words, encoding="utf-8")
    mark = {"made_by": MADE_BY, "version": 1, "lessons": names}
    (made / MARKER).write_text(json.dumps(mark, indent=1) + "\n", encoding="utf-8")


def require_place(out: Path) -> None:
    """Raises `HandoutError` for a place that holds something else, or a handout in which somebody has worked."""
    if not out.exists() and not out.is_symlink():
        return
    if out.is_symlink() or not out.is_dir():
        raise HandoutError(f"--out {out} is no folder: name one that is new, or a handout to be replaced")
    if any(not path.name.startswith(".") for path in out.iterdir()) and not is_handout(out):
        raise HandoutError(
            f"--out {out} holds something that is no handout of ours: name a new folder, or an empty one"
        )
    course = out / "teacher" / "nbgrader"
    kept = sorted({path.name for path in course.glob("*")} - MADE_FOR_NBGRADER)
    if kept:
        raise HandoutError(
            f"{course} holds {', '.join(kept)}, which would be lost: name another --out, or move them away first"
        )


def is_handout(folder: Path) -> bool:
    """Whether a folder bears our mark."""
    try:
        return json.loads((folder / MARKER).read_text(encoding="utf-8"))["made_by"] == MADE_BY
    except (OSError, ValueError, KeyError, TypeError):
        return False
