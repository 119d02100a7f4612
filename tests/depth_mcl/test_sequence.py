"""Recordings: what is written is read, and what does not fit is named."""

import shutil

import cv2
import numpy as np
import pytest

from course_lib.depth_mcl.sequence import read_sequence, write_sequence
from course_lib.depth_mcl.sequence_files import (
    SequenceError,
    read_depth_png,
    read_pose,
    read_tum,
    write_depth_png,
    write_tum,
)
from course_lib.geometry import UP_AXES, optical_pose, rotation_to_z_up, state_from_optical_pose
from tests.rendering.shapes import SMALL, random_states


@pytest.fixture
def folder(tmp_path, rng):
    depths = [np.where(rng.random(SMALL.shape) < 0.1, np.nan, rng.uniform(0.5, 9, SMALL.shape)) for _ in range(4)]
    poses = optical_pose(random_states(4, rng))
    path = np.column_stack([np.arange(5.0), np.zeros((5, 2))])
    write_sequence(tmp_path / "run", SMALL.matrix, [2, 5, 7, 9], depths, poses, np.arange(4) / 10, "z", path)
    return tmp_path / "run"


def test_what_is_written_is_read(folder):
    sequence = read_sequence(folder)
    assert sequence.frames == [2, 5, 7, 9]
    assert (sequence.up, sequence.image_shape) == ("z", SMALL.shape)
    assert np.allclose(sequence.intrinsics, SMALL.matrix, atol=1e-6)
    assert np.allclose(sequence.times, [0, 0.1, 0.2, 0.3])
    assert sequence.path_on_floor.shape == (5, 3)
    assert [frame for frame, _, _ in sequence] == sequence.frames
    camera = sequence.camera(near=0.3, far=7.0)
    assert (camera.near, camera.far, camera.shape) == (0.3, 7.0, SMALL.shape)
    assert sequence.thinned(2, 1).frames == [5, 9]
    assert np.array_equal(sequence.thinned(2, 1).camera_to_world, sequence.camera_to_world[1::2])


def test_depth_survives_to_half_a_millimetre_and_nan_stays_nan_and_trajectories_survive(tmp_path, rng):
    depth = rng.uniform(0.01, 60, (20, 30))
    depth[3, 4] = np.nan
    depth[5, 6] = 70.0  # more than 16 bits of millimetres hold
    write_depth_png(tmp_path / "d.png", depth)
    again = read_depth_png(tmp_path / "d.png")
    assert np.isnan(again[[3, 5], [4, 6]]).all()
    assert np.isnan(again).sum() == 2
    assert np.nanmax(np.abs(again - depth)[np.isfinite(again)]) <= 0.000505  # and the last digit of float32
    poses, times = optical_pose(random_states(9, rng)), np.sort(rng.random(9))
    write_tum(tmp_path / "t.txt", times, poses)
    read_times, read_poses = read_tum(tmp_path / "t.txt")
    assert np.allclose(read_times, times, atol=1e-8)
    assert np.allclose(read_poses, poses, atol=1e-7)


def test_nothing_is_written_where_lengths_differ_or_a_recording_stands_and_listed_images_exist(folder, tmp_path):
    with pytest.raises(ValueError, match="agree"):
        write_sequence(tmp_path / "new", SMALL.matrix, [1, 2], [np.ones(SMALL.shape)], np.eye(4)[None])
    assert not (tmp_path / "new").exists()
    for frames, sizes, said in (([2, 1], [(4, 4), (4, 4)], "ascend"), ([1, 2], [(4, 4), (4, 5)], "one size")):
        with pytest.raises(ValueError, match=said):
            write_sequence(tmp_path / "new", SMALL.matrix, frames, [np.ones(s) for s in sizes], [np.eye(4)] * 2)
        assert not (tmp_path / "new").exists()
    (folder / "poses.txt").unlink()  # what an interrupted write leaves
    with pytest.raises(ValueError, match="already"):
        write_sequence(folder, SMALL.matrix, [1], [np.ones(SMALL.shape)], np.eye(4)[None])
    (folder / "depth.txt").write_text("0.0 depth/000002.png\n0.1 depth/nowhere.png\n0.2 depth\n0.3 " + 900 * "1")
    with pytest.raises(SequenceError, match=r"names 3 images that are no files, depth/nowhere\.png in row 2"):
        read_sequence(folder)


def frame_5(f, row):
    lines = (f / "poses.txt").read_text().splitlines()
    (f / "poses.txt").write_text("\n".join([*lines[:2], row, *lines[3:]]))


def truncate_an_image(f):
    image = f / "depth" / "000002.png"
    image.write_bytes(image.read_bytes()[:60])


@pytest.mark.parametrize(
    ("damage", "said"),
    [
        (lambda f: frame_5(f, "6 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"), "other frames"),
        (lambda f: (f / "depth" / "000005.png").unlink(), "other frames"),
        (lambda f: frame_5(f, "5 1 2 3"), "poses"),
        (lambda f: frame_5(f, "5 " + " ".join(["2"] * 16)), "frame 5"),
        (lambda f: (f / "poses.txt").write_text("# nothing\n"), "poses"),
        (lambda f: (f / "intrinsics.txt").write_text("1 2\n3 4\n"), "3 x 3"),
        (lambda f: np.savetxt(f / "intrinsics.txt", [[500, 0, 300], [0, 500, 200], [0, 0, 1]]), "another image size"),
        (lambda f: (f / "up.txt").write_text("north"), r"up\.txt"),
        (truncate_an_image, "complete"),
        (lambda f: (f / "groundtruth.txt").write_text("0 0 0 0 0 0 0 1\n"), "same"),
        (lambda f: (f / "path_on_floor.txt").write_text("1 2\n"), "x y z"),
        (lambda f: (f / "path_on_floor.txt").write_text("# x y z, metres; 2 rows\n1 2 3\n"), "announces 2 rows"),
        (lambda f: (f / "path_on_floor.txt").write_text("# x y z, metres; 1 rows\n1 2 3"), "is not complete"),
        (lambda f: [p.rename(p.with_name("cam0_" + p.name)) for p in (f / "depth").glob("*.png")], "first number"),
        (lambda f: write_depth_png(f / "depth" / "000007.png", np.ones((10, 10))), "one image size"),
        (lambda f: cv2.imwrite(str(f / "depth" / "000005.png"), np.ones((4, 4), np.uint8)), "16-bit"),
        (lambda f: shutil.rmtree(f), "no sequence"),
    ],
)
def test_a_damaged_recording_is_named(folder, damage, said):
    damage(folder)
    with pytest.raises((SequenceError, FileNotFoundError), match=said):
        list(read_sequence(folder))


def test_depth_is_in_the_units_told_and_a_recording_without_truth_is_read_and_says_so_where_truth_is_asked_for(folder):
    millimetres, fifths = read_sequence(folder), read_sequence(folder, units_per_metre=5000)
    assert np.allclose(fifths.depth(1), millimetres.depth(1) / 5, equal_nan=True)
    for bad in (0, -1000, np.nan, np.inf):
        with pytest.raises(ValueError, match="units"):
            read_sequence(folder, units_per_metre=bad)
    (folder / "poses.txt").unlink()
    sequence = read_sequence(folder)
    assert not sequence.has_poses
    assert sequence.frames == [2, 5, 7, 9]
    assert [pose for _, _, pose in sequence] == [None] * 4
    assert sequence.times is None  # the truth file's; it does not stand alone
    with pytest.raises(SequenceError, match=r"no poses\.txt.*--start"):
        _ = sequence.camera_to_world


@pytest.fixture
def tum_folder(folder):
    """The same recording as the TUM RGB-D dataset has it; the third image was taken while nobody saw the camera."""
    rows = [f"{1305031102 + i / 30:.6f} depth/{1305031102 + i / 30:.6f}.png" for i in range(4)]
    for name, row in zip(("000002", "000005", "000007", "000009"), rows, strict=True):
        (folder / "depth" / f"{name}.png").rename(folder / row.split()[1])
    (folder / "depth.txt").write_text("# depth maps\n" + "\n".join(rows))
    poses = read_tum(folder / "groundtruth.txt")[1]
    write_tum(folder / "groundtruth.txt", 1305031102 + np.array([-0.01, 0.034, 0.5, 0.11]), poses)
    (folder / "poses.txt").unlink()
    return folder, poses


def test_a_folder_of_the_tum_dataset_is_read_by_its_times(tum_folder):
    folder, poses = tum_folder
    sequence = read_sequence(folder, units_per_metre=5000)
    assert sequence.frames == [1, 2, 4]
    assert np.allclose(sequence.camera_to_world, poses[[0, 1, 3]], atol=1e-6)
    assert np.allclose(sequence.times - 1305031102, [0, 1 / 30, 0.1], atol=1e-5)
    assert sequence.depth(2).shape == SMALL.shape
    (folder / "groundtruth.txt").unlink()
    sequence = read_sequence(folder)
    assert (len(sequence), len(sequence.times), sequence.has_poses) == (4, 4, False)


@pytest.mark.parametrize("sign", [1, -1], ids=["the force that holds it", "gravity"])
def test_an_accelerometer_tells_what_is_down_at_the_time_of_every_image(tum_folder, sign):
    """Two hundred samples a second; down turns steadily, and the hand shakes."""
    folder, _ = tum_folder
    times = 1305031102 + np.arange(-100, 120) / 200
    turned = 0.5 * (times - 1305031102)
    down = np.column_stack([np.sin(turned), np.cos(turned), 0.1 * np.ones(len(times))])
    shaken = 9.81 * down + 3 * np.sin(80 * times)[:, None]
    rows = np.column_stack([times, -sign * shaken])[::-1]  # in no order
    np.savetxt(folder / "accelerometer.txt", rows, fmt="%.6f", header="accelerometer data\ntimestamp ax ay az")
    sequence = read_sequence(folder)
    assert sequence.gravity.shape == (3, 3)
    found = sequence.gravity / np.linalg.norm(sequence.gravity, axis=1, keepdims=True)
    angles = 0.5 * (sequence.times - 1305031102)
    expected = np.column_stack([np.sin(angles), np.cos(angles), 0.1 * np.ones(3)]) / np.hypot(1, 0.1)
    assert np.arccos(np.sum(found * expected, axis=1)).max() < np.deg2rad(2.5)
    (folder / "gravity.txt").write_text("1 0 0 1\n2 0 0 1\n4 0 0 1\n")
    assert (read_sequence(folder).gravity == [0, 0, 1]).all(), "gravity.txt is meant for these frames, so it goes first"


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        ("1305031102 0 1", "rows of 4 numbers"),
        ("1305031102 0 0 0", "an acceleration, not zero"),
        ("1305031000 0 1 0", "within 0.5 s of every image; the largest gap is 102.1 s"),
    ],
)
def test_an_accelerometer_that_cannot_be_used_is_named(tum_folder, rows, said):
    (tum_folder[0] / "accelerometer.txt").write_text(rows + "\n")
    with pytest.raises(SequenceError, match=said):
        read_sequence(tum_folder[0])


@pytest.mark.parametrize(
    ("damage", "said"),
    [
        (lambda f: (f / "depth.txt").write_text("one line too few words\n"), "a time and a file name"),
        (lambda f: (f / "depth.txt").write_text("# nothing\n"), "names no image"),
        (lambda f: write_tum(f / "groundtruth.txt", [7.0], np.eye(4)[None]), "within 0.02 s"),
    ],
)
def test_a_damaged_tum_folder_is_named(tum_folder, damage, said):
    damage(tum_folder[0])
    with pytest.raises(SequenceError, match=said):
        read_sequence(tum_folder[0])


def test_a_pose_is_read_from_a_matrix_poses_or_a_trajectory_and_with_few_digits_is_a_rotation(folder, tmp_path):
    first = read_sequence(folder).camera_to_world[0]
    np.savetxt(tmp_path / "matrix.txt", first, fmt="%.6f")
    for path in (tmp_path / "matrix.txt", folder / "poses.txt", folder / "groundtruth.txt"):
        assert np.allclose(read_pose(path), first, atol=1e-5)
    for matrix in (np.ones((4, 4)), np.eye(3), np.diag([1, 1, 1, 2])):
        np.savetxt(tmp_path / "matrix.txt", matrix)
        with pytest.raises(SequenceError, match="must hold a pose"):
            read_pose(tmp_path / "matrix.txt")
    rows = np.loadtxt(folder / "poses.txt")
    np.savetxt(folder / "poses.txt", rows, fmt=["%d"] + ["%.4f"] * 16)
    (folder / "groundtruth.txt").unlink()
    states = state_from_optical_pose(read_sequence(folder).camera_to_world)
    assert np.allclose(optical_pose(states), rows[:, 1:].reshape(-1, 4, 4), atol=2e-4)
    for up, axis in UP_AXES.items():
        rotation = rotation_to_z_up(up)[:3, :3]
        assert np.array_equal(rotation @ axis, [0, 0, 1])
        assert np.linalg.det(rotation) == pytest.approx(1)
