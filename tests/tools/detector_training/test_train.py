"""The training loop: it learns toy panoramas, goes on where it was stopped, and works with several processes."""

import hashlib
import json
import threading
from itertools import pairwise

import pytest

torch = pytest.importorskip("torch", reason="PyTorch, which only the training of the detector needs, is not installed")

from course_lib.spherical_stereo.detection.darknet import check_weights, parse_cfg  # noqa: E402
from tests.tools.detector_training.toy_panoramas import CLASSES, ROOM_NAMES, TINY_CFG, write_toy_folder  # noqa: E402
from tools.detector_training.augmentation import AugmentationRanges  # noqa: E402
from tools.detector_training.batches import QUEUE_LENGTH, _made_ahead  # noqa: E402
from tools.detector_training.checkpoints import CheckpointError, Position  # noqa: E402
from tools.detector_training.export import read_weights  # noqa: E402
from tools.detector_training.images import PanoramaFolders, TrainingDataError  # noqa: E402
from tools.detector_training.network import TrainableNetwork  # noqa: E402
from tools.detector_training.report import write_report  # noqa: E402
from tools.detector_training.schedule import AveragedNetwork, learning_rate  # noqa: E402
from tools.detector_training.train import TrainingPlan, TrainingResult, train  # noqa: E402
from tools.detector_training.validation import Validation, network_detector, validate  # noqa: E402

STILL = AugmentationRanges((1.0, 1.0), 0.0, 0.0, 0.0, 0.0, (1.0, 1.0), 0.0, 0.0)


@pytest.fixture(scope="module")
def toy(tmp_path_factory):
    """Folder with tiny.cfg and 8 toy panoramas."""
    folder = tmp_path_factory.mktemp("toy")
    (folder / "tiny.cfg").write_text(TINY_CFG)
    write_toy_folder(folder / "images", 8, width=256)
    return folder


def test_an_error_while_nobody_takes_batches_any_more_ends_the_thread():
    failing = threading.Event()

    def make(number):
        if number == QUEUE_LENGTH + 1:  # the first is taken, the others fill the queue
            failing.set()
            raise OSError("the disk is full")
        return number

    batches = _made_ahead(make, 100)
    assert next(batches) == 0
    assert failing.wait(5)
    closing = threading.Thread(target=batches.close, daemon=True)
    closing.start()
    closing.join(5)
    assert not closing.is_alive()


def test_an_error_in_the_making_of_a_batch_reaches_the_one_who_takes_them():
    def make(number):
        raise OSError("the disk is full")

    with pytest.raises(OSError, match="disk is full"):
        next(_made_ahead(make, 3))


def plan(**changes):
    values = {"minutes": None, "batch_size": 4, "window": (256, 128), "panorama_width": 256, "learning_rate": 5e-3}
    values |= {"warm_up_steps": 5, "validation_images": 8, "minutes_between_validations": 60.0, "bfloat16": False}
    return TrainingPlan(**{**values, **changes})


def run(toy, output, given, **options):
    images = [toy / "images"]
    options = {"log": lambda text: None, "ranges": STILL, **options}
    return train(toy / "tiny.cfg", ROOM_NAMES, images, images, output, given, **options)


def test_it_learns_toy_panoramas(toy, tmp_path):
    result = run(toy, tmp_path, plan(epochs=60, learning_rate=8e-3))
    assert result.validation.recall > 0.9
    assert result.validation.precision > 0.9
    # What was written finds them too.
    check_weights(toy / "tiny.cfg", result.weights)
    network = TrainableNetwork(parse_cfg(TINY_CFG)).eval()
    read_weights(network, result.weights)
    names = list(CLASSES)
    again = validate(network_detector(network, names), PanoramaFolders([toy / "images"], names, 256).panoramas, names)
    assert again.recall == pytest.approx(result.validation.recall)


def test_a_training_that_goes_on_equals_one_in_one_piece(toy, tmp_path):
    # Nothing is faster than a second, so a checkpoint is written after every epoch.
    often = {"minutes_between_checkpoints": 0.0}
    whole = run(toy, tmp_path / "whole", plan(epochs=4, **often))

    # The first half of a plan of four epochs: stopped by an interrupt, as Ctrl-C does it.
    class Stop(Exception):
        pass

    def stop_in_third_epoch(batches, count, calls=[0]):  # noqa: B006
        calls[0] += 1
        if calls[0] == 3:
            raise Stop
        return batches

    with pytest.raises(Stop):
        run(toy, tmp_path / "halves", plan(epochs=4, **often), progress=stop_in_third_epoch)
    halves = run(toy, tmp_path / "halves", plan(epochs=4, **often), resume=True)
    assert halves.position.step == whole.position.step
    a, b = (torch.frombuffer(bytearray(r.weights.read_bytes()[20:]), dtype=torch.float32) for r in (whole, halves))
    torch.testing.assert_close(a, b, atol=1e-4, rtol=1e-3)


def test_two_processes_train_one_network(toy, tmp_path):
    lines = []
    result = run(toy, tmp_path, plan(epochs=2, processes=2), log=lines.append)
    assert result.position.images_seen == 16
    assert len([line for line in lines if line.startswith("epoch")]) == 2
    check_weights(toy / "tiny.cfg", result.weights)


def test_a_training_stops_when_its_time_is_over(toy, tmp_path):
    result = run(toy, tmp_path, plan(minutes=1.0 / 60.0))
    assert 1.0 <= result.position.seconds < 10.0


def test_what_cannot_be_trained_is_named(toy, tmp_path):
    with pytest.raises(TrainingDataError, match="multiples of 32"):
        run(toy, tmp_path, plan(window=(250, 128)))
    with pytest.raises(TrainingDataError, match="at least two"):
        run(toy, tmp_path, plan(batch_size=3, processes=2))
    with pytest.raises(CheckpointError, match="nothing to go on from"):
        run(toy, tmp_path / "new", plan(epochs=1), resume=True)
    run(toy, tmp_path / "old", plan(epochs=1))
    with pytest.raises(CheckpointError, match="seed 0, not 3"):
        run(toy, tmp_path / "old", plan(epochs=2, seed=3), resume=True)


def test_the_learning_rate_warms_up_and_falls():
    rates = [learning_rate(1.0, step, 10, step / 100) for step in range(101)]
    assert rates[0] == pytest.approx(0.1, rel=0.01)
    assert max(rates) == rates[9]
    assert rates[100] == pytest.approx(0.01)
    assert all(later < earlier for earlier, later in pairwise(rates[10:]))


def test_the_average_forgets_its_start_and_follows_the_weights():
    network = torch.nn.Linear(2, 2)
    average = AveragedNetwork(network, decay=0.9, ramp=1.0)
    with torch.no_grad():
        network.weight.fill_(3.0)
    for _ in range(200):
        average.update(network)
    torch.testing.assert_close(average.network.weight, network.weight.detach())


@pytest.mark.parametrize("warm", [False, True])
def test_the_report_names_the_weights_that_the_training_started_from(warm, tmp_path):
    first = tmp_path / "first.weights"
    first.write_bytes(b"weights")
    result = TrainingResult(first, Position(0), None, 10.0)
    measured = Validation(1, 0.5, 1.0, 1.0, 1.0, {"sofa": (1.0, 1.0, 3)})
    path = write_report(tmp_path / "training.json", plan(), result, measured, first if warm else None)
    expected = hashlib.sha256(b"weights").hexdigest() if warm else None
    assert json.loads(path.read_text())["started_from_sha256"] == expected
