"""What the filter of project P1 runs on: a seed's own recording in the corridor, and a renderer that counts."""

from functools import cache
from typing import NamedTuple

import numpy as np

from course_lib.depth_mcl import DepthCamera, DepthRenderer, SceneMap, read_sequence
from course_lib.files import temporary_folder
from course_lib.geometry import state_from_optical_pose
from course_lib.paths import data_path
from course_lib.simulation.corridor.recorded_runs import WagonModel
from course_lib.simulation.corridor.seeded_recording import SeedModels, building_of_data, record_seed

FRAMES = 40
RENDERS_A_FRAME = 40
PARTICLES = 40
# A wagon pushed at 2 m/s by what the recording's clock says, twice the course's usual: room for a better prediction.
WAGON = WagonModel(frames=FRAMES, mean_step=0.2, step_spread=0.15, heading_wobble_deg=2.0)
CAMERA = DepthCamera.sr4000(far=11.0).resized(44, 36)
# How far the start that is told lies from the true one, one sigma of x and y [m] and yaw [rad]: by tape and eye.
START_SIGMA = (0.05, 0.05, np.deg2rad(1.0))


class BudgetError(RuntimeError):
    """More depth images were rendered than the project allows."""


class CountedRenderer:
    """Depth images of the map from particles, at most `budget` of them: `render(states)` counts in `renders`."""

    def __init__(self, budget: int) -> None:
        self.budget = budget
        self.renders = 0

    def render(self, states: np.ndarray) -> np.ndarray:
        """Depth images `(N, H, W)` [m] of the map from states `(N, 6)`; inf where nothing is hit.

        Raises `BudgetError` where more than `budget` would have been drawn since the start.
        """
        states = np.atleast_2d(np.asarray(states, dtype=np.float64))
        self.renders += len(states)
        if self.renders > self.budget:
            raise BudgetError(f"the budget of {self.budget} renders is spent: use fewer particles a frame")
        return _renderer().render(states)


@cache
def _renderer() -> DepthRenderer:
    """The one renderer of the corridor's map, opened when first used."""
    return DepthRenderer(SceneMap.load(data_path("corridor/map.ply")), CAMERA)


class Recording(NamedTuple):
    """A seed's recording."""

    frames: np.ndarray
    """`(T, H, W)` depth images in metres, nan = no measurement."""
    states: np.ndarray
    """`(T, 6)` the true states."""
    start: np.ndarray
    """`(6,)` the start that the filter is told, a little wrong."""


@cache
def recording(seed: int) -> Recording:
    """The recording of a seed: another day in the building of the map, another run of the wagon."""
    with temporary_folder() as temporary:
        folder = temporary / "run"
        building = building_of_data(data_path("corridor"))
        record_seed(folder, building, seed, models=SeedModels(wagon=WAGON), camera=CAMERA)
        sequence = read_sequence(folder)
        frames = np.stack([sequence.depth(index) for index in range(FRAMES)])
        states = state_from_optical_pose(sequence.camera_to_world)
    start = states[0].copy()
    start[[0, 1, 5]] += START_SIGMA * np.random.default_rng([seed, 2]).standard_normal(3)
    return Recording(frames, states, start)
