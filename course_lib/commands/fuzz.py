"""Damage valid files of every format in many ways, and see that each is refused by name or read rightly."""

from __future__ import annotations

import argparse
import json
import os
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

from course_lib.commands.arguments import (
    require_count,
    require_output_folder,
    require_positive,
    require_processes,
    require_seed,
)
from course_lib.commands.fuzz_table import fuzz_table
from course_lib.output_folder import replaced_outputs
from course_lib.writing import write_at_once

if TYPE_CHECKING:  # imported where they are used, so that --help does not wait for OpenCV
    from course_lib.fuzzing.campaign import Trial

FILES = 1000
"""Where neither --files nor --seconds is given."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declares the options of `fuzz`."""
    parser.add_argument("--seconds", type=float, metavar="S", help="stop after so many seconds")
    parser.add_argument("--seed", type=int, default=1, metavar="N", help="same seed, same files (default: 1)")
    parser.add_argument(
        "--files", type=int, metavar="N", help=f"how many files (default: {FILES}, or what fits --seconds)"
    )
    parser.add_argument("--processes", type=int, default=1, metavar="P", help="that try files at a time (default: 1)")
    parser.add_argument("--formats", metavar="NAMES", help="only these, with commas (default: all)")
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of the table")
    parser.add_argument(
        "--out", type=Path, default=Path("results/fuzz"), metavar="FOLDER", help="for the counts and the failing files"
    )
    parser.add_argument("--read", type=Path, metavar="FILE", help="try this one file and nothing else")
    parser.add_argument("--format", metavar="NAME", help="what the file given with --read is")


def run(arguments: argparse.Namespace) -> int:
    """Tries files, prints the counts, keeps what failed; 1 where anything did."""
    if not hasattr(os, "fork"):
        raise ValueError("fuzz needs a system that can fork a process, such as Linux or macOS")
    if arguments.read is not None:
        return read_one(arguments.read, arguments.format)
    from course_lib.commands.progress import progress_bar
    from course_lib.experiments.results import write_results
    from course_lib.fuzzing.campaign import defects, run_campaign

    names = format_names(arguments.formats)
    require_seed(arguments.seed)
    require_count("--files", arguments.files)
    require_processes("--processes", arguments.processes)
    if arguments.seconds is not None:
        require_positive("--seconds", arguments.seconds, "seconds")
    require_output_folder(arguments.out)
    files = FILES if arguments.files is None and arguments.seconds is None else arguments.files
    trials = run_campaign(
        names, arguments.seed, files, arguments.seconds, arguments.processes, progress_bar("fuzz", "file")
    )
    result = summary(trials, arguments.seed)
    print(json.dumps(result) if arguments.json else fuzz_table(result), flush=True)
    failing = defects(trials)
    with replaced_outputs(arguments.out, "fuzz") as out:
        write_results(out / "fuzz.json", result)
        _keep(failing, arguments.seed, out, arguments.out)
    if failing and not arguments.json:
        print(f"\n{len(failing)} files show defects. {arguments.out}/failing.txt says how to read each again.")
    return 1 if failing else 0


def format_names(listed: str | None) -> list[str]:
    """The formats that "ply,obj" names, or all. Raises `ValueError` for others."""
    from course_lib.fuzzing.formats import FORMATS

    names = list(FORMATS) if listed is None else listed.split(",")
    unknown = [name for name in names if name not in FORMATS]
    if unknown:
        raise ValueError(f"--formats {', '.join(unknown)} is not known; known are {', '.join(FORMATS)}")
    return list(dict.fromkeys(names))


def summary(trials: list[Trial], seed: int) -> dict:
    """The counts of a run, why changed results are right, and what failed: for JSON."""
    from course_lib.fuzzing.campaign import counted, defects
    from course_lib.fuzzing.trial import CLASSES

    formats = counted(trials)
    told = Counter(trial.verdict.told for trial in trials if trial.verdict.outcome == "changed")
    kinds: dict[str, dict[str, int]] = {}
    for trial in trials:
        kind = trial.damage.partition(":")[0] if ": " in trial.damage else "mutated"
        of_kind = kinds.setdefault(kind, dict.fromkeys(CLASSES, 0))
        of_kind[trial.verdict.outcome] += 1
    return {
        "seed": seed,
        "files": len(trials),
        "formats": formats,
        "all": {name: sum(counts[name] for counts in formats.values()) for name in CLASSES},
        "damage": kinds,
        "explained": dict(told.most_common()),
        "peak_mb": max((trial.verdict.memory_mb for trial in trials), default=0.0),
        "slowest_s": max((trial.verdict.seconds for trial in trials), default=0.0),
        "defects": [
            {
                "format": one.format,
                "number": one.number,
                "damage": one.damage,
                "class": one.verdict.outcome,
                "told": one.verdict.told,
            }
            for one in defects(trials)
        ],
    }


def _keep(failing: list[Trial], seed: int, out: Path, shown: Path) -> None:
    """The failing files, each in a folder of its own under its own name, and how to read them again."""
    from course_lib.fuzzing.campaign import put_damaged

    lines = []
    for trial in failing:
        name = put_damaged(trial.format, seed, trial.number, out / f"{trial.format}_{trial.number}")
        path = shown / f"{trial.format}_{trial.number}" / name
        lines.append(
            f"{path} ({trial.damage}): {trial.verdict.outcome}: {trial.verdict.told}\n"
            f"    python3 course.py fuzz --read {path} --format {trial.format}\n"
        )
    if lines:
        write_at_once(out / "failing.txt", "".join(lines))


def read_one(path: Path, name: str | None) -> int:
    """Try one file and print its verdict; 1 where it shows a defect."""
    from course_lib.fuzzing.campaign import Bench
    from course_lib.fuzzing.formats import FORMATS
    from course_lib.fuzzing.trial import DEFECTS

    if name not in FORMATS:
        raise ValueError(f"--format says what the file of --read is: one of {', '.join(FORMATS)}; got {name!r}")
    with Bench([name]) as bench:
        verdict = bench.try_file(name, path)
    print(f"{verdict.outcome}: {verdict.told or 'read as the valid file is'} ({verdict.memory_mb:.0f} MB)")
    return 1 if verdict.outcome in DEFECTS else 0
