"""Making the room's data and training pictures, at a reduced size: same seed, same bytes; stopped runs harm nothing."""

from __future__ import annotations

import numpy as np
import pytest

from course_lib.geometry import wrap_angle
from course_lib.simulation.data_folder import checksums
from course_lib.simulation.room.data import PRODUCTS, RoomModels, make_room_data
from course_lib.simulation.room.experiment_room import make_experiment_room
from course_lib.simulation.room.measurement_places import MEASUREMENT_PLACES
from course_lib.simulation.room.survey import RoomSurveyModel
from course_lib.simulation.room.training_images import make_room_images, read_image_list
from course_lib.spherical_stereo.recording import read_stereo_recording
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

SMALL = RoomModels(width=320, places=(3,), survey=RoomSurveyModel(places=3, width=320, fewest_pixels=10))


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    folder = tmp_path_factory.mktemp("data") / "room"
    make_room_data(folder, 11, SMALL)
    return folder


@pytest.mark.slow
def test_one_seed_gives_the_same_bytes_and_other_files_stay(small, tmp_path):
    (tmp_path / "README.md").write_text("written by hand")
    make_room_data(tmp_path, 11, SMALL)
    assert checksums(tmp_path, PRODUCTS) == checksums(small, PRODUCTS)
    assert (small / "SHA256SUMS").read_text() == checksums(small, PRODUCTS)
    assert (tmp_path / "README.md").read_text() == "written by hand"


@pytest.mark.slow
def test_the_recording_says_where_each_pair_was_taken(small):
    place = MEASUREMENT_PLACES[2]
    for number, height in ((1, 1.32), (2, 1.44)):
        recording = read_stereo_recording(small / f"experiment_{number}")
        assert (recording.rig.baseline, recording.rig.upper_height) == (0.30, height)
        assert [pair.name for pair in recording.pairs] == ["03_a", "03_b"]
        for pair, heading in zip(recording.pairs, place.headings_deg, strict=True):
            np.testing.assert_allclose(pair.pose[:2], [place.x, place.y])
            assert wrap_angle(pair.pose[2] - np.deg2rad(heading)) == pytest.approx(0.0, abs=1e-12)
            upper, lower = pair.images()
            assert upper.shape == lower.shape == (160, 320, 3)


@pytest.mark.slow
def test_the_map_lists_every_object_of_the_room_where_it_stands(small):
    room, semantic_map = make_experiment_room(), SemanticMap.load(small / "semantic_map.json")
    assert list(semantic_map.labels) == [thing.label for thing in room.objects]
    true = np.array([[thing.x, thing.y] for thing in room.objects])
    errors = np.linalg.norm(semantic_map.positions - true, axis=1)
    assert 0 < errors.max() < 0.05
    np.testing.assert_allclose(semantic_map.walls, room.walls)


@pytest.mark.slow
def test_training_pictures_go_on_where_they_stopped(tmp_path):
    make_room_images(tmp_path / "stopped", 5, 1, 1)
    images = make_room_images(tmp_path / "stopped", 5, 2, 1)
    again = make_room_images(tmp_path / "at_once", 5, 2, 1)
    assert images == again == read_image_list(tmp_path / "at_once")
    for image in images:
        assert (tmp_path / "stopped" / image["file"]).read_bytes() == (
            tmp_path / "at_once" / image["file"]
        ).read_bytes()
        assert len(image["objects"]) >= 3
        for thing in image["objects"]:
            u_min, v_min, u_max, v_max = thing["visible_box"]
            assert 0 <= u_min < 1280
            assert u_min < u_max <= u_min + 1280
            assert 0 <= v_min < v_max <= 640
