"""A lesson runs top to bottom in a fresh kernel, offline, in at most a minute; all of them in 15 s in the mean."""

from __future__ import annotations

import copy

import pytest

from course_lib.commands.refresh import MAX_SECONDS, execute
from course_lib.paths import notebook_paths

resource = pytest.importorskip("resource", reason="processor time of the kernel is known on POSIX systems only")

MEAN_SECONDS = 15.0
_seconds: dict[str, float] = {}


def processor_seconds() -> float:
    """Processor time of all child processes that have ended, kernels among them."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def test_a_lesson_runs_offline_within_a_minute(lesson):
    before = processor_seconds()
    elapsed = execute(copy.deepcopy(lesson.notebook), lesson.path.parent, cell_timeout=MAX_SECONDS)
    # On a computer that does other work besides, the clock runs on while the lesson waits; its processor time does not.
    _seconds[lesson.number] = min(elapsed, processor_seconds() - before)
    assert _seconds[lesson.number] > 0.5
    assert _seconds[lesson.number] <= MAX_SECONDS


def test_lessons_take_15_seconds_in_the_mean():
    if len(_seconds) < len(notebook_paths()):
        pytest.skip("not all lessons were run")
    assert sum(_seconds.values()) / len(_seconds) <= MEAN_SECONDS, _seconds
