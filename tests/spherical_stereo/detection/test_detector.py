"""Detection with real networks run by OpenCV: every object once wherever it is, and every misfit of files named."""

import pickle
import struct
from concurrent.futures import ThreadPoolExecutor

import cv2
import numpy as np
import pytest

from course_lib.spherical_stereo.detection import detector as detection
from course_lib.spherical_stereo.detection.darknet import DetectorError
from course_lib.spherical_stereo.detection.detector import YoloDetector
from course_lib.spherical_stereo.panorama import PanoramaError, open_view
from tests.spherical_stereo.detection import blob_networks
from tests.spherical_stereo.detection.blob_networks import CFG, GREEN, INPUT_SIZE, RED, panorama, write_darknet


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    return write_darknet(tmp_path_factory.mktemp("blobs"))


@pytest.fixture
def copied(tmp_path):
    """A folder with the three files, to spoil."""
    return write_darknet(tmp_path)[0].parent


@pytest.fixture(scope="module")
def detector(files):
    return YoloDetector(*files)


def test_one_object_slid_across_every_column_is_detected_exactly_once(detector, rng):
    image = panorama(rng, (100, 50, RED))
    for column in range(256):
        found = detector.detect(np.roll(image, column, axis=1))
        assert [d.label for d in found] == ["sofa"], f"with the object at column {100 + column}"
        (sofa,) = found
        assert 0 <= sofa.box[0] < 256
        assert abs((sofa.box[0] - 100 - column + 128) % 256 - 128) < 1
        assert np.subtract(sofa.box[2:], sofa.box[:2]) == pytest.approx((32, 24), abs=0.5)
        assert np.mean(sofa.box[1::2]) == pytest.approx(50 + 24 / 2, abs=1)
    # Without the appended quarter an object on the seam is found twice.
    assert [len(detector.detect_in_plane(panorama(rng, (u, 50, RED)))[0]) for u in (100, 240)] == [1, 2]


def test_a_box_across_the_seam_passes_the_width_and_its_colour_is_the_object_s_own(detector, rng):
    found = {d.label: d for d in detector.detect(panorama(rng, (246, 30, RED), (60, 70, GREEN)))}
    assert found["sofa"].box[::2] == pytest.approx((246, 278), abs=1)
    assert abs((found["sofa"].hue + 180) % 360 - 180) < 1
    assert found["sofa"].saturation == pytest.approx(100, abs=1)
    assert found["television"].hue == pytest.approx(120, abs=1)


def test_names_of_coco_come_out_as_the_labels_of_the_map_the_surest_first(detector, rng):
    image = panorama(rng, (20, 30, RED), (120, 70, GREEN), (200, 20, RED))
    image[30:44, 20:52] //= 2
    found = detector.detect(image)
    assert detector.labels == ["sofa", "television"]
    assert sorted(d.label for d in found) == ["sofa", "sofa", "television"]
    assert [d.score for d in found] == sorted((d.score for d in found), reverse=True)
    assert detector.detect(panorama(rng)) == []


@pytest.mark.parametrize("scale", [0.5, 3])
@pytest.mark.parametrize("input_size", [INPUT_SIZE, (320, 192)])
def test_a_panorama_of_another_size_gives_the_same_boxes_in_its_own_pixels(files, rng, scale, input_size):
    """320 x 192 holds the extended image with 32 rows of padding above and below."""
    image = panorama(rng, (100, 50, RED), (250, 20, GREEN))
    found = YoloDetector(*files, input_size=input_size).detect(cv2.resize(image, None, fx=scale, fy=scale))
    sofa, television = sorted(found, key=lambda d: d.label)
    assert np.array(sofa.box) / scale == pytest.approx((100, 50, 132, 74), abs=2)
    assert np.array(television.box) / scale == pytest.approx((250, 20, 282, 44), abs=2)


def test_opencv_s_own_threshold_of_two_tenths_does_not_decide(files, rng):
    image = panorama(rng, (100, 50, (105, 105, 185)))  # a pale red: a weak answer
    scores = [d.score for d in YoloDetector(*files, score_threshold=0.001).detect(image)]
    assert 0 < max(scores) < 0.2
    assert YoloDetector(*files, score_threshold=0.2).detect(image) == []


def test_a_box_below_the_threshold_votes_on_the_place_of_a_surer_one(detector, monkeypatch):
    """Two boxes of one object, 0.6 and 0.4 sure: with a threshold of 0.5 one stays, between the two."""
    boxes, scores = np.array([[100.0, 40, 140, 80], [104.0, 40, 144, 80]]), np.array([[0.6, 0.0], [0.4, 0.0]])
    monkeypatch.setattr(detector._network, "infer", lambda blob: (boxes, scores))
    found, sure, _ = detector.detect_in_plane(np.zeros((128, 320, 3), np.uint8))
    assert found.tolist() == [pytest.approx([101.6, 40, 141.6, 80])]
    assert sure.tolist() == [0.6]


def test_a_detector_sent_elsewhere_gives_the_same_and_an_image_is_checked(detector, rng):
    image = panorama(rng, (10, 50, RED))
    assert pickle.loads(pickle.dumps(detector)).detect(image) == detector.detect(image)
    assert detection.find_objects(open_view(image), detector).detections == tuple(detector.detect(image))
    with pytest.raises(PanoramaError, match="twice as wide"):
        detector.detect(image[:, :255])


def test_every_detector_is_given_the_image_as_the_protocol_says(files, rng):
    class Noting(YoloDetector):
        def detect(self, image_bgr):
            given.append(image_bgr)
            return super().detect(image_bgr)

    given, image = [], panorama(rng, (10, 50, RED))
    detection.find_objects(open_view(image), Noting(*files))
    assert given[0] is image


def test_files_that_do_not_belong_together_and_folders_that_lack_one_are_refused(copied):
    with pytest.raises(DetectorError, match=r"exactly one \.cfg file; found none"):
        YoloDetector.load(copied / "nowhere")
    (copied / "blobs.names").write_text("a\nb\nc\n")
    with pytest.raises(DetectorError, match=r"2 classes.* has 3"):
        YoloDetector.load(copied)
    cut = copied / "blobs.weights"
    cut.write_bytes(cut.read_bytes()[:-4000])
    cv2.dnn.readNetFromDarknet(str(copied / "blobs.cfg"), str(cut))  # without an error
    with pytest.raises(DetectorError, match="Was the copy cut off"):
        YoloDetector.load(copied)
    (copied / "second.names").write_text("")
    with pytest.raises(DetectorError, match=r"exactly one \.names file; found blobs\.names, second\.names"):
        YoloDetector.load(copied)


def test_the_threshold_that_training_chose_is_taken_unless_another_is_given(copied):
    assert YoloDetector.load(copied).score_threshold == 0.5
    chosen = copied / "training.json"
    chosen.write_text('{"score_threshold": 0.31}')
    assert YoloDetector.load(copied).score_threshold == 0.31
    for content in ("[]", "{}", '{"score_threshold": "high"}', '{"score_threshold": true}', '{"score_threshold": 31}'):
        chosen.write_text(content)
        with pytest.raises(DetectorError, match="score_threshold"):
            YoloDetector.load(copied)
        assert YoloDetector.load(copied, score_threshold=0.4).score_threshold == 0.4
    with pytest.raises(DetectorError, match="iou_threshold must be between 0 and 1"):
        YoloDetector.load(copied, score_threshold=0.4, iou_threshold=1.2)


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("filters=3", "size=3", "filters must be whole numbers; got none"),
        ("width=320", "width=3.5", "whole numbers; got 3.5"),
        ("width=320", "width=2147483647", "1 to 16,777,216 pixels"),
        ("filters=3", "filters=4", r"blobs\.weights holds"),
    ],
)
def test_a_fault_of_the_cfg_names_the_cfg(copied, old, new, says):
    (copied / "blobs.cfg").write_text(CFG.replace(old, new, 1))
    with pytest.raises(DetectorError, match=rf"blobs\.cfg: .*{says}"):
        YoloDetector.load(copied)


def test_a_layer_that_nothing_takes_and_that_detects_nothing_is_named(copied):
    """OpenCV makes an output of it, and its numbers must not be taken for boxes."""
    unused = "[convolutional]\nfilters=4\nsize=1\nstride=1\nactivation=linear\n\n[route]\nlayers=-2\n\n"
    first, second = CFG.rsplit("[convolutional]", 1)
    (copied / "blobs.cfg").write_text(f"{first}{unused}[convolutional]{second}")
    weights = np.insert(blob_networks.darknet_weights(), [3 + 3 * 3 * blob_networks.BLOCK**2] * 16, 0).astype("<f4")
    (copied / "blobs.weights").write_bytes(struct.pack("<3iq", 0, 2, 5, 0) + weights.tobytes())
    with pytest.raises(DetectorError, match=r"has an output of shape \(1, 4, 32, 80\) that no \[yolo\] layer gives"):
        YoloDetector.load(copied)


def test_threads_take_turns_and_no_run_writes_over_what_another_gave(detector, rng):
    blobs = rng.random((40, 1, 3, *INPUT_SIZE[::-1]), dtype=np.float32)
    alone = [[output.copy() for output in detector._network.infer(blob)] for blob in blobs]
    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(detector._network.infer, blobs))
    for one, other in zip(together, alone, strict=True):
        assert all(map(np.array_equal, one, other))


@pytest.mark.parametrize(
    ("image_size", "input_size"),
    [((160, 64), (128, 51)), ((160, 64), (60, 60)), ((33, 77), (42, 42)), ((50, 20), (416, 416)), ((200, 3), (42, 42))],
)
def test_the_whole_image_lies_inside_the_input_and_its_box_comes_back_exactly(image_size, input_size):
    padded, letterbox = detection.letterbox_image(np.full((*image_size[::-1], 3), 255, dtype=np.uint8), input_size)
    rows, columns = np.nonzero((padded != detection.PADDING_GREY).any(axis=-1))
    inside = [columns.min(), rows.min(), columns.max() + 1, rows.max() + 1]
    assert detection.boxes_to_image(inside, letterbox) == pytest.approx([0, 0, *image_size], abs=1e-10)
    assert (inside[2] - inside[0] == input_size[0]) or (inside[3] - inside[1] == input_size[1])
