"""The judge of every way of grading: a submission runs in the sandbox, and its answers are compared here.

What decides is never in reach of the student's code, which gets arguments and gives values. A sentence for the student
holds no input, no value and no word of the student's own making, because such a word could carry an input out. The
teacher's remarks hold all of it.
"""

import builtins
import contextlib
import pickle
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np

from courseware.classroom.exchange import AnswerFormatError, decode, one_line
from courseware.classroom.points import SCORE_POINTS, earned, lesson_of, most_of, secret
from courseware.classroom.sandbox import Limits, Run, Sandbox
from courseware.classroom.worlds import graded_project, score_points, score_sentence
from courseware.lessons.kit.exercise import Exercise
from courseware.lessons.kit.exercises import SEE_CHECK, fault, find_exercise, right_on
from courseware.lessons.kit.projects import AnswerError, Outcome, Project

Status = Literal["right", "partly right", "wrong", "not attempted"]
FAILURES = {
    "does not end": "does not end in time", "prints": "prints without end", "calls exit": "calls exit() or quit()",
    "calls itself": "calls itself without end", "takes more": "takes too much memory", "crashes": "crashes",
    "starts more": "starts too many processes",
}  # fmt: skip
"""What a student reads of a failure that begins so."""


class Settings(NamedTuple):
    """How files are judged. functions: "06.1" -> "raw_score" for each exercise and project. scores: projects' too."""

    functions: dict[str, str]
    seed: int
    library: Path
    limits: Limits = Limits()
    trust: bool = False
    scores: bool = False


@dataclass
class Graded:
    """What one answer earned. sentence: for the student. remarks, printed: for the teacher alone."""

    number: str
    status: Status = "not attempted"
    points: float = 0
    sentence: str = "Not attempted."
    right_inputs: int = 0
    inputs: int = 0
    remarks: list[str] = field(default_factory=list)
    printed: str = ""

    @property
    def most(self) -> int:
        return most_of(self.number)


@dataclass
class Judged:
    """What one file came to. why: why it was not read, or "". stopped: which of its statements stop.

    shapes: digests of the answers' syntax trees.
    """

    lessons: list[str] = field(default_factory=list)
    answers: list[Graded] = field(default_factory=list)
    problems: list[str] = field(default_factory=list)
    tries: dict[str, int] = field(default_factory=dict)
    recalled: list[list[str]] = field(default_factory=list)
    shapes: dict[str, str] = field(default_factory=dict)
    stopped: list[str] = field(default_factory=list)
    why: str = ""


def judge(path: Path, settings: Settings, guess: str = "") -> Judged:
    """Judge one file. guess: the lesson that its name says."""
    functions, seed, library, limits, trust, scores = settings
    try:
        with Sandbox(path, library, limits, trust) as box:
            if "unreadable" in box.opened:
                return Judged(why=f"the file {one_line(box.opened['unreadable'])}")
            found = _opened(box.opened)
            lessons = lessons_of(found.pop("exercises"), found.pop("functions"), functions, guess)
            judged = Judged(lessons, **found)
            asked = {number: name for number, name in functions.items() if lesson_of(number) in lessons}
            judged.shapes = {number: judged.shapes[name] for number, name in asked.items() if name in judged.shapes}
            judged.answers = [
                judge_answer(find_exercise(number), name, box, seed) for number, name in asked.items() if "." in number
            ]
    except AnswerFormatError as error:
        return Judged(why=f"the file could not be read: its process {error}")
    if not lessons:
        judged.why = "the file does not say which lesson it is: it has no exercise's cell and no exercise's function"
    for name in [name for name in asked if scores and "." not in name]:
        try:
            judged.answers.append(judge_score(name, path, settings))
        except AnswerFormatError as error:
            remark = f"its process {error}"
            judged.answers.append(Graded(name, "wrong", 0, "Your function could not be scored.", remarks=[remark]))
    return judged


def _opened(message: dict) -> dict:
    """Return what the process says that the file holds. Raises `AnswerFormatError` if it is not in the right form."""
    try:
        return {
            "exercises": [str(number) for number in message["exercises"]],
            "functions": [str(name) for name in message["functions"]],
            "problems": [one_line(text) for text in message["problems"][:50]],
            "tries": {str(number): int(tries) for number, tries in message["tries"].items()},
            "recalled": [[one_line(part, 300) for part in one] for one in message["recalled"][:20]],
            "shapes": {str(name): str(shape)[:16] for name, shape in message["shapes"].items()},
        }
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise AnswerFormatError("sends what is no list of cells") from error


def lessons_of(exercises: list[str], names: list[str], functions: dict[str, str], guess: str) -> list[str]:
    """Return the lessons and projects in a file: by the exercises of its cells, else by the names that it defines."""
    if lessons := sorted({lesson_of(number) for number in exercises if number in functions}):
        return lessons
    count = Counter(lesson_of(number) for number, name in functions.items() if name in names)
    best = max(count, key=lambda lesson: (count[lesson], lesson == guess), default="")
    return [best] if best else []


# Exercises


def judge_answer(exercise: Exercise, function: str, box: Sandbox, seed: int) -> Graded:
    """Run and judge one answer."""
    arguments = exercise.draw(np.random.default_rng(secret(seed, exercise.number)))
    run = box.run(exercise.number, function, pickle.dumps(arguments))
    none = run.head.get("none")
    remarks = [one_line(text) for text in run.head.get("problems", [])][:20]
    answers, troubles, details = _answers(run, len(arguments))
    if none == "stub" or (none == "missing" and not remarks) or answers[0] is ...:
        return Graded(exercise.number, inputs=len(arguments))
    if none is not None:
        said = "There is none that runs." if none == "missing" else "It is something else."
        return Graded(exercise.number, "wrong", 0, f"A function {function}() is asked. {said}", remarks=remarks)
    with np.errstate(all="ignore"):
        right = _right(exercise, arguments, answers)
        points = earned(most_of(exercise.number), right)
        status: Status = "right" if all(right) else "partly right" if points else "wrong"
        sentence = "Right." if all(right) else _sentence(exercise, arguments, answers, right, troubles)
    printed = one_line(run.calls[0].get("printed", "")) if run.calls else ""
    remarks = [] if all(right) else [*remarks, *details]
    return Graded(exercise.number, status, points, sentence, sum(right), len(right), remarks, printed)


def _answers(run: Run, wanted: int) -> tuple[list, list[str], list[str]]:
    """Return an answer for each input (None if there is none), the kinds of the troubles, and what they say."""
    answers, troubles, details = [], [], []
    for call in run.calls[:wanted]:
        value = None
        if "failure" in call:
            troubles.append(failure_kind(str(call["failure"])))
            details.append(f"Your function {one_line(call['failure'])}")
        elif call.get("changed"):
            troubles.append("changes the array it was given: work on a new one")
        else:
            try:
                value = decode(call.get("value"))
            except AnswerFormatError as error:
                troubles.append("sends the grader what is no answer")
                details.append(str(error))
        answers.append(value)
    if run.ended or len(answers) < wanted:
        troubles.append(failure_kind(run.ended))
        details += [f"Your function {run.ended}."] if run.ended else []
    return answers + [None] * (wanted - len(answers)), troubles, list(dict.fromkeys(details))[:5]


def failure_kind(failure: str) -> str:
    """Return the kind of a failed call, without a word of the student's: an error of Python's own by its name."""
    for start, kind in FAILURES.items():
        if failure.startswith(start):
            return kind
    stops, _, name = failure.partition("stops with ")
    if stops or not name:
        return "ends before it has answered"
    name = name.split(":")[0].split(" ")[0].rstrip(".")
    known = getattr(builtins, name, None)
    return f"stops with {name}" if isinstance(known, type) and issubclass(known, Exception) else "stops with an error"


def _right(exercise: Exercise, arguments: list[tuple], answers: list) -> list[bool]:
    """Return where the answers are right. A kind of value that cannot be compared is wrong."""
    with contextlib.suppress(Exception):
        return right_on(exercise, arguments, answers)
    if len(answers) == 1:
        return [False]
    return [_right(exercise, [given], [answer])[0] for given, answer in zip(arguments, answers, strict=True)]


def _sentence(exercise: Exercise, arguments: list, answers: list, right: list[bool], troubles: list[str]) -> str:
    """Return what the student reads of answers that are not all right."""
    if troubles:
        where = "" if len(troubles) == len(arguments) or not any(right) else " on some inputs"
        return f"Your function {troubles[0]}{where}."
    with contextlib.suppress(Exception):  # a value of a kind that cannot be compared
        return fault(exercise, arguments, answers, details=False) or SEE_CHECK
    return SEE_CHECK


# A project's last function


def judge_score(name: str, path: Path, settings: Settings) -> Graded:
    """Judge a project's function in the worlds of the secret seed; "inputs" are the worlds in which it runs."""
    project = graded_project(name, secret(settings.seed, name))
    memory = 2 * settings.limits.memory_mb
    roomy = settings.limits._replace(call_seconds=project.seconds, seconds=5 * project.seconds, memory_mb=memory)
    outcomes: list[Outcome] = []
    with Sandbox(path, settings.library, roomy, settings.trust) as box:
        for world in project.seeds:
            lost = outcomes and outcomes[-1].out_of_time
            outcomes.append(outcomes[-1] if lost else _outcome(project, box, world))
    values = [outcome.value for outcome in outcomes]
    failed = [outcome.remark for outcome in outcomes if outcome.failed]
    if len(failed) == len(values) and failed[0] == "Not attempted.":
        return Graded(name)
    points = score_points(project, values)
    status: Status = "right" if points == SCORE_POINTS else "partly right" if points else "wrong"
    sentence = score_sentence(project, values, len(failed))
    ran = len(values) - len(failed)
    return Graded(name, status, points, sentence, ran, len(values), list(dict.fromkeys(failed))[:5])


def _outcome(project: Project, box: Sandbox, world: int) -> Outcome:
    """Run the function in one world and measure its answer."""

    def call(calls: list[tuple]) -> list:
        run = box.run(project.name, project.function, pickle.dumps(calls), project.forbidden)
        if run.head.get("none") is not None:
            raise LookupError("Not attempted.")
        if banned := run.head.get("forbidden"):
            raise LookupError(f"Not scored: it uses {one_line(banned)}, which is to be written yourself.")
        failures = [one_line(one["failure"]) for one in run.calls if "failure" in one]
        if failures or run.ended or len(run.calls) < len(calls):
            raise AnswerError((failures or [run.ended or "does not answer every call"])[0])
        return [decode(one.get("value")) for one in run.calls]

    last = False  # no other world is tried
    try:
        task = project.prepare(world)
        answers = call(list(task.arguments) if project.many else [task.arguments])
        with np.errstate(all="ignore"):
            result = project.measure(task, answers if project.many else answers[0])
        if project.rule is not None:
            project.rule(project.prepare(world), lambda *arguments: call([arguments])[0], answers[0])
        if np.isfinite(result.value):
            return Outcome(float(result.value), result.remark)
        remark = f"failed: {result.remark or 'no number came of it'}"
    except LookupError as error:
        remark, last = str(error), True
    except AnswerError as error:
        remark, last = f"Your function {one_line(error)}.", str(error).startswith("does not end")
    except Exception as error:  # a value of a kind that nobody measures
        remark = f"Your function returns what cannot be measured ({type(error).__name__})."
    return Outcome(project.worst, remark, True, last)


def from_json(stored: dict) -> Judged:
    """Return what was judged from its `dataclasses.asdict`, as JSON keeps it."""
    return Judged(**stored | {"answers": [Graded(**one) for one in stored["answers"]]})
