"""`bench --lessons`: what a kernel takes is seen, its children's too; nothing is stored; the server that it asks for.

How much a lesson takes is no test: small programs that take a known amount are measured here.
"""

import json
import subprocess
import sys

import nbformat
import pytest
from nbformat.v4 import new_code_cell, new_notebook

from course_lib.cli import main
from tools import lesson_costs, lesson_costs_table, refresh
from tools.lesson_costs import Cost, ProcessWatch

HELD_MB = 300
LINUX = sys.platform.startswith("linux")
# The program holds nothing itself; its child takes memory and half a second of a processor, then both wait.
CHILD = "import time\nheld = bytearray(b'x') * {mb}_000_000\nwhile time.process_time() < 0.5: pass\nprint('ready')\n"
PARENT = """
import subprocess, sys
child = subprocess.Popen([sys.executable, "-c", {child!r} + "sys.stdin.read()"], stdin=subprocess.PIPE,
                         stdout=subprocess.PIPE)
print(child.stdout.readline().decode(), flush=True)
sys.stdin.read()
child.communicate()
print("child ended", flush=True)
sys.stdin.read()
"""


def watched(program: str) -> Cost:
    """What `program` takes until it prints its first line."""
    with subprocess.Popen(
        [sys.executable, "-c", program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as process:
        with ProcessWatch(process.pid) as watch:
            assert process.stdout.readline().strip() == "ready"
        process.stdin.close()
    return watch.cost


def test_memory_and_time_of_a_child_count():
    child = "import sys\n" + CHILD.format(mb=HELD_MB)
    cost = watched(PARENT.format(child=child))
    assert cost.processor_s >= 0.5
    assert cost.peak_mb >= HELD_MB
    idle = watched("import sys; print('ready', flush=True); sys.stdin.read()")
    assert idle.peak_mb < HELD_MB
    assert idle.processor_s < cost.processor_s
    if LINUX:
        assert HELD_MB <= cost.own_mb < cost.peak_mb - 2, "the files of two interpreters are not their own"
    else:
        assert cost.own_mb is None


def test_the_time_of_a_child_that_ended_still_counts():
    burn = "import subprocess, sys\nsubprocess.run([sys.executable, '-c', {!r}])\nprint('ready', flush=True)\n"
    ended = "import time\nwhile time.process_time() < 0.5: pass"
    assert watched(burn.format(ended) + "sys.stdin.read()").processor_s >= 0.5


@pytest.mark.skipif(not LINUX, reason="only Linux keeps the peak")
def test_a_peak_between_two_looks_is_seen(monkeypatch):
    monkeypatch.setattr(lesson_costs, "EVERY_S", 3600.0)
    freed = f"import sys\nheld = bytearray(b'x') * {HELD_MB}_000_000\ndel held\nprint('ready', flush=True)\n"
    assert watched(freed + "sys.stdin.read()").peak_mb >= HELD_MB


@pytest.fixture(scope="module")
def notebook(tmp_path_factory):
    folder = tmp_path_factory.mktemp("lesson")
    sources = [
        f"held = bytearray(b'x') * {HELD_MB}_000_000",
        "import time\nstarted = time.process_time()\nwhile time.process_time() - started < 0.5: pass",
        "open('left behind.txt', 'w').write('x');",
    ]
    path = folder / "99_test.ipynb"
    nbformat.write(new_notebook(cells=[new_code_cell(source) for source in sources]), path)
    return path


def test_a_notebook_is_measured_and_nothing_is_stored(notebook):
    before = notebook.read_bytes()
    cost = lesson_costs.notebook_cost(notebook)
    assert cost.name == "99"
    assert cost.peak_mb >= HELD_MB
    assert cost.processor_s >= 0.5
    assert notebook.read_bytes() == before
    assert list(notebook.parent.iterdir()) == [notebook], "what its cells write goes to a folder that is thrown away"


def test_the_server_is_measured_until_it_has_shown_its_page():
    cost = lesson_costs.server_cost()
    assert cost.peak_mb > 20, "more than an interpreter alone"


RESULT = {
    "lessons": [
        {"name": "00", "peak_mb": 600.0, "own_mb": 400.0, "processor_s": 10.0},
        {"name": "P1", "peak_mb": 700.0, "own_mb": 550.0, "processor_s": 30.0},
    ],
    "server": {"name": "server", "peak_mb": 170.0, "own_mb": 100.0, "processor_s": 3.0},
    "machine": {"processors": 2, "date": "2026-11-23"},
}


def test_the_table_has_a_row_a_lesson_the_greatest_and_the_sum():
    rows = lesson_costs_table.table(RESULT)
    assert "| P1 | 700 | 550 | 30 |" in rows
    assert "| the greatest | 700 | 550 | 30 |" in rows
    assert "| all together | 1300 | 950 | 40 |" in rows


def test_a_server_carries_what_both_its_memory_and_its_processors_carry():
    # 8 GiB less one is 7,516 MB, less 200 of libraries; 650 MB a student. 120 s for 30 s each.
    assert lesson_costs_table.capacity(RESULT, 8, 16) == {"by memory": 11, "by processors": 64, "students": 11}
    assert lesson_costs_table.capacity(RESULT, 8, 2) == {"by memory": 11, "by processors": 8, "students": 8}
    assert lesson_costs_table.capacity(RESULT, 0.5, 2)["students"] == 0
    assert "carries 8 students" in lesson_costs_table.capacity_sentence(RESULT, 8, 2)


def test_where_the_system_does_not_tell_what_is_shared_nothing_is_taken_as_shared():
    unknown = {"lessons": [RESULT["lessons"][1] | {"own_mb": None}], "server": RESULT["server"] | {"own_mb": None}}
    assert lesson_costs_table.capacity(unknown, 8, 16)["by memory"] == 7516 // 870
    assert "| P1 | 700 |  | 30 |" in lesson_costs_table.table(unknown)


def test_the_command_prints_the_table_or_json_for_the_lessons_it_was_given(notebook, capsys, monkeypatch):
    monkeypatch.setattr(refresh, "select", lambda lessons: [notebook] if lessons == ["99"] else [])
    monkeypatch.setattr(lesson_costs, "notebook_cost", lambda path: Cost(**RESULT["lessons"][1]))
    monkeypatch.setattr(lesson_costs, "server_cost", lambda: Cost(**RESULT["server"]))
    assert main(["bench", "--server", "8", "2", "--lessons", "99"]) == 0
    printed = capsys.readouterr()
    assert "| P1 | 700 | 550 | 30 |" in printed.out
    assert "8 GiB and 2 processors carries 8 students" in printed.out
    assert main(["bench", "--lessons", "99", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["lessons"] == [RESULT["lessons"][1]]


def test_a_server_of_no_size_and_an_unknown_lesson_are_named(capsys):
    assert main(["bench", "--lessons", "77"]) == 2
    assert "no lesson 77" in capsys.readouterr().err
    assert main(["bench", "--lessons", "00", "--server", "16", "0"]) == 2
    assert "two positive numbers" in capsys.readouterr().err
