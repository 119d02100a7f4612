"""What tests of several commands share."""

import csv
import json

import pytest

from course_lib.depth_mcl.sequence import read_sequence, write_sequence
from courseware.cli import main


@pytest.fixture
def told(capsys):
    """Call a command with --json, and return what it printed."""

    def call(*words):
        capsys.readouterr()
        assert main([*map(str, words), "--json"]) == 0
        return json.loads(capsys.readouterr().out, parse_constant=pytest.fail)

    return call


@pytest.fixture
def printed(capsys):
    """Call a command, and return what it printed."""

    def call(*words):
        capsys.readouterr()
        assert main([*map(str, words)]) == 0
        return capsys.readouterr().out

    return call


@pytest.fixture
def recorded(corridor_folder, tmp_path):
    """Write some frames of a shipped recording of the corridor to a folder below tmp_path, and return it."""

    def write(name, frames, to, change=lambda depths: None, timed=False):
        whole = read_sequence(corridor_folder / name)
        depths = [whole.depth(k) for k in frames]
        change(depths)
        poses, times = whole.camera_to_world[list(frames)], whole.times[list(frames)] if timed else None
        write_sequence(tmp_path / to, whole.intrinsics, list(frames), depths, poses, times, up="z")
        return tmp_path / to

    return write


def rows_of(path):
    """Rows of a CSV file."""
    return list(csv.DictReader(path.open()))
