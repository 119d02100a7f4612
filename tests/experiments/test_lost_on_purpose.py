"""Runs that are made to get lost, on which the limits of `depth_mcl.status` were chosen, are never called tracked.

Recordings and seeds from 10,000 up are development data. Images are thinned and few particles used, for time.
"""

import numpy as np
import pytest

from course_lib.depth_mcl.evaluation import pose_errors
from course_lib.depth_mcl.sequence import read_sequence, write_sequence
from course_lib.recordings import SIGMA, run_sequence, system_noise
from course_lib.rendering.scene_map import SceneMap
from course_lib.rendering.sensor import subsample_depth

LOST_POSITION, LOST_ROTATION = 0.3, np.deg2rad(15.0)  # m, rad; beyond either a frame is truly lost
WIDTH = 40  # pixels, of the thinned images

WAYS = {"kidnapped": {"skipped": (0.2, 0.6)}, "mirrored map": {"mirrored": True}}


def judged_run(folder, tmp_path, seed, frames, *, noise=0.3, n_particles=30, skipped=(0, 0), mirrored=False):
    """Which frames of the shipped recording, run one way, are truly lost, and what each was called.

    noise: factor on the usual system noise, too little to find back. skipped: shares of the recording between which
    the filter sees nothing. mirrored: the map, in which no pose is right.
    """
    scene_map, sequence = SceneMap.load(folder / "map.ply"), read_sequence(folder / "wagon")
    begin, end = (round(share * frames) for share in skipped)
    kept = [i for i in range(frames) if not begin <= i < end]
    if mirrored:
        vertices = scene_map.vertices.copy()
        vertices[:, 0] = 2 * vertices[:, 0].mean() - vertices[:, 0]
        scene_map = SceneMap(vertices, scene_map.faces)
    camera = sequence.camera()
    small = camera.resized(WIDTH, round(WIDTH * camera.height / camera.width))
    depths = [subsample_depth(sequence.depth(i), camera, small) for i in kept]
    write_sequence(tmp_path / "thinned", small.matrix, kept, depths, sequence.camera_to_world[kept], up=sequence.up)
    options = {"start": sequence.camera_to_world[0], "n_particles": n_particles, "seed": seed, "backend": "ray"}
    options |= system_noise("xyyaw", *(noise * usual for usual in SIGMA["xyyaw"]))
    run = run_sequence(scene_map, read_sequence(tmp_path / "thinned"), **options)
    metres, radians = pose_errors(run.camera_to_world, sequence.camera_to_world[kept])
    return (metres > LOST_POSITION) | (radians > LOST_ROTATION) | mirrored, np.array(run.statuses)


@pytest.mark.slow
def test_a_run_that_holds_the_track_is_called_tracked(corridor_folder, tmp_path):
    lost, statuses = judged_run(corridor_folder, tmp_path, 10301, 20, noise=1.0, n_particles=200)
    assert not lost.any()
    assert (statuses == "tracked").sum() >= 18


@pytest.mark.parametrize("name", WAYS)
@pytest.mark.slow
def test_a_run_that_is_lost_is_never_called_tracked(corridor_folder, tmp_path, name):
    lost, statuses = judged_run(corridor_folder, tmp_path, 10302, 40, **WAYS[name])
    assert lost.sum() >= 15
    assert not (statuses[lost] == "tracked").any()
    assert (statuses[lost] == "lost").sum() >= 0.8 * lost.sum()
