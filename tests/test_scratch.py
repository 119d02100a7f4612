"""What is made for a while in the temporary folder goes with its run, or, where that was killed, with the next one."""

import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import pytest

from course_lib.scratch import PREFIX, clear_scratch, scratch_folder

ROOT = Path(__file__).resolve().parents[1]
HOLDS = """
import sys, time
from course_lib.output_folder import replaced_outputs
from course_lib.scratch import scratch_folder
with scratch_folder() as folder:
    (folder / "deep").mkdir()
    (folder / "deep" / "work").write_text("begun")
    (folder / "deep").chmod(0)
    with replaced_outputs(folder, None):
        print(folder, flush=True)
        time.sleep(600)
"""
WORKS = """
import sys, types
from course_lib import cli
from course_lib.worker_pool import worker_pool
from tests.test_scratch import hold
def run(arguments):
    with worker_pool(2, hold, (sys.argv[1],)) as pool:
        list(pool.map(int, range(2)))
if __name__ == "__main__":
    sys.modules["course_lib.commands.try_it"] = types.SimpleNamespace(run=run, add_arguments=lambda parser: None)
    cli.COMMANDS["try"] = ("try_it", "a try")
    sys.exit(cli.main(["try"]))
"""

pytestmark = pytest.mark.skipif(os.name == "nt", reason="no locks on folders there, so nothing is cleared")


@pytest.fixture(autouse=True)
def temporary(tmp_path, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    return tmp_path


def hold(folder):
    with scratch_folder() as held:
        (held / "work").write_text("begun")
        (Path(folder) / f"worker-{os.getpid()}").touch()
        time.sleep(600)


def begun():
    """A process that holds a scratch folder, and the folder."""
    process = subprocess.Popen([sys.executable, "-c", HOLDS], cwd=ROOT, stdout=subprocess.PIPE, text=True)
    return process, Path(process.stdout.readline().strip())


def test_it_is_gone_at_the_end_and_after_an_error(temporary):
    with scratch_folder() as folder:
        (folder / "a").write_text("x")
    assert folder.parents[2] == temporary
    with pytest.raises(KeyError), scratch_folder():
        raise KeyError
    assert list(temporary.iterdir()) == []


WAITS = """
import sys
from course_lib.output_folder import replaced_outputs
from course_lib.scratch import scratch_folder
with scratch_folder() as folder, replaced_outputs(folder, None) as new:
    (new / "a").write_text("first")
    with replaced_outputs(new, None) as newer:
        (newer / "b").write_text("second")
    assert [path.name for path in folder.iterdir()] == []
    print(sorted(path.name for path in new.iterdir()))
print("done")
"""


def test_a_folder_of_ours_can_itself_be_put_in_place_and_nobody_waits_for_himself():
    """Lesson 20 once waited for ever: the lock that it wanted was its own."""
    command = [sys.executable, "-c", WAITS]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=120, check=True)
    assert done.stdout.splitlines() == ["['a', 'b']", "done"]


def test_the_next_run_clears_what_a_killed_one_left_and_nothing_of_one_that_lives(temporary):
    (killed, left), (lives, held) = begun(), begun()
    try:
        killed.send_signal(signal.SIGKILL)
        killed.wait()
        assert left.is_dir()
        with scratch_folder() as folder:
            assert sorted(temporary.iterdir()) == sorted([held.parents[1], folder.parents[1]])
    finally:
        lives.kill()
        lives.wait()
    clear_scratch()
    assert list(temporary.iterdir()) == []


def test_a_link_and_a_strangers_folder_stay(temporary):
    (temporary / "precious").mkdir()
    (temporary / "precious" / "a").write_text("x")
    (temporary / f"{PREFIX}link").symlink_to("precious", target_is_directory=True)
    (temporary / "course-scratch-").mkdir()
    clear_scratch()
    assert sorted(path.name for path in temporary.iterdir()) == ["course-scratch-", f"{PREFIX}link", "precious"]
    assert (temporary / "precious" / "a").read_text() == "x"


@pytest.mark.parametrize(("sent", "to", "code"), [(signal.SIGTERM, os.kill, 143), (signal.SIGINT, os.killpg, 130)])
def test_a_command_that_is_stopped_clears_its_workers_folders_too(sent, to, code, temporary, tmp_path_factory):
    """Ctrl-C reaches all processes of a terminal at once, `kill` one alone."""
    notes = tmp_path_factory.mktemp("notes")
    (notes / "program.py").write_text(WORKS)
    process = subprocess.Popen(
        [sys.executable, str(notes / "program.py"), str(notes)],
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    while len(list(notes.glob("worker-*"))) < 2:
        assert process.poll() is None
        time.sleep(0.05)
    assert len(list(temporary.glob(f"{PREFIX}*"))) == 2
    to(process.pid, sent)
    assert process.communicate()[1].strip() == "Stopped."
    assert process.returncode == code
    assert list(temporary.iterdir()) == []
