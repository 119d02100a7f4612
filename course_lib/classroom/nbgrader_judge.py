"""What nbgrader does in our courses: the judge of `course.py grade` gives the points, and no cell runs in a kernel."""

import atexit
import contextlib
import functools
import json
import os
import sys
from pathlib import Path

from nbconvert.preprocessors import ClearMetadataPreprocessor, CSSHTMLHeaderPreprocessor
from nbformat import NotebookNode
from nbformat.v4 import new_output
from nbgrader import utils
from nbgrader.preprocessors import (
    AssignLatePenalties,
    CheckCellMetadata,
    ClearOutput,
    DeduplicateIds,
    GetGrades,
    NbGraderPreprocessor,
    OverwriteCells,
    OverwriteKernelspec,
    SaveAutoGrades,
)
from traitlets import Bool, Unicode
from traitlets.config import Config

from course_lib.classroom.assignment_cells import read_assignments
from course_lib.classroom.grading import function_names, require_unseen, tried_library
from course_lib.classroom.judge import Judged, judge
from course_lib.classroom.sandbox import Limits
from course_lib.classroom.student_copies import write_notebook
from course_lib.files import temporary_folder


class Judge(NbGraderPreprocessor):
    """Writes the judge's points and sentences into the graded cells, in place of running the notebook."""

    seed_file = Unicode("", help="the file with the secret seed").tag(config=True)
    trust = Bool(False, help="judge without walls: only where you have read every file").tag(config=True)

    def preprocess(self, nb: NotebookNode, resources: dict) -> tuple[NotebookNode, dict]:
        if not self.trust:
            require_unseen(Path(self.seed_file))
        seed = json.loads(Path(self.seed_file).read_text(encoding="utf-8"))["seed"]
        judged = judge_notebook(nb, seed, self.trust)
        given = {one.number.replace(".", "-"): one for one in judged.answers}
        for cell in nb.cells:
            if utils.is_grade(cell):
                one = given.get(cell.metadata.nbgrader["grade_id"].removeprefix("points-"))
                if one is None:
                    said = f"no points: {judged.why or 'this exercise is not in the notebook'}"
                    cell.outputs = [new_output("error", ename="Ungraded", evalue=said, traceback=[said])]
                else:
                    text = "\n".join([*judged.problems, f"{one.number}: {one.sentence}", ""])
                    points = {"text/plain": f"{float(one.points):g}"}
                    cell.outputs = [
                        new_output("stream", name="stdout", text=text),
                        new_output("execute_result", data=points, execution_count=cell.execution_count),
                    ]
        return nb, resources


def judge_notebook(nb: NotebookNode, seed: int, trust: bool) -> Judged:
    """Judge one notebook, its exercises and a project's score."""
    library, functions = _prepared(trust)
    with temporary_folder() as folder:
        write_notebook(folder / "submission.ipynb", nb)
        return judge(folder / "submission.ipynb", functions, seed, library, Limits(), trust=trust, scores=True)


@functools.cache
def _prepared(trust: bool) -> tuple[Path, dict[str, str]]:
    """Return the library for the sandbox and the functions that are asked for, once for all notebooks of a process."""
    stack = contextlib.ExitStack()
    atexit.register(stack.close)
    library, _, _ = stack.enter_context(tried_library(Limits(), trust))
    return library, function_names(read_assignments())


def configure(config: Config, course: Path) -> None:
    """Set nbgrader up for a course that `course.py handout` made. course: its folder, beside grading/."""
    programs = str(Path(sys.executable).parent)
    if programs not in os.environ.get("PATH", "").split(os.pathsep):  # nbgrader calls `alembic` by its bare name
        os.environ["PATH"] = os.pathsep.join([programs, os.environ.get("PATH", os.defpath)])
    config.CourseDirectory.course_id = "indoor-localization"
    config.CourseDirectory.root = str(course)
    config.ClearSolutions.code_stub = {"python": ""}
    config.OverwriteCells.add_missing_cells = True
    config.Judge.seed_file = str(course.parent / "grading" / "seed.json")
    config.Autograde.sanitize_preprocessors = [
        ClearOutput, DeduplicateIds, OverwriteKernelspec, OverwriteCells, CheckCellMetadata,
    ]  # fmt: skip
    config.Autograde.autograde_preprocessors = [
        Judge, ClearMetadataPreprocessor, SaveAutoGrades, AssignLatePenalties, CheckCellMetadata,
    ]  # fmt: skip
    config.GenerateFeedback.preprocessors = [GetGrades, CSSHTMLHeaderPreprocessor]
