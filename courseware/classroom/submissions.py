"""A folder of what students handed in: whose each file is. What it holds, the judge reads.

    FOLDER/alice/06_likelihood_and_weights.ipynb                      a folder for each student
    FOLDER/alice_06.ipynb, FOLDER/alice.py                            the student in the file's name
    FOLDER/Alice Doe_12345_assignsubmission_file_/homework.ipynb      Moodle's download
    FOLDER/doealice_LATE_12345_67890_homework-1.ipynb                 Canvas's download

Links are not followed, and nothing here opens a file.
"""

import csv
import itertools
import os
import re
import stat
import unicodedata
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

MAX_FILES = 100
"""Of one student that are graded, and as many that are named as not read: a student can hand in no more work."""
MAX_DEPTH = 20  # folders within folders
READ = (".ipynb", ".py")
ARCHIVES = (".zip", ".tar", ".gz", ".tgz", ".7z", ".rar", ".bz2", ".xz")
OF_PROGRAMS = re.compile(
    r"__MACOSX|__pycache__|\._.*|\.(DS_Store|git|gitignore|idea|ipynb_checkpoints|vscode|venv|virtual_documents)"
)
"""What programs put beside a student's work."""
MOODLE = re.compile(r"^(?P<name>.+)_(?P<id>\d+)_assignsubmission_\w+?_?$")
CANVAS = re.compile(r"^(?P<name>[^\W\d_]+?)_(?:LATE_)?(?P<id>\d+)_\d+_(?P<rest>.+)$")
VERSION = re.compile(r"(?:[ _-]*\(\d+\)|[ _-]+v?\d{1,2}|[ _-]+(?:final|copy|copie|kopie|late))+$", re.IGNORECASE)
HIDDEN = (".", "__")
NOBODYS = "does not say whose it is: name it as in alice_06.ipynb, or put it into a folder of the student's name"
DATE = re.compile(r"[ _-]*(?:19|20)\d\d[-_.]?\d\d[-_.]?\d\d(?:[T_-]\d{4,6})?")
NAMES = ("name", "full name", "student", "user", "username", "login", "email address", "email", "sis login id")
NAMES += ("id", "identifier", "id number", "sis user id", "student id")
"""Columns of a roster that may name a student, as Moodle's and Canvas's exports call them."""


class SubmissionError(ValueError):
    """A folder or a roster that cannot be read; the message says why."""


class Submission(NamedTuple):
    """One file that is graded. guess: the lesson that its name says, or ""."""

    student: str
    path: Path
    guess: str = ""


@dataclass(frozen=True, order=True)
class NotRead:
    """One file that is not graded, and why. student: "" where nobody's."""

    student: str
    name: str
    why: str


@dataclass(frozen=True)
class Roster:
    """Who is in the class: the columns as they were given, and a row for each student's key."""

    columns: Sequence[str] = ()
    rows: dict[str, dict[str, str]] = field(default_factory=dict)
    keys: dict[str, str] = field(default_factory=dict)

    def find(self, *names: str) -> str:
        """Return the key of the student whom one of these names means, or ""."""
        return next((self.keys[key] for name in names if (key := plain(name)) in self.keys), "")


def collect(folder: Path, lessons: dict[str, str], roster: Roster | None = None) -> tuple[list, list]:
    """Return the submissions in a folder and what is not read. lessons: "06" -> "06_likelihood_and_weights".

    Raises `SubmissionError` if there is no folder or nothing in it.
    """
    folder, roster = Path(folder), roster or Roster()
    if not folder.is_dir() or not any(folder.iterdir()):
        what = "is empty" if folder.is_dir() else "is not a folder"
        raise SubmissionError(f"{folder} {what}: name the folder that holds what the students handed in")
    found: dict[str, list[Submission]] = defaultdict(list)
    not_read: dict[str, list[NotRead]] = defaultdict(list)
    for path in files_in(folder):
        relative = path.relative_to(folder)
        student, guess = whose(relative, lessons, roster)
        if why := refused(path) or ("" if student else NOBODYS):
            not_read[student].append(NotRead(student, shown(relative), why))
        else:
            found[student].append(Submission(student, path, guess))
    for files, what in ((not_read, "named here"), (found, "graded")):
        for student, some in files.items():
            if (more := len(some) - MAX_FILES) > 0:
                del some[MAX_FILES:]
                why = f"only {MAX_FILES} files of a student are {what}"
                not_read[student].append(NotRead(student, f"{more:,} more files", why))
    return sorted(itertools.chain(*found.values())), sorted(itertools.chain(*not_read.values()))


def files_in(folder: Path) -> Iterator[Path]:
    """Yield all files in a folder and below, and the folders into which we do not look."""
    for place, folders, names in os.walk(folder):
        deep = len(Path(place).relative_to(folder).parts) >= MAX_DEPTH
        closed = [name for name in folders if deep or name.startswith(HIDDEN) or (Path(place) / name).is_symlink()]
        folders[:] = sorted(set(folders) - set(closed))
        yield from (Path(place) / name for name in sorted([*names, *closed]) if not OF_PROGRAMS.fullmatch(name))


def refused(path: Path) -> str:
    """Return why a file or a folder is not read, or ""."""
    try:
        mode = path.lstat().st_mode
    except OSError as error:
        return f"cannot be looked at: {error.strerror}"
    if stat.S_ISLNK(mode):
        return "is a link: links are not followed"
    if path.name.startswith(HIDDEN if stat.S_ISDIR(mode) else "."):
        return f"is hidden, because its name begins with {path.name[0]}: rename it, then grade the folder again"
    if stat.S_ISDIR(mode):
        return f"is a folder within {MAX_DEPTH} others"
    if not stat.S_ISREG(mode):
        return "is no plain file"
    if path.suffix.lower() in ARCHIVES:
        return "is an archive: unpack it, then grade the folder again"
    return "" if path.suffix.lower() in READ else "is neither a notebook (.ipynb) nor a Python file (.py)"


def whose(relative: Path, lessons: dict[str, str], roster: Roster) -> tuple[str, str]:
    """Return the student and the lesson that a file's place and name tell; "" for what they do not tell."""
    stem = shown(relative.name.removesuffix(relative.suffix))
    folders = [shown(part) for part in relative.parts[:-1]]
    first, rest = folders[0] if folders else stem, stem
    if match := MOODLE.match(first) or CANVAS.match(first):
        names, rest = [match["id"], match["name"]], match.groupdict().get("rest", stem)
    else:
        names = [first if folders else _without_lesson(VERSION.sub("", DATE.sub("", stem)), lessons)]
    words = re.findall(r"[^\W_]+", DATE.sub("", rest))
    guesses = [word.upper() for word in [*words, *folders[1:]] if word.upper() in lessons]
    return roster.find(*names, *folders[:1]) or names[-1], guesses[0] if guesses else ""


def _without_lesson(stem: str, lessons: dict[str, str]) -> str:
    """Return a file's name without the lesson's: "alice_06_likelihood_and_weights" is alice's."""
    parts = re.split(r"[ _.-]+", stem)
    place = next((k for k, part in enumerate(parts) if part.upper() in lessons), len(parts))
    title = lessons[parts[place].upper()].split("_") if place < len(parts) else []
    kept = parts[:place] or [part for part in parts[place + 1 :] if part.lower() not in title]
    return VERSION.sub("", "_".join(kept)).strip(" _-")


def plain(name: str) -> str:
    """Return a name in one form for comparison: case, encoding, punctuation and order of words do not count."""
    words = re.findall(r"[^\W_]+", unicodedata.normalize("NFKC", name).casefold())
    return " ".join(sorted(words))


def read_roster(path: Path) -> Roster:
    """Read a class list, as an LMS exports it. Raises `SubmissionError`."""
    rows = read_table(path)
    headings = tuple(rows[0]) if rows else ()
    known = {heading.strip().casefold(): heading for heading in headings}
    columns = [known[name] for name in NAMES if name in known]
    first, last = known.get("first name"), known.get("last name") or known.get("surname")
    if not columns and not (first and last):
        raise SubmissionError(f"{path} has no column that names students: call one of them {', '.join(NAMES)}")
    by_key, keys = {}, {}
    for row in rows:
        names = [f"{row[first]} {row[last]}"] if first and last else []
        names += [row[column] for column in columns if row[column].strip()]
        for name in names:
            by_key.setdefault(names[0], row)
            forms = [name, name.partition("@")[0], re.sub(r"\W", "", name)]
            forms += ["".join(reversed(name.split(maxsplit=1)))] if " " in name else []
            forms += re.findall(r"(\d+)\D*$", name) if "participant" in name.casefold() else []
            for form in forms:
                keys.setdefault(plain(form), names[0])
    return Roster(headings, by_key, keys)


def read_table(path: Path) -> list[dict[str, str]]:
    """Read a CSV file with a heading, with commas, semicolons or tabs, as a spreadsheet or an LMS writes it.

    Raises `SubmissionError` if it is none.
    """
    try:
        lines = Path(path).read_text(encoding="utf-8-sig").splitlines()
        dialect = csv.Sniffer().sniff(lines[0], delimiters=",;\t")
        rows = list(csv.DictReader(lines, dialect=dialect))
        return [{heading: text or "" for heading, text in row.items() if heading is not None} for row in rows]
    except (OSError, UnicodeDecodeError, csv.Error, IndexError) as error:
        raise SubmissionError(f"{path} is not a CSV file with a heading ({error})") from error


def shown(name: object) -> str:
    """Return a name of the file system as text in one form (NFC), whatever its bytes are."""
    text = unicodedata.normalize("NFC", os.fsencode(str(name)).decode("utf-8", "replace"))
    return "".join(letter if letter.isprintable() else "\ufffd" for letter in text)
