"""Mistakes as edits of a solution: what the edits mean, and what is said of an edit that does not fit."""

import pytest

from courseware.lessons.kit import exercises
from courseware.lessons.kit.mistakes import EditError, edited, read_hints, read_mistakes

OFFSET = 1.0


def line(x, slope):
    """A line: slope * x."""
    shifted = x - OFFSET
    return slope * shifted


def twice(x):
    """Twice the distance."""
    return abs(x) + abs(x)


MISTAKES = """
    slope * => 2 * slope *
    slope * => slope +
    Look at the slope,
    and at nothing else.
    - OFFSET => + OFFSET and also return slope => return -slope
    Two signs.
"""


def test_the_left_side_is_replaced_below_the_docstring_and_the_hint_belongs_to_the_edits_above_it():
    found = [(one.hint, [function(3.0, 5.0) for function in one.functions]) for one in read_mistakes(line, MISTAKES)]
    assert found == [("Look at the slope, and at nothing else.", [20.0, 7.0]), ("Two signs.", [-20.0])]
    assert line(3.0, 5.0) == 10.0


def test_everywhere_replaces_the_left_side_in_every_place():
    assert edited(twice, "everywhere abs(x) => x")(-3.0) == -6.0
    assert edited(twice, "abs(x) + => x +")(-3.0) == 0.0


def test_dots_stand_for_the_whole_body_which_may_call_the_right_function_and_the_right_side_may_be_empty():
    assert edited(line, "... => return line(-x, slope)")(3.0, 5.0) == line(-3.0, 5.0)
    assert edited(line, "- OFFSET =>")(3.0, 5.0) == 15.0


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("slope + => slope -\nA sign.", "does not contain 'slope \\+'"),
        ("slope * => slope (\nA bracket.", "makes no Python"),
        ("A hint alone.", "stands below no edit"),
        ("slope * => slope +", "write a hint below 'slope \\* => slope \\+'"),
    ],
)
def test_an_edit_that_does_not_fit_is_refused(text, words):
    with pytest.raises(EditError, match=words):
        read_mistakes(line, text)


def test_an_edit_says_how_often_its_left_side_stands_there():
    with pytest.raises(EditError, match=r"2 times: write more of the line, or `everywhere`"):
        edited(twice, "abs(x) => x")
    with pytest.raises(EditError, match="once: leave `everywhere` out"):
        edited(twice, "everywhere abs(x) + => x +")


def test_a_file_of_hints_has_one_heading_for_each_exercise_and_the_mistakes_stand_below(tmp_path):
    (tmp_path / "lesson_99.hints").write_text("[99.1]\nold => new\nA hint.\n\n[99.2]\na[1] => a[0]\nThe first.\n")
    found = read_hints(tmp_path / "lesson_99.hints")
    assert {number: text.strip() for number, text in found.items()} == {
        "99.1": "old => new\nA hint.",
        "99.2": "a[1] => a[0]\nThe first.",
    }
    for text in ("old => new\nA hint.\n[99.1]\n", "[99.1]\n[99.1]\n"):
        (tmp_path / "lesson_99.hints").write_text(text)
        with pytest.raises(EditError, match=r"lesson_99\.hints: write one heading"):
            read_hints(tmp_path / "lesson_99.hints")


def test_hints_of_an_exercise_that_there_is_not_are_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(exercises, "answers_folder", lambda: tmp_path)
    (tmp_path / "lesson_06.py").touch()
    (tmp_path / "lesson_06.hints").write_text("[06.77]\nold => new\nA hint.\n")
    with pytest.raises(EditError, match=r"lesson_06\.hints: there is no exercise 06\.77"):
        exercises.lesson_exercises.__wrapped__("06")
