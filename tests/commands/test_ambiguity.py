"""`ambiguity`: a symmetric room is not sure of itself."""

import pytest

from courseware.cli import main
from tests.beyond.look_alikes.look_alike_scene import SYMMETRIC


def test_what_is_confused_is_told_with_its_places(tmp_path, told):
    SYMMETRIC.save(tmp_path / "map.json")
    words = ["ambiguity", "--map", tmp_path / "map.json", "--out", tmp_path / "out", "--step", 2, "--draws", 2]
    found = told(*words)["matchers"]
    assert set(found) == {"greedy", "consistent"}
    one = found["consistent"]
    assert one["mean_confidence"] < 0.7, "half a turn looks the same"
    assert one["sure_percent"] < 50
    first, second = one["confused"][0]["landmarks"]
    assert first < second
    assert one["confused"][0]["labels"][0] == one["confused"][0]["labels"][1]
    assert one["confused"][0]["places_m"] == [list(SYMMETRIC.positions[k]) for k in (first, second)]
    files = {path.name for path in (tmp_path / "out").glob("[!.]*")}
    assert files == {"ambiguity.json", "ambiguity_consistent.png", "ambiguity_greedy.png", "run.json"}


def test_help_says_where_it_writes(capsys):
    with pytest.raises(SystemExit):
        main(["ambiguity", "--help"])
    assert "(default: results/ambiguity)" in " ".join(capsys.readouterr().out.split())
