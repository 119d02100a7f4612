"""Three submissions of a lesson sent through nbgrader: what it gives for each, and whether anything leaked.

`solved`: the model answers, the first of which also warns, logs and writes to the error stream. `untouched`: as
released. `mistaken`: the first answer right, each other one a typical mistake, one that earns half where there is one;
a project's last function is the paper's method. The points must be all, none, and those that the graded tests give to
the same functions without nbgrader. Nothing of the teacher's may stand in what is released, graded or fed back.
"""

import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import nbformat

from course_lib.classroom.assignment_cells import Assignment, tag_of
from course_lib.classroom.graded_tests import grade, silence
from course_lib.classroom.leaks import find_leaks, solutions, teachers_words
from course_lib.classroom.model_answers import function_name, model_bodies, solved_stub
from course_lib.classroom.nbgrader_course import canary_of, write_course, write_grading_module
from course_lib.classroom.points import points_of
from course_lib.classroom.score_worlds import MAX_POINTS
from course_lib.files import temporary_folder
from course_lib.lessons.kit.exercises import Exercise, find_exercise
from course_lib.lessons.kit.mistakes import Mistake
from course_lib.lessons.kit.projects import find_project

HEADER = "lesson  most  solved  untouched  mistaken (expected)  leaks  seconds"
NOISE = """import logging, os, sys, warnings
warnings.warn("a warning of the answer")
logging.getLogger("answer").warning("a line of its log")
print("a line of its own", file=sys.stderr)
os.write(2, b"a line below Python\\n")
"""
PAPER = """from course_lib.lessons.kit.projects import find_project
return next(rival for rival in find_project({name!r}).rivals if rival.key == "paper").function({arguments})"""
SLIP = """from course_lib.lessons.kit.exercises import find_exercise
return find_exercise({number!r}).known[{index}].functions[0]({arguments})"""


@dataclass(frozen=True)
class Trial:
    """Points that nbgrader gave to the three submissions of one lesson, and what leaked."""

    name: str
    most: float
    solved: float
    untouched: float
    mistaken: float
    expected: float
    leaks: tuple[str, ...]
    seconds: float

    @property
    def as_it_must_be(self) -> bool:
        right = (self.solved, self.untouched, self.mistaken) == (self.most, 0.0, self.expected)
        return right and 0 < self.expected < self.most and not self.leaks

    def row(self) -> str:
        """One line of the table."""
        told = f"{self.mistaken:g} ({self.expected:g})"
        line = f"{self.name:6}  {self.most:4g}  {self.solved:6g}  {self.untouched:9g}  {told:19}  {len(self.leaks):5}"
        return f"{line}  {self.seconds:7.0f}" + ("" if self.as_it_must_be else f"  WRONG {' '.join(self.leaks[:1])}")


def try_assignment(assignment: Assignment, seed: int, answers_only: bool = True, folder: Path | None = None) -> Trial:
    """Send the three submissions of one lesson through nbgrader.

    answers_only: only the cells that matter run. folder: new or empty, kept; a temporary one for None.
    """
    if folder is None:
        with temporary_folder() as temporary:
            return try_assignment(assignment, seed, answers_only, temporary)
    started = time.monotonic()
    warnings.filterwarnings("ignore", module="nbgrader")  # its database's, about itself
    canary, name, course = canary_of(seed), assignment.name, folder / "nbgrader"
    write_course(course, [assignment], canary)
    write_grading_module(folder / "grading", seed, canary)
    api = nbgrader_api(course, answers_only)
    told(api.generate_assignment(name))
    mistaken, expected = mistaken_bodies(assignment, seed)
    for student, bodies in (("solved", noisy_bodies(assignment)), ("untouched", {}), ("mistaken", mistaken)):
        submit(course, name, student, bodies)
        told(api.autograde(name, student))
        told(api.generate_feedback(name, student))
    given = scores(course, name)
    return Trial(
        name,
        most_of(assignment),
        *(given[student] for student in ("solved", "untouched", "mistaken")),
        expected,
        tuple(leaks_of(course, assignment, seed)),
        time.monotonic() - started,
    )


def nbgrader_api(course: Path, answers_only: bool = False):
    """nbgrader's own interface in Python, with the configuration of the course's file."""
    from nbgrader.apps.api import NbGraderAPI
    from nbgrader.coursedir import CourseDirectory
    from traitlets.config.loader import PyFileConfigLoader

    config = PyFileConfigLoader("nbgrader_config.py", path=str(course)).load_config()
    config.RunWhatCounts.answers_only = answers_only
    return NbGraderAPI(CourseDirectory(config=config), config=config)


def told(result: dict) -> None:
    """Raises `RuntimeError` with nbgrader's last lines where a step of it failed."""
    if not result["success"]:
        tail = "\n".join(str(result.get("error") or result.get("log")).splitlines()[-15:])
        raise RuntimeError(f"nbgrader failed:\n{tail}")


def submit(course: Path, name: str, student: str, bodies: dict[str, str]) -> Path:
    """Hand in the released notebook with these bodies, by their functions' names, in its stubs."""
    notebook = nbformat.read(course / "release" / name / f"{name}.ipynb", as_version=4)
    for cell in notebook.cells:
        if tag_of(cell) in ("exercise", "submission") and function_name(cell.source) in bodies:
            cell.source = solved_stub(cell.source, bodies[function_name(cell.source)])
    path = course / "submitted" / student / name / f"{name}.ipynb"
    path.parent.mkdir(parents=True)
    nbformat.write(notebook, path)
    return path


def scores(course: Path, name: str) -> dict[str, float]:
    """Points of every student for one assignment, out of nbgrader's own book."""
    from nbgrader.api import Gradebook

    with Gradebook(f"sqlite:///{course / 'gradebook.db'}") as book:
        return {one.student.id: one.score for one in book.assignment_submissions(name)}


def noisy_bodies(assignment: Assignment) -> dict[str, str]:
    """The model answers, the first of which is heard on the error stream in every way that there is."""
    bodies = model_bodies(assignment)
    first = next(iter(bodies))
    return bodies | {first: NOISE + bodies[first]}


def mistaken_bodies(assignment: Assignment, seed: int) -> tuple[dict[str, str], float]:
    """Bodies with typical mistakes in all answers but the first, and the points that they must earn."""
    bodies, points = {}, 0.0
    for position, cells in enumerate(assignment.exercises()):
        name = function_name(cells.stub)
        exercise = find_exercise(cells.number)
        if position == 0:
            bodies[name] = model_bodies(assignment)[name]
            points += points_of(exercise)
            continue
        index, earned = telling_mistake(exercise, seed)
        bodies[name] = SLIP.format(number=cells.number, index=index, arguments=arguments_of(cells.stub))
        points += earned
    if assignment.is_project:
        project = find_project(assignment.name)
        arguments = arguments_of(assignment.submission())
        bodies[project.function] = PAPER.format(name=assignment.name, arguments=arguments)
        paper = next(rival for rival in project.rivals if rival.key == "paper")
        points += silently(assignment.name, paper.function, seed)
    return bodies, points


def telling_mistake(exercise: Exercise, seed: int) -> tuple[int, float]:
    """Which of the typical mistakes to make, and its points: the first that earns half, else the first."""

    def earned(mistake: Mistake) -> float:
        return silently(exercise.number, mistake.functions[0], seed)

    found = [(index, earned(mistake)) for index, mistake in enumerate(exercise.known)]
    return next(((index, points) for index, points in found if points), found[0])


def silently(number: str, function: Callable, seed: int) -> float:
    """Points of a function, unheard."""
    with silence():
        return grade(number, function, seed).points


def arguments_of(stub: str) -> str:
    """The names of a stub's arguments, as in a call."""
    return stub[stub.index("(") + 1 : stub.index("):")]


def most_of(assignment: Assignment) -> float:
    """Points of a whole assignment."""
    stages = sum(points_of(find_exercise(one.number)) for one in assignment.exercises())
    return float(stages + (MAX_POINTS if assignment.is_project else 0))


def leaks_of(course: Path, assignment: Assignment, seed: int) -> list[str]:
    """What of the teacher's stands in what was released and handed in, graded or fed back.

    The model answers are looked for everywhere but in the work of those who handed them in.
    """
    teachers, answers = teachers_words(seed, canary_of(seed)), solutions([assignment])
    found = [f"release/{leak}" for leak in find_leaks(course / "release", teachers | answers)]
    for folder in ("submitted", "feedback"):
        found += [f"{folder}/{leak}" for leak in find_leaks(course / folder, teachers)]
        found += [f"{folder}/untouched/{leak}" for leak in find_leaks(course / folder / "untouched", answers)]
    graded = {name: word for name, word in teachers.items() if "module" not in name}  # the hidden region calls it there
    return found + [f"autograded/{leak}" for leak in find_leaks(course / "autograded", graded)]
