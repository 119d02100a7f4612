"""The camera that is carried by hand through a furnished room."""

import numpy as np
import pytest

from course_lib.depth_mcl.sequence import read_sequence
from course_lib.geometry import state_from_optical_pose
from course_lib.rendering.scene_map import SceneMap
from courseware.simulation.corridor.recorded_runs import steps_and_turns
from courseware.simulation.corridor.surface_fusion import FusionModel
from courseware.simulation.room.depth_world import DepthSurveyModel, WalkModel, record_walk, walk_states
from courseware.simulation.room.furnishing import make_look_alike_room
from courseware.simulation.room.scene import NoFreePlace, distance_to, footprint
from courseware.simulation.sensors.laser_survey import ScannerModel

SEEDS = (10_050, 10_051, 10_052)


@pytest.fixture(scope="module", params=SEEDS)
def walk(request):
    room = make_look_alike_room(request.param)
    return room, walk_states(room, WalkModel(), np.random.default_rng(request.param))


def test_all_six_degrees_of_freedom_move_none_jumps_and_it_keeps_clear_of_walls_and_furniture(walk):
    room, states = walk
    assert states.shape == (WalkModel().frames, 6)
    steps, turns = steps_and_turns(states)
    assert np.median(steps) == pytest.approx(0.08, rel=0.2)
    assert steps.max() < 0.12
    assert np.rad2deg(turns.max()) < 20
    assert np.linalg.norm(np.ptp(states[:, :2], axis=0)) > 1.0
    height, roll, pitch, heading = np.ptp(np.column_stack([states[:, 2:5], np.unwrap(states[:, 5])]), axis=0)
    assert height > 0.05
    assert min(roll, pitch) > 0.1
    assert heading > 1.0
    low, high = room.walls.min(axis=0), room.walls.max(axis=0)
    assert (states[:, :2] > low + 0.3).all()
    assert (states[:, :2] < high - 0.3).all()
    nearest = min(distance_to(footprint(item), states[:, :2]).min() for item in room.objects)
    assert nearest > 0.15, "corners of the way are rounded, by less than what it keeps clear"


@pytest.mark.slow
def test_one_seed_decides_every_byte_of_a_recording_and_where_nobody_can_walk_it_says_so(tmp_path):
    coarse = DepthSurveyModel(
        scanner=ScannerModel(step_deg=1.5), fusion=FusionModel(voxel=0.08, truncation=0.24, triangles=4000)
    )
    for name in ("one", "two"):
        record_walk(tmp_path / name, SEEDS[0], coarse, WalkModel(frames=3))
    files = sorted(path.relative_to(tmp_path / "one") for path in (tmp_path / "one").rglob("*") if path.is_file())
    assert {"map.ply", "poses.txt", "intrinsics.txt", "up.txt"} <= {path.name for path in files}
    for path in files:
        assert (tmp_path / "one" / path).read_bytes() == (tmp_path / "two" / path).read_bytes(), path
    recording, scene_map = read_sequence(tmp_path / "one"), SceneMap.load(tmp_path / "one" / "map.ply")
    assert len(recording) == 3
    low, high = scene_map.bounds
    assert (state_from_optical_pose(recording.camera_to_world)[:, :3] > low).all()
    assert (state_from_optical_pose(recording.camera_to_world)[:, :3] < high).all()
    assert np.isfinite(recording.depth(0)).mean() > 0.5
    room = make_look_alike_room(SEEDS[0])
    with pytest.raises(NoFreePlace, match="no walk of 120 frames"):
        walk_states(room, WalkModel(shortest_stretch=50.0), np.random.default_rng(1))
