"""Outputs of a command in small, and what lies in a folder after it: for the tests of what writes."""

from course_lib.output_folder import MADE, replaced_outputs
from course_lib.unfinished import UNFINISHED


def names(folder):
    """Files below a folder, the list of what was made apart."""
    return sorted(p.relative_to(folder).as_posix() for p in folder.rglob("*") if not p.is_dir() and p.name != MADE)


def left_over(folder):
    return [path.name for path in folder.rglob(f"*{UNFINISHED}*")]


def make(out, contents, command="demo"):
    with replaced_outputs(out, command) as new:
        for name, text in contents.items():
            (new / name).parent.mkdir(parents=True, exist_ok=True)
            (new / name).write_text(text)
