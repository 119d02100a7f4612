"""What lies in a folder of outputs after an interruption: the old whole, the new whole, or neither.

The old is compared byte by byte. So is the new with what an undisturbed run makes; a file of it that tells times may
differ in them, and must then be a whole one of its kind.
"""

from __future__ import annotations

import io
import json
import os
import re
import shutil
from pathlib import Path
from typing import Literal

from course_lib.unfinished import UNFINISHED

State = Literal["old", "new", "between", "broken"]
Tree = dict[str, bytes]

_TIMES = re.compile(r"(^|_)(ms|s|seconds|times?|sizes?|made|date|peak|mb|duration)(_|$)")
"""Keys of JSON whose values another run of the same seed need not repeat."""


def tree(folder: Path) -> Tree:
    """Content by path of every file in a folder; what unfinished runs left is not among it."""
    found = {}
    for path in sorted(folder.rglob("*")) if folder.is_dir() else ():
        name = path.relative_to(folder).as_posix()
        if UNFINISHED not in name and not path.is_dir():
            found[name] = path.read_bytes()
    return found


def put_back(folder: Path, kept: Tree) -> None:
    """Makes a folder hold these files and nothing else."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for name, content in kept.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(content)


def left_over(stage: Path, out: Path) -> list[str]:
    """What a stopped run left: unfinished things anywhere, and whatever stands beside its outputs."""
    unfinished = {path.relative_to(stage).as_posix() for path in stage.rglob(f"*{UNFINISHED}*")}
    strangers = {path.name for path in stage.iterdir() if path != out} if stage.is_dir() else set()
    return sorted(unfinished | strangers)


def state(now: Tree, old: Tree, new: Tree, by_file: bool = False) -> State:
    """What the files of a folder are, given those before the run and those of an undisturbed one.

    by_file: the command promises each file whole and goes on from there, not all of them at once: "between" is then
    whole files of both.
    """
    if now == old:
        return "old"
    if now.keys() == new.keys() and all(_is_the_new(name, now[name], old, new) for name in now):
        return "new"
    if by_file and all(_is_of_either(name, now[name], old, new) for name in now) and old.keys() <= now.keys():
        return "between"
    return "broken"


def _is_of_either(name: str, content: bytes, old: Tree, new: Tree) -> bool:
    if name in old and content == old[name]:
        return True
    if name.endswith(".jsonl"):  # grows by lines; the next run mends the last
        return content.startswith(old.get(name, b"")) and _begins_as(content, new.get(name, b""))
    if name == ".copies.json":  # tells of both while they change
        return _json(content) is not None
    return name in new and _is_the_new(name, content, old, new)


def _begins_as(content: bytes, new: bytes) -> bool:
    """Whether these are the new's first rows, but for times; a last one without its end is compared up to a time."""
    *whole, begun = content.split(b"\n")
    *rows, _ = new.split(b"\n")
    found = [_json(row) for row in whole]
    if None in found or found != [_json(row) for row in rows[: len(whole)]]:
        return False
    row = rows[len(whole)] if len(whole) < len(rows) else b""
    times = (key.start() for key in re.finditer(rb'"(\w+)":', row) if _TIMES.search(key[1].decode()))
    told = row[: next(times, len(row))]
    return told.startswith(begun) or (told != row and begun.startswith(told))


def _is_the_new(name: str, content: bytes, old: Tree, new: Tree) -> bool:
    if content == new[name]:
        return True
    if content == old.get(name):
        return False
    kind = _KINDS.get(os.path.splitext(name)[1].lower())
    return kind is not None and (found := kind(content)) is not None and found == kind(new[name])


def _json(content: bytes) -> object:
    try:
        return _timeless(json.loads(content))
    except ValueError:
        return None


def _timeless(value: object, key: str = "") -> object:
    if _TIMES.search(key):
        return None
    if isinstance(value, dict):
        return {name: _timeless(part, name) for name, part in value.items()}
    return [_timeless(part) for part in value] if isinstance(value, list) else value


def _rows(content: bytes) -> object:
    """Lines of JSON, the last one with its end."""
    *rows, end = content.split(b"\n")
    found = [_json(row) for row in rows]
    return found if rows and not end and None not in found else None


def _page(content: bytes) -> object:
    return content.rstrip().endswith(b"</html>") or None


def _table(content: bytes) -> object:
    lines = content.split(b"\n")
    return (lines[0], len(lines)) if content.endswith(b"\n") else None


def _picture(content: bytes) -> object:
    from PIL import Image

    try:
        with Image.open(io.BytesIO(content)) as picture:
            picture.load()
            return picture.size
    except OSError:
        return None


_KINDS = {
    ".json": _json,
    ".jsonl": _rows,
    ".ipynb": _json,
    ".html": _page,
    ".csv": _table,
    ".png": _picture,
    ".jpg": _picture,
    ".webp": _picture,
}
