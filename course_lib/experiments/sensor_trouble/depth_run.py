"""Paper 1's filter on a wagon, and the annealed one carried by hand, on recordings of the corridor with troubles.

Both are guarded (beyond/guarded_depth.py): a frame at fault is not used. The paper's filter has its 200 particles and
no odometer; images are of half the SR4000's size each way, and recordings are shortened, so that all troubles at all
shares take minutes and not hours.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Literal

import numpy as np

from course_lib.beyond.guarded_depth import GuardedLocalizer
from course_lib.beyond.six_dof.localizer import AnnealedLocalizer
from course_lib.depth_mcl.evaluation import pose_errors
from course_lib.depth_mcl.localizer import MonteCarloLocalizer
from course_lib.depth_mcl.sequence import DepthSequence, read_sequence
from course_lib.experiments.lost_on_purpose import LOST_POSITION, LOST_ROTATION
from course_lib.experiments.sensor_trouble.depth_frames import TROUBLES, troubled_recording
from course_lib.experiments.sensor_trouble.placing import Arrival, generator
from course_lib.experiments.sensor_trouble.score import Gate
from course_lib.files import temporary_folder
from course_lib.geometry import optical_pose, state_from_optical_pose
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap
from course_lib.simulation.corridor.seeded_recording import building_of_data, record_seed

IMAGE = (88, 72)  # pixels, width and height
GATE = Gate(LOST_POSITION, float(np.rad2deg(LOST_ROTATION)))
Dof = Literal["xyyaw", "6"]
FILTERS = {"xyyaw": MonteCarloLocalizer, "6": AnnealedLocalizer}


def watched_frames(
    dof: Dof, renderer: DepthRenderer, arrivals: Sequence[Arrival], true_poses: np.ndarray, period: float, seed: int
) -> list[dict]:
    """What became of every frame that was due: outcome, whether the pose is one to go by, its errors.

    true_poses: `(T, 4, 4)` camera-to-world, optical, z up; the filter starts at the first. A frame that never came, or
    came out of order, has the pose that the filter was moved to when the next one told of the gap.
    """
    localizer = GuardedLocalizer(FILTERS[dof](renderer, seed=seed), period)
    localizer.initialize(state_from_optical_pose(true_poses[0]))
    outcomes, states = [], []
    for arrival in arrivals:
        if arrival.image is None:
            outcomes.append("no image")
            states.append(states[-1])
            continue
        frame = localizer.step(arrival.image, arrival.time)
        for back, estimate in enumerate(reversed(frame.missed), start=1):
            states[-back] = estimate.state
        outcomes.append(frame.outcome)
        states.append(frame.estimate.state)
    position, rotation = pose_errors(optical_pose(np.array(states)), true_poses)
    return [
        {"outcome": outcome, "confident": outcome == "tracked", "position_m": float(p), "rotation_deg": float(r)}
        for outcome, p, r in zip(outcomes, position, np.rad2deg(rotation), strict=True)
    ]


def corridor_trouble(data: str, seed: int, frames: int, shares: Sequence[float], dof: Dof) -> dict:
    """A point of a sweep: a seed's recording undisturbed, and with every trouble at every share (0 to 1).

    {"undisturbed": frames, "troubles": [{"trouble", "share", "runs", "frames"}]}, frames as `watched_frames` has them.
    """
    scene_map, building = SceneMap.load(Path(data) / "map.ply"), building_of_data(data)
    with temporary_folder() as temporary:
        folder = temporary / "recording"
        camera = DepthCamera.sr4000().resized(*IMAGE)
        carried = "wagon" if dof == "xyyaw" else "hand"
        record_seed(folder, building, seed, camera=camera, frames=frames, carried=carried)
        recording = read_sequence(folder)
        return troubles_of(recording, scene_map, seed, shares, dof)


def troubles_of(
    recording: DepthSequence, scene_map: SceneMap, seed: int, shares: Sequence[float], dof: Dof, troubles=TROUBLES
) -> dict:
    """`corridor_trouble` of a recording with its truth and times, z up."""
    images = [recording.depth(index) for index in range(len(recording))]
    times, true = recording.times, recording.camera_to_world
    period = float(np.median(np.diff(times)))
    with DepthRenderer(scene_map, recording.camera()) as renderer:

        def run(arrivals: Sequence[Arrival]) -> list[dict]:
            return watched_frames(dof, renderer, arrivals, true, period, seed)

        calm = run([Arrival(image, float(time)) for image, time in zip(images, times, strict=True)])
        rows = []
        for trouble in troubles:
            for share in shares:
                arrivals, runs = troubled_recording(trouble, images, times, share, generator(seed, trouble, share))
                rows.append({"trouble": trouble, "share": share, "runs": runs, "frames": run(arrivals)})
    return {"undisturbed": calm, "troubles": rows}
