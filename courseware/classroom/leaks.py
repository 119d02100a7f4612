"""What of the teacher's is looked for in whatever students get: the canary, the secret seed, every solution."""

import ast
import html
import json
import re
from pathlib import Path

from courseware.classroom.assignment_cells import Assignment, function_name, tag_of
from courseware.classroom.model_answers import model_answers

MIN_DIGITS = 8
"""A seed of fewer is found everywhere by chance."""
MIN_LETTERS = 20
"""A body of fewer, without its spaces, is a line that others write too."""


class LeakError(RuntimeError):
    """Something of the teacher's stands in what students get; names the file, and what it is."""


def teachers_words(seed: int, canary: str) -> dict[str, str]:
    """Return what no file of a student may hold, whatever the student wrote, by what it is called."""
    return {"the canary": canary} | ({"the secret seed": str(seed)} if len(str(seed)) >= MIN_DIGITS else {})


def solutions(assignments: list[Assignment]) -> dict[str, str]:
    """Return the bodies of all model answers by what they are called, without those that a cell of the lesson shows."""
    found = {}
    for assignment in assignments:
        taught = "\n".join(plain(cell.source) for cell in assignment.stored.cells if tag_of(cell) != "solution")
        for number, code in model_answers(assignment).items():
            body = body_of(code)
            if len(plain(body)) >= MIN_LETTERS and plain(body) not in taught:
                found[f"the model answer of {number}"] = body
    return found


def body_of(code: str) -> str:
    """Return the lines of the last function's body, without its docstring."""
    name = function_name(code)
    node = next(one for one in ast.parse(code).body if isinstance(one, ast.FunctionDef) and one.name == name)
    first = node.body[1 if ast.get_docstring(node) is not None else 0]
    return "\n".join(code.splitlines()[first.lineno - 1 : node.end_lineno])


def find_leaks(folder: Path, words: dict[str, str]) -> list[str]:
    """Return "06.ipynb holds the canary" for every file of a folder, and everything that it holds of `words`."""
    wanted = {name: plain(text) for name, text in words.items()}
    found = []
    for path in sorted(path for path in folder.rglob("*") if path.is_file()):
        text = text_of(path)
        found += [f"{path.relative_to(folder)} holds {name}" for name, one in wanted.items() if one in text]
    return found


def text_of(path: Path) -> str:
    """Return all words of a file: of a notebook the texts in its JSON, of a page those without tags."""
    raw = path.read_bytes().decode("utf-8", errors="replace")
    if path.suffix == ".ipynb":  # a list of lines is one text
        raw = re.sub(r'\\n",\s*"', r"\\n", raw)
        raw = "\n".join(json.loads(text) for text in re.findall(r'"(?:[^"\\]|\\.)*+"', raw))
    elif path.suffix == ".html":
        raw = html.unescape(re.sub(r"<[^>]*>", "", raw))
    return plain(raw)


def plain(text: str) -> str:
    """Return text without spaces and line ends; a comment of code keeps its words."""
    return re.sub(r"[\s#]+", "", text)
