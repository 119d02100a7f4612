"""`make-data finale` refuses, before any work, what would lose data or cannot be made."""

import pytest

from course_lib.cli import main
from course_lib.simulation.room import finale_data


@pytest.fixture
def made(monkeypatch):
    """The arguments of every call that would have surveyed; nothing is."""
    calls = []

    def note(out, seed):
        calls.append((out, seed))
        return {"seed": seed, "objects": 13, "triangles": 60_000}

    monkeypatch.setattr(finale_data, "make_finale_data", note)
    return calls


def test_another_seed_does_not_replace_the_shipped_room(made, capsys):
    assert main(["make-data", "finale", "--seed", "5"]) == 2
    assert "give --out FOLDER, or data/finale would be replaced" in capsys.readouterr().err
    assert made == []


def test_another_seed_goes_where_out_says(made, tmp_path):
    assert main(["make-data", "finale", "--seed", "5", "--out", str(tmp_path / "room")]) == 0
    assert made == [(tmp_path / "room", 5)]


def test_the_shipped_seed_is_made_in_its_place(made, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("tools.make_finale.FOLDER", tmp_path / "finale")
    assert main(["make-data", "finale"]) == 0
    assert made == [(tmp_path / "finale", finale_data.SEED)]
    assert "13 objects, 60000 triangles" in capsys.readouterr().out


def test_a_file_in_place_of_the_folder_is_named_with_its_option(tmp_path, capsys):
    (tmp_path / "file").write_text("")
    assert main(["make-data", "finale", "--out", str(tmp_path / "file")]) == 2
    assert f"--out {tmp_path / 'file'} is a file" in capsys.readouterr().err
