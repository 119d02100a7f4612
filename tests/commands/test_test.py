"""`course.py test`: which tests run, on how many processors, and that an empty or failing run never reads as a pass."""

import os
import sys
from subprocess import CompletedProcess

import nbformat
import pytest

from courseware.cli import main, parse
from courseware.commands import test as command


def words_for(*words, n_workers=1):
    return command.pytest_arguments(parse("course.py test", command, list(words)), n_workers)


@pytest.mark.parametrize(
    ("words", "parts", "marks"),
    [
        (["--all"], ["notebooks", "tests"], None),
        (["-x"], ["notebooks", "tests"], "not release"),
        (["--fast"], ["tests"], "not release and not browser and not slow"),
    ],
)
def test_the_lessons_and_the_tests_run_on_every_processor_and_parts_can_be_left_out(words, parts, marks):
    given = words_for(*words, "-n", "3", n_workers=2)
    # The cells of a lesson share a kernel: spread over two processes they would fail.
    assert given[given.index("-n") :][:2] == ["-n", "2"]
    assert given[given.index("--dist") + 1] == "loadfile"
    assert given[-2:] == ["-n", "3"], "one's own comes last, so that it counts"
    assert "-n" not in words_for(*words)
    assert [word for word in given if word in ("notebooks", "tests")] == parts
    assert ("--nbval" in given) == ("notebooks" in parts)
    assert (given[given.index("-m") + 1] if "-m" in given else None) == marks
    assert ("--ignore=tests/lessons" in given) == ("--fast" in words)


@pytest.fixture
def course(tmp_path, monkeypatch):
    """A course without lessons and tests, whose tests run in two processes."""
    (tmp_path / "tests").mkdir()
    (tmp_path / "tests" / "nbval_sanitize.cfg").touch()
    monkeypatch.setattr(command, "REPOSITORY", tmp_path)
    monkeypatch.setattr(command, "cpu_count", lambda: 2)
    return tmp_path


def write_notebook(path, *cells):
    """A notebook of cells (source, what is stored as printed)."""
    written = [nbformat.v4.new_code_cell(source, execution_count=1) for source, _ in cells]
    for cell, (_, printed) in zip(written, cells, strict=True):
        cell.outputs = [nbformat.v4.new_output("stream", name="stdout", text=printed)]
    path.parent.mkdir(exist_ok=True)
    nbformat.write(nbformat.v4.new_notebook(cells=written, metadata={"language_info": {"name": "python"}}), path)


CONNECT = """
import socket
try:
    socket.create_connection(("192.0.2.1", 80), timeout=1800)
except OSError as error:
    print("offline" in str(error))
"""


@pytest.mark.slow
def test_a_failing_test_and_a_wrong_stored_output_fail_the_run(course, capfd):
    (course / "tests" / "test_one.py").write_text("def test_one():\n    assert False\n")
    # The second cell needs the first one's kernel; the third reaches for the network.
    write_notebook(
        course / "notebooks" / "00_a.ipynb", ("x = 7; print(x)", "7\n"), ("print(x + 1)", "7\n"), (CONNECT, "True\n")
    )
    assert main(["test"]) == 1
    out = capfd.readouterr().out
    assert "2 failed, 2 passed" in out
    assert "FAILED (pytest's exit code 1); not all tests passed." in out


@pytest.mark.parametrize(
    ("code", "said"), [(0, "all tests passed"), (5, "FAILED, because no test was found"), (2, "code 2")]
)
def test_only_a_run_of_tests_that_all_passed_reads_as_a_pass(course, monkeypatch, capsys, code, said):
    monkeypatch.setattr(command.subprocess, "run", lambda *words, **_: CompletedProcess(words, code))
    assert main(["test", "tests"]) == code
    assert said in capsys.readouterr().out.splitlines()[-1]


def test_no_display_and_none_of_the_users_settings_reach_the_tests(tmp_path):
    user = {"DISPLAY": ":0", "JUPYTER_CONFIG_DIR": "/home/me/.jupyter", "PATH": os.environ["PATH"], "MPLBACKEND": "x"}
    environment = command.suite_environment(tmp_path, user)
    assert not {"DISPLAY", "MPLBACKEND"} & set(environment)
    assert environment["JUPYTER_CONFIG_DIR"].startswith(str(tmp_path))
    assert environment["PATH"] == user["PATH"]
    if sys.platform.startswith("linux"):
        assert environment["VTK_DEFAULT_OPENGL_WINDOW"] == "vtkEGLRenderWindow"
