"""Keep a student's predictions and the results of the checks, on this computer only.

Each lesson has one file, such as `06.json`, in the folder that the environment variable `COURSE_RECORD` names.
`course.py lab` sets the variable. Without it nothing is read or written, so tests and refreshes leave no trace.
"""

import itertools
import json
import os
from collections.abc import Callable
from pathlib import Path

from course_lib.files import atomic_write

RECORD = "COURSE_RECORD"


class RecordError(ValueError):
    """A file that is not a valid record. The message names the file and says what to do."""


def record_folder() -> Path | None:
    """Return the folder of the records, or None if no records are kept."""
    return Path(folder) if (folder := os.environ.get(RECORD)) else None


def read_record(lesson: str) -> dict:
    """Return a lesson's `{"predictions": {"1": text}, "checks": {"06.1": {"status": ..., "attempts": n}}}`.

    Both are empty if there is no record. Raises `RecordError` for a file that is not a valid record of this lesson.
    """
    folder = record_folder()
    path = folder / f"{lesson}.json" if folder else None
    if path is None or not path.exists():
        return {"predictions": {}, "checks": {}}
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
        predictions, checks = found["predictions"], found["checks"]
        texts = [*predictions.values(), *(entry["status"] for entry in checks.values())]
        if not all(isinstance(text, str) for text in texts):
            raise TypeError("a text is missing")
        if not all(isinstance(entry["attempts"], int) for entry in checks.values()):
            raise TypeError("a count is missing")
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise RecordError(f"{path} is not a valid record of lesson {lesson} ({error!r}): move it away") from error
    if found.get("lesson", lesson) != lesson:
        raise RecordError(f"{path} is the record of lesson {found['lesson']}, not of {lesson}: move it away")
    return {"predictions": predictions, "checks": checks}


def record_prediction(lesson: str, index: int, text: str) -> str:
    """Keep the prediction for question `index` (1, 2, ...). Return a sentence if a damaged record was set aside."""
    return _change(lesson, lambda record: record["predictions"].update({str(index): text}))


def record_check(number: str, status: str) -> tuple[str, int]:
    """Keep the result of one check of exercise `number`. An exercise that was right once stays right.

    Return a sentence if a damaged record was set aside, else "", and the number of tries.
    """
    tries = 0

    def count(record: dict) -> None:
        entry = record["checks"].setdefault(number, {"status": status, "attempts": 0})
        if status != "not attempted":
            entry["attempts"] += 1
            entry["status"] = "right" if entry["status"] == "right" else status
        nonlocal tries
        tries = entry["attempts"]

    return _change(number.partition(".")[0], count), tries


def _change(lesson: str, change: Callable[[dict], None]) -> str:
    """Change a lesson's record and write it. A damaged file is renamed; then return a sentence that says so."""
    said, folder = "", record_folder()
    if folder is None:
        return said
    path = folder / f"{lesson}.json"
    try:
        record = read_record(lesson)
    except RecordError:
        names = (path.with_name(f"{lesson}.unreadable-{n}.json") for n in itertools.count(1))
        kept = path.rename(next(name for name in names if not name.exists()))
        said = f"{path} could not be read as a record; it is kept as {kept.name}, and a new record is started."
        record = read_record(lesson)
    change(record)
    folder.mkdir(parents=True, exist_ok=True)
    atomic_write(path, json.dumps({"lesson": lesson, **record}, indent=1, ensure_ascii=False) + "\n")
    return said
