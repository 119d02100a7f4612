"""Make a class's folder: lessons without solutions for students; solutions, rubrics, graded tests for the teacher.

The teacher's part holds a course for nbgrader, too. Its tests draw their inputs from a secret seed.
"""

import argparse
import secrets
from pathlib import Path

from course_lib.commands.arguments import add_flag, require_seed
from course_lib.commands.output import progress_bar


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("lessons", nargs="*", metavar="NN", help="lessons and projects, such as 03 or P1 (default: all)")
    told = "where the folder goes: new, empty, or a handout that is replaced as a whole (default: handout/ in the "
    add("--out", type=Path, metavar="DIR", help=told + "course's folder, which git ignores)")
    add_flag(parser, "--solved", "put the solved lessons into the teacher's folder, too: for the screen")
    told = "the secret seed of the graded tests, to make the same folder again (default: drawn by the system)"
    add("--seed", type=int, help=told)
    told = "make nothing; send a solved, an untouched and a mistaken submission of each lesson through nbgrader, and "
    add_flag(parser, "--try", told + "print their points and what leaked (a minute a lesson)", dest="trial")


def run(arguments: argparse.Namespace) -> int:
    from course_lib.classroom.assignment_cells import read_assignments
    from course_lib.paths import REPOSITORY

    seed = secrets.randbits(62) if arguments.seed is None else arguments.seed
    require_seed(seed)
    assignments = read_assignments(arguments.lessons)
    if arguments.trial:
        return trial(assignments, seed)

    from course_lib.classroom.handout import make_handout

    out = arguments.out or REPOSITORY / "handout"
    made = make_handout(out, assignments, seed, arguments.solved, progress_bar("handout", unit="step"))
    count = len(assignments)
    print(f"{count} notebook{'s' * (count > 1)} in {made}:")
    print(f"  {made / 'student'}   for the students")
    print(f"  {made / 'teacher'}   for you alone: begin with its README.md")
    return 0


def trial(assignments: list, seed: int) -> int:
    """Send three submissions of every lesson through nbgrader; 1 where points or secrecy are not as they must be."""
    from course_lib.classroom.nbgrader_trial import HEADER, try_assignment

    print(HEADER, flush=True)
    wrong = 0
    for assignment in assignments:
        found = try_assignment(assignment, seed)
        wrong += not found.as_it_must_be
        print(found.row(), flush=True)
    print("all as they must be" if not wrong else f"{wrong} NOT as they must be")
    return 1 if wrong else 0
