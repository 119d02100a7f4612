"""The list of a folder's pictures: what is wrong with it has a name, before anything is measured."""

import json

import pytest

from course_lib.cli import main
from course_lib.simulation.room.training_images import read_image_list

OBJECT = {
    "object": 0,
    "label": "chair",
    "visible_box": [1, 2, 3, 4],
    "unoccluded_box": [1, 2, 3, 4],
    "visible_fraction": 1.0,
}


def listed(*objects):
    return {"version": 1, "images": [{"file": "a.jpg", "width": 64, "height": 32, "objects": list(objects)}]}


def written(folder, content):
    text = content if isinstance(content, str) else json.dumps(content)
    (folder / "boxes.json").write_text(text)
    return folder


SPOILT = [
    ("[]", "has version None"),
    ('{"version": 2}', "has version 2"),
    ('{"version": 1}', "must have a list of images"),
    ("[" * 100_000, "levels"),
    ("{", "is not JSON"),
    ({"version": 1, "images": [5]}, "image 0"),
    ({"version": 1, "images": [{"file": "a.jpg"}]}, "image 0: a field is missing .*objects"),
    ({"version": 1, "images": [{"file": 5, "objects": []}]}, "file must be a name"),
    (listed(5), "image 0"),
    (listed(OBJECT, {}), "object"),
    (listed(OBJECT | {"visible_box": 5}), "image 0"),
    (listed(OBJECT | {"visible_box": [1, 2, 3]}), "a box of four numbers is expected"),
    (listed(OBJECT | {"visible_fraction": "much"}), "a number is expected, found much"),
]


def test_a_list_that_is_right_is_read(tmp_path):
    assert read_image_list(written(tmp_path, listed(OBJECT)))[0]["objects"] == [OBJECT]


@pytest.mark.parametrize(("content", "said"), SPOILT)
def test_a_list_that_is_not_names_the_image_and_the_field(tmp_path, content, said):
    with pytest.raises(ValueError, match=f"boxes.json.*{said}"):
        read_image_list(written(tmp_path, content))


def test_score_detector_says_so_before_it_scores_anything(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("tools.detector_evaluation.score_detector", lambda *given: 1 / 0)
    words = ["score-detector", "--images", str(written(tmp_path, listed(OBJECT | {"visible_box": 5})))]
    assert main(words) == 2
    assert "image 0: a field is missing or of the wrong kind" in capsys.readouterr().err
    written(tmp_path, listed(OBJECT))
    assert main(words) == 2
    assert "a.jpg is missing" in capsys.readouterr().err
