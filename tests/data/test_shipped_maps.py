"""The finale's two maps are of the room that its seed makes; the projects' rooms are of the seeds that they name."""

from pathlib import Path

import numpy as np
import pytest

from course_lib.rendering.scene_map import SceneMap
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap
from courseware.answers.project_2_task import HIDDEN_SEEDS, room_of
from courseware.experiments.room_evaluation import NO_OBJECT
from courseware.lessons.project_2.rooms import PRACTICE_SEEDS
from courseware.simulation.room.depth_world import depth_caster
from courseware.simulation.room.finale_data import SEED
from courseware.simulation.room.furnishing import make_look_alike_room
from tools.project_rooms import POSES

DATA = Path(__file__).resolve().parents[2] / "data"


def test_both_maps_are_surveys_of_the_seeds_room():
    room = make_look_alike_room(SEED)
    semantic_map = SemanticMap.load(DATA / "finale" / "semantic_map.json")
    assert [item.label for item in room.objects] == list(semantic_map.labels)
    away = semantic_map.positions - [(item.x, item.y) for item in room.objects]
    assert 0.003 < np.sqrt(np.mean(away**2)) < 0.02, "surveyed with an error of a centimetre"
    scene_map = SceneMap.load(DATA / "finale" / "map.ply")
    eye = np.append(room.walls.mean(axis=0), 1.5)
    directions = np.random.default_rng(0).standard_normal((400, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    ends = eye + depth_caster(room).cast(eye, directions).distance[:, None] * directions
    nearest = [np.linalg.norm(scene_map.vertices - end, axis=1).min() for end in ends]
    assert 0.001 < np.median(nearest) < 0.05, "noise of a survey: the map is not the room"


@pytest.mark.parametrize("seeds", [PRACTICE_SEEDS, HIDDEN_SEEDS])
def test_projects_hold_the_rooms_of_their_seeds_and_true_poses_lay_what_is_seen_on_the_map(seeds):
    rooms = [room_of(seed) for seed in seeds]
    off = []
    for room in rooms:
        assert len(room.views) == 2 * POSES
        assert room.semantic_map.labels.count(room.look_alike) >= 3
        for view in room.views:
            c, s = np.cos(view.pose[2]), np.sin(view.pose[2])
            for one, landmark in zip(view.observations, view.shows, strict=True):
                if landmark != NO_OBJECT:
                    there = np.array([[c, -s], [s, c]]) @ [one.x, one.y] + view.pose[:2]
                    off.append(np.linalg.norm(there - room.semantic_map.positions[landmark]))
    assert np.median(off) < 0.2
