"""The folder in which a command keeps its results."""

import contextlib
import json
import sys
from collections.abc import Iterator
from datetime import datetime
from pathlib import Path

from course_lib.files import atomic_write, staging_dir
from courseware.paths import REPOSITORY


@contextlib.contextmanager
def run_folder(out: str | Path | None, command: str) -> Iterator[Path]:
    """Yield a folder for the results of one run of `command`, and say where they are when the body has ended.

    out: None makes `results/COMMAND/TIME`. `run.json` is written last: a folder without it is not whole.
    """
    if out is None:
        out = REPOSITORY / "results" / command.replace(" ", "_") / datetime.now().strftime("%Y-%m-%d_%H-%M-%S")
    out = Path(out)
    with staging_dir(out) as new:
        yield new
        (out / "run.json").unlink(missing_ok=True)
        files = sorted(path.relative_to(new).as_posix() for path in new.rglob("*") if path.is_file())
    atomic_write(out / "run.json", json.dumps({"command": command, "files": files}, indent=1) + "\n")
    print(f"results: {out}", file=sys.stderr)
