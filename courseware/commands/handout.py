"""Make a class's folder: lessons without solutions for students; solutions, rubrics, graded tests for the teacher.

The teacher's part holds a course for nbgrader, too. The judge draws its inputs from a secret seed.
"""

import argparse
import secrets
from pathlib import Path

from courseware.commands.arguments import add_flag, require_seed
from courseware.commands.output import progress_bar


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("lessons", nargs="*", metavar="NN", help="lessons and projects, such as 03, F1 or P1 (default: all)")
    text = "where the folder goes: new, empty, or a handout that is replaced as a whole (default: handout/ in the "
    add("--out", type=Path, metavar="DIR", help=text + "course's folder, which git ignores)")
    add_flag(parser, "--solved", "put the solved lessons into the teacher's folder, too: for the screen")
    text = "add course.zip: the whole course for students, without tests, grader and history, the answers packed away"
    add_flag(parser, "--package", text)
    text = "the secret seed of the graded tests, to make the same folder again (default: drawn by the system)"
    add("--seed", type=int, help=text)


def run(arguments: argparse.Namespace) -> int:
    from courseware.classroom.assignment_cells import read_assignments
    from courseware.classroom.handout import make_handout
    from courseware.paths import REPOSITORY

    seed = secrets.randbits(62) if arguments.seed is None else arguments.seed
    require_seed(seed)
    assignments = read_assignments(arguments.lessons)
    out, bar = arguments.out or REPOSITORY / "handout", progress_bar("handout", unit="step")
    made = make_handout(out, assignments, seed, arguments.solved, arguments.package, bar)
    count = len(assignments)
    print(f"{count} notebook{'s' * (count > 1)} in {made}:")
    print(f"  {made / 'student'}   for the students")
    if arguments.package:
        print(f"  {made / 'course.zip'}   the whole course for students")
    print(f"  {made / 'teacher'}   for you alone: begin with its README.md")
    return 0
