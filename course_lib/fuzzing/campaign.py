"""Many files: which damage the n-th file of a format gets, where it is put, and all verdicts counted."""

from __future__ import annotations

import shutil
import time
import zlib
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from course_lib.fuzzing.bombs import LINKS, make_bombs, put_link
from course_lib.fuzzing.depth_oracle import depths_agree
from course_lib.fuzzing.formats import FORMATS, Format
from course_lib.fuzzing.mutators import BYTES, mutators_for
from course_lib.fuzzing.readings import Reading
from course_lib.fuzzing.samples import room_mesh, write_samples
from course_lib.fuzzing.trial import CLASSES, DEFECTS, MEMORY, SECONDS, Verdict, try_file
from course_lib.reading import is_given
from course_lib.scratch import scratch_folder
from course_lib.worker_pool import worker_pool

SHARES = {"bytes": 0.35, "inside": 0.45, "both": 0.08, "link": 0.06, "bomb": 0.06}
"""How often which kind of damage is done."""

SLOW_ROUNDS = 4
"""Formats whose reader starts a process of its own get one file in so many rounds."""


@dataclass(frozen=True)
class Damage:
    """What stands in the place of a valid file."""

    name: str
    """Which mutators made it, which link or which bomb it is."""
    content: bytes | None
    """The file's bytes; None: it is no plain file."""
    link: str = ""
    """Which kind of link, where there is no content."""


@dataclass(frozen=True)
class Trial:
    """One file that was tried."""

    format: str
    number: int
    damage: str
    verdict: Verdict


def damage(one: Format, whole: bytes, seed: int, number: int) -> Damage:
    """What becomes of the valid file `whole`: the same for the same seed, format and number."""
    rng = np.random.default_rng([seed, zlib.crc32(one.name.encode()), number])
    kind = str(rng.choice(list(SHARES), p=list(SHARES.values())))
    inside = mutators_for(one.traits)
    if kind == "link":
        link = LINKS[int(rng.integers(0, len(LINKS)))]
        return Damage(f"link: {link}", None, link)
    bombs = [(trait, name) for trait in sorted(one.traits) for name in make_bombs(trait)] if kind == "bomb" else []
    if bombs:
        trait, name = bombs[int(rng.integers(0, len(bombs)))]
        return Damage(f"bomb: {name}", make_bombs(trait)[name]())
    drawn = {"inside": (inside or BYTES,), "both": (inside or BYTES, BYTES)}.get(kind, (BYTES,))
    names, data = [], whole
    for mutators in drawn:
        mutator = mutators[int(rng.integers(0, len(mutators)))]
        names.append(mutator.__name__)
        data = mutator(data, rng)
    return Damage(", ".join(names), data)


class Bench:
    """The valid samples in a folder of their own, and what their readers make of them. A context manager."""

    def __init__(self, names: Sequence[str]) -> None:
        cv2.setNumThreads(1)  # a child that is forked has none of its parent's threads
        mesh = room_mesh()
        depths_agree(mesh.vertices, mesh.faces)  # compiled now, once, and not by every child
        self._scratch = ExitStack()
        self.folder = self._scratch.enter_context(scratch_folder())
        write_samples(self.folder)
        self._whole = {name: (self.folder / FORMATS[name].file).read_bytes() for name in names}
        self._original: dict[str, Reading] = {
            name: FORMATS[name].read(self.folder / FORMATS[name].file) for name in names
        }

    def __enter__(self) -> Bench:
        return self

    def __exit__(self, *error: object) -> None:
        self._scratch.close()

    def damage(self, name: str, seed: int, number: int) -> Damage:
        """The damage that file `number` of a format gets."""
        return damage(FORMATS[name], self._whole[name], seed, number)

    def try_damage(self, name: str, done: Damage, seconds: float = SECONDS, memory: int = MEMORY) -> Verdict:
        """Puts the damaged file in place, has it read, and puts the valid one back."""
        return self._tried(name, lambda path: put(done, path, self._whole[name]), seconds, memory)

    def try_file(self, name: str, file: Path, seconds: float = SECONDS, memory: int = MEMORY) -> Verdict:
        """The same with a file that lies elsewhere. Raises `FileNotFoundError` where nothing is."""
        if not is_given(file):
            raise FileNotFoundError(f"there is no {file}: give --read a file, such as those that failing.txt names")
        if file.is_file() and not file.is_symlink():
            return self._tried(name, lambda path: shutil.copyfile(file, path), seconds, memory)
        return self._tried(name, lambda path: path.symlink_to(file.absolute()), seconds, memory)

    def _tried(self, name: str, place: Callable[[Path], object], seconds: float, memory: int) -> Verdict:
        one, path = FORMATS[name], self.folder / FORMATS[name].file
        path.unlink()
        try:
            place(path)
            return try_file(path, one.read, one.errors, one.explain, self._original[name], seconds, memory)
        finally:
            for left in (path, path.with_name("elsewhere")):
                if left.is_dir() and not left.is_symlink():
                    shutil.rmtree(left)
                else:
                    left.unlink(missing_ok=True)
            path.write_bytes(self._whole[name])


def put(done: Damage, path: Path, whole: bytes) -> None:
    """Puts what stands for the valid file at `path`."""
    if done.content is None:
        put_link(done.link, path, whole)
    else:
        path.write_bytes(done.content)


def put_damaged(name: str, seed: int, number: int, folder: Path) -> str:
    """Puts file `number` of a format into a new folder; returns its name, that of the sample."""
    with scratch_folder() as samples:
        write_samples(samples)
        whole = (samples / FORMATS[name].file).read_bytes()
    folder.mkdir(parents=True)
    path = folder / Path(FORMATS[name].file).name
    put(damage(FORMATS[name], whole, seed, number), path, whole)
    return path.name


def plan(names: Sequence[str], files: int | None) -> Iterator[tuple[str, int]]:
    """(format, number of its file), format after format, round after round; endless where `files` is None."""
    count = rounds = 0
    while True:
        for name in names:
            if FORMATS[name].slow and len(names) > 1 and rounds % SLOW_ROUNDS:
                continue
            if files is not None and count >= files:
                return
            yield name, rounds // SLOW_ROUNDS if FORMATS[name].slow and len(names) > 1 else rounds
            count += 1
        rounds += 1


def run_campaign(
    names: Sequence[str],
    seed: int,
    files: int | None,
    seconds: float | None,
    processes: int,
    progress: Callable[[Iterator[Trial]], Iterable[Trial]] = lambda trials: trials,
) -> list[Trial]:
    """Try files until there were so many, or the time is up. `progress` wraps the iterator over what was tried."""
    until = None if seconds is None else time.monotonic() + seconds
    planned = plan(names, files)
    trials = _here(names, seed, planned) if processes == 1 else _apart(names, seed, planned, processes)
    found = []
    for trial in progress(trials):
        found.append(trial)
        if until is not None and time.monotonic() > until:
            break
    return found


def _here(names: Sequence[str], seed: int, planned: Iterator[tuple[str, int]]) -> Iterator[Trial]:
    with Bench(names) as bench:
        for name, number in planned:
            yield _tried(bench, name, seed, number)


def _tried(bench: Bench, name: str, seed: int, number: int) -> Trial:
    done = bench.damage(name, seed, number)
    return Trial(name, number, done.name, bench.try_damage(name, done))


_bench: Bench | None = None  # of a process that tries files for another one


def _open_bench(names: Sequence[str]) -> None:
    global _bench
    _bench = Bench(names)


def _try_one(name: str, seed: int, number: int) -> Trial:
    return _tried(_bench, name, seed, number)


def _apart(names: Sequence[str], seed: int, planned: Iterator[tuple[str, int]], processes: int) -> Iterator[Trial]:
    """In several processes, each with a bench of its own; what they find comes in the plan's order."""
    with worker_pool(processes, _open_bench, (list(names),)) as pool:
        waiting = []
        for name, number in planned:
            waiting.append(pool.submit(_try_one, name, seed, number))
            if len(waiting) >= 4 * processes:
                yield waiting.pop(0).result()
        for one in waiting:
            yield one.result()


def counted(trials: Sequence[Trial]) -> dict[str, dict[str, int]]:
    """How many files of each format came to which verdict, every class of `CLASSES` in its order."""
    counts: dict[str, Counter] = {}
    for trial in trials:
        counts.setdefault(trial.format, Counter())[trial.verdict.outcome] += 1
    known = [name for name in FORMATS if name in counts]
    return {name: {outcome: counts[name][outcome] for outcome in CLASSES} for name in known}


def defects(trials: Sequence[Trial]) -> list[Trial]:
    """The files that show a defect of a reader."""
    return [trial for trial in trials if trial.verdict.outcome in DEFECTS]
