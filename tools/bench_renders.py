"""`bench --renders`: memory over many renders, each backend in a process of its own, and whether images stay."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from course_lib.child import python
from course_lib.child import run as run_child

LEAST = 20  # fewer leave nothing to compare once memory has settled
WHAT = {"renders": "renders, one renderer", "renderers": "renderers, a render each"}


def measure(
    script: Path, environment: dict[str, str], backends: Sequence[str], n_renders: int, n_renderers: int
) -> Iterator[tuple[str, dict]]:
    """What `script` (tools/benchmarks/renders.py) tells of every backend, each as soon as it is known.

    environment: in which it finds its modules. Raises `ValueError` for fewer than `LEAST` renders or renderers,
    `RuntimeError` for a measurement that ended otherwise than with its numbers.
    """
    for option, n in (("--renders", n_renders), ("--renderers", n_renderers)):
        if n < LEAST:
            raise ValueError(f"{option} must be a whole number, at least {LEAST}; got {n}")
    for backend in backends:
        print(f"measuring: {backend}", file=sys.stderr, flush=True)
        command = python(script, backend, str(n_renders), str(n_renderers))
        done = run_child(command, environment, stdout=subprocess.PIPE, text=True)
        if done.returncode:
            raise RuntimeError(
                f"the measurement of {backend} ended with code {done.returncode}; what it said stands above"
            )
        yield backend, json.loads(done.stdout.splitlines()[-1])


def heading() -> str:
    """The line above the rows."""
    heads = ("before", "settled", "greatest", "end", "grew [MB]", "other images")
    return f"{'memory held [MB]':42}" + "".join(f"{head:>14}" for head in heads)


def rows(backend: str, told: dict) -> str:
    """Memory (MB) before the first call, settled, the greatest from then on, at the end; calls of another image.

    Settled: after a tenth of the calls, 20 at least. Grew: from the least of the first quarter since then to the least
    of the last.
    """
    if "missing" in told:
        return f"{backend:42}  not here: {told['missing'][:90]}"
    lines = []
    for key, what in WHAT.items():
        one = told[key]
        held = [one[name] for name in ("before_the_first_mb", "settled_mb", "greatest_mb", "end_mb")]
        name = f"{backend}, {one['calls']:,} {what}"
        numbers = [f"{mb:14.1f}" for mb in held] + [f"{one['grew_mb']:+14.1f}", f"{one['other_images']:14}"]
        lines.append(f"{name:42}" + "".join(numbers))
    return "\n".join(lines)
