"""What nbgrader does in our courses besides its own steps, and the configuration that says so.

nbgrader gives all points to a graded cell without output, takes one line on the error stream for a failure, and shows
tracebacks and hidden tests in its feedback. So: a cell that a student marked to be skipped runs all the same; points
are given for one number in the output and for nothing else; error streams are dropped; what failed is named without a
traceback; whatever holds the teacher's canary or seed is taken out; and the feedback has no hidden tests.

A submission still runs in one process with the graded tests, with the rights of whoever starts nbgrader: who means to
cheat can. `course.py grade` runs every answer in a process of its own, walled in; compare its points.
"""

import ast
import importlib.util
import json
import os
import sys
from pathlib import Path
from types import ModuleType

from nbconvert.preprocessors import ClearMetadataPreprocessor, CSSHTMLHeaderPreprocessor
from nbformat import NotebookNode
from nbformat.v4 import new_output
from nbgrader import utils
from nbgrader.preprocessors import (
    AssignLatePenalties,
    CheckCellMetadata,
    ClearHiddenTests,
    ClearOutput,
    DeduplicateIds,
    Execute,
    GetGrades,
    IgnorePattern,
    LimitOutput,
    NbGraderPreprocessor,
    OverwriteCells,
    OverwriteKernelspec,
    SaveAutoGrades,
)
from traitlets import Bool, Unicode
from traitlets.config import Config

from course_lib.classroom.leaks import teachers_words
from course_lib.classroom.nbgrader_course import MODULE
from course_lib.paths import REPOSITORY

SKIP = "skip-execution"
"""nbclient does not run a cell with this tag."""
ONLY_SHOWS = {"check", "predict", "print", "recall", "score", "show", "show_scene"}
"""A cell that calls only these defines nothing that an answer could need."""
CELL_SECONDS = 900
"""Longest time of one cell: a project's function gets two minutes in each of several worlds."""
NOT_HANDED_IN = ["*.py", "*.pyc", "*.pyd", "*.so", "*.pth"]
"""Files beside a submitted notebook that would be imported in place of ours."""


class RunWhatCounts(NbGraderPreprocessor):
    """Before a submission runs: nothing is skipped but cells that only show something."""

    answers_only = Bool(False, help="run imports, definitions and graded cells alone, which is faster").tag(config=True)

    def preprocess_cell(self, cell: NotebookNode, resources: dict, index: int) -> tuple[NotebookNode, dict]:
        tags = [tag for tag in cell.metadata.get("tags", []) if tag != SKIP]
        if cell.cell_type == "code" and not utils.is_grade(cell) and self.may_be_skipped(cell):
            tags.append(SKIP)
        if tags or "tags" in cell.metadata:
            cell.metadata["tags"] = tags
        return cell, resources

    def may_be_skipped(self, cell: NotebookNode) -> bool:
        """Whether no answer needs this cell."""
        return only_shows(cell.source) or (self.answers_only and not only_defines(cell.source))


def only_defines(source: str) -> bool:
    """Whether a cell's statements are imports and definitions."""
    try:
        statements = ast.parse(source).body
    except SyntaxError:
        return True  # run, so that the feedback shows what is wrong
    return all(isinstance(node, ast.Import | ast.ImportFrom | ast.FunctionDef | ast.ClassDef) for node in statements)


def only_shows(source: str) -> bool:
    """Whether a cell's statements only call what shows or checks something, by its plain name."""
    try:
        statements = ast.parse(source).body
    except SyntaxError:
        return False
    return bool(statements) and all(
        isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Call)
        and isinstance(node.value.func, ast.Name)
        and node.value.func.id in ONLY_SHOWS
        and not any(isinstance(part, ast.NamedExpr) for part in ast.walk(node))
        for node in statements
    )


class PointsAlone(NbGraderPreprocessor):
    """After a submission has run: a graded cell holds one number of points, or an error that says what was wrong."""

    grading = Unicode("", help="folder of the graded tests' module").tag(config=True)

    def preprocess(self, nb: NotebookNode, resources: dict) -> tuple[NotebookNode, dict]:
        module = grading_module(Path(self.grading))
        self.secrets = tuple(teachers_words(module.SEED, module.CANARY).values())
        return super().preprocess(nb, resources)

    def preprocess_cell(self, cell: NotebookNode, resources: dict, index: int) -> tuple[NotebookNode, dict]:
        if cell.cell_type != "code":
            return cell, resources
        if any(secret in json.dumps(cell.outputs) for secret in self.secrets):
            self.log.warning("Cell %s showed what is the teacher's: taken out", cell.get("id", index))
            cell.outputs = [refusal("this cell showed what is the teacher's")]
        if utils.is_grade(cell):
            cell.outputs = graded_outputs(cell.outputs, float(cell.metadata.nbgrader["points"]))
        return cell, resources


def graded_outputs(outputs: list[NotebookNode], most: float) -> list[NotebookNode]:
    """Of a graded cell: what it printed and its one number, or an error without a traceback."""
    printed = [one for one in outputs if one.output_type == "stream" and one.name == "stdout"]
    errors = [one for one in outputs if one.output_type == "error"]
    results = [one for one in outputs if one.output_type == "execute_result"]
    if errors:
        return [refusal(f"no points: {errors[0].ename}. Did the cell of the answer run?")]
    if len(results) != 1:
        return [refusal(f"no points: the graded cell gave {len(results)} results, not one")]
    try:
        value = float(results[0].data["text/plain"])
    except (KeyError, TypeError, ValueError):
        value = -1.0
    if not 0 <= value <= most:
        return [refusal("no points: the graded cell gave no number of points")]
    return [*printed, *results]


def refusal(words: str) -> NotebookNode:
    """An error as nbgrader reads it: no points."""
    return new_output("error", ename="Ungraded", evalue=words, traceback=[words])


def grading_module(folder: Path) -> ModuleType:
    """The module course_grading of a teacher's folder. Raises `FileNotFoundError` where there is none."""
    path = folder / f"{MODULE}.py"
    if not path.is_file():
        raise FileNotFoundError(f"no {path}: the folders grading/ and nbgrader/ of a handout stay together")
    spec = importlib.util.spec_from_file_location(MODULE, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def configure(config: Config, course: Path) -> None:
    """Set nbgrader up for a course that `course.py handout` made. course: its folder, beside grading/."""
    grading = course.parent / "grading"
    first = f"import sys; sys.path[:0] = [{str(grading)!r}, {str(REPOSITORY)!r}]; import {MODULE}; del sys.path[:2]"
    programs = str(Path(sys.executable).parent)
    if programs not in os.environ.get("PATH", "").split(os.pathsep):  # nbgrader calls `alembic` by its bare name
        os.environ["PATH"] = os.pathsep.join([programs, os.environ.get("PATH", os.defpath)])
    config.CourseDirectory.course_id = "indoor-localization"
    config.CourseDirectory.root = str(course)
    config.CourseDirectory.ignore = [".ipynb_checkpoints", "__pycache__", *NOT_HANDED_IN]
    config.ClearSolutions.code_stub = {"python": "..."}
    config.OverwriteCells.add_missing_cells = True
    config.Execute.timeout = CELL_SECONDS
    config.Execute.extra_arguments = [
        "--HistoryManager.hist_file=:memory:",
        "--IPKernelApp.log_level=ERROR",  # it listens on this computer only; no need to warn
        f"--IPKernelApp.exec_lines={first}",
    ]
    config.IgnorePattern.enabled = True
    config.IgnorePattern.pattern = r"[\s\S]"  # any line on the error stream
    config.PointsAlone.grading = str(grading)
    config.Autograde.sanitize_preprocessors = [
        ClearOutput,
        DeduplicateIds,
        OverwriteKernelspec,
        OverwriteCells,
        RunWhatCounts,
        CheckCellMetadata,
    ]
    config.Autograde.autograde_preprocessors = [
        Execute,
        IgnorePattern,
        PointsAlone,
        ClearMetadataPreprocessor,
        LimitOutput,
        SaveAutoGrades,
        AssignLatePenalties,
        CheckCellMetadata,
    ]
    config.GenerateFeedback.preprocessors = [GetGrades, ClearHiddenTests, CSSHTMLHeaderPreprocessor]
