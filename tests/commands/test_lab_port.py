"""Two labs that start at once choose two ports, and both answer."""

import os
import re
import shutil
import socket
import subprocess
import sys
import time
import urllib.request
from pathlib import Path

import pytest

from course_lib.commands import lab_port
from course_lib.commands.lab_port import reserve_port
from course_lib.paths import REPOSITORY

HANGS_S = 1200
LAB = """
import argparse, sys
from pathlib import Path
from course_lib.commands import lab
lab.ROOT, sys.prefix = Path(sys.argv[1]), sys.argv[2]
lab.run(argparse.Namespace(port=None, no_browser=True, notebook=None, fresh=[]))
"""
pytestmark = pytest.mark.skipif(os.name == "nt", reason="locks of POSIX")


@pytest.fixture
def locks(tmp_path, monkeypatch):
    monkeypatch.setattr(lab_port.tempfile, "gettempdir", lambda: str(tmp_path))
    return tmp_path / f"course-lab-{os.geteuid()}"


def test_a_reserved_port_is_nobody_elses_until_it_is_let_go(locks):
    first, handle = reserve_port()
    second, other = reserve_port()
    assert second > first
    os.close(handle)
    again, handle = reserve_port()
    assert again == first
    os.close(handle)
    os.close(other)


def test_the_program_that_this_one_becomes_keeps_it(locks):
    port, handle = reserve_port()
    keeper = subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE, close_fds=False)
    os.close(handle)
    assert reserve_port()[0] > port
    keeper.communicate(b"\n")
    assert reserve_port()[0] == port


def test_a_port_on_which_somebody_listens_is_passed_over(locks):
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
        assert reserve_port(port)[0] != port


@pytest.mark.parametrize("spoil", [lambda path: path.write_text(""), lambda path: path.symlink_to("/nowhere")])
def test_without_locks_it_still_finds_a_port(locks, spoil):
    spoil(locks)
    port, handle = reserve_port()
    assert lab_port.FIRST <= port < lab_port.FIRST + lab_port.N_PORTS
    assert handle is None


@pytest.mark.slow
def test_two_labs_that_start_at_once_both_answer(tmp_path):
    (tmp_path / "course" / "notebooks").mkdir(parents=True)
    shutil.copy(REPOSITORY / "notebooks" / "00_start_here.ipynb", tmp_path / "course" / "notebooks")
    command = [sys.executable, "-c", LAB, str(tmp_path / "course"), str(tmp_path / "environment")]
    environment = os.environ | {"PYTHONPATH": str(REPOSITORY)}
    logs = [tmp_path / "one.log", tmp_path / "two.log"]
    labs = []
    try:
        for log in logs:
            with log.open("w") as file:
                labs.append(subprocess.Popen(command, env=environment, stdout=file, stderr=file))
        addresses = [address_in(log, process) for log, process in zip(logs, labs, strict=True)]
        assert len({port for port, _ in addresses}) == 2
        for port, token in addresses:
            with urllib.request.urlopen(f"http://127.0.0.1:{port}/api/status?token={token}", timeout=HANGS_S) as answer:
                assert answer.status == 200
    finally:
        for process in labs:
            process.terminate()
            process.wait(HANGS_S)


def address_in(log: Path, process: subprocess.Popen) -> tuple[str, str]:
    """Port and token that a lab has printed, once it listens."""
    begun = time.monotonic()
    while time.monotonic() - begun < HANGS_S:
        found = re.search(r"http://127.0.0.1:(\d+)/lab\S*token=(\w+)", log.read_text())
        if found:
            try:
                urllib.request.urlopen(f"http://127.0.0.1:{found[1]}/api?token={found[2]}", timeout=HANGS_S).close()
                return found[1], found[2]
            except OSError:
                pass
        assert process.poll() is None, log.read_text()
        time.sleep(0.2)
    raise AssertionError(f"no lab after {HANGS_S} s: {log.read_text()}")
