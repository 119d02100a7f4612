"""Submissions as students hand them in: a lesson's notebook with answers in place of its stubs."""

import ast
import inspect
import json
import textwrap
from pathlib import Path

from course_lib.classroom.assignment_cells import Assignment, read_assignments, tag_of
from course_lib.classroom.model_answers import function_name, model_bodies, solved_stub
from course_lib.lessons.kit.exercises import find_exercise


def assignment_of(name: str) -> Assignment:
    (assignment,) = read_assignments([name])
    return assignment


def handed_in(path: Path, name: str, answers: dict[str, str]) -> Path:
    """The notebook of a lesson at `path`, with the source `answers[number]` in place of a stub; others untouched."""
    notebook = assignment_of(name).notebook()
    for cell in notebook.cells:
        if tag_of(cell) == "exercise" and cell.metadata.get("exercise") in answers:
            cell.source = answers[cell.metadata["exercise"]]
        if cell.cell_type == "code":
            cell.outputs = []
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(notebook), encoding="utf-8")
    return path


def solved(name: str) -> dict[str, str]:
    """The model answers of a lesson, by number."""
    assignment = assignment_of(name)
    bodies = model_bodies(assignment)
    return {one.number: solved_stub(one.stub, bodies[function_name(one.stub)]) for one in assignment.exercises()}


def mistaken(number: str, which: int = 0) -> str | None:
    """A known mistake of an exercise as a student's cell; None where the exercise does not write it out.

    The module of the exercises stands before it, as whoever made the mistake would have typed the same thoughts.
    """
    assignment = assignment_of(number.partition(".")[0])
    name = next(function_name(one.stub) for one in assignment.exercises() if one.number == number)
    tree = ast.parse(inspect.getsource(inspect.getmodule(find_exercise(number).reference)))
    (exercises,) = (node for node in tree.body if "EXERCISES" in _assigned(node))
    tree.body.remove(exercises)
    mistakes = [
        call.args[0]
        for exercise in exercises.value.elts
        if any(part.arg == "number" and ast.literal_eval(part.value) == number for part in exercise.keywords)
        for call in ast.walk(exercise)
        if isinstance(call, ast.Call) and isinstance(call.func, ast.Name) and call.func.id == "Mistake" and call.args
    ]
    if not mistakes:
        return None
    tree.body = [node for node in tree.body if getattr(node, "module", None) != "__future__"]
    inner = f"{ast.unparse(tree)}\nreturn {ast.unparse(mistakes[which % len(mistakes)])}"
    maker = f"make_{number.replace('.', '_')}"
    return f"def {maker}():\n{textwrap.indent(inner, '    ')}\n\n{name} = {maker}()\n"


def _assigned(node: ast.stmt) -> list[str]:
    targets = node.targets if isinstance(node, ast.Assign) else [node.target] if isinstance(node, ast.AnnAssign) else []
    return [target.id for target in targets if isinstance(target, ast.Name)]
