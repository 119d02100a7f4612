"""ONNX networks: the three layouts of outputs give the same boxes as Darknet, and a wrong one is named."""

import numpy as np
import pytest

from course_lib.spherical_stereo.detection import onnx_network
from course_lib.spherical_stereo.detection.darknet import DetectorError
from course_lib.spherical_stereo.detection.detector import YoloDetector
from course_lib.spherical_stereo.detection.onnx_network import LAYOUTS, decode_onnx
from tests.spherical_stereo.detection.blob_networks import GREEN, INPUT_SIZE, RED, blob_onnx, panorama, write_darknet


@pytest.fixture
def names(tmp_path):
    return write_darknet(tmp_path / "names")[2]


@pytest.fixture
def path(tmp_path):
    (tmp_path / "blobs.onnx").write_bytes(blob_onnx())
    return tmp_path / "blobs.onnx"


def test_an_onnx_network_finds_the_objects_of_a_panorama_once(names, path, rng):
    detector = YoloDetector.from_onnx(path, names, layout="yolov8", input_size=INPUT_SIZE)
    sofa, television = sorted(detector.detect(panorama(rng, (100, 50, RED), (245, 20, GREEN))), key=lambda d: d.label)
    assert sofa.box == pytest.approx((100, 50, 132, 74), abs=1)
    assert television.box == pytest.approx((245, 20, 277, 44), abs=1)


ROW = [50, 40, 20, 10]  # a box by its centre and its size
SHARES, CONFIDENCES = np.array([[[[0.1, 0.25, 0.5, 0.75]]]]), np.array([[[0.3, 0.6]]])


@pytest.mark.parametrize(
    ("layout", "outputs", "box", "score"),
    [
        ("yolov5", [np.array([[[*ROW, 0.5, 0.9, 0.1]]])], [40, 35, 60, 45], [0.45, 0.05]),
        ("yolov8", [np.array([[*ROW, 0.9, 0.1]]).T[None]], [40, 35, 60, 45], [0.9, 0.1]),
        ("yolov4", [SHARES, CONFIDENCES], [10, 20, 50, 60], [0.3, 0.6]),
        ("yolov4", [CONFIDENCES, SHARES], [10, 20, 50, 60], [0.3, 0.6]),
    ],
)
def test_each_layout_gives_boxes_in_input_pixels_and_scores_with_the_objectness_in_them(layout, outputs, box, score):
    boxes, scores = decode_onnx(outputs, layout, 2, (100, 80))
    assert boxes == pytest.approx(np.array([box]))
    assert scores == pytest.approx(np.array([score]))


@pytest.mark.parametrize("layout", LAYOUTS)
def test_outputs_of_another_layout_are_refused_with_their_shapes(layout):
    with pytest.raises(DetectorError, match=r"the file gives \[\(1, 9, 8\)\]"):
        decode_onnx([np.zeros((1, 9, 8))], layout, 2, (100, 80))


@pytest.mark.parametrize(
    ("layout", "outputs"),
    [
        ("yolov4", [SHARES, CONFIDENCES, CONFIDENCES]),
        ("yolov4", [CONFIDENCES, CONFIDENCES]),
        ("yolov4", [SHARES, SHARES]),
        ("yolov4", [SHARES, np.repeat(CONFIDENCES, 2, axis=1)]),
        ("yolov8", [np.ones((1, 6, 3))] * 2),
        ("yolov8", [np.ones((2, 6, 3))]),
        ("yolov8", [np.ones((1, 6))]),
    ],
)
def test_a_layout_needs_its_own_number_of_outputs_and_of_their_rows(layout, outputs):
    with pytest.raises(DetectorError, match=rf"layout {layout} .*the file gives"):
        decode_onnx(outputs, layout, 2, (100, 80))


def refused(path, names, says, layout="yolov8", input_size=INPUT_SIZE):
    with pytest.raises(DetectorError, match=says):
        YoloDetector.from_onnx(path, names, layout=layout, input_size=input_size)


def test_files_sizes_and_results_that_do_not_fit_are_named(names, path, monkeypatch):
    refused(path, names, "at an input of 200 x 128", input_size=(200, 128))
    refused(path, names, "layout yolov5", layout="yolov5")
    refused(path, names, "known are yolov5, yolov8, yolov4", layout="yolov9")
    cells = np.array([4, 12, 20, 28], "<f4").tobytes()  # where the first four cells are
    path.write_bytes(blob_onnx().replace(cells, np.full(4, np.nan, "<f4").tobytes(), 1))
    refused(path, names, r"blobs\.onnx gives boxes or scores that are NaN")
    path.write_bytes(b"this is no network")
    refused(path, names, "cannot read")
    monkeypatch.setattr(onnx_network, "_PROBE", "import os; os.abort()")  # as a file that ends OpenCV's reader
    refused(path, names, r"running the ONNX file .*blobs\.onnx ends the process")
    path.unlink()
    refused(path, names, "is missing")
