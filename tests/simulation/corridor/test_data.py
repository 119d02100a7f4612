"""Making the data, at a reduced size: same seed, same bytes; a run that is stopped leaves the old data alone."""

import argparse
import dataclasses
import json

import numpy as np
import pytest
from course_lib.output_folder import MADE

from course_lib.depth_mcl.sequence import read_sequence
from course_lib.rendering.scene_map import SceneMap
from course_lib.simulation.corridor.data import PRODUCTS, CorridorModels, make_corridor_data
from course_lib.simulation.corridor.recorded_runs import HandModel, WagonModel
from course_lib.simulation.corridor.surface_fusion import FusionModel
from course_lib.simulation.data_folder import checksums
from course_lib.simulation.parameter_tables import field_comments, parameter_tables
from course_lib.simulation.sensors.laser_survey import ScannerModel
from tools import make_corridor as make_data

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


def test_a_file_in_the_way_is_told_at_once(tmp_path):
    (tmp_path / "taken").write_text("a file")
    for out in (tmp_path / "taken", tmp_path / "taken" / "below", tmp_path / "nowhere" / ".." / "taken"):
        with pytest.raises(ValueError, match="taken is a file"):
            make_corridor_data(out, 1, progress=lambda items, text: pytest.fail("work had begun"))


def test_a_negative_seed_is_refused():
    with pytest.raises(ValueError, match="--seed must be 0 or more; got -3"):
        make_data.run(argparse.Namespace(seed=-3, out=None))


@pytest.mark.slow
def test_all_products_are_there_and_readable(small):
    folder, summary = small
    assert {path.name for path in folder.iterdir()} == {*PRODUCTS, MADE}
    assert len(SceneMap.load(folder / "map.ply").faces) == summary["measured"]["map"]["triangles"]
    assert len(read_sequence(folder / "wagon")) == 3
    assert len(read_sequence(folder / "hand")) == 4
    assert json.loads((folder / "summary.json").read_text())["seed"] == 11


@pytest.mark.slow
def test_a_run_that_is_stopped_leaves_the_old_data_alone(small):
    folder, _ = small
    before = checksums(folder, PRODUCTS)

    def stop(items, text):
        if "recording" in text:
            raise KeyboardInterrupt
        return items

    with pytest.raises(KeyboardInterrupt):
        make_corridor_data(folder, 12, SMALL, progress=stop)
    assert checksums(folder, PRODUCTS) == before
    assert [path.name for path in folder.parent.iterdir()] == [folder.name]


MODELS = {field.name: getattr(CorridorModels(), field.name) for field in dataclasses.fields(CorridorModels)}


@pytest.mark.parametrize("name", [name for name, model in MODELS.items() if dataclasses.is_dataclass(model)])
def test_every_parameter_has_a_source_or_is_called_chosen(name):
    model = MODELS[name]
    for field, comment in field_comments(model).items():
        assert "chosen" in comment or "data sheet" in comment, field


def test_the_parameter_tables_show_the_values_used():
    text = parameter_tables(dataclasses.replace(CorridorModels(), wagon=WagonModel(frames=123)), "corridor")
    assert "| `frames` | 123 |" in text
    assert "| `frequency` | 15000000.0 | Hz" in text


def test_a_parameter_without_a_comment_is_named():
    @dataclasses.dataclass
    class Model:
        speed: float = 1.0

    with pytest.raises(ValueError, match="no comment with unit and source behind speed"):
        field_comments(Model())


@pytest.mark.slow
def test_no_measured_number_is_missing(small):
    numbers = small[1]["measured"]
    assert np.isfinite([numbers["map"]["hole_share"], numbers["wagon"]["no_return_share"]]).all()
    assert set(numbers["noise_on_a_wall_m"]) == {"2 m", "5 m", "8 m"}
