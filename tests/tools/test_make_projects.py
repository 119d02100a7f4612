"""`make-data projects` refuses, before any work, what cannot be made, and tells what it wrote."""

import pytest

from course_lib.cli import main
from course_lib.experiments import project_rooms
from course_lib.simulation.data_folder import checksums


@pytest.fixture
def made(monkeypatch):
    """The folders of every call that would have photographed; nothing is."""
    calls = []

    def note(out, load_detector, work, processes, progress):
        calls.append((work, processes))
        (out / "rooms_practice.json").write_text("{}")
        (out / "rooms_hidden.json").write_text("{}")
        return {"practice": 32, "hidden": 96}

    monkeypatch.setattr(project_rooms, "make_project_rooms", note)
    return calls


def test_the_files_get_their_checksums(made, tmp_path, capsys):
    out, work = tmp_path / "out", tmp_path / "work"
    assert main(["make-data", "projects", "--out", str(out), "--work", str(work), "--processes", "1"]) == 0
    assert made == [(work, 1)]
    assert sorted(path.name for path in out.glob("[!.]*")) == ["SHA256SUMS", "rooms_hidden.json", "rooms_practice.json"]
    assert (out / "SHA256SUMS").read_text() == checksums(out, ["rooms_practice.json", "rooms_hidden.json"])
    assert "32 views (practice) and 96 views (hidden)" in capsys.readouterr().out


@pytest.mark.parametrize("option", ["--out", "--work"])
def test_a_file_in_place_of_a_folder_is_refused(made, option, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("tools.make_projects.FOLDER", tmp_path / "projects")
    (tmp_path / "file").write_text("")
    assert main(["make-data", "projects", option, str(tmp_path / "file")]) == 2
    assert f"{tmp_path / 'file'} is a file" in (told := capsys.readouterr().err)
    assert told.startswith(f"error: {option} ")
    assert made == []


@pytest.mark.parametrize("processes", ["0", "-2", "10000"])
def test_processes_that_cannot_be_are_refused(made, processes, tmp_path, capsys):
    assert main(["make-data", "projects", "--out", str(tmp_path / "out"), "--processes", processes]) == 2
    assert "--processes must be at " in capsys.readouterr().err
    assert made == []
