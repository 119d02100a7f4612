"""Workers end with the process that they work for: by its end, by an exception, by kill -9."""

import multiprocessing
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from course_lib.worker_pool import worker_pool

ROOT = Path(__file__).resolve().parents[1]
HANGS_S = 600
ENDS_S = 120  # of a process whose pipe is closed; a whole minute on a busy machine is nothing unusual

KILLED = """
import sys
from tests.test_worker_pool import note_and_sleep
from course_lib.worker_pool import worker_pool
if __name__ == "__main__":
    with worker_pool(2) as pool:
        list(pool.map(note_and_sleep, [sys.argv[1]] * 2))
"""
KILLED_BESIDE = """
import sys
from pathlib import Path
from tests.test_worker_pool import note_and_sleep_beside
from tools.detector_training.workers import start_others
if __name__ == "__main__":
    for process in start_others(3, Path("meeting"), note_and_sleep_beside, (sys.argv[1],)):
        process.join()
"""


def square(number):
    return number * number


def note_and_sleep(folder):
    (Path(folder) / f"worker-{os.getpid()}").touch()
    time.sleep(HANGS_S)


def note_and_sleep_beside(rank, count, meeting_file, folder):
    note_and_sleep(folder)


def press_ctrl_c():
    try:
        os.kill(os.getpid(), signal.SIGINT)
        time.sleep(0.1)
    except KeyboardInterrupt:
        return "stopped"
    return "still here"


def note_start(folder):
    (Path(folder) / f"begun-{os.getpid()}").touch()


def wait_until(told, what, most=HANGS_S):
    begun = time.monotonic()
    while not told():
        assert time.monotonic() - begun < most, what
        time.sleep(0.05)


def noted(folder):
    return [int(path.name.split("-")[1]) for path in Path(folder).glob("worker-*")]


def runs(process_id):
    """Whether a process is there that is not dead already (a zombie waits for whoever adopted it)."""
    try:
        os.kill(process_id, 0)
        status = Path(f"/proc/{process_id}/stat")
        return not (status.exists() and status.read_text().rsplit(")", 1)[1].split()[0] == "Z")
    except (ProcessLookupError, FileNotFoundError):
        return False


def test_work_is_done_in_fresh_processes_that_begin_as_told(tmp_path):
    with worker_pool(2, note_start, (str(tmp_path),)) as pool:
        assert list(pool.map(square, range(4))) == [0, 1, 4, 9]
    assert 1 <= len(list(tmp_path.glob("begun-*"))) <= 2
    assert str(os.getpid()) not in {path.name.split("-")[1] for path in tmp_path.glob("begun-*")}
    assert not multiprocessing.active_children()


@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
def test_ctrl_c_which_reaches_all_of_a_terminals_processes_stops_no_worker_by_itself():
    earlier = signal.getsignal(signal.SIGINT)
    with worker_pool(1) as pool:
        assert pool.submit(press_ctrl_c).result() == "still here"
    assert signal.getsignal(signal.SIGINT) is earlier
    assert signal.SIGINT not in signal.pthread_sigmask(signal.SIG_BLOCK, set()), "here it goes on to work"


def test_an_exception_ends_the_workers_in_the_middle_of_their_work(tmp_path):
    def stop_in_the_middle():
        with worker_pool(1) as pool:
            pool.submit(note_and_sleep, str(tmp_path))
            wait_until(lambda: noted(tmp_path), "the worker began")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        stop_in_the_middle()
    wait_until(lambda: not any(map(runs, noted(tmp_path))), "the worker ended", ENDS_S)


@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
@pytest.mark.parametrize("sent", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
@pytest.mark.parametrize("code", [KILLED, KILLED_BESIDE], ids=["pool", "training"])
def test_no_worker_is_left_by_a_process_that_is_killed(tmp_path, code, sent):
    if code is KILLED_BESIDE:
        pytest.importorskip("torch")
    program = tmp_path / "program.py"
    program.write_text(code)
    process = subprocess.Popen(
        [sys.executable, str(program), str(tmp_path)],
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        stderr=subprocess.DEVNULL,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    wait_until(lambda: len(noted(tmp_path)) == 2 or process.poll() is not None, "two workers began")
    assert process.poll() is None
    process.send_signal(sent)  # to it alone, as `kill` does
    process.wait(HANGS_S)
    wait_until(lambda: not any(map(runs, noted(tmp_path))), "the workers ended", ENDS_S)
