"""What commands print and write: a progress bar, one JSON object or a text, a run's folder, a page in three dimensions.

A bar is drawn on standard error, so that the output of `--json` stays one object.
"""

import json
import sys
from collections.abc import Callable, Iterable
from pathlib import Path

from courseware.run_folder import run_folder


def progress_bar(description: str, unit: str = "frame") -> Callable[[Iterable], Iterable]:
    """Return a wrapper that draws a bar while its iterable is consumed."""
    from tqdm import tqdm

    def wrap(iterable: Iterable, total: int | None = None) -> Iterable:
        # Without a terminal one line every ten seconds still tells a log that the run is alive.
        interval = 0.1 if sys.stderr.isatty() else 10.0
        return tqdm(iterable, desc=description, unit=unit, total=total, mininterval=interval, file=sys.stderr)

    return wrap


WRITTEN = "\nWritten to {out}: {files}"  # the line that says where the files are


def print_and_write(arguments, command: str, summary: dict, text: str, write: Callable, told: str = WRITTEN) -> None:
    """Print `summary` with --json, else `text`. With --out, `write` fills that folder and returns the files' names."""
    print(json.dumps(summary) if arguments.json else text, flush=True)
    if arguments.out:
        with run_folder(arguments.out, command) as out:
            written = write(out)
        if told and not arguments.json:
            print(told.format(out=arguments.out, files=", ".join(written)))


def write_scene(path: Path, title: str, make: Callable[[], tuple]) -> str:
    """Write the scene that `make` gives (plotter, words) as a page. Return its name, or why there is no page."""
    from courseware.plots.scene_page import ScenePageError, write_page

    try:
        plotter, words = make()
        try:
            write_page(plotter, path, title, f"{title}. {words}", words)
        finally:
            plotter.close()
    except (ScenePageError, ImportError) as reason:
        return f"no {path.name} ({reason})"
    return f"{path.name} (to be turned in a browser)"
