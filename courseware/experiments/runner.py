"""Run an experiment for many seeds: on every processor, each result kept as a line of a file and used again.

An experiment is a module with a function of a seed and a few parameters, a table, and a `run` that puts both together
for the command `demo`. A file of rows holds one JSON object a line, {"point": parameters, "result": what came out}.
"""

import json
import os
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

from filelock import FileLock, Timeout
from joblib import Parallel, cpu_count, delayed


class Outcome(NamedTuple):
    """What an experiment gives to the command that runs it."""

    summary: dict  # The numbers, for JSON
    text: str  # The table
    files: dict[str, tuple[dict, list[dict] | None]]  # By the JSON file's name: numbers, rows for a CSV file beside it
    figures: str = ""  # Which function of `commands.demo_figures` draws the figures; none where it is empty
    drawn: object = None  # What they are drawn from


def no_bar(text: str, unit: str = "") -> Callable[[Iterable], Iterable]:
    """Return a wrapper of a loop that draws no progress bar."""
    return iter


class Runner(NamedTuple):
    """Where an experiment runs."""

    folder: Path  # Of the files of rows
    temporary: Path  # An empty folder, which is removed when the figures are drawn
    processes: int | None = None  # At a time; None: one for each processor
    bar: Callable[..., Callable[[Iterable], Iterable]] = no_bar  # Wraps a loop, given words and the unit of the count

    def rows(self, function: Callable, points: Sequence[dict], name: str, unit: str = "seed") -> list:
        """`kept_rows` in the file `name`.jsonl."""
        return kept_rows(function, points, self.folder / f"{name}.jsonl", self.processes, self.bar(name, unit))


def kept_rows(
    function: Callable,
    points: Sequence[dict],
    path: Path,
    processes: int | None = None,
    progress: Callable[[Iterable], Iterable] = iter,
) -> list:
    """Return `function(**point)` of every point, in their order; points that the file at `path` holds are not run.

    function: of a module; its result is what JSON can hold. A result is written as soon as it is there, so that a run
    that was stopped goes on where it was. processes: calls at a time (None: one for each processor).
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    try:
        with FileLock(path.with_name(f".{path.name}.lock"), timeout=0):
            results = _read(path)
            missing = [point for point in points if _key(point) not in results]
            workers = max(1, min(processes or cpu_count(), len(missing)))
            parallel = Parallel(workers, batch_size=1, return_as="generator_unordered")
            computed = parallel(delayed(_call)(function, point, workers > 1) for point in missing)
            with path.open("ab") as file:
                for _ in progress(missing):
                    line = json.dumps(next(computed), allow_nan=False).encode() + b"\n"
                    file.write(line)
                    file.flush()
                    results |= _results([line])
    except Timeout:
        raise RuntimeError(f"{path} is being written by another run: wait for it, or give another --out") from None
    return [results[_key(point)] for point in points]


def _key(point: dict) -> str:
    return json.dumps(point, sort_keys=True)


def _call(function: Callable, point: dict, beside_others: bool) -> dict:
    if beside_others:  # what draws must not start threads for every processor again
        os.environ["LP_NUM_THREADS"] = "1"
    try:
        return {"point": point, "result": function(**point)}
    except Exception as error:
        raise RuntimeError(f"seed {point['seed']}: {error}; finished seeds are kept") from error


def _read(path: Path) -> dict[str, object]:
    """Results by point; a last line that a stopped run left half-written is removed."""
    text = path.read_bytes() if path.exists() else b""
    whole = text[: text.rfind(b"\n") + 1]
    if whole != text:
        os.truncate(path, len(whole))
    return _results(whole.splitlines())


def _results(lines: Iterable[bytes]) -> dict[str, object]:
    rows = [json.loads(line) for line in lines]
    return {_key(row["point"]): row["result"] for row in rows if "point" in row}
