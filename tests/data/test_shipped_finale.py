"""The finale's shipped room: two maps of the room that its seed makes."""

from pathlib import Path

import numpy as np
import pytest

from course_lib.rendering.scene_map import SceneMap
from course_lib.simulation.room.depth_world import depth_caster
from course_lib.simulation.room.finale_data import SEED
from course_lib.simulation.room.furnishing import make_look_alike_room
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

FOLDER = Path(__file__).resolve().parents[2] / "data" / "finale"


@pytest.fixture(scope="module")
def room():
    return make_look_alike_room(SEED)


def test_the_semantic_map_is_of_the_seeds_room(room):
    semantic_map = SemanticMap.load(FOLDER / "semantic_map.json")
    assert [item.label for item in room.objects] == list(semantic_map.labels)
    away = semantic_map.positions - [(item.x, item.y) for item in room.objects]
    assert 0.003 < np.sqrt(np.mean(away**2)) < 0.02, "surveyed with an error of a centimetre"


def test_the_mesh_map_is_a_survey_of_the_same_room(room):
    scene_map = SceneMap.load(FOLDER / "map.ply")
    assert len(scene_map) == 60_000
    eye = np.append(room.walls.mean(axis=0), 1.5)
    directions = np.random.default_rng(0).standard_normal((400, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    ends = eye + depth_caster(room).cast(eye, directions).distance[:, None] * directions
    nearest = [np.linalg.norm(scene_map.vertices - end, axis=1).min() for end in ends]
    assert np.median(nearest) < 0.05
    assert np.median(nearest) > 0.001, "noise of a survey: the map is not the room"
