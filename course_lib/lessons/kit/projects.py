"""Projects: two to four hours of work whose end is scored by a number that can always be better.

`score("P1", function)` runs the student's function on the hidden seeds of the project, a line a seed, and tells the
median beside the paper's own method and ours on the same seeds. `score("P1", function, seeds=[...])` runs it on seeds
of the student's own, for development. Stages on the way there are exercises ("P1.1"), in `exercises.py` of the folder
`course_lib/lessons/project_1/`; the project itself is `PROJECT` in its `project.py`:

    PROJECT = Project(
        name="P1", title="...", unit="m", better="lower", digits=3, function="localize",
        seeds=(...),                       # hidden: others than any that the notebook prints
        prepare=lambda seed: Task(arguments, truth),
        measure=lambda task, answer: Result(value, "what else is worth a line"),   # AnswerError: a sentence
        rivals=(Rival("paper", "the paper's own method", f), Rival("ours", "ours", g)),
    )

What the rivals reach is stored in data/projects/P1.json by `python -m course_lib.lessons.kit.score P1 --store`.
"""

from __future__ import annotations

import importlib
import json
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np

from course_lib.experiments.intervals import median_interval
from course_lib.experiments.results import write_results
from course_lib.lessons.kit.attempt import Attempt, attempt
from course_lib.lessons.kit.exercises import SHOWN, is_stub
from course_lib.lessons.kit.hints import kind_of
from course_lib.lessons.kit.progress_bar import progress
from course_lib.paths import REPOSITORY, data_path


class Task(NamedTuple):
    """What one seed asks. arguments: given to the student's function. truth: whatever `measure` compares with."""

    arguments: tuple
    truth: object


class Result(NamedTuple):
    """What an answer is worth: the number that is ranked, and what else is worth saying of it."""

    value: float
    remark: str = ""


class AnswerError(ValueError):
    """An answer that cannot be measured; its text ends the sentence "Your function ...": "returns 3 states, not 40"."""


class UnknownProjectError(KeyError):
    """There is no project of that name."""

    def __str__(self) -> str:
        return str(self.args[0])


@dataclass(frozen=True)
class Rival:
    """A method whose result on the hidden seeds stands beside the student's: a submission like any other."""

    key: Literal["paper", "ours", "none", "other"]
    name: str
    function: Callable


@dataclass(frozen=True)
class Project:
    """One project.

    name: "P1". title: what is measured, in words. unit: of the number, "" for none. better: which way is up. digits:
    after the point. function: what the student's function is called in the notebook and in a file that is handed in.
    seeds: the hidden ones, at least six (fewer have no interval). prepare: a seed's `Task`. measure: what an answer to
    it is worth. rivals: what to compare with. seconds: longest time that one call of the student's function may take.
    many: a task's arguments are those of many calls, a tuple for each, and the answer is the list of what they return.
    """

    name: str
    title: str
    unit: str
    better: Literal["lower", "higher"]
    digits: int
    function: str
    seeds: tuple[int, ...]
    prepare: Callable[[int], Task]
    measure: Callable[[Task, object], Result]
    rivals: tuple[Rival, ...]
    seconds: float = 120.0
    many: bool = False

    @property
    def worst(self) -> float:
        """What a seed counts on which the function fails."""
        return np.inf if self.better == "lower" else -np.inf

    def told(self, value: float) -> str:
        """A value with its digits and unit."""
        return f"{value:.{self.digits}f} {self.unit}".rstrip() if np.isfinite(value) else "failed"


class Outcome(NamedTuple):
    """What came of one seed: the value, a remark, and whether it failed (the remark then says how)."""

    value: float
    remark: str
    failed: bool = False
    out_of_time: bool = False
    printed: str = ""


def find_project(name: str) -> Project:
    """The project of that name. Raises `UnknownProjectError`, which names those that there are."""
    names = project_names()
    if name not in names:
        raise UnknownProjectError(f"there is no project {name!r}; there are {', '.join(names)}")
    return importlib.import_module(f"course_lib.lessons.project_{name[1:]}.project").PROJECT


def project_names() -> list[str]:
    """Names ("P1") of the projects."""
    folders = Path(__file__).parents[1].glob("project_[0-9]/project.py")
    return sorted(f"P{path.parent.name.removeprefix('project_')}" for path in folders)


def score(name: str, function: Callable, seeds: Sequence[int] | None = None, rivals: bool = True) -> None:
    """Print what `function` reaches in project `name`: on its hidden seeds, or for development on `seeds` of your own.

    On the hidden seeds the rivals' results are stored; on seeds of your own they run too, unless `rivals` is False.
    """
    project = find_project(name)
    if not callable(function):
        print(f"{name}: give the function itself, without calling it; this is a {kind_of(function)}.")
    elif is_stub(function):
        print(f"{name}: not attempted yet. Replace the `...` of {function.__name__}, then run this cell again.")
    elif seeds is None:
        report(project, outcomes(project, function, project.seeds), stored_rivals(project), hidden=True)
    else:
        seeds = own_seeds(project, seeds)
        others = {
            rival.key: (rival.name, [outcome.value for outcome in outcomes(project, rival.function, seeds, rival.name)])
            for rival in (project.rivals if rivals else ())
        }
        report(project, outcomes(project, function, seeds), others, seeds=seeds)


def own_seeds(project: Project, seeds: Sequence[int]) -> list[int]:
    """The seeds that somebody develops on. Raises `ValueError` for none, bad ones, or hidden ones."""
    numbers = [int(seed) for seed in np.atleast_1d(seeds)]
    if not numbers or min(numbers) < 0:
        raise ValueError(f"seeds must be whole numbers, 0 or more, at least one; got {seeds!r}")
    if set(numbers) & set(project.seeds):
        raise ValueError("one of these seeds is a hidden one: choose others to develop on, such as 10001")
    return numbers


def outcomes(project: Project, function: Callable, seeds: Sequence[int], who: str = "your function") -> list[Outcome]:
    """Outcome of every seed, with a progress bar; none runs after one that takes too long."""
    found: list[Outcome] = []
    for seed in progress(seeds, f"{project.name}, {who}"):
        if found and found[-1].out_of_time:
            found.append(Outcome(project.worst, "not run: the seed before took too long", True, True))
        else:
            found.append(one_outcome(project, function, seed))
    return found


def one_outcome(project: Project, function: Callable, seed: int) -> Outcome:
    """What a function reaches on one seed, whatever it does."""
    task = project.prepare(seed)
    started = time.monotonic()
    trial = answered(project, function, task)
    if trial.failure is not None:
        late = time.monotonic() - started >= project.seconds
        return Outcome(project.worst, f"Your function {trial.failure}", True, late, trial.printed)
    try:
        result = project.measure(task, trial.value)
    except AnswerError as error:
        return Outcome(project.worst, f"Your function {error}.", True, printed=trial.printed)
    if not np.isfinite(result.value):
        return Outcome(project.worst, f"failed: {result.remark or 'no number came of it'}", True, printed=trial.printed)
    return Outcome(float(result.value), result.remark, printed=trial.printed)


def answered(project: Project, function: Callable, task: Task) -> Attempt:
    """What a function answers to a task: one value, or where the task asks for many calls the list of theirs."""
    if not project.many:
        return attempt(function, task.arguments, project.seconds)
    answers, printed = [], ""
    for index, arguments in enumerate(task.arguments):
        trial = attempt(function, arguments, project.seconds)
        printed = printed if index else trial.printed
        if trial.failure is not None:
            return trial
        answers.append(trial.value)
    return Attempt(answers, None, printed)


def report(
    project: Project,
    found: Sequence[Outcome],
    others: dict[str, tuple[str, list[float]]],
    hidden: bool = False,
    seeds: Sequence[int] = (),
) -> None:
    """Print a line a seed, the median with its interval, the rivals' beside it, and what is still to beat.

    What the function itself printed on the first seed stands before it.
    """
    if found[0].printed:
        print(f"(your function prints) {found[0].printed[:SHOWN].rstrip()}")
    print(f"{project.name}: {project.title}; {project.better} is better")
    names = [f"hidden seed {i + 1}" for i in range(len(found))] if hidden else [f"seed {seed}" for seed in seeds]
    for name, outcome in zip(names, found, strict=True):
        if outcome.failed:
            print(f"{name}: {outcome.remark}")
        else:
            print(f"{name}: {project.told(outcome.value)}" + (f" ({outcome.remark})" if outcome.remark else ""))
    values = [outcome.value for outcome in found]
    width = max(len(name) for name in ["yours", *(name for name, _ in others.values())])
    print(f"{'yours':<{width}}  {told_median(project, values)}")
    for name, theirs in others.values():
        print(f"{name:<{width}}  {told_median(project, theirs)}; {told_wins(project, values, theirs)}")
    if others:
        print(to_beat(project, values, others))


def told_median(project: Project, values: Sequence[float]) -> str:
    """The median of values over seeds, with its 95 % interval where there are enough that did not fail."""
    failed = sum(not np.isfinite(value) for value in values)
    lost = f", {failed} of {len(values)} failed" if failed else ""
    middle = float(np.median(values))
    if not np.isfinite(middle):
        return f"no median: {failed} of {len(values)} seeds failed"
    interval = median_interval(values) if not failed else {"low": None, "high": None}
    if interval["low"] is None:
        return f"median {project.told(middle)} over {len(values)} seed{'s' * (len(values) > 1)}{lost}"
    low, high = (f"{interval[end]:.{project.digits}f}" for end in ("low", "high"))
    return f"median {project.told(middle)} (95 % interval {low} to {high} over {len(values)} seeds)"


def told_wins(project: Project, values: Sequence[float], theirs: Sequence[float]) -> str:
    """On how many of the seeds the student's function did better."""
    wins = sum(is_better(project, mine, other) for mine, other in zip(values, theirs, strict=True))
    return f"yours is better on {wins} of {len(theirs)}"


def is_better(project: Project, value: float, other: float) -> bool:
    """Whether a value is strictly better than another."""
    return value < other if project.better == "lower" else value > other


def to_beat(project: Project, values: Sequence[float], others: dict[str, tuple[str, list[float]]]) -> str:
    """One sentence: what is still to beat."""
    mine = float(np.median(values))
    if not np.isfinite(mine):
        return "To beat: get it to run on every seed first."
    ahead = [
        (float(np.median(theirs)), name)
        for name, theirs in others.values()
        if not is_better(project, mine, np.median(theirs))
    ]
    if not ahead:
        return "You beat all of them. To beat: your own number; it can always be better."
    best, name = min(ahead, key=lambda pair: abs(pair[0] - mine))
    return f"To beat next: {name}, which is ahead of yours by {project.told(abs(best - mine))}."


# What the rivals reach on the hidden seeds: made once, stored, and compared with a recomputation by a test.


def stored_rivals(project: Project) -> dict[str, tuple[str, list[float]]]:
    """The rivals' values on the hidden seeds by key, with their names. Raises `ValueError` for stale numbers."""
    stored = json.loads(data_path(f"projects/{project.name}.json").read_text(encoding="utf-8"))
    keys = [rival.key for rival in project.rivals]
    if stored["seeds"] != list(project.seeds) or list(stored["rivals"]) != keys:
        raise ValueError(
            f"data/projects/{project.name}.json is of other seeds or rivals: run the command `store` again"
        )
    return {key: (rival["name"], rival["values"]) for key, rival in stored["rivals"].items()}


def store_rivals(project: Project) -> Path:
    """Run the rivals on the hidden seeds and write what they reach to data/projects/."""
    rivals = {}
    for rival in project.rivals:
        found = outcomes(project, rival.function, project.seeds, rival.name)
        if any(outcome.failed for outcome in found):
            raise RuntimeError(f"{rival.name}: {next(o.remark for o in found if o.failed)}")
        rivals[rival.key] = {
            "name": rival.name,
            "values": [round(outcome.value, project.digits + 3) for outcome in found],
            "remarks": [outcome.remark for outcome in found],
        }
    path = REPOSITORY / "data" / "projects" / f"{project.name}.json"
    units = {"title": project.title, "unit": project.unit, "better": project.better}
    write_results(path, {"project": project.name, **units, "seeds": list(project.seeds), "rivals": rivals})
    return path
