"""Predictions are kept, come back after a new start, and stand beside what was measured."""

import json

import pytest

from courseware.lessons.kit.exercises import check
from courseware.lessons.kit.predictions import Predictions, predict, recall
from courseware.lessons.kit.student_record import RECORD, read_record

QUESTIONS = ("How many times more?", "How far away?")


def test_what_is_typed_is_kept_and_stands_in_the_box_again(record):
    typed = "3 m, because … 「三」"
    Predictions("06", QUESTIONS).boxes[1].value = typed
    assert read_record("06")["predictions"] == {"2": typed}
    again = Predictions("06", QUESTIONS)
    assert [box.value for box in again.boxes] == ["", typed]
    assert [box.description for box in again.boxes] == ["1. How many times more?", "2. How far away?"]
    stored = again._repr_mimebundle_()
    assert "How far away?" in stored["text/html"]
    assert "because" not in stored["text/html"] + stored["text/plain"], "a notebook stores no answers"
    assert json.loads((record / "06.json").read_text("utf-8"))["lesson"] == "06"
    assert [path.name for path in record.iterdir()] == ["06.json"]


def test_the_prediction_is_shown_beside_the_measured_answer(record, capsys):
    predict("06", *QUESTIONS)
    Predictions("06", QUESTIONS).boxes[0].value = "ten\ntimes"
    capsys.readouterr()
    recall("06", "2.0 times", "0.30 m")
    assert capsys.readouterr().out.splitlines() == [
        "1. How many times more?",
        "   you said: ten times",
        "   measured: 2.0 times",
        "2. How far away?",
        "   you said: (nothing yet: type it in under Predict)",
        "   measured: 0.30 m",
    ]
    with pytest.raises(ValueError, match="1 measured answers for 2"):
        recall("06", "2.0 times")


def test_without_a_record_nothing_is_written_and_only_what_was_measured_is_printed(record, monkeypatch, capsys):
    monkeypatch.delenv(RECORD)
    typed = Predictions("06", QUESTIONS)
    typed.boxes[0].value = "ten"
    assert "not kept" in typed._state.value
    recall("06", "2.0 times")
    assert capsys.readouterr().out.splitlines() == ["1. Prediction 1", "   measured: 2.0 times"]
    check("06.1", lambda hidden, alpha: hidden)
    assert [*record.iterdir(), *record.parent.iterdir()] == [record]


@pytest.mark.parametrize("questions", [(), ("Why?", " ")])
def test_boxes_without_words_are_refused(record, questions):
    with pytest.raises(ValueError, match="question in words"):
        predict("06", *questions)
