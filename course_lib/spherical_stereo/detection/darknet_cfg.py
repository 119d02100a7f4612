"""The text of a Darknet cfg: sections of options, in the order of the layers.

    [convolutional]      # a section; everything after # or ; is a comment
    filters=32           # its options

Which layers there are and which of them leave the number of channels as it is stands here too, since an unknown one
would make the count of weights wrong. Source: paper 2, section 2.2 (YOLOv4 is published as such a file).
"""

from dataclasses import dataclass
from pathlib import Path

from course_lib.files import read_text

INPUT_KINDS = ("net", "network")
DETECTION_KINDS = ("yolo", "region")
SAME_CHANNELS = ("maxpool", "avgpool", "upsample", "dropout", "softmax", "shortcut", "sam", *DETECTION_KINDS)
LAYER_KINDS = ("convolutional", "route", "reorg", "scale_channels", *SAME_CHANNELS)


class DetectorError(ValueError):
    """A detector that cannot be set up: a file that is missing, malformed or does not fit the others, or an option."""


@dataclass(frozen=True)
class Section:
    """One `[kind]` block of a cfg."""

    kind: str
    """What stands between the brackets: "net", "convolutional", "route", ..."""
    options: dict[str, str]
    """`key=value` lines, as text; a key that comes twice keeps its last value, as in OpenCV."""
    line: int
    """Line of the bracket, from 1; for messages."""

    def integer(self, key: str, default: int | None = None) -> int:
        """The option as a whole number. Raises DetectorError: missing with no default, or no whole number."""
        text = self.options.get(key)
        if text is None:
            if default is None:
                raise DetectorError(f"[{self.kind}] at line {self.line} has no {key}: add {key}=...")
            return default
        try:
            return int(text)
        except ValueError:
            raise DetectorError(f"[{self.kind}] at line {self.line}: {key}={text} is not a whole number") from None

    def integers(self, key: str) -> list[int]:
        """The option as a list of whole numbers separated by commas. Raises DetectorError."""
        text = self.options.get(key, "")
        try:
            numbers = [int(part) for part in text.split(",") if part.strip()]
        except ValueError:
            numbers = []
        if not numbers:
            raise DetectorError(f"[{self.kind}] at line {self.line}: {key}={text} is not a list of whole numbers")
        return numbers


def read_cfg(path: str | Path) -> list[Section]:
    """Read a Darknet cfg: the `[net]` section first, then one section per layer, in order.

    Raises DetectorError: the file is missing or not text, a line is neither `[kind]`, `key=value` nor a comment, a
    section is unknown or empty, or the file does not start with `[net]`. Messages give the line number.
    """
    return parse_cfg(read_text(path, "cfg file", DetectorError), str(path))


def parse_cfg(text: str, name: str = "cfg") -> list[Section]:
    """The sections of a cfg given as text; `name` is used in messages. Raises DetectorError as `read_cfg` does."""
    sections: list[Section] = []
    for number, raw in enumerate(text.splitlines(), start=1):
        line = raw.split("#", 1)[0].split(";", 1)[0].strip()
        if not line:
            continue
        if line.startswith("[") and line.endswith("]"):
            sections.append(Section(line[1:-1].strip().lower(), {}, number))
            continue
        key, equals, value = (part.strip() for part in line.partition("="))
        if not (key and equals and value):
            raise DetectorError(f"{name}, line {number}: '{line}' is neither [section] nor key=value")
        if not sections:
            raise DetectorError(f"{name}, line {number}: '{line}' comes before any [section]; a cfg starts with [net]")
        sections[-1].options[key] = value
    _check_sections(sections, name)
    return sections


def _check_sections(sections: list[Section], name: str) -> None:
    if not sections:
        raise DetectorError(f"{name} has no [section]: a Darknet cfg starts with [net]")
    if sections[0].kind not in INPUT_KINDS:
        raise DetectorError(f"{name}, line {sections[0].line}: starts with [{sections[0].kind}], expected [net]")
    for section in sections[1:]:
        if section.kind not in LAYER_KINDS:
            known = ", ".join(sorted(LAYER_KINDS))
            raise DetectorError(f"{name}, line {section.line}: unknown section [{section.kind}], known are {known}")
    for section in sections:
        # These three work without options, as they stand in published cfgs; any other empty block is a slip.
        if not section.options and section.kind not in ("avgpool", "softmax", "maxpool"):
            raise DetectorError(f"{name}, line {section.line}: section [{section.kind}] is empty")
    if len(sections) == 1:
        raise DetectorError(f"{name} has a [net] section and no layer")


def render_cfg(sections: list[Section]) -> str:
    """The text of a cfg with these sections; comments are lost."""
    blocks = ["\n".join([f"[{s.kind}]", *(f"{key}={value}" for key, value in s.options.items())]) for s in sections]
    return "\n\n".join(blocks) + "\n"
