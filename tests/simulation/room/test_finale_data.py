"""Making the finale's data at a reduced size: one seed, the same bytes; the maps of the demo's own room."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from course_lib.rendering.scene_map import SceneMap
from course_lib.simulation.corridor.surface_fusion import FusionModel
from course_lib.simulation.data_folder import checksums
from course_lib.simulation.room.depth_world import MAP, STREAM, DepthSurveyModel, surveyed_mesh
from course_lib.simulation.room.finale_data import PRODUCTS, FinaleModels, make_finale_data
from course_lib.simulation.room.furnishing import make_look_alike_room
from course_lib.simulation.room.look_alike_recording import RecordingModels
from course_lib.simulation.room.survey import RoomSurveyModel
from course_lib.simulation.sensors.laser_survey import ScannerModel
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

SEED = 10_001
MESH = DepthSurveyModel(
    stations=2,
    scanner=dataclasses.replace(ScannerModel(), step_deg=2.0),
    fusion=FusionModel(voxel=0.1, truncation=0.3, triangles=3_000),
)
SMALL = FinaleModels(recording=RecordingModels(survey=RoomSurveyModel(width=320, fewest_pixels=5)), mesh=MESH)


@pytest.mark.slow
def test_one_seed_gives_the_same_bytes_and_other_files_stay(tmp_path):
    (tmp_path / "README.md").write_text("written by hand")
    told = make_finale_data(tmp_path, SEED, SMALL)
    make_finale_data(tmp_path / "again", SEED, SMALL)
    assert checksums(tmp_path / "again", PRODUCTS) == (tmp_path / "SHA256SUMS").read_text()
    assert (tmp_path / "README.md").read_text() == "written by hand"
    assert told["objects"] == len(SemanticMap.load(tmp_path / "semantic_map.json"))
    # The mesh is the one that `demo finale` makes of this seed.
    rng = np.random.default_rng([STREAM, SEED, MAP])
    vertices, _ = surveyed_mesh(make_look_alike_room(SEED), MESH, rng)
    assert SceneMap.load(tmp_path / "map.ply").vertices == pytest.approx(vertices, abs=1e-6)
    assert "| `step_deg` | 2.0 |" in (tmp_path / "PARAMETERS.md").read_text()
