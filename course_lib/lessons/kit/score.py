"""A file that was handed in, scored: for teachers, and for us who store the rivals' numbers.

    python -m course_lib.lessons.kit.score P1 FILE        the score of the function in FILE, which is a Python file or a
                                                          notebook (`course.py score P1 FILE`)
    python -m course_lib.lessons.kit.score P1 --store     data/projects/P1.json made again

Of a notebook only imports, definitions and assignments run: no check, no figure, no score of its own.
"""

from __future__ import annotations

import argparse
import ast
import sys
from collections.abc import Callable
from pathlib import Path

import nbformat

from course_lib.lessons.kit.projects import Project, UnknownProjectError, find_project, score, store_rivals


def main(words: list[str]) -> int:
    """Score or store; returns the exit code: 2 for what the caller can mend."""
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
    if path.suffix not in (".py", ".ipynb") or not path.is_file():
        raise ValueError(f"{path} is no Python file and no notebook")
    names: dict = {"__name__": "handed_in", "__file__": str(path)}
    try:
        for text in [path.read_text(encoding="utf-8")] if path.suffix == ".py" else definitions(path):
            exec(compile(text, str(path), "exec"), names)
    except (Exception, SystemExit) as error:
        raise ValueError(f"{path} does not run: {type(error).__name__}: {error}") from error
    if not callable(names.get(project.function)):
        raise ValueError(f"{path} defines no function {project.function}(), which is what {project.name} asks for")
    return names[project.function]


DEFINING = (ast.Import, ast.ImportFrom, ast.FunctionDef, ast.ClassDef, ast.Assign, ast.AnnAssign)


def definitions(path: Path) -> list[ast.Module]:
    """The imports, definitions and assignments of a notebook's code cells, a cell each; lines for IPython are left
    out."""
    cells = []
    for cell in nbformat.read(path, as_version=4).cells:
        if cell.cell_type == "code":
            lines = ["pass" if line.startswith(("%", "!")) else line for line in cell.source.splitlines()]
            nodes = [node for node in ast.parse("\n".join(lines)).body if isinstance(node, DEFINING)]
            cells.append(ast.Module(nodes, type_ignores=[]))
    return cells


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
