"""A localized recording as a scene: what is in it, where it is cut, which frames are the worst."""

from types import SimpleNamespace

import numpy as np
import pytest

from course_lib.depth_mcl import SceneMap, read_sequence
from course_lib.geometry import state_from_optical_pose
from course_lib.recordings import Run
from courseware.plots.figures import BLUE, ORANGE, PURPLE, VERMILION
from courseware.plots.scene_page import page_html
from courseware.plots.track_scene import track_scene, worst_frames

NEAR, FAR = 0.1, 10.0
FRAMES = 40
OFF = 17  # the frame whose estimate is half a metre off


@pytest.fixture(scope="module")
def scene_map(corridor_folder):
    return SceneMap.load(corridor_folder / "map.ply")


@pytest.fixture(scope="module")
def wagon(corridor_folder):
    return read_sequence(corridor_folder / "wagon")


@pytest.fixture(scope="module")
def run(wagon) -> Run:
    """A run that knows the truth, but for one frame."""
    poses = np.array(wagon.camera_to_world[:FRAMES])
    poses[OFF, 2, 3] += 0.5
    known = {"frames": wagon.frames[:FRAMES], "states": state_from_optical_pose(poses), "camera_to_world": poses}
    known |= {"scores": np.where(np.arange(FRAMES) == 30, 0.2, 0.8), "statuses": ["tracked"] * FRAMES}
    return Run(**dict.fromkeys(Run._fields, ()) | known)


def posed(wagon, camera_to_world=None):
    """The recording with other poses, or without."""
    parts = {"frames": wagon.frames, "camera": wagon.camera, "depth": wagon.depth, "camera_to_world": camera_to_world}
    return SimpleNamespace(has_poses=camera_to_world is not None, **parts)


def of_colour(plotter, colour: str) -> list:
    """The data of a scene's objects in that colour, in their order."""
    actors = [actor for actor in plotter.actors.values() if actor.prop.color.hex_rgb == colour.lower()]
    return [actor.mapper.dataset for actor in actors]


def test_path_truth_and_the_points_of_the_worst_frame_are_there(scene_map, wagon, run):
    plotter, words = track_scene(scene_map, run, wagon, "z", NEAR, FAR)
    assert f"{run.frames[OFF]}" in words
    assert np.allclose(of_colour(plotter, BLUE)[0].points, run.camera_to_world[:, :3, 3], atol=1e-4)
    assert np.allclose(of_colour(plotter, "#000000")[0].points, wagon.camera_to_world[:FRAMES, :3, 3], atol=1e-4)
    points, lines = of_colour(plotter, PURPLE)[4:6]
    assert worst_frames(run, wagon)[2] == OFF
    assert np.allclose(lines.points[0], run.camera_to_world[OFF, :3, 3], atol=1e-4)
    # The wagon's camera sees the floor; half a metre too high, it sees it half a metre above the map's.
    assert np.percentile(points.points[:, 2], 3) == pytest.approx(0.5, abs=0.1)
    grey = of_colour(plotter, "#d3d3d3")[0]
    assert grey.bounds[5] == pytest.approx(run.camera_to_world[:, 2, 3].max() + 0.4, abs=1e-3)
    assert len(page_html(plotter, "A run", words)) < 1_300_000
    plotter.close()


def moved_paths(scene_map, wagon, run, matrix, up, true=None):
    """The estimate's path in the scene of a world, and in that of the same world moved by a matrix."""
    moved = run._replace(camera_to_world=matrix @ run.camera_to_world)
    other, _ = track_scene(scene_map.transformed(matrix), moved, posed(wagon, true), up, NEAR, FAR)
    return run.camera_to_world[:, :3, 3], of_colour(other, BLUE)[0].points


def test_a_world_with_another_up_axis_is_turned(scene_map, wagon, run):
    """The same world on its side: the scene is the same."""
    side = np.array([[1.0, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
    plain, turned = moved_paths(scene_map, wagon, run, side, "-y", side @ wagon.camera_to_world)
    assert np.allclose(plain[:, 2], turned[:, 2], atol=1e-4)
    assert np.allclose(np.linalg.norm(np.diff(plain, axis=0)), np.linalg.norm(np.diff(turned, axis=0)), atol=1e-4)


def test_far_from_zero_the_scene_is_brought_near(scene_map, wagon, run):
    away = np.eye(4)
    away[:3, 3] = [3.6e5, -4.4e6, 12.0]
    plain, near = moved_paths(scene_map, wagon, run, away, "z")
    assert np.abs(near).max() < 1000
    assert np.allclose(np.diff(near, axis=0), np.diff(plain, axis=0), atol=1e-3)


def test_doubtful_and_lost_frames_are_marked_and_said(scene_map, wagon, run):
    statuses = ["tracked"] * 30 + ["doubtful"] * 4 + ["lost"] * 6
    plotter, words = track_scene(scene_map, run._replace(statuses=statuses), wagon, "z", NEAR, FAR)
    assert [[mesh.n_points for mesh in of_colour(plotter, one)] for one in (ORANGE, VERMILION)] == [[4], [6]]
    assert "orange where doubtful, red where lost" in words


def test_the_worst_frames_are_apart_and_without_truth_those_of_the_lowest_score(wagon, run):
    unmeasured = run._replace(scores=np.where(np.arange(FRAMES) == 3, np.nan, run.scores))
    worst = worst_frames(unmeasured, posed(wagon))
    assert 30 in worst
    assert 3 not in worst, "a frame without a measurement has no points to draw"
    assert np.diff(worst).min() >= FRAMES / 10
    assert OFF in worst_frames(run, wagon)
