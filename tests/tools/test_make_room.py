"""`make-data room` and `make-data training-rooms` refuse, before any work, what would lose data or cannot be made."""

import json
from pathlib import Path

import pytest

from course_lib.cli import main
from course_lib.simulation.room import data as room_data
from course_lib.simulation.room import training_images as room_images

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def made(monkeypatch):
    """The arguments of every call that would have photographed; nothing is."""
    calls = []

    def note(out, *rest, **_):
        calls.append((out, *rest))
        return {"pairs": 40, "objects": 14}

    monkeypatch.setattr(room_data, "make_room_data", note)
    return calls


def test_another_seed_does_not_replace_the_shipped_room(made, capsys):
    assert main(["make-data", "room", "--seed", "5"]) == 2
    assert "give --out FOLDER, or data/room would be replaced" in capsys.readouterr().err
    assert made == []


def test_another_seed_goes_where_out_says(made, tmp_path):
    assert main(["make-data", "room", "--seed", "5", "--out", str(tmp_path / "room")]) == 0
    assert made == [(tmp_path / "room", 5)]


def test_the_shipped_seed_is_made_in_its_place(made, tmp_path, monkeypatch):
    monkeypatch.setattr("tools.make_room.FOLDER", tmp_path / "data" / "room")
    assert main(["make-data", "room"]) == 0
    assert made == [(tmp_path / "data" / "room", 4)]


@pytest.mark.parametrize("command", ["room", "training-rooms"])
def test_a_file_in_place_of_the_folder_is_named_with_its_option(command, tmp_path, capsys):
    (tmp_path / "file").write_text("")
    assert main(["make-data", command, "--out", str(tmp_path / "file")]) == 2
    assert f"--out {tmp_path / 'file'} is a file" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("option", "value", "least"), [("--rooms", "0", 1), ("--images-per-room", "0", 1), ("--first-room", "-1", 0)]
)
def test_numbers_of_training_rooms_are_named_with_their_option(option, value, least, tmp_path, capsys):
    assert main(["make-data", "training-rooms", "--out", str(tmp_path / "rooms"), option, value]) == 2
    assert f"{option} must be at least {least}; got {value}" in capsys.readouterr().err
    assert not (tmp_path / "rooms").exists()


def test_training_rooms_that_are_all_there_are_counted(tmp_path, capsys):
    images = [{"file": f"000007_{k}.jpg", "room_seed": 7, "objects": []} for k in range(3)]
    (tmp_path / room_images.BOXES_FILE).write_text(json.dumps({"version": 1, "images": images}))
    assert main(["make-data", "training-rooms", "--out", str(tmp_path), "--first-room", "7", "--rooms", "1"]) == 0
    assert "3 pictures of 1 rooms" in capsys.readouterr().out
