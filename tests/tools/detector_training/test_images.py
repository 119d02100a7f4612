"""Training pictures: what counts as an object, and boxes that stay on their objects however the picture is changed."""

import numpy as np
import pytest

from tests.tools.detector_training.toy_panoramas import CLASSES, write_toy_folder
from tools.detector_training import images
from tools.detector_training.images import LabelledPanorama, TrainingDataError, panorama_window, read_panoramas

NAMES = list(CLASSES)
WIDTH, HEIGHT = 256, 128


def painted(box):
    """A dark panorama with one bright object that fills `box`, which may cross the seam."""
    image = np.full((HEIGHT, WIDTH, 3), 20, np.uint8)
    image[int(box[1]) : int(box[3]), np.arange(int(box[0]), int(box[2])) % WIDTH] = 230
    return LabelledPanorama(image, np.array([1]), np.array([box], np.float32), np.array([False]))


@pytest.mark.parametrize("box", [[40, 50, 80, 90], [240, 60, 280, 100], [0, 40, 30, 80]])
@pytest.mark.parametrize("seed", range(6))
def test_boxes_stay_on_their_objects_however_the_panorama_is_turned_mirrored_and_scaled(box, seed):
    rng = np.random.default_rng(seed)
    scale, top = float(rng.uniform(0.85, 1.15)), float(rng.uniform(-6, 6))
    sample = panorama_window(painted(box), (320, HEIGHT), int(rng.integers(WIDTH)), bool(seed % 2), scale, top)
    bright = sample.image.max(axis=2) > 125
    assert not sample.ignored.all()
    for u0, v0, u1, v1 in np.round(sample.boxes).astype(int):
        assert bright[max(v0 + 2, 0) : v1 - 2, max(u0 + 2, 0) : max(u1 - 2, 0)].all()
        bright[max(v0 - 2, 0) : v1 + 2, max(u0 - 2, 0) : u1 + 2] = False
    assert not bright.any(), "every bright pixel lies in a box"


def test_the_window_left_as_it_is_shows_the_extended_panorama_and_objects_of_the_left_quarter_twice():
    panorama = painted([20, 50, 50, 90])
    sample = panorama_window(panorama, (320, HEIGHT))
    np.testing.assert_array_equal(sample.image, np.concatenate([panorama.image, panorama.image[:, :64]], axis=1))
    assert sample.boxes.tolist() == [[20, 50, 50, 90], [276, 50, 306, 90]]


def test_one_seed_gives_one_sample_and_another_seed_another():
    panorama = painted([30, 50, 70, 90])
    rngs = map(np.random.default_rng, (1, 1, 2))
    first, second, third = (images.augmented_sample(panorama, (256, 96), rng) for rng in rngs)
    np.testing.assert_array_equal(first.image, second.image)
    np.testing.assert_array_equal(first.boxes, second.boxes)
    assert not np.array_equal(first.image, third.image)


def thing(box, fraction=1.0, label="chair"):
    return {"object": 0, "label": label, "visible_box": box, "unoccluded_box": box, "visible_fraction": fraction}


def test_small_or_hidden_objects_are_ignored_unknown_labels_left_out_and_boxes_scaled():
    objects = [
        thing([100, 200, 1300, 300]),
        thing([100, 100, 150, 129]),
        thing([200, 100, 250, 180], fraction=0.49),
        thing([300, 100, 350, 180], label="lamp"),
    ]
    panorama = images.labelled_panorama({"objects": objects}, np.zeros((640, 1280, 3), np.uint8), NAMES, 1024)
    assert panorama.ignored.tolist() == [False, True, True]
    assert panorama.image.shape == (512, 1024, 3)
    np.testing.assert_allclose(panorama.boxes[0], [80, 160, 1040, 240])


def test_the_parts_of_several_processes_make_up_the_folders_and_one_without_an_image_is_named(tmp_path):
    folders = [write_toy_folder(tmp_path / name, 5, width=64) for name in "ab"]
    parts = [read_panoramas(folders, NAMES, 64, (k, 2)) for k in (0, 1)]
    assert sorted(map(len, parts)) == [4, 6]
    assert len({panorama.image.tobytes() for part in parts for panorama in part}) == 5, "both hold the same five"
    (tmp_path / "boxes.json").write_text('{"version": 1, "images": []}')
    with pytest.raises(TrainingDataError, match="no image that is there"):
        read_panoramas([tmp_path], NAMES)
