"""Detection with real networks run by OpenCV: every object once wherever it is, and every misfit of files named."""

import re
import struct

import cv2
import numpy as np
import pytest

from course_lib.spherical_stereo.detection.darknet import expected_weight_floats, read_cfg
from course_lib.spherical_stereo.detection.detected_object import Detection, DetectionError
from course_lib.spherical_stereo.detection.detector import DetectorError, YoloDetector, find_objects
from course_lib.spherical_stereo.panorama import PanoramaError, open_view
from tests.spherical_stereo.detection.blob_networks import (
    GREEN,
    INPUT_SIZE,
    NAMES,
    OBJECT_HEIGHT,
    OBJECT_WIDTH,
    RED,
    panorama,
    write_darknet,
)
from tests.spherical_stereo.detection.published_cfgs import yolov4_tiny


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    return write_darknet(tmp_path_factory.mktemp("blobs") / "network")


@pytest.fixture(scope="module")
def detector(files):
    return YoloDetector(*files)


def offset_on_circle(u, expected, width=256):
    return (u - expected + width / 2) % width - width / 2


def test_one_object_slid_across_every_column_is_detected_exactly_once(detector, rng):
    image = panorama(rng, (100, 50, RED))
    for column in range(256):
        found = detector.detect(np.roll(image, column, axis=1))
        assert [d.label for d in found] == ["sofa"], f"with the object at column {100 + column}"
        (sofa,) = found
        assert 0 <= sofa.box[0] < 256
        assert abs(offset_on_circle(sofa.box[0], 100 + column)) < 1
        assert sofa.size == pytest.approx((OBJECT_WIDTH, OBJECT_HEIGHT), abs=0.5)
        assert abs(sofa.centre[1] - (50 + OBJECT_HEIGHT / 2)) < 1


def test_without_the_appended_quarter_an_object_at_the_seam_is_not_counted_once(files, rng):
    plain = YoloDetector(*files, use_seam_extension=False)
    image = panorama(rng, (100, 50, RED))
    counts = {u: len(plain.detect(np.roll(image, u - 100, axis=1))) for u in (100, *range(226, 256, 2))}
    assert counts.pop(100) == 1
    # With its middle on the seam the object is a half at either end, and both are found.
    assert counts[240] == 2


def test_a_box_across_the_seam_passes_the_width(detector, rng):
    (sofa,) = detector.detect(panorama(rng, (246, 30, RED)))
    assert sofa.box[0] == pytest.approx(246, abs=1)
    assert sofa.box[2] == pytest.approx(278, abs=1)
    assert sofa.centre[0] > 256


def test_hue_and_saturation_are_the_object_s_own_across_the_seam(detector, rng):
    found = {d.label: d for d in detector.detect(panorama(rng, (240, 30, RED), (60, 70, GREEN)))}
    assert abs(offset_on_circle(found["sofa"].hue, 0, 360)) < 1
    assert found["television"].hue == pytest.approx(120, abs=1)
    assert found["sofa"].saturation == pytest.approx(100, abs=1)


def test_names_of_coco_come_out_as_the_labels_of_the_map(detector, rng):
    assert NAMES == ["couch", "tv"]
    found = detector.detect(panorama(rng, (20, 30, RED), (120, 70, GREEN), (200, 20, RED)))
    assert sorted(d.label for d in found) == ["sofa", "sofa", "television"]
    assert detector.labels == ["sofa", "television"]


def test_an_empty_room_has_no_detections(detector, rng):
    assert detector.detect(panorama(rng)) == []


def test_the_greatest_score_comes_first(detector, rng):
    image = panorama(rng, (20, 30, RED), (120, 70, GREEN))
    image[30:44, 20:52] //= 2
    scores = [d.score for d in detector.detect(image)]
    assert scores == sorted(scores, reverse=True)
    assert len(scores) == 2


@pytest.mark.parametrize("scale", [0.5, 1.5, 3])
def test_a_panorama_of_another_size_gives_the_same_boxes_in_its_own_pixels(detector, rng, scale):
    image = panorama(rng, (100, 50, RED), (250, 20, GREEN))
    size = (int(256 * scale), int(128 * scale))
    found = detector.detect(cv2.resize(image, size, interpolation=cv2.INTER_AREA if scale < 1 else cv2.INTER_LINEAR))
    expected = {d.label: np.array(d.box) * scale for d in detector.detect(image)}
    assert len(found) == 2
    for detection in found:
        assert np.abs(np.array(detection.box) - expected[detection.label]).max() < 2 * max(scale, 1)


def test_another_input_size_pads_and_boxes_come_back(files, rng):
    """320 x 192 holds the extended image with 32 rows of padding above and below."""
    padded = YoloDetector(*files, input_size=(320, 192))
    image = panorama(rng, (100, 50, RED), (250, 100, GREEN))
    boxes = {d.label: d.box for d in padded.detect(image)}
    assert boxes["sofa"] == pytest.approx((100, 50, 132, 74), abs=1)
    assert boxes["television"] == pytest.approx((250, 100, 282, 124), abs=1)


def test_opencv_s_own_threshold_of_two_tenths_does_not_decide(files, rng):
    image = panorama(rng, (100, 50, (105, 105, 185)))  # a pale red: a weak answer
    scores = [d.score for d in YoloDetector(*files, score_threshold=0.001).detect(image)]
    assert scores
    assert max(scores) < 0.2
    assert YoloDetector(*files, score_threshold=0.2).detect(image) == []


@pytest.mark.parametrize(
    ("image", "says"),
    [
        (np.zeros((0, 0, 3), dtype=np.uint8), "empty"),
        (None, "empty"),
        (np.zeros((128, 256), dtype=np.uint8), "grey"),
        (np.full((128, 256, 3), 90, dtype=np.uint8), "grey"),
        (np.zeros((128, 255, 3), dtype=np.uint8), "twice as wide"),
        (np.zeros((128, 256, 3)), "float64"),
    ],
)
def test_an_image_that_is_no_colour_panorama_is_refused(detector, image, says):
    with pytest.raises(PanoramaError, match=says):
        detector.detect(image)


def test_a_view_that_was_checked_is_taken_as_it_is(detector, rng):
    image = panorama(rng, (10, 50, RED))
    assert detector.find(open_view(image)) == detector.detect(image)
    assert find_objects(open_view(image), detector).detections == tuple(detector.detect(image))


def test_a_box_below_the_threshold_votes_on_the_place_of_a_surer_one(detector, monkeypatch):
    """Two boxes of one object, 0.6 and 0.4 sure: with a threshold of 0.5 one stays, where both say."""
    boxes, scores = np.array([[100.0, 40, 140, 80], [104.0, 40, 144, 80]]), np.array([[0.6, 0.0], [0.4, 0.0]])
    monkeypatch.setattr(detector._network, "infer", lambda blob: (boxes, scores))
    found, sure, _ = detector.detect_in_plane(np.zeros((128, 320, 3), np.uint8))
    assert detector.score_threshold == 0.5
    assert found.tolist() == [pytest.approx([101.6, 40, 141.6, 80])]
    assert sure.tolist() == [0.6]


def test_truncated_weights_that_opencv_would_take_are_refused(files, tmp_path):
    cfg, weights, names = files
    cut = tmp_path / "cut.weights"
    cut.write_bytes(weights.read_bytes()[:-4000])
    cv2.dnn.readNetFromDarknet(str(cfg), str(cut))  # not a word
    with pytest.raises(DetectorError, match="too short"):
        YoloDetector(cfg, cut, names)


def test_names_of_another_network_are_refused(files, tmp_path):
    cfg, weights, _ = files
    (tmp_path / "other.names").write_text("a\nb\nc\n")
    with pytest.raises(DetectorError, match=r"2 classes.*3 names"):
        YoloDetector(cfg, weights, tmp_path / "other.names")


def test_a_missing_file_is_named(files, tmp_path):
    cfg, weights, names = files
    nothing = tmp_path / "nothing"
    for arguments in ((nothing, weights, names), (cfg, nothing, names), (cfg, weights, nothing)):
        with pytest.raises(DetectorError, match="nothing is missing"):
            YoloDetector(*arguments)


def test_a_yolov4_with_the_80_classes_of_coco_runs_at_the_shape_of_a_panorama(tmp_path, rng):
    cfg = tmp_path / "yolov4-tiny.cfg"
    cfg.write_text(yolov4_tiny())
    weights = rng.normal(0, 0.02, expected_weight_floats(read_cfg(cfg))).astype("<f4")
    (tmp_path / "some.weights").write_bytes(struct.pack("<3iq", 0, 2, 5, 0) + abs(weights).tobytes())
    (tmp_path / "coco.names").write_text("\n".join(["diningtable", *(f"thing {i}" for i in range(79))]))
    detector = YoloDetector.load(tmp_path, input_size=(320, 128), score_threshold=0.0)
    boxes, scores, classes = detector.detect_in_plane(panorama(rng))
    assert len(boxes) == len(scores) == len(classes) > 0
    assert (boxes >= 0).all()
    assert (boxes <= [256, 128, 256, 128]).all()
    assert "table" in detector.labels
    with pytest.raises(DetectorError, match="multiples of the network's stride"):
        YoloDetector.load(tmp_path, input_size=(330, 128))


def test_thresholds_outside_nought_to_one_are_refused(files):
    for name in ("score_threshold", "iou_threshold"):
        with pytest.raises(DetectorError, match=name):
            YoloDetector(*files, **{name: 1.2})


def test_a_folder_with_one_file_of_each_kind_is_loaded(files, rng):
    detector = YoloDetector.load(files[0].parent, score_threshold=0.4)
    assert (detector.input_size, detector.score_threshold) == (INPUT_SIZE, 0.4)
    assert len(detector.detect(panorama(rng, (10, 50, RED)))) == 1


def test_the_threshold_that_training_chose_is_taken_unless_another_is_given(files, tmp_path):
    for path in files:
        (tmp_path / path.name).write_bytes(path.read_bytes())
    assert YoloDetector.load(tmp_path).score_threshold == 0.5
    chosen = tmp_path / "training.json"
    chosen.write_text('{"score_threshold": 0.31}')
    assert YoloDetector.load(tmp_path).score_threshold == 0.31
    assert YoloDetector.load(tmp_path, score_threshold=0.4).score_threshold == 0.4
    for content in ("{", "[]", "{}", '{"score_threshold": "high"}', '{"score_threshold": null}'):
        chosen.write_text(content)
        with pytest.raises(DetectorError, match=r"training\.json must be JSON with a number"):
            YoloDetector.load(tmp_path)
        assert YoloDetector.load(tmp_path, score_threshold=0.4).score_threshold == 0.4
    chosen.write_text('{"score_threshold": 31}')
    with pytest.raises(DetectorError, match="score_threshold must be between 0 and 1"):
        YoloDetector.load(tmp_path)


def test_a_folder_that_lacks_or_doubles_a_file_is_refused(files, tmp_path):
    with pytest.raises(DetectorError, match="no detector folder"):
        YoloDetector.load(tmp_path / "nowhere")
    for path in files:
        (tmp_path / path.name).write_bytes(path.read_bytes())
    (tmp_path / "second.cfg").write_text("")
    with pytest.raises(DetectorError, match=r"exactly one \.cfg file; found blobs\.cfg, second\.cfg"):
        YoloDetector.load(tmp_path)
    (tmp_path / "second.cfg").unlink()
    (tmp_path / "blobs.names").unlink()
    with pytest.raises(DetectorError, match=r"exactly one \.names file; found none"):
        YoloDetector.load(tmp_path)


def test_a_detection_knows_its_centre_its_size_and_its_place_on_the_circle():
    detection = Detection("chair", 0.5, (250, 10, 270, 40), 20.0, 55.0)
    assert (detection.centre, detection.size) == ((260, 25), (20, 30))
    assert Detection("chair", 0.5, (506, 10, 526, 40), 20.0, 55.0).wrapped(256) == detection


def test_a_detection_keeps_the_canonical_label():
    assert Detection("Couch", 0.5, (1, 2, 3, 4), 20.0, 55.0).label == "sofa"
    assert Detection("Traffic_Light", 0.5, (1, 2, 3, 4), 20.0, 55.0).label == "traffic light"


def test_a_grey_detection_says_so():
    grey = Detection("refrigerator", 0.9, (1, 2, 3, 4), float("nan"), 3.0)
    assert grey.is_grey
    assert "grey, no hue" in grey.describe()
    red = Detection("sofa", 0.9, (1, 2, 3, 4), 0.0, 80.0)
    assert not red.is_grey
    assert "hue 0 deg" in red.describe()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"label": ""}, "label"),
        ({"label": "  "}, "label"),
        ({"label": 3}, "label"),
        ({"score": "x"}, "score must be a number; got 'x'"),
        ({"score": None}, "score must be a number"),
        ({"hue": "red"}, "hue must be a number"),
        ({"saturation": [1, 2]}, "saturation must be a number"),
        ({"box": 7}, "four finite"),
        ({"box": ("a", 2, 3, 4)}, "four finite"),
        ({"score": 1.1}, "score"),
        ({"score": float("nan")}, "score"),
        ({"box": (1, 2, 3)}, "four finite"),
        ({"box": (1, 2, float("inf"), 4)}, "four finite"),
        ({"box": (3, 2, 1, 4)}, "u_min < u_max"),
        ({"box": (-1, 2, 3, 4)}, "0 <= u_min"),
        ({"hue": 360.0}, "hue"),
        ({"hue": -1.0}, "hue"),
        ({"saturation": 101.0}, "saturation"),
        ({"saturation": float("nan")}, "saturation"),
    ],
)
def test_a_detection_that_cannot_be_is_refused(change, message):
    good = {"label": "sofa", "score": 0.9, "box": (1, 2, 3, 4), "hue": 10.0, "saturation": 50.0}
    Detection(**good)
    with pytest.raises(DetectionError, match=message):
        Detection(**(good | change))


@pytest.mark.parametrize("threshold", ["1.5", "-0.1", "true", '"0.4"', "null", "[0.4]"])
def test_a_trained_threshold_that_is_none_is_named_with_its_file(files, tmp_path, threshold):
    for path in files:
        (tmp_path / path.name).write_bytes(path.read_bytes())
    (tmp_path / "training.json").write_text(f'{{"score_threshold": {threshold}}}')
    with pytest.raises(
        DetectorError, match=r"training\.json(: score_threshold must be between|.* must be JSON with a number)"
    ):
        YoloDetector.load(tmp_path)


def test_a_training_report_that_is_no_file_is_not_one_left_out(files, tmp_path):
    for path in files:
        (tmp_path / path.name).write_bytes(path.read_bytes())
    (tmp_path / "training.json").mkdir()
    with pytest.raises(DetectorError, match=r"training\.json is a folder"):
        YoloDetector.load(tmp_path)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("filters=3", "size=3", "has no filters"),
        ("width=320", "width=3.5", "not a whole number"),
        ("width=320", "width=2147483647", "is more than 16,777,216 pixels"),
        ("classes=2", "classes=3", "channels"),
        ("filters=3", "filters=4", r"is too short.* blobs\.weights|blobs\.weights is too short"),
    ],
)
def test_a_fault_of_the_cfg_names_the_cfg(files, tmp_path, old, new, said):
    cfg = tmp_path / "other.cfg"
    cfg.write_text(files[0].read_text().replace(old, new, 1))
    with pytest.raises(DetectorError, match=r"other\.cfg") as told:
        YoloDetector(cfg, *files[1:])
    assert re.search(said, str(told.value))


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_weights_that_are_no_numbers_are_named(files, tmp_path, value):
    weights = tmp_path / "other.weights"
    weights.write_bytes(files[1].read_bytes()[:-4] + np.float32(value).tobytes())
    with pytest.raises(DetectorError, match=r"other\.weights: 1 of its \d+ numbers are NaN or infinite"):
        YoloDetector(files[0], weights, files[2])


def test_a_network_of_right_numbers_whose_results_are_none_is_refused(files, tmp_path):
    weights = np.frombuffer(files[1].read_bytes()[20:], "<f4").copy()
    weights[:3], weights[3 + 144 :] = 3e38, 3e38  # sums that no float32 holds, of both signs
    weights[3 + 144 :: 2] = -3e38
    damaged = tmp_path / "other.weights"
    damaged.write_bytes(files[1].read_bytes()[:20] + weights.tobytes())
    with pytest.raises(DetectorError, match=r"blobs\.cfg with .*other\.weights gives boxes or scores that are NaN"):
        YoloDetector(files[0], damaged, files[2])
