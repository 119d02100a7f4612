"""Score a file that a student handed in for a project, on the hidden seeds, without the notebook."""

from __future__ import annotations

import argparse
import subprocess
import sys

PASSES_ARGUMENTS_ON = True


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("project", metavar="P1", help="which project")
    parser.add_argument("file", metavar="FILE", help="a Python file that defines the project's function")


def run(arguments: argparse.Namespace) -> int:
    # A process of its own: what a student's file does to it ends with it.
    words = [arguments.project, arguments.file, *arguments.passed_on]
    return subprocess.run([sys.executable, "-m", "course_lib.lessons.kit.score", *words]).returncode
