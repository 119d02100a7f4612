"""Score what a student handed in for a project, a Python file or the notebook, on the hidden seeds."""

from __future__ import annotations

import argparse

from course_lib.child import course_module
from course_lib.child import run as run_child


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("project", metavar="P1", help="which project")
    parser.add_argument(
        "file", metavar="FILE", help="a Python file, or a notebook, that defines the project's function"
    )
    parser.add_argument(
        "--seeds", nargs="+", metavar="N", help="score on these seeds, such as 10001, not the hidden ones"
    )


def run(arguments: argparse.Namespace) -> int:
    # A process of its own: what a student's file does to it ends with it.
    words = [arguments.project, arguments.file, *(["--seeds", *arguments.seeds] if arguments.seeds else [])]
    return run_child(course_module("course_lib.lessons.kit.score", *words)).returncode
