"""Making the corridor's data of a small world, start to end: the same bytes from one seed, and no inverse crime.

The map must come from the survey day and from where registration believes the stations stood; the recording from the
run day. What the shipped files hold is asked in tests/data.
"""

import dataclasses
import json
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

from course_lib.depth_mcl.sequence import read_sequence
from course_lib.rendering.scene_map import SceneMap
from courseware.simulation.corridor.materials import WALL_PAINT
from courseware.simulation.corridor.mesh_building import MeshBuilder, Placement
from courseware.simulation.corridor.recorded_runs import HandModel, WagonModel
from courseware.simulation.corridor.surface_fusion import FusionModel
from courseware.simulation.corridor.world import TrueWorld
from courseware.simulation.data_folder import checksums, field_comments
from courseware.simulation.sensors.laser_survey import ScannerModel
from courseware.simulation.sensors.ray_casting import WorldCaster
from tools import corridor_data as data

LONG = 8.0  # m: a box of 8 x 2.4 x 2.4 m instead of the corridor
SCREEN = 5.0  # m along x: a screen across the box, there on the run day only
MODELS = data.CorridorModels(
    scanner=ScannerModel(step_deg=1.0),
    fusion=FusionModel(voxel=0.1, truncation=0.3, triangles=3000, least_component=10),
    wagon=WagonModel(frames=2, start=1.0),
    hand=HandModel(frames=3, start=1.0),
    stations=((2.0, 0.2), (4.0, -0.2)),
)


class Made(NamedTuple):
    """What was made, and the scans that fusion was given."""

    folder: Path
    summary: dict
    fused: list


def box_world(rng):
    """A box without and with the screen, in place of `make_corridor`."""
    b = MeshBuilder()
    b.box(Placement(), (0, -1.2, 0), (LONG, 1.2, 2.4), WALL_PAINT)
    survey_day = b.build()
    b.box(Placement(), (SCREEN, -1.1, 0.1), (SCREEN + 0.1, 1.1, 2.3), WALL_PAINT)
    return TrueWorld(survey_day, b.build(), clutter_boxes=np.zeros((0, 2, 2)))


@pytest.fixture(scope="module")
def make(tmp_path_factory):

    def make_data(folder=None, **scanner):
        fused = []
        fuse = data.fuse
        folder = folder or tmp_path_factory.mktemp("box") / "data"
        models = dataclasses.replace(MODELS, scanner=dataclasses.replace(MODELS.scanner, **scanner))
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(data, "make_corridor", box_world)
            patch.setattr(data, "PLANAR_MIN_AREA", 0.5)
            patch.setattr(data, "fuse", lambda scans, *rest: fused.extend(scans) or fuse(scans, *rest))
            return Made(folder, data.make_corridor_data(folder, 3, models), fused)

    return make_data


@pytest.fixture(scope="module")
def made(make):
    return make()


def ahead(path):
    """Distance from the middle of the box, 2 m from its end, to the first surface along +x."""
    scene_map = SceneMap.load(path)
    caster = WorldCaster(scene_map.vertices, scene_map.faces)
    return float(caster.cast(np.array([2.0, 0.05, 1.0]), np.array([[1.0, 0.0, 0.0]])).distance[0])


@pytest.mark.slow
def test_one_seed_gives_the_same_bytes_and_the_map_is_fused_at_believed_stations(made, make, tmp_path):
    (tmp_path / "wagon").mkdir()
    (tmp_path / "wagon" / "old.txt").write_text("of an older run")
    (tmp_path / "README.md").write_text("written by hand")
    make(tmp_path)
    assert checksums(tmp_path, data.PRODUCTS) == checksums(made.folder, data.PRODUCTS)
    assert checksums(tmp_path, data.PRODUCTS) == (made.folder / "SHA256SUMS").read_text()
    assert (tmp_path / "README.md").read_text() == "written by hand"
    assert not (tmp_path / "wagon" / "old.txt").exists()
    # Stations believed 0.2 m from where they stood bend the map; fused with their true poses it would not be bent.
    straight, bent = (one.summary["measured"]["map"] for one in (made, make(registration_position=0.2)))
    assert straight["registration"]["rms_station_position_error_m"] < 0.01
    assert bent["registration"]["rms_station_position_error_m"] > 0.1
    assert bent["distance_to_surveyed_world"]["median_m"] > 0.03
    assert bent["distance_to_surveyed_world"]["median_m"] > 5 * straight["distance_to_surveyed_world"]["median_m"]


@pytest.mark.parametrize("name", ["scanner", "fusion", "camera", "wagon", "hand", "floor_survey"])
def test_every_parameter_has_a_source_or_is_called_chosen(name):
    model = getattr(data.CorridorModels(), name)
    comments = field_comments(model)
    assert set(comments) == {field.name for field in dataclasses.fields(model)}
    for field, comment in comments.items():
        assert "chosen" in comment or "data sheet" in comment, field


def test_all_products_are_there_the_map_of_the_survey_day_without_true_poses_the_recordings_of_the_run_day(made):
    assert ahead(made.folder / "map.ply") == pytest.approx(LONG - 2.0, abs=0.1)
    assert ahead(made.folder / "planar_map.ply") == pytest.approx(LONG - 2.0, abs=0.1)
    assert ahead(made.folder / "true_world.ply") == pytest.approx(SCREEN - 2.0, abs=0.01)
    for name in ("wagon", "hand"):
        sequence = read_sequence(made.folder / name)
        middle = sequence.depth(0)[62:82, 78:98]
        assert np.nanmedian(middle) < SCREEN - sequence.camera_to_world[0, 0, 3] + 0.6
    assert len(made.fused) == 2
    assert not any(hasattr(scan, "true_pose") for scan in made.fused)
    folder, numbers = made.folder, made.summary["measured"]
    assert {path.name for path in folder.iterdir()} == set(data.PRODUCTS)
    assert len(SceneMap.load(folder / "map.ply").faces) == numbers["map"]["triangles"]
    assert (len(read_sequence(folder / "wagon")), len(read_sequence(folder / "hand"))) == (2, 3)
    assert json.loads((folder / "summary.json").read_text())["seed"] == 3
    assert np.isfinite([numbers["map"]["hole_share"], numbers["wagon"]["no_return_share"]]).all()
    assert set(numbers["noise_on_a_wall_m"]) == {"2 m", "5 m", "8 m"}
