"""Walks through generated rooms: every thinning from every offset, the floor once."""

import numpy as np
import pytest

from course_lib.depth_mcl.sequence import read_sequence, write_sequence
from courseware.experiments import walk


@pytest.mark.slow
def test_each_offset_of_each_thinning_is_run_and_the_floor_once(corridor_folder, monkeypatch):
    """Every recording is five frames of the shipped one."""

    def record(folder, seed):
        assert seed == 10_001
        hand = read_sequence(corridor_folder / "hand")
        depths = [hand.depth(i) for i in range(5)]
        write_sequence(folder, hand.intrinsics, list(range(5)), depths, hand.camera_to_world[:5], up="z")
        (folder / "map.ply").write_bytes((corridor_folder / "map.ply").read_bytes())

    monkeypatch.setattr(walk, "record_walk", record)
    rows = walk.room_walk(10_001, ["annealed", "floor"], [1, 2])
    told = [(row["method"], row["every"], len(row["run"]["status"])) for row in rows]
    assert told == [("annealed", 1, 5), ("annealed", 2, 3), ("annealed", 2, 2), ("floor", 1, 5)]
    assert np.median(rows[0]["run"]["position_m"]) < 0.05
