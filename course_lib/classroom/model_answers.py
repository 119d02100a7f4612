"""Model answers: a lesson's solution under the name that the student's function has; a project's from its own file."""

import ast
import re
from pathlib import Path

from course_lib.classroom.assignment_cells import Assignment, AssignmentError
from course_lib.lessons.kit.statements import needed, read_statements
from course_lib.paths import REPOSITORY


def model_solution_path(name: str) -> Path:
    """Return where the model solution of a project ("P1") lies."""
    return REPOSITORY / "notebooks" / "projects" / "solutions" / f"{name}_model_solution.py"


def function_name(source: str) -> str:
    """Return the name of the function that a stub's or a solution's cell defines. Raises `AssignmentError`."""
    functions = [node.name for node in ast.parse(source).body if isinstance(node, ast.FunctionDef)]
    if not functions:
        raise AssignmentError(f"a stub or a solution defines a function; this cell defines none: {source[:60]!r}")
    return functions[-1]


def model_answers(assignment: Assignment) -> dict[str, str]:
    """Return the code of every model answer: "06.1" -> code; of a project also "P1", the function that is scored."""
    if not assignment.is_project:
        return {one.number: _renamed(one.solution, function_name(one.stub)) for one in assignment.exercises()}
    source = model_solution_path(assignment.name).read_text(encoding="utf-8")
    statements, _ = read_statements([("the model solution", source)])
    stubs = {one.number: one.stub for one in assignment.exercises()} | {assignment.name: assignment.submission()}
    found = {}
    for number, stub in stubs.items():
        name = function_name(stub)
        chosen = [one.node for one in needed(statements, name)]
        chosen.sort(key=lambda node: getattr(node, "name", "") == name)  # last, as a cell is named by its last function
        if not chosen:
            raise AssignmentError(f"the model solution has no function {function_name(stub)}()")
        found[number] = "\n\n\n".join(ast.get_source_segment(source, node) for node in chosen)
    return found


def _renamed(solution: str | None, name: str) -> str:
    if solution is None:
        raise AssignmentError(f"the exercise of {name}() has no solution cell")
    return re.sub(rf"\b{re.escape(function_name(solution))}\b", name, solution)
