"""Print a student's progress and write it as a page. `course.py progress` runs this in another process.

python -m course_lib.lessons.kit.show_progress [--out PAGE]
"""

import argparse
import os
import sys
from pathlib import Path

from course_lib.lessons.kit.lesson_progress import tables, unknown_files
from course_lib.lessons.kit.progress_page import PAGE, write_page
from course_lib.lessons.kit.student_record import RECORD, record_folder
from course_lib.paths import REPOSITORY


def main(words: list[str]) -> int:
    """Print the progress, write the page, and return the exit code."""
    parser = argparse.ArgumentParser(prog="course.py progress")
    parser.add_argument(
        "--out", type=Path, metavar="PAGE", help="where to write the page (default: work/progress.html)"
    )
    arguments = parser.parse_args(words)
    os.environ.setdefault(RECORD, str(REPOSITORY / "work" / "record"))
    parts = tables()
    print("\n\n".join(part.as_text() for part in parts))
    faults = [f"{one.contents.title}: {one.said}" for part in parts for one in part.parts if one.said]
    for sentence in [*faults, *unknown_files()]:
        print(f"\n{sentence}")
    page = arguments.out or record_folder().parent / PAGE
    if not arguments.out and not page.parent.is_dir():
        print("\nThere is no folder work/ yet: `python3 course.py lab` makes it.")
        return 0
    try:
        write_page(page)
    except OSError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    print(f"\nThe same as a page: {page}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
