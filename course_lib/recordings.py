"""Run a localizer over a recording: plain functions of a recording, a map and a seed."""

import time
import warnings
from collections.abc import Callable, Iterable, Iterator
from typing import Literal, NamedTuple, get_args

import numpy as np

from course_lib.beyond.guarded_depth import GuardedLocalizer, status_of
from course_lib.beyond.guarded_frames import Fault
from course_lib.beyond.lost_and_found.free_space import FreeSpace
from course_lib.beyond.lost_and_found.global_search import GlobalSearch, PoseCandidates
from course_lib.beyond.lost_and_found.recovery import RecoveringLocalizer
from course_lib.beyond.six_dof.calibration import Calibration
from course_lib.beyond.six_dof.localizer import AnnealedLocalizer
from course_lib.depth_mcl.evaluation import pose_errors
from course_lib.depth_mcl.fallon import COARSE_HEIGHT, COARSE_WIDTH
from course_lib.depth_mcl.localizer import MonteCarloLocalizer, NoMeasurementWarning
from course_lib.depth_mcl.motion import BODY_AXES, TANGENT_SPACE, Motion
from course_lib.depth_mcl.sequence import FAR, NEAR, DepthSequence
from course_lib.depth_mcl.status import Agreement, TrackStatus
from course_lib.depth_mcl.uncertainty import normalized_error
from course_lib.geometry import optical_pose, rotation_to_z_up, state_from_optical_pose
from course_lib.rendering.renderer import Backend, DepthRenderer
from course_lib.rendering.scene_map import SceneMap
from course_lib.rendering.sensor import subsample_depth

# Standard deviations of the system noise a frame, metres and degrees. Chosen: for six degrees of freedom about the
# steps of a camera carried by hand, median 0.04 m and 2 degrees in the kitchen recording; for x, y and yaw 1.5 times a
# wagon's longest step, 0.1 m.
SIGMA = {"6": (0.05, 2.0), "xyyaw": (0.15, 1.5)}
START_FRAMES = 20  # in which it must become clear where a recording begins

Localizer = MonteCarloLocalizer | AnnealedLocalizer | RecoveringLocalizer
LOCALIZERS: dict[str, type[Localizer]] = {
    "paper": MonteCarloLocalizer,
    "annealed": AnnealedLocalizer,
    "recovering": RecoveringLocalizer,
}


class Run(NamedTuple):
    """The result of a filter on a recording of T frames."""

    frames: list[int]
    states: np.ndarray  # `(T, 6)` estimates, in the world of the map that was used
    camera_to_world: np.ndarray  # `(T, 4, 4)` estimates in the recording's own world, optical convention
    scores: np.ndarray  # `(T,)` raw score of the best particle; NaN where the frame held no measurement
    ess: np.ndarray  # `(T,)` effective sample size
    agreements: list[Agreement]  # how each frame's image agrees with the map as seen from its estimate
    statuses: list[TrackStatus]  # how far each pose can be believed (`depth_mcl.status`)
    normalized_errors: np.ndarray  # `(T,)` squared, in units of the covariance; NaN with too few particles
    deviations: np.ndarray  # `(T, 6)` true states from the estimates; this and the errors are empty without the truth
    error_sigmas: np.ndarray  # `(T, 6)` how far off the filter expects to be in each, one sigma
    renders: np.ndarray  # `(T,)` how many images were drawn to find each estimate
    ms_per_frame: float  # milliseconds, the mean over steps; reading the images is not counted
    faults: list[Fault | None]  # why the watch did not use a frame, None where it did; without a watch all None
    calibration: Calibration | None  # what the annealed filter's images say of the camera's intrinsics

    @classmethod
    def of(cls, sequence: DepthSequence, to_z_up: np.ndarray, motion: Motion, *followed: tuple) -> "Run":
        """Return the run of a recording. followed: the columns of `follow`. motion: measures the errors."""
        estimates, outcomes, seconds = followed
        count, covariances = len(estimates), [e.error_covariance for e in estimates]
        states = np.array([e.state for e in estimates])
        true = state_from_optical_pose(to_z_up @ sequence.camera_to_world[:count]) if sequence.has_poses else ()
        deviations = [motion.deviations(t[None], state)[0] for t, state in zip(true, states, strict=False)]
        return cls(
            frames=sequence.frames[:count],
            states=states,
            camera_to_world=np.linalg.inv(to_z_up) @ optical_pose(states),
            scores=np.array([e.score for e in estimates]),
            ess=np.array([e.ess for e in estimates]),
            agreements=[e.agreement for e in estimates],
            statuses=[status_of(outcome) for outcome in outcomes],
            normalized_errors=np.array([normalized_error(d, c) for d, c in zip(deviations, covariances, strict=False)]),
            deviations=np.array(deviations),
            error_sigmas=np.sqrt([np.diag(c) for c in covariances]),
            renders=np.array([getattr(e, "renders", len(e.particles)) for e in estimates]),
            ms_per_frame=1000 * sum(seconds) / count,
            faults=[None if outcome in get_args(TrackStatus) else outcome for outcome in outcomes],
            calibration=getattr(estimates[-1], "calibration", None),
        )


def system_noise(dof: Literal["6", "xyyaw"], position: float, rotation_deg: float) -> dict:
    """Return `run_sequence`'s motion and its noise: standard deviations a frame, metres and degrees, of what moves."""
    rotation = np.deg2rad(rotation_deg)
    if dof == "6":
        return {"sigma": [position] * 3 + [rotation] * 3, "motion": TANGENT_SPACE}
    return {"sigma": [position, position, 0.0, 0.0, 0.0, rotation], "motion": BODY_AXES}


def find_start(
    scene_map: SceneMap, sequence: DepthSequence, *, seed: int, up: str, near: float, far: float, progress: Callable
) -> tuple[int, PoseCandidates, np.ndarray]:
    """Return where a recording begins: the frame in which it was clear, what was found, and the first place's pose.

    The pose is a camera-to-world matrix `(4, 4)` in the recording's own world, all NaN where none was found. Without
    gravity.txt or accelerometer.txt the images show which way is down, or the camera is taken to be held upright.
    """
    to_z_up = rotation_to_z_up(up)
    with DepthRenderer(scene_map.transformed(to_z_up), sequence.camera(near, far)) as renderer:
        search = GlobalSearch(renderer, seed=seed)
        for index in progress(range(min(START_FRAMES, len(sequence)))):
            candidates = search.step(sequence.depth(index), _known(sequence, index)["gravity"])
            if candidates.status == "found":
                break
    pose = optical_pose(candidates.poses[0].state) if candidates.poses else np.full((4, 4), np.nan)
    return index, candidates, np.linalg.inv(to_z_up) @ pose


def _known(sequence: DepthSequence, index: int) -> dict:
    """Return a frame's time and gravity by name, None where the recording does not have them."""
    columns = {"time": sequence.times, "gravity": sequence.gravity}
    return {name: None if column is None else column[index] for name, column in columns.items()}


def can_search(scene_map: SceneMap) -> bool:
    """Return whether a map has free space to search in, and the ray caster is there to look for it."""
    try:
        FreeSpace(scene_map).spread_out(1)
    except (ImportError, ValueError):
        return False
    return True


def follow(localizer: Localizer | GuardedLocalizer, arrivals: Iterable[tuple[np.ndarray, dict]]) -> Iterator[tuple]:
    """Yield the estimate, its outcome and the seconds it took for every image.

    The outcome is the estimate's status, or that of the watch (`guarded_depth.OUTCOMES`). Each image comes with other
    measurements by name, such as time and gravity. The localizer gets those that it takes.
    """
    for depth, known in arrivals:
        begun = time.perf_counter()
        with warnings.catch_warnings(action="ignore", category=NoMeasurementWarning):  # the outcome says it
            found = localizer.step(depth, **{name: known[name] for name in localizer.takes & known.keys()})
        estimate, seconds = getattr(found, "estimate", found), time.perf_counter() - begun
        yield estimate, getattr(found, "outcome", estimate.status), seconds


def run_sequence(
    scene_map: SceneMap,
    sequence: DepthSequence,
    method: str = "paper",
    *,
    up: str | None = None,
    start: np.ndarray | None = None,
    frames: int | None = None,
    near: float = NEAR,
    far: float = FAR,
    backend: Backend = "raster",
    exact: bool = False,
    coarse: bool = False,
    watched: bool = False,
    progress: Callable = iter,
    **parts: object,
) -> Run:
    """Localize a recording by one of `LOCALIZERS`; parts: arguments of that class, such as n_particles and seed.

    up: the axis of map and recording that points up (None: what the recording says, else z). start: camera-to-world
    matrix `(4, 4)` in the recording's own world, optical convention (None: the first true pose). coarse: compare 20 x
    15 pixels. watched: by a `GuardedLocalizer`. progress: wraps the frame indices. Others as in `DepthRenderer`.
    """
    to_z_up = rotation_to_z_up(up or sequence.up or "z")
    count = len(sequence) if frames is None else min(frames, len(sequence))
    if count < 1:
        raise ValueError(f"frames must be at least 1; got {frames}")
    start = sequence.camera_to_world[0] if start is None else start
    camera = sequence.camera(near, far)
    used = camera.resized(COARSE_WIDTH, COARSE_HEIGHT) if coarse else camera
    with DepthRenderer(scene_map.transformed(to_z_up), used, backend, exact=exact) as renderer:
        localizer = LOCALIZERS[method](renderer, **parts)
        motion = localizer.motion
        localizer = GuardedLocalizer(localizer, sequence.period) if watched else localizer
        localizer.initialize(state_from_optical_pose(to_z_up @ start))
        indices = progress(range(count))
        arrivals = ((subsample_depth(sequence.depth(k), camera, used), _known(sequence, k)) for k in indices)
        followed = list(follow(localizer, arrivals))
    return Run.of(sequence, to_z_up, motion, *zip(*followed, strict=True))


def pose_error_summary(run: Run, sequence: DepthSequence) -> dict[str, float | None]:
    """Return median and 90th percentile of position (m) and rotation (degrees) errors, the share within 5 cm, 5 deg.

    The mean normalized error is near 1 where the covariance is right; None where a frame had too few particles for it.
    """
    position, rotation = pose_errors(run.camera_to_world, sequence.camera_to_world[: len(run.frames)])
    rotation_deg, normalized = np.rad2deg(rotation), float(np.mean(run.normalized_errors))
    return {
        "median_position_m": float(np.median(position)),
        "p90_position_m": float(np.percentile(position, 90)),
        "median_rotation_deg": float(np.median(rotation_deg)),
        "p90_rotation_deg": float(np.percentile(rotation_deg, 90)),
        "within_5cm_5deg_percent": float(100 * np.mean((position <= 0.05) & (rotation_deg <= 5.0))),
        "mean_normalized_error": None if np.isnan(normalized) else normalized,
    }
