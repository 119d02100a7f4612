"""Training pictures: what counts as an object, and boxes that stay on their objects however the picture is changed."""

import json

import cv2
import numpy as np
import pytest

from tests.tools.detector_training.toy_panoramas import CLASSES, write_toy_folder
from tools.detector_training.augmentation import AugmentationRanges, augmented_sample, panorama_window, recoloured
from tools.detector_training.images import (
    LabelledPanorama,
    PanoramaFolders,
    TrainingDataError,
    labelled_panorama,
    read_boxes,
)

NAMES = list(CLASSES)
WIDTH, HEIGHT = 256, 128


def painted(box, width=WIDTH, height=HEIGHT):
    """A dark panorama with one bright object that fills `box`, which may cross the seam."""
    image = np.full((height, width, 3), 20, np.uint8)
    columns = np.arange(int(box[0]), int(box[2])) % width
    image[int(box[1]) : int(box[3]), columns] = 230
    return LabelledPanorama("toy", image, np.array([1]), np.array([box], np.float32), np.array([False]))


def bright_inside(image, box):
    """Smallest box around the bright pixels near `box`."""
    mask = image.max(axis=2) > 125
    u0, v0, u1, v1 = np.round(box).astype(int) + np.array([-4, -4, 4, 4])
    window = mask[max(v0, 0) : v1, max(u0, 0) : u1]
    rows, columns = np.flatnonzero(window.any(axis=1)), np.flatnonzero(window.any(axis=0))
    u, v = max(u0, 0), max(v0, 0)
    return np.array([u + columns[0], v + rows[0], u + columns[-1] + 1, v + rows[-1] + 1])


@pytest.mark.parametrize("box", [[40, 50, 80, 90], [240, 60, 280, 100], [0, 40, 30, 80]])
@pytest.mark.parametrize("seed", range(6))
def test_boxes_stay_on_their_objects(box, seed):
    rng = np.random.default_rng(seed)
    scale = float(rng.uniform(0.85, 1.15))
    top = float(rng.uniform(-6, 6))
    sample = panorama_window(painted(box), (320, HEIGHT), int(rng.integers(WIDTH)), bool(seed % 2), scale, top)
    whole = [b for b, ignored in zip(sample.boxes, sample.ignored, strict=True) if not ignored]
    assert whole
    for found in whole:
        np.testing.assert_allclose(bright_inside(sample.image, found), found, atol=1.5)


def test_every_bright_pixel_of_a_sample_lies_in_a_box():
    panorama = painted([240, 60, 280, 100])
    for seed in range(8):
        rng = np.random.default_rng(seed)
        sample = panorama_window(panorama, (320, HEIGHT), int(rng.integers(WIDTH)), scale=float(rng.uniform(0.9, 1.1)))
        mask = sample.image.max(axis=2) > 125
        for u0, v0, u1, v1 in np.round(sample.boxes).astype(int):
            mask[max(v0 - 2, 0) : v1 + 2, max(u0 - 2, 0) : u1 + 2] = False
        assert not mask.any()


def test_an_object_in_the_left_quarter_appears_in_both_copies():
    sample = panorama_window(painted([20, 50, 50, 90]), (320, HEIGHT))
    assert sample.boxes.tolist() == [[20, 50, 50, 90], [276, 50, 306, 90]]


def test_the_window_left_as_it_is_shows_the_extended_panorama():
    panorama = painted([240, 60, 280, 100])
    sample = panorama_window(panorama, (320, HEIGHT))
    np.testing.assert_array_equal(sample.image, np.concatenate([panorama.image, panorama.image[:, :64]], axis=1))


def test_an_object_cut_to_less_than_two_fifths_is_ignored():
    # 12 of 40 columns are left of the window's end, then 20 of 40.
    for roll, ignored in ((0, True), (-8, False)):
        sample = panorama_window(painted([244, 50, 284, 90]), (256, HEIGHT), roll)
        at_the_right = sample.boxes[:, 2] == 256
        assert sample.ignored[at_the_right].tolist() == [ignored]


def test_mirroring_twice_gives_the_first_picture():
    panorama = painted([30, 50, 70, 90])
    once = panorama_window(panorama, (WIDTH, HEIGHT), mirror=True)
    again = LabelledPanorama("x", once.image, once.labels, once.boxes, once.ignored)
    twice = panorama_window(again, (WIDTH, HEIGHT), mirror=True)
    np.testing.assert_array_equal(twice.image, panorama.image)
    np.testing.assert_array_equal(twice.boxes, panorama.boxes)


def test_one_seed_gives_one_sample_and_another_seed_another():
    panorama = painted([30, 50, 70, 90])
    first, second, third = (augmented_sample(panorama, (256, 96), np.random.default_rng(seed)) for seed in (1, 1, 2))
    np.testing.assert_array_equal(first.image, second.image)
    np.testing.assert_array_equal(first.boxes, second.boxes)
    assert not np.array_equal(first.image, third.image)


def test_a_lower_window_still_holds_what_stands_at_the_horizon():
    panorama = painted([100, 56, 140, 80])
    for seed in range(20):
        sample = augmented_sample(panorama, (256, 96), np.random.default_rng(seed))
        assert sample.image.shape == (96, 256, 3)
        assert (sample.boxes[:, 3] - sample.boxes[:, 1]).max() > 18


def test_recolouring_with_all_ranges_closed_changes_nothing():
    image = np.random.default_rng(0).integers(0, 256, (20, 40, 3), dtype=np.uint8)
    still = AugmentationRanges(exposure=0, gamma=0, white_balance=0, saturation=(1.0, 1.0), noise=0, blur=0)
    np.testing.assert_allclose(recoloured(image, np.random.default_rng(0), still).astype(int), image, atol=1)


def entry(objects, width=1280):
    return {"file": "a.jpg", "width": width, "height": width // 2, "objects": objects}


def thing(box, fraction=1.0, label="chair"):
    return {"object": 0, "label": label, "visible_box": box, "visible_fraction": fraction}


def test_small_or_hidden_objects_are_ignored_and_unknown_labels_left_out():
    objects = [
        thing([0, 100, 50, 130]),
        thing([100, 100, 150, 129]),
        thing([200, 100, 250, 180], fraction=0.49),
        thing([300, 100, 350, 180], label="lamp"),
        thing(None, fraction=0.0),
    ]
    panorama = labelled_panorama(entry(objects), np.zeros((640, 1280, 3), np.uint8), NAMES, 1280)
    assert panorama.ignored.tolist() == [False, True, True]


def test_boxes_are_scaled_with_the_image():
    panorama = labelled_panorama(entry([thing([100, 200, 1300, 300])]), np.zeros((640, 1280, 3), np.uint8), NAMES, 1024)
    assert panorama.image.shape == (512, 1024, 3)
    np.testing.assert_allclose(panorama.boxes, [[80, 160, 1040, 240]])


def test_images_added_later_are_taken_up(tmp_path):
    folder = write_toy_folder(tmp_path / "a", 3, width=256)
    content = json.loads((folder / "boxes.json").read_text())
    (folder / "boxes.json").write_text(json.dumps({**content, "images": content["images"][:2]}))
    panoramas = PanoramaFolders([folder], NAMES, 256)
    assert len(panoramas) == 2
    (folder / "boxes.json").write_text(json.dumps(content))
    assert panoramas.refresh() == 1
    assert panoramas.refresh() == 0


def test_the_parts_of_several_processes_make_up_the_folders(tmp_path):
    folders = [write_toy_folder(tmp_path / name, 5, width=64) for name in "ab"]
    parts = [PanoramaFolders(folders, NAMES, 64, (k, 2)) for k in (0, 1)]
    assert sorted(p.file for part in parts for p in part.panoramas) == sorted(2 * [f"{i:06d}.jpg" for i in range(5)])


def test_bad_folders_are_named(tmp_path):
    with pytest.raises(TrainingDataError, match="is missing"):
        read_boxes(tmp_path)
    (tmp_path / "boxes.json").write_text('{"version": 2, "images": []}')
    with pytest.raises(TrainingDataError, match="version"):
        read_boxes(tmp_path)
    (tmp_path / "boxes.json").write_text('{"version": 1, "images"')
    with pytest.raises(TrainingDataError, match="not JSON"):
        read_boxes(tmp_path)
    (tmp_path / "boxes.json").write_text("[" * 100_000)
    with pytest.raises(TrainingDataError, match="levels"):
        read_boxes(tmp_path)
    (tmp_path / "boxes.json").write_text('{"version": 1, "images": [5]}')
    with pytest.raises(TrainingDataError, match="image 0 has no file"):
        read_boxes(tmp_path)
    (tmp_path / "boxes.json").write_text('{"version": 1, "images": []}')
    with pytest.raises(TrainingDataError, match="no image that is there"):
        PanoramaFolders([tmp_path], NAMES)
    cv2.imwrite(str(tmp_path / "a.jpg"), np.zeros((32, 64, 3), np.uint8))
    (tmp_path / "boxes.json").write_text(json.dumps({"version": 1, "images": [entry([])]}))
    with pytest.raises(TrainingDataError, match=r"64 x 32, boxes\.json says 1280 x 640"):
        PanoramaFolders([tmp_path], NAMES)
    with pytest.raises(TrainingDataError, match="a box that is none"):
        labelled_panorama(entry([thing([50, 100, 50, 130])], 64), np.zeros((32, 64, 3), np.uint8), NAMES, 64)
    for spoilt in ({}, 5, thing(5), thing([1, 2, 3]), thing(["a", 2, 3, 4]), {"label": NAMES[0]}):
        with pytest.raises(TrainingDataError, match="missing or of the wrong kind"):
            labelled_panorama(entry([spoilt], 64), np.zeros((32, 64, 3), np.uint8), NAMES, 64)
