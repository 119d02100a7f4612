"""The training loop: it learns toy panoramas, goes on where it was stopped, and works with several processes."""

import pytest

torch = pytest.importorskip("torch", reason="PyTorch, which only the training of the detector needs, is not installed")

from course_lib.spherical_stereo.detection.darknet import check_weights, read_cfg  # noqa: E402
from tests.tools.detector_training.toy_panoramas import CLASSES, ROOM_NAMES, TINY_CFG, write_toy_folder  # noqa: E402
from tools.detector_evaluation import measure_detector  # noqa: E402
from tools.detector_training.images import AugmentationRanges, TrainingDataError, read_panoramas  # noqa: E402
from tools.detector_training.state import CheckpointError  # noqa: E402
from tools.detector_training.train import TrainingPlan, train  # noqa: E402

STILL = AugmentationRanges((1.0, 1.0), 0.0, 0.0, 0.0, 0.0, (1.0, 1.0), 0.0, 0.0)


@pytest.fixture(scope="module")
def toy(tmp_path_factory):
    """Folder with tiny.cfg and 8 toy panoramas."""
    folder = tmp_path_factory.mktemp("toy")
    (folder / "tiny.cfg").write_text(TINY_CFG)
    write_toy_folder(folder / "images", 8, width=256)
    return folder


def plan(**changes):
    values = {"minutes": None, "batch_size": 4, "window": (256, 128), "panorama_width": 256, "learning_rate": 5e-3}
    values |= {"warm_up_steps": 5, "validation_images": 8, "minutes_between_validations": 60.0, "bfloat16": False}
    return TrainingPlan(**{**values, **changes})


def run(toy, output, given, **options):
    images = [toy / "images"]
    options = {"log": lambda text: None, "ranges": STILL, **options}
    return train(toy / "tiny.cfg", ROOM_NAMES, images, images, output, given, **options)


def test_it_learns_toy_panoramas_and_opencv_finds_them_with_the_written_weights(toy, tmp_path):
    result = run(toy, tmp_path, plan(epochs=60, learning_rate=8e-3))
    panoramas = read_panoramas([toy / "images"], list(CLASSES), 256)
    found = measure_detector(toy / "tiny.cfg", result.weights, ROOM_NAMES, panoramas)
    assert found.recall > 0.9
    assert found.precision > 0.9
    assert found == result.validation


def test_a_training_that_goes_on_equals_one_in_one_piece(toy, tmp_path):
    # Nothing is faster than a second, so a checkpoint is written after every epoch.
    often = plan(epochs=4, minutes_between_checkpoints=0.0)
    whole = run(toy, tmp_path / "whole", often)
    epochs = []

    def stop_in_third_epoch(made, count):
        epochs.append(count)
        if len(epochs) == 3:
            raise KeyboardInterrupt
        return made

    with pytest.raises(KeyboardInterrupt):
        run(toy, tmp_path / "halves", often, progress=stop_in_third_epoch)
    halves = run(toy, tmp_path / "halves", often, resume=True)
    assert halves.position.step == whole.position.step
    a, b = (torch.frombuffer(bytearray(r.weights.read_bytes()[20:]), dtype=torch.float32) for r in (whole, halves))
    torch.testing.assert_close(a, b, atol=1e-4, rtol=1e-3)


def test_two_processes_train_one_network_and_what_cannot_be_trained_is_named(toy, tmp_path):
    result = run(toy, tmp_path, plan(epochs=2, processes=2))
    assert (result.position.images_seen, result.position.epoch) == (16, 2)
    check_weights(read_cfg(toy / "tiny.cfg"), result.weights)
    for wrong, said in (
        ({"window": (250, 128)}, "multiples of 32"),
        ({"batch_size": 3, "processes": 2}, "at least two"),
    ):
        with pytest.raises(TrainingDataError, match=said):
            run(toy, tmp_path, plan(**wrong))
    with pytest.raises(CheckpointError, match="nothing to go on from"):
        run(toy, tmp_path / "new", plan(epochs=1), resume=True)
    run(toy, tmp_path / "old", plan(epochs=1))
    with pytest.raises(CheckpointError, match="seed 0, not 3"):
        run(toy, tmp_path / "old", plan(epochs=2, seed=3), resume=True)
