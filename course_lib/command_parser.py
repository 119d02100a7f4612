"""A command's arguments: what does not fit is told in one sentence, with the nearest name, in place of a usage."""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterable, Sequence
from difflib import get_close_matches
from typing import NoReturn

LIKE = 0.6  # difflib's measure from which two names are alike, its own default
VERY_LIKE = 0.8  # chosen: of two words the first alone makes demo corridor and demo room alike

# argparse's words -> ours; what is not among them (another Python's words) is told as it is.
_SAID = (
    (r"argument (\S+): invalid int value: (.*)", r"\1 must be a whole number; got \2"),
    (r"argument (\S+): invalid float value: (.*)", r"\1 must be a number; got \2"),
    (r"argument (\S+): invalid choice: (.*?) \(choose from (.*)\)", r"\1 must be one of \3; got \2"),
    (r"argument (\S+): expected one argument", r"\1 needs a value"),
    (r"argument (\S+): expected (.*)", r"\1 needs \2"),
    (r"the following arguments are required: (.*)", r"\1 must be given"),
)


def meant(word: str, names: Iterable[str], like: float = LIKE) -> str:
    """ "; did you mean ...?" with the names that are most like a word; nothing where none is."""
    lower = {name.lower(): name for name in names}
    found = [lower[name] for name in get_close_matches(word.lower(), lower, n=3, cutoff=like)]
    return f"; did you mean {' or '.join(found)}?" if found else ""


class CommandParser(argparse.ArgumentParser):
    """Knows the options' names, and ends with code 2 and one sentence where the words do not fit."""

    def parse_args(self, args: Sequence[str], namespace: None = None) -> argparse.Namespace:
        """As argparse's, for the words of a command that takes no others than its own."""
        if any(word == "" or re.fullmatch(r"--[\w-]+=", word) for word in args):
            self.error("an empty word stands where a value is expected (a variable that is not set?): give one")
        found, others = self.parse_known_args(args, namespace)
        if others:
            name = others[0].partition("=")[0]
            option = name.startswith("-")
            what, like = ("option", meant(name, self._options())) if option else ("place for the word", "")
            self.error(f"{' '.join(others)}: there is no {what} {name!r}{like}")
        return found

    def error(self, message: str) -> NoReturn:
        """One sentence on standard error, and the end with code 2."""
        for said, ours in _SAID:
            message = re.sub(f"^{said}$", ours, message)
        stop = "" if message.endswith("?") else "."
        self.exit(2, f"error: {message}{stop} All options: python3 {self.prog} --help\n")

    def _options(self) -> list[str]:
        return [name for action in self._actions for name in action.option_strings]
