"""Exercises in the notebooks: complete, foldable, and judged rightly by their own checks."""

import ast
import re
import types

from courseware.lessons.kit.exercises import find_exercise, judge, lesson_exercises
from tools.refresh import solution_cell, stub_cell, with_example

# Seeds other than that of `check`: what is right or wrong must not hang on one set of inputs.
SEEDS = (0, 1, 2)


def functions_of(lesson, cell) -> dict[str, types.FunctionType]:
    """The functions that one cell defines, run alone after the lesson's imports."""
    namespace: dict = {}
    exec(lesson.imports(), namespace)
    before = set(namespace)
    exec(compile(cell.source, cell.id, "exec"), namespace)
    return {k: v for k, v in namespace.items() if k not in before and isinstance(v, types.FunctionType)}


def only(cells: list):
    assert len(cells) == 1, f"exactly one such cell, not {len(cells)}"
    return cells[0]


def stub_of(lesson, number: str):
    return functions_of(lesson, only(lesson.exercise_cells(number, "exercise")))


def test_a_lesson_has_three_to_six_exercises_of_all_levels_and_says_so(lesson):
    exercises = lesson_exercises(lesson.number)
    assert 3 <= len(exercises) <= 6
    listed = [exercise.number for exercise in exercises]
    assert lesson.exercise_numbers() == listed, "cells of the notebook, and EXERCISES in courseware/answers"
    assert {exercise.level for exercise in exercises} == {"warm-up", "core", "challenge"}
    for exercise in exercises:
        heading = only(lesson.exercise_cells(exercise.number, "task")).source.splitlines()[0]
        assert (re.findall(r" · (warm-up|challenge)$", heading) or ["core"]) == [exercise.level], heading


def test_every_exercise_is_complete_and_its_first_hint_asks_and_none_is_the_code(lesson):
    for number in lesson.exercise_numbers():
        task = only(lesson.exercise_cells(number, "task"))
        assert re.search(r"\d", task.source.replace(number, "")), "the task tells the expected number"
        cells = lesson.exercise_cells(number, "hint")
        assert {cell.cell_type for cell in (task, *cells)} == {"markdown"}
        text = "".join(cell.source for cell in cells)
        hints = re.findall(r"<details><summary>[^<]*</summary>(.*?)</details>", text, re.S)
        assert 1 <= len(hints) == text.count("<details>") == text.count("</details>") <= 3
        challenge = task.source.partition("\n")[0].endswith("challenge")
        assert challenge or "?" in hints[0], f"{number}: the first hint is a question"
        assert not any("```" in hint or re.search(r"\breturn\b[^.?,;]*[(\[]", hint) for hint in hints), number
        for tag in ("exercise", "check", "solution"):
            only(lesson.exercise_cells(number, tag))


def require_numbers_of_the_example(notebook) -> None:
    for number in notebook.exercise_numbers():
        task = only(notebook.exercise_cells(number, "task")).source
        assert task == with_example(task, find_exercise(number)), "written by `python -m tools.refresh --solutions`"


def test_a_task_shows_the_numbers_of_its_exercises_example(lesson):
    require_numbers_of_the_example(lesson)


def test_a_stage_shows_the_numbers_of_its_exercises_example(project):
    require_numbers_of_the_example(project)


def require_unsolved_stub(notebook, number: str) -> None:
    """The stub has a docstring, the cell below checks its function, and both say that nothing was tried."""
    ((name, stub),) = stub_of(notebook, number).items()
    assert stub.__doc__
    assert judge(find_exercise(number), stub).status == "not attempted"
    cell = only(notebook.exercise_cells(number, "check"))
    assert ast.unparse(ast.parse(cell.source)) == f"check('{number}', {name})"
    assert "".join(o.text for o in cell.outputs).startswith(f"{number}: not attempted")


def test_the_stub_is_not_passed_and_the_solution_is_folded_with_its_number_alone_and_passes(lesson):
    for number in lesson.exercise_numbers():
        require_unsolved_stub(lesson, number)
        cell = only(lesson.exercise_cells(number, "solution"))
        assert cell.metadata["jupyter"]["source_hidden"] is True
        assert cell.source.splitlines()[0] == f"# Solution {number}", "a folded cell shows its first line"
        solutions = functions_of(lesson, cell)
        (name,) = stub_of(lesson, number)
        assert name not in solutions, "the solution has a name of its own, so the student's work is never overwritten"
        (solution,) = [f for key, f in solutions.items() if key.startswith(name)]
        assert judge(find_exercise(number), solution).status == "right"
        assert cell.source == solution_cell(find_exercise(number)), "written by `python -m tools.refresh`"
        assert only(lesson.exercise_cells(number, "exercise")).source == stub_cell(find_exercise(number))
