"""Model answers in the student's stubs: the same signature and docstring, a body that stands alone, and back again."""

import re

import pytest

from course_lib.classroom.assignment_cells import AssignmentError, read_assignments
from course_lib.classroom.model_answers import (
    BEGIN,
    END,
    function_name,
    lesson_body,
    model_bodies,
    project_body,
    solved_stub,
)

STUB = 'def double(x):\n    """Twice x."""\n    ...'


@pytest.mark.parametrize("assignment", read_assignments(), ids=lambda one: one.name)
def test_without_its_region_a_solved_stub_is_the_stub_again(assignment):
    bodies = model_bodies(assignment)
    stubs = [one.stub for one in assignment.exercises()]
    stubs += [assignment.submission()] if assignment.is_project else []
    assert len(stubs) == len(bodies)
    for stub in stubs:
        solved = solved_stub(stub, bodies[function_name(stub)], marked=True)
        compile(solved, "stub", "exec")
        assert re.sub(f"{BEGIN}.*{END}", "...", solved, flags=re.S) == stub
        assert "_solution" not in solved


def test_comments_stay_and_the_docstring_is_the_stubs():
    solution = "# Solution\ndef double_solution(x):\n    # First a thought.\n    return 2 * x  # and a word"
    body = lesson_body(STUB, solution, "0.1")
    assert body == "# First a thought.\nreturn 2 * x  # and a word"
    told = 'def double_solution(x):\n    """Other words."""\n    return 2 * x'
    assert lesson_body(STUB, told, "0.1") == "return 2 * x"


def test_what_a_solution_takes_beyond_the_stub_is_set_in_its_body():
    body = lesson_body(STUB, "def double_solution(x, factor=2):\n    return factor * x", "0.1")
    assert body == "factor = 2\nreturn factor * x"


def test_a_solution_of_other_arguments_and_a_stub_of_another_form_are_refused():
    with pytest.raises(AssignmentError, match="takes"):
        lesson_body(STUB, "def double_solution(y):\n    return 2 * y", "0.1")
    with pytest.raises(AssignmentError, match=r"\.\.\."):
        solved_stub("def double(x):\n    return 2 * x", "return 3")


def test_a_projects_answer_brings_the_helpers_that_it_needs_and_no_stage():
    source = (
        "import math\nimport numpy as np\nLIMIT = 3\nOTHER = 4\n\n\n"
        "def helper(x):\n    return math.floor(x) + LIMIT\n\n\n"
        "def stage(x):\n    return x\n\n\ndef last(x):\n    return helper(stage(x))\n"
    )
    body = project_body(source, "last", {"stage", "last"})
    assert body.startswith("import math\n\nLIMIT = 3\n\ndef helper(x):")
    assert body.endswith("return helper(stage(x))")
    assert "OTHER" not in body
    assert "def stage" not in body
