"""`stereo` on a rendered pair and on a real one: its JSON, its table, what it writes, and what it refuses."""

import json
from pathlib import Path

import cv2
import numpy as np
import pytest

from course_lib.cli import main
from course_lib.spherical_stereo.detection.boxes_file import read_stereo_boxes
from tests.spherical_stereo.stereo_scene import scene
from tests.spherical_stereo.vertical_pair import HEIGHT, WIDTH

REAL_BOXES = Path(__file__).parents[1] / "spherical_stereo" / "panorama_room_boxes.json"


@pytest.fixture(scope="module")
def pair(tmp_path_factory):
    """A folder with upper.png, lower.png and boxes.json of the rendered scene."""
    folder = tmp_path_factory.mktemp("pair")
    boards, upper, lower, upper_detections, lower_detections = scene()
    cv2.imwrite(str(folder / "upper.png"), upper)
    cv2.imwrite(str(folder / "lower.png"), lower)
    names = [f"{board.label} {i}" for i, board in enumerate(boards)]
    sides = {
        "upper": zip(upper_detections, names, strict=True),
        "lower": zip(lower_detections, names[::-1], strict=True),
    }
    content = {
        side: [{"label": d.label, "box": d.box, "name": name} for d, name in items] for side, items in sides.items()
    }
    content["upper"].append({"label": "television", "box": [10, 10, 30, 30], "name": "nobody's"})
    (folder / "boxes.json").write_text(json.dumps({"version": 1, "width": WIDTH, "height": HEIGHT, **content}))
    return folder


@pytest.fixture
def panorama_room():
    """The real vertical pair beside the project; tests that need it are skipped where it is absent."""
    folder = Path(__file__).parents[3] / "shared" / "real" / "panorama_room"
    if not folder.is_dir():
        pytest.skip(f"the real pair is not here ({folder}); it is not part of the repository")
    return folder


def arguments(folder, boxes="boxes.json", baseline="0.3", upper="upper.png", lower="lower.png"):
    words = ["stereo", "--upper", str(folder / upper), "--lower", str(folder / lower), f"--baseline={baseline}"]
    return words + (["--boxes", str(folder / boxes)] if boxes else [])


@pytest.mark.slow
def test_every_object_is_listed_with_both_distances(pair, tmp_path, capsys):
    assert main([*arguments(pair), "--json", "--out", str(tmp_path / "out")]) == 0
    summary = json.loads(capsys.readouterr().out)
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
    stored = json.loads((written / "stereo.json").read_text())
    assert stored["objects"] == summary["objects"]
    assert "numpy" in stored["versions"]
    assert len((written / "stereo.csv").read_text().splitlines()) == 9
    for name in ("disparity.png", "distances.png", "room.png"):
        assert cv2.imread(str(written / name)).size > 100_000


def test_the_table_names_every_object_and_why_one_has_no_partner(pair, capsys):
    assert main(arguments(pair)) == 0
    printed = capsys.readouterr().out
    assert "obey the epipolar constraint" in printed
    assert "8 objects seen in both images" in printed
    for i, board in enumerate(scene()[0]):
        assert f"{board.label} {i}" in printed
    assert "upper image only: class not in the other image" in printed
    assert main(arguments(pair, boxes=None)) == 0
    assert "give the objects' boxes" in capsys.readouterr().out


@pytest.fixture
def plain_pair(tmp_path):
    """A folder with two images of one colour, which have no features."""
    image = np.full((64, 128, 3), (90, 100, 110), np.uint8)
    cv2.imwrite(str(tmp_path / "upper.png"), image)
    cv2.imwrite(str(tmp_path / "lower.png"), image)
    return tmp_path


def test_images_without_features_are_told_in_words_and_are_valid_json_too(plain_pair, tmp_path, capsys):
    assert main(arguments(plain_pair, boxes=None)) == 0
    printed = capsys.readouterr().out
    assert "no features matched" in printed
    assert "nan" not in printed
    assert main([*arguments(plain_pair, boxes=None), "--json", "--out", str(tmp_path / "out")]) == 0
    summary = json.loads(capsys.readouterr().out, parse_constant=pytest.fail)
    assert summary["matches"] == 0
    assert summary["epipolar_percent"] is None
    assert json.loads((tmp_path / "out" / "stereo.json").read_text())["epipolar_percent"] is None


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"baseline": "-0.3"}, "--baseline must be a positive number"),
        ({"upper": "missing.png"}, "missing.png is missing"),
        ({"upper": "lower.png", "lower": "upper.png"}, "swapped"),
        ({"lower": "half.png"}, "one size"),
    ],
)
def test_bad_input_is_told_in_one_line(pair, change, message, capsys):
    cv2.imwrite(str(pair / "half.png"), scene()[2][::2, ::2])
    assert main(arguments(pair, **change)) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("error: ")
    assert captured.err.count("\n") == 1
    assert message in captured.err


def test_the_real_pair_is_matched_and_its_objects_find_themselves(panorama_room, capsys):
    words = ["--upper", str(panorama_room / "upper.png"), "--lower", str(panorama_room / "lower.png")]
    assert main(["stereo", *words, "--boxes", str(REAL_BOXES), "--baseline", "0.2", "--json"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["matches"] > 500
    assert summary["epipolar_percent"] > 90
    # The README beside the pair: flow between the two is vertical, |dx| 0.3 px, dy 12 px (medians).
    assert summary["median_disparity_px"] == pytest.approx(12, abs=1.5)
    assert summary["median_azimuth_difference_px"] < 0.6
    pairs = {(row["upper"], row["lower"]) for row in summary["objects"]}
    assert pairs == {(upper, lower) for _, upper, lower in read_stereo_boxes(REAL_BOXES).named_pairs()}
    assert (len(pairs), summary["unmatched"]) == (16, [])
    # No ground truth, but two ways of measuring: they agree where the boxes show the whole object.
    ratios = [r["box_centre"]["horizontal_range_m"] / r["disparity"]["horizontal_range_m"] for r in summary["objects"]]
    assert np.median(np.abs(np.array(ratios) - 1)) < 0.15
