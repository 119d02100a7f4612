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


def test_it_is_not_a_box(world):
    parts = "door,pillar,window,radiator,bench,notice board,stairs,railing,portal,recess,lamp,cable tray,extinguisher"
    for part in [*parts.split(","), "exit sign", "room", "pipe"]:
        assert len(world.survey_day.faces_of(part)) > 0, part


def test_only_doors_and_clutter_differ_between_the_days(world):
    survey, run = world.survey_day, world.run_day
    for part in ("wall", "radiator", "notice board", "cable tray"):
        one, other = (mesh.vertices[mesh.faces[mesh.faces_of(part)]] for mesh in (survey, run))
        assert np.array_equal(one, other)
    leaves = [
        np.array([mesh.part_bounds(f"door {number} leaf") for number in range(len(corridor.LEFT_DOORS))])
        for mesh in (survey, run)
    ]
    moved = np.abs(leaves[0] - leaves[1]).max(axis=(1, 2)) > 0.1
    assert moved.tolist() == [row[4] != row[5] for row in corridor.LEFT_DOORS]
    assert len(survey.faces_of("clutter")) == 0
    kinds = {name.split()[-1] for name in run.part_names if name.startswith("clutter")}
    assert kinds == {thing.kind for thing in corridor.CLUTTER}
    assert len(world.clutter_boxes) == len(corridor.CLUTTER)


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
    for rows in (corridor.LEFT_DOORS + corridor.RIGHT_DOORS, corridor.WINDOWS):
        gaps = np.diff(np.sort([row[0] for row in rows]))
        assert gaps.std() > 0.2 * gaps.mean()


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
