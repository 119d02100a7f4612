"""The tools that make data refuse, before any work, what would lose the shipped data or cannot be made."""

import importlib
import json

import pytest

from course_lib.experiments import project_rooms
from course_lib.simulation.data_folder import checksums

# Tool -> what makes the data, the shipped seed, what it returns.
MADE = {
    "corridor": ("tools.corridor_data", "make_corridor_data", 4, {"measured": {}}),
    "room": ("course_lib.simulation.room.data", "make_room_data", 4, {"pairs": 40, "objects": 14}),
    "finale": (
        "course_lib.simulation.room.finale_data",
        "make_finale_data",
        10_001,
        {"objects": 13, "triangles": 60_000},
    ),
}


@pytest.fixture
def calls(monkeypatch):
    """The arguments of every call that would have worked for minutes; nothing is made."""
    noted = []
    for module, function, _, summary in MADE.values():

        def note(out, seed, summary=summary, **_):
            noted.append((out, seed))
            return summary

        monkeypatch.setattr(importlib.import_module(module), function, note)
    return noted


@pytest.mark.parametrize("name", MADE)
def test_another_seed_goes_where_out_says_and_never_in_the_place_of_the_shipped_data(
    name, calls, tmp_path, monkeypatch, run_tool, capsys
):
    shipped = MADE[name][2]
    assert run_tool(f"make_{name}", "--seed", "7") == 2
    assert f"(seed {shipped}): give --out FOLDER, or data/{name} would be replaced" in capsys.readouterr().err
    assert run_tool(f"make_{name}", "--seed", "-1", "--out", tmp_path / "out") == 2
    assert calls == []
    assert run_tool(f"make_{name}", "--seed", "7", "--out", tmp_path / "out") == 0
    monkeypatch.setattr("tools.shipped_data.DATA", tmp_path)
    assert run_tool(f"make_{name}") == 0
    assert calls == [(tmp_path / "out", 7), (tmp_path / name, shipped)]


@pytest.mark.parametrize(
    ("name", "option"),
    [*((f"make_{name}", "--out") for name in MADE), ("make_training_rooms", "--out"), ("make_projects", "--work")],
)
def test_a_file_in_place_of_the_folder_is_named_with_its_option(name, option, calls, tmp_path, run_tool, capsys):
    (tmp_path / "file").write_text("")
    assert run_tool(name, option, tmp_path / "file") == 2
    assert f"error: {option} {tmp_path / 'file'} is a file" in capsys.readouterr().err
    assert calls == []


@pytest.mark.parametrize(
    ("option", "value", "least"), [("--rooms", "0", 1), ("--images-per-room", "0", 1), ("--first-room", "-1", 0)]
)
def test_numbers_of_training_rooms_are_named_with_their_option(option, value, least, tmp_path, run_tool, capsys):
    assert run_tool("make_training_rooms", "--out", tmp_path / "rooms", option, value) == 2
    assert f"{option} must be at least {least}; got {value}" in capsys.readouterr().err
    assert not (tmp_path / "rooms").exists()


def test_training_rooms_that_are_all_there_are_counted(tmp_path, run_tool, capsys):
    images = [{"file": f"000007_{k}.jpg", "room_seed": 7, "objects": []} for k in range(3)]
    (tmp_path / "boxes.json").write_text(json.dumps({"version": 1, "images": images}))
    assert run_tool("make_training_rooms", "--out", tmp_path, "--first-room", "7", "--rooms", "1") == 0
    assert "3 pictures of 1 rooms" in capsys.readouterr().out


def test_the_files_of_the_projects_get_their_checksums(tmp_path, monkeypatch, run_tool, capsys):
    def note(out, load_detector, work, processes, progress):
        (out / "rooms_practice.json").write_text("{}")
        (out / "rooms_hidden.json").write_text("{}")
        return {"practice": 32, "hidden": 96}

    monkeypatch.setattr(project_rooms, "make_project_rooms", note)
    out = tmp_path / "out"
    assert run_tool("make_projects", "--out", out, "--work", tmp_path / "work", "--processes", "1") == 0
    assert sorted(path.name for path in out.glob("[!.]*")) == ["SHA256SUMS", "rooms_hidden.json", "rooms_practice.json"]
    assert (out / "SHA256SUMS").read_text() == checksums(out, ["rooms_practice.json", "rooms_hidden.json"])
    assert "32 views (practice) and 96 views (hidden)" in capsys.readouterr().out
