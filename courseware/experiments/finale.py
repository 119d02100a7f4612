"""Both papers in one world: panoramas find the robot in a furnished room, the depth camera makes it exact.

Where the panoramas leave several poses, the depth camera judges the best of them. While the filter's covariance leaves
the pose open, the robot turns and looks again.
"""

import warnings
from collections.abc import Callable, Sequence
from itertools import islice
from pathlib import Path

import numpy as np
from numpy.random import Generator

from course_lib.beyond.look_alikes.consistent import associate_consistent
from course_lib.beyond.six_dof.localizer import AnnealedEstimate, AnnealedLocalizer
from course_lib.depth_mcl.evaluation import pose_errors
from course_lib.depth_mcl.localizer import MAP_MARGIN, NoMeasurementWarning
from course_lib.depth_mcl.sequence import FAR
from course_lib.geometry import optical_pose, wrap_angle
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap
from course_lib.spherical_stereo.detection.detector import YoloDetector
from course_lib.spherical_stereo.pose.localization import Localization
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D
from courseware.experiments.observed_rooms import MODELS, photographed_pairs
from courseware.experiments.room_evaluation import median
from courseware.experiments.runner import Outcome, Runner
from courseware.paths import data_path
from courseware.simulation.room import depth_world
from courseware.simulation.room.look_alike_recording import surveyed_room
from courseware.simulation.sensors.time_of_flight import TimeOfFlightCamera, TimeOfFlightModel

CAMERA_HEIGHT = 1.0  # metres, of the depth camera on the robot (chosen)
LEVEL_SIGMA = 0.005, np.deg2rad(0.3)  # metres, radians: how level the robot stands (chosen)
FRAMES = 3  # depth images of one view, the robot rolling on by a few centimetres
STEP, TURN = 0.03, 0.02  # metres, radians a frame
MAX_ALTERNATIVES = 3
REACHED = 0.03, 1.0  # metres, degrees
VIEWS, VIEW_TURN = 12, np.deg2rad(30.0)  # at most so many views, the robot turning so far to the next: once around
ODOMETRY_SIGMA = 0.05, np.deg2rad(1.0)  # share of a motion; least of a turn (chosen)
MEDIANS = {
    "semantic_m": 3,
    "position_m": 4,
    "rotation_deg": 2,
}  # medians that are printed, with their digits


def run(runner: Runner, *, seed: int, seeds: list[int] | None, places: int, detector: Path | None) -> Outcome:
    """Run `demo finale`: the rooms that are missing, then all places together."""
    seeds, network = seeds or [seed], (detector or data_path("detector")).absolute()
    YoloDetector.load(network)  # A fault of its files stops the run now, not after the first room.
    points = [{"seed": one, "places": places, "detector": str(network)} for one in seeds]
    rooms = runner.rows(finale_room, points, "finale", "room")
    result = {"seeds": seeds, **summarize([place for room in rooms for place in room])}
    return Outcome(result, finale_text(result), {"finale.json": (result, None)})


def finale_room(seed: int, places: int, detector: str) -> list[dict]:
    """Run both methods one after the other from so many random places of a seed's room, at the rig's first height."""

    def generator(*stream: int) -> Generator:
        return np.random.default_rng([depth_world.STREAM, seed, *stream])

    room, semantic_map = surveyed_room(seed, MODELS)
    survey = depth_world.surveyed_mesh(room, depth_world.DepthSurveyModel(), generator(depth_world.MAP))
    sensor = TimeOfFlightCamera(DepthCamera.sr4000(), TimeOfFlightModel(), generator(depth_world.CAMERA))
    caster, results = depth_world.depth_caster(room), []

    def capture(state: np.ndarray, rng: Generator) -> np.ndarray:
        return sensor.capture(caster, state, rng).depth

    options = {"association": associate_consistent, "reject_implausible": True}
    pairs = photographed_pairs(room, semantic_map, seed, 2 * places, MODELS, YoloDetector.load(detector), **options)
    with DepthRenderer(SceneMap(*survey), DepthCamera.sr4000(far=FAR)) as renderer:
        # Two headings at each place of the paper's table; here every place is one of its own.
        for k, (_, localizer, pair) in enumerate(islice(pairs, 0, 2 * places, 2)):
            found = localizer.localize(*pair.images())
            results.append(one_place(found, pair.pose, renderer, capture, generator(depth_world.PLACE, k)))
    return results


def one_place(
    found: Localization, true_pose: np.ndarray, renderer: DepthRenderer, capture: Callable, rng: Generator
) -> dict:
    """Return what the semantic pose is worth at one place, and what the depth filter makes of it."""
    starts = starts_of(found, renderer.scene_map)
    result = {"semantic_status": found.status, "starts": len(starts)}
    if found.pose is not None:
        result["semantic_m"] = float(np.hypot(found.pose.x - true_pose[0], found.pose.y - true_pose[1]))
    if not starts:
        return result | {"reached": False}
    estimate, state, views = look_around(renderer, starts, true_pose, capture, rng)
    position, rotation = pose_errors(optical_pose(estimate.state), optical_pose(state))
    degrees = float(np.rad2deg(rotation))
    reached = bool(position <= REACHED[0] and degrees <= REACHED[1])
    status = estimate.status if is_known(estimate) else "open"
    found = {"views": views, "position_m": float(position), "rotation_deg": degrees}
    return result | found | {"status": status, "reached": reached}


def look_around(
    renderer: DepthRenderer, starts: Sequence[Pose2D], true_pose: np.ndarray, capture: Callable, rng: Generator
) -> tuple[AnnealedEstimate, np.ndarray, int]:
    """Return the first estimate that knows its pose, else the last one, the true state `(6,)` there, and the views.

    A view that leaves the pose open may have moved the filter along a wall: the next one starts from the panoramas
    again, carried on by the odometer. capture: gives the depth image from a state, and takes a generator.
    """
    pose = true_pose
    for views in range(1, VIEWS + 1):
        states = robot_states(pose, rng)
        depths = [capture(state, rng) for state in states]
        estimate = best_start(renderer, starts, depths, seed=int(rng.integers(2**31)))
        if is_known(estimate) or views == VIEWS:
            return estimate, states[-1], views
        pose = states[-1, [0, 1, 5]] + [0.0, 0.0, VIEW_TURN]
        ahead, turn = odometry((FRAMES - 1) * STEP, (FRAMES - 1) * TURN + VIEW_TURN, rng)
        starts = [Pose2D(*map(float, one.apply([ahead, 0.0])), float(wrap_angle(one.theta + turn))) for one in starts]


def is_known(estimate: AnnealedEstimate) -> bool:
    """Return whether an estimate is tracked, and by its covariance within `REACHED`, one standard deviation."""
    position, rotation = (np.sqrt(np.trace(estimate.error_covariance[part, part])) for part in (slice(3), slice(3, 6)))
    return estimate.status == "tracked" and position <= REACHED[0] and np.rad2deg(rotation) <= REACHED[1]


def odometry(ahead: float, turn: float, rng: Generator) -> tuple[float, float]:
    """Return a motion as wheels measure it: metres ahead, radians counterclockwise, with noise of `ODOMETRY_SIGMA`."""
    share, least = ODOMETRY_SIGMA
    return ahead * (1.0 + share * rng.standard_normal()), turn + np.hypot(share * turn, least) * rng.standard_normal()


def best_start(renderer: DepthRenderer, starts: Sequence[Pose2D], depths: Sequence, seed: int) -> AnnealedEstimate:
    """Return the last estimate of the start that explains the depth images best, by its mean raw score."""
    runs = [follow(renderer, start_state(start), depths, seed) for start in starts]
    return runs[int(np.argmax(np.nan_to_num([mean_score(run) for run in runs], nan=-np.inf)))][-1]


def starts_of(found: Localization, scene_map: SceneMap) -> list[Pose2D]:
    """Return the depth filter's starts: the semantic pose, or else the best weighed poses that lie on the map."""
    if found.pose is not None:
        return [found.pose]
    poses = [one.pose for one in found.alternatives[:MAX_ALTERNATIVES]]
    return [pose for pose in poses if scene_map.contains(start_state(pose)[:3], MAP_MARGIN)]


def start_state(pose: Pose2D) -> np.ndarray:
    """Return the depth camera's state `(6,)` on a robot at a semantic pose: it stands, so roll and pitch are 0."""
    return np.array([pose.x, pose.y, CAMERA_HEIGHT, 0.0, 0.0, pose.theta])


def follow(renderer: DepthRenderer, start: np.ndarray, depths: Sequence, seed: int) -> list[AnnealedEstimate]:
    """Return the depth filter's estimates for the images, from one start, a state `(6,)`."""
    localizer = AnnealedLocalizer(renderer, seed=seed)
    localizer.initialize(start)
    with warnings.catch_warnings(action="ignore", category=NoMeasurementWarning):  # the estimate's status says so
        return [localizer.step(depth) for depth in depths]


def mean_score(estimates: Sequence[AnnealedEstimate]) -> float:
    """Return the mean raw score of a run, by which starts are compared. NaN if a frame held no measurement."""
    return float(np.mean([estimate.score for estimate in estimates]))


def robot_states(pose: np.ndarray, rng: Generator) -> np.ndarray:
    """Return true states `(FRAMES, 6)` of the depth camera on a robot that stands at x, y, heading and rolls slowly."""
    height, level = LEVEL_SIGMA
    tilt = level * rng.standard_normal((FRAMES, 2))
    z = CAMERA_HEIGHT + height * rng.standard_normal(FRAMES)
    x, y, headings, ahead = *pose[:2], pose[2] + TURN * np.arange(FRAMES), STEP * np.arange(FRAMES)
    return np.column_stack([x + ahead * np.cos(headings), y + ahead * np.sin(headings), z, tilt, headings])


def summarize(places: Sequence[dict]) -> dict[str, float | None]:
    """Return the numbers of the table; a median of nothing is None."""
    return {
        "places": len(places),
        "reached": sum(place["reached"] for place in places),
        "semantic_ok": sum(place["semantic_status"] == "ok" for place in places),
        "started_from_several": sum(place["starts"] > 1 for place in places),
        "looked_again": sum(place.get("views", 1) > 1 for place in places),
        "left_open": sum(place.get("status") == "open" for place in places),
        "wrong_called_tracked": sum(not p["reached"] and p.get("status") == "tracked" for p in places),
        **{f"median_{name}": median([one[name] for one in places if name in one]) for name in MEDIANS},
    }


def finale_text(result: dict) -> str:
    """Return the numbers of `summarize` in words."""
    values = ((result[f"median_{name}"], digits) for name, digits in MEDIANS.items())
    semantic, position, rotation = ("-" if value is None else f"{value:.{digits}f}" for value, digits in values)
    return (
        f"{result['reached']} of {result['places']} places reached within {REACHED[0]:g} m and {REACHED[1]:g} degree\n"
        f"panoramas: {result['semantic_ok']} answered, median {semantic} m; "
        f"{result['started_from_several']} left several poses to the depth camera\n"
        f"then the depth camera: median {position} m, {rotation} degrees; at {result['looked_again']} places only "
        "after the robot had turned and looked again\n"
        f"not reached: {result['wrong_called_tracked']} called tracked, {result['left_open']} left open"
    )
