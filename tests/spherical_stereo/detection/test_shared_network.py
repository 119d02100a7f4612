"""One detector in several threads, after a fork, copied and pickled: each gets the boxes of its own image."""

import copy
import pickle
import threading
import time

import numpy as np
import pytest

from course_lib.spherical_stereo.detection.darknet import DetectorError
from course_lib.spherical_stereo.detection.detector import YoloDetector
from tests.rendering.test_threads_and_processes import in_a_fork, needs_fork
from tests.spherical_stereo.detection.blob_networks import GREEN, INPUT_SIZE, RED, panorama, write_darknet
from tests.spherical_stereo.detection.onnx_files import blob_onnx


@pytest.fixture(params=["darknet", "onnx"])
def detector(request, tmp_path, monkeypatch):
    """Given by paths that are told from where one stands."""
    monkeypatch.chdir(tmp_path)
    files = [path.relative_to(tmp_path) for path in write_darknet(tmp_path / "network")]
    if request.param == "darknet":
        return YoloDetector(*files)
    (tmp_path / "network" / "blobs.onnx").write_bytes(blob_onnx("yolov8"))
    return YoloDetector.from_onnx("network/blobs.onnx", files[2], layout="yolov8", input_size=INPUT_SIZE)


class SlowNet:
    """Keeps its input in itself, as OpenCV's does, and takes its time."""

    def setInput(self, blob):
        self.blob = blob

    def getUnconnectedOutLayersNames(self):
        return ["output"]

    def forward(self, names):
        time.sleep(0.05)
        return [self.blob]


def test_threads_take_turns_and_each_gets_what_it_asked_for(detector):
    network = detector._network
    network._net = SlowNet()
    blobs = [np.full((1, 3, 2, 2), float(number)) for number in range(4)]
    answers: dict[int, np.ndarray] = {}

    def ask(number):
        (answers[number],) = network._results(blobs[number])

    threads = [threading.Thread(target=ask, args=(number,)) for number in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert [answers[number].max() for number in range(4)] == [0, 1, 2, 3]


def test_what_one_run_gave_is_not_written_over_by_the_next(detector, rng):
    width, height = INPUT_SIZE
    blobs = rng.random((2, 1, 3, height, width), dtype=np.float32)
    first = detector._network._results(blobs[0])
    kept = [output.copy() for output in first]
    detector._network._results(blobs[1])
    assert all(np.array_equal(one, other) for one, other in zip(first, kept, strict=True))


@needs_fork
def test_a_fork_while_another_thread_detects_finds_no_closed_door(detector, rng):
    image = panorama(rng, (100, 50, RED))
    with detector._network._turn:  # as another thread holds it
        assert in_a_fork(lambda: [found.label for found in detector.detect(image)]) == "['sofa']"


@pytest.mark.parametrize("way", [copy.deepcopy, lambda one: pickle.loads(pickle.dumps(one))])
def test_a_copy_or_one_that_was_sent_elsewhere_finds_the_same(detector, way, rng, tmp_path, monkeypatch):
    image = panorama(rng, (100, 50, RED), (20, 60, GREEN))
    other = way(detector)
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    assert len(detector.detect(image)) == 2
    assert other.detect(image) == detector.detect(image)


def test_one_that_was_sent_where_its_file_is_not_says_so_when_it_is_used(detector, rng, tmp_path):
    sent = pickle.dumps(detector)
    for path in (tmp_path / "network").iterdir():
        path.unlink()
    with pytest.raises(DetectorError, match=r"blobs\.(cfg|onnx) is missing"):
        pickle.loads(sent).detect(panorama(rng))
