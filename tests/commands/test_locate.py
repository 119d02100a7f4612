"""`locate` on a rendered pair: the pose of the boards' map, with its sigmas, pairs and figure, and what it refuses."""

import json
import math

import cv2
import numpy as np
import pytest

from course_lib.cli import main
from course_lib.spherical_stereo.detection.detector import YoloDetector
from tests.spherical_stereo.stereo_scene import TRUE_POSE, mapped_scene
from tests.spherical_stereo.vertical_pair import BASELINE


@pytest.fixture(scope="module")
def pair(tmp_path_factory):
    """A folder with upper.png, lower.png, boxes.json and map.json of the rendered scene."""
    folder = tmp_path_factory.mktemp("pair")
    upper, lower, semantic_map = mapped_scene()
    content = {"version": 1, "width": upper.width, "height": upper.height}
    for side, view in (("upper", upper), ("lower", lower)):
        cv2.imwrite(str(folder / f"{side}.png"), view.image)
        content[side] = [{"label": d.label, "box": d.box} for d in view.detections]
    (folder / "boxes.json").write_text(json.dumps(content))
    semantic_map.save(folder / "map.json")
    return folder


def words(folder, *more, boxes=True, baseline=BASELINE, **other):
    files = {name: other.get(name, f"{name}.{ending}") for name, ending in
             (("upper", "png"), ("lower", "png"), ("map", "json"))}  # fmt: skip
    options = [word for name, file in files.items() for word in (f"--{name}", str(folder / file))]
    options += ["--boxes", str(folder / "boxes.json")] if boxes else []
    return ["locate", *options, f"--baseline={baseline}", *more]


def answer(capsys, *words):
    assert main([*words, "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def test_the_pose_comes_with_its_sigmas_pairs_and_residuals(pair, capsys):
    found = answer(capsys, *words(pair))
    assert (found["status"], found["reason"]) == ("ok", None)
    assert math.hypot(found["x_m"] - TRUE_POSE.x, found["y_m"] - TRUE_POSE.y) < 0.15
    assert found["heading_deg"] == pytest.approx(math.degrees(TRUE_POSE.theta), abs=2)
    assert found["sigma_x_m"] == pytest.approx(found["covariance"][0][0] ** 0.5)
    assert math.radians(found["sigma_heading_deg"]) == pytest.approx(found["covariance"][2][2] ** 0.5)
    residuals = [row["residual_m"] for row in found["objects"]]
    assert found["rms_residual_m"] == pytest.approx(np.sqrt(np.mean(np.square(residuals))))
    assert found["rms_residual_m"] < 2 * found["expected_rms_residual_m"]
    ranges = {(row["label"], row["landmark"]): row["range_m"] for row in found["objects"]}
    expected = {("sofa", 0): 1.6, ("sofa", 1): 2.2, ("chair", 2): 1.4, ("television", 3): 2.0, ("potted plant", 4): 1.8}
    assert ranges == {key: pytest.approx(value, rel=0.1) for key, value in expected.items()}


def test_the_consistent_matcher_says_how_sure_it_is_and_which_poses_there_are(pair, capsys):
    found = answer(capsys, *words(pair, "--association", "consistent"))
    assert found["status"] == "ok"
    assert math.hypot(found["x_m"] - TRUE_POSE.x, found["y_m"] - TRUE_POSE.y) < 0.15
    assert found["confidence"] > 0.8
    assert found["alternatives"][0][:2] == [found["x_m"], found["y_m"]]
    assert found["rms_residual_m"] < 2 * found["expected_rms_residual_m"]
    assert main(words(pair, "--association", "consistent")) == 0
    assert f"confidence {found['confidence']:.2f}" in capsys.readouterr().out
    assert answer(capsys, *words(pair))["confidence"] is None


@pytest.mark.slow
def test_the_table_and_the_files_say_the_same(pair, tmp_path, capsys):
    out = tmp_path / "out"
    assert main(words(pair, "--out", str(out))) == 0
    printed = capsys.readouterr().out
    stored = json.loads((out / "locate.json").read_text())
    assert f"pose: x {stored['x_m']:.2f} ± {stored['sigma_x_m']:.2f} m" in printed
    assert "5 objects above, 5 below, 5 seen in both" in printed
    assert printed.count("\n 1 ") == printed.count("\n 5 ") == 1
    assert len((out / "locate.csv").read_text().splitlines()) == 6
    assert min(cv2.imread(str(out / "locate.png")).shape[:2]) > 1000
    assert "Written to" in printed
    assert "locate.html (to be turned in a browser)" in printed
    assert "<title>On the map</title>" in (out / "locate.html").read_text()


@pytest.mark.slow
def test_no_pose_is_an_answer_and_is_drawn_too(pair, tmp_path, capsys):
    out = tmp_path / "out"
    assert main(words(pair, "--out", str(out), baseline=1.0)) == 0
    printed = capsys.readouterr().out
    assert "no pose, implausible: the 5 objects miss their landmarks by" in printed
    stored = json.loads((out / "locate.json").read_text())
    assert (stored["status"], stored["x_m"], len(stored["rejected_pose"])) == ("unable", None, 3)
    assert (out / "locate.png").is_file()
    assert "<title>No pose: implausible</title>" in (out / "locate.html").read_text()
    assert answer(capsys, *words(pair, "--paper", baseline=1.0))["status"] == "ok"


class Boxes:
    """A detector that knows the scene."""

    labels = ("chair", "sofa")

    def detect(self, image):
        upper, lower, _ = mapped_scene()
        return next(view.detections for view in (upper, lower) if np.array_equal(view.image, image))


def test_without_boxes_a_detector_finds_the_objects_and_the_course_s_says_what_it_knows(pair, monkeypatch, capsys):
    monkeypatch.setattr(YoloDetector, "load", lambda folder, **options: Boxes())
    assert main(words(pair, boxes=False)) == 0
    printed = capsys.readouterr().out
    assert "It knows 2 classes, from simulated rooms only:\nchair, sofa." in printed
    assert "5 seen in both" in printed
    assert main(words(pair, "--detector", str(pair), boxes=False)) == 0
    assert "It knows" not in capsys.readouterr().out


@pytest.mark.parametrize(
    ("more", "other", "message"),
    [
        ((), {"upper": "none.png"}, "none.png is missing"),
        ((), {"baseline": 300}, "Is it in millimetres"),
        ((), {"baseline": -0.3}, "baseline must be a positive number of metres"),
        (("--detector", "somewhere"), {}, "give one of the two"),
        (("--association", "best"), {}, "association must be one of greedy"),
        ((), {"upper": "lower.png", "lower": "upper.png"}, "Swap the two images"),
        (("--out", __file__), {}, "is a file: give a folder"),
    ],
)
def test_what_does_not_fit_is_named_in_one_line(pair, more, other, message, capsys):
    assert main(words(pair, *more, **other)) == 2
    error = capsys.readouterr().err
    assert message in error
    assert error.count("\n") == 1
