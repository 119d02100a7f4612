"""Letters that the figures' own font lacks, such as Japanese ones: another font of the machine, or numbers in brackets.

Object names are the reader's, in any language; matplotlib brings a font of Latin, Greek and Cyrillic letters.
"""

from __future__ import annotations

import functools
import re
import unicodedata
import warnings
from collections.abc import Iterable

from matplotlib import font_manager
from matplotlib.backend_bases import RendererBase
from matplotlib.figure import Figure
from matplotlib.text import Text

_PLACEHOLDERS = "Last Resort"
"""In the name of a font that has a box for every letter there is."""


class LetteredFigure(Figure):
    """A figure whose texts are readable with the fonts of this machine."""

    def draw(self, renderer: RendererBase) -> None:
        make_readable(self)
        super().draw(renderer)


def make_readable(figure: Figure) -> None:
    """Gives texts with letters that their font lacks another one; without such a font, a number stands for each word.

    The numbers are told once, in one warning: which word each of them stands for.
    """
    lacking = [text for text in figure.findobj(Text) if missing_letters(text)]
    letters = frozenset().union(*map(missing_letters, lacking))
    if not letters:
        return
    font = font_with(letters)
    if font is not None:
        for text in lacking:
            text.set_fontfamily([*text.get_fontfamily(), font])
        return
    runs = re.compile("[" + "".join(map(re.escape, sorted(letters))) + "]+")
    words = sorted({word for text in lacking for word in runs.findall(text.get_text())})
    numbers = {word: f"[{number}]" for number, word in enumerate(words, start=1)}
    for text in lacking:
        text.set_text(runs.sub(lambda found: numbers[found[0]], text.get_text()))
    told = ", ".join(f"{number} {word}" for word, number in numbers.items())
    warnings.warn(
        f"no font of this machine has the letters of some names; in figures numbers stand for them: {told}. "
        "With a font such as Noto Sans CJK JP installed, figures show the names",
        stacklevel=2,
    )


def plain_labels(labels: Iterable[str]) -> dict[str, str]:
    """Each label in the letters that a scene's texts have, which is ASCII alone.

    Marks on letters are left out (é becomes e); for a label in another script a number stands, which one warning tells.
    """
    plain = {}
    for label in sorted(set(labels)):
        letters = [letter for letter in unicodedata.normalize("NFKD", label) if not unicodedata.combining(letter)]
        readable = all(letter.isascii() and letter.isprintable() for letter in letters) and "".join(letters).strip()
        plain[label] = "".join(letters) if readable else None
    others = [label for label, drawn in plain.items() if drawn is None]
    plain |= {label: f"[{number}]" for number, label in enumerate(others, start=1)}
    if others:
        told = ", ".join(f"{plain[label]} {label}" for label in others)
        warnings.warn(f"scenes are lettered in ASCII; in them numbers stand for some names: {told}", stacklevel=2)
    return plain


def missing_letters(text: Text) -> frozenset[str]:
    """The letters of a text that none of its fonts has."""
    letters = {letter for letter in text.get_text() if not letter.isascii() and letter.isprintable()}
    for family in text.get_fontfamily() if letters else ():
        letters = {letter for letter in letters if ord(letter) not in _letters_of(_font_file(family))}
    return frozenset(letters)


@functools.cache
def _font_file(family: str) -> str:
    return font_manager.findfont(font_manager.FontProperties(family=[family]))


@functools.cache
def _letters_of(path: str) -> frozenset[int]:
    return frozenset(font_manager.get_font(path).get_charmap())


@functools.cache
def font_with(letters: frozenset[str]) -> str | None:
    """The name of a font of this machine that has all these letters, one without serifs if there is one, or None."""
    entries = sorted(font_manager.fontManager.ttflist, key=lambda one: ("Serif" in one.name, one.name, one.fname))
    wanted = {ord(letter) for letter in letters}
    for entry in entries:
        if _PLACEHOLDERS in entry.name:
            continue
        try:
            if wanted <= _letters_of(entry.fname):
                return entry.name
        except (OSError, RuntimeError):  # deleted, or of a kind that matplotlib does not draw
            continue
    return None
