"""What of the teacher's is looked for in whatever students get: the canary, the secret seed, every solution's body.

Spaces and line ends do not count, nor does how a page colours code: notebooks are read as their texts, pages without
their tags.
"""

import html
import json
import re
from collections.abc import Iterator
from pathlib import Path

from course_lib.classroom.assignment_cells import Assignment, tag_of
from course_lib.classroom.model_answers import model_bodies
from course_lib.classroom.nbgrader_course import MODULE

MIN_DIGITS = 8
"""A seed of fewer is found everywhere by chance."""
MIN_LETTERS = 20
"""A body of fewer, without its spaces, is a line that others write too."""


class LeakError(RuntimeError):
    """Something of the teacher's stands in what students get; names the file, and what it is."""


def teachers_words(seed: int, canary: str) -> dict[str, str]:
    """What no file of a student may hold, whatever the student wrote: by what it is called."""
    words = {"the canary": canary, "the graded tests' module": f"from {MODULE} import"}
    return words | ({"the secret seed": str(seed)} if len(str(seed)) >= MIN_DIGITS else {})


def solutions(assignments: list[Assignment]) -> dict[str, str]:
    """Bodies of all model answers, by what they are called; without those that the lesson itself teaches in a cell."""
    found = {}
    for assignment in assignments:
        taught = "\n".join(plain(cell.source) for cell in assignment.stored.cells if tag_of(cell) != "solution")
        for name, body in model_bodies(assignment).items():
            if len(plain(body)) >= MIN_LETTERS and plain(body) not in taught:
                found[f"the model answer of {name}() ({assignment.name})"] = body
    return found


def find_leaks(folder: Path, words: dict[str, str]) -> list[str]:
    """ "06.ipynb holds the canary" for every file of a folder, and everything that it holds of `words`."""
    wanted = {name: plain(text) for name, text in words.items()}
    found = []
    for path in sorted(path for path in folder.rglob("*") if path.is_file()):
        text = text_of(path)
        found += [f"{path.relative_to(folder)} holds {name}" for name, one in wanted.items() if one in text]
    return found


def text_of(path: Path) -> str:
    """All words of a file, without spaces."""
    raw = path.read_bytes().decode("utf-8", errors="replace")
    if path.suffix == ".ipynb":
        return "\n".join(plain(text) for text in _strings(json.loads(raw)))
    if path.suffix == ".html":
        return plain(html.unescape(re.sub(r"<[^>]*>", "", raw)))
    return plain(raw)


def plain(text: str) -> str:
    """Text without spaces and line ends; a comment of code keeps its words."""
    return re.sub(r"[\s#]+", "", text)


def _strings(value: object) -> Iterator[str]:
    """Texts of a notebook; a list of lines is one text."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, list) and all(isinstance(part, str) for part in value):
        yield "".join(value)
    elif isinstance(value, list | dict):
        for part in value.values() if isinstance(value, dict) else value:
            yield from _strings(part)
