"""Trouble a depth camera's frames, and run paper 1's filter and the annealed one on them.

Both filters are guarded (`beyond/guarded_depth.py`). An exposure that jumps is modelled after the simulated camera
(simulation/sensors/time_of_flight.py): with a share of the light amplitudes fall to that share, ranges are noisier, by

    sigma_r = c / (4 pi f) sqrt(shot^2 / A + dark^2 / A^2),      A = share * WHITE_SHARE * 4 / r^2

and returns whose amplitude falls below the camera's threshold are lost: far ones first.
"""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path

import numpy as np

from course_lib.beyond.guarded_depth import GuardedLocalizer
from course_lib.beyond.six_dof.localizer import AnnealedLocalizer
from course_lib.depth_mcl.evaluation import pose_errors
from course_lib.depth_mcl.localizer import MonteCarloLocalizer
from course_lib.depth_mcl.sequence import DepthSequence, read_sequence
from course_lib.files import temporary_folder
from course_lib.geometry import optical_pose, state_from_optical_pose
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap
from courseware.experiments.troubled_frames import SECOND, Arrival, Gate, Spoil, troubles_of
from courseware.simulation.corridor.recorded_runs import FRAME_RATE
from courseware.simulation.corridor.seeded_recording import building_of_data, record_seed
from courseware.simulation.sensors.time_of_flight import SPEED_OF_LIGHT, TimeOfFlightModel

GATE = Gate(0.3, 15.0)  # chosen: beyond either an estimate is useless for going through a door
IMAGE = (88, 72)  # pixels: half of the SR4000's each way, so that all troubles take minutes
FILTERS = {"xyyaw": MonteCarloLocalizer, "6": AnnealedLocalizer}
LIGHT_LEFT = 1 / 16  # share of the exposure that is left after a jump: four stops; chosen
WHITE_SHARE = 0.3  # reflectivity times cosine of what is seen, which a depth image does not tell; chosen
MAX_RANGE = 9.99  # m, where a saturated sensor stops: the SR4000's unambiguous range


def half_covered(image: np.ndarray, earlier: np.ndarray, before: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Return one half, upper, lower, left or right, without returns: a hand before the lens is too near for any."""
    covered = image.copy()
    height, width = image.shape
    halves = (np.s_[: height // 2], np.s_[height // 2 :], np.s_[:, : width // 2], np.s_[:, width // 2 :])
    covered[halves[rng.integers(4)]] = np.nan
    return covered


def saturated(image: np.ndarray, earlier: np.ndarray, before: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Return all pixels at zero, all at the greatest range, or all anywhere between: one of the three at random."""
    kind = rng.integers(3)
    if kind == 2:
        return rng.uniform(0.0, MAX_RANGE, image.shape).astype(image.dtype)
    return np.full_like(image, (0.0, MAX_RANGE)[kind])


def underexposed(image: np.ndarray, earlier: np.ndarray, before: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Return the image with `LIGHT_LEFT` of its light: noisier, and without what is far (the model above)."""
    model = TimeOfFlightModel()
    amplitude = LIGHT_LEFT * WHITE_SHARE * 4 / np.maximum(image.astype(np.float64), 0.05) ** 2
    phase = np.sqrt(model.shot_noise**2 / amplitude + model.dark_noise**2 / amplitude**2)
    noise = SPEED_OF_LIGHT / (4 * np.pi * model.frequency) * phase * rng.standard_normal(image.shape)
    return np.where(amplitude < model.least_amplitude, np.nan, image + noise).astype(image.dtype)


def repeated(image: np.ndarray, earlier: np.ndarray, before: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Return the image that arrived before, once more."""
    return before.copy()


SPOILS: dict[str, Spoil] = {
    "repeated": repeated,
    "black": lambda image, *_: np.full_like(image, np.nan),  # no return in any pixel
    "frozen for a second": repeated,
    "half covered": half_covered,
    "saturated": saturated,
    "exposure jump": underexposed,
}
# How many frames one after the other each trouble lasts.
LENGTHS = dict.fromkeys(("dropped", *SPOILS, "time backwards"), 1) | {"frozen for a second": round(SECOND * FRAME_RATE)}


def corridor_trouble(
    data: str, seed: int, frames: int, shares: Sequence[float], dof: str, lengths: Mapping = LENGTHS, image=IMAGE
) -> dict:
    """Return `troubles_of` a filter ("xyyaw" or "6") on a seed's recording of the corridor. image: size in pixels."""
    camera, carried = DepthCamera.sr4000().resized(*image), "wagon" if dof == "xyyaw" else "hand"
    with temporary_folder() as temporary:
        record_seed(temporary / "run", building_of_data(data), seed, camera=camera, frames=frames, carried=carried)
        recording = read_sequence(temporary / "run")
        images = [recording.depth(index) for index in range(len(recording))]
        with DepthRenderer(SceneMap.load(Path(data) / "map.ply"), recording.camera()) as renderer:
            run = partial(watched_frames, recording, partial(FILTERS[dof], renderer, seed=seed))
            return troubles_of(run, lengths, SPOILS, images, recording.times, seed, shares)


def watched_frames(recording: DepthSequence, make: Callable, arrivals: Sequence[Arrival]) -> list[dict]:
    """Return what became of every frame: outcome, whether the pose is one to go by, its errors. make: the filter.

    A frame that never came, or out of order, has the pose to which the filter was moved when the next told of the gap.
    """
    localizer = GuardedLocalizer(make(), float(np.median(np.diff(recording.times))))
    localizer.initialize(state_from_optical_pose(recording.camera_to_world[0]))
    outcomes, states = [], []
    for arrival in arrivals:
        if arrival.image is None:
            outcomes.append("no image")
            states.append(states[-1])
            continue
        watched = localizer.step(arrival.image, arrival.time)
        for back, estimate in enumerate(reversed(watched.missed), start=1):
            states[-back] = estimate.state
        outcomes.append(watched.outcome)
        states.append(watched.estimate.state)
    position, rotation = pose_errors(optical_pose(np.array(states)), recording.camera_to_world)
    return [
        {"outcome": outcome, "confident": outcome == "tracked", "position_m": float(p), "rotation_deg": float(r)}
        for outcome, p, r in zip(outcomes, position, np.rad2deg(rotation), strict=True)
    ]
