"""A file that was handed in, scored without its notebook: for teachers, and for us who store the rivals' numbers.

python -m course_lib.lessons.kit.score P1 FILE.py     the score of FILE.py's function (`course.py score P1 FILE.py`)
python -m course_lib.lessons.kit.score P1 --store     data/projects/P1.json made again
"""

from __future__ import annotations

import argparse
import importlib.util
import sys
from collections.abc import Callable
from pathlib import Path

from course_lib.lessons.kit.projects import Project, UnknownProjectError, find_project, score, store_rivals


def main(words: list[str]) -> int:
    """Score or store; returns the exit code: 2 for what the caller can mend."""
    parser = argparse.ArgumentParser(prog="course.py score", description=__doc__.split("\n")[0])
    parser.add_argument("project", metavar="P1")
    parser.add_argument("file", nargs="?", type=Path, help="a Python file with the project's function")
    parser.add_argument("--seeds", nargs="+", type=int, help="score on these instead of the hidden ones")
    parser.add_argument("--store", action="store_true", help="run the rivals on the hidden seeds and store the numbers")
    arguments = parser.parse_args(words)
    try:
        project = find_project(arguments.project)
        if arguments.store:
            print(store_rivals(project))
            return 0
        if arguments.file is None:
            raise ValueError(f"name the file to score; it defines {project.function}()")
        score(project.name, handed_in(project, arguments.file), arguments.seeds)
    except (UnknownProjectError, ValueError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


def handed_in(project: Project, path: Path) -> Callable:
    """The project's function in a file. Raises `ValueError` where there is none, or the file does not run."""
    if path.suffix != ".py" or not path.is_file():
        raise ValueError(f"{path} is no Python file")
    spec = importlib.util.spec_from_file_location("handed_in", path)
    module = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except (Exception, SystemExit) as error:
        raise ValueError(f"{path} does not run: {type(error).__name__}: {error}") from error
    if not callable(getattr(module, project.function, None)):
        raise ValueError(f"{path} defines no function {project.function}(), which is what {project.name} asks for")
    return getattr(module, project.function)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
