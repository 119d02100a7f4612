"""The models' parameters as Markdown tables: value, unit and source come from the models' own source text.

A field of a model is written `name: type = value  # unit, meaning; source or "chosen"`. The comment is the one place
where unit and source stand, so the tables cannot drift from the code.
"""

from __future__ import annotations

import dataclasses
import inspect
import re


def parameter_tables(models: object, world: str) -> str:
    """A table for every dataclass among the fields of `models`, as one Markdown text; world: "corridor" or "room".

    Raises `ValueError` for a parameter without a comment.
    """
    parts = [f"# Parameters of the simulated {world}\n\nWritten by `make-data {world}` from the models' source text.\n"]
    for field in dataclasses.fields(models):
        model = getattr(models, field.name)
        if dataclasses.is_dataclass(model):
            parts.append(parameter_table(model))
    return "\n".join(parts)


def field_comments(model: object) -> dict[str, str]:
    """The comment behind every field of a dataclass instance, by field name."""
    found = re.findall(r"^    (\w+): [^=\n]+=[^#\n]+#\s*(.+)$", inspect.getsource(type(model)), flags=re.MULTILINE)
    comments = dict(found)
    missing = [field.name for field in dataclasses.fields(model) if field.name not in comments]
    if missing:
        raise ValueError(f"{type(model).__name__}: no comment with unit and source behind {', '.join(missing)}")
    return comments


def parameter_table(model: object) -> str:
    """The table of one dataclass instance, as Markdown."""
    comments = field_comments(model)
    title = (type(model).__doc__ or "").split("\n\n")[0].strip()
    rows = [
        f"| `{field.name}` | {getattr(model, field.name)} | {comments[field.name].replace('|', '/')} |"
        for field in dataclasses.fields(model)
    ]
    head = "| parameter | value | unit, meaning, source |\n|---|---|---|"
    return "\n".join([f"## {type(model).__name__}\n", f"{title}\n", head, *rows, ""])
