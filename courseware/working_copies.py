"""A student's own copies of the lessons, in `work/`, which git ignores: `git pull` meets nothing that a student wrote.

A copy that nobody has changed follows the course; nothing here writes to a changed one.
"""

import datetime
import hashlib
import json
import os
import subprocess
from collections.abc import Sequence
from itertools import chain, count
from pathlib import Path

from course_lib.files import atomic_write

NOTEBOOKS, WORK, MEMORY = "notebooks", "work", ".copies.json"
LESSONS = ("[0-9][0-9]_*.ipynb", "foundations/F[0-9]_*.ipynb", "projects/P[0-9]_*.ipynb")
# What lessons show and link to. Not among it: projects/solutions, and scenes/yours, where a student's own scenes go.
COMPANIONS = ("*.md", "pictures/*", "scenes/*.html", "projects/*.md")
# Sections whose stored outputs answer the predictions at a lesson's start. A student's copy has none there.
MEASURED = ("## Measure", "## Break it", "## Recap")


def lessons(root: Path) -> dict[str, str]:
    """Return number ("06", "F1", "P1") -> path below notebooks/ of every lesson, foundation and project."""
    return {Path(name).name[:2]: name for name in _below_notebooks(root, LESSONS)}


def _below_notebooks(root: Path, patterns: tuple[str, ...]) -> list[str]:
    folder = root / NOTEBOOKS
    found = (path for pattern in patterns for path in sorted(folder.glob(pattern)))
    return [path.relative_to(folder).as_posix() for path in found if path.is_file() and not path.name.startswith(".")]


def as_number(word: str) -> str:
    """Return a lesson's number as its file's name begins with it: 06 for 6, P1 for p1."""
    return word.upper().zfill(2)


def copy_of(notebook: str, root: Path) -> str:
    """Return the path below `root` that opens for a number ("06") or path: for a lesson its copy, else the file."""
    numbers = lessons(root)
    named = numbers.get(as_number(notebook))
    path = Path(os.path.normpath(root / NOTEBOOKS / named if named else root / notebook))
    if not path.is_relative_to(root):
        raise ValueError(f"{notebook} lies outside {root}, where JupyterLab opens nothing: copy it into {root / WORK}")
    below = path.relative_to(root).as_posix()
    if below.removeprefix(f"{NOTEBOOKS}/") in numbers.values():
        return WORK + below.removeprefix(NOTEBOOKS)
    if not path.is_file():
        raise ValueError(f"there is no notebook {notebook} in {root}; see the folder {NOTEBOOKS}/")
    return below


def make_copies(root: Path, fresh: Sequence[str] = (), today: datetime.date | None = None) -> list[str]:
    """Bring `work/` up to date, and return what the student should know, a sentence each.

    fresh: numbers of lessons that start again; an old copy is renamed, `06_title.before-2026-11-23.ipynb`.
    """
    work, numbers, again = root / WORK, lessons(root), {as_number(word) for word in fresh}
    if unknown := sorted(again - set(numbers)):
        raise ValueError(f"there is no lesson {', '.join(unknown)}; there are: {', '.join(numbers)}")
    memory = _remembered(work / MEMORY)
    first, edited, before = not memory, _changed_in_place(root), json.dumps(memory)
    told = [f"Your copies of the lessons are in {WORK}/, which git leaves alone."] if first else []
    for name in [*numbers.values(), *_below_notebooks(root, COMPANIONS)]:
        content, mine = _fresh_copy(root / NOTEBOOKS / name), work / name
        begun, is_lesson, number = memory.get(name, {}), name in numbers.values(), mine.name[:2]
        if is_lesson and number in again and mine.exists():
            old = _free_name(mine, today or datetime.date.today())
            os.replace(mine, old)
            told.append(f"Lesson {number} starts again; your earlier copy is now {old.relative_to(root)}.")
        elif is_lesson and not (first or mine.exists()):
            told.append(f"Lesson {number} is new in your folder: {WORK}/{name}.")
        there, new = _checksum(mine.read_bytes()) if mine.exists() else None, _checksum(content)
        if there in (None, new) or (there == begun.get("whole") and name not in edited):
            if there != new:
                mine.parent.mkdir(parents=True, exist_ok=True)
                atomic_write(mine, content)
            # What somebody typed into the course's own file is theirs: its copy must never count as untouched.
            memory[name] = {"whole": "" if name in edited else new, "text": _text_version(content)}
        elif begun.get("text") != _text_version(content) and name not in edited:
            told.append(
                f"Lesson {number} has changed since you began your copy: `python3 course.py lab --fresh {number}` "
                "starts the new one and keeps yours."
                if is_lesson
                else f"{WORK}/{name} is changed by you and stays; the course's new one: {NOTEBOOKS}/{name}."
            )
    if edited:
        paths = " ".join(f"{NOTEBOOKS}/{name}" for name in edited)
        told.append(
            f"Changed in place, where git pull may stop at it: {paths}. Copy what you typed there into {WORK}/; then "
            f"`git checkout HEAD -- {paths}` brings the course's back."
        )
    if json.dumps(memory) != before:
        atomic_write(work / MEMORY, json.dumps(memory, indent=1))
    return told


def _fresh_copy(path: Path) -> bytes:
    """Return the bytes of a student's copy of a file of the course: of a lesson, without the measured answers."""
    content = path.read_bytes()
    if path.suffix != ".ipynb":
        return content
    try:
        notebook = json.loads(content)
        clear_answers(notebook["cells"])
    except (ValueError, KeyError, TypeError):  # for example in the middle of a git merge
        return content
    return (json.dumps(notebook, indent=1, ensure_ascii=False, sort_keys=True) + "\n").encode()


def clear_answers(cells: list[dict]) -> None:
    """Clear what the code cells of the sections `MEASURED` show; they show it again when the student runs them."""
    section = ""
    for cell in cells:
        if cell["cell_type"] == "markdown" and "".join(cell["source"]).startswith("## "):
            section = "".join(cell["source"]).partition("\n")[0]
        elif cell["cell_type"] == "code" and section.startswith(MEASURED):
            cell["outputs"] = []


def _remembered(path: Path) -> dict[str, dict]:
    """Return which version each copy was made of. Without that, a copy that differs from the course's is changed."""
    try:
        memory = json.loads(path.read_text(encoding="utf-8"))
        return {name: dict(entry) for name, entry in memory.items()}
    except (OSError, ValueError, AttributeError, TypeError):
        return {}


def _checksum(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _text_version(content: bytes) -> str:
    """Return a checksum of a notebook's cells without outputs, because new pictures alone do not change a lesson."""
    try:
        cells = [[cell["cell_type"], "".join(cell["source"])] for cell in json.loads(content)["cells"]]
    except (ValueError, KeyError, TypeError):  # it is no notebook
        return _checksum(content)
    return _checksum(json.dumps(cells).encode())


def _free_name(path: Path, today: datetime.date) -> Path:
    """Return a name beside `path` that nothing has yet, for an earlier copy."""
    endings = chain([""], (f"-{n}" for n in count(2)))
    names = (path.with_name(f"{path.stem}.before-{today.isoformat()}{ending}{path.suffix}") for ending in endings)
    return next(name for name in names if not name.exists())


def _changed_in_place(root: Path) -> list[str]:
    """Return the lessons in notebooks/ that differ from the last commit; none without git."""
    command = ["git", "--no-optional-locks", "diff", "--name-only", "--relative", "-z", "HEAD", "--", NOTEBOOKS]
    try:
        changed = subprocess.run(command, cwd=root, capture_output=True, timeout=60, check=True).stdout
    except (OSError, subprocess.SubprocessError):
        return []
    names = {name.removeprefix(f"{NOTEBOOKS}/") for name in changed.decode(errors="replace").split("\0")}
    return [name for name in lessons(root).values() if name in names]
