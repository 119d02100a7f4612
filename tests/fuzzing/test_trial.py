"""Every class of verdict is noticed, each with a reader that is bad on purpose."""

import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

from course_lib.fuzzing.trial import DEFECTS, Verdict, try_file

LONG = 600.0
"""Seconds: no reader here takes so long on any machine, but for the one that never ends."""


class NamedError(ValueError):
    """What the readers here may raise."""


def told(reader, path, explain=lambda data, found, original: None, seconds=LONG, **limits) -> Verdict:
    return try_file(path, reader, (NamedError,), explain, {"numbers": np.arange(3)}, seconds, **limits)


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "poses.txt"
    path.write_bytes(b"damaged")
    return path


def test_an_error_that_names_the_file_is_a_refusal(file):
    def reader(path):
        raise NamedError(f"{path} is damaged")

    found = told(reader, file)
    assert found.outcome == "refused"
    assert "poses.txt is damaged" in found.told


def test_an_error_of_the_right_type_without_the_files_name_has_no_name(file):
    def reader(path):
        raise NamedError("row 3 is damaged")

    assert told(reader, file).outcome == "unnamed"


def test_an_error_of_another_type_has_no_name_even_with_the_files_name(file):
    def reader(path):
        raise KeyError(str(path))

    found = told(reader, file)
    assert found.outcome == "unnamed"
    assert "KeyError" in found.told


def test_the_same_result_is_the_same(file):
    assert told(lambda path: {"numbers": np.arange(3)}, file).outcome == "same"


def test_another_result_needs_a_reason(file):
    def reader(path):
        return {"numbers": np.arange(4)}

    assert told(reader, file).outcome == "unexplained"
    assert "numbers" in told(reader, file).told
    found = told(reader, file, explain=lambda data, found, original: f"it says {data.decode()}")
    assert (found.outcome, found.told) == ("changed", "it says damaged")


def test_a_reason_that_cannot_be_found_is_none(file):
    found = told(lambda path: {"numbers": np.arange(4)}, file, explain=lambda data, found, original: found["names"])
    assert found.outcome == "unexplained"


def test_what_is_no_file_cannot_be_read_with_another_result(tmp_path):
    path = tmp_path / "poses.txt"
    path.symlink_to("nowhere")
    seen = told(lambda path: {"numbers": None}, path, explain=lambda data, found, original: "it may be missing")
    assert seen.outcome == "unexplained"
    path.unlink()
    seen = told(lambda path: {"numbers": None}, path, explain=lambda data, found, original: f"the file is {data}")
    assert (seen.outcome, seen.told) == ("changed", "the file is None")


def test_a_crash_is_a_crash(file):
    found = told(lambda path: os.kill(os.getpid(), signal.SIGSEGV), file)
    assert (found.outcome, found.told) == ("crash", "died by SIGSEGV")


def test_a_reader_that_ends_the_process_without_a_word_is_a_crash(file):
    found = told(lambda path: os._exit(3), file)
    assert found.outcome == "crash"
    assert "3" in found.told


def test_a_reader_that_never_ends_hangs(file):
    assert told(lambda path: time.sleep(10_000), file, seconds=1.0).outcome == "hang"


def test_a_reader_that_waits_for_a_child_of_its_own_hangs_and_leaves_nothing(file):
    program = "import os, sys, time; open(sys.argv[1], 'w').write(str(os.getpid())); time.sleep(10_000)"
    note = file.with_name("pid")
    found = told(
        lambda path: subprocess.run([sys.executable, "-c", program, str(note)], check=True), file, seconds=20.0
    )
    assert found.outcome == "hang"
    deadline = time.monotonic() + 60
    while _alive(int(note.read_text())) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert not _alive(int(note.read_text()))


def _alive(pid):
    try:
        with open(f"/proc/{pid}/stat") as file:
            return file.read().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def test_two_gigabytes_are_too_much(file):
    found = told(lambda path: {"numbers": np.ones(250_000_000)}, file)
    assert found.outcome == "memory"
    assert found.memory_mb > 2_000


def test_too_much_memory_counts_even_where_the_file_is_refused_by_name(file):
    def reader(path):
        np.ones(250_000_000)
        raise NamedError(f"{path} is damaged")

    assert told(reader, file).outcome == "memory"


def test_the_memory_of_the_readers_own_children_counts(file):
    program = "import numpy; numpy.ones(250_000_000)"
    found = told(lambda path: subprocess.run([sys.executable, "-c", program], check=True) and {}, file)
    assert found.outcome == "memory"


def test_memory_that_was_asked_for_and_not_there_counts_however_it_is_told(file):
    def reader(path):
        try:
            np.ones(10**12)
        except MemoryError as error:
            raise NamedError(f"{path} cannot be read ({error})") from error

    assert told(reader, file).outcome == "memory"


def test_the_next_file_is_judged_alone(file):
    """What the one reader did to itself, the next one does not meet."""
    for bad in (lambda path: os.kill(os.getpid(), signal.SIGSEGV), lambda path: {"numbers": np.ones(250_000_000)}):
        assert told(bad, file).outcome in DEFECTS
        found = told(lambda path: {"numbers": np.arange(3)}, file)
        assert found.outcome == "same"
        assert found.memory_mb < 1_000


def test_of_a_file_that_is_not_there_the_folder_is_named(tmp_path):
    def reader(path):
        raise NamedError(f"{path.parent} holds no poses")

    path = tmp_path / "poses.txt"
    assert told(reader, path).outcome == "refused"
    path.write_bytes(b"damaged")
    assert told(reader, path).outcome == "unnamed"
