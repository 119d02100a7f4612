"""Show a student's progress: print it, and write the page `work/progress.html`, which `check` and `predict` update.

python -m courseware.lessons.kit.show_progress [--out PAGE]     (`course.py progress`)
"""

import argparse
import contextlib
import datetime
import os
import sys
from collections.abc import Sequence
from pathlib import Path

import jinja2

from course_lib.files import atomic_write
from courseware.lessons.kit.lesson_progress import Table, tables, unknown_files
from courseware.lessons.kit.student_record import RECORD, record_folder
from courseware.paths import REPOSITORY

PAGE = "progress.html"

_PAGE = jinja2.Environment(autoescape=True, trim_blocks=True).from_string(
    Path(__file__).with_name("progress.html").read_text(encoding="utf-8")
)


def main(words: list[str]) -> int:
    """Print the progress, write the page, and return the exit code."""
    parser = argparse.ArgumentParser(prog="course.py progress")
    told = "where to write the page (default: work/progress.html)"
    parser.add_argument("--out", type=Path, metavar="PAGE", help=told)
    page = parser.parse_args(words).out
    os.environ.setdefault(RECORD, str(REPOSITORY / "work" / "record"))
    found = tables()
    print("\n\n".join(map(as_text, found)))
    for sentence in faults(found):
        print(f"\n{sentence}")
    if page is None:
        page = record_folder().parent / PAGE
        if not page.parent.is_dir():
            print("\nThere is no folder work/ yet: `python3 course.py lab` makes it.")
            return 0
    try:
        atomic_write(page, as_page(found, datetime.datetime.now()))
    except OSError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    print(f"\nThe same as a page: {page}")
    return 0


def update_page() -> None:
    """Write the page again, beside the folder of the records. Without records, do nothing.

    A write error is ignored, because it must not disturb a lesson. The records are complete without the page.
    """
    if (folder := record_folder()) is not None:
        with contextlib.suppress(OSError):
            atomic_write(folder.parent / PAGE, as_page(tables(), datetime.datetime.now()))


def faults(found: Sequence[Table]) -> list[str]:
    """Return a sentence for each damaged record and for each file that is no record."""
    return [f"{one.title}: {one.said}" for table in found for one in table.parts if one.said] + unknown_files()


def as_text(table: Table) -> str:
    rows = [table.headings, *table.rows()]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = ("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) for row in rows)
    return "\n".join(line.rstrip() for line in lines)


def as_page(found: Sequence[Table], now: datetime.datetime) -> str:
    """Return the tables and sentences as HTML. The page loads nothing, and it shows every state as a word."""
    return _PAGE.render(tables=found, said=faults(found), now=f"{now:%Y-%m-%d %H:%M}")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
