"""Runs that are made to get lost, and how often `beyond/being_lost.py`, which knows no truth, notices.

Its limits were chosen on these runs, so their recordings are development data: the simulated corridor and the real
kitchen, with seeds from 10,000 up. Images are thinned and few particles used, for time.

    table(SceneMap.load(map_file), read_sequence(folder), "6", seed=10201, frames=100)

Of the kitchen this says: 456 frames truly lost, 88 % of them called lost, 10 % doubtful, 2 % tracked; 384 good ones,
70 % called tracked, 22 % doubtful, 8 % lost.
"""

from __future__ import annotations

from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np

from course_lib.depth_mcl.evaluation import pose_errors
from course_lib.depth_mcl.sequence import DepthSequence, read_sequence, write_sequence
from course_lib.experiments.recordings import SIGMA, run_sequence, system_noise
from course_lib.files import temporary_folder
from course_lib.geometry import rotation_exp
from course_lib.rendering.scene_map import SceneMap
from course_lib.rendering.sensor import subsample_depth

# A frame is truly lost beyond either (chosen: what makes an estimate useless for going through a door).
LOST_POSITION = 0.3  # metres
LOST_ROTATION = np.deg2rad(15.0)

WIDTH = 40  # pixels, of the thinned images


class Way(NamedTuple):
    """One way to run a recording, most of them wrong."""

    skipped: tuple[float, float] = (0.0, 0.0)
    """The stretch of the recording that the filter does not see, as shares of its length: it is kidnapped."""
    shift: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Of the start, metres."""
    turn_deg: float = 0.0
    """Of the start, about the camera's vertical."""
    noise: float = 1.0
    """Factor on the usual system noise."""
    n_particles: int = 100
    mirrored: bool = False
    """The map is its mirror image: no pose is right."""


WAYS = {
    "as it is": Way(),
    "kidnapped": Way(skipped=(0.25, 0.45)),
    "kidnapped twice as far": Way(skipped=(0.2, 0.6)),
    "started beside": Way(shift=(0.3, 0.3, 0.2), turn_deg=50.0),
    "started a metre off": Way(shift=(-1.0, 0.1, 0.0)),
    "a tenth of the noise": Way(noise=0.1),
    "a quarter of the noise": Way(noise=0.25),
    "30 particles": Way(n_particles=30),
    "mirrored map": Way(mirrored=True),
}


class Judged(NamedTuple):
    """A run's frames: what they are, and what they were called."""

    truly_lost: np.ndarray
    """`(T,)` bool."""
    statuses: np.ndarray
    """`(T,)` "tracked", "doubtful" or "lost"."""

    def called(self, truly_lost: bool) -> dict[str, int]:
        """How many of the frames that are lost, or not, were called what."""
        chosen = self.statuses[self.truly_lost == truly_lost]
        return {status: int((chosen == status).sum()) for status in ("tracked", "doubtful", "lost")}


def judged_run(
    scene_map: SceneMap, sequence: DepthSequence, way: Way, dof: Literal["6", "xyyaw"], seed: int, frames: int = 200
) -> Judged:
    """The first frames of a recording run one way; the recording must hold its true poses."""
    count = min(frames, len(sequence))
    begin, end = (round(share * count) for share in way.skipped)
    kept = [i for i in range(count) if not begin <= i < end]
    start = sequence.camera_to_world[0].copy()
    start[:3, 3] += way.shift
    start[:3, :3] = start[:3, :3] @ rotation_exp(np.deg2rad([0.0, way.turn_deg, 0.0]))
    position, rotation_deg = SIGMA[dof]
    with temporary_folder() as folder:
        _write_thinned(folder, sequence, kept)
        run = run_sequence(
            _mirrored(scene_map) if way.mirrored else scene_map,
            read_sequence(folder),
            start=start,
            n_particles=way.n_particles,
            seed=seed,
            backend="ray",
            **system_noise(dof, way.noise * position, way.noise * rotation_deg),
        )
    metres, radians = pose_errors(run.camera_to_world, sequence.camera_to_world[kept])
    lost = (metres > LOST_POSITION) | (radians > LOST_ROTATION) | way.mirrored
    return Judged(lost, np.array(run.statuses))


def table(
    scene_map: SceneMap, sequence: DepthSequence, dof: Literal["6", "xyyaw"], seed: int, frames: int = 200
) -> str:
    """Every way of `WAYS` on the first frames: of those truly lost and of the others, how many were called what."""
    heads = [
        f"{'':22}  {'truly lost, called':^27}  {'good, called':^27}",
        f"{'':22}" + "  tracked doubtful   lost  " * 2,
    ]
    judged = {name: judged_run(scene_map, sequence, way, dof, seed, frames) for name, way in WAYS.items()}
    everything = Judged(*(np.concatenate(parts) for parts in zip(*judged.values(), strict=True)))
    lines = []
    for name, one in [*judged.items(), ("together", everything)]:
        numbers = [f"{n:9d}" for lost in (True, False) for n in one.called(lost).values()]
        lines.append(f"{name:22}" + "".join(numbers))
    return "\n".join([*heads, *lines])


def _mirrored(scene_map: SceneMap) -> SceneMap:
    vertices = scene_map.vertices.copy()
    vertices[:, 0] = 2 * vertices[:, 0].mean() - vertices[:, 0]
    return SceneMap(vertices, scene_map.faces)


def _write_thinned(folder: Path, sequence: DepthSequence, kept: list[int]) -> None:
    """Some frames of a recording, their images thinned to `WIDTH`, as a recording of its own."""
    camera = sequence.camera()
    small = camera.resized(WIDTH, round(WIDTH * camera.height / camera.width))
    depths = [subsample_depth(sequence.depth(i), camera, small) for i in kept]
    poses = sequence.camera_to_world[kept]
    write_sequence(folder, small.matrix, [sequence.frames[i] for i in kept], depths, poses, up=sequence.up)
