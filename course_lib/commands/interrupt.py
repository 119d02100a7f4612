"""Stop every writing command at random moments, and fill its disk: is what it leaves the old whole, or the new?

Each is run once for the old, once for the new, and then stopped again and again on its way from the one to the other:
by kill -9 at a moment of the clock or at a step of its writing, by Ctrl-C, by a disk too small (Linux, where a user may
mount one). What is found is told: old, new, broken, and what the next run did not clear. Other programs should rest.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

import numpy as np

from course_lib.commands.arguments import require_output_folder, require_positive, require_seed
from course_lib.scratch import scratch_folder


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declares the options of `interrupt`."""
    parser.add_argument("--moments", type=int, default=200, metavar="N", help="kills, of all commands (default: 200)")
    parser.add_argument("--seed", type=int, default=0, help="draws the moments (default: 0)")
    parser.add_argument("--only", nargs="+", metavar="NAME", help="these commands alone, such as 'demo corridor'")
    parser.add_argument("--no-disk", action="store_true", help="fill no disk")
    parser.add_argument(
        "--out",
        type=Path,
        default=Path("results/interrupt"),
        metavar="FOLDER",
        help="where interrupt.json goes (default: results/interrupt)",
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of the table")


def run(arguments: argparse.Namespace) -> int:
    """Stops what was asked for; 1 where anything was broken or left."""
    if sys.platform == "win32":
        raise RuntimeError("interrupt needs Linux or macOS: it forks, and kills groups of processes")
    from course_lib.commands.full_disk import full_disks, why_no_disk
    from course_lib.commands.interrupt_cases import CASES
    from course_lib.commands.interruptions import InterruptionError, Staged, drawn_ctrl_c, drawn_kills, interruptions
    from course_lib.experiments.results import write_results
    from course_lib.output_folder import replaced_outputs

    require_seed(arguments.seed)
    require_positive("--moments", arguments.moments, "kills")
    known = {case.name: case for case in CASES}
    if unknown := sorted(set(arguments.only or ()) - set(known)):
        raise ValueError(f"--only {', '.join(unknown)}: there is no such command here; there are: {', '.join(known)}")
    require_output_folder(arguments.out)
    cases = [known[name] for name in arguments.only or known]
    counts = shares(arguments.moments, len(cases))
    no_disk = "not asked for" if arguments.no_disk else why_no_disk()
    rows = []
    for case, count, random in zip(cases, counts, np.random.default_rng(arguments.seed).spawn(len(cases)), strict=True):
        row = {"name": case.name, **dict.fromkeys(WAYS), "not_run": None}
        try:
            with scratch_folder() as folder:
                with Staged(case, folder.resolve()) as staged:
                    row["kill"] = interruptions(staged, drawn_kills(staged, count, random))
                    row["ctrl_c"] = interruptions(staged, drawn_ctrl_c(staged, max(1, count // 10), random))
                    row["full_disk"] = None if no_disk else full_disks(staged)
        except InterruptionError as error:
            row["not_run"] = str(error)
        rows.append(row)
        print(row_text(row), file=sys.stderr, flush=True)
    result = {
        "seed": arguments.seed,
        "moments": arguments.moments,
        "no_disk": no_disk,
        "rows": rows,
        "sum": total(rows),
    }
    print(json.dumps(result) if arguments.json else table(result), flush=True)
    with replaced_outputs(arguments.out, "interrupt") as out:
        write_results(out / "interrupt.json", result)
    return (
        1 if any(row["not_run"] for row in rows) or any(one["faults"] for one in result["sum"].values() if one) else 0
    )


def shares(moments: int, n_cases: int) -> list[int]:
    """So many whole numbers, alike but for one, at least one each; their sum is `moments` where that can be."""
    return [max(1, int(n)) for n in np.diff(np.arange(n_cases + 1) * moments // n_cases)]


WAYS = {"kill": "kill -9", "ctrl_c": "Ctrl-C", "full_disk": "full disk"}
COUNTED = ("moments", "old", "new", "between", "broken", "cleared", "left")


def total(rows: list[dict]) -> dict[str, dict | None]:
    """The counts of all commands, by what stopped them; None where nothing was."""
    sums = {}
    for way in WAYS:
        found = [row[way] for row in rows if row[way]]
        counts = {key: sum(one[key] for one in found) for key in COUNTED}
        sums[way] = counts | {"faults": [fault for one in found for fault in one["faults"]]} if found else None
    return sums


def row_text(row: dict) -> str:
    """One line of the table's first part."""
    told = (
        " / ".join(f"{row[way][key]}" for key in ("old", "new", "between", "broken")) if row[way] else "-"
        for way in WAYS
    )
    return f"{row['name']:<30}" + "".join(f"{text:<22}" for text in told)


def table(result: dict) -> str:
    """What the command prints."""
    head = f"{'old / new / between / broken':<30}" + "".join(f"{name:<22}" for name in WAYS.values())
    sums = {"name": "all"} | result["sum"]
    lines = [head, *(row_text(row) for row in result["rows"]), row_text(sums), ""]
    kill = result["sum"]["kill"] or dict.fromkeys(COUNTED, 0)
    lines.append(
        f"between: whole files of both, where a command puts each in place by itself, and completed by the next run\n"
        f"{kill['cleared']} of {kill['moments']} kills left something unfinished beside the outputs, which the next "
        f"run cleared; not cleared: {kill['left']}"
    )
    if result["no_disk"]:
        lines.append(f"no disk was filled: {result['no_disk']}")
    lines += [f"not run: {row['not_run']}" for row in result["rows"] if row["not_run"]]
    lines += [fault for found in result["sum"].values() if found for fault in found["faults"]]
    return "\n".join(lines)
