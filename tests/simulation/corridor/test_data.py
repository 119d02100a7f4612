"""Making the corridor's data, at a reduced size: same seed, same bytes; a stopped run leaves the old data alone."""

import dataclasses
import json

import numpy as np
import pytest

from course_lib.depth_mcl.sequence import read_sequence
from course_lib.rendering.scene_map import SceneMap
from course_lib.simulation.corridor.recorded_runs import HandModel, WagonModel
from course_lib.simulation.corridor.surface_fusion import FusionModel
from course_lib.simulation.data_folder import checksums, field_comments
from course_lib.simulation.sensors.laser_survey import ScannerModel
from tools.corridor_data import PRODUCTS, CorridorModels, make_corridor_data

SMALL = CorridorModels(
    scanner=ScannerModel(step_deg=0.8),
    fusion=FusionModel(voxel=0.08, truncation=0.24, triangles=8000, least_component=20),
    wagon=WagonModel(frames=3),
    hand=HandModel(frames=4),
    stations=((8.3, 0.3), (11.3, -0.4)),
)


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    folder = tmp_path_factory.mktemp("data") / "corridor"
    return folder, make_corridor_data(folder, 11, SMALL)


@pytest.mark.slow
def test_one_seed_gives_the_same_bytes_and_other_files_stay(small, tmp_path):
    folder, _ = small
    (tmp_path / "wagon").mkdir()
    (tmp_path / "wagon" / "old.txt").write_text("of an older run")
    (tmp_path / "README.md").write_text("written by hand")
    make_corridor_data(tmp_path, 11, SMALL)
    assert (tmp_path / "SHA256SUMS").read_bytes() == (folder / "SHA256SUMS").read_bytes()
    assert checksums(tmp_path, PRODUCTS) == checksums(folder, PRODUCTS)
    assert (tmp_path / "README.md").read_text() == "written by hand"
    assert not (tmp_path / "wagon" / "old.txt").exists()


@pytest.mark.slow
def test_all_products_are_there_and_readable(small):
    folder, summary = small
    assert {path.name for path in folder.iterdir()} == set(PRODUCTS)
    assert len(SceneMap.load(folder / "map.ply").faces) == summary["measured"]["map"]["triangles"]
    assert (len(read_sequence(folder / "wagon")), len(read_sequence(folder / "hand"))) == (3, 4)
    assert json.loads((folder / "summary.json").read_text())["seed"] == 11
    numbers = summary["measured"]
    assert np.isfinite([numbers["map"]["hole_share"], numbers["wagon"]["no_return_share"]]).all()
    assert set(numbers["noise_on_a_wall_m"]) == {"2 m", "5 m", "8 m"}


MODELS = {field.name: getattr(CorridorModels(), field.name) for field in dataclasses.fields(CorridorModels)}


@pytest.mark.parametrize("name", [name for name, model in MODELS.items() if dataclasses.is_dataclass(model)])
def test_every_parameter_has_a_source_or_is_called_chosen(name):
    comments = field_comments(MODELS[name])
    assert set(comments) == {field.name for field in dataclasses.fields(MODELS[name])}
    for field, comment in comments.items():
        assert "chosen" in comment or "data sheet" in comment, field
