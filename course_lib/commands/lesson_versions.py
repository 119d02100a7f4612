"""Versions of a lesson: what its text says, what it holds altogether, and whether it was changed in place."""

from __future__ import annotations

import hashlib
import json
import subprocess
from pathlib import Path

NOTEBOOKS = "notebooks"
LESSONS = ("[0-9][0-9]_*.ipynb", "projects/P[0-9]_*.ipynb")


class NotANotebookError(ValueError):
    """A file that should be a notebook is not, such as one with a merge's marks in it."""


def lessons(root: Path) -> dict[str, str]:
    """Number ("06", "P1") of every lesson and project of the repository -> its path below notebooks/, in order."""
    return {Path(name).name[:2]: name for name in below_notebooks(root, LESSONS)}


def below_notebooks(root: Path, patterns: tuple[str, ...]) -> list[str]:
    """Files of notebooks/ that fit one of the patterns, in order, but for hidden ones."""
    folder = root / NOTEBOOKS
    found = (path for pattern in patterns for path in sorted(folder.glob(pattern)))
    return [path.relative_to(folder).as_posix() for path in found if path.is_file() and not path.name.startswith(".")]


def checksum(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def text_version(content: bytes) -> str:
    """Checksum of a notebook's cells without outputs: a lesson whose pictures alone were drawn anew has not changed.

    Raises `NotANotebookError`.
    """
    return _checksum_of([[cell.get("cell_type"), _joined(cell.get("source"))] for cell in _cells(content)])


def whole_version(content: bytes) -> str:
    """Checksum of a notebook's cells with their outputs, however it is laid out. Raises `NotANotebookError`."""
    kept = ("cell_type", "source", "outputs", "execution_count", "attachments")
    return _checksum_of([{key: _joined(cell[key]) for key in kept if key in cell} for cell in _cells(content)])


def _cells(content: bytes) -> list[dict]:
    try:
        cells = json.loads(content)["cells"]
        if isinstance(cells, list) and all(isinstance(cell, dict) for cell in cells):
            return cells
    except (ValueError, KeyError, TypeError, RecursionError):
        pass
    raise NotANotebookError("a notebook is JSON with a list of cells")


def _joined(value: object) -> object:
    """The same text whether a notebook keeps it as one string or as a list of lines."""
    if isinstance(value, dict):
        return {key: _joined(part) for key, part in value.items()}
    if isinstance(value, list):
        return "".join(value) if all(isinstance(part, str) for part in value) and value else list(map(_joined, value))
    return value


def _checksum_of(content: object) -> str:
    return checksum(json.dumps(content, sort_keys=True).encode())


def changed_in_place(root: Path) -> dict[str, bytes]:
    """Lessons that differ from the last commit, path below notebooks/ -> the commit's content; none without git."""
    names = _git(root, "diff", "--name-only", "--relative", "-z", "HEAD", "--", NOTEBOOKS).decode(errors="replace")
    changed = [name.removeprefix(f"{NOTEBOOKS}/") for name in names.split("\0")]
    return {
        name: content
        for name in lessons(root).values()
        if name in changed and (content := _git(root, "show", f"HEAD:./{NOTEBOOKS}/{name}"))
    }


def _git(root: Path, *words: str) -> bytes:
    """What git answers, nothing where it does not."""
    try:
        command = ["git", "--no-optional-locks", *words]
        return subprocess.run(command, cwd=root, capture_output=True, timeout=60, check=True).stdout
    except (OSError, subprocess.SubprocessError):
        return b""
