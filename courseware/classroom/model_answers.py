"""Model answers: a lesson's solution under the name that the student's function has; a project's from its own file."""

import ast
import re
from pathlib import Path

from courseware.classroom.assignment_cells import Assignment, AssignmentError, function_name
from courseware.lessons.kit.statements import needed, read_statements
from courseware.paths import REPOSITORY


def model_solution_path(name: str) -> Path:
    """Return where the model solution of a project ("P1") lies."""
    return REPOSITORY / "notebooks" / "projects" / "solutions" / f"{name}_model_solution.py"


def model_answers(assignment: Assignment) -> dict[str, str]:
    """Return the code of every model answer: "06.1" -> code; of a project also "P1", the function that is scored."""
    functions = assignment.functions()
    if not assignment.is_project:
        solutions = {one.number: one.solution for one in assignment.exercises()}
        return {n: re.sub(rf"\b{function_name(solutions[n])}\b", name, solutions[n]) for n, name in functions.items()}
    source = model_solution_path(assignment.name).read_text(encoding="utf-8")
    statements, _ = read_statements([("the model solution", source)])
    found = {}
    for number, name in functions.items():
        chosen = [one.node for one in needed(statements, name)]
        chosen.sort(key=lambda node: getattr(node, "name", "") == name)  # last, as a cell is named by its last function
        if not chosen:
            raise AssignmentError(f"the model solution has no function {name}()")
        found[number] = "\n\n\n".join(ast.get_source_segment(source, node) for node in chosen)
    return found
