"""`locate` on a rendered pair: the pose of the boards' map, with its sigmas, pairs and figure."""

import json
import math

import cv2
import numpy as np
import pytest

from course_lib.spherical_stereo import panorama
from course_lib.spherical_stereo.detection import colour
from course_lib.spherical_stereo.detection.detector import YoloDetector
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.panorama import View
from tests.spherical_stereo.stereo_scene import BASELINE, TRUE_POSE, mapped_scene


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


def words(folder, *more, boxes=True, baseline=BASELINE):
    files = ["--upper", folder / "upper.png", "--lower", folder / "lower.png", "--map", folder / "map.json"]
    files += ["--boxes", folder / "boxes.json"] if boxes else []
    return ["locate", *files, f"--baseline={baseline}", *more]


def test_the_pose_comes_with_its_sigmas_pairs_and_residuals(pair, told):
    found = told(*words(pair))
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


def test_the_consistent_matcher_says_how_sure_it_is_and_which_poses_there_are(pair, told, printed):
    found = told(*words(pair, "--association", "consistent"))
    assert found["status"] == "ok"
    assert math.hypot(found["x_m"] - TRUE_POSE.x, found["y_m"] - TRUE_POSE.y) < 0.15
    assert found["confidence"] > 0.8
    assert found["alternatives"][0][:2] == [found["x_m"], found["y_m"]]
    assert found["rms_residual_m"] < 2 * found["expected_rms_residual_m"]
    assert f"confidence {found['confidence']:.2f}" in printed(*words(pair, "--association", "consistent"))
    assert told(*words(pair))["confidence"] is None


@pytest.mark.slow
def test_the_table_and_the_files_say_the_same(pair, tmp_path, printed):
    out = tmp_path / "out"
    text = printed(*words(pair, "--out", out))
    stored = json.loads((out / "locate.json").read_text())
    assert f"pose: x {stored['x_m']:.2f} ± {stored['sigma_x_m']:.2f} m" in text
    assert "5 objects above, 5 below, 5 seen in both" in text
    assert len((out / "locate.csv").read_text().splitlines()) == 6
    assert min(cv2.imread(str(out / "locate.png")).shape[:2]) > 1000
    assert "<title>On the map</title>" in (out / "locate.html").read_text()


@pytest.mark.slow
def test_no_pose_is_an_answer_and_is_drawn_too(pair, tmp_path, told, printed):
    out = tmp_path / "out"
    text = printed(*words(pair, "--out", out, baseline=1.0))
    assert "no pose, implausible: the 5 objects miss their landmarks by" in text
    stored = json.loads((out / "locate.json").read_text())
    assert (stored["status"], stored["x_m"], len(stored["rejected_pose"])) == ("unable", None, 3)
    assert (out / "locate.png").is_file()
    assert "<title>No pose: implausible</title>" in (out / "locate.html").read_text()
    assert told(*words(pair, "--paper", baseline=1.0))["status"] == "ok"


def test_each_panorama_is_opened_and_coloured_once_on_the_way_of_a_user(pair, monkeypatch, told):
    opened, asked = [], []
    open_view, measure, localize = panorama.open_view, colour.mean_hue_saturation, SemanticLocalizer.localize
    monkeypatch.setattr(
        panorama, "open_view", lambda image, *name: opened.append(isinstance(image, View)) or open_view(image, *name)
    )
    monkeypatch.setattr(colour, "mean_hue_saturation", lambda *given: asked.append(given[1]) or measure(*given))
    calls = []
    monkeypatch.setattr(SemanticLocalizer, "localize", lambda *given: calls.append(given) or localize(*given))
    assert told(*words(pair))["status"] == "ok"
    assert opened.count(False) == 2, "the two images; what was opened is not opened again"
    assert len(asked) == 10, "five objects in each"
    ((_, upper, lower, boxes),) = calls
    assert (upper.size, lower.size, len(boxes.upper)) == (boxes.size, boxes.size, 5)


class Boxes:
    """A detector that knows the scene."""

    labels = ("chair", "sofa")

    def detect(self, image):
        upper, lower, _ = mapped_scene()
        return next(view.detections for view in (upper, lower) if np.array_equal(view.image, image))


def test_without_boxes_a_detector_finds_the_objects_and_the_course_s_says_what_it_knows(pair, monkeypatch, printed):
    monkeypatch.setattr(YoloDetector, "load", lambda folder, **options: Boxes())
    text = printed(*words(pair, boxes=False))
    assert "It knows 2 classes, from simulated rooms only:\nchair, sofa." in text
    assert "5 seen in both" in text
    assert "It knows" not in printed(*words(pair, "--detector", pair, boxes=False))
