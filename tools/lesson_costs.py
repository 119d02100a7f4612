"""What one student's kernel costs in each lesson and project: memory and processor time, measured, nothing stored.

Neither number depends on how fast the machine is or on what else it does, so no time of the clock is told.
"""

import json
import os
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from urllib.error import URLError
from urllib.request import urlopen

import nbformat
import psutil

from course_lib.files import temporary_folder
from courseware.commands.lab import lab_command
from tools.refresh import HANGS_S, execute

EVERY_S = 0.1  # between two looks at the processes; the kernel's own peak is the system's, which misses nothing
SERVER_STARTS_S = 1200.0  # only what hangs takes so long


@dataclass(frozen=True)
class Cost:
    """What one kernel and its children took."""

    name: str
    peak_mb: float  # 10^6 bytes: most resident memory at one moment, libraries included
    own_mb: float | None  # most without the files of libraries, which processes share; None where no Linux tells
    processor_s: float  # user and system time of the whole tree, the kernel's start included


@contextmanager
def watched(pid: int, name: str, costs: list[Cost]) -> Iterator[None]:
    """Look at process `pid` and all its descendants, every `EVERY_S` and once more at the end; `costs` gets their cost.

    A child's peak that lasts less than `EVERY_S` may be missed; the time of children that ended is in their parent's.
    """
    ended, looks = threading.Event(), [(0.0, 0.0, 0.0)]

    def look_often() -> None:
        while not ended.wait(EVERY_S):
            looks.append(look(pid))

    thread = threading.Thread(target=look_often, daemon=True)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()
        looks.append(look(pid))
        peak, own, processor_s = map(max, zip(*looks, strict=True))
        costs.append(Cost(name, peak / 1e6, own / 1e6 if own else None, processor_s))


def look(pid: int) -> tuple[float, float, float]:
    """Bytes resident now, or at the process's own peak; bytes that are no file's; processor seconds of the tree."""
    resident = own = processor_s = 0.0
    try:
        process = psutil.Process(pid)
        tree = [process, *process.children(recursive=True)]
    except psutil.Error:  # it ended by itself: what was seen before stands
        return 0.0, 0.0, 0.0
    for one in tree:
        try:
            times, resident_now = one.cpu_times(), one.memory_info().rss
        except psutil.Error:  # ended since the list was made; its parent has its time now
            continue
        sizes = status_bytes(one.pid)
        processor_s += times.user + times.system + times.children_user + times.children_system
        resident += resident_now
        own += sizes.get("RssAnon", 0) + sizes.get("RssShmem", 0)
    return max(resident, status_bytes(pid).get("VmHWM", 0)), own, processor_s


def status_bytes(pid: int) -> dict[str, int]:
    """Sizes in /proc/PID/status [bytes] by name; none where there is no such file."""
    try:
        lines = Path(f"/proc/{pid}/status").read_text(encoding="utf-8").splitlines()
    except OSError:
        return {}
    words = [line.split() for line in lines]
    return {word[0].rstrip(":"): int(word[1]) * 1024 for word in words if len(word) == 3 and word[2] == "kB"}


def notebook_cost(path: Path) -> Cost:
    """What running all cells of the notebook `path` takes; the file and its folder stay as they are."""
    costs: list[Cost] = []
    with temporary_folder() as folder:
        watch = partial(watched, name=path.name.partition("_")[0], costs=costs)
        execute(nbformat.read(path, as_version=4), folder, HANGS_S, watch)
    return costs[0]


def server_cost() -> Cost:
    """What the server of `course.py lab` takes once it has shown its first page, without a kernel."""
    costs: list[Cost] = []
    with temporary_folder() as folder:
        command, environment = lab_command(port=0, state_folder=folder)
        silent = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        server = subprocess.Popen(command, env=environment, start_new_session=True, **silent)
        try:
            with watched(server.pid, "server", costs):
                _wait_for_first_page(server, folder / "runtime")
        finally:
            server.terminate()
            server.wait()
    return costs[0]


def _wait_for_first_page(server: subprocess.Popen, runtime: Path) -> None:
    """Wait until the server has written down its address, and answers there."""
    until = time.monotonic() + SERVER_STARTS_S
    while time.monotonic() < until and server.poll() is None:
        for path in runtime.glob("jpserver-*.json"):
            try:
                told = json.loads(path.read_text(encoding="utf-8"))
                urlopen(f"{told['url']}lab?token={told['token']}", timeout=SERVER_STARTS_S).read()
                return
            except (ValueError, URLError):  # half written, or written before anybody listens
                continue
        time.sleep(EVERY_S)
    raise RuntimeError("JupyterLab did not start; try python3 course.py lab --no-browser to see why")


def measure(paths: list[Path]) -> dict:
    """Costs of these notebooks and of the server, and the machine: the object that `bench --lessons --json` prints."""
    costs = []
    for path in paths:
        cost = notebook_cost(path)
        print(f"{cost.name}: {cost.peak_mb:.0f} MB, {cost.processor_s:.0f} s", file=sys.stderr)
        costs.append(asdict(cost))
    machine = {"processors": os.cpu_count(), "date": time.strftime("%Y-%m-%d")}
    return {"lessons": costs, "server": asdict(server_cost()), "machine": machine}
