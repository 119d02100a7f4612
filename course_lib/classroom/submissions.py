"""A folder of what students handed in: whose each file is, which lesson's, and what is not read and why.

    FOLDER/alice/06_likelihood_and_weights.ipynb      a folder for each student, files named after the lesson
    FOLDER/alice/06/anything.ipynb                    as nbgrader collects them
    FOLDER/alice_06.ipynb, FOLDER/alice_P1.py         or all in one folder, student and lesson in the name

Nothing here runs what it finds. Links are not followed, and nothing is read that is not a plain file of a bounded size.
"""

import json
import os
import re
import stat
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

LARGEST_FILE_MB = 20
"""A lesson with all its pictures has 0.4 MB."""
MAX_FILES = 20_000
MAX_CELLS = 2_000
LARGEST_CODE = 1_000_000
"""Characters of code in one notebook; a lesson has 20,000."""
READ = (".ipynb", ".py")
ARCHIVES = (".zip", ".tar", ".gz", ".tgz", ".7z", ".rar", ".bz2", ".xz")


class SubmissionError(ValueError):
    """A file that cannot be read as a submission; the message says why."""


@dataclass(frozen=True, order=True)
class Submission:
    """One file that is graded. lesson: "06" or "P1"."""

    student: str
    lesson: str
    path: Path


@dataclass(frozen=True, order=True)
class NotRead:
    """One file that is not graded, and why. student: "" where nobody's."""

    student: str
    name: str
    why: str


@dataclass(frozen=True)
class Collection:
    """All that a folder holds."""

    submissions: tuple[Submission, ...]
    not_read: tuple[NotRead, ...]


def collect(folder: Path, titles: Sequence[str]) -> Collection:
    """The submissions in a folder. titles: names of the lessons' files, without suffix ("06_likelihood_and_weights").

    Of several files of one student for one lesson the newest counts. Raises `SubmissionError` for what is no folder.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise SubmissionError(f"{folder} is no folder: name the one that holds what the students handed in")
    if not any(folder.iterdir()):
        raise SubmissionError(f"{folder} is empty: name the folder that holds what the students handed in")
    found: dict[tuple[str, str], list[tuple[int, str, Path]]] = {}
    not_read: list[NotRead] = []
    for path, kind in _files(folder, folder, not_read):
        relative = path.relative_to(folder)
        student, lesson = whose(relative, titles)
        why = _refused(path, kind, student, lesson)
        if why is not None:
            not_read.append(NotRead(student, shown(relative), why))
        else:
            found.setdefault((student, lesson), []).append((path.stat().st_mtime_ns, shown(relative), path))
    submissions = []
    for (student, lesson), files in found.items():
        files.sort(key=lambda file: (file[0], file[1]))
        submissions.append(Submission(student, lesson, files[-1][2]))
        not_read += [NotRead(student, name, f"older than {files[-1][1]}, which counts") for _, name, _ in files[:-1]]
    return Collection(tuple(sorted(submissions)), tuple(sorted(not_read)))


def _files(folder: Path, root: Path, not_read: list[NotRead]) -> list[tuple[Path, os.stat_result]]:
    """Whatever is in a folder and below that is no folder, hidden ones left out; links as they are."""
    found, folders = [], [folder]
    while folders:
        for entry in sorted(os.scandir(folders.pop()), key=lambda entry: entry.name):
            if entry.name.startswith(".") or entry.name == "__pycache__":
                continue
            if entry.is_dir(follow_symlinks=False):
                folders.append(Path(entry.path))
            else:
                found.append((Path(entry.path), entry.stat(follow_symlinks=False)))
        if len(found) > MAX_FILES or len(folders) > MAX_FILES:
            raise SubmissionError(f"{root} holds more than {MAX_FILES:,} files: is it the right folder?")
    return found


def whose(relative: Path, titles: Sequence[str]) -> tuple[str, str]:
    """Student and lesson of a file, by its place and name; "" for what cannot be told.

    The lesson: the course's own file name where the name ends so, else the last number of a lesson in it, else of a
    folder about it. The student: the first folder, else the rest of the name.
    """
    lessons = {title[:2].upper(): title for title in titles}
    stem, folders = shown(relative.name.removesuffix(relative.suffix)), [shown(part) for part in relative.parts[:-1]]
    lesson, rest = "", stem
    for title in titles:
        if title.lower() in stem.lower():
            start = stem.lower().rindex(title.lower())
            lesson, rest = title[:2].upper(), stem[:start] + stem[start + len(title) :]
    if not lesson:
        tokens = [match for match in re.finditer(r"[A-Za-z0-9]+", stem) if match.group().upper() in lessons]
        if tokens:
            start, end = tokens[-1].span()
            lesson, rest = tokens[-1].group().upper(), stem[:start] + stem[end:]
    if not lesson:
        around = [part.upper() for part in folders[1:] if part.upper() in lessons]
        lesson = around[-1] if around else ""
    return folders[0] if folders else rest.strip(" _-.()") if lesson else "", lesson


def _refused(path: Path, kind: os.stat_result, student: str, lesson: str) -> str | None:
    """Why a file is not read, or None."""
    suffix = path.suffix.lower()
    if stat.S_ISLNK(kind.st_mode):
        return "is a link: links are not followed"
    if not stat.S_ISREG(kind.st_mode):
        return "is no plain file"
    if suffix in ARCHIVES:
        return "is an archive: unpack it, then grade the folder again"
    if suffix not in READ:
        return "is neither a notebook (.ipynb) nor a Python file (.py)"
    if not lesson:
        return "does not say which lesson it is: put the number into the name, as in alice_06.ipynb"
    if not student:
        return "does not say whose it is: name it as in alice_06.ipynb, or put it into a folder of the student's name"
    if kind.st_size > LARGEST_FILE_MB << 20:
        return f"has more than {LARGEST_FILE_MB} MB"
    return None


def read_cells(path: Path) -> list[tuple[str, str]]:
    """Name and source of each code cell; a Python file is one cell. Raises `SubmissionError`, with the file's name."""
    try:
        return _cells(path)
    except SubmissionError as error:
        raise SubmissionError(f"{shown(path.name)} {error}") from None


def _cells(path: Path) -> list[tuple[str, str]]:
    text = _read_text(path)
    if path.suffix.lower() == ".py":
        return [("the file", text)]
    try:
        notebook = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise SubmissionError(f"is damaged: it is no notebook that can be read ({type(error).__name__})") from error
    cells = notebook.get("cells") if isinstance(notebook, dict) else None
    if not isinstance(cells, list):
        raise SubmissionError("is no notebook of today's format: open it in JupyterLab and save it again")
    found = []
    for number, cell in enumerate(cells[:MAX_CELLS], start=1):
        if isinstance(cell, dict) and cell.get("cell_type") == "code":
            source = cell.get("source", "")
            if isinstance(source, list) and all(isinstance(line, str) for line in source):
                source = "".join(source)
            if isinstance(source, str):
                found.append((f"cell {number}", source))
    if sum(len(source) for _, source in found) > LARGEST_CODE:
        raise SubmissionError(f"holds more than {LARGEST_CODE:,} characters of code")
    return found


def _read_text(path: Path) -> str:
    """The text of a plain file of a bounded size, wherever its name points to by now."""
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError as error:
        raise SubmissionError(f"cannot be opened: {error.strerror}") from error
    with os.fdopen(descriptor, "rb") as file:
        if not stat.S_ISREG(os.fstat(descriptor).st_mode):
            raise SubmissionError("is no plain file")
        content = file.read((LARGEST_FILE_MB << 20) + 1)
    if len(content) > LARGEST_FILE_MB << 20:
        raise SubmissionError(f"has more than {LARGEST_FILE_MB} MB")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise SubmissionError("is not in UTF-8") from error


def shown(name: object) -> str:
    """A name of the file system as text that can be printed, whatever its bytes are."""
    text = os.fsencode(str(name)).decode("utf-8", "replace")
    return "".join(letter if letter.isprintable() else "\ufffd" for letter in text)
