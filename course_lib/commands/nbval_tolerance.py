"""A pytest plugin: nbval compares a cell's numbers with the tolerance that the cell declares, and all else exactly.

A cell declares it in a comment at the end of a line, for whoever reads it:

    print(f"median error {error:.4f} m")  # numbers within 5 %
    print(f"median error {error:.4f} m")  # numbers within 0.002
    print(f"median error {error:.4f} m")  # numbers within 5 % or 0.002

It holds for every number that the cell prints or writes under a picture: the stored one and the new one may differ by
so many percent of the stored one, or by so much. A processor that rounds other last digits, after many steps, comes to
slightly other numbers; the words between them stay. Loaded with `-p course_lib.commands.nbval_tolerance`.
"""

from __future__ import annotations

import copy
import re
from typing import NamedTuple

NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
DECLARED = re.compile(r"#\s*numbers within\s+(?:(\d+(?:\.\d+)?)\s*%)?(?:\s*or\s+)?(\d+(?:\.\d+)?)?\s*$", re.MULTILINE)


class Tolerance(NamedTuple):
    """How far a new number may lie from the stored one: the larger of the two."""

    share: float
    absolute: float

    def holds(self, stored: float, new: float) -> bool:
        return abs(new - stored) <= max(self.share * abs(stored), self.absolute) * (1 + 1e-9)


def declared_tolerance(source: str) -> Tolerance | None:
    """What a cell's code declares, or None. Raises `ValueError` for a declaration that nobody can read."""
    if not re.search(r"#\s*numbers within", source):
        return None
    found = DECLARED.findall(source)
    if len(found) != 1 or not any(found[0]):
        raise ValueError(
            "a cell declares one tolerance, such as '# numbers within 5 %' or '# numbers within 5 % or 0.002'; "
            f"got {re.findall(r'#.*numbers within.*', source)}"
        )
    percent, absolute = found[0]
    return Tolerance(float(percent or 0) / 100, float(absolute or 0))


def within_tolerance(new: str, stored: str, tolerance: Tolerance) -> str:
    """`stored` where the new text says the same words and its numbers hold the tolerance, else `new`.

    Spaces between words count as one: a number with a digit more moves what stands beside it.
    """
    words = [re.sub(r"\s+", " ", text) for text in (NUMBER.sub("#", new), NUMBER.sub("#", stored))]
    numbers = [[float(number) for number in NUMBER.findall(text)] for text in (new, stored)]
    if words[0] != words[1] or len(numbers[0]) != len(numbers[1]):
        return new
    return stored if all(tolerance.holds(b, a) for a, b in zip(*numbers, strict=True)) else new


def adopted(new: list[dict], stored: list[dict], tolerance: Tolerance, sanitize) -> list[dict]:
    """The new outputs, with the stored text wherever that holds the tolerance."""
    new, left = copy.deepcopy(new), [dict(texts(output)) for output in stored]
    for index, output in enumerate(new):
        if index >= len(left):
            break
        for key, text in texts(output):
            if key in left[index]:
                text = within_tolerance(sanitize(text), sanitize(left[index][key]), tolerance)
                output.update({"text": text}) if key == "text" else output["data"].update({key: text})
    return new


def texts(output: dict) -> list[tuple[str, str]]:
    """The texts of an output by key: of a stream, or of each form in which something is displayed."""
    parts = {"text": output["text"]} if "text" in output else dict(output.get("data", {}))
    return [(key, "".join(text) if isinstance(text, list) else text) for key, text in parts.items()]


def pytest_configure() -> None:
    """Lets nbval adopt what holds its cell's tolerance before it compares."""
    try:
        from nbval.plugin import IPyNbCell
    except ImportError:  # a run without lessons switches nbval off
        return
    compare = IPyNbCell.compare_outputs
    if getattr(compare, "knows_tolerance", False):
        return

    def compare_with_tolerance(self, test, ref, skip_compare=None):
        tolerance = declared_tolerance(self.cell.source)
        if tolerance is not None:
            test = adopted(test, ref, tolerance, self.sanitize)
        return compare(self, test, ref, skip_compare)

    compare_with_tolerance.knows_tolerance = True
    IPyNbCell.compare_outputs = compare_with_tolerance
