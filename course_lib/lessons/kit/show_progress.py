"""Show a student's progress: print it, and write the page `work/progress.html`, which `check` and `predict` update.

python -m course_lib.lessons.kit.show_progress [--out PAGE]     (`course.py progress`)
"""

import argparse
import contextlib
import datetime
import html
import os
import sys
from collections.abc import Sequence
from pathlib import Path

from course_lib.files import atomic_write
from course_lib.lessons.kit.lesson_progress import Progress, Table, tables, unknown_files
from course_lib.lessons.kit.student_record import RECORD, record_folder
from course_lib.paths import REPOSITORY

PAGE = "progress.html"

_HTML = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; img-src data:">
<title>Your progress</title>
<link rel="icon" href="data:,">
<style>
:root {{ color-scheme: light dark; --line: #8a8a8a; --band: #eef1f5; --bar: #2b6cb0; }}
@media (prefers-color-scheme: dark) {{ :root {{ --band: #2a2d31; --bar: #7db7ec; }} }}
body {{ margin: 1rem auto; padding: 0 1rem; max-width: 62rem; font: 1rem/1.45 sans-serif; }}
.scrolls {{ overflow-x: auto; }}
table {{ border-collapse: collapse; width: 100%; margin: 1rem 0; }}
caption {{ text-align: left; font-weight: bold; font-size: 1.15rem; padding: 0.3rem 0; }}
th, td {{ text-align: left; vertical-align: top; padding: 0.3rem 0.6rem; border-bottom: 1px solid var(--line); }}
tbody th {{ font-weight: normal; }}
tr.done, tfoot {{ background: var(--band); }}
tfoot td {{ font-weight: bold; }}
.bar {{ display: block; height: 0.35rem; width: 6rem; border: 1px solid var(--line); }}
.bar span {{ display: block; height: 100%; background: var(--bar); }}
</style>
</head>
<body>
<main>
<h1>Your progress</h1>
<p>From your records on this computer alone (work/record); nothing is sent anywhere, nothing is marked. As of {now}.
A check that was right once stays right.</p>
{said}{tables}
</main>
</body>
</html>
"""


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
    said = "".join(f"<p>{html.escape(sentence)}</p>\n" for sentence in faults(found))
    return _HTML.format(now=f"{now:%Y-%m-%d %H:%M}", said=said, tables="\n".join(map(_table, found)))


def _table(table: Table) -> str:
    head = "".join(f'<th scope="col">{html.escape(heading)}</th>' for heading in table.headings)
    *rows, sums = map(_row, table.rows(), [*table.parts, None])
    body = "\n".join(rows)
    return (
        f'<div class="scrolls" tabindex="0" role="region" aria-label="{table.name}">\n<table>\n'
        f"<caption>{table.name}</caption>\n<thead><tr>{head}</tr></thead>\n<tbody>\n{body}\n</tbody>\n"
        f"<tfoot>{sums}</tfoot>\n</table>\n</div>"
    )


def _row(cells: Sequence[str], one: Progress | None) -> str:
    """Return a row with a bar in its second column. The row of the sums (None) has no bar."""
    name, checks, *others = map(html.escape, cells)
    if one is not None and one.exercises:
        share = 100 * len(one.right) // len(one.exercises)
        checks += f'<span class="bar" aria-hidden="true"><span style="width: {share}%"></span></span>'
    row = "".join(f"<td>{cell}</td>" for cell in (checks, *others))
    kind = ' class="done"' if one is not None and one.state == "done" else ""
    return f'<tr{kind}><th scope="row">{name}</th>{row}</tr>'


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
