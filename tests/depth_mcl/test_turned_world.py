"""A filter that knows no direction of the world: the corridor drawn at any angle on the map is the same corridor."""

import numpy as np
import pytest

from course_lib.depth_mcl.evaluation import timed_error
from course_lib.depth_mcl.localizer import MonteCarloLocalizer
from course_lib.depth_mcl.motion import WORLD_AXES
from course_lib.depth_mcl.sequence import read_sequence
from course_lib.geometry import pose_matrix, state_from_matrix, state_from_optical_pose
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap
from course_lib.rendering.sensor import subsample_depth

FRAMES = 90
LOST = 0.5  # metres; the wagon goes 8.6 m


@pytest.fixture(scope="module")
def stretch(corridor_folder):
    """Map, camera, depth images `(T, 26, 32)` and true states of the wagon's first 90 frames."""
    sequence = read_sequence(corridor_folder / "wagon")
    camera = sequence.camera()
    small = camera.resized(32, 26)
    depths = [subsample_depth(sequence.depth(i), camera, small) for i in range(FRAMES)]
    scene_map = SceneMap.load(corridor_folder / "map.ply")
    return scene_map, small, depths, state_from_optical_pose(sequence.camera_to_world[:FRAMES])


def errors(stretch, turn: float, seed: int, **settings: object) -> np.ndarray:
    """Timed errors `(T,)` in metres of a run in the corridor turned about z by `turn` radians."""
    scene_map, camera, depths, states = stretch
    world = pose_matrix([0, 0, 0, 0, 0, turn])
    true = state_from_matrix(world @ pose_matrix(states))
    with DepthRenderer(scene_map.transformed(world), camera, "ray") as renderer:
        localizer = MonteCarloLocalizer(renderer, 60, seed=seed, **settings)
        localizer.initialize(true[0])
        found = np.array([localizer.step(depth).state for depth in depths])
    return timed_error(found[:, :3], true[:, :3]).errors


@pytest.fixture(scope="module")
def unturned(stretch):
    return [np.median(errors(stretch, 0.0, seed)) for seed in (10_001, 10_002)]


@pytest.mark.parametrize("turn", [np.pi / 4, np.pi / 2, np.random.default_rng(10_003).uniform(-np.pi, np.pi)])
@pytest.mark.slow
def test_errors_stay_within_their_spread_over_seeds_however_the_world_is_turned(stretch, unturned, turn):
    found = errors(stretch, turn, seed=10_004)
    assert found.max() < LOST
    assert np.median(found) < 1.5 * max(unturned) < 0.15


@pytest.mark.slow
def test_noise_along_the_worlds_axes_loses_the_wagon_in_a_corridor_that_runs_askew(stretch):
    assert errors(stretch, np.pi / 4, seed=10_005, motion=WORLD_AXES).max() > LOST
