"""What `bench --lessons` prints, in Markdown: a row a lesson, and how many students one server carries."""

from __future__ import annotations

SYSTEM_BYTES = 2**30
"""Left to the operating system."""
PATIENCE_S = 120.0
"""How long a class waits for its results when everybody runs all the cells at the same moment."""


def text(result: dict, memory_gib: float, processors: float) -> str:
    """The table of `lesson_costs.measure`'s result, and the sentence on a server of that size."""
    return "\n".join([*table(result), "", capacity_sentence(result, memory_gib, processors)])


def table(result: dict) -> list[str]:
    """Lines of the table: a row a lesson, then the greatest, the sum, and the server of JupyterLab."""
    rows = result["lessons"]
    peaks, owns, seconds = ([row[key] for row in rows] for key in ("peak_mb", "own_mb", "processor_s"))
    own_known = None not in owns
    return [
        "| lesson | memory at its peak [MB] | of it, the student's own [MB] | processor time [s] |",
        "|---|---|---|---|",
        *(_row(row["name"], row["peak_mb"], row["own_mb"], row["processor_s"]) for row in rows),
        _row("the greatest", max(peaks), max(owns) if own_known else None, max(seconds)),
        _row("all together", sum(peaks), sum(owns) if own_known else None, sum(seconds)),
        _row("JupyterLab's server", *(result["server"][key] for key in ("peak_mb", "own_mb", "processor_s"))),
    ]


def capacity(result: dict, memory_gib: float, processors: float) -> dict[str, int]:
    """Students that fit by memory and by processors on one server, and how many of them fit by both.

    By memory: each has one kernel open, in the lesson that takes most, and a server of JupyterLab; nothing is shared
    but the files of libraries, once. By processors: everybody runs all cells of the longest lesson at the same moment,
    and has the results within `PATIENCE_S`.
    """
    lessons, server = result["lessons"], result["server"]

    def own(row: dict) -> float:
        return row["peak_mb"] if row["own_mb"] is None else row["own_mb"]

    files_mb = max(row["peak_mb"] - own(row) for row in [*lessons, server])
    free_mb = (memory_gib * 2**30 - SYSTEM_BYTES) / 1e6 - files_mb
    by_memory = int(max(free_mb, 0) // (max(own(row) for row in lessons) + own(server)))
    by_processors = int(processors * PATIENCE_S // max(row["processor_s"] for row in lessons))
    return {"by memory": by_memory, "by processors": by_processors, "students": min(by_memory, by_processors)}


def capacity_sentence(result: dict, memory_gib: float, processors: float) -> str:
    """How many students one server carries, and what that assumes."""
    found = capacity(result, memory_gib, processors)
    return (
        f"One server of {memory_gib:g} GiB and {processors:g} processors carries {found['students']} students: "
        f"{found['by memory']} by memory (each one kernel, in the lesson that takes most, and a server of JupyterLab; "
        f"files of libraries once; {SYSTEM_BYTES / 2**30:g} GiB left to the system), {found['by processors']} by "
        f"processors (all run all cells of the longest lesson at the same moment and wait {PATIENCE_S:g} s at most)."
    )


def _row(name: str, peak_mb: float, own_mb: float | None, processor_s: float) -> str:
    return f"| {name} | {peak_mb:.0f} | {'' if own_mb is None else f'{own_mb:.0f}'} | {processor_s:.0f} |"
