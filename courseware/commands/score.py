"""Score what a student handed in for a project, a Python file or the notebook, on the hidden seeds."""

import argparse
import subprocess
import sys


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("project", metavar="P1", help="which project")
    text = "a Python file, or a notebook, that defines the project's function"
    parser.add_argument("file", metavar="FILE", help=text)
    text = "score on these seeds, such as 10001, not the hidden ones"
    parser.add_argument("--seeds", nargs="+", metavar="N", help=text)


def run(arguments: argparse.Namespace) -> int:
    # A process of its own, because it runs a student's file.
    words = [arguments.project, arguments.file, *(["--seeds", *arguments.seeds] if arguments.seeds else [])]
    return subprocess.call([sys.executable, "-P", "-m", "courseware.lessons.kit.score", *words])
