"""How long a lesson takes and how its text reads: the model of minutes, which `refresh` writes into the first cell.

    minutes = words / 130 + code lines / 10 + figures + 8 x panels + exercises

An exercise takes 4 minutes (warm-up), 9 (core) or 30 (challenge). Hints and solutions are not counted, because the
exercise's minutes hold them. The core path leaves out all cells that are tagged `more`.
"""

import argparse
import re
import statistics
import sys
from typing import NamedTuple

import nbformat

from course_lib.files import atomic_write
from courseware.paths import REPOSITORY, numbered_paths

WORDS_A_MINUTE, LINES_A_MINUTE, A_FIGURE, A_PANEL = 130, 10, 1, 8
AN_EXERCISE = {"warm-up": 4, "core": 9, "challenge": 30}
STATED = re.compile(r"\*\*About \d+ minutes\*\* \(\d+ with all parts marked \*More\*\)")
PAGES = [REPOSITORY / name for name in ("TEACHING.md", "notebooks/README.md")]


class Pace(NamedTuple):
    """What one part of a lesson holds."""

    words: int
    code: int  # lines that are shown
    figures: int
    panels: int
    exercises: float  # minutes

    @property
    def minutes(self) -> int:
        """Return the minutes of the model, rounded."""
        reading = self.words / WORDS_A_MINUTE + self.code / LINES_A_MINUTE
        return round(reading + A_FIGURE * self.figures + A_PANEL * self.panels + self.exercises)


def tags(cell) -> list[str]:
    """Return the tags of a cell."""
    return cell.metadata.get("tags", [])


def prose(cells: list) -> str:
    """Return the text of Markdown cells, without mathematics, code, marks and addresses."""
    text = "\n\n".join(c.source for c in cells if c.cell_type == "markdown" and not {"hint"} & set(tags(c)))
    for pattern, instead in (
        (r"```.*?```|\$\$.*?\$\$|<[^>]+>|^\|[-|: ]+\|$", " "),
        (r"\$[^$]*\$|`[^`]*`", "x"),
        (r"\]\([^)]*\)|[*#|\[]", " "),
    ):
        text = re.sub(pattern, instead, text, flags=re.S | re.M)
    return text


def words(text: str) -> int:
    """Return the number of words of a text."""
    return len(re.findall(r"[A-Za-z][A-Za-z'’-]*", text))


def pace(cells: list) -> Pace:
    """Return what these cells hold."""
    shown = [
        c
        for c in cells
        if c.cell_type == "code"
        and not c.metadata.get("jupyter", {}).get("source_hidden")
        and "solution" not in tags(c)
    ]
    kinds = [o.get("data", {}).get("text/plain", "").partition(" ")[0] for c in shown for o in c.outputs]
    headings = [c.source.partition("\n")[0] for c in cells if "task" in tags(c)]
    levels = [(re.findall(r" · (warm-up|challenge)$", heading) or ["core"])[0] for heading in headings]
    return Pace(
        words(prose(cells)),
        sum(len(c.source.splitlines()) for c in shown),
        sum(kind == "Picture:" for kind in kinds),
        sum(kind == "Panel" for kind in kinds),
        sum(AN_EXERCISE[level] for level in levels),
    )


def core_and_all(notebook: nbformat.NotebookNode) -> tuple[Pace, Pace]:
    """Return what the core path and the whole lesson hold."""
    return pace([c for c in notebook.cells if "more" not in tags(c)]), pace(notebook.cells)


def write_minutes(notebook: nbformat.NotebookNode) -> None:
    """Write the minutes of the model into the first cell, where it states them (`STATED`)."""
    core, everything = (part.minutes for part in core_and_all(notebook))
    stated = f"**About {core} minutes** ({everything} with all parts marked *More*)"
    notebook.cells[0].source = STATED.sub(stated, notebook.cells[0].source)


def reading(notebook: nbformat.NotebookNode) -> tuple[float, float]:
    """Return how many colons there are in 1,000 words, and the median number of words in a sentence."""
    text = prose(notebook.cells)
    lengths = [n for n in map(words, re.split(r"[.?!](?:\s|$)|\n\s*\n", text)) if n > 2]
    return 1000 * len(re.findall(r"[\w)]:(?:\s|$)", text)) / max(words(text), 1), statistics.median(lengths)


def with_minutes(line: str, minutes: dict[str, int]) -> str:
    """Return a line of notebooks/README.md or TEACHING.md with the minutes of its lessons, or with their sum."""
    if row := re.match(r"\| \[(\w\d) (?:· )?|### ([0-9F]\d) · ", line):
        number = row[1] or row[2]
        return re.sub(r"\(\d+ min\)|\d+ min(?= \|$)", lambda m: re.sub(r"\d+", str(minutes[number]), m[0]), line)
    if path := re.match(r"(\| [a-z0-9 ]+ \| ((?:\d\d(?:, )?)+) \| )\d+ h \d+ min \|$", line):
        hours, rest = divmod(sum(minutes[number] for number in path[2].split(", ")), 60)
        return f"{path[1]}{hours} h {rest} min |"
    if meeting := re.match(r"(\| \d+ \| ((?:\d\d(?:, )?)+) \| )(\d+) \| (\d+) \| (.*)", line):
        lessons = sum(minutes[number] for number in meeting[2].split(", "))
        talk = int(meeting[3]) + int(meeting[4]) - lessons
        at_home = re.sub(r"lesson (\d\d) \(\d+ min\)", lambda m: f"lesson {m[1]} ({minutes[m[1]]} min)", meeting[5])
        return f"{meeting[1]}{lessons} | {talk} | {at_home}"
    return line


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `pace`."""
    parser.add_argument("lessons", nargs="*", metavar="NN", help="lessons, such as 03 or F1 (default: all)")
    what = "write the minutes into first cells, and of all lessons into notebooks/README.md and TEACHING.md"
    parser.add_argument("--write", action="store_true", help=what)


def run(arguments: argparse.Namespace) -> int:
    """Print one line a lesson."""
    paths = {number: path for number, path in numbered_paths().items() if not number.startswith("P")}
    minutes = {}
    print("lesson  core: words lines figures min   all: words lines figures min   colons in 1,000 words, sentence")
    for number in arguments.lessons or sorted(paths):
        notebook = nbformat.read(paths[number], as_version=4)
        core, everything = core_and_all(notebook)
        minutes[number] = core.minutes
        columns = "   ".join(f"{p.words:12} {p.code:5} {p.figures:7} {p.minutes:3}" for p in (core, everything))
        colons, sentence = reading(notebook)
        print(f"{number:6} {columns}   {colons:10.1f} {sentence:12.0f}")
        if arguments.write:
            write_minutes(notebook)
            atomic_write(paths[number], nbformat.writes(notebook) + "\n")
    for page in PAGES if arguments.write and not arguments.lessons else ():
        lines = page.read_text(encoding="utf-8").splitlines()
        atomic_write(page, "\n".join(with_minutes(line, minutes) for line in lines) + "\n")
    return 0


if __name__ == "__main__":
    from courseware.cli import tool

    sys.exit(tool("tools.pace"))
