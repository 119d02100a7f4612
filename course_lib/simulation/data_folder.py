"""Folders of generated data: checked before the work, with checksums."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from pathlib import Path

from course_lib.files import require_writable


def require_folder(out: str | Path) -> Path:
    """`out` as an absolute path. Raises `ValueError` where it cannot be a folder, `OSError` where nothing
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
