"""Lesson 20: a reader's folders are read, misreadings show, and a chosen baseline has the error that it should."""

import cv2
import nbformat
import numpy as np
import pytest

from course_lib.depth_mcl.sequence import write_sequence
from courseware.answers.lesson_20 import baseline_needed
from courseware.lessons.lesson_20 import own_panoramas, recordings
from courseware.paths import REPOSITORY


def test_every_misreading_shows_at_the_given_poses():
    checker = recordings.Checker(recordings.recording())
    for frame in (0, 8, 20):
        right, *misread = (checker(frame, name) for name in recordings.READINGS)
        assert all(wrong.hits < 0.5 or wrong.median > 3 * right.median for wrong in misread)


def test_the_lesson_runs_on_a_recording_of_one_frame(tmp_path):
    given = recordings.recording().sequence
    write_sequence(tmp_path, given.intrinsics, [0], [given.depth(0)], given.camera_to_world[:1], up="z")
    with pytest.raises(FileNotFoundError, match=r"map\.ply"):
        recordings.recording(tmp_path)
    (tmp_path / "map.ply").symlink_to(REPOSITORY / "data/corridor/planar_map.ply")
    notebook = nbformat.read(REPOSITORY / "notebooks" / "20_your_own_data.ipynb", as_version=4)
    source, names = {cell.id: cell.source for cell in notebook.cells}, {}
    exec(source["20-mine"].replace("MY_SEQUENCE = None", f"MY_SEQUENCE = {str(tmp_path)!r}"), names)
    for cell in "imports look check-picture read-depth read-pose read-points readings filter filter-picture".split():
        exec(source[f"20-{cell}"], names)
    assert len(names["found"].frames) == 1


def test_a_readers_pair_is_read_and_what_is_missing_or_doubled_is_named(tmp_path):
    pair = own_panoramas.panorama_pair()
    cv2.imwrite(str(tmp_path / "upper.png"), pair.upper)
    with pytest.raises(FileNotFoundError, match="no lower panorama"):
        own_panoramas.panorama_pair(tmp_path, 0.25)
    cv2.imwrite(str(tmp_path / "lower.png"), pair.lower)
    assert np.array_equal(own_panoramas.panorama_pair(tmp_path, 0.25).lower, pair.lower)
    with pytest.raises(ValueError, match=r"bocks\.json is missing"):
        own_panoramas.panorama_pair(tmp_path, 0.25, tmp_path / "bocks.json")


def test_the_chosen_baseline_has_just_the_error_that_a_simulation_finds():
    baseline = baseline_needed(4.0, 0.5, 960, 0.1)
    e, rows = np.arctan(baseline / 8), np.random.default_rng(1).normal(0, 0.5 * np.pi / 960, (2, 20_000))
    assert (baseline / (np.tan(e + rows[0]) - np.tan(-e + rows[1]))).std() == pytest.approx(0.1, rel=0.03)
