"""Checksums of generated data, and the models' parameters as Markdown tables, from the comments behind their fields."""

import dataclasses
import hashlib
import inspect
import re
from collections.abc import Sequence
from pathlib import Path


def checksums(folder: Path, products: Sequence[str]) -> str:
    """SHA-256 of every product in a folder, one line a file as `sha256sum` writes them; SHA256SUMS itself left out."""
    names = (path.relative_to(folder) for path in sorted(folder.rglob("*")) if path.is_file())
    made = [name for name in names if name.parts[0] in products and name.name != "SHA256SUMS"]
    return "".join(f"{hashlib.sha256((folder / n).read_bytes()).hexdigest()}  {n.as_posix()}\n" for n in made)


def parameter_tables(models: object, world: str) -> str:
    """A table for every dataclass among the fields of `models`, as one Markdown text; world: "corridor" or "room"."""
    parts = [f"# Parameters of the simulated {world}\n\nWritten by `make-data {world}` from the models' source text.\n"]
    fields = (getattr(models, field.name) for field in dataclasses.fields(models))
    return "\n".join([*parts, *(parameter_table(model) for model in fields if dataclasses.is_dataclass(model))])


def field_comments(model: object) -> dict[str, str]:
    """The comment behind every field of a dataclass instance, by field name."""
    return dict(re.findall(r"^    (\w+): [^=\n]+=[^#\n]+#\s*(.+)$", inspect.getsource(type(model)), flags=re.MULTILINE))


def parameter_table(model: object) -> str:
    """The table of one dataclass instance, as Markdown. Raises `KeyError` for a parameter without a comment."""
    comments = field_comments(model)
    title = (type(model).__doc__ or "").split("\n\n")[0].strip()
    rows = [
        f"| `{field.name}` | {getattr(model, field.name)} | {comments[field.name].replace('|', '/')} |"
        for field in dataclasses.fields(model)
    ]
    head = "| parameter | value | unit, meaning, source |\n|---|---|---|"
    return "\n".join([f"## {type(model).__name__}\n", f"{title}\n", head, *rows, ""])
