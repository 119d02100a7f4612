"""`make-data room` and `make-data training-rooms` refuse, before any work, what would lose data or cannot be made."""

import json
import os
import signal
import subprocess
import sys
import time
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
    monkeypatch.setattr("course_lib.commands.make_room.FOLDER", tmp_path / "data" / "room")
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


SMALL = """
import sys
from course_lib.cli import main
from course_lib.commands.interrupt_small import SMALL
SMALL["make-data_room"]()
sys.exit(main(["make-data", "room", "--seed", "7", "--out", sys.argv[1]]))
"""


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
@pytest.mark.parametrize(("sent", "code"), [(signal.SIGKILL, -signal.SIGKILL), (signal.SIGTERM, 143)])
def test_stopped_in_the_middle_it_leaves_nothing_that_the_next_run_does_not_clear(sent, code, tmp_path):
    place, temporary = tmp_path / "place", tmp_path / "temporary"
    for folder in (place, temporary):
        folder.mkdir()
    options = {"cwd": ROOT, "env": os.environ | {"TMPDIR": str(temporary)}, "stderr": subprocess.DEVNULL}
    command = [sys.executable, "-c", SMALL, str(place / "room")]
    process = subprocess.Popen(command, **options)
    while not list(place.rglob("*.jpg")):
        assert process.poll() is None
        time.sleep(0.01)
    process.send_signal(sent)
    assert process.wait() == code
    assert list(temporary.iterdir()) == [], "what it makes lies beside its place"
    assert bool(list(place.iterdir())) == (sent == signal.SIGKILL)
    assert not (place / "room").exists()
    assert subprocess.run(command, **options).returncode == 0
    assert [path.name for path in place.iterdir()] == ["room"]
    assert list(temporary.iterdir()) == []
