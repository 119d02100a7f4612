"""What `fuzz` prints: how many files of each format came to which verdict."""

from __future__ import annotations

HEADINGS = {
    "refused": "refused",
    "same": "same",
    "changed": "explained",
    "unexplained": "unexplained",
    "unnamed": "unnamed",
    "crash": "crash",
    "hang": "hang",
    "memory": "memory",
}
"""Class of `course_lib.fuzzing.trial` -> heading of its column."""


def fuzz_table(result: dict) -> str:
    """The counts of a run of `fuzz`, a line a format, and in words what the columns mean."""
    widths = {name: max(7, len(heading)) for name, heading in HEADINGS.items()}
    head = "".join(f"  {heading:>{widths[name]}}" for name, heading in HEADINGS.items())
    lines = [f"{'format':<14}{'files':>7}{head}"]
    for name, counts in (*result["formats"].items(), ("all", result["all"])):
        cells = "".join(f"  {counts[one]:>{widths[one]}}" for one in HEADINGS)
        lines.append(f"{name:<14}{sum(counts.values()):>7}{cells}")
    lines += [
        "",
        "refused: by an error that names the file. same, explained: read, with the result of the valid file, or",
    ]
    lines.append("another one that a second reading of the file confirms. The other five columns are defects.")
    lines += [f"  explained: {count} times {why}" for why, count in result["explained"].items()]
    lines.append(f"Seed {result['seed']}; most memory {result['peak_mb']:.0f} MB.")
    return "\n".join(lines)
