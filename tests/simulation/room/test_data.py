"""Making data of rooms at a reduced size: same seed, same bytes; stopped runs harm nothing."""

import numpy as np
import pytest

from course_lib.geometry import wrap_angle
from course_lib.rendering.scene_map import SceneMap
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap
from courseware.simulation.corridor.surface_fusion import FusionModel
from courseware.simulation.data_folder import checksums
from courseware.simulation.room import finale_data
from courseware.simulation.room.data import PRODUCTS, RoomModels, make_room_data
from courseware.simulation.room.depth_world import MAP, STREAM, DepthSurveyModel, surveyed_mesh
from courseware.simulation.room.experiment_room import make_experiment_room
from courseware.simulation.room.furnishing import make_look_alike_room
from courseware.simulation.room.look_alike_recording import RecordingModels
from courseware.simulation.room.measurement_places import MEASUREMENT_PLACES
from courseware.simulation.room.stereo_recording import read_stereo_recording
from courseware.simulation.room.survey import RoomSurveyModel
from courseware.simulation.sensors.laser_survey import ScannerModel

SMALL = RoomModels(width=320, places=(3,), survey=RoomSurveyModel(places=3, width=320, fewest_pixels=10))


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    folder = tmp_path_factory.mktemp("data") / "room"
    make_room_data(folder, 11, SMALL)
    return folder


@pytest.mark.slow
def test_one_seed_gives_the_same_bytes_and_says_where_each_pair_and_object_was(small, tmp_path):
    (tmp_path / "README.md").write_text("written by hand")
    make_room_data(tmp_path, 11, SMALL)
    assert checksums(tmp_path, PRODUCTS) == checksums(small, PRODUCTS)
    assert (small / "SHA256SUMS").read_text() == checksums(small, PRODUCTS)
    assert (tmp_path / "README.md").read_text() == "written by hand"
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
    room, semantic_map = make_experiment_room(), SemanticMap.load(small / "semantic_map.json")
    assert list(semantic_map.labels) == [thing.label for thing in room.objects]
    true = np.array([[thing.x, thing.y] for thing in room.objects])
    errors = np.linalg.norm(semantic_map.positions - true, axis=1)
    assert 0 < errors.max() < 0.05
    np.testing.assert_allclose(semantic_map.walls, room.walls)


FINALE_SEED = 10_001
MESH = DepthSurveyModel(
    stations=2, scanner=ScannerModel(step_deg=2.0), fusion=FusionModel(voxel=0.1, truncation=0.3, triangles=3_000)
)
SMALL_FINALE = finale_data.FinaleModels(
    recording=RecordingModels(survey=RoomSurveyModel(width=320, fewest_pixels=5)), mesh=MESH
)


@pytest.mark.slow
def test_the_finales_maps_are_those_of_the_demos_own_room(tmp_path):
    (tmp_path / "README.md").write_text("written by hand")
    told = finale_data.make_finale_data(tmp_path, FINALE_SEED, SMALL_FINALE)
    assert checksums(tmp_path, finale_data.PRODUCTS) == (tmp_path / "SHA256SUMS").read_text()
    assert (tmp_path / "README.md").read_text() == "written by hand"
    assert told["objects"] == len(SemanticMap.load(tmp_path / "semantic_map.json"))
    # The mesh is the one that `demo finale` makes of this seed.
    rng = np.random.default_rng([STREAM, FINALE_SEED, MAP])
    vertices, _ = surveyed_mesh(make_look_alike_room(FINALE_SEED), MESH, rng)
    assert SceneMap.load(tmp_path / "map.ply").vertices == pytest.approx(vertices, abs=1e-6)
    assert "| `step_deg` | 2.0 |" in (tmp_path / "PARAMETERS.md").read_text()
