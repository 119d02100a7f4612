"""Show how far you have come: predictions typed and checks right in every lesson, and the same as a page."""

import argparse
import subprocess
import sys


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--out", metavar="PAGE", help="where to write the page (default: work/progress.html)")


def run(arguments: argparse.Namespace) -> int:
    # A process of its own, because commands import nothing that only the notebooks use.
    words = ["--out", arguments.out] if arguments.out else []
    return subprocess.call([sys.executable, "-P", "-m", "courseware.lessons.kit.show_progress", *words])
