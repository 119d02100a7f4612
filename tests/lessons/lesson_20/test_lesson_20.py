"""Lesson 20: a reader's folders are read, misreadings show, and the stand-in is the same with and without real data."""

import shutil
from pathlib import Path

import cv2
import nbformat
import numpy as np
import pytest

from course_lib.depth_mcl.motion import TANGENT_SPACE
from course_lib.depth_mcl.sequence import read_sequence, write_sequence
from course_lib.lessons.lesson_20.exercises import baseline_needed
from course_lib.lessons.lesson_20.own_panoramas import (
    AmbiguousFileError,
    MissingBaselineError,
    MissingPanoramaError,
    NoNearFeatureError,
    distances_table,
    fit_text,
    measured_objects,
    near_features,
    panorama_pair,
)
from course_lib.lessons.lesson_20.panel import reading_panel
from course_lib.lessons.lesson_20.readings import (
    READINGS,
    Checker,
    MissingMapError,
    Recording,
    compare_readings,
    misread_run,
    readings_table,
    recording,
)
from course_lib.paths import REPOSITORY
from course_lib.spherical_stereo.detection.detected_object import DetectionError
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.matching.features import detect_features, match_features
from course_lib.spherical_stereo.matching.object_matching import match_objects
from course_lib.spherical_stereo.panorama import StereoRig

RIGHT = "as the formats say"
REAL_BOXES = REPOSITORY / "tests" / "spherical_stereo" / "panorama_room_boxes.json"


@pytest.fixture(scope="module")
def stand_in() -> Recording:
    return recording()


@pytest.fixture(scope="module")
def checker(stand_in) -> Checker:
    return Checker(stand_in)


@pytest.fixture(scope="module")
def pair():
    return panorama_pair()


def own_folder(stand_in: Recording, folder: Path) -> Path:
    """A reader's folder: the stand-in's first three frames, and the corridor's simpler map."""
    sequence = stand_in.sequence
    depths = [sequence.depth(index) for index in range(3)]
    write_sequence(folder, sequence.intrinsics, sequence.frames[:3], depths, sequence.camera_to_world[:3])
    shutil.copy(REPOSITORY / "data" / "corridor" / "planar_map.ply", folder / "map.ply")
    return folder


def test_read_as_the_formats_say_the_stand_in_agrees_with_its_map(checker):
    compared = checker(8)
    assert compared.median < 0.03
    assert compared.hits > 0.9


@pytest.mark.parametrize("reading", [name for name in READINGS if name != RIGHT])
@pytest.mark.parametrize("frame", [0, 20])
def test_every_misreading_shows_at_the_given_poses(checker, reading, frame):
    right, wrong = checker(frame), checker(frame, reading)
    assert wrong.hits < 0.5 or wrong.median > 3 * right.median


def test_a_camera_that_was_moved_disagrees_more(checker):
    assert checker(8, shift=0.2).median > 1.5 * checker(8).median


def test_a_readers_folder_is_read_with_its_own_map(stand_in, tmp_path):
    mine = recording(own_folder(stand_in, tmp_path))
    assert len(mine.sequence) == 3
    assert len(mine.scene_map.faces) < len(stand_in.scene_map.faces)
    assert mine.name == tmp_path.name


def test_a_folder_without_a_map_is_named(stand_in, tmp_path):
    (own_folder(stand_in, tmp_path) / "map.ply").unlink()
    with pytest.raises(MissingMapError, match=r"map\.ply"):
        recording(tmp_path)


def test_a_map_beside_its_materials_is_the_map_and_two_maps_are_named(stand_in, tmp_path):
    write_sequence(tmp_path, stand_in.sequence.intrinsics, [0], [stand_in.sequence.depth(0)], np.eye(4)[None])
    (tmp_path / "map.mtl").write_text("newmtl wall\n")
    (tmp_path / "map.obj").write_text("mtllib map.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    assert len(recording(tmp_path).scene_map) == 1
    (tmp_path / "map.ply").write_text("ply\n")
    with pytest.raises(MissingMapError, match=r"2 maps in .*map\.obj and map\.ply"):
        recording(tmp_path)


def test_a_recording_of_few_frames_is_misread_as_far_as_it_goes(stand_in):
    short = stand_in._replace(sequence=stand_in.sequence.thinned(60))
    assert 1 < len(short.sequence) < 8
    run = misread_run(short, "depth: 5000 units a metre", frames=8, n_particles=4, seed=1)
    assert len(run.frames) == len(short.sequence)


def test_the_lesson_runs_on_a_recording_of_one_frame(stand_in, tmp_path, monkeypatch):
    """Its cells up to the filter's picture, as a reader runs them who tries a single depth image first."""
    monkeypatch.chdir(tmp_path)
    sequence = stand_in.sequence
    depths = [sequence.depth(0)]
    write_sequence(tmp_path / "mine", sequence.intrinsics, [0], depths, sequence.camera_to_world[:1], up="z")
    shutil.copy(REPOSITORY / "data" / "corridor" / "planar_map.ply", tmp_path / "mine" / "map.ply")
    run = ["20-imports", "20-mine", "20-look", "20-check-picture", "20-read-depth", "20-read-pose", "20-read-points"]
    run += ["20-readings", "20-filter", "20-filter-picture"]
    notebook = nbformat.read(REPOSITORY / "notebooks" / "20_your_own_data.ipynb", as_version=4)
    source = {cell.id: cell.source for cell in notebook.cells}
    names: dict = {}
    for cell in run:
        exec(source[cell], names)
        names |= {"MY_SEQUENCE": str(tmp_path / "mine")} if cell == "20-mine" else {}
    assert len(names["found"].frames) == len(names["sequence"]) == 1
    panel = reading_panel(names["mine"])
    assert panel.draw(**panel.defaults() | {"frame": panel.controls["frame"].maximum}).alt.startswith("Frame 0,")


def test_a_folder_that_is_not_there_is_named(tmp_path):
    with pytest.raises(FileNotFoundError, match="nowhere"):
        recording(tmp_path / "nowhere")


def test_a_wrong_unit_gives_poses_and_a_low_score(stand_in):
    options = {"sigma": [0.05] * 3 + [0.03] * 3, "n_particles": 15, "seed": 1, "motion": TANGENT_SPACE}
    right = misread_run(stand_in, RIGHT, frames=2, **options)
    wrong = misread_run(stand_in, "depth: 5000 units a metre", frames=2, **options)
    assert np.isfinite(wrong.camera_to_world).all()
    assert wrong.scores.max() < 0.5 * right.scores.min()


def test_the_table_of_readings_tells_numbers_with_their_spread(checker):
    lines = readings_table(compare_readings(checker, [0, 8])).splitlines()
    assert len(lines) == 1 + len(READINGS)
    both = sorted(checker(frame).median for frame in (0, 8))
    assert f"{np.median(both):.3f} m ({both[0]:.3f} to {both[1]:.3f})" in lines[1]
    assert "no number" in next(line for line in lines if line.startswith("poses: world to camera"))


def test_a_readers_pair_is_read_and_what_is_missing_is_named(pair, tmp_path):
    with pytest.raises(MissingPanoramaError, match="upper"):
        panorama_pair(tmp_path, 0.3)
    cv2.imwrite(str(tmp_path / "upper.jpg"), pair.upper)
    cv2.imwrite(str(tmp_path / "lower.png"), pair.lower)
    with pytest.raises(MissingBaselineError, match="above the lower"):
        panorama_pair(tmp_path)
    mine = panorama_pair(tmp_path, 0.25)
    assert mine.rig == StereoRig(0.25)
    assert (list(mine.upper_detections), mine.semantic_map) == ([], None)
    assert np.array_equal(mine.lower, pair.lower)
    pair.semantic_map.save(tmp_path / "map.csv")
    assert len(panorama_pair(tmp_path, 0.25).semantic_map) == len(pair.semantic_map)


def test_files_that_are_named_or_doubled_are_not_passed_over(pair, tmp_path):
    """Else a slip in the name of the boxes gave no boxes, and one of two maps was taken without a word."""
    cv2.imwrite(str(tmp_path / "upper.png"), pair.upper)
    cv2.imwrite(str(tmp_path / "lower.png"), pair.lower)
    with pytest.raises(DetectionError, match=r"bocks\.json is missing"):
        panorama_pair(tmp_path, 0.25, tmp_path / "bocks.json")
    (tmp_path / "boxes.json").symlink_to(tmp_path / "nowhere")
    with pytest.raises(DetectionError, match=r"boxes\.json is missing"):
        panorama_pair(tmp_path, 0.25)
    (tmp_path / "boxes.json").unlink()
    for name in ("map.json", "map.csv"):
        pair.semantic_map.save(tmp_path / name)
    with pytest.raises(AmbiguousFileError, match=r"map\.json and map\.csv"):
        panorama_pair(tmp_path, 0.25)
    shutil.copy(tmp_path / "upper.png", tmp_path / "upper.jpg")
    with pytest.raises(AmbiguousFileError, match=r"upper\.png and upper\.jpg"):
        panorama_pair(tmp_path, 0.25)


def test_a_wrong_baseline_shows_in_the_residuals_and_nowhere_else(pair):
    matches = [
        (i, j)
        for i, above in enumerate(pair.upper_detections)
        for j, below in enumerate(pair.lower_detections)
        if above.label == below.label and abs(np.mean(above.box[::2]) - np.mean(below.box[::2])) < 10
    ]
    found = {
        baseline: SemanticLocalizer(
            StereoRig(baseline), pair.semantic_map, reject_implausible=False
        ).localize_detections(pair.upper_detections, pair.lower_detections, matches)
        for baseline in (0.3, 0.2)
    }
    residuals = {key: np.median(np.linalg.norm(one.residuals, axis=1)) for key, one in found.items()}
    assert all(one.status == "ok" for one in found.values())
    assert residuals[0.2] > 3 * residuals[0.3]
    assert "position wrong by" in fit_text(found[0.2], pair.true_pose)
    assert "pose (" in fit_text(found[0.3], None)


@pytest.mark.parametrize(("distance", "row_error", "height", "limit"), [(4.0, 0.5, 960, 0.1), (2.0, 1.5, 512, 0.03)])
def test_the_chosen_baseline_has_just_the_error_that_a_simulation_finds(distance, row_error, height, limit):
    baseline = baseline_needed(distance, row_error, height, limit)
    e = np.arctan(baseline / (2 * distance))
    rows = np.random.default_rng(1).normal(0, row_error, (2, 20_000))
    found = baseline / (np.tan(e + np.pi * rows[0] / height) - np.tan(-e + np.pi * rows[1] / height))
    assert found.std() == pytest.approx(limit, rel=0.03)


def test_no_baseline_is_chosen_where_none_is_good_enough():
    assert np.isnan(baseline_needed(8.0, 2.0, 512, 0.05))


def test_no_boxes_give_no_distances_but_a_sentence(pair):
    assert distances_table(measured_objects(pair, [])).startswith("0 objects")


def test_a_pair_without_a_near_feature_is_named(pair, rng):
    """Two strangers; two blank images; and one image twice, in which everything is at infinity."""
    strangers = [rng.integers(0, 255, pair.upper.shape, dtype=np.uint8) for _ in "ul"]
    blank = np.full_like(pair.upper, (90, 60, 30))
    for images in (strangers, [blank, blank], [pair.upper, pair.upper]):
        with pytest.raises(NoNearFeatureError, match="none of them nearer than 50 baselines: are both images sharp"):
            near_features(match_features(*map(detect_features, images)))
    found = match_features(detect_features(pair.upper), detect_features(pair.lower))
    assert (found.vertical_disparity[near_features(found)] > 0.02).all()
    assert found.epipolar[near_features(found)].all()


def test_the_stored_lesson_is_that_of_the_stand_in():
    """Its outputs must come out the same whether or not real data lies beside the project."""
    notebook = nbformat.read(REPOSITORY / "notebooks" / "20_your_own_data.ipynb", as_version=4)
    (cell,) = [cell for cell in notebook.cells if cell.id == "20-mine"]
    chosen: dict = {}
    exec(cell.source, chosen)
    assert all(value is None for name, value in chosen.items() if name.startswith("MY_"))
    assert all("shared/real" not in cell.source for cell in notebook.cells)


def test_the_real_recording_agrees_with_its_map(kitchen_folder):
    kitchen = recording(kitchen_folder)
    assert read_sequence(kitchen_folder).up is None
    check = Checker(kitchen)
    assert check(20).median < 0.03
    assert all(check(20, name).hits < 0.5 or check(20, name).median > 0.04 for name in READINGS if name != RIGHT)


def test_the_real_pair_is_measured():
    folder = REPOSITORY.parent / "shared" / "real" / "panorama_room"
    if not folder.is_dir():
        pytest.skip(f"the real pair is not here ({folder}); it is not part of the repository")
    mine = panorama_pair(folder, 0.2, REAL_BOXES)
    matches = match_objects(mine.upper, mine.upper_detections, mine.lower, mine.lower_detections, mine.rig)
    ranges = [one.disparity.horizontal_range_m for one in measured_objects(mine, matches)]
    assert len(ranges) >= 14
    assert 1.0 < np.median(ranges) < 4.0
