"""One judge: the same points by every way, for honest notebooks of every form, and sentences that help."""

import re

import nbformat
import pytest

from courseware.classroom.assignment_cells import function_names
from courseware.classroom.judge import Settings, judge, lessons_of
from courseware.classroom.points import earned
from courseware.lessons.kit.exercises import find_exercise
from tests.classroom.handed_in import assignment_of, handed_in, mistaken, solved

FUNCTIONS = function_names()


@pytest.fixture
def judged(library, tmp_path):
    def run(answers: dict[str, str] | None, name: str = "06", file: str = "homework.ipynb"):
        return judge(handed_in(tmp_path / file, name, answers or {}), Settings(FUNCTIONS, 5, library))

    return run


def test_the_model_answers_have_all_points_and_an_untouched_lesson_none(judged):
    for answers, points in ((solved("06"), 16), (None, 0)):
        found = judged(answers)
        assert found.lessons == ["06"]
        assert sum(one.points for one in found.answers) == points
        assert sum(one.most for one in found.answers) == 16


@pytest.mark.parametrize("name", ["00", "P1", "P2"])
def test_answers_that_take_functions_or_the_lessons_own_objects_run(judged, name):
    assert {one.status for one in judged(solved(name), name).answers} == {"right"}


def test_an_answer_may_use_the_practice_rooms_and_their_tasks(judged):
    answers = solved("P3")
    imports = (f"from courseware.lessons.project_{n} import {name}" for n, name in ((2, "rooms"), (3, "tasks")))
    used = "assert len(tasks.prepare(10_601).truth) == 3 * len(rooms.rooms_of('practice')[0].views)"
    answers["P3.1"] = "\n".join([*imports, answers["P3.1"].replace("    r = ", f"    {used}\n    r = ")])
    assert used in answers["P3.1"]
    assert {one.status for one in judged(answers, "P3").answers} == {"right"}


def test_an_honest_notebook_of_an_odd_form_has_all_points(judged):
    """Its answer begins with %%time, and a top-level call changes what another answer needs."""
    answers = solved("06")
    answers["06.1"] = f"%%time\n{answers['06.1']}"
    answers["06.3"] = answers["06.3"].replace("np.log(2)", "table['two']")
    answers["06.3"] += "\n\ntable = {}\ntable.update(two=np.log(2))"
    found = judged(answers)
    assert [one.status for one in found.answers] == ["right"] * 4, found


def test_a_known_mistake_is_named_and_what_cannot_run_is_said(judged):
    others = {"06.2": "def weigh_rightly(:\n", "06.4": "LIMIT = nothing_there"}
    answers = solved("06") | {"06.1": mistaken("06.1")} | others
    found = judged(answers)
    assert found.answers[0].sentence in {mistake.hint for mistake in find_exercise("06.1").known}
    assert [one.status for one in found.answers] == ["wrong", "not attempted", "right", "not attempted"]
    assert "is not Python" in found.problems[0]


def test_the_grade_says_what_the_lesson_says(judged):
    """Values in another order, a case that is left out: without a known mistake, too."""
    swapped = solved("06")["06.4"].replace("return mean, ", "return ", 1) + ", mean"
    nobody = "def raw_score(hidden, alpha):\n    return hidden / hidden * (0.1 + 0 * alpha)"
    found = judged({"06.1": nobody, "06.4": swapped}).answers
    assert found[3].sentence == "The values are right, but in another order than the task names them."
    assert found[0].sentence.startswith("There is a NaN in your result")


@pytest.mark.parametrize(("body", "sentence"), [
    ("[0.0] * int(1e4 * alpha)", "The result has another shape than the task asks for."),
    ("'x' * int(1e4 * alpha)", "Return numbers."),
    ("[0.0] * 5 if alpha > 0.5 else (1 - hidden) * alpha / (alpha + 0.02) + hidden * alpha / (alpha + 2)", "Right on"),
])  # fmt: skip
def test_no_sentence_carries_a_secret_input_out(judged, body, sentence):
    said = judged({"06.1": f"def raw_score(hidden, alpha):\n    return {body}"}).answers[0].sentence
    assert said.startswith(sentence)
    assert not re.search(r"\d", said)


def test_half_of_the_inputs_right_earns_half(judged):
    right = solved("06")["06.3"].splitlines()
    body = ["    if len(likelihoods) % 2:", "        return 0.0"]
    place = next(k for k, line in enumerate(right) if "return" in line)
    found = judged({"06.3": "\n".join([*right[:place], *body, *right[place:]])}).answers[2]
    right_on = [number < found.right_inputs for number in range(found.inputs)]
    assert 0 < found.right_inputs < found.inputs
    assert found.points == earned(4, right_on)


def test_the_lesson_is_known_by_its_cells_else_by_its_functions(judged, library, tmp_path):
    assert judged(solved("06"), file="20_my_own.ipynb").lessons == ["06"]
    path = tmp_path / "alice.py"
    path.write_text("import numpy as np\n\n\n" + "\n\n\n".join(solved("06").values()), encoding="utf-8")
    found = judge(path, Settings(FUNCTIONS, 5, library))
    assert (found.lessons, [one.status for one in found.answers]) == (["06"], ["right"] * 4)
    path.write_text("print('hello')", encoding="utf-8")
    assert "does not say which lesson" in judge(path, Settings(FUNCTIONS, 5, library)).why
    assert lessons_of([], ["localize"], FUNCTIONS, "") == ["P1"]


@pytest.mark.parametrize(("content", "why"), [
    (b"", "not a notebook"), (b"{}", "not a notebook"), (b'{"cells": 3}', "not a notebook"), (b"\xff\xfe", "UTF-8"),
    (b"[" * 100_000, "not a notebook"),
    (b'{"cells": [{"cell_type": "code", "source": 3, "metadata": []}]}', "not a notebook"),
])  # fmt: skip
def test_a_damaged_file_is_told_in_a_sentence(library, tmp_path, content, why):
    (tmp_path / "06.ipynb").write_bytes(content)
    assert why in judge(tmp_path / "06.ipynb", Settings(FUNCTIONS, 5, library)).why


def test_tries_and_predictions_are_read_from_what_the_notebook_shows(library, tmp_path):
    notebook = assignment_of("06").notebook()
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    checked = next(cell for cell in code if cell.source.startswith('check("06.1"'))
    recall = "1. How far?\n   you said: 3 m\n   measured: 0.3 m\n"
    for cell, text in ((checked, "06.1: right. (try 4)\n"), (code[-1], recall)):
        cell.outputs = [nbformat.v4.new_output("stream", name="stdout", text=text)]
    (tmp_path / "06.ipynb").write_text(nbformat.writes(notebook), encoding="utf-8")
    found = judge(tmp_path / "06.ipynb", Settings(FUNCTIONS, 5, library))
    assert found.tries == {"06.1": 4}
    assert ["How far?", "3 m", "0.3 m"] in found.recalled


def test_the_same_program_under_other_names_has_the_same_shape(judged):
    answers = solved("06")
    one = judged(answers).shapes
    two = judged(answers | {"06.3": answers["06.3"].replace("normalized", "n")}).shapes
    other = judged(answers | {"06.3": answers["06.3"].replace("normalized = 1", "normalized = 1.0")}).shapes
    assert one == two
    assert one["06.3"] != other["06.3"]


def test_a_projects_last_function_runs_in_the_worlds_of_the_seed(library, tmp_path):
    path = tmp_path / "P3.py"
    path.write_text("def match(seen, semantic_map):\n    return []\n", encoding="utf-8")
    withheld = judge(path, Settings(FUNCTIONS, 5, library, scores=True)).answers[-1]
    assert (withheld.number, withheld.right_inputs, withheld.inputs) == ("P3", 12, 12), withheld
    assert withheld.points > 0
    ban = "from course_lib.spherical_stereo.pose.rigid_fit import fit_rigid_2d as match\n"
    path.write_text(ban, encoding="utf-8")
    banned = judge(path, Settings(FUNCTIONS, 5, library, scores=True)).answers[-1]
    assert banned.points == 0
    assert "Not scored: it uses course_lib.spherical_stereo" in banned.remarks[0]
