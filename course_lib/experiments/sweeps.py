"""Many seeded experiments on many processors or machines: `sweep` keeps each result as it comes and goes on from there.

    rows = sweep(corridor_errors, {"seed": range(1, 101)}, results="results/sweep.jsonl")

An executor is whatever has the `submit` of Python's `concurrent.futures`: processes of this machine unless another is
given, such as Dask's, `dask.distributed.Client(address).get_executor()`, whose workers may be anywhere.

The results file holds one JSON object a line: what was run, then a row for each point. Only the process that sweeps
writes it, a whole line at a time; a line that a killed run left half-written is run again.
"""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import BrokenExecutor, Executor, Future, as_completed
from itertools import product
from pathlib import Path
from typing import BinaryIO

from course_lib.processors import processors
from course_lib.worker_pool import worker_pool

VERSION = 1

Grid = Mapping[str, Sequence] | Sequence[Mapping]


class SweepError(RuntimeError):
    """A sweep that cannot go on; the message says what was found and what to do. Rows that were done are kept."""


class finished:
    """Futures in the order in which they end, with a length for progress bars."""

    def __init__(self, futures: Iterable[Future]) -> None:
        self._futures = list(futures)

    def __len__(self) -> int:
        return len(self._futures)

    def __iter__(self) -> Iterator[Future]:
        return as_completed(self._futures)


def sweep(
    function: Callable[..., dict],
    grid: Grid,
    executor: Executor | None = None,
    *,
    results: str | Path,
    progress: Callable[[Iterable], Iterable] = iter,
) -> list[dict]:
    """Rows `{"point": ..., "result": ...}` of `function(**point)` for every point of the grid, in the grid's order.

    function: of a module, so that other processes find it; it gets a point's values by name, among them `seed`, and
    returns what JSON can hold. grid: the values of each name, every combination of which is a point, or the points
    themselves; each has a seed of its own or shares it with others, as the grid says. executor: where calls run; None
    for a process of this machine for each of its processors. results: the file that is written row by row, and whose
    rows are not run again. progress: wraps the loop over the points that are still to be run (tqdm).
    Points whose call raises are left out of the file; the others are run to the end, then `SweepError` names them.
    Raises `ValueError` for a grid without points or seeds or with a point twice, `SweepError` where the file is of
    another sweep, is damaged, or is being written by another process.
    """
    points = grid_points(grid)
    name = f"{function.__module__}.{function.__qualname__}"
    with _open_for_one(Path(results)) as file:
        with contextlib.nullcontext():
            rows = _read_rows(file, Path(results), name)
        missing = {key: point for key, point in points.items() if key not in rows}
        if missing and executor is None:
            workers = min(processors(), len(missing))
            with worker_pool(workers) as pool:
                rows |= _run(function, missing, pool, file, progress)
        elif missing:
            rows |= _run(function, missing, executor, file, progress)
    return [rows[key] for key in points]


def grid_points(grid: Grid) -> dict[str, dict]:
    """Every point of a grid by its key, the same text for the same values: `sweep`'s grid, its order and its errors."""
    if isinstance(grid, Mapping):
        listed = [dict(zip(grid, values, strict=True)) for values in product(*grid.values())]
    else:
        listed = [dict(point) for point in grid]
    if not listed or not all("seed" in point for point in listed):
        raise ValueError(
            f"a sweep's grid needs points, and each point a seed; got {len(listed)} points of {str(grid)[:200]}"
        )
    points = {_key(point): json.loads(_key(point)) for point in listed}
    if len(points) < len(listed):
        raise ValueError(f"{len(listed) - len(points)} of {len(listed)} points of the grid stand there twice")
    return points


def _key(point: Mapping) -> str:
    """A point as text; NumPy's numbers count as Python's."""
    return json.dumps(point, sort_keys=True, default=lambda value: value.item())


def _run(
    function: Callable[..., dict],
    points: Mapping[str, dict],
    executor: Executor,
    file: BinaryIO,
    progress: Callable[[Iterable], Iterable],
) -> dict[str, dict]:
    """Calls the function for each point, and writes each row when it is there."""
    futures = {executor.submit(function, **point): key for key, point in points.items()}
    rows, failed = {}, {}
    try:
        for future in progress(finished(futures)):
            key = futures[future]
            try:
                row = {"point": points[key], "result": future.result()}
                _require_text(row)
            except BrokenExecutor as error:
                raise SweepError(
                    f"a process of the sweep ended without a word (out of memory, killed?) after {len(rows)} of "
                    f"{len(points)} rows, which are kept; run the sweep again to go on: {error}"
                ) from error
            except Exception as error:
                failed[key] = error
            else:
                with contextlib.nullcontext():
                    _write_line(file, row)
                rows[key] = json.loads(json.dumps(row))
    except BaseException:
        for future in futures:
            future.cancel()
        raise
    if failed:
        key, error = next(iter(failed.items()))
        raise SweepError(
            f"{len(failed)} of {len(points)} points failed, the others are kept. The first: {key}: "
            f"{type(error).__name__}: {error}. Mend that and run the sweep again: only these are run"
        ) from error
    return rows


def _write_line(file: BinaryIO, content: dict) -> None:
    """Adds a line, whole and on its way to the disk."""
    left = _line(content)
    while left:  # not through the file's buffer, which on a full disk would fail once more when it is closed
        left = left[os.write(file.fileno(), left) :]
    os.fsync(file.fileno())


def _require_text(row: dict) -> None:
    """Raises `ValueError` or `TypeError` for what JSON cannot hold."""
    _line(row)


def _line(content: dict) -> bytes:
    return (json.dumps(content, allow_nan=False) + "\n").encode()


@contextlib.contextmanager
def _open_for_one(path: Path) -> Iterator[BinaryIO]:
    """The results file, open for adding lines, while no other process sweeps into it."""
    with contextlib.nullcontext():
        path.parent.mkdir(parents=True, exist_ok=True)
        opened = path.open("a+b")
    with opened as file:
        try:
            import fcntl
        except ImportError:  # Windows: nothing keeps a second sweep out
            pass
        else:
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                raise SweepError(
                    f"{path} is being written by another sweep: wait for it, or give another file"
                ) from None
        yield file


def _read_rows(file: BinaryIO, path: Path, name: str) -> dict[str, dict]:
    """The rows that the file holds, by key; a new file gets its first line, a half-written last line is removed."""
    file.seek(0)
    text = file.read()
    whole = text[: text.rfind(b"\n") + 1]
    header, rows = {"sweep": name, "version": VERSION}, {}
    if not whole and not _line(header).startswith(text):  # not ours, nor a first line that a killed sweep left
        raise SweepError(f"{path} holds no rows of a sweep: give another file")
    for number, line in enumerate(whole.splitlines(), start=1):
        try:
            content = json.loads(line)
            if number == 1:
                found = content["sweep"], content["version"]
            else:
                rows[_key(content["point"])] = {"point": content["point"], "result": content["result"]}
        except (ValueError, KeyError, TypeError):
            raise SweepError(f"{path}, line {number} is no row of a sweep: {line[:80]!r}. Give another file") from None
        if number == 1 and found != (name, VERSION):
            raise SweepError(f"{path} holds rows of {found[0]} (version {found[1]}), not of {name}: give another file")
    file.truncate(len(whole))
    if not whole:
        _write_line(file, header)
    return rows
