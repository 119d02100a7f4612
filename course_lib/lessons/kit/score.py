"""Score a submitted file (for teachers), or store the rivals' results (for maintainers).

    python -m course_lib.lessons.kit.score P1 FILE        scores the function in FILE, a Python file or a notebook
                                                          (`course.py score P1 FILE`)
    python -m course_lib.lessons.kit.score P1 --store     writes data/projects/P1.json again

In a notebook only imports, definitions and assignments run, so its checks, figures and scores do not.
"""

import argparse
import ast
import sys
from collections.abc import Callable
from pathlib import Path

import nbformat

from course_lib.lessons.kit.projects import Project, UnknownProjectError, find_project, score, store_rivals

DEFINING = (ast.Import, ast.ImportFrom, ast.FunctionDef, ast.ClassDef, ast.Assign, ast.AnnAssign)


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
    if path.suffix not in (".py", ".ipynb") or not path.is_file():
        raise ValueError(f"{path} is neither a Python file nor a notebook")
    names: dict = {"__name__": "handed_in", "__file__": str(path)}
    try:
        for text in [path.read_text(encoding="utf-8")] if path.suffix == ".py" else _definitions(path):
            exec(compile(text, str(path), "exec"), names)
    except (Exception, SystemExit) as error:
        raise ValueError(f"{path} does not run: {type(error).__name__}: {error}") from error
    if not callable(names.get(project.function)):
        raise ValueError(f"{path} defines no function {project.function}(), which {project.name} asks for")
    return names[project.function]


def _definitions(path: Path) -> list[ast.Module]:
    """Return the imports, definitions and assignments of each code cell of a notebook, without IPython's commands."""
    cells = []
    for cell in nbformat.read(path, as_version=4).cells:
        if cell.cell_type == "code":
            lines = ["pass" if line.startswith(("%", "!")) else line for line in cell.source.splitlines()]
            nodes = [node for node in ast.parse("\n".join(lines)).body if isinstance(node, DEFINING)]
            cells.append(ast.Module(nodes, type_ignores=[]))
    return cells


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
