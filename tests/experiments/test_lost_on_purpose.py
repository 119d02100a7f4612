"""Runs that are made to get lost, on which the limits of `beyond.tracking` were chosen, are never called tracked.

Recordings and seeds from 10,000 up are development data. Images are thinned and few particles used, for time.
"""

from typing import NamedTuple

import numpy as np
import pytest

from course_lib.depth_mcl.evaluation import pose_errors
from course_lib.depth_mcl.sequence import read_sequence, write_sequence
from course_lib.experiments.recordings import SIGMA, run_sequence, system_noise
from course_lib.geometry import rotation_exp
from course_lib.rendering.scene_map import SceneMap
from course_lib.rendering.sensor import subsample_depth

LOST_POSITION, LOST_ROTATION = 0.3, np.deg2rad(15.0)  # m, rad; beyond either a frame is truly lost
WIDTH = 40  # pixels, of the thinned images


class Way(NamedTuple):
    """One way to run a recording."""

    skipped: tuple[float, float] = (0.0, 0.0)  # shares of its length between which the filter sees nothing: kidnapped
    shift: tuple[float, float, float] = (0.0, 0.0, 0.0)  # m, of the start
    turn_deg: float = 0.0  # of the start, about the camera's vertical
    noise: float = 0.3  # factor on the usual system noise: too little to find back
    n_particles: int = 30
    mirrored: bool = False  # the map is its mirror image: no pose is right


WAYS = {
    "kidnapped": Way(skipped=(0.2, 0.6)),
    "started beside": Way(shift=(0.3, 0.3, 0.2), turn_deg=50.0),
    "started a metre off": Way(shift=(-1.0, 0.1, 0.0)),
    "mirrored map": Way(mirrored=True),
}


def judged_run(folder, tmp_path, way, seed, frames):
    """Which frames of the shipped recording, run one way, are truly lost, and what each was called."""
    scene_map, sequence = SceneMap.load(folder / "map.ply"), read_sequence(folder / "wagon")
    begin, end = (round(share * frames) for share in way.skipped)
    kept = [i for i in range(frames) if not begin <= i < end]
    start = sequence.camera_to_world[0].copy()
    start[:3, 3] += way.shift
    start[:3, :3] = start[:3, :3] @ rotation_exp(np.deg2rad([0.0, way.turn_deg, 0.0]))
    if way.mirrored:
        vertices = scene_map.vertices.copy()
        vertices[:, 0] = 2 * vertices[:, 0].mean() - vertices[:, 0]
        scene_map = SceneMap(vertices, scene_map.faces)
    camera = sequence.camera()
    small = camera.resized(WIDTH, round(WIDTH * camera.height / camera.width))
    depths = [subsample_depth(sequence.depth(i), camera, small) for i in kept]
    write_sequence(tmp_path / "thinned", small.matrix, kept, depths, sequence.camera_to_world[kept], up=sequence.up)
    run = run_sequence(
        scene_map,
        read_sequence(tmp_path / "thinned"),
        start=start,
        n_particles=way.n_particles,
        seed=seed,
        backend="ray",
        **system_noise("xyyaw", *(way.noise * usual for usual in SIGMA["xyyaw"])),
    )
    metres, radians = pose_errors(run.camera_to_world, sequence.camera_to_world[kept])
    return (metres > LOST_POSITION) | (radians > LOST_ROTATION) | way.mirrored, np.array(run.statuses)


@pytest.mark.slow
def test_a_run_that_holds_the_track_is_called_tracked(corridor_folder, tmp_path):
    lost, statuses = judged_run(corridor_folder, tmp_path, Way(noise=1.0, n_particles=200), seed=10301, frames=20)
    assert not lost.any()
    assert (statuses == "tracked").sum() >= 18


@pytest.mark.parametrize("name", WAYS)
@pytest.mark.slow
def test_a_run_that_is_lost_is_never_called_tracked(corridor_folder, tmp_path, name):
    lost, statuses = judged_run(corridor_folder, tmp_path, WAYS[name], seed=10302, frames=40)
    assert lost.sum() >= 15
    assert not (statuses[lost] == "tracked").any()
    assert (statuses[lost] == "lost").sum() >= 0.8 * lost.sum()
