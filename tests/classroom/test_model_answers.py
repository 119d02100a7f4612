"""Model answers: each defines the function that its stub asks for, and stands alone."""

import pytest

from courseware.classroom.assignment_cells import function_name, read_assignments
from courseware.classroom.model_answers import model_answers


@pytest.mark.parametrize("assignment", read_assignments(), ids=lambda one: one.name)
def test_every_model_answer_defines_its_stubs_function(assignment):
    answers = model_answers(assignment)
    assert {number: function_name(code) for number, code in answers.items()} == assignment.functions()
    for number, code in answers.items():
        compile(code, number, "exec")
        assert "_solution" not in code
