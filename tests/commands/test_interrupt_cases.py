"""The cases of `interrupt`: every command that writes, made short; what is kept for them, and what they leave."""

import os
import sys

import pytest

from course_lib.commands.full_disk import full_disks, why_no_disk, wrong_end
from course_lib.commands.interrupt_cases import CASES, Case
from course_lib.commands.interruptions import Staged, interruptions
from course_lib.commands.stopped_runs import Ended, Moment
from course_lib.commands.whole_outputs import state
from course_lib.paths import data_path
from tests.commands.test_interrupt import REFUSED

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="it forks")

BY_NAME = {case.name: case for case in CASES}
KEEPS = """
import sys
from pathlib import Path
out, which = Path(sys.argv[1]), sys.argv[2]
rows = out / "rows.txt"
print("kept" if rows.exists() else "made anew")
if which == "2" and not rows.exists():
    rows.write_text("takes long")
(out / "a.txt").write_text(which)
"""
TEMPORARY = """
import os, sys, tempfile
from pathlib import Path
held = tempfile.mkdtemp()
(Path(sys.argv[1]) / "a.txt").write_text(sys.argv[2])
"""

FILLED = """
import sys, tempfile
from pathlib import Path
with tempfile.TemporaryDirectory(dir={place}) as folder:
    for number in range(5):
        Path(folder, str(number)).write_text("")
(Path(sys.argv[1]) / "a.txt").write_text(sys.argv[2])
"""

ROW_1, ROW_2 = b'{"seed": 1, "ms": 5}\n', b'{"seed": 2, "found": 3, "ms": 5}\n'


@pytest.mark.parametrize(
    ("rows", "expected"),
    [
        (ROW_1, "old"),
        (ROW_1 + ROW_2, "new"),
        (ROW_1 + b'{"seed": 2, "found": 3, "ms": 71}\n', "new"),
        (ROW_1 + b'{"seed": 2, "found": 4, "ms": 5}\n', "broken"),
        (ROW_1 + ROW_2[:18], "between"),
        (ROW_1 + b'{"seed": 2, "found": 3, "ms": 7', "between"),
        (ROW_1 + b'{"seed": 2, "found": 4', "broken"),
        (ROW_1 + ROW_2 + b"{", "broken"),
        (ROW_1 + b"\n", "broken"),
        (b'{"seed": 1, "ms": 6}\n', "broken"),
        (ROW_2, "broken"),
        (b"", "broken"),
    ],
)
def test_rows_may_tell_other_times_and_end_in_a_row_that_was_begun(rows, expected):
    assert state({"a.jsonl": rows}, {"a.jsonl": ROW_1}, {"a.jsonl": ROW_1 + ROW_2}, by_file=True) == expected


def test_what_takes_long_is_done_once_and_kept_for_the_runs_that_are_stopped(tmp_path):
    with Staged(Case("kept", "{out} {which}", KEEPS, kept=True), tmp_path.resolve()) as staged:
        assert staged.old == {"rows.txt": b"takes long", "a.txt": b"1"}
        staged.begin_anew()
        assert staged.run(2).printed.strip() == "kept"


def test_what_killed_runs_leave_in_the_folder_for_temporary_files_goes_with_the_case(tmp_path, monkeypatch):
    (tmp_path / "users").mkdir()
    (tmp_path / "case").mkdir()
    monkeypatch.setenv("TMPDIR", str(tmp_path / "users"))
    with Staged(Case("temporary", "{out} {which}", TEMPORARY), (tmp_path / "case").resolve()) as staged:
        interruptions(staged, [Moment(step=1)])
    assert not [path for path in (tmp_path / "users").iterdir() if path.name.startswith("tmp")]
    assert list((tmp_path / "case" / "tmp").iterdir())


@pytest.mark.skipif(not os.path.isdir("/proc/self/fd"), reason="whose folder a name is in cannot be told here")
def test_a_step_is_what_happens_where_the_outputs_go_and_not_in_other_folders(tmp_path):
    steps = {}
    for name, place in (("elsewhere", "None"), ("beside", "Path(sys.argv[1]).parent")):
        (tmp_path / name).mkdir()
        with Staged(Case(name, "{out} {which}", FILLED.format(place=place)), (tmp_path / name).resolve()) as staged:
            steps[name] = staged.steps
    assert steps["elsewhere"] == 1, "a.txt is opened for writing"
    assert steps["beside"] == 1 + 2 * 5 + 2, "so are five more, which go again, and their folder comes and goes"


def test_from_the_finished_rooms_the_projects_become_what_is_shipped(tmp_path):
    with Staged(BY_NAME["make-data projects"], tmp_path.resolve()) as staged:
        for name in ("rooms_practice.json", "rooms_hidden.json"):
            shipped = (data_path("projects") / name).read_bytes()
            assert staged.new[name] == shipped != staged.old[name]


@pytest.mark.skipif(why_no_disk() is not None, reason=f"no disk can be filled here: {why_no_disk()}")
def test_a_command_that_was_made_short_is_held_to_the_end_of_a_command_on_a_full_disk(tmp_path):
    with Staged(BY_NAME["bench"], tmp_path.resolve()) as staged:
        assert full_disks(staged)["faults"] == []
        ended = Ended(1, "", f"Traceback: {staged.stage}: No space left on device", 99, ())
        assert any("exit code 1" in fault for fault in wrong_end(ended, "old", staged))


NOT_KILLED = {
    "train-detector": "it needs PyTorch, which the course does not install: its checkpoints alone, by a writer",
    "interrupt": "it would kill itself",
}


def test_every_command_with_an_out_folder_is_killed_or_it_is_said_why_not():
    assert {*REFUSED, "progress"} - set(BY_NAME) == set(NOT_KILLED)
