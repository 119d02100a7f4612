"""`stereo` on a rendered pair and on a real one: its JSON, its table, and what it writes."""

import json
from pathlib import Path

import cv2
import numpy as np
import pytest

from course_lib.spherical_stereo.drawn_boxes import read_stereo_boxes
from tests.spherical_stereo.stereo_scene import HEIGHT, WIDTH, scene

REAL_PAIR = Path(__file__).parents[3] / "shared" / "real" / "panorama_room"
REAL_BOXES = Path(__file__).parents[1] / "spherical_stereo" / "panorama_room_boxes.json"


@pytest.fixture(scope="module")
def pair(tmp_path_factory):
    """A folder with upper.png, lower.png and boxes.json of the rendered scene."""
    folder = tmp_path_factory.mktemp("pair")
    boards, upper, lower, upper_detections, lower_detections = scene()
    cv2.imwrite(str(folder / "upper.png"), upper)
    cv2.imwrite(str(folder / "lower.png"), lower)
    names = [f"{board.label} {i}" for i, board in enumerate(boards)]
    content = {
        side: [{"label": d.label, "box": d.box, "name": name} for d, name in zip(seen, ordered, strict=True)]
        for side, seen, ordered in (("upper", upper_detections, names), ("lower", lower_detections, names[::-1]))
    }
    content["upper"].append({"label": "television", "box": [10, 10, 30, 30], "name": "nobody's"})
    (folder / "boxes.json").write_text(json.dumps({"version": 1, "width": WIDTH, "height": HEIGHT, **content}))
    return folder


def arguments(folder, boxes="boxes.json", baseline=0.3):
    words = ["stereo", "--upper", folder / "upper.png", "--lower", folder / "lower.png", "--baseline", baseline]
    return words + (["--boxes", folder / boxes] if boxes else [])


@pytest.mark.slow
def test_every_object_is_listed_with_both_distances(pair, tmp_path, told):
    summary = told(*arguments(pair), "--out", tmp_path / "out")
    assert summary["matches"] > 100
    assert summary["epipolar_percent"] > 90
    assert summary["baseline_m"] == 0.3
    boards = scene()[0]
    assert [row["name"] for row in summary["objects"]] == [f"{board.label} {i}" for i, board in enumerate(boards)]
    for row, board in zip(summary["objects"], boards, strict=True):
        for way in ("box_centre", "disparity"):
            assert row[way]["outcome"] == "ok"
            assert row[way]["horizontal_range_m"] == pytest.approx(board.range, rel=0.25)
            assert row[way]["distance_m"] >= row[way]["horizontal_range_m"]
            assert row[way]["horizontal_sigma_m"] > 0
    nobodys = {"name": "nobody's", "label": "television", "side": "upper", "index": 8}
    assert summary["unmatched"] == [nobodys | {"reason": "class not in the other image"}]
    written = tmp_path / "out"
    assert json.loads((written / "stereo.json").read_text())["objects"] == summary["objects"]
    assert len((written / "stereo.csv").read_text().splitlines()) == 9
    for name in ("disparity.png", "distances.png", "room.png"):
        assert cv2.imread(str(written / name)).size > 100_000


def test_the_table_names_every_object_and_why_one_has_no_partner(pair, printed):
    text = printed(*arguments(pair))
    assert "obey the epipolar constraint" in text
    assert "8 objects seen in both images" in text
    for i, board in enumerate(scene()[0]):
        assert f"{board.label} {i}" in text
    assert "upper image only: class not in the other image" in text
    assert "give the objects' boxes" in printed(*arguments(pair, boxes=None))


def test_images_without_features_are_told_in_words_and_are_valid_json_too(tmp_path, told, printed):
    for side in ("upper", "lower"):
        cv2.imwrite(str(tmp_path / f"{side}.png"), np.full((64, 128, 3), (90, 100, 110), np.uint8))
    text = printed(*arguments(tmp_path, boxes=None))
    assert "no features matched" in text
    summary = told(*arguments(tmp_path, boxes=None), "--out", tmp_path / "out")
    assert summary["matches"] == 0
    assert summary["epipolar_percent"] is None
    assert json.loads((tmp_path / "out" / "stereo.json").read_text())["epipolar_percent"] is None


@pytest.mark.skipif(not REAL_PAIR.is_dir(), reason="the real pair is not part of the repository")
def test_the_real_pair_is_matched_and_its_objects_find_themselves(told):
    summary = told(*arguments(REAL_PAIR, REAL_BOXES, baseline=0.2))
    assert summary["matches"] > 500
    assert summary["epipolar_percent"] > 90
    # The README beside the pair: flow between the two is vertical, |dx| 0.3 px, dy 12 px (medians).
    assert summary["median_disparity_px"] == pytest.approx(12, abs=1.5)
    assert summary["median_azimuth_difference_px"] < 0.6
    pairs = {(row["upper"], row["lower"]) for row in summary["objects"]}
    boxes = read_stereo_boxes(REAL_BOXES)
    lower = [one.name for one in boxes.lower]
    assert pairs == {(i, lower.index(one.name)) for i, one in enumerate(boxes.upper) if one.name in lower}
    assert (len(pairs), summary["unmatched"]) == (16, [])
    # No ground truth, but two ways of measuring: they agree where the boxes show the whole object.
    ratios = [r["box_centre"]["horizontal_range_m"] / r["disparity"]["horizontal_range_m"] for r in summary["objects"]]
    assert np.median(np.abs(np.array(ratios) - 1)) < 0.15
