"""Projects: two to four hours of work, scored with a number that can always be improved.

`score("P1", function)` runs the student's function on the project's hidden seeds and prints a line for each seed. Then
it prints the median beside the medians of the paper's method and ours, on the same seeds. For development,
`score("P1", function, seeds=[...])` runs it on seeds that the student chooses. The stages of a project are exercises
("P1.1") in `courseware/answers/project_1.py`. The project itself is `PROJECT` in `project_1_task.py` next to it:

    PROJECT = Project(
        name="P1", title="...", unit="m", better="lower", digits=3, function="localize",
        seeds=(...),                       # hidden: the notebook prints none of them
        prepare=lambda seed: Task(arguments, truth),
        measure=lambda task, answer: Result(value, "a remark"),   # or it raises AnswerError
        rivals=(Rival("paper", "the paper's own method", f), Rival("ours", "ours", g)),
    )

`python -m courseware.lessons.kit.score P1 --store` stores the rivals' results in `courseware/answers/project_1.json`.
"""

import importlib
import json
import re
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np

from courseware.experiments.intervals import median_interval
from courseware.experiments.results import write_results
from courseware.lessons.kit.attempt import Attempt, attempt
from courseware.lessons.kit.exercises import answers_folder, is_stub, show_printed
from courseware.lessons.kit.forbidden import forbidden_module
from courseware.lessons.kit.hints import kind_of
from courseware.lessons.kit.progress_bar import progress
from courseware.paths import REPOSITORY


class Task(NamedTuple):
    """The task of one seed. arguments: for the student's function. truth: `measure` compares the answer with it."""

    arguments: tuple
    truth: object


class Result(NamedTuple):
    """The result of one answer: the value that counts, and a remark for the reader."""

    value: float
    remark: str = ""


class AnswerError(ValueError):
    """An answer that cannot be measured. Its text completes "Your function ...", such as "returns 3 states, not 40"."""


class UnknownProjectError(LookupError):
    """No project has this name."""


class Rival(NamedTuple):
    """A method that we compare with the student's. It runs on the same seeds and by the same rules."""

    key: Literal["paper", "ours", "none", "other"]
    name: str
    function: Callable


@dataclass(frozen=True)
class Project:
    """One project.

    name: "P1". title: the measured quantity in words. unit: of the value, "" for none. better: whether lower or higher
    values win. digits: decimals of a printed value. function: the name of the student's function, in the notebook and
    in a submitted file. seeds: hidden, at least six, because fewer have no interval. prepare: makes a seed's `Task`.
    measure: makes the `Result` of an answer. rivals: the methods to compare with. seconds: time limit of one call.
    many: True if a task holds the arguments of many calls, a tuple for each; its answer is the list of their results.
    forbidden: modules that a submission may not use. rule: `rule(task, function, answer)` gets the task as `prepare`
    made it and raises `AnswerError` if the answer came about against the rules.
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
    forbidden: tuple[str, ...] = ()
    rule: Callable[[Task, Callable, object], None] | None = None

    @property
    def worst(self) -> float:
        """Return the value of a seed on which the function fails."""
        return np.inf if self.better == "lower" else -np.inf

    def told(self, value: float) -> str:
        """Return a value as text, with its unit."""
        return f"{value:.{self.digits}f} {self.unit}".rstrip()


class Outcome(NamedTuple):
    """The outcome of one seed. If the function failed, the remark says how."""

    value: float
    remark: str
    failed: bool = False
    out_of_time: bool = False
    printed: str = ""


def find_project(name: str) -> Project:
    """Return the project of this name. Raises `UnknownProjectError`, which lists all names."""
    if name not in (names := project_names()):
        raise UnknownProjectError(f"there is no project {name!r}; there are {', '.join(names)}")
    return importlib.import_module(f"courseware.answers.project_{name[1:]}_task").PROJECT


def project_names() -> list[str]:
    """Return the names ("P1") of the projects."""
    found = (re.fullmatch(r"project_(\d)_task\.py", path.name) for path in answers_folder().iterdir())
    return sorted(f"P{match[1]}" for match in found if match)


def score(name: str, function: Callable, seeds: Sequence[int] | None = None, rivals: bool = True) -> None:
    """Print the score of `function` in project `name`, on the hidden seeds or on `seeds` that you choose.

    The rivals' results on the hidden seeds are stored. On your seeds the rivals run too, unless `rivals` is False.
    Raises `ValueError` if there is no seed, or one is negative or hidden.
    """
    project = find_project(name)
    if not callable(function):
        print(f"{name}: give the function itself, without calling it; this is a {kind_of(function)}.")
    elif is_stub(function):
        print(f"{name}: not attempted yet. Replace the `...` of {function.__name__}, then run this cell again.")
    elif (module := forbidden_module(function, project.forbidden)) is not None:
        print(f"{name}: your function uses {module}, which this project asks you to write yourself.")
    elif seeds is None:
        names = [f"hidden seed {number}" for number, _ in enumerate(project.seeds, start=1)]
        report(project, names, outcomes(project, function, project.seeds), dict(stored_rivals(project).values()))
    else:
        seeds = [int(seed) for seed in np.atleast_1d(seeds)]
        if not seeds or min(seeds) < 0:
            raise ValueError(f"seeds must be one or more whole numbers, each 0 or larger; got {seeds!r}")
        if set(seeds) & set(project.seeds):
            raise ValueError("one of these seeds is hidden: choose other seeds for development, such as 10001")
        others = {
            rival.name: [outcome.value for outcome in outcomes(project, rival.function, seeds, rival.name)]
            for rival in (project.rivals if rivals else ())
        }
        report(project, [f"seed {seed}" for seed in seeds], outcomes(project, function, seeds), others)


def outcomes(project: Project, function: Callable, seeds: Sequence[int], who: str = "your function") -> list[Outcome]:
    """Return the outcome of every seed. After a seed that takes too long, no other seed runs."""
    found: list[Outcome] = []
    for seed in progress(seeds, f"{project.name}, {who}"):
        if found and found[-1].out_of_time:
            found.append(Outcome(project.worst, "not run: the seed before took too long", True, True))
        else:
            found.append(one_outcome(project, function, seed))
    return found


def one_outcome(project: Project, function: Callable, seed: int) -> Outcome:
    """Run a function on one seed and return the outcome, even if the function fails."""
    task = project.prepare(seed)
    started = time.monotonic()
    trial = _answered(project, function, task)
    if trial.failure is not None:
        late = time.monotonic() - started >= project.seconds
        return Outcome(project.worst, f"Your function {trial.failure}", True, late, trial.printed)
    try:
        result = project.measure(task, trial.value)
        if project.rule is not None:
            project.rule(project.prepare(seed), function, trial.value)
    except AnswerError as error:
        return Outcome(project.worst, f"Your function {error}.", True, printed=trial.printed)
    if not np.isfinite(result.value):
        return Outcome(project.worst, f"failed: {result.remark or 'no number came of it'}", True, printed=trial.printed)
    return Outcome(float(result.value), result.remark, printed=trial.printed)


def _answered(project: Project, function: Callable, task: Task) -> Attempt:
    """Return a function's answer to a task. If the project asks for many calls, it is the list of their answers."""
    if not project.many:
        return attempt(function, task.arguments, project.seconds)
    trials: list[Attempt] = []
    for arguments in task.arguments:
        trials.append(attempt(function, arguments, project.seconds))
        if trials[-1].failure is not None:
            return trials[-1]
    return Attempt([trial.value for trial in trials], None, trials[0].printed)


def report(project: Project, names: Sequence[str], found: Sequence[Outcome], others: dict[str, list[float]]) -> None:
    """Print a line for each seed, the median with its interval, the rivals' medians, and the next rival to beat.

    names: of the seeds. others: name of a rival -> its value for each seed. The text that the function itself printed
    on the first seed comes first.
    """
    show_printed(found[0].printed)
    print(f"{project.name}: {project.title}; {project.better} is better")
    for name, outcome in zip(names, found, strict=True):
        remark = f" ({outcome.remark})" if outcome.remark else ""
        print(f"{name}: {outcome.remark if outcome.failed else project.told(outcome.value) + remark}")
    values = [outcome.value for outcome in found]
    width = max(map(len, ["yours", *others]))
    print(f"{'yours':<{width}}  {_median(project, values)}")
    for name, theirs in others.items():
        wins = sum(is_better(project, mine, other) for mine, other in zip(values, theirs, strict=True))
        print(f"{name:<{width}}  {_median(project, theirs)}; yours is better on {wins} of {len(theirs)}")
    if others:
        print(_to_beat(project, float(np.median(values)), {name: np.median(theirs) for name, theirs in others.items()}))


def _median(project: Project, values: Sequence[float]) -> str:
    """Return the median over the seeds in words, with its 95 % interval if no seed failed and there are enough."""
    failed, middle = sum(not np.isfinite(value) for value in values), float(np.median(values))
    if not np.isfinite(middle):
        return f"no median: {failed} of {len(values)} seeds failed"
    interval = {"low": None} if failed else median_interval(values)
    if interval["low"] is None:
        lost = f", {failed} of {len(values)} failed" if failed else ""
        return f"median {project.told(middle)} over {len(values)} seed{'s' * (len(values) > 1)}{lost}"
    low, high = (f"{interval[end]:.{project.digits}f}" for end in ("low", "high"))
    return f"median {project.told(middle)} (95 % interval {low} to {high} over {len(values)} seeds)"


def is_better(project: Project, value: float, other: float) -> bool:
    """Return whether `value` is strictly better than `other`."""
    return value < other if project.better == "lower" else value > other


def _to_beat(project: Project, mine: float, others: dict[str, float]) -> str:
    """Return a sentence that says what the student can beat next. mine, others: medians."""
    if not np.isfinite(mine):
        return "To beat: get it to run on every seed first."
    ahead = {name: abs(theirs - mine) for name, theirs in others.items() if not is_better(project, mine, theirs)}
    if not ahead:
        return "You beat all of them. To beat: your own number; it can always be better."
    nearest = min(ahead, key=ahead.get)
    return f"To beat next: {nearest}, which is ahead of yours by {project.told(ahead[nearest])}."


# The rivals' results on the hidden seeds are computed once and stored. A test computes them again and compares.


def rivals_file(project: Project) -> str:
    """Return the name of the file with the rivals' results: project_1.json for P1."""
    return f"project_{project.name[1:]}.json"


def stored_rivals(project: Project) -> dict[str, tuple[str, list[float]]]:
    """Return key -> (name, values on the hidden seeds) of the rivals. Raises `ValueError` if the file is outdated."""
    path = answers_folder() / rivals_file(project)
    stored = json.loads(path.read_text(encoding="utf-8"))
    keys = [rival.key for rival in project.rivals]
    if stored["seeds"] != list(project.seeds) or list(stored["rivals"]) != keys:
        raise ValueError(
            f"{path} holds other seeds or rivals: run "
            f"`python -m courseware.lessons.kit.score {project.name} --store` again"
        )
    return {key: (rival["name"], rival["values"]) for key, rival in stored["rivals"].items()}


def store_rivals(project: Project) -> Path:
    """Run the rivals on the hidden seeds, write their results into courseware/answers, and return the path."""
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
    path = REPOSITORY / "courseware" / "answers" / rivals_file(project)
    units = {"title": project.title, "unit": project.unit, "better": project.better}
    write_results(path, {"project": project.name, **units, "seeds": list(project.seeds), "rivals": rivals})
    return path
