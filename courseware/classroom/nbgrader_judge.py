"""What nbgrader does in our courses: the judge of `course.py grade` gives the points, and no cell runs in a kernel."""

import functools
import json
import os
import sys
import tempfile
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

from course_lib.files import temporary_folder
from courseware.classroom.assignment_cells import function_names
from courseware.classroom.grading import prepare, require_unseen
from courseware.classroom.judge import Settings, judge
from courseware.classroom.sandbox import Limits
from courseware.classroom.student_copies import write


class Judge(NbGraderPreprocessor):
    """Writes the judge's points and sentences into the graded cells, in place of running the notebook."""

    seed_file = Unicode("", help="the file with the secret seed").tag(config=True)
    trust = Bool(False, help="judge without walls: only where you have read every file").tag(config=True)

    def preprocess(self, nb: NotebookNode, resources: dict) -> tuple[NotebookNode, dict]:
        if not self.trust:
            require_unseen(Path(self.seed_file))
        seed = json.loads(Path(self.seed_file).read_text(encoding="utf-8"))["seed"]
        with temporary_folder() as folder:
            write(folder / "submission.ipynb", nb)
            settings = Settings(function_names(), seed, Path(_library(self.trust).name), trust=self.trust, scores=True)
            judged = judge(folder / "submission.ipynb", settings)
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


@functools.cache
def _library(trust: bool) -> tempfile.TemporaryDirectory:
    """Return the library for the sandbox, once for all notebooks of a process, which removes it at its end."""
    folder = tempfile.TemporaryDirectory(prefix="course-")
    prepare(Path(folder.name), Limits(), trust)
    return folder


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
