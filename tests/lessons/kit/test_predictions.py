"""Predictions are kept, come back after a new start, and stand beside what was measured."""

import json
import os

import pytest

from course_lib.lessons.kit import predictions
from course_lib.lessons.kit.exercises import check
from course_lib.lessons.kit.predictions import Predictions, predict, recall
from course_lib.lessons.kit.student_record import RECORD, RecordError, read_record

QUESTIONS = ("How many times more?", "How far away?")


@pytest.fixture
def record(tmp_path, monkeypatch):
    """The folder of a student's record."""
    monkeypatch.setenv(RECORD, str(tmp_path / "record"))
    monkeypatch.setattr(predictions, "_ASKED", {})
    return tmp_path / "record"


@pytest.fixture
def nowhere(monkeypatch):
    monkeypatch.delenv(RECORD, raising=False)
    monkeypatch.setattr(predictions, "_ASKED", {})


def test_what_is_typed_is_kept_and_stands_in_the_box_again(record):
    Predictions("06", QUESTIONS).boxes[1].value = "3 m, because … 「三」"
    assert read_record("06")["predictions"] == {"2": "3 m, because … 「三」"}
    assert [box.value for box in Predictions("06", QUESTIONS).boxes] == ["", "3 m, because … 「三」"]


def test_every_box_is_named_by_its_question(record):
    described = [box.description for box in Predictions("06", QUESTIONS).boxes]
    assert described == ["1. How many times more?", "2. How far away?"]


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


def test_without_a_record_nothing_is_written_and_only_what_was_measured_is_printed(nowhere, tmp_path, capsys):
    typed = Predictions("06", QUESTIONS)
    typed.boxes[0].value = "ten"
    assert "not kept" in typed._state.value
    predict("06", *QUESTIONS)
    capsys.readouterr()
    recall("06", "2.0 times", "0.30 m")
    assert "you said" not in capsys.readouterr().out
    check("06.1", lambda hidden, alpha: hidden)
    assert list(tmp_path.iterdir()) == []


def test_the_measured_answers_stand_alone_where_the_boxes_were_not_shown(nowhere, capsys):
    recall("06", "2.0 times")
    assert capsys.readouterr().out.splitlines() == ["1. Prediction 1", "   measured: 2.0 times"]


def test_another_number_of_answers_than_questions_is_an_error(nowhere):
    predict("06", *QUESTIONS)
    with pytest.raises(ValueError, match="1 measured answers for 2"):
        recall("06", "2.0 times")
    with pytest.raises(ValueError, match="question in words"):
        predict("06")


def test_what_is_stored_in_a_lesson_is_the_questions_and_never_the_answers(record):
    Predictions("06", QUESTIONS).boxes[0].value = "my secret"
    stored = Predictions("06", QUESTIONS)._repr_mimebundle_()
    assert "How far away?" in stored["text/html"]
    assert "my secret" not in stored["text/html"] + stored["text/plain"]


def test_checks_are_counted_and_what_was_right_stays_right(record):
    for answer in (
        lambda hidden, alpha: hidden + alpha,
        lambda hidden, alpha: (1 - hidden) * alpha / (alpha + 0.02) + hidden * alpha / (alpha + 2),
        lambda hidden, alpha: hidden,
    ):
        check("06.1", answer)
    assert read_record("06")["checks"] == {"06.1": {"status": "right", "attempts": 3}}


def test_an_untouched_stub_is_recorded_as_not_attempted(record):
    check("06.1", lambda hidden, alpha: ...)
    assert read_record("06")["checks"] == {"06.1": {"status": "not attempted", "attempts": 0}}


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{",
        "[]",
        '{"predictions": {"1": 3}, "checks": {}}',
        '{"predictions": {}}',
        '{"predictions": {}, "checks": {"06.1": ["status", "attempts"]}}',
        '{"predictions": {}, "checks": {"06.1": {"status": "right", "attempts": "3"}}}',
        '{"lesson": "07", "predictions": {}, "checks": {}}',
        "[" * 100_000,
    ],
    ids=range(9),
)
def test_a_damaged_record_is_named_and_kept_under_another_name(record, capsys, text):
    record.mkdir()
    (record / "06.json").write_text(text)
    with pytest.raises(RecordError, match=r"06\.json"):
        read_record("06")
    typed = Predictions("06", QUESTIONS)
    typed.boxes[0].value = "ten"
    assert "it is kept as 06.unreadable-1.json" in typed._state.value
    assert "Prediction 1 is kept." in typed._state.value
    assert read_record("06")["predictions"] == {"1": "ten"}
    (record / "06.json").write_text(text + " ")
    check("06.1", lambda hidden, alpha: hidden)
    assert "it is kept as 06.unreadable-2.json" in capsys.readouterr().out
    assert [(record / f"06.unreadable-{n}.json").read_text() for n in (1, 2)] == [text, text + " "]


def test_a_full_disk_is_named_and_the_old_record_stays(record, monkeypatch, capsys):
    boxes = Predictions("06", QUESTIONS)
    boxes.boxes[0].value = "ten"
    kept = (record / "06.json").read_text()

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    boxes.boxes[1].value = "three"
    assert "No space left on device" in boxes._state.value
    assert "06.json" in boxes._state.value
    check("06.1", lambda hidden, alpha: hidden)
    assert "No space left on device" in capsys.readouterr().out
    assert (record / "06.json").read_text() == kept
    assert [path.name for path in record.iterdir()] == ["06.json"]


def test_records_are_plain_json(record):
    Predictions("06", QUESTIONS).boxes[0].value = "ten"
    assert json.loads((record / "06.json").read_text())["lesson"] == "06"
    assert [path.name for path in record.iterdir()] == ["06.json"]
