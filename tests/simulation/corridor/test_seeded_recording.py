"""A seed's own recording: what the seed decides, what a hardship changes, and what the filter is told."""

import numpy as np
import pytest

from course_lib.depth_mcl.sequence import read_sequence
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.scene_map import SceneMap
from courseware.simulation.corridor.seeded_recording import HARDSHIPS, building_of_data, record_seed
from courseware.simulation.corridor.world import run_day

CAMERA = DepthCamera.sr4000().resized(22, 18)


@pytest.fixture(scope="module")
def building(corridor_folder):
    return building_of_data(corridor_folder)


@pytest.fixture(scope="module")
def record(building, tmp_path_factory):

    def make(seed, hardships=()):
        folder = tmp_path_factory.mktemp("recording") / "run"
        record_seed(folder, building, seed, hardships, camera=CAMERA, frames=3)
        return read_sequence(folder)

    return make


@pytest.fixture(scope="module")
def plain(record):
    return record(10_010)


def images(sequence):
    return np.stack([sequence.depth(i) for i in range(len(sequence))])


@pytest.mark.slow
def test_a_seed_gives_one_recording_in_the_shipped_building(record, plain, building, corridor_folder):
    again, other = record(10_010), record(10_011)
    assert np.array_equal(images(again), images(plain), equal_nan=True)
    assert np.array_equal(again.camera_to_world, plain.camera_to_world)
    assert abs(other.camera_to_world[0, 0, 3] - plain.camera_to_world[0, 0, 3]) > 0.1
    assert np.ptp([len(s.path_on_floor) for s in (plain, other)]) > 0
    shipped = SceneMap.load(corridor_folder / "true_world.ply").vertices
    mine, _ = run_day(building, [0.0] * 7, [])
    found = set(map(tuple, np.round(shipped, 3).tolist()))
    assert np.mean([tuple(vertex) in found for vertex in np.round(mine.vertices, 3).tolist()]) > 0.9


@pytest.mark.parametrize("hardship", [h for h in HARDSHIPS if h != "pushed by hand"])
@pytest.mark.slow
def test_an_error_of_the_camera_changes_the_images_and_not_what_is_told(hardship, record, plain):
    harder = record(10_010, (hardship,))
    assert not np.array_equal(images(harder), images(plain), equal_nan=True)
    assert np.nanmedian(np.abs(images(harder) - images(plain))) < 0.1
    assert np.array_equal(harder.camera_to_world, plain.camera_to_world)
    assert np.array_equal(harder.intrinsics, plain.intrinsics)
    assert harder.intrinsics == pytest.approx(CAMERA.matrix, abs=1e-5)
