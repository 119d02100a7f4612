"""`course.py test`: which tests run, and that an empty or failing run never reads as a pass."""

import argparse
import os
import re
import sys

import pytest

from course_lib.commands import test as test_command


def test_without_arguments_the_tests_and_the_notebooks_run():
    parts = test_command.choose_parts([])
    assert list(parts) == ["tests", "notebooks"]
    assert parts["tests"] == ["tests"]
    assert parts["notebooks"][-1] == "notebooks"
    assert "--nbval" in parts["notebooks"]
    assert "--nbval-lax" not in parts["notebooks"]


def test_options_go_to_both_parts():
    parts = test_command.choose_parts(["-x", "-k", "wrap"])
    assert parts["tests"] == ["-x", "-k", "wrap", "tests"]
    assert parts["notebooks"][-4:] == ["-x", "-k", "wrap", "notebooks"]


@pytest.mark.parametrize(
    ("passed_on", "part", "arguments"),
    [
        (["tests/test_geometry.py", "-k", "foo"], "tests", ["-k", "foo", "tests/test_geometry.py"]),
        (["tests/test_geometry.py::test_a"], "tests", ["tests/test_geometry.py::test_a"]),
        (["tests/not_there.py"], "tests", ["tests/not_there.py"]),
        (["notebooks/00_start_here.ipynb"], "notebooks", ["notebooks/00_start_here.ipynb"]),
        (["notebooks/"], "notebooks", ["notebooks/"]),
    ],
)
def test_a_path_chooses_its_part_alone(passed_on, part, arguments):
    parts = test_command.choose_parts(passed_on)
    assert list(parts) == [part]
    assert parts[part][-len(arguments) :] == arguments


def test_one_part_can_be_left_out():
    assert list(test_command.choose_parts([], no_notebooks=True)) == ["tests"]
    assert list(test_command.choose_parts([], only_notebooks=True)) == ["notebooks"]


@pytest.mark.parametrize(
    ("codes", "chosen", "passes"),
    [
        ({"tests": 0, "notebooks": 0}, False, True),
        ({"tests": 1, "notebooks": 0}, False, False),
        ({"tests": 0, "notebooks": 2}, False, False),
        ({"tests": 0, "notebooks": 5}, False, False),  # no notebook was found
        ({"tests": 5, "notebooks": 0}, False, False),
        ({"tests": 0, "notebooks": 5}, True, True),  # -k chose tests of one part
        ({"tests": 5, "notebooks": 5}, True, False),
        ({"tests": 5, "notebooks": 1}, True, False),
        ({}, False, False),
    ],
)
def test_only_a_run_with_tests_and_without_failures_passes(codes, chosen, passes, capsys):
    code = test_command.conclude(codes, chosen, 1.0)
    assert (code == 0) == passes
    closing = capsys.readouterr().out.strip().splitlines()[-1]
    assert closing.endswith("all tests passed.") == passes or "not all" in closing
    assert ("FAILED" in closing) == (not passes)


def run_in(folder, monkeypatch, *passed_on):
    """Runs the command on another folder's tests/ and notebooks/."""
    monkeypatch.setattr(test_command, "ROOT", folder)
    return test_command.run(
        argparse.Namespace(passed_on=list(passed_on), no_notebooks=False, only_notebooks=False, debug=False)
    )


def write_notebook(path, source, printed):
    """A notebook of one cell with a stored output."""
    import nbformat

    cell = nbformat.v4.new_code_cell(source, execution_count=1)
    cell.outputs = [nbformat.v4.new_output("stream", name="stdout", text=printed)]
    notebook = nbformat.v4.new_notebook(cells=[cell], metadata={"language_info": {"name": "python"}})
    path.parent.mkdir(exist_ok=True)
    nbformat.write(notebook, path)


@pytest.mark.parametrize(
    ("test_body", "printed", "passes"),
    [("assert True", "2\n", True), ("assert False", "2\n", False), ("assert True", "3\n", False)],
)
def test_a_failing_test_and_a_wrong_stored_output_fail_the_run(tmp_path, monkeypatch, test_body, printed, passes):
    (tmp_path / "tests").mkdir()
    (tmp_path / "tests" / "test_one.py").write_text(f"def test_one():\n    {test_body}\n")
    write_notebook(tmp_path / "notebooks" / "00_a.ipynb", "print(1 + 1)", printed)
    assert (run_in(tmp_path, monkeypatch) == 0) == passes


@pytest.mark.parametrize("wrong", range(4))
def test_a_wrong_output_in_either_half_of_the_lessons_fails_the_run(tmp_path, monkeypatch, capfd, wrong):
    (tmp_path / "tests").mkdir()
    (tmp_path / "tests" / "test_one.py").write_text("def test_one():\n    pass\n")
    for number in range(3):
        write_notebook(
            tmp_path / "notebooks" / f"0{number}_a.ipynb", "print(1 + 1)", "3\n" if number == wrong else "2\n"
        )
    assert (run_in(tmp_path, monkeypatch) == 0) == (wrong == 3)
    printed = capfd.readouterr().out
    assert all(f"0{number}_a.ipynb" in printed for number in range(3))


def test_with_one_processor_the_lessons_run_one_after_the_other(tmp_path, monkeypatch):
    monkeypatch.setattr(test_command, "ROOT", tmp_path)
    for number in range(3):
        write_notebook(tmp_path / "notebooks" / f"0{number}_a.ipynb", "print(2)", "2\n")
    assert test_command.in_two_halves(["--nbval", "notebooks"], 1) == [["--nbval", "notebooks"]]
    first, second = test_command.in_two_halves(["--nbval", "notebooks"], 2)
    assert first == ["--nbval", os.path.join("notebooks", "00_a.ipynb"), os.path.join("notebooks", "02_a.ipynb")]
    assert second == ["--nbval", os.path.join("notebooks", "01_a.ipynb")]


def test_no_test_at_all_fails_with_a_sentence(tmp_path, monkeypatch, capfd):
    (tmp_path / "tests").mkdir()
    (tmp_path / "notebooks").mkdir()
    assert run_in(tmp_path, monkeypatch) == 5
    assert re.search("tests and notebooks: FAILED, because no test was found", capfd.readouterr().out)


def test_no_display_and_none_of_the_users_settings_reach_the_tests(tmp_path):
    user = {"DISPLAY": ":0", "JUPYTER_CONFIG_DIR": "/home/me/.jupyter", "PATH": os.environ["PATH"], "MPLBACKEND": "x"}
    for part, backend in (("tests", "Agg"), ("notebooks", None)):
        environment = test_command.part_environment(part, tmp_path, user)
        assert "DISPLAY" not in environment
        assert environment["JUPYTER_CONFIG_DIR"].startswith(str(tmp_path))
        assert environment.get("MPLBACKEND") == backend
        assert environment["PATH"] == user["PATH"]
        if sys.platform.startswith("linux"):
            assert environment["VTK_DEFAULT_OPENGL_WINDOW"] == "vtkEGLRenderWindow"


@pytest.mark.parametrize("option", ["-k", "--deselect", "-p"])
def test_an_options_value_is_no_path_though_it_may_look_like_one(option):
    parts = test_command.choose_parts([option, "data", "-x"])
    assert list(parts) == ["tests", "notebooks"]
    assert parts["tests"] == [option, "data", "-x", "tests"]
