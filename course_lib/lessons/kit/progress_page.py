"""Write the page of a student's progress, `work/progress.html`. `check` and `predict` update it."""

import contextlib
import datetime
import html
from collections.abc import Iterable, Sequence
from pathlib import Path

from course_lib.files import atomic_write
from course_lib.lessons.kit.lesson_progress import Progress, Table, tables, unknown_files
from course_lib.lessons.kit.student_record import record_folder

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
:root {{ color-scheme: light dark; --ink: #1f1f1f; --paper: #fff; --line: #8a8a8a; --band: #eef1f5; --bar: #2b6cb0; }}
@media (prefers-color-scheme: dark) {{
  :root {{ --ink: #e8e8e8; --paper: #1b1b1b; --line: #8f8f8f; --band: #2a2d31; --bar: #7db7ec; }}
}}
body {{ margin: 1rem auto; padding: 0 1rem; max-width: 62rem; font: 1rem/1.45 sans-serif; color: var(--ink);
  background: var(--paper); }}
.scrolls {{ overflow-x: auto; }}
table {{ border-collapse: collapse; width: 100%; margin: 1rem 0; }}
caption {{ text-align: left; font-weight: bold; font-size: 1.15rem; padding: 0.3rem 0; }}
th, td {{ text-align: left; vertical-align: top; padding: 0.3rem 0.6rem; border-bottom: 1px solid var(--line); }}
tbody th {{ font-weight: normal; }}
tr.done th, tr.done td, tfoot th, tfoot td {{ background: var(--band); }}
tfoot th, tfoot td {{ font-weight: bold; }}
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


def update_page() -> None:
    """Write the page again, beside the folder of the records. Without records, do nothing.

    A write error is ignored, because it must not disturb a lesson. The records are complete without the page, and
    `course.py progress` shows them.
    """
    folder = record_folder()
    if folder is not None:
        with contextlib.suppress(OSError):
            write_page(folder.parent / PAGE)


def write_page(path: Path) -> None:
    """Write the page of the present progress to `path`."""
    atomic_write(path, as_page(tables(), unknown_files(), datetime.datetime.now()))


def as_page(parts: Sequence[Table], said: Sequence[str], now: datetime.datetime) -> str:
    """Return the tables and sentences as HTML. The page loads nothing, and it shows every state as a word."""
    faults = [f"{one.contents.title}: {one.said}" for part in parts for one in part.parts if one.said]
    paragraphs = "".join(f"<p>{html.escape(sentence)}</p>\n" for sentence in [*faults, *said])
    return _HTML.format(now=f"{now:%Y-%m-%d %H:%M}", said=paragraphs, tables="\n".join(map(_table, parts)))


def _table(table: Table) -> str:
    head = "".join(f'<th scope="col">{html.escape(heading)}</th>' for heading in table.headings)
    rows = "\n".join(_row(table.cells(one), one) for one in table.parts)
    return (
        f'<div class="scrolls" tabindex="0" role="region" aria-label="{table.name}">\n<table>\n'
        f"<caption>{table.name}</caption>\n<thead><tr>{head}</tr></thead>\n<tbody>\n{rows}\n</tbody>\n"
        f"<tfoot>{_row(table.sums())}</tfoot>\n</table>\n</div>"
    )


def _row(cells: Iterable[str], one: Progress | None = None) -> str:
    name, checks, *others = map(html.escape, cells)
    if one is not None and one.contents.exercises:
        share = 100 * len(one.right) // len(one.contents.exercises)
        checks += f'<span class="bar" aria-hidden="true"><span style="width: {share}%"></span></span>'
    row = "".join(f"<td>{cell}</td>" for cell in (checks, *others))
    kind = ' class="done"' if one is not None and one.state == "done" else ""
    return f'<tr{kind}><th scope="row">{name}</th>{row}</tr>'
