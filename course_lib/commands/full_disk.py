"""The cases of `interrupt` on a disk that is too small, from far too small to large enough.

The disk is a tmpfs in a mount namespace of its own (`unshare`): no other process sees it, and it goes with the last.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys

from course_lib.commands.interruptions import Staged
from course_lib.commands.stopped_runs import Ended, Runs
from course_lib.commands.whole_outputs import Tree, state

PAGE = 4096  # bytes: what the smallest file takes on a tmpfs
FILLED = (0.0, 0.4, 0.9, 0.2, 0.7, 1.05, 2.5)
"""Room beside the old, in sizes of the new; a command, whose run may take long, has the first three alone."""

BAD_INPUT = 2  # exit code
REFUSED_BEFORE_STEPS = 12
"""A run that did no more than so many things to files was refused before its work: there is nothing to print."""


class DiskError(RuntimeError):
    """A disk that could not be mounted or looked at."""


_MOUNT = """
import subprocess, sys
from pathlib import Path
from course_lib.commands.whole_outputs import put_back, tree
stage, size = sys.argv[1:]
old = tree(Path(stage) / "out")
subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "none", stage], check=True)
put_back(Path(stage) / "out", old)
"""
_LOOK = """
import json, subprocess, sys
from pathlib import Path
from course_lib.commands.whole_outputs import left_over, tree
stage = Path(sys.argv[1])
found = {name: content.decode("latin-1") for name, content in tree(stage / "out").items()}
print(json.dumps([found, left_over(stage, stage / "out")]))
subprocess.run(["umount", "--lazy", str(stage)], check=True)
"""


def why_no_disk() -> str | None:
    """Why no disk of one's own can be mounted here; None where one can."""
    if not sys.platform.startswith("linux") or not shutil.which("unshare"):
        return "this needs Linux and its unshare"
    done = subprocess.run(["unshare", "-rm", "true"], capture_output=True, text=True, check=False)
    return None if done.returncode == 0 else f"this user may not mount a disk ({done.stderr.strip()})"


def full_disks(staged: Staged) -> dict:
    """Runs a case on disks of several sizes, the old on them; what was found, counted.

    Old or new must be there whole; a run that fails must name the file or folder, say that the disk is full, and have
    printed what it found.
    """
    counts = dict.fromkeys(("moments", "old", "new", "between", "broken", "cleared", "left"), 0)
    faults = []
    taken = {which: sum(PAGE + len(content) for content in getattr(staged, which).values()) for which in ("old", "new")}
    with Runs(staged.stage, staged.modules, ("unshare", "-rm")) as runs:
        for share in FILLED[:3] if staged.case.is_command else FILLED:
            staged.begin_anew()
            size = taken["old"] + int(share * taken["new"]) + 4 * PAGE
            ended, files, left = _run_on_a_disk(staged, runs, size)
            held = state(files, staged.old, staged.new, staged.case.by_file)
            counts["moments"] += 1
            counts[held] += 1
            counts["left"] += bool(left)
            wrong = [f"{held}: {sorted(files)}"] * (held == "broken") + [f"left {left}"] * bool(left)
            wrong += wrong_end(ended, held, staged)
            faults += [f"{staged.case.name} on a disk of {size:,} bytes: {what}" for what in wrong]
    return counts | {"faults": faults}


def _run_on_a_disk(staged: Staged, runs: Runs, size: int) -> tuple[Ended, Tree, list[str]]:
    """How a run on a disk of so many bytes ended, the files that are there then, and what it left."""
    stage = str(staged.stage)
    mounted = runs.run(_MOUNT, [stage, str(size)], {})
    ended = runs.run(staged.case.program, staged.words(2), staged.environment(2))
    looked = runs.run(_LOOK, [stage], {})
    if mounted.code or looked.code:
        raise DiskError(f"a disk of {size:,} bytes at {stage}: {mounted.complained}{looked.complained}")
    found, left = json.loads(looked.printed)
    return ended, {name: text.encode("latin-1") for name, text in found.items()}, left


def wrong_end(ended: Ended, held: str, staged: Staged) -> list[str]:
    """What is wrong about what a run said of its disk."""
    said = ended.complained
    if ended.code == 0:
        return ["exit code 0, and the new is not there"] * (held != "new")
    wrong = []
    full = "disk is full" in said or "No space left on device" in said
    if not full or not any(str(place) in said for place in (staged.stage, staged.given)):
        wrong.append(f"exit code {ended.code}, and the full disk is not named: {said[-1000:]}")
    if staged.case.is_command and (ended.code != BAD_INPUT or "Traceback" in said or "[Errno" in said):
        wrong.append(f"exit code {ended.code}: {said[-1000:]}")
    if staged.case.prints and not ended.printed.strip() and ended.steps > REFUSED_BEFORE_STEPS:
        wrong.append(f"nothing was printed before the disk was full: {said[-1000:]}")
    return wrong
