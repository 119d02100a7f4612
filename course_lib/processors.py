"""How many processors this process may use: a machine's own number is wrong in containers and on shared machines."""

from __future__ import annotations

import os


def processors() -> int:
    """Number of processors that the system lets this process run on, at least 1."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
