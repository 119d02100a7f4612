"""A student's record for the tests."""

import json

import pytest

from courseware.lessons.kit import predictions
from courseware.lessons.kit.student_record import RECORD


@pytest.fixture
def record(tmp_path, monkeypatch):
    """The folder of a student's record, in a folder work/."""
    monkeypatch.setenv(RECORD, str(tmp_path / "work" / "record"))
    monkeypatch.setattr(predictions, "_ASKED", {})
    (tmp_path / "work" / "record").mkdir(parents=True)
    return tmp_path / "work" / "record"


@pytest.fixture
def keep(record):
    """A function that writes a record: predictions, and an exercise's status for each letter (right, wrong, none)."""
    words = {"r": "right", "w": "wrong", "n": "not attempted"}

    def write(lesson: str, letters: str = "", predictions: tuple = ()) -> None:
        checks = {f"{lesson}.{n}": {"status": words[one], "attempts": 1} for n, one in enumerate(letters, start=1)}
        typed = {str(n): text for n, text in enumerate(predictions, start=1)}
        (record / f"{lesson}.json").write_text(json.dumps({"predictions": typed, "checks": checks}))

    return write


def right_06_1(hidden, alpha):
    return (1 - hidden) * alpha / (alpha + 0.02) + hidden * alpha / (alpha + 2)
