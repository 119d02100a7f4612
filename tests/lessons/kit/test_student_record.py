"""The record of a student is kept whatever happens: damaged files, a full disk."""

import os

import pytest

from courseware.lessons.kit.exercises import check
from courseware.lessons.kit.predictions import Predictions
from courseware.lessons.kit.student_record import RecordError, read_record
from tests.lessons.kit.conftest import right_06_1


def stub(hidden, alpha): ...


def wrong(hidden, alpha):
    return hidden


@pytest.mark.parametrize(
    ("answers", "status", "attempts"),
    [([stub], "not attempted", 0), ([stub, wrong], "wrong", 1), ([wrong, right_06_1, wrong, stub], "right", 3)],
)
def test_checks_are_counted_and_what_was_right_stays_right(record, answers, status, attempts):
    for answer in answers:
        check("06.1", answer)
    assert read_record("06")["checks"] == {"06.1": {"status": status, "attempts": attempts}}


@pytest.mark.parametrize(
    "text",
    [
        "{",
        "[]",
        '{"predictions": {"1": 3}, "checks": {}}',
        '{"predictions": {}}',
        '{"predictions": {}, "checks": {"06.1": ["status", "attempts"]}}',
        '{"predictions": {}, "checks": {"06.1": {"status": "right", "attempts": "3"}}}',
        '{"lesson": "07", "predictions": {}, "checks": {}}',
        "[" * 100_000,
    ],
    ids=range(8),
)
def test_a_damaged_record_is_named_and_kept_under_another_name(record, capsys, text):
    (record / "06.json").write_text(text)
    with pytest.raises(RecordError, match=r"06\.json"):
        read_record("06")
    typed = Predictions("06", ("How many?",))
    typed.boxes[0].value = "ten"
    assert "it is kept as 06.unreadable-1.json" in typed._state.value
    assert "Prediction 1 is kept." in typed._state.value
    assert read_record("06")["predictions"] == {"1": "ten"}
    (record / "06.json").write_text(text + " ")
    check("06.1", wrong)
    assert "it is kept as 06.unreadable-2.json" in capsys.readouterr().out
    assert [(record / f"06.unreadable-{n}.json").read_text() for n in (1, 2)] == [text, text + " "]


def test_a_full_disk_is_named_and_the_old_record_stays(record, monkeypatch, capsys):
    boxes = Predictions("06", ("How many?", "How far?"))
    boxes.boxes[0].value = "ten"
    kept = (record / "06.json").read_text()

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    boxes.boxes[1].value = "three"
    check("06.1", wrong)
    for said in (boxes._state.value, capsys.readouterr().out):
        assert "No space left on device" in said
        assert "06.json" in said
    assert {path.name: path.read_text() for path in record.iterdir()} == {"06.json": kept}
