"""`bench --lessons`: what a kernel and its children take is seen, nothing is stored; the server that it asks for."""

import json
import subprocess
import sys
from pathlib import Path

import nbformat
import pytest
from nbformat.v4 import new_code_cell, new_notebook

from tools import bench_tables, lesson_costs, refresh
from tools.lesson_costs import Cost

HELD_MB = 300
BURN = "import time\nwhile time.process_time() < 0.5: pass\n"
WAIT = "import sys\nprint('ready', flush=True)\nsys.stdin.read()\n"
PROGRAMS = {
    "itself": f"held = bytearray(b'x') * {HELD_MB}_000_000\n{BURN}{WAIT}",
    "its child": "import subprocess, sys\nchild = subprocess.Popen([sys.executable, '-c', {}], stdin=subprocess.PIPE)\n"
    "sys.stdin.read(); child.communicate()",
}
PROGRAMS["its child"] = PROGRAMS["its child"].format(repr(PROGRAMS["itself"]))


@pytest.mark.parametrize("taken", PROGRAMS)
@pytest.mark.slow
def test_what_a_process_and_its_children_take_is_seen(taken):
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    with subprocess.Popen([sys.executable, "-c", PROGRAMS[taken]], **pipes) as process:
        with lesson_costs.watched(process.pid, "", costs := []):
            assert process.stdout.readline().strip() == "ready"
        process.stdin.close()
    (cost,) = costs
    assert cost.processor_s >= 0.45
    assert cost.peak_mb >= HELD_MB
    if sys.platform.startswith("linux"):
        assert HELD_MB <= cost.own_mb < cost.peak_mb - 2, "the files of interpreters are not their own"


@pytest.mark.slow
def test_a_notebook_is_measured_and_nothing_is_stored(tmp_path):
    sources = [f"held = bytearray(b'x') * {HELD_MB}_000_000", "open('left behind.txt', 'w').write('x');"]
    path = tmp_path / "99_test.ipynb"
    nbformat.write(new_notebook(cells=[new_code_cell(source) for source in sources]), path)
    before = path.read_bytes()
    cost = lesson_costs.notebook_cost(path)
    assert cost.name == "99"
    assert cost.peak_mb >= HELD_MB
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path], "what its cells write goes to a folder that is thrown away"


RESULT = {
    "lessons": [
        {"name": "00", "peak_mb": 600.0, "own_mb": 400.0, "processor_s": 10.0},
        {"name": "P1", "peak_mb": 700.0, "own_mb": 550.0, "processor_s": 30.0},
    ],
    "server": {"name": "server", "peak_mb": 170.0, "own_mb": 100.0, "processor_s": 3.0},
}


def test_a_server_carries_what_both_its_memory_and_its_processors_carry():
    # 8 GiB less one is 7,516 MB, less 200 of libraries; 650 MB a student. 120 s for 30 s each.
    assert bench_tables.capacity(RESULT, 8, 2) == (11, 8)
    assert bench_tables.capacity(RESULT, 0.5, 2)[0] == 0
    unknown = {"lessons": [RESULT["lessons"][1] | {"own_mb": None}], "server": RESULT["server"] | {"own_mb": None}}
    assert bench_tables.capacity(unknown, 8, 16)[0] == 7516 // 870, "nothing is taken as shared"
    assert "| P1 | 700 |  | 30 |" in bench_tables.lessons_rows(unknown)


def test_the_command_prints_the_table_or_json_for_the_lessons_it_was_given(run_tool, capsys, monkeypatch):
    monkeypatch.setattr(refresh, "select", lambda lessons: [Path("99")] if lessons == ["99"] else [])
    monkeypatch.setattr(lesson_costs, "notebook_cost", lambda path: Cost(**RESULT["lessons"][1]))
    monkeypatch.setattr(lesson_costs, "server_cost", lambda: Cost(**RESULT["server"]))
    assert run_tool("bench", "--server", "8", "2", "--lessons", "99") == 0
    printed = capsys.readouterr().out
    assert all(f"| {name} | 700 | 550 | 30 |" in printed for name in ("P1", "the greatest", "all together"))
    assert "8 GiB and 2 processors carries 8 students" in printed
    assert run_tool("bench", "--lessons", "99", "--json") == 0
    assert json.loads(capsys.readouterr().out)["lessons"] == [RESULT["lessons"][1]]
    assert run_tool("bench", "--lessons", "99", "--server", "16", "0") == 2
    assert "two positive numbers" in capsys.readouterr().err
