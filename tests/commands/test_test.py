"""`course.py test`: which tests run, on how many processors, and that an empty or failing run never reads as a pass."""

import argparse
import os
import sys
from pathlib import Path

import pytest

from course_lib.commands import test as test_command


def test_without_arguments_the_lessons_and_the_tests_run_in_one_run():
    words = test_command.pytest_arguments([])
    assert words[:2] == ["notebooks", "tests"]
    assert "--nbval" in words
    assert "--nbval-lax" not in words


def test_options_are_passed_on():
    assert test_command.pytest_arguments(["-x", "-k", "wrap"])[-3:] == ["-x", "-k", "wrap"]


def test_the_whole_runs_on_every_processor_and_a_file_stays_on_one():
    words = test_command.pytest_arguments(["-x"], workers=2)
    assert words[words.index("-n") + 1] == "2"
    # The cells of a lesson share a kernel: spread over two processes they would fail.
    assert words[words.index("--dist") + 1] == "loadfile"
    assert "-n" not in test_command.pytest_arguments(["-x"], workers=1)
    # One's own -n comes last, so that it counts.
    assert test_command.pytest_arguments(["-n", "3"], workers=2)[-2:] == ["-n", "3"]


def test_workers_do_not_start_threads_that_wait_for_each_other():
    assert test_command.one_thread_a_worker(["-n", "2"])["OMP_NUM_THREADS"] == "1"
    assert test_command.one_thread_a_worker(["tests"]) == {}


@pytest.mark.parametrize(
    ("passed_on", "lessons"),
    [
        (["tests/test_geometry.py", "-k", "foo"], False),
        (["tests/test_geometry.py::test_a"], False),
        (["tests/not_there.py"], False),
        (["notebooks/00_start_here.ipynb"], True),
        (["notebooks/", "tests/test_geometry.py"], True),
    ],
)
def test_a_path_chooses_what_runs_in_this_one_process(passed_on, lessons):
    words = test_command.pytest_arguments(passed_on, workers=2)
    assert words[-len(passed_on) :] == passed_on
    assert not {"tests", "notebooks", "-n"} & set(words)
    assert ("--nbval" in words) == lessons


@pytest.mark.parametrize("option", ["-k", "--deselect", "-p", "-m", "-n"])
def test_an_options_value_is_no_path_though_it_may_look_like_one(option):
    words = test_command.pytest_arguments([option, "data", "-x"])
    assert words[:2] == ["notebooks", "tests"]


def test_parts_can_be_left_out():
    assert test_command.pytest_arguments([], no_notebooks=True)[0] == "tests"
    only = test_command.pytest_arguments([], only_notebooks=True)
    assert only[0] == "notebooks"
    assert "tests" not in only
    fast = test_command.pytest_arguments([], fast=True)
    assert "notebooks" not in fast
    assert fast[fast.index("-m") + 1] == "not browser and not slow"
    assert "--ignore=tests/lessons" in fast


def test_without_a_lesson_the_whole_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(test_command, "ROOT", tmp_path)
    (tmp_path / "notebooks").mkdir()
    with pytest.raises(ValueError, match="no lesson was found"):
        test_command.pytest_arguments([])
    assert test_command.pytest_arguments([], no_notebooks=True)[0] == "tests"


@pytest.mark.parametrize("code", [0, 1, 2, 4, 5])
def test_only_a_run_with_tests_and_without_failures_passes(code, capsys):
    assert test_command.conclude(code, 1.0) == code
    closing = capsys.readouterr().out.strip().splitlines()[-1]
    assert ("all tests passed." in closing and "not all" not in closing) == (code == 0)
    assert ("FAILED" in closing) == (code != 0)


def run_in(folder, monkeypatch, *passed_on):
    """Runs the command on another folder's tests/ and notebooks/, in two processes."""
    monkeypatch.setattr(test_command, "ROOT", folder)
    monkeypatch.setattr(test_command, "processors", lambda: 2)
    return test_command.run(
        argparse.Namespace(
            passed_on=list(passed_on),
            fast=False,
            no_notebooks=False,
            only_notebooks=False,
            debug=False,
        )
    )


def write_notebook(path, *cells):
    """A notebook of cells (source, what is stored as printed)."""
    import nbformat

    written = [nbformat.v4.new_code_cell(source, execution_count=1) for source, _ in cells]
    for cell, (_, printed) in zip(written, cells, strict=True):
        cell.outputs = [nbformat.v4.new_output("stream", name="stdout", text=printed)]
    notebook = nbformat.v4.new_notebook(cells=written, metadata={"language_info": {"name": "python"}})
    path.parent.mkdir(exist_ok=True)
    nbformat.write(notebook, path)


CONNECT = """
import socket
try:
    socket.create_connection(("192.0.2.1", 80), timeout=1800)
except OSError as error:
    print("offline" in str(error))
"""


@pytest.mark.slow
def test_a_failing_test_and_a_wrong_stored_output_fail_the_run(tmp_path, monkeypatch, capfd):
    (tmp_path / "tests").mkdir()
    (tmp_path / "tests" / "test_one.py").write_text("def test_one():\n    assert False\n")
    # The second cell needs the first one's kernel; the third reaches for the network.
    write_notebook(
        tmp_path / "notebooks" / "00_a.ipynb", ("x = 7; print(x)", "7\n"), ("print(x + 1)", "7\n"), (CONNECT, "True\n")
    )
    write_notebook(tmp_path / "notebooks" / "01_b.ipynb", ("print(2)", "2\n"))
    assert run_in(tmp_path, monkeypatch) == 1
    assert "2 failed, 3 passed" in capfd.readouterr().out


def test_a_run_without_a_failure_passes(tmp_path, monkeypatch, capfd):
    (tmp_path / "tests").mkdir()
    (tmp_path / "tests" / "test_one.py").write_text("def test_one():\n    assert True\n")
    assert run_in(tmp_path, monkeypatch, "tests") == 0
    assert "1 passed" in capfd.readouterr().out


def test_no_test_at_all_fails_with_a_sentence(tmp_path, monkeypatch, capfd):
    (tmp_path / "tests").mkdir()
    assert run_in(tmp_path, monkeypatch, "tests") == 5
    assert "FAILED, because no test was found" in capfd.readouterr().out


def test_no_display_and_none_of_the_users_settings_reach_the_tests(tmp_path):
    user = {"DISPLAY": ":0", "JUPYTER_CONFIG_DIR": "/home/me/.jupyter", "PATH": os.environ["PATH"], "MPLBACKEND": "x"}
    environment = test_command.suite_environment(tmp_path, user)
    assert "DISPLAY" not in environment
    assert "MPLBACKEND" not in environment
    assert environment["JUPYTER_CONFIG_DIR"].startswith(str(tmp_path))
    assert environment["PATH"] == user["PATH"]
    if sys.platform.startswith("linux"):
        assert environment["VTK_DEFAULT_OPENGL_WINDOW"] == "vtkEGLRenderWindow"


@pytest.fixture
def arranged(request):
    """What tests/conftest.py makes of collected tests (file, marks, fixtures): their files and marks, in order."""
    conftest = request.config.pluginmanager.get_plugin(str(Path(__file__).parents[1] / "conftest.py"))

    class Item:
        def __init__(self, file, *marks, fixtures=()):
            self.path, self.marks, self.fixturenames = Path(file), list(marks), fixtures

        def add_marker(self, name):
            self.marks.append(name)

        def get_closest_marker(self, name):
            return name if name in self.marks else None

    def arrange(*described):
        items = [Item(file, *marks, fixtures=fixtures) for file, marks, fixtures in described]
        conftest.pytest_collection_modifyitems(items)
        return [(item.path.name, item.marks) for item in items]

    return arrange


def test_what_drives_a_browser_is_marked_by_its_fixture(arranged):
    tests = [("a.py", [], ("browser", "lab")), ("a.py", [], ("page",)), ("a.py", [], ("lab",)), ("a.py", [], ())]
    assert [marks for _, marks in arranged(*tests)] == [["browser"], ["browser"], [], []]


def test_the_files_that_take_long_come_first_and_stay_whole(arranged):
    tests = [("a.py", [], ()), ("b.py", [], ()), ("b.py", ["slow"], ()), ("c.ipynb", [], ()), ("d.py", [], ("page",))]
    assert [name for name, _ in arranged(*tests)] == ["c.ipynb", "b.py", "b.py", "d.py", "a.py"]
