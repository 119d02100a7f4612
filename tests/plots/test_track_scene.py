"""A localized recording as a scene: what is in it, where it is cut, which frames are the worst."""

from __future__ import annotations

import numpy as np
import pytest

from course_lib.depth_mcl import SceneMap, read_sequence
from course_lib.experiments.recordings import Run
from course_lib.geometry import state_from_optical_pose
from course_lib.plots.figures import BLUE, ORANGE, PURPLE, VERMILION
from course_lib.plots.scene_page import page_html
from course_lib.plots.track_scene import track_scene, worst_frames

NEAR, FAR = 0.1, 10.0
FRAMES = 40
OFF = 17  # the frame whose estimate is half a metre off


@pytest.fixture(scope="module")
def recording(corridor_folder):
    return SceneMap.load(corridor_folder / "map.ply"), read_sequence(corridor_folder / "wagon")


def made_run(sequence, off: float = 0.5, statuses=("tracked",) * FRAMES) -> Run:
    """A run that knows the truth, but for one frame."""
    poses = np.array(sequence.camera_to_world[:FRAMES])
    poses[OFF, 2, 3] += off
    return Run(
        frames=sequence.frames[:FRAMES],
        states=state_from_optical_pose(poses),
        camera_to_world=poses,
        scores=np.where(np.arange(FRAMES) == 30, 0.2, 0.8),
        ess=np.full(FRAMES, 10.0),
        agreements=[],
        statuses=list(statuses),
        normalized_errors=np.empty(0),
        deviations=np.empty(0),
        error_sigmas=np.empty(0),
        renders=np.empty(0),
        ms_per_frame=0.0,
        frames_without_measurement=0,
    )


def of_colour(plotter, colour: str) -> list:
    """The data of a scene's objects in that colour, in their order."""
    actors = [actor for actor in plotter.actors.values() if actor.prop.color.hex_rgb == colour.lower()]
    return [actor.mapper.dataset for actor in actors]


def test_path_truth_and_the_points_of_the_worst_frame_are_there(recording):
    scene_map, sequence = recording
    run = made_run(sequence)
    plotter, words = track_scene(scene_map, run, sequence, "z", NEAR, FAR)
    assert f"{run.frames[OFF]}" in words
    assert np.allclose(of_colour(plotter, BLUE)[0].points, run.camera_to_world[:, :3, 3], atol=1e-4)
    assert np.allclose(of_colour(plotter, "#000000")[0].points, sequence.camera_to_world[:FRAMES, :3, 3], atol=1e-4)
    points, lines = of_colour(plotter, PURPLE)[4:6]
    assert worst_frames(run, sequence)[2] == OFF
    assert np.allclose(lines.points[0], run.camera_to_world[OFF, :3, 3], atol=1e-4)
    # The wagon's camera sees the floor; half a metre too high, it sees it half a metre above the map's.
    assert np.percentile(points.points[:, 2], 3) == pytest.approx(0.5, abs=0.1)
    grey = of_colour(plotter, "#d3d3d3")[0]
    assert grey.bounds[5] == pytest.approx(run.camera_to_world[:, 2, 3].max() + 0.4, abs=1e-3)
    assert len(page_html(plotter, "A run", words)) < 1_300_000
    plotter.close()


def test_a_world_with_another_up_axis_is_turned(recording):
    """The same world on its side: the scene is the same."""
    scene_map, sequence = recording
    side = np.array([[1.0, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
    run = made_run(sequence)
    turned = run._replace(camera_to_world=side @ run.camera_to_world)
    plain, _ = track_scene(scene_map, run, sequence, "z", NEAR, FAR)

    class Turned:
        has_poses, frames, camera, depth = True, sequence.frames, sequence.camera, sequence.depth
        camera_to_world = side @ sequence.camera_to_world

    other, _ = track_scene(scene_map.transformed(side), turned, Turned, "-y", NEAR, FAR)
    paths = [of_colour(plotter, BLUE)[0].points for plotter in (plain, other)]
    assert np.allclose(paths[0][:, 2], paths[1][:, 2], atol=1e-4)
    assert np.allclose(np.linalg.norm(np.diff(paths[0], axis=0)), np.linalg.norm(np.diff(paths[1], axis=0)), atol=1e-4)


def test_far_from_zero_the_scene_is_brought_near(recording):
    scene_map, sequence = recording
    away = np.eye(4)
    away[:3, 3] = [3.6e5, -4.4e6, 12.0]
    run = made_run(sequence)

    class Away:
        has_poses, frames, camera, depth = False, sequence.frames, sequence.camera, sequence.depth

    moved = run._replace(camera_to_world=away @ run.camera_to_world)
    plotter, _ = track_scene(scene_map.transformed(away), moved, Away, "z", NEAR, FAR)
    line = of_colour(plotter, BLUE)[0].points
    assert np.abs(line).max() < 1000
    assert np.allclose(np.diff(line, axis=0), np.diff(run.camera_to_world[:, :3, 3], axis=0), atol=1e-3)


def test_doubtful_and_lost_frames_are_marked_and_said(recording):
    scene_map, sequence = recording
    statuses = ["tracked"] * 30 + ["doubtful"] * 4 + ["lost"] * 6
    plotter, words = track_scene(scene_map, made_run(sequence, statuses=statuses), sequence, "z", NEAR, FAR)
    assert [mesh.n_points for mesh in of_colour(plotter, ORANGE)] == [4]
    assert [mesh.n_points for mesh in of_colour(plotter, VERMILION)] == [6]
    assert "orange where doubtful, red where lost" in words


def test_the_worst_frames_are_apart_and_without_truth_those_of_the_lowest_score(recording):
    _, sequence = recording
    run = made_run(sequence)

    class NoTruth:
        has_poses = False

    worst = worst_frames(run._replace(scores=np.where(np.arange(FRAMES) == 3, np.nan, run.scores)), NoTruth)
    assert 30 in worst
    assert 3 not in worst, "a frame without a measurement has no points to draw"
    assert np.diff(worst).min() >= FRAMES / 10
    assert OFF in worst_frames(run, sequence)
