"""Draw both papers' flow charts as SVG: notebooks/pictures/flow_depth_mcl.svg and flow_spherical_stereo.svg.

    python -m tools.flow_charts

The steps and their lessons are read from the table of notebooks/README.md. A box links to its lesson.
"""

import re
import sys
from argparse import ArgumentParser, Namespace
from html import escape
from itertools import zip_longest

from course_lib.files import atomic_write
from courseware.paths import REPOSITORY

NOTEBOOKS = REPOSITORY / "notebooks"
WIDTH, HEIGHT, GAP, MARGIN = 420, 58, 26, 42  # of the chart, of a box, between boxes, beside boxes: pixels
STYLE = (
    "text { font: 14.5px 'DejaVu Sans', Verdana, sans-serif; fill: #111; text-anchor: middle }"
    " .note { font-size: 12.5px; fill: #444 } rect { fill: #e8f1f8; stroke: #0072b2; stroke-width: 1.6; rx: 7 }"
    " a:hover rect, a:focus rect { fill: #ffe9b8 } .arrow { stroke: #444; stroke-width: 1.8; fill: none }"
)
CHARTS = {  # name -> title, and the step to which the last one leads back
    "flow_depth_mcl": ("Paper 1, figure 1: the steps of the particle filter", 1),
    "flow_spherical_stereo": ("Paper 2, figure 2: from two panoramas to a pose", None),
}


def steps(column: int) -> list[tuple[str, str, str]]:
    """Return (words, file of the lesson, note) of every step in a column of the table, top down."""
    table = re.findall(r"^\| (\[.+?) \| (\[.+?) \|$", (NOTEBOOKS / "README.md").read_text(encoding="utf-8"), re.M)
    found = [re.fullmatch(r"\[(.+?)\]\((\d\d_\w+\.ipynb)\)(?:, ([^;]+).*)?", row[column]) for row in table]
    return [(one[1], one[2], one[3] or "") for one in found if one]


def chart(title: str, rows: list[tuple[str, str, str]], back_to: int | None) -> str:
    """Return the SVG of one chart."""
    height = 40 + len(rows) * (HEIGHT + GAP)
    middle, right, tops = WIDTH / 2, WIDTH - MARGIN, range(40, height, HEIGHT + GAP)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" role="img" aria-label="{title}">',
        f"<title>{title}</title><style>{STYLE}</style>",
        '<defs><marker id="head" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="6" markerHeight="6" orient="auto">'
        '<path d="M0 0L8 4L0 8z" fill="#444"/></marker></defs>',
        f'<rect x="0" y="0" width="{WIDTH}" height="{height}" style="fill: #fff; stroke: none"/>',
        f'<text x="{middle}" y="24" class="note">{title}</text>',
    ]
    for top, below, (words, lesson, note) in zip_longest(tops, tops[1:], rows):
        small = f"lesson {lesson[:2]}" + f" · {note}" * bool(note)
        parts.append(
            f'<a href="../{lesson}" target="_top"><rect x="{MARGIN}" y="{top}" width="{WIDTH - 2 * MARGIN}"'
            f' height="{HEIGHT}"/><text x="{middle}" y="{top + 25}">{escape(words)}</text>'
            f'<text x="{middle}" y="{top + 45}" class="note">{escape(small)}</text></a>'
        )
        if below:
            parts.append(f'<path class="arrow" marker-end="url(#head)" d="M{middle} {top + HEIGHT}V{below - 1}"/>')
    if back_to is not None:
        start, end = tops[-1] + HEIGHT / 2, tops[back_to] + HEIGHT / 2
        parts.append(f'<path class="arrow" marker-end="url(#head)" d="M{right} {start}h22V{end}h-20"/>')
        turned = f"translate({right + 34} {(start + end) / 2}) rotate(90)"
        parts.append(f'<text class="note" transform="{turned}" dy="4">next image</text>')
    return "\n".join([*parts, "</svg>", ""])


def add_arguments(parser: ArgumentParser) -> None:
    """Declare no options."""


def run(arguments: Namespace) -> int:
    """Write both charts."""
    for column, (name, (title, back_to)) in enumerate(CHARTS.items()):
        atomic_write(NOTEBOOKS / "pictures" / f"{name}.svg", chart(title, steps(column), back_to))
    return 0


if __name__ == "__main__":
    from courseware.cli import tool

    sys.exit(tool("tools.flow_charts"))
