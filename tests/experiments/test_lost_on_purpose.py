"""Runs that are made to get lost are noticed, and the run that is not is left in peace."""

import numpy as np
import pytest

from course_lib.depth_mcl.sequence import read_sequence
from course_lib.experiments.lost_on_purpose import WAYS, Judged, judged_run
from course_lib.rendering.scene_map import SceneMap


@pytest.fixture(scope="module")
def corridor(corridor_folder):
    return SceneMap.load(corridor_folder / "map.ply"), read_sequence(corridor_folder / "wagon")


def test_frames_are_counted_by_what_they_are_and_what_they_were_called():
    judged = Judged(np.array([True, True, False, True]), np.array(["lost", "tracked", "tracked", "lost"]))
    assert judged.called(truly_lost=True) == {"tracked": 1, "doubtful": 0, "lost": 2}
    assert judged.called(truly_lost=False) == {"tracked": 1, "doubtful": 0, "lost": 0}


def test_a_run_that_holds_the_track_is_called_tracked(corridor):
    judged = judged_run(*corridor, WAYS["as it is"]._replace(n_particles=200), "xyyaw", seed=10301, frames=20)
    assert not judged.truly_lost.any()
    assert judged.called(truly_lost=False)["tracked"] >= 18


@pytest.mark.parametrize("name", ["kidnapped twice as far", "started a metre off", "mirrored map"])
def test_a_run_that_is_lost_is_never_called_tracked(corridor, name):
    way = WAYS[name]._replace(n_particles=30, noise=0.3)  # too little to find back
    judged = judged_run(*corridor, way, "xyyaw", seed=10302, frames=40)
    called = judged.called(truly_lost=True)
    assert judged.truly_lost.sum() >= 15
    assert called["tracked"] == 0
    assert called["lost"] >= 0.8 * judged.truly_lost.sum()
