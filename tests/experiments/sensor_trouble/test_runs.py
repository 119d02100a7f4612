"""Short runs of both methods with troubles: each frame named, recovered, and no confident wrong pose."""

import math

import numpy as np
import pytest
from course_lib.experiments.sensor_trouble import depth_run, stereo_run
from course_lib.experiments.sensor_trouble.score import summary

from course_lib.beyond.guarded_depth import OUTCOMES
from course_lib.depth_mcl.sequence import read_sequence
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.scene_map import SceneMap
from course_lib.simulation.corridor.seeded_recording import building_of_data, record_seed
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.panorama import StereoRig
from tests.spherical_stereo.moved_rig import KnowingDetector, pair_from
from tests.spherical_stereo.stereo_scene import TRUE_POSE, mapped_scene
from tests.spherical_stereo.vertical_pair import BASELINE

SEED = 10_008  # for tuning: the tests' own


@pytest.fixture(scope="module")
def troubled_wagon(corridor_folder, tmp_path_factory):
    folder = tmp_path_factory.mktemp("trouble") / "wagon"
    camera = DepthCamera.sr4000().resized(44, 36)
    record_seed(folder, building_of_data(corridor_folder), SEED, camera=camera, frames=26)
    troubles = ("dropped", "black", "time backwards")
    return depth_run.troubles_of(
        read_sequence(folder), SceneMap.load(corridor_folder / "map.ply"), SEED, [0.1], "xyyaw", troubles
    )


def test_the_depth_filter_names_every_frame_and_recovers(troubled_wagon):
    told = summary([troubled_wagon], depth_run.GATE)
    assert told["undisturbed"]["false_alarms"] == told["undisturbed"]["confident_wrong"] == 0
    names = {row["trouble"]: row["outcomes"] for row in told["rows"]}
    assert names == {"dropped": {"no image": 3}, "black": {"no return": 3}, "time backwards": {"out of order": 3}}
    for row in told["rows"]:
        assert row["confident_wrong"] == 0
        assert set(row["good_frames"]) <= {"tracked", "doubtful", "lost"} <= set(OUTCOMES)
    for one in troubled_wagon["troubles"]:
        assert one["frames"][-1]["position_m"] < 0.3
        first = one["runs"][0][0]
        assert one["frames"][:first] == troubled_wagon["undisturbed"][:first], "before the trouble nothing differs"
        assert one["frames"] != troubled_wagon["undisturbed"]


def test_a_dropped_frames_pose_is_the_one_that_was_moved(troubled_wagon):
    dropped = troubled_wagon["troubles"][0]
    first = dropped["runs"][0][0]
    assert dropped["frames"][first]["position_m"] != dropped["frames"][first - 1]["position_m"]


@pytest.fixture(scope="module")
def troubled_walk():
    """A rig that goes to and fro between four places; what it moved is in its own axes, turned on the map."""
    places = [(0.0, 0.0), (0.35, 0.1), (0.1, -0.3), (-0.3, 0.1)]
    pairs = [pair_from(*place) for place in places]
    semantic_map = mapped_scene()[2]
    localizer = SemanticLocalizer(StereoRig(BASELINE), semantic_map, KnowingDetector(*pairs), association="consistent")
    poses = []
    for x, y in places:
        moved = TRUE_POSE.apply([[x, y]])[0]
        poses.append([*moved, TRUE_POSE.theta])
    order = [k % 4 for k in range(20)]
    walk = [pairs[k][:2] for k in order]
    return stereo_run.troubles_of(localizer, walk, np.array([poses[k] for k in order]), SEED, [0.1])


def test_the_stereo_method_names_every_pair(troubled_walk):
    told = summary([troubled_walk], stereo_run.GATE)
    assert told["undisturbed"] == {
        "frames": 20,
        "good_frames": {"ok": 20},
        "false_alarms": 0,
        "confident_wrong": 0,
    }
    names = {row["trouble"]: row["outcomes"] for row in told["rows"]}
    assert names["dropped"] == {"no image": 2}
    assert names["repeated"] == {"repeated": 2}
    assert names["one camera dark"] == {"blank image": 2}
    assert names["cameras exchanged"] == {"images seem swapped": 2}
    assert names["different moments"] == {"images of different moments": 2}
    assert sum(names["exposure jump"].values()) == 2
    assert all(row["confident_wrong"] == 0 for row in told["rows"])
    assert all(row["recovered"] == row["undisturbed"] for row in told["rows"])


def test_pairs_without_trouble_have_the_answers_that_they_had(troubled_walk):
    for one in troubled_walk["troubles"]:
        bad = {k for first, end in one["runs"] for k in range(first, end)}
        for k, (frame, calm) in enumerate(zip(one["frames"], troubled_walk["undisturbed"], strict=True)):
            assert (frame == calm) or k in bad


def test_poses_of_the_walk_are_right(troubled_walk):
    errors = [frame["position_m"] for frame in troubled_walk["undisturbed"]]
    assert max(errors) < 0.2
    assert math.isfinite(sum(errors))
