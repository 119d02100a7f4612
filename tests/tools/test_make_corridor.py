"""`make-data corridor` tells at once what it will not do."""

import pytest

from course_lib.cli import main


@pytest.fixture(autouse=True)
def no_work(monkeypatch):
    """Making data takes minutes: a test that gets so far has failed."""

    def made(*_, **__):
        pytest.fail("work had begun")

    monkeypatch.setattr("tools.corridor_data.make_corridor_data", made)


def test_another_seed_needs_a_folder_of_its_own(capsys):
    assert main(["make-data", "corridor", "--seed", "7"]) == 2
    assert "--seed 7 makes other data than the shipped ones (seed 4): give --out FOLDER" in capsys.readouterr().err


@pytest.mark.parametrize("out", ["/proc/nope", "/dev/null/below"])
def test_a_folder_that_cannot_be_written_is_told_before_the_work(out, capsys):
    assert main(["make-data", "corridor", "--seed", "7", "--out", out]) == 2
    assert f"--out {out}" in capsys.readouterr().err


def test_a_file_in_the_way_is_told_before_the_work(tmp_path, capsys):
    (tmp_path / "taken").write_text("a file")
    assert main(["make-data", "corridor", "--out", str(tmp_path / "taken")]) == 2
    assert "taken is a file" in capsys.readouterr().err
