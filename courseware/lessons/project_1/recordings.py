"""What the filter of project P1 runs on: a seed's own recording in the corridor, and a renderer that counts."""

from collections import namedtuple
from functools import cache

import numpy as np

from course_lib.depth_mcl import DepthCamera, DepthRenderer, SceneMap, read_sequence
from course_lib.files import temporary_folder
from course_lib.geometry import state_from_optical_pose
from courseware.paths import data_path
from courseware.simulation.corridor.recorded_runs import WagonModel
from courseware.simulation.corridor.seeded_recording import SeedModels, building_of_data, record_seed

FRAMES, RENDERS_A_FRAME, PARTICLES = 40, 40, 40
# The recording's clock says that the wagon moves at 2 m/s, twice the course's usual speed: a prediction can help.
MODELS = SeedModels(wagon=WagonModel(frames=FRAMES, mean_step=0.2, step_spread=0.15, heading_wobble_deg=2.0))
CAMERA = DepthCamera.sr4000(far=11.0).resized(44, 36)
# Standard deviation of the start that we tell: x and y [m] by tape, yaw [rad] by eye.
START_SIGMA = (0.05, 0.05, np.deg2rad(1.0))

# frames: depth images `(T, H, W)` [m], NaN without measurement. states: the true ones `(T, 6)`. start: told, `(6,)`.
Recording = namedtuple("Recording", "frames states start")


class BudgetError(RuntimeError):
    """More depth images were rendered than the project allows."""


class CountedRenderer:
    """Render depth images of the map from particles, at most `budget` of them. `renders` is their number so far."""

    def __init__(self, budget: int) -> None:
        self.budget = budget
        self.renders = 0

    def render(self, states: np.ndarray) -> np.ndarray:
        """Return depth images `(N, H, W)` [m] of the map from states `(N, 6)`; inf where nothing is hit.

        Raises `BudgetError` if more than `budget` images are asked for in all.
        """
        states = np.atleast_2d(np.asarray(states, dtype=np.float64))
        self.renders += len(states)
        if self.renders > self.budget:
            raise BudgetError(f"the budget of {self.budget} renders is spent: use fewer particles a frame")
        return _renderer().render(states)


@cache
def _renderer() -> DepthRenderer:
    return DepthRenderer(SceneMap.load(data_path("corridor/map.ply")), CAMERA)


@cache
def recording(seed: int) -> Recording:
    """Return the recording of a seed: another day in the building of the map, another run of the wagon."""
    with temporary_folder() as temporary:
        folder = temporary / "run"
        record_seed(folder, building_of_data(data_path("corridor")), seed, models=MODELS, camera=CAMERA)
        sequence = read_sequence(folder)
        frames = np.stack([sequence.depth(index) for index in range(FRAMES)])
        states = state_from_optical_pose(sequence.camera_to_world)
    start = states[0].copy()
    start[[0, 1, 5]] += START_SIGMA * np.random.default_rng([seed, 2]).standard_normal(3)
    return Recording(frames, states, start)


def wall_ahead(states):
    """Depth images (N, 3, 5) of a wall at x = 10 m and one at y = 2 m, from states (N, 6): stands for a renderer."""
    states = np.atleast_2d(states)[:, :, None, None]
    rays = np.arctan(np.tile(np.linspace(-0.4, 0.4, 5), (3, 1)))
    with np.errstate(divide="ignore"):
        front = (10 - states[:, 0]) / np.cos(states[:, 5] + rays)
        side = (2 - states[:, 1]) / np.sin(states[:, 5] + rays)
    return np.minimum(front, np.where(side > 0, side, np.inf)) * np.cos(rays)
