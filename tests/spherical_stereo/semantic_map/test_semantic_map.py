"""The semantic map: what it holds, what it refuses, and that a file of it is whole or not there."""

import json
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from course_lib.spherical_stereo.semantic_map.semantic_map import Landmark, SemanticMap, SemanticMapError

WALLS = [[0.0, 0.0], [6.0, 0.0], [6.0, 5.5], [0.0, 5.5]]


def test_json_keeps_name_and_walls_and_nothing_changes_them(tmp_path):
    semantic_map = SemanticMap([Landmark("sofa", 1.0, 0.5, 210.0, 55.0)], walls=WALLS, name="部屋")
    with pytest.raises(ValueError, match="read-only"):
        semantic_map.positions[0, 0] = 9.0
    semantic_map.save(tmp_path / "map.json")
    read = SemanticMap.load(tmp_path / "map.json")
    assert (read.name, read.walls.tolist()) == ("部屋", WALLS)
    with pytest.raises(SemanticMapError, match=r"\.json or \.csv"):
        semantic_map.save(tmp_path / "map.txt")


def test_csv_as_a_spreadsheet_saves_it_is_read(tmp_path):
    text = '\ufeff"# semantic map, version 1",,,,\r\nlabel,x,y,hue,saturation\r\nsofa,1,0.5,210,55\r\n'
    (tmp_path / "map.csv").write_bytes(text.encode())
    assert repr(SemanticMap.load(tmp_path / "map.csv").landmarks) == repr((Landmark("sofa", 1, 0.5, 210, 55),))


values = st.floats(-1e6, 1e6)


@given(st.lists(st.tuples(values, values, st.one_of(st.just(math.nan), st.floats(0, 359.9)), st.floats(0, 100)),
                min_size=1, max_size=6))  # fmt: skip
def test_both_formats_keep_every_bit(tmp_path_factory, rows):
    folder = tmp_path_factory.mktemp("maps")
    semantic_map = SemanticMap([Landmark(f"class {i}", *row) for i, row in enumerate(rows)])
    for name in ("map.json", "map.csv"):
        semantic_map.save(folder / name)
        assert repr(SemanticMap.load(folder / name).landmarks) == repr(semantic_map.landmarks)  # of floats, every bit


@pytest.mark.parametrize("ending", [".csv", ".json"])
def test_a_saved_map_that_was_cut_anywhere_is_refused(tmp_path, ending):
    path = tmp_path / f"map{ending}"
    SemanticMap([Landmark("sofa", 1, 2, 3, 4), Landmark("chair", 3, 4, 50, 60)]).save(path)
    whole = path.read_bytes()
    for length in range(len(whole.rstrip())):
        path.write_bytes(whole[:length])
        with pytest.raises(SemanticMapError):
            SemanticMap.load(path)


SOFA = {"label": "sofa", "x": 1.0, "y": 0.5, "hue": 210.0, "saturation": 55.0}


def refused(path, text, says):
    path.write_text(text)
    with pytest.raises(SemanticMapError, match=f"{path.name}: .*{says}"):
        SemanticMap.load(path)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"landmarks": []}, "the map is empty"),
        ({"landmarks": [SOFA, SOFA | {"x": 1.005}]}, "written twice.* 5.0 mm apart"),
        ({"version": 2}, "version must be 1.*got 2"),
        ({"landmarks": {"sofa": 1}}, "a list of landmarks"),
        ({"walls": [[0, 0], [1, 0]]}, "at least three finite corners"),
        ({"walls": [[0, 0], [1, 0], "door"]}, "array"),
    ],
)
def test_a_json_file_that_is_no_map_is_named(tmp_path, change, says):
    refused(tmp_path / "map.json", json.dumps({"version": 1, "landmarks": [SOFA]} | change), says)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"x": "1.5"}, "x of this sofa must be a number; got '1.5'"),
        ({"y": True}, "y of this sofa must be a number; got True"),
        ({"saturation": 100.5}, r".*saturation in \[0, 100\]"),
        ({"saturation": -0.5}, r".*saturation in \[0, 100\]"),
        ({"hue": 360}, r".*hue in \[0, 360\)"),
        ({"hue": -1}, r".*hue in \[0, 360\)"),
        ({"label": " - "}, "a label is a text"),
    ],
)
def test_a_landmark_that_cannot_be_is_named(tmp_path, change, says):
    refused(tmp_path / "map.json", json.dumps({"version": 1, "landmarks": [SOFA | change]}), f"landmark 0: {says}")


HEAD = "# semantic map, version 1\nlabel,x,y,hue,saturation\n"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("label,x,y,hue,saturation\nsofa,1,2,3,4\n", "first line must be '# semantic map, version 1'"),
        (HEAD.replace("version 1", "version 7") + "sofa,1,2,3,4\n", "version must be 1.*7"),
        ("# semantic map, version 1\nlabel,x,y\nsofa,1,2\n", "second line must name the columns"),
        (HEAD + "sofa,,2,3,4\n", "landmark 0: lacks x"),
        (HEAD + "sofa,one,2,3,4\n", "x of this sofa must be a number; got 'one'"),
        (HEAD + "sofa,nan,2,3,4\n", "x and y must be finite"),
        (HEAD + "sofa,1,2,nan,4\n", "landmark 0: lacks a hue"),
    ],
)
def test_csv_that_is_no_map_is_named(tmp_path, text, says):
    refused(tmp_path / "map.csv", text, says)
