"""`ambiguity`: a symmetric room is not sure of itself, an unlike object makes it so."""

from tests.beyond.look_alikes.look_alike_scene import PLANTED, SYMMETRIC


def matchers(told, semantic_map, folder, *words):
    semantic_map.save(folder / "map.json")
    common = ["ambiguity", "--map", folder / "map.json", "--out", folder / "out", "--step", 2, "--draws", 2]
    return told(*common, *words)["matchers"]


def test_what_is_confused_is_told_with_its_places(tmp_path, told):
    found = matchers(told, SYMMETRIC, tmp_path)
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


def test_one_unlike_object_makes_the_room_sure(tmp_path, told):
    symmetric, planted = (
        matchers(told, room, tmp_path, "--association", "consistent")["consistent"] for room in (SYMMETRIC, PLANTED)
    )
    assert planted["mean_confidence"] > symmetric["mean_confidence"] + 0.2
