"""`course.py score`: a file that was handed in, scored without its notebook; what does not fit is named."""

import nbformat
import pytest
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook

from courseware.cli import main
from courseware.lessons.kit import score as scoring


@pytest.fixture
def scored(monkeypatch):
    """What the score would be of: (project, function, seeds)."""
    calls = []
    monkeypatch.setattr(scoring, "score", lambda *given: calls.append(given))
    return calls


def test_the_files_function_is_scored_and_of_a_notebook_only_what_defines_is_run(scored, tmp_path):
    (tmp_path / "P1.py").write_text("def localize(*given):\n    return 42\n")
    assert scoring.main(["P1", str(tmp_path / "P1.py"), "--seeds", "10001", "10002"]) == 0
    ((name, function, seeds),) = scored
    assert (name, function(), seeds) == ("P1", 42, [10_001, 10_002])
    sources = ["%matplotlib inline\nSIZE = 6", "check('P1.1', 1 / 0)", "def localize(*given):\n    return SIZE"]
    notebook = new_notebook(cells=[new_markdown_cell("# P1"), *map(new_code_cell, sources)])
    path = tmp_path / "P1.ipynb"
    nbformat.write(notebook, path)
    assert scoring.main(["P1", str(path)]) == 0
    _, function, seeds = scored[1]
    assert (function(), seeds) == (6, None)


@pytest.mark.parametrize(
    ("text", "words"), [("def locate(): ...\n", "no function localize()"), ("def localize(:\n", "is not Python")]
)
def test_a_file_that_does_not_fit_is_named(scored, tmp_path, capsys, text, words):
    (tmp_path / "P1.py").write_text(text)
    assert scoring.main(["P1", str(tmp_path / "P1.py")]) == 2
    assert words in capsys.readouterr().err
    assert not scored


def test_a_file_that_is_not_there_is_said_to_be_missing(tmp_path, capsys):
    assert scoring.main(["P1", str(tmp_path / "nofile")]) == 2
    assert "nofile is missing" in capsys.readouterr().err


def test_the_command_runs_it_in_a_process_of_its_own(monkeypatch):
    ran = []
    monkeypatch.setattr("subprocess.call", lambda words: ran.append(words) or 7)
    assert main(["score", "P1", "a.py", "--seeds", "10001"]) == 7
    assert ran[0][1:] == ["-P", "-m", "courseware.lessons.kit.score", "P1", "a.py", "--seeds", "10001"]
