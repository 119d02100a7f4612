"""The semantic map: what it holds, what it refuses, and that a file of it is whole or not there."""

import json
import math
import os

import numpy as np
import pytest
from course_lib.writing import WriteError
from hypothesis import given
from hypothesis import strategies as st

from course_lib.spherical_stereo.semantic_map.semantic_map import Landmark, SemanticMap, SemanticMapError

WALLS = [[0.0, 0.0], [6.0, 0.0], [6.0, 5.5], [0.0, 5.5]]


def a_map(**changes):
    landmarks = [
        Landmark("sofa", 1.0, 0.5, 210.0, 55.0),
        Landmark("sofa", 4.0, 0.5, 212.0, 54.0),
        Landmark("television", 5.5, 3.0, math.nan, 4.0),
    ]
    return SemanticMap(landmarks, **{"walls": WALLS, "name": "部屋", **changes})


def as_json(**changes):
    """The JSON content of a good map with one thing changed; the value ... leaves a key out."""
    rows = [{"label": "sofa", "x": 1.0, "y": 0.5, "hue": 210.0, "saturation": 55.0}]
    content = {"version": 1, "landmarks": rows, **changes}
    return {name: value for name, value in content.items() if value is not ...}


def landmark(**changes):
    return as_json(
        landmarks=[
            {
                name: value
                for name, value in {
                    "label": "sofa", "x": 1.0, "y": 0.5, "hue": 210.0, "saturation": 55.0, **changes,
                }.items()
                if value is not ...
            }
        ]
    )  # fmt: skip


def same(first, second):
    return (
        first.labels == second.labels
        and np.array_equal(first.positions, second.positions)
        and np.array_equal(first.hues, second.hues, equal_nan=True)
        and np.array_equal(first.saturations, second.saturations)
    )


def test_the_centroid_is_the_mean_of_all_objects():
    assert a_map().centroid == pytest.approx([3.5, 4.0 / 3])


def test_a_map_cannot_be_changed_by_writing_to_its_arrays():
    with pytest.raises(ValueError, match="read-only"):
        a_map().positions[0, 0] = 9.0


def test_a_couch_is_kept_as_a_sofa():
    assert Landmark("Couch", 0, 0, 10, 50).label == "sofa"


def test_json_gives_back_the_whole_map(tmp_path):
    a_map().save(tmp_path / "map.json")
    read = SemanticMap.load(tmp_path / "map.json")
    assert same(read, a_map())
    assert read.name == "部屋"
    assert read.walls.tolist() == WALLS


def test_csv_gives_back_every_landmark(tmp_path):
    a_map().save(tmp_path / "map.csv")
    assert same(SemanticMap.load(tmp_path / "map.csv"), a_map())


def test_grey_is_null_in_json_and_empty_in_csv(tmp_path):
    a_map().save(tmp_path / "map.json")
    a_map().save(tmp_path / "map.csv")
    assert json.loads((tmp_path / "map.json").read_text("utf-8"))["landmarks"][2]["hue"] is None
    assert (tmp_path / "map.csv").read_text().splitlines()[-1] == "television,5.5,3.0,,4.0"


def test_csv_as_a_spreadsheet_saves_it_is_read(tmp_path):
    text = '\ufeff"# semantic map, version 1",,,,\r\nlabel,x,y,hue,saturation\r\nsofa,1,0.5,210,55\r\n'
    (tmp_path / "map.csv").write_bytes(text.encode())
    assert same(SemanticMap.load(tmp_path / "map.csv"), SemanticMap([Landmark("sofa", 1, 0.5, 210, 55)]))


values = st.floats(-1e6, 1e6)


@given(st.lists(st.tuples(values, values, st.one_of(st.just(math.nan), st.floats(0, 359.9)), st.floats(0, 100)),
                min_size=1, max_size=6))  # fmt: skip
def test_both_formats_keep_every_bit(tmp_path_factory, rows):
    folder = tmp_path_factory.mktemp("maps")
    semantic_map = SemanticMap([Landmark(f"class {i}", *row) for i, row in enumerate(rows)])
    for name in ("map.json", "map.csv"):
        semantic_map.save(folder / name)
        assert same(SemanticMap.load(folder / name), semantic_map)


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (as_json(landmarks=[]), "the map is empty"),
        (as_json(landmarks=as_json()["landmarks"] * 2), "written twice.*remove one"),
        (as_json(version=2), "version must be 1.*got 2"),
        (as_json(version=...), "version must be 1.*got none"),
        (as_json(version=True), "version must be 1.*got True"),
        (as_json(landmarks=...), "landmarks must be a list.*nothing"),
        (as_json(landmarks={"sofa": 1}), "landmarks must be a list.*an object"),
        (as_json(landmarks=["sofa"]), "landmark 0 must be an object"),
        (as_json(name=3), "name must be a text"),
        (as_json(walls=[[0, 0], [1, 0]]), "at least three finite corners"),
        (as_json(walls=[[0, 0], [1, 0], "door"]), "at least three finite corners"),
        ([1, 2], "must hold a JSON object"),
        (landmark(x=...), "landmark 0 lacks x"),
        (landmark(hue=..., label=...), "landmark 0 lacks label, hue"),
        (landmark(x="1.5"), "x of this sofa must be a number; got '1.5'"),
        (landmark(y=True), "y of this sofa must be a number; got True"),
        (landmark(x=None), "x of this sofa must be a number; got None"),
        (landmark(saturation=-1), r"saturation of this sofa must lie in \[0, 100\].*-1"),
        (landmark(saturation=100.5), r"saturation of this sofa must lie in \[0, 100\]"),
        (landmark(hue=360), r"hue of this sofa must lie in \[0, 360\)"),
        (landmark(hue=-10), r"hue of this sofa must lie in \[0, 360\)"),
        (landmark(label=""), "label must be the name of a class"),
        (landmark(label=7), "label must be the name of a class"),
    ],
)
def test_a_file_that_is_no_map_is_named(tmp_path, content, says):
    path = tmp_path / "map.json"
    path.write_text(json.dumps(content))
    with pytest.raises(SemanticMapError, match=f"map.json: .*{says}"):
        SemanticMap.load(path)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("{", "is not JSON"),
        ("", "is not JSON"),
        (json.dumps(landmark(x=math.nan)), "NaN, which is no JSON number"),
        (json.dumps(landmark(y=math.inf)), "Infinity, which is no JSON number"),
        (json.dumps(landmark(x=0.5)).replace("0.5", "1e999"), "the number 1e999, which is too large"),
    ],
)
def test_json_that_is_broken_is_named(tmp_path, text, says):
    (tmp_path / "map.json").write_text(text)
    with pytest.raises(SemanticMapError, match=says):
        SemanticMap.load(tmp_path / "map.json")


HEAD = "# semantic map, version 1\nlabel,x,y,hue,saturation\n"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (HEAD, "the map is empty"),
        ("label,x,y,hue,saturation\nsofa,1,2,3,4\n", "first line must be '# semantic map, version 1'"),
        (HEAD.replace("version 1", "version 7") + "sofa,1,2,3,4\n", "version must be 1.*7"),
        ("# semantic map, version 1\nlabel,x,y\nsofa,1,2\n", r"missing: \['hue', 'saturation'\]"),
        (HEAD + "sofa,1,2\n", "landmark 0 lacks hue, saturation"),
        (HEAD + "sofa,,2,3,4\n", "landmark 0 lacks x"),
        (HEAD + "chair,1,2,3,4\nsofa,1,5,2,3,4\n", "line 4 has 1 values too many for 5 columns"),
        (HEAD + "sofa,1,2,3,4,\n", "line 3 has 1 values too many"),
        (HEAD + "sofa,one,2,3,4\n", "x of this sofa must be a number; got 'one'"),
        (HEAD + "sofa,nan,2,3,4\n", "must be finite"),
        (HEAD + "sofa,1,2,nan,4\n", "hue is NaN"),
        (HEAD + "sofa,1,2,3,-4\n", "saturation"),
        (HEAD + "sofa,1,2,3,4\nsofa,1.005,2,9,9\n", "5.0 mm apart"),
    ],
)
def test_csv_that_is_no_map_is_named(tmp_path, text, says):
    (tmp_path / "map.csv").write_text(text)
    with pytest.raises(SemanticMapError, match=says):
        SemanticMap.load(tmp_path / "map.csv")


@pytest.mark.parametrize("ending", [".csv", ".json"])
def test_a_saved_map_that_was_cut_anywhere_is_refused(tmp_path, ending):
    path = tmp_path / f"map{ending}"
    SemanticMap([Landmark("sofa", 1, 2, 3, 4), Landmark("chair", 3, 4, 50, 60)]).save(path)
    whole = path.read_bytes()
    for length in range(len(whole.rstrip())):
        path.write_bytes(whole[:length])
        with pytest.raises(SemanticMapError):
            SemanticMap.load(path)


def test_a_file_that_cannot_be_read_is_named(tmp_path):
    with pytest.raises(SemanticMapError, match="is missing"):
        SemanticMap.load(tmp_path / "map.json")
    with pytest.raises(SemanticMapError, match=r"\.json or a \.csv"):
        SemanticMap.load(tmp_path / "map.yaml")
    (tmp_path / "folder.json").mkdir()
    with pytest.raises(SemanticMapError, match="is a folder"):
        SemanticMap.load(tmp_path / "folder.json")
    (tmp_path / "binary.json").write_bytes(b"\xff\xfe\x00\x80")
    with pytest.raises(SemanticMapError, match="not UTF-8 text"):
        SemanticMap.load(tmp_path / "binary.json")


@pytest.mark.parametrize("x", [math.nan, math.inf])
def test_a_landmark_at_no_place_is_refused(x):
    with pytest.raises(SemanticMapError, match="must be finite"):
        Landmark("sofa", x, 0.0, 10.0, 10.0)


def test_objects_of_two_classes_may_share_a_place():
    assert len(SemanticMap([Landmark("table", 1, 1, 30, 40), Landmark("potted plant", 1, 1, 110, 60)])) == 2


def test_two_sofas_two_centimetres_apart_are_two():
    assert len(SemanticMap([Landmark("sofa", 1, 1, 30, 40), Landmark("sofa", 1.02, 1, 30, 40)])) == 2


def test_a_failed_save_leaves_the_old_map_whole_and_nothing_beside_it(tmp_path, monkeypatch):
    path = tmp_path / "map.json"
    a_map().save(path)
    before = path.read_bytes()

    def disk_full(*_):
        raise OSError("no space left")

    monkeypatch.setattr(os, "replace", disk_full)
    with pytest.raises(WriteError, match="no space left"):
        a_map(name="other").save(path)
    assert path.read_bytes() == before
    assert [each.name for each in tmp_path.iterdir()] == ["map.json"]


def test_saving_where_nothing_can_be_saved_is_named(tmp_path):
    with pytest.raises(WriteError, match="cannot be written"):
        a_map().save(tmp_path / "missing" / "map.json")
    with pytest.raises(SemanticMapError, match=r"\.json or \.csv"):
        a_map().save(tmp_path / "map.txt")


@pytest.mark.parametrize("label", ["___", " - ", "\u2028"])
def test_a_label_without_a_letter_is_refused(label):
    with pytest.raises(SemanticMapError, match="label must be the name of a class"):
        Landmark(label, 0.0, 0.0, 10.0, 50.0)
