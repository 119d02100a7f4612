"""Folders of generated data: checked before the work, filled at its end, all at once, with checksums."""

from __future__ import annotations

import hashlib
import shutil
from collections.abc import Sequence
from pathlib import Path

from course_lib.output_folder import replaced_outputs, require_writable


def require_folder(out: str | Path) -> Path:
    """`out` as an absolute path. Raises `ValueError` where it cannot be a folder, `WriteError` where nothing
    can be written there: now, not after minutes of work.
    """
    out = Path(out).resolve()
    existing = next(path for path in (out, *out.parents) if path.exists())
    if not existing.is_dir():
        raise ValueError(f"cannot make the folder {out}: {existing} is a file; give a folder, or a new name")
    require_writable(out)
    return out


def checksums(folder: Path, products: Sequence[str]) -> str:
    """SHA-256 of every product in a folder, one line a file as `sha256sum` writes them; SHA256SUMS itself left out."""
    files = sorted(
        path
        for path in folder.rglob("*")
        if path.is_file() and path.relative_to(folder).parts[0] in products and path.name != "SHA256SUMS"
    )
    lines = [f"{hashlib.sha256(p.read_bytes()).hexdigest()}  {p.relative_to(folder).as_posix()}\n" for p in files]
    return "".join(lines)


def move_products(folder: Path, out: Path, products: Sequence[str]) -> None:
    """Puts the finished products in the place of the earlier ones, all at once; what else is in `out` stays."""
    with replaced_outputs(out, "make-data", products) as new:
        for name in products:
            for path in sorted((folder / name, *(folder / name).rglob("*"))):
                if path.is_dir():
                    (new / path.relative_to(folder)).mkdir(parents=True)
                else:  # one by one: `copytree` would collect a full disk's errors, and tell none of them
                    shutil.copy2(path, new / path.relative_to(folder))
