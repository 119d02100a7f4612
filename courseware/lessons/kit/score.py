"""Score a submitted file (for teachers), or store the rivals' results (for maintainers).

    python -m courseware.lessons.kit.score P1 FILE        scores the function in FILE, a Python file or a notebook
                                                          (`course.py score P1 FILE`)
    python -m courseware.lessons.kit.score P1 --store     writes courseware/answers/project_1.json again

Only what the function needs runs (`kit.statements`); checks, figures and scores do not.
"""

import argparse
import ast
import sys
from collections.abc import Callable
from pathlib import Path

import nbformat

from courseware.lessons.kit.projects import Project, UnknownProjectError, find_project, score, store_rivals
from courseware.lessons.kit.statements import needed, read_statements


def main(words: list[str]) -> int:
    """Score a file or store the rivals' results. Return the exit code; 2 is an error that the user can correct."""
    parser = argparse.ArgumentParser(prog="course.py score", description=__doc__.split("\n")[0])
    parser.add_argument("project", metavar="P1")
    parser.add_argument("file", nargs="?", type=Path, help="a Python file or a notebook with the project's function")
    parser.add_argument("--seeds", nargs="+", type=int, help="score on these instead of the hidden ones")
    parser.add_argument("--store", action="store_true", help="run the rivals on the hidden seeds and store the numbers")
    arguments = parser.parse_args(words)
    try:
        project = find_project(arguments.project)
        if arguments.store:
            print(store_rivals(project))
        elif arguments.file is None:
            raise ValueError(f"name the file to score; it defines {project.function}()")
        else:
            score(project.name, handed_in(project, arguments.file), arguments.seeds)
    except (UnknownProjectError, ValueError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


def handed_in(project: Project, path: Path) -> Callable:
    """Return the project's function in a file. Raises `ValueError` if there is none, or if the file does not run."""
    if not path.exists():
        raise ValueError(f"{path} is missing. Give the path of a Python file or a notebook")
    if path.suffix not in (".py", ".ipynb") or not path.is_file():
        raise ValueError(f"{path} is neither a Python file nor a notebook")
    names: dict = {"__name__": "handed_in", "__file__": str(path)}
    try:
        statements, problems = read_statements(cells_of(path))
        for one in needed(statements, project.function):
            exec(compile(ast.Module([one.node], []), f"{path}, {one.cell}", "exec"), names)
    except (Exception, SystemExit) as error:
        raise ValueError(f"{path} does not run: {type(error).__name__}: {error}") from error
    if problems and not callable(names.get(project.function)):
        raise ValueError(f"{path} does not run: {problems[0]}")
    if not callable(names.get(project.function)):
        raise ValueError(f"{path} defines no function {project.function}(), which {project.name} asks for")
    return names[project.function]


def cells_of(path: Path) -> list[tuple[str, str]]:
    """Return the name and the source of each code cell. A Python file is one cell."""
    if path.suffix == ".py":
        return [("the file", path.read_text(encoding="utf-8-sig"))]
    cells = nbformat.read(path, as_version=4).cells
    return [(f"cell {n}", cell.source) for n, cell in enumerate(cells, 1) if cell.cell_type == "code"]


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
