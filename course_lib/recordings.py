"""Any recording through the filter, as plain functions of a recording, a map and a seed."""

import time
import warnings
from collections.abc import Callable, Mapping
from functools import partial
from typing import Literal, NamedTuple

import numpy as np

from course_lib.beyond.being_lost import Agreement, TrackStatus, agreement, judge_track
from course_lib.beyond.guarded_frames import Fault, FrameCheck
from course_lib.beyond.lost_and_found.free_space import FreeSpace
from course_lib.beyond.lost_and_found.global_search import GlobalSearch, PoseCandidates
from course_lib.beyond.lost_and_found.recovery import RecoveringLocalizer
from course_lib.beyond.six_dof.calibration import Calibration
from course_lib.beyond.six_dof.localizer import AnnealedEstimate, AnnealedLocalizer
from course_lib.depth_mcl.evaluation import pose_errors
from course_lib.depth_mcl.fallon import COARSE_HEIGHT, COARSE_WIDTH
from course_lib.depth_mcl.likelihood import Weighting
from course_lib.depth_mcl.localizer import SIGMA_XY_YAW, MonteCarloLocalizer, NoMeasurementWarning
from course_lib.depth_mcl.motion import BODY_AXES, TANGENT_SPACE, Motion
from course_lib.depth_mcl.sequence import FAR, NEAR, DepthSequence
from course_lib.depth_mcl.uncertainty import normalized_error
from course_lib.geometry import optical_pose, rotation_to_z_up, state_from_optical_pose
from course_lib.rendering.renderer import Backend, DepthRenderer
from course_lib.rendering.scene_map import SceneMap
from course_lib.rendering.sensor import subsample_depth

# Standard deviations of the system noise a frame, metres and degrees (chosen: for six degrees of freedom about the
# steps of a camera carried by hand, median 0.04 m and 2 degrees in the kitchen recording; for x, y, yaw one and a half
# of a wagon's longest steps, 0.1 m).
SIGMA = {"6": (0.05, 2.0), "xyyaw": (0.15, 1.5)}
START_FRAMES = 20  # in which it must become clear where a recording begins


class Run(NamedTuple):
    """What the filter made of a recording of T frames."""

    frames: list[int]
    states: np.ndarray  # `(T, 6)` estimates, in the world of the map that was used
    camera_to_world: np.ndarray  # `(T, 4, 4)` estimates in the recording's own world, optical convention
    scores: np.ndarray  # `(T,)` raw score of the best particle; NaN where the frame held no measurement
    ess: np.ndarray  # `(T,)` effective sample size
    agreements: list[Agreement]  # How each frame's image agrees with the map as seen from its estimate
    statuses: list[TrackStatus]  # Whether the filter believes itself on the track
    normalized_errors: np.ndarray  # `(T,)` squared, in units of the covariance; NaN with too few particles
    deviations: np.ndarray  # `(T, 6)` the true states from the estimates, as the motion measures them
    """This and `normalized_errors` are empty where no truth is known."""
    error_sigmas: np.ndarray  # `(T, 6)` how far off the filter expects to be in each, one sigma
    renders: np.ndarray  # `(T,)` how many images were drawn to find each estimate
    ms_per_frame: float  # Milliseconds, the mean over steps; reading the images is not counted
    frames_without_measurement: int
    faults: tuple[Fault | None, ...] = ()
    """Why frames were not used (guarded_frames.py), None where they were; empty where nobody looked."""
    calibration: Calibration | None = None  # What the annealed filter's images tell of the camera's intrinsics


def system_noise(dof: Literal["6", "xyyaw"], position: float, rotation_deg: float) -> dict:
    """Return `run_sequence`'s motion and its noise: standard deviations a frame, metres and degrees, of what moves."""
    rotation = np.deg2rad(rotation_deg)
    if dof == "6":
        return {"sigma": [position] * 3 + [rotation] * 3, "motion": TANGENT_SPACE}
    return {"sigma": [position, position, 0.0, 0.0, 0.0, rotation], "motion": BODY_AXES}


def find_start(
    scene_map: SceneMap, sequence: DepthSequence, *, seed: int, up: str, near: float, far: float, progress: Callable
) -> tuple[int, PoseCandidates, np.ndarray]:
    """Search where a recording begins: the frame in which it was clear, what was found, and the first place's pose.

    The pose is a camera-to-world matrix `(4, 4)` in the recording's own world, all NaN where none was found. Without
    gravity.txt or accelerometer.txt the images show which way is down, or the camera is taken to be held upright.
    """
    to_z_up = rotation_to_z_up(up)
    with DepthRenderer(scene_map.transformed(to_z_up), sequence.camera(near, far)) as renderer:
        search = GlobalSearch(renderer, seed=seed)
        for index in progress(range(min(START_FRAMES, len(sequence)))):
            candidates = search.step(sequence.depth(index), _gravity(sequence, index))
            if candidates.status == "found":
                break
    pose = optical_pose(candidates.poses[0].state) if candidates.poses else np.full((4, 4), np.nan)
    return index, candidates, np.linalg.inv(to_z_up) @ pose


def _gravity(sequence: DepthSequence, index: int) -> np.ndarray | None:
    return None if sequence.gravity is None else sequence.gravity[index]


def can_search(scene_map: SceneMap) -> bool:
    """Return whether a map has free space to search in, and the ray caster is there to look for it."""
    try:
        FreeSpace(scene_map).spread_out(1)
    except (ImportError, ValueError):
        return False
    return True


def run_sequence(
    scene_map: SceneMap,
    sequence: DepthSequence,
    *,
    sigma: np.ndarray = SIGMA_XY_YAW,
    motion: Motion = BODY_AXES,
    weighting: Weighting | None = None,
    **options: object,
) -> Run:
    """Localize a recording by the paper's filter: arguments of `MonteCarloLocalizer`; options: `run_localizer`'s."""
    make = partial(MonteCarloLocalizer, sigma=sigma, motion=motion, weighting=weighting)
    return run_localizer(make, scene_map, sequence, motion=motion, **options)


def run_annealed(
    scene_map: SceneMap, sequence: DepthSequence, *, parts: Mapping[str, object] | None = None, **options: object
) -> Run:
    """Localize a recording, annealed and refined. parts: of `AnnealedLocalizer`; options: `run_localizer`'s."""
    return run_localizer(partial(AnnealedLocalizer, **(parts or {})), scene_map, sequence, **options)


def run_recovering(scene_map: SceneMap, sequence: DepthSequence, **options: object) -> Run:
    """Localize a recording as `run_annealed` does, and where it is lost, search globally (`RecoveringLocalizer`)."""

    def step(localizer: RecoveringLocalizer, depth: np.ndarray, index: int) -> AnnealedEstimate:
        found = localizer.step(depth, gravity=_gravity(sequence, index))
        searched = 0 if found.candidates is None else found.candidates.renders
        return found.estimate._replace(renders=found.estimate.renders + searched)

    return run_localizer(RecoveringLocalizer, scene_map, sequence, step=step, **options)


def run_localizer(
    make: Callable[..., MonteCarloLocalizer | AnnealedLocalizer | RecoveringLocalizer],
    scene_map: SceneMap,
    sequence: DepthSequence,
    *,
    n_particles: int = 200,
    seed: int = 0,
    step: Callable = lambda localizer, depth, index: localizer.step(depth),
    motion: Motion = TANGENT_SPACE,
    coarse: bool = False,
    up: str | None = None,
    start: np.ndarray | None = None,
    frames: int | None = None,
    backend: Backend = "raster",
    exact: bool = False,
    near: float = NEAR,
    far: float = FAR,
    watched: bool = False,
    progress: Callable = iter,
) -> Run:
    """Localize a recording: every frame's estimate as plain arrays.

    make: gives the filter from a renderer of the map. step: gives the filter a frame's image. motion: how errors are
    measured. coarse: compare 20 x 15 pixels. start: camera-to-world matrix `(4, 4)` in the recording's own world,
    optical convention (None: the first true pose). up: the axis of map and recording that points up (None: what the
    recording says, else z). watched: treat a frame at fault as one without measurement. progress: wraps the frame
    indices. Statuses of the paper's filter are those of `judge_track`. Other arguments as in `DepthRenderer`.
    """
    to_z_up = rotation_to_z_up(up or sequence.up or "z")
    check, faults = FrameCheck(near, far), []
    camera = sequence.camera(near, far)
    used = camera.resized(COARSE_WIDTH, COARSE_HEIGHT) if coarse else camera
    count = len(sequence) if frames is None else min(frames, len(sequence))
    if count < 1:
        raise ValueError(f"frames must be at least 1; got {frames}")
    start = sequence.camera_to_world[0] if start is None else start
    true = state_from_optical_pose(to_z_up @ sequence.camera_to_world[:count]) if sequence.has_poses else ()
    estimates, agreements, seconds = [], [], 0.0
    with (
        warnings.catch_warnings(action="ignore", category=NoMeasurementWarning),  # they are counted instead, below
        DepthRenderer(scene_map.transformed(to_z_up), used, backend, exact=exact) as renderer,
    ):
        localizer = make(renderer, n_particles=n_particles, seed=seed)
        localizer.initialize(state_from_optical_pose(to_z_up @ start))
        for index in progress(range(count)):
            depth = sequence.depth(index)
            if watched:
                faults.append(check.look(depth, None if sequence.times is None else float(sequence.times[index])).fault)
                depth = depth if faults[-1] is None else np.full_like(depth, np.nan)
            if coarse:
                depth = subsample_depth(depth, camera, used)
            begun = time.perf_counter()
            estimates.append(step(localizer, depth, index))
            seconds += time.perf_counter() - begun
            measured = renderer.render_points(used.points(depth))
            agreements.append(agreement(measured, renderer.render(estimates[-1].state)[0]))
    states = np.array([e.state for e in estimates])
    deviations = [motion.deviations(t[None], e.state)[0] for t, e in zip(true, estimates, strict=False)]
    covariances = [e.error_covariance for e in estimates]
    if isinstance(estimates[0], AnnealedEstimate):  # which says itself what it is worth
        statuses = ["doubtful" if e.status == "no measurement" else e.status for e in estimates]
    else:
        statuses = judge_track(agreements)
    looked_at = zip(estimates, faults or [None] * count, strict=True)
    return Run(
        frames=sequence.frames[:count],
        states=states,
        camera_to_world=np.linalg.inv(to_z_up) @ optical_pose(states),
        scores=np.array([e.score for e in estimates]),
        ess=np.array([e.ess for e in estimates]),
        agreements=agreements,
        statuses=statuses,
        normalized_errors=np.array([normalized_error(d, c) for d, c in zip(deviations, covariances, strict=False)]),
        deviations=np.array(deviations),
        error_sigmas=np.sqrt([np.diag(c) for c in covariances]),
        renders=np.array([getattr(e, "renders", len(e.particles)) for e in estimates]),
        ms_per_frame=1000 * seconds / count,
        frames_without_measurement=sum(e.status == "no measurement" and f in (None, "no return") for e, f in looked_at),
        faults=tuple(faults),
        calibration=getattr(estimates[-1], "calibration", None),
    )


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
