"""One case of `interrupt`: its two undisturbed runs, then as many that are stopped on the way from old to new."""

from __future__ import annotations

import contextlib
import shutil
import signal
import time
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from course_lib.commands.interrupt_cases import Case
from course_lib.commands.stopped_runs import Ended, Moment, Runs
from course_lib.commands.whole_outputs import Tree, left_over, put_back, state, tree
from course_lib.paths import data_path

LONGEST_DELAY_S = 0.005  # after a step: a file of some megabytes is being written then
STOPPED = 130  # exit code after Ctrl-C


class InterruptionError(RuntimeError):
    """A case that tells nothing: its run fails undisturbed, or makes the same twice."""


class Staged:
    """A case with its folders, its undisturbed outputs, and a process to run it in; a context manager.

    old, new: its files after its first and its second run.
    """

    def __init__(self, case: Case, folder: Path) -> None:
        self.case, self.given = case, folder / "given"
        self.stage = folder / "stage"
        self.out = self.stage / "out"
        self.out.mkdir(parents=True)
        self.given.mkdir()
        case.prepare(self.given, self.out)

    def __enter__(self) -> Staged:
        with Runs(self.stage) as cold:
            if self.case.kept:
                self._undisturbed(cold, 2)
            self.old, ended = self._undisturbed(cold, 1)
        with contextlib.ExitStack() as context:
            self.modules = ended.modules
            self.runs = context.enter_context(Runs(self.stage, self.modules))
            self.begin_anew()
            self.runs.run("", [], {})  # imports what the others need
            began = time.monotonic()
            self.new, ended = self._undisturbed(self.runs, 2)
            self.seconds, self.steps = time.monotonic() - began, ended.steps
            if self.old == self.new:
                raise InterruptionError(f"{self.case.name}: both runs made the same: nothing could be told apart")
            self._context = context.pop_all()
        return self

    def __exit__(self, *_: object) -> None:
        self._context.close()

    def words(self, which: int) -> list[str]:
        """The words of its first or second run."""
        return [word.format(**self._places(which)) for word in self.case.words.split()]

    def environment(self, which: int) -> dict[str, str]:
        """The environment variables of a run."""
        name, _, value = self.case.environment.format(**self._places(which)).partition("=")
        return {name: value} if name else {}

    def run(self, which: int, moment: Moment | None = None) -> Ended:
        """Runs it, and stops it at a moment."""
        return self.runs.run(self.case.program, self.words(which), self.environment(which), moment)

    def begin_anew(self) -> None:
        """The old, and nothing beside it."""
        for path in self.stage.iterdir():
            if path.is_dir():
                shutil.rmtree(path)
            else:
                path.unlink()
        put_back(self.out, self.old)

    def _places(self, which: int) -> dict[str, object]:
        return {"out": self.out, "given": self.given, "data": data_path("corridor").parent, "which": which}

    def _undisturbed(self, runs: Runs, which: int) -> tuple[Tree, Ended]:
        ended = runs.run(self.case.program, self.words(which), self.environment(which))
        if ended.code != 0 or left_over(self.stage, self.out):
            raise InterruptionError(
                f"{self.case.name} undisturbed: exit code {ended.code}, left {left_over(self.stage, self.out)}; "
                f"{ended.complained[-1000:]}"
            )
        return tree(self.out), ended


def interruptions(staged: Staged, moments: Iterable[Moment]) -> dict:
    """Stops a case at these moments, each on its way from the old to the new; what was found, counted.

    After one that left something, or stands between, the next run must clear and complete it.
    """
    counts = dict.fromkeys(("moments", "old", "new", "between", "broken", "cleared", "left"), 0)
    faults = []
    for moment in moments:
        staged.begin_anew()
        ended = staged.run(2, moment)
        files, left = tree(staged.out), left_over(staged.stage, staged.out)
        found = state(files, staged.old, staged.new, staged.case.by_file)
        counts["moments"] += 1
        counts[found] += 1
        wrong = [f"broken: {sorted(files)}"] * (found == "broken")
        if moment.signal == signal.SIGINT:
            wrong += [f"left {left}"] * bool(left) + (wrong_end(ended) if staged.case.is_command else [])
        if left or found in ("between", "broken"):
            staged.run(2)
            still = left_over(staged.stage, staged.out)
            counts["cleared"] += bool(left) and not still
            if still or state(tree(staged.out), staged.old, staged.new) != "new":
                counts["left"] += 1
                wrong.append(f"the next run left {still}, {sorted(tree(staged.out))}")
        faults += [f"{staged.case.name}, {moment}: {what}" for what in wrong]
    return counts | {"seconds": round(staged.seconds, 2), "steps": staged.steps, "faults": faults}


def wrong_end(ended: Ended) -> list[str]:
    """What is wrong about a command's end after Ctrl-C: it says so in a line, without a traceback; exit code 130."""
    if ended.code == 0:  # it was done before
        return []
    if ended.code != STOPPED or "Traceback" in ended.complained:
        return [f"exit code {ended.code}, {ended.complained[-2000:]}"]
    return []


def drawn_kills(staged: Staged, count: int, random: np.random.Generator) -> list[Moment]:
    """Moments of kill -9, by turns at a step, by the clock, shortly after a step, by the clock."""
    kills = []
    steps = max(staged.steps, 1)  # none are seen where a command's own child writes: then the clock alone stops it
    for index in range(count):
        at_a_step = Moment(step=int(random.integers(1, steps + 1)))
        delay, share = random.uniform(0, LONGEST_DELAY_S), random.uniform()
        by_the_clock = Moment(seconds=share * staged.seconds)
        kills.append((at_a_step, by_the_clock, at_a_step._replace(delay=delay), by_the_clock)[index % 4])
    return kills


def drawn_ctrl_c(staged: Staged, count: int, random: np.random.Generator) -> list[Moment]:
    """Moments of Ctrl-C, at steps."""
    steps = random.integers(1, max(staged.steps, 1) + 1, count)
    return [Moment(step=int(step), signal=signal.SIGINT) for step in steps]
