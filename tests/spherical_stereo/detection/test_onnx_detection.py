"""ONNX networks: the three layouts of outputs give the same boxes as Darknet, and a wrong one is named."""

import numpy as np
import pytest

from course_lib.child import ChildStopped, run_apart
from course_lib.spherical_stereo.detection import onnx_network
from course_lib.spherical_stereo.detection.darknet import DetectorError
from course_lib.spherical_stereo.detection.detector import YoloDetector
from course_lib.spherical_stereo.detection.onnx_network import LAYOUTS, decode_onnx
from tests.spherical_stereo.detection.blob_networks import GREEN, INPUT_SIZE, RED, panorama, write_darknet
from tests.spherical_stereo.detection.onnx_files import blob_onnx
from tests.spherical_stereo.detection.onnx_model import model, node


@pytest.fixture
def names(tmp_path):
    return write_darknet(tmp_path / "names")[2]


@pytest.mark.parametrize("layout", LAYOUTS)
def test_every_layout_finds_the_objects_of_a_panorama_once(layout, names, tmp_path, rng):
    path = tmp_path / "blobs.onnx"
    path.write_bytes(blob_onnx(layout))
    detector = YoloDetector.from_onnx(path, names, layout=layout, input_size=INPUT_SIZE)
    image = panorama(rng, (100, 50, RED), (245, 20, GREEN))
    boxes = {d.label: d.box for d in detector.detect(image)}
    assert boxes["sofa"] == pytest.approx((100, 50, 132, 74), abs=1)
    assert boxes["television"] == pytest.approx((245, 20, 277, 44), abs=1)
    assert len(boxes) == 2


def test_objectness_multiplies_the_class_score_in_the_yolov5_layout():
    rows = np.array([[[50, 40, 20, 10, 0.5, 0.9, 0.1]]])
    boxes, scores = decode_onnx([rows], "yolov5", 2, (100, 80))
    assert boxes.tolist() == [[40, 35, 60, 45]]
    assert scores == pytest.approx(np.array([[0.45, 0.05]]))


def test_rows_lie_in_columns_in_the_yolov8_layout():
    columns = np.array([[[50, 10], [40, 10], [20, 4], [10, 2], [0.9, 0.2], [0.1, 0.7]]])
    boxes, scores = decode_onnx([columns], "yolov8", 2, (100, 80))
    assert boxes.tolist() == [[40, 35, 60, 45], [8, 9, 12, 11]]
    assert scores.tolist() == [[0.9, 0.1], [0.2, 0.7]]


def test_boxes_are_shares_of_the_input_in_the_yolov4_layout_whatever_the_order_of_outputs():
    boxes = np.array([[[[0.1, 0.25, 0.5, 0.75]]]])
    confidences = np.array([[[0.3, 0.6]]])
    for outputs in ([boxes, confidences], [confidences, boxes]):
        found, scores = decode_onnx(outputs, "yolov4", 2, (100, 80))
        assert found == pytest.approx(np.array([[10, 20, 50, 60]]))
        assert scores.tolist() == [[0.3, 0.6]]


@pytest.mark.parametrize("layout", LAYOUTS)
def test_outputs_of_another_layout_are_refused_with_their_shapes(layout):
    with pytest.raises(DetectorError, match=r"the file gives \[\(1, 9, 8\)\]"):
        decode_onnx([np.zeros((1, 9, 8))], layout, 2, (100, 80))


def test_an_unknown_layout_is_refused():
    with pytest.raises(DetectorError, match="known are yolov5, yolov8, yolov4"):
        decode_onnx([], "yolov9", 2, (100, 80))


def test_files_and_sizes_that_do_not_fit_are_named(names, tmp_path):
    with pytest.raises(DetectorError, match="is missing"):
        YoloDetector.from_onnx(tmp_path / "none.onnx", names, layout="yolov8", input_size=INPUT_SIZE)
    broken = tmp_path / "broken.onnx"
    broken.write_bytes(b"this is no network")
    with pytest.raises(DetectorError, match="cannot read"):
        YoloDetector.from_onnx(broken, names, layout="yolov8", input_size=INPUT_SIZE)
    path = tmp_path / "blobs.onnx"
    path.write_bytes(blob_onnx("yolov8"))
    with pytest.raises(DetectorError, match="at an input of 200 x 128"):
        YoloDetector.from_onnx(path, names, layout="yolov8", input_size=(200, 128))
    with pytest.raises(DetectorError, match="layout yolov5"):
        YoloDetector.from_onnx(path, names, layout="yolov5", input_size=INPUT_SIZE)


def test_a_file_that_ends_opencvs_reader_is_an_error_with_a_name(names, tmp_path, monkeypatch):
    """As four of 496 files with a changed byte did: what follows the file's word without looking, looks elsewhere."""
    monkeypatch.setattr(onnx_network, "_PROBE", "import os; os.abort()")
    path = tmp_path / "blobs.onnx"
    path.write_bytes(blob_onnx("yolov8"))
    with pytest.raises(DetectorError, match=r"blobs\.onnx cannot be used: reading and running it crashes \(SIGABRT\)"):
        YoloDetector.from_onnx(path, names, layout="yolov8", input_size=INPUT_SIZE)


def onnx_of_an_index_made_of_the_image(times: float) -> bytes:
    """A network that takes its boxes from where the image's brightness says: at 0 for a black one."""
    width, height = INPUT_SIZE
    every = 3 * width * height
    constants = {"flat": np.array([1, every]), "times": np.array([times]), "first": np.array([0])}
    constants |= {"last": np.array([70]), "axis": np.array([1]), "shape": np.array([1, 10, 7])}
    nodes = [
        node("Reshape", ["image", "flat"], "values"),
        node("Mul", ["values", "times"], "places"),
        node("Cast", ["places"], "index", to=7),
        node("Gather", ["values", "index"], "gathered", axis=1),
        node("Reshape", ["gathered", "flat"], "row"),
        node("Slice", ["row", "first", "last", "axis"], "cut"),
        node("Reshape", ["cut", "shape"], "output"),
    ]
    return model(nodes, constants, {"image": (1, 3, height, width)}, {"output": (1, 10, 7)})


def test_a_network_that_fails_on_an_image_is_told_by_name(names, tmp_path, rng):
    """It runs on a black image, as the trial does, and not on one whose brightness leads it out of its numbers."""
    path = tmp_path / "wild.onnx"
    path.write_bytes(onnx_of_an_index_made_of_the_image(1e9))
    detector = YoloDetector.from_onnx(path, names, layout="yolov5", input_size=INPUT_SIZE)
    with pytest.raises(DetectorError, match=r"OpenCV cannot run .*wild\.onnx on this image"):
        detector.detect(panorama(rng))


def test_the_name_of_a_function_is_not_taken_for_a_lack_of_memory(names, tmp_path):
    """OpenCV's error for an input that nobody gives comes from `allocateLayers`."""
    width, height = INPUT_SIZE
    path = tmp_path / "two.onnx"
    images = {"image": (1, 3, height, width), "second": (1, 3, height, width)}
    nodes = [node("Add", ["image", "second"], "sum"), node("Reshape", ["sum", "flat"], "output")]
    flat = np.array([1, 3 * width * height])
    path.write_bytes(model(nodes, {"flat": flat}, images, {"output": (1, 3 * width * height)}))
    with pytest.raises(ChildStopped, match="allocateLayers"):
        run_apart(onnx_network._PROBE.format(*INPUT_SIZE), str(path), onnx_network.MEMORY)
    with pytest.raises(DetectorError, match=f"OpenCV cannot run .*two.onnx at an input of {width} x {height}"):
        YoloDetector.from_onnx(path, names, layout="yolov5", input_size=INPUT_SIZE)


def test_results_that_are_no_numbers_are_refused(names, tmp_path):
    path = tmp_path / "blobs.onnx"
    data = blob_onnx("yolov8")
    cells = np.array([4, 12, 20, 28], "<f4").tobytes()  # where the first four cells are
    assert cells in data
    path.write_bytes(data.replace(cells, np.full(4, np.nan, "<f4").tobytes(), 1))
    with pytest.raises(DetectorError, match=r"blobs\.onnx gives boxes or scores that are NaN"):
        YoloDetector.from_onnx(path, names, layout="yolov8", input_size=INPUT_SIZE)
