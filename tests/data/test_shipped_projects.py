"""The rooms of projects P2 and P3 are of the seeds that the projects name."""

from pathlib import Path

import numpy as np
import pytest

from course_lib.experiments.room_evaluation import NO_OBJECT
from course_lib.lessons.project_2.rooms import POSES, SEEDS, project_rooms

FOLDER = Path(__file__).resolve().parents[2] / "data" / "projects"
FILES = {name: FOLDER / f"rooms_{name}.json" for name in SEEDS}


@pytest.mark.parametrize("name", SEEDS)
def test_they_hold_the_rooms_of_their_seeds(name):
    rooms = project_rooms(FILES[name])
    assert tuple(room.seed for room in rooms) == SEEDS[name]
    assert all(len(room.views) == 2 * POSES for room in rooms)
    assert all(room.semantic_map.labels.count(room.look_alike) >= 3 for room in rooms)


def test_the_truth_belongs_to_the_views():
    """Observations laid on the map by the true pose lie where the landmarks are that they show."""
    off = []
    for room in project_rooms(FILES["practice"]):
        for view in room.views:
            c, s = np.cos(view.pose[2]), np.sin(view.pose[2])
            for one, landmark in zip(view.observations, view.shows, strict=True):
                if landmark != NO_OBJECT:
                    there = np.array([[c, -s], [s, c]]) @ [one.x, one.y] + view.pose[:2]
                    off.append(np.linalg.norm(there - room.semantic_map.positions[landmark]))
    assert len(off) > 150
    assert np.median(off) < 0.2
