"""`ambiguity`: a symmetric room is not sure of itself, an unlike object makes it so."""

import json

import pytest

from course_lib.cli import main
from tests.beyond.look_alikes.look_alike_scene import PLANTED, SYMMETRIC


@pytest.fixture
def map_file(tmp_path):
    def write(semantic_map):
        path = tmp_path / "map.json"
        semantic_map.save(path)
        return str(path)

    return write


def told(capsys, *words):
    code = main(["ambiguity", "--step", "2", "--draws", "2", *words, "--json"])
    return code, json.loads(capsys.readouterr().out)["matchers"]


def test_what_is_confused_is_told_with_its_places(map_file, tmp_path, capsys):
    out = tmp_path / "out"
    code, matchers = told(capsys, "--map", map_file(SYMMETRIC), "--out", str(out))
    assert code == 0
    assert set(matchers) == {"greedy", "consistent"}
    one = matchers["consistent"]
    assert one["mean_confidence"] < 0.7, "half a turn looks the same"
    assert one["sure_percent"] < 50
    first, second = one["confused"][0]["landmarks"]
    a, b = one["confused"][0]["places_m"]
    assert first < second
    assert one["confused"][0]["labels"][0] == one["confused"][0]["labels"][1]
    assert [list(SYMMETRIC.positions[first]), list(SYMMETRIC.positions[second])] == [a, b]
    files = {path.name for path in out.glob("[!.]*")}
    assert files == {"ambiguity.json", "ambiguity_consistent.png", "ambiguity_greedy.png", "run.json"}


def test_one_unlike_object_makes_the_room_sure(map_file, tmp_path, capsys):
    words = ["--out", str(tmp_path / "out"), "--association", "consistent"]
    symmetric = told(capsys, "--map", map_file(SYMMETRIC), *words)[1]["consistent"]
    planted = told(capsys, "--map", map_file(PLANTED), *words)[1]["consistent"]
    assert planted["mean_confidence"] > symmetric["mean_confidence"] + 0.2
