"""What a student predicted and which checks said right: kept on this computer, in the folder of the student's work.

One file a lesson, `06.json`, in the folder that the environment variable `COURSE_RECORD` names (`course.py lab` does).
Without it nothing is read or written: a refresh, a test or somebody else's server leaves no trace.
"""

from __future__ import annotations

import itertools
import json
import os
from pathlib import Path

from course_lib.files import atomic_write

RECORD = "COURSE_RECORD"


class RecordError(ValueError):
    """A record that is no record of ours: says which file, and what to do."""


def record_folder() -> Path | None:
    """Where records are kept, or None where they are not."""
    return Path(folder) if (folder := os.environ.get(RECORD)) else None


def read_record(lesson: str) -> dict:
    """`{"predictions": {"1": text}, "checks": {"06.1": {"status": ..., "attempts": n}}}` of a lesson; empty for none.

    Raises `RecordError` for a file that is something else.
    """
    folder = record_folder()
    path = folder / f"{lesson}.json" if folder else None
    if path is None or not path.exists():
        return {"predictions": {}, "checks": {}}
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
        predictions, checks = found["predictions"], found["checks"]
        texts = [*predictions.values(), *(entry["status"] for entry in checks.values())]
        counts = [entry["attempts"] for entry in checks.values()]
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise RecordError(f"{path} is no record of lesson {lesson} ({error!r}): move it away to begin anew") from error
    if not all(isinstance(text, str) for text in texts) or not all(isinstance(count, int) for count in counts):
        raise RecordError(f"{path} is no record of lesson {lesson}: move it away to begin anew")
    if found.get("lesson", lesson) != lesson:
        raise RecordError(f"{path} is the record of lesson {found['lesson']}, not of {lesson}: move it away")
    return {"predictions": predictions, "checks": checks}


def record_prediction(lesson: str, index: int, text: str) -> str:
    """Keep what was typed for question `index`, counted from 1; a sentence where a damaged record was set aside."""
    record, said = _record_to_change(lesson)
    record["predictions"][str(index)] = text
    _write(lesson, record)
    return said


def record_check(number: str, status: str) -> str:
    """Keep the outcome of one check of exercise `number`; what once was right stays right.

    Returns a sentence where a damaged record was set aside, else nothing.
    """
    lesson = number.partition(".")[0]
    record, said = _record_to_change(lesson)
    entry = record["checks"].setdefault(number, {"status": status, "attempts": 0})
    entry["attempts"] += status != "not attempted"
    if entry["status"] != "right" and status != "not attempted":
        entry["status"] = status
    _write(lesson, record)
    return said


def _record_to_change(lesson: str) -> tuple[dict, str]:
    """The record, and nothing to say; where it cannot be read, an empty one and where the damaged one is kept."""
    try:
        return read_record(lesson), ""
    except RecordError:
        damaged = record_folder() / f"{lesson}.json"
        names = (damaged.with_name(f"{lesson}.unreadable-{n}.json") for n in itertools.count(1))
        kept = next(name for name in names if not name.exists())
        damaged.rename(kept)
        said = f"{damaged} could not be read as a record; it is kept as {kept.name}, and a new one is begun."
        return {"predictions": {}, "checks": {}}, said


def _write(lesson: str, record: dict) -> None:
    folder = record_folder()
    if folder is None:
        return
    folder.mkdir(parents=True, exist_ok=True)
    text = json.dumps({"lesson": lesson, **record}, indent=1, ensure_ascii=False) + "\n"
    atomic_write(folder / f"{lesson}.json", text)
