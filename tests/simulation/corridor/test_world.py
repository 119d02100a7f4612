"""The true world: sizes, what it holds, how its two days differ, and that no spacing repeats."""

import numpy as np
import pytest

from course_lib.simulation.corridor import world as corridor
from course_lib.simulation.corridor.mesh_building import read_world_ply, write_world_ply
from course_lib.simulation.corridor.world import make_corridor
from course_lib.simulation.sensors.ray_casting import WorldCaster


@pytest.fixture(scope="module")
def world():
    return make_corridor(np.random.default_rng(4))


def first_hit(mesh, origin, direction):
    return float(WorldCaster.of(mesh).cast(np.array(origin), np.array([direction])).distance[0])


def test_the_corridor_is_forty_metres_long_and_has_a_floor_at_zero(world):
    low, high = world.survey_day.part_bounds("floor")
    assert (low[0], high[0]) == pytest.approx((0, 40), abs=0.05)
    assert first_hit(world.survey_day, [14.0, 0.0, 1.0], [0, 0, -1]) == pytest.approx(1.0, abs=0.006)


@pytest.mark.parametrize(
    "part",
    "door pillar window radiator bench notice_board stairs railing portal recess lamp cable_tray extinguisher "
    "exit_sign room pipe".split(),
)
def test_it_is_not_a_box(world, part):
    assert len(world.survey_day.faces_of(part.replace("_", " "))) > 0


def test_it_has_a_side_corridor_and_stairs_that_go_down_and_up(world):
    middle = sum(corridor.JUNCTION[:2]) / 2
    assert first_hit(world.survey_day, [middle + 0.4, 0.5, 0.5], [0, 1, 0]) > 4.0
    low, high = world.survey_day.part_bounds("stairs")
    assert low[2] < -1.4
    assert high[2] > 1.4


def test_windows_have_no_glass(world):
    # Through the upper part of the second window, beside its mullions.
    x = corridor.WINDOWS[1][0] + 0.3
    assert np.isinf(first_hit(world.survey_day, [x, 0.0, 1.8], [0, -1, 0]))
    assert np.isfinite(first_hit(world.survey_day, [x, 0.0, 0.5], [0, -1, 0]))


def test_features_follow_no_common_spacing():
    xs = np.sort([row[0] for row in corridor.LEFT_DOORS + corridor.RIGHT_DOORS])
    gaps = np.diff(xs)
    assert gaps.std() > 0.2 * gaps.mean()
    starts = np.diff([row[0] for row in corridor.WINDOWS])
    assert starts.std() > 0.2 * starts.mean()


def test_clutter_stands_only_on_the_run_day(world):
    assert len(world.survey_day.faces_of("clutter")) == 0
    assert len(world.run_day.faces_of("clutter")) > 1000
    kinds = {name.split()[-1] for name in world.run_day.part_names if name.startswith("clutter")}
    assert {"cartons", "person", "trolley", "plant", "bin"} <= kinds
    assert len(world.clutter_boxes) == len(corridor.CLUTTER)


def test_some_doors_stand_otherwise_on_the_run_day(world):
    moved = [
        number
        for number in range(len(corridor.LEFT_DOORS))
        if np.abs(
            world.survey_day.part_bounds(f"door {number} leaf") - world.run_day.part_bounds(f"door {number} leaf")
        ).max()
        > 0.1
    ]
    assert len(moved) == sum(row[4] != row[5] for row in corridor.LEFT_DOORS) >= 3


def test_the_building_itself_is_the_same_on_both_days(world):
    for part in ("wall", "radiator", "notice board", "cable tray"):
        survey, run = world.survey_day, world.run_day
        assert np.array_equal(survey.vertices[survey.faces[survey.faces_of(part)]],
                              run.vertices[run.faces[run.faces_of(part)]])  # fmt: skip


def test_walls_bow_by_millimetres(world):
    mesh = world.survey_day
    points = mesh.vertices[mesh.faces[mesh.faces_of("ceiling")]].reshape(-1, 3)
    assert 0.001 < np.abs(points[:, 2] - 2.6).max() <= corridor.BOW_AMPLITUDE + 1e-9


def test_closed_solids_face_outward(world):
    mesh = world.run_day
    corners = mesh.vertices[mesh.faces[mesh.faces_of("clutter 0 cartons")]]
    corners = corners - corners.reshape(-1, 3).mean(axis=0)
    volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
    assert 0.1 < volume < 0.5


def test_the_seed_decides_the_world(world):
    again, other = make_corridor(np.random.default_rng(4)), make_corridor(np.random.default_rng(5))
    assert np.array_equal(world.run_day.vertices, again.run_day.vertices)
    assert not np.array_equal(world.run_day.vertices, other.run_day.vertices)


def test_reflectivity_survives_the_file(world, tmp_path):
    write_world_ply(tmp_path / "world.ply", world.run_day, "test")
    vertices, faces, reflectivity = read_world_ply(tmp_path / "world.ply")
    assert np.allclose(vertices, world.run_day.vertices, atol=1e-5)
    assert np.array_equal(faces, world.run_day.faces)
    assert np.allclose(reflectivity, world.run_day.reflectivity, atol=1e-6)


def test_an_unknown_part_is_named(world):
    with pytest.raises(ValueError, match="no part begins with 'swimming pool'"):
        world.survey_day.part_bounds("swimming pool")
