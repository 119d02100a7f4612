"""Model answers: each defines the function that its stub asks for, and stands alone."""

import pytest

from course_lib.classroom.assignment_cells import AssignmentError, read_assignments
from course_lib.classroom.model_answers import function_name, model_answers


@pytest.mark.parametrize("assignment", read_assignments(), ids=lambda one: one.name)
def test_every_model_answer_defines_its_stubs_function(assignment):
    answers = model_answers(assignment)
    stubs = {one.number: one.stub for one in assignment.exercises()}
    stubs |= {assignment.name: assignment.submission()} if assignment.is_project else {}
    assert list(answers) == list(stubs)
    for number, stub in stubs.items():
        compile(answers[number], number, "exec")
        assert function_name(answers[number]) == function_name(stub)
        assert "_solution" not in answers[number]


def test_a_cell_without_a_function_is_refused():
    with pytest.raises(AssignmentError, match="defines a function"):
        function_name("x = 1")
