"""The cases of `interrupt` on a disk that is too small, from far too small to large enough.

The disk is a tmpfs in a mount namespace of its own (`unshare`): no other process sees it, and it goes with the last.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

from course_lib.commands.interruptions import Staged
from course_lib.commands.whole_outputs import left_over, put_back, state, tree
from course_lib.paths import REPOSITORY

PAGE = 4096  # bytes: what the smallest file takes on a tmpfs
FILLED = (0.0, 0.2, 0.5, 0.8, 0.95, 1.1, 2.5)
"""Room beside the old, in sizes of the new."""

_ON_A_DISK = """
import json, subprocess, sys
call = json.loads(sys.argv[1])
sys.path.insert(0, call["root"])
from pathlib import Path
from course_lib.commands.full_disk import on_a_disk
print("\\n" + json.dumps(on_a_disk(**call)))
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
    for share in FILLED:
        staged.begin_anew()
        size = taken["old"] + int(share * taken["new"]) + 4 * PAGE
        found = _run_on_a_disk(staged, size)
        counts["moments"] += 1
        where = f"{staged.case.name} on a disk of {size:,} bytes"
        held = state(_texts(found["tree"]), staged.old, staged.new, staged.case.by_file)
        counts[held] += 1
        said = found["error"]
        if held == "broken":
            faults.append(f"{where}: broken: {sorted(found['tree'])}; {said[-500:]}")
        if found["left"]:
            counts["left"] += 1
            faults.append(f"{where}: left {found['left']}")
        if found["code"] != 0 and not (str(staged.stage) in said and "disk is full" in said):
            faults.append(f"{where}: exit code {found['code']} without naming the full disk: {said[-500:]}")
        if found["code"] == 0 and held != "new":
            faults.append(f"{where}: exit code 0, and the new is not there")
        if staged.case.prints and not found["printed"].strip() and "before" not in said:
            faults.append(f"{where}: nothing was printed before the disk was full: {said[-500:]}")
    return counts | {"faults": faults}


def _run_on_a_disk(staged: Staged, size: int) -> dict:
    call = {
        "root": str(REPOSITORY),
        "stage": str(staged.stage),
        "size": size,
        "program": staged.case.program,
        "words": staged.words(2),
        "environment": staged.environment(2),
    }
    done = subprocess.run(
        ["unshare", "-rm", sys.executable, "-P", "-c", _ON_A_DISK, json.dumps(call)],
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode != 0:
        raise RuntimeError(f"{staged.case.name} on a disk of its own: {done.stderr[-1000:]}")
    return json.loads(done.stdout.splitlines()[-1])


def on_a_disk(root: str, stage: str, size: int, program: str, words: list[str], environment: dict[str, str]) -> dict:
    """In a namespace of its own: puts what stands in `stage`/out on a disk of `size` bytes, runs, tells what became."""
    out = Path(stage) / "out"
    old = tree(out)
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "none", stage], check=True)
    put_back(out, old)
    done = subprocess.run(
        [sys.executable, "-P", "-c", program, *words],
        cwd=stage,
        env=os.environ | {"PYTHONPATH": root} | environment,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        check=False,
    )
    return {
        "code": done.returncode,
        "printed": done.stdout.decode("utf-8", "replace"),
        "error": done.stderr.decode("utf-8", "replace"),
        "tree": {name: content.decode("latin-1") for name, content in tree(out).items()},
        "left": left_over(Path(stage), out),
    }


def _texts(found: dict[str, str]) -> dict[str, bytes]:
    return {name: text.encode("latin-1") for name, text in found.items()}
