"""A student's own copies of the lessons, in `work/`, which git ignores: `git pull` meets nothing that a student wrote.

Every lesson and project is copied once and then belongs to the student: nothing here writes to a copy again, and
nothing is deleted. What the lessons lean on (glossary, pictures, scenes) is copied as well, not linked, so that nothing
done in `work/` writes into a tracked file; such a copy follows the course for as long as nobody has changed it.
`work/.copies.json` remembers of which version each copy was made.
"""

from __future__ import annotations

import contextlib
import datetime
import json
import os
import tempfile
from collections.abc import Sequence
from pathlib import Path

from course_lib.commands.lesson_versions import (
    NOTEBOOKS,
    NotANotebookError,
    below_notebooks,
    changed_in_place,
    checksum,
    lessons,
    text_version,
    whole_version,
)

WORK, MEMORY = "work", ".copies.json"
_EARLIER = "earlier"  # in an entry of the memory: the entry before it, until the copy has changed as well
# What lessons show and link to. Not among it: projects/solutions, and scenes/yours, where a student's own scenes go.
COMPANIONS = ("*.md", "pictures/*", "scenes/*.html", "projects/*.md")


class WorkingCopiesError(RuntimeError):
    """A student's copies cannot be made: the message says where, why, and what to do."""


def as_number(word: str) -> str:
    """A lesson's number as its file's name begins with it: 06 for 6, P1 for p1."""
    return word.upper().zfill(2)


def copy_of(notebook: str, root: Path) -> str:
    """Path below the repository of what opens for `notebook`: of a lesson or project its copy, else the file itself.

    notebook: a number ("06"), a path below the repository, or an absolute one. Raises `ValueError` for a path that is
    not there or lies outside: JupyterLab shows what is below the repository.
    """
    numbers = lessons(root)
    named = numbers.get(as_number(notebook))
    path = Path(os.path.normpath(root / NOTEBOOKS / named if named else root / notebook))
    if not path.is_relative_to(root):
        raise ValueError(f"{notebook} lies outside {root}, where JupyterLab opens nothing: copy it into {root / WORK}")
    below = path.relative_to(root).as_posix()
    if below in {f"{NOTEBOOKS}/{name}" for name in numbers.values()}:
        return WORK + below.removeprefix(NOTEBOOKS)
    if not path.is_file():
        raise ValueError(f"there is no notebook {notebook} in {root}; see the folder {NOTEBOOKS}/")
    return below


def make_copies(root: Path, fresh: Sequence[str] = (), today: datetime.date | None = None) -> list[str]:
    """Copies every lesson that has no copy in work/ yet; returns what the student is to be told, a sentence each.

    fresh: numbers of lessons to begin anew; the old copy is renamed, `06_title.before-2026-11-23.ipynb`. today: None is
    the calendar's. All files are written beside their places and put there whole at the end, so a full disk leaves
    things as they were. Raises `ValueError` for a number without a lesson, `WorkingCopiesError` where nothing can be
    written.
    """
    known, work, numbers = lessons(root), root / WORK, {as_number(word) for word in fresh}
    if unknown := sorted(numbers - set(known)):
        raise ValueError(f"there is no lesson {', '.join(unknown)}; there are: {', '.join(known)}")
    if work.exists() and not work.is_dir():
        raise WorkingCopiesError(f"{work} is not a folder, and your copies of the lessons belong there: move it away")
    try:
        copies = _Copies(root, today or datetime.date.today())
        copies.decide(numbers)
        copies.write()
    except OSError as error:
        raise WorkingCopiesError(
            f"your copies of the lessons cannot be written to {work} ({error.strerror or error}); nothing of yours was "
            "changed. Make room on the disk, or put the course into a folder of your own, and call this again"
        ) from error
    return copies.sentences


class _Copies:
    """What stands in work/, what is to be written there, and what is to be said."""

    def __init__(self, root: Path, today: datetime.date) -> None:
        self.root, self.notebooks, self.work, self.today = root, root / NOTEBOOKS, root / WORK, today
        self.first = not (self.work / MEMORY).exists()
        self.sentences: list[str] = []
        self.contents: dict[str, bytes] = {}  # path below work/ -> what is to be written there
        self.set_aside: dict[str, str] = {}  # path below work/ -> new name of what stands there
        self.in_place = changed_in_place(root)
        self.unsettled = False  # whether a run was killed while the copies went to their places
        self.memory = self._remembered()
        self.earlier = dict(self.memory)

    def decide(self, fresh: set[str]) -> None:
        """Compares the course with the copies: afterwards all that is to be written and said is known."""
        remembered = json.dumps(self.memory)
        untouched = []
        if self.first:
            self.sentences.append(f"Your copies of the lessons are in {WORK}/, which git leaves alone.")
        for number, name in lessons(self.root).items():
            try:
                made_of = self._version(name)
            except NotANotebookError:
                self.sentences.append(
                    f"{NOTEBOOKS}/{name} is no notebook (did a merge stop half-way?) and is left out: "
                    f"`git checkout HEAD -- {NOTEBOOKS}/{name}` brings the course's back."
                )
                continue
            if not os.path.lexists(self.work / name) or number in fresh:
                self._copy_lesson(number, name, made_of)
            elif self.memory.setdefault(name, made_of).get("text") != made_of["text"]:
                if self._is_as_it_was_made(name):
                    untouched.append(number)
                else:
                    self.sentences.append(
                        f"Lesson {number} has changed since you began your copy: `python3 course.py lab --fresh "
                        f"{number}` starts the new one beside yours."
                    )
        if untouched:
            self.sentences.append(
                f"Changed by the course before you began: {', '.join(untouched)}. `python3 course.py lab --fresh "
                f"{' '.join(untouched)}` takes the new ones."
            )
        if self.in_place:
            paths = " ".join(f"{NOTEBOOKS}/{name}" for name in self.in_place)
            kept = all(name in self.contents for name in self.in_place)
            self.sentences.append(
                f"Changed in place, where git pull may stop at it: {paths}. "
                f"{'Your new copy holds that' if kept else f'Copy what you typed there into {WORK}/'}; then "
                f"`git checkout HEAD -- {paths}` brings the course's back."
            )
        for name in below_notebooks(self.root, COMPANIONS):
            self._follow(name)
        if json.dumps(self.memory) != remembered or MEMORY in self.set_aside or self.unsettled:
            self.contents[MEMORY] = json.dumps(self.memory, indent=1).encode()

    def _version(self, name: str) -> dict[str, str]:
        """Checksums of the course's version of a lesson, also where someone works in the course's own file."""
        here = (self.notebooks / name).read_bytes()
        text_version(here)  # what is no notebook is not copied
        content = self.in_place.get(name, here)
        return {"text": text_version(content), "whole": whole_version(content)}

    def _copy_lesson(self, number: str, name: str, made_of: dict[str, str]) -> None:
        if os.path.lexists(self.work / name):
            old = self.set_aside[name] = self._free_name(name)
            self.sentences.append(f"Lesson {number} begins anew; your earlier copy is now {WORK}/{old}.")
        elif not self.first:
            self.sentences.append(f"Lesson {number} is new in your folder: {WORK}/{name}.")
        self.contents[name] = (self.notebooks / name).read_bytes()
        self.memory[name] = made_of | {"made": self.today.isoformat()}

    def _follow(self, name: str) -> None:
        """Brings what the lessons lean on up to date, unless the student has changed it."""
        content = (self.notebooks / name).read_bytes()
        new, made, there = {"whole": checksum(content)}, self.memory.get(name), self.work / name
        found = {"whole": checksum(there.read_bytes())} if there.exists() else None
        if found in (None, made, new):
            self.memory[name] = new
            if found != new:
                self.contents[name] = content
        elif made not in (None, new):
            self.sentences.append(
                f"{WORK}/{name} is changed by you and stays; the course's new one: {NOTEBOOKS}/{name}."
            )

    def _is_as_it_was_made(self, name: str) -> bool:
        with contextlib.suppress(NotANotebookError, OSError):
            return whole_version((self.work / name).read_bytes()) == self.memory[name]["whole"]
        return False

    def _free_name(self, name: str) -> str:
        """Where an earlier file goes: beside the new one, under a name that nothing has yet."""
        stem, ending = os.path.splitext(name)
        additions = ["", *(f"-{n}" for n in range(2, 10_000))]
        names = (f"{stem}.before-{self.today.isoformat()}{addition}{ending}" for addition in additions)
        return next(free for free in names if not os.path.lexists(self.work / free))

    def _remembered(self) -> dict[str, dict]:
        """What `.copies.json` says. One that cannot be read is set aside; copies then count as the present lessons'."""
        try:
            memory = json.loads((self.work / MEMORY).read_text(encoding="utf-8"))
            entries = [*memory.values(), *(entry[_EARLIER] for entry in memory.values() if entry.get(_EARLIER))]
            if all(isinstance(entry["whole"] + entry.get("text", ""), str) for entry in entries):
                self.unsettled = any(_EARLIER in entry for entry in memory.values())
                return {name: self._settled(name, entry) for name, entry in memory.items()}
        except FileNotFoundError:
            return {}
        except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
            pass
        self.set_aside[MEMORY] = self._free_name(MEMORY)
        self.sentences.append(
            f"{WORK}/{MEMORY}, which remembers your copies' versions, could not be read; it is kept as "
            f"{WORK}/{self.set_aside[MEMORY]}, and your copies stay as they are."
        )
        return {}

    def _settled(self, name: str, entry: dict) -> dict:
        """What is remembered of a copy, also where a run was killed between remembering it and putting it there."""
        earlier = entry.pop(_EARLIER, None)
        if not earlier:
            return entry
        with contextlib.suppress(NotANotebookError, OSError):
            content = (self.work / name).read_bytes()
            if (whole_version(content) if name.endswith(".ipynb") else checksum(content)) == entry["whole"]:
                return entry
        return earlier

    def write(self) -> None:
        """Writes all files beside their places, then puts each there in one step.

        First of all goes what is remembered, so that a copy never stands there unremembered: the new, and while the
        copies go to their places the earlier beside it, for a run that is killed then. Last the new alone.
        """
        if not self.contents:
            return None
        empty = not self.work.exists()
        self.work.mkdir(exist_ok=True)
        try:
            with tempfile.TemporaryDirectory(dir=self.work, prefix=".") as folder:
                stage = Path(folder)
                beside = {name: stage / str(index) for index, name in enumerate(self.contents)}
                for name, path in beside.items():
                    path.write_bytes(self.contents[name])
                meanwhile = {
                    name: entry | ({_EARLIER: self.earlier[name]} if self.earlier.get(name, entry) != entry else {})
                    for name, entry in self.memory.items()
                }
                (stage / MEMORY).write_text(json.dumps(meanwhile, indent=1), encoding="utf-8")
                if MEMORY in self.contents:
                    self._put(stage / MEMORY, MEMORY)
                for name in sorted(beside, key=lambda name: name == MEMORY):
                    (self.work / name).parent.mkdir(exist_ok=True)
                    self._put(beside[name], name)
        except OSError:
            if empty:
                with contextlib.suppress(OSError):
                    self.work.rmdir()  # only an empty folder goes
            raise

    def _put(self, path: Path, name: str) -> None:
        target = self.work / name
        if name in self.set_aside:
            _link(target, self.work / self.set_aside.pop(name))
            os.replace(path, target)
        elif name.endswith(".ipynb"):
            with contextlib.suppress(FileExistsError):  # another lab, started at the same time, was faster
                _link(path, target)
        else:
            os.replace(path, target)


def _link(path: Path, name: Path) -> None:
    """Gives a file a second name, or where file systems know none, its only one. Raises `FileExistsError`."""
    try:
        os.link(path, name)
    except FileExistsError:
        raise
    except OSError:
        if os.path.lexists(name):
            raise FileExistsError(f"{name} is there already") from None
        os.rename(path, name)
