"""A pytest plugin: nbval compares a cell's numbers with the tolerance that the cell declares, and all else exactly.

A cell declares it in its metadata, out of the reader's sight, as "5 %", "0.002" or "5 % or 0.002":

    "metadata": {"numbers_within": "5 % or 0.002"}

It holds for every number that the cell prints or writes under a picture: the new one may differ by so many percent of
the stored one, or by so much. The words between them stay. Loaded with `-p courseware.commands.nbval_tolerance`.
"""

import copy
import re
from typing import NamedTuple

NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
DECLARED = re.compile(r"(?:(\d+(?:\.\d+)?) %)?(?:(?:^| or )(\d+(?:\.\d+)?))?")


class Tolerance(NamedTuple):
    """How far a new number may lie from the stored one: the larger of the two."""

    share: float
    absolute: float


def declared_tolerance(cell: dict) -> Tolerance | None:
    """Return what a cell's metadata declares, or None. Raises `ValueError` for a declaration that nobody can read."""
    if (declared := cell["metadata"].get("numbers_within")) is None:
        return None
    found = DECLARED.fullmatch(declared)
    if not found or not any(found.groups()):
        raise ValueError(f"numbers_within must be such as '5 %', '0.002' or '5 % or 0.002'; got {declared!r}")
    return Tolerance(float(found[1] or 0) / 100, float(found[2] or 0))


def within_tolerance(new: str, stored: str, tolerance: Tolerance) -> str:
    """Return `stored` if the new text says the same words and its numbers hold the tolerance, else `new`."""
    # Spaces between words count as one: a number with a digit more moves what stands beside it.
    words = [re.sub(r"\s+", " ", NUMBER.sub("#", text)) for text in (new, stored)]
    if words[0] != words[1]:
        return new
    pairs = zip(map(float, NUMBER.findall(new)), map(float, NUMBER.findall(stored)), strict=True)
    held = all(abs(a - b) <= max(tolerance.share * abs(b), tolerance.absolute) * (1 + 1e-9) for a, b in pairs)
    return stored if held else new


def adopted(new: list[dict], stored: list[dict], tolerance: Tolerance, sanitize) -> list[dict]:
    """Return the new outputs, with the stored text wherever that holds the tolerance."""
    new = copy.deepcopy(new)
    for output, left in zip(new, stored, strict=False):
        for key, text in texts(output).items():
            if key in texts(left):
                text = within_tolerance(sanitize(text), sanitize(texts(left)[key]), tolerance)
                (output if key == "text" else output["data"])[key] = text
    return new


def texts(output: dict) -> dict[str, str]:
    """Return the texts of an output by key: of a stream, or of each form in which something is displayed."""
    parts = {"text": output["text"]} if "text" in output else output.get("data", {})
    return {key: "".join(text) if isinstance(text, list) else text for key, text in parts.items()}


def pytest_configure() -> None:
    """Let nbval adopt the numbers that hold their cell's tolerance before it compares."""
    try:
        from nbval.plugin import IPyNbCell
    except ImportError:  # a run without lessons switches nbval off
        return
    compare = IPyNbCell.compare_outputs

    def compare_with_tolerance(self, test, ref, skip_compare=None):
        tolerance = declared_tolerance(self.cell)
        return compare(self, adopted(test, ref, tolerance, self.sanitize) if tolerance else test, ref, skip_compare)

    if compare.__name__ != compare_with_tolerance.__name__:
        IPyNbCell.compare_outputs = compare_with_tolerance
