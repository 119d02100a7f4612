"""`ambiguity`: a symmetric room is not sure of itself, an unlike object makes it so; bad words are told at once."""

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
    assert sorted(path.name for path in out.glob("[!.]*")) == [
        "ambiguity.json",
        "ambiguity_consistent.png",
        "ambiguity_greedy.png",
        "run.json",
    ]


def test_one_unlike_object_makes_the_room_sure(map_file, tmp_path, capsys):
    words = ["--out", str(tmp_path / "out"), "--association", "consistent"]
    symmetric = told(capsys, "--map", map_file(SYMMETRIC), *words)[1]["consistent"]
    planted = told(capsys, "--map", map_file(PLANTED), *words)[1]["consistent"]
    assert planted["mean_confidence"] > symmetric["mean_confidence"] + 0.2


def test_the_text_names_the_objects(map_file, tmp_path, capsys):
    words = ["--step", "2", "--draws", "1", "--out", str(tmp_path / "out"), "--association", "greedy"]
    assert main(["ambiguity", "--map", map_file(SYMMETRIC), *words]) == 0
    text = capsys.readouterr().out
    assert "free places" in text
    assert "confused in" in text


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--association", "best"], "association must be one of greedy, hungarian, consistent"),
        (["--step", "0"], "--step must be a positive number of metres"),
        (["--step", "nan"], "--step must be a positive number of metres"),
        (["--step", "500"], "give a smaller --step"),
        (["--draws", "0"], "--draws must be at least 1; got 0"),
        (["--seed", "-1"], "--seed must be 0 or more"),
    ],
)
def test_bad_words_are_told(map_file, tmp_path, capsys, words, said):
    out = tmp_path / "out"
    assert main(["ambiguity", "--map", map_file(SYMMETRIC), "--out", str(out), *words]) == 2
    assert said in capsys.readouterr().err
    assert not out.exists()
