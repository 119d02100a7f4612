"""All answers of a folder, on several processors: whatever happens to one of them, the others are graded.

A worker is a process that draws inputs, runs answers in a sandbox of its own and compares. Where the comparison itself
takes too long or ends the worker (a value can be made for that), the worker is replaced and the answer says so.
"""

import contextlib
import multiprocessing
import os
import signal
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from pathlib import Path

from course_lib.classroom.assignment_cells import Assignment, read_assignments
from course_lib.classroom.confinement import Limits
from course_lib.classroom.judging import Graded, Task, grade, not_judged
from course_lib.classroom.model_answers import function_name
from course_lib.classroom.probe import missing_protections
from course_lib.classroom.sandbox import Sandbox, SandboxError, remove
from course_lib.classroom.submissions import Collection, collect
from course_lib.files import temporary_folder
from course_lib.lessons.kit.projects import find_project

JUDGE_SECONDS = 300.0
SCORE_SECONDS = 7200.0
"""Beyond an answer's own time: drawing, references and known mistakes take seconds, also on a slow machine."""
START_SECONDS = 900.0


@dataclass(frozen=True)
class Results:
    """What a folder's grading came to.

    graded: every answer, by student and exercise. assignments: the lessons that somebody handed in. seed: the same one
    gives the same results again. missing: protections that this machine did not give.
    """

    collection: Collection
    assignments: tuple[Assignment, ...]
    graded: tuple[Graded, ...]
    seed: int
    missing: tuple[str, ...] = ()


def grade_folder(
    folder: Path,
    seed: int,
    jobs: int = 1,
    limits: Limits | None = None,
    trusted: bool = False,
    scores: bool = False,
    progress: Callable[[Iterator[Graded], int], Iterable[Graded]] = lambda graded, total: graded,
) -> Results:
    """Grade all submissions in a folder. `progress` wraps the iterator over answers and is given its length.

    scores: also run each project's last function in the worlds of the seed, which takes minutes a submission.
    Raises `SubmissionError` for what is no folder, `SandboxError` where this machine lacks a wall and it is not
    `trusted`.
    """
    limits = limits or Limits()
    known = {assignment.name: assignment for assignment in read_assignments()}
    collection = collect(folder, [assignment.path.stem for assignment in known.values()])
    assignments = tuple(known[name] for name in sorted({one.lesson for one in collection.submissions}))
    tasks = [
        Task(one.student, one.lesson, one.path, exercise.number, function_name(exercise.stub))
        for one in collection.submissions
        for exercise in known[one.lesson].exercises()
    ]
    if scores:
        projects = [one for one in collection.submissions if known[one.lesson].is_project]
        tasks += [
            Task(one.student, one.lesson, one.path, one.lesson, find_project(one.lesson).function) for one in projects
        ]
    with working_folder() as scratch:
        missing = missing_protections(scratch / "probe", limits)
        if missing and not trusted:
            raise SandboxError(
                "nothing was run, since this machine does not keep strangers' code in: "
                + "; ".join(missing)
                + ". Grade on Linux 5.13 or newer (a virtual machine will do), or, where you trust every student and "
                "every file, add --trusted"
            )
        graded = list(progress(_graded(tasks, scratch, seed, jobs, limits, trusted), len(tasks)))
    return Results(collection, assignments, tuple(sorted(graded, key=_order)), seed, tuple(missing))


def _order(graded: Graded) -> tuple[str, str]:
    return graded.student, graded.number


@contextlib.contextmanager
def working_folder() -> Iterator[Path]:
    """A folder for everything that is written meanwhile; it goes, however the grading ends."""
    with temporary_folder() as path:
        try:
            yield path
        finally:
            for _ in range(50):  # processes that were killed a moment ago may still hold a file
                remove(path)
                if not path.exists():
                    break
                time.sleep(0.1)


# Workers


def _graded(
    tasks: Sequence[Task], scratch: Path, seed: int, jobs: int, limits: Limits, trusted: bool
) -> Iterator[Graded]:
    """Every task's result, in the order in which they come."""
    waiting = list(reversed(tasks))
    workers = [
        _Worker(scratch / f"worker-{number}", seed, limits, trusted) for number in range(min(jobs, len(tasks)) or 1)
    ]
    try:
        while waiting or any(worker.task for worker in workers):
            for worker in workers:
                if worker.task is None and waiting:
                    worker.give(waiting.pop())
            busy = {worker.connection: worker for worker in workers if worker.task}
            ready = wait(list(busy), timeout=0.5)
            for worker in busy.values():
                result = worker.result(worker.connection in ready)
                if result is not None:
                    yield result
    finally:
        for worker in workers:
            worker.end()


class _Worker:
    """One worker as the grader sees it: a task at a time, ended and begun anew where it takes too long."""

    def __init__(self, folder: Path, seed: int, limits: Limits, trusted: bool) -> None:
        self._settings = (folder, seed, limits, trusted)
        self._limits = limits
        self._begun = 0
        self.task: Task | None = None
        self._start()

    def _start(self) -> None:
        context = multiprocessing.get_context("spawn")
        folder, *rest = self._settings
        self.connection, theirs = context.Pipe()
        self._begun += 1
        self._process = context.Process(
            target=work, args=(theirs, folder.with_name(f"{folder.name}-{self._begun}"), *rest), daemon=True
        )
        self._process.start()
        theirs.close()
        self._fresh = True

    def give(self, task: Task) -> None:
        self.task = task
        most = SCORE_SECONDS if task.number == task.lesson else self._limits.seconds + JUDGE_SECONDS
        self._deadline = time.monotonic() + most + START_SECONDS * self._fresh
        with contextlib.suppress(OSError):  # the worker has died: `result` will say so
            self.connection.send(task)

    def result(self, is_ready: bool) -> Graded | None:
        """The task's result; None where it is not there yet."""
        if is_ready:
            try:
                found = self.connection.recv()
            except (EOFError, OSError):
                found = "the grader's process ended while it looked at this answer"
        elif time.monotonic() > self._deadline:
            found = "comparing this answer took too long"
        else:
            return None
        task, self.task, self._fresh = self.task, None, False
        if isinstance(found, Graded):
            return found
        self.end()
        self._start()
        return not_judged(task, "wrong", f"Could not be judged: {found}.")

    def end(self) -> None:
        """End the process, whatever it does; its sandbox dies with it."""
        self.connection.close()
        self._process.kill()
        self._process.join()


def work(connection: Connection, folder: Path, seed: int, limits: Limits, trusted: bool) -> None:
    """A worker's life: tasks in, results out; an error is sent as its text."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the grader's, who then ends the workers
    _end_with_parent()
    with Sandbox(folder, trusted) as sandbox:
        while True:
            try:
                task = connection.recv()
            except (EOFError, OSError):
                return
            try:
                connection.send(grade(task, sandbox, seed, limits))
            except Exception as error:
                connection.send(f"{type(error).__name__}: {error}"[:300])


def _end_with_parent() -> None:
    if sys.platform == "linux":
        from course_lib.classroom.confinement import die_with_parent

        parent = os.getppid()
        die_with_parent()
        if os.getppid() != parent:
            os._exit(0)
