"""Six degrees of freedom side by side: what is pooled, thinned, and said of frames that are wrong."""

import numpy as np
import pytest

from course_lib.beyond.six_dof.poses import retract
from course_lib.beyond.six_dof.prediction import START_SPREAD
from course_lib.depth_mcl.sequence import read_sequence
from course_lib.rendering.scene_map import SceneMap
from courseware.experiments.six_degrees import ABLATIONS, StandingStill, pooled, run_frames


@pytest.fixture(scope="module")
def corridor(corridor_folder):
    return SceneMap.load(corridor_folder / "map.ply"), read_sequence(corridor_folder / "hand").thinned(30, 7)


def test_a_thinned_recording_keeps_what_belongs_together(corridor_folder):
    whole = read_sequence(corridor_folder / "hand")
    thinned = whole.thinned(8, 3)
    assert thinned.frames == whole.frames[3::8]
    assert len(thinned) == len(thinned.camera_to_world) == len(thinned.times) == 19
    assert np.array_equal(thinned.depth(2), whole.depth(19), equal_nan=True)
    assert np.array_equal(thinned.camera_to_world[2], whole.camera_to_world[19])
    assert thinned.up == whole.up
    for every, offset in ((0, 0), (8, -1), (1, len(whole))):
        with pytest.raises(ValueError, match="no frame is left"):
            whole.thinned(every, offset)


@pytest.mark.slow
def test_what_is_switched_off_is_off(corridor):
    """From frame to frame two metres: what is searched for, and how often, tells each idea's absence."""
    scene_map, sequence = corridor
    two = sequence.thinned(4)
    renders = {name: run_frames(name, scene_map, two, seed=10_001)["renders"] for name in ("annealed", *ABLATIONS)}
    assert max(renders["without refinement"]) < min(renders["annealed"])
    for name in ("without a second look", "without hypotheses"):
        assert max(renders[name]) < max(renders["annealed"])
    pose, still = np.eye(4), StandingStill(np.eye(4))
    for step in range(1, 4):
        pose = retract(pose, np.full(6, 0.1 * step))
        still.found(pose)
    assert not still.motion.any()
    assert still.spread()[0] == START_SPREAD[0]


def a_run(position, rotation, status):
    n = len(position)
    others = {"renders": [100] * n, "score": [0.5] * n, "normalized_error": [1.0] * n, "within_3_sigma": [1.0] * n}
    return {"position_m": position, "rotation_deg": rotation, "status": status, **others}


def test_frames_of_several_runs_are_pooled_not_their_medians():
    few = a_run([0.01, 0.02, 0.5], [1.0, 1.0, 1.0], ["tracked", "lost", "lost"])
    statuses = ["tracked", "lost", "tracked", "lost", "lost"]
    row = pooled([few, a_run([0.01, 0.07, 0.01, 0.04, 0.3], [1.0, 1.0, 30.0, 6.0, 1.0], statuses)])
    wanted = {"frames": 8, "median_position_m": 0.03, "within_5cm_5deg_percent": 37.5, "within_10cm_percent": 75.0}
    wanted |= {"wrong": 3, "wrong_called_lost": 2, "good": 3, "good_called_lost": 1}
    wanted |= {"most_renders": 100, "within_3_sigma_percent": 100.0}
    assert {key: row[key] for key in wanted} == pytest.approx(wanted)
