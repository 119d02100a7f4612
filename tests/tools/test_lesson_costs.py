"""`bench --lessons`: what a kernel and its children take is seen, nothing is stored; the server that it asks for."""

import json
import sys
from pathlib import Path

import nbformat
import pytest
from nbformat.v4 import new_code_cell, new_notebook

from tools import lesson_costs, refresh
from tools.lesson_costs import Cost

HELD_MB = 300


@pytest.mark.slow
def test_a_notebook_is_measured_and_nothing_is_stored(tmp_path):
    sources = [f"held = bytearray(b'x') * {HELD_MB}_000_000", "open('left behind.txt', 'w').write('x');"]
    path = tmp_path / "99_test.ipynb"
    nbformat.write(new_notebook(cells=[new_code_cell(source) for source in sources]), path)
    before = path.read_bytes()
    cost = lesson_costs.notebook_cost(path)
    assert cost.name == "99"
    assert cost.peak_mb >= HELD_MB
    assert cost.processor_s > 0.1, "the kernel's start alone takes more"
    if sys.platform.startswith("linux"):
        assert HELD_MB <= cost.own_mb < cost.peak_mb - 2, "the files of the interpreter are not its own"
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path], "what its cells write goes to a folder that is thrown away"


PROJECT = {"name": "P1", "peak_mb": 700.0, "own_mb": 550.0, "processor_s": 30.0}
SERVER = {"name": "server", "peak_mb": 170.0, "own_mb": 100.0, "processor_s": 3.0}


def test_the_command_prints_the_table_or_json_for_the_lessons_it_was_given(run_tool, capsys, monkeypatch):
    monkeypatch.setattr(refresh, "select", lambda lessons: [Path("99")] if lessons == ["99"] else [])
    monkeypatch.setattr(lesson_costs, "notebook_cost", lambda path: Cost(**PROJECT))
    monkeypatch.setattr(lesson_costs, "server_cost", lambda: Cost(**SERVER))
    assert run_tool("bench", "--server", "8", "2", "--lessons", "99") == 0
    printed = capsys.readouterr().out
    assert all(f"| {name} | 700 | 550 | 30 |" in printed for name in ("P1", "the greatest", "all together"))
    assert "8 GiB and 2 processors carries 8 students" in printed
    assert run_tool("bench", "--lessons", "99", "--json") == 0
    assert json.loads(capsys.readouterr().out)["lessons"] == [PROJECT]
    assert run_tool("bench", "--lessons", "99", "--server", "16", "0") == 2
    assert "two positive numbers" in capsys.readouterr().err
