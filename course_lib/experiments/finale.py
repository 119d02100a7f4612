"""Both papers in one world: the semantic pose starts the depth filter that paper 1 had to start by hand.

A robot stands somewhere in a furnished room that it has a semantic map and a mesh map of. Its two panoramas give x, y
and heading to centimetres and a degree (paper 2); from there the depth filter, annealed and refined, takes it to
millimetres (paper 1). Where the panoramas leave several poses, the depth camera judges the best of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from course_lib.depth_mcl.annealed.localizer import AnnealedEstimate, AnnealedLocalizer
from course_lib.depth_mcl.camera import DepthCamera
from course_lib.depth_mcl.evaluation import pose_errors
from course_lib.depth_mcl.localizer import MAP_MARGIN
from course_lib.depth_mcl.rendering.renderer import DepthRenderer
from course_lib.depth_mcl.scene_map import SceneMap
from course_lib.depth_mcl.sequence import FAR
from course_lib.geometry import optical_pose, wrap_angle
from course_lib.simulation.room.depth_world import (
    CAMERA,
    MAP,
    PLACE,
    STREAM,
    DepthSurveyModel,
    depth_caster,
    surveyed_mesh,
)
from course_lib.simulation.room.look_alike_recording import RecordingModels, photograph_room, surveyed_room
from course_lib.simulation.sensors.ray_casting import WorldCaster
from course_lib.simulation.sensors.time_of_flight import TimeOfFlightCamera, TimeOfFlightModel
from course_lib.spherical_stereo.detection.detector import YoloDetector
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.pose.localization import Localization
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D
from course_lib.spherical_stereo.recording import read_stereo_recording

CAMERA_HEIGHT = 1.0  # metres, of the depth camera on the robot (chosen)
LEVEL_SIGMA = 0.005, np.deg2rad(0.3)  # metres, radians: how level the robot stands (chosen)
FRAMES = 3  # depth images at each place, the robot rolling on by a few centimetres
STEP, TURN = 0.03, 0.02  # metres, radians a frame
MOST_ALTERNATIVES = 3
ON_THE_FLOOR = (0, 1, 5)  # of a state: x, y, yaw, what a semantic pose tells
REACHED = 0.03, 1.0  # metres, degrees


def finale_room(seed: int, places: int, detector: str, camera: int = 1) -> list[dict]:
    """A point of a sweep: from so many random places of a seed's room, both methods one after the other.

    detector: folder of the network. camera: 1 or 2, the paper's heights of the stereo rig.
    """
    models = RecordingModels()
    room, semantic_map = surveyed_room(seed, models)
    scene_map = SceneMap(*surveyed_mesh(room, DepthSurveyModel(), np.random.default_rng([STREAM, seed, MAP])))
    sensor = TimeOfFlightCamera(DepthCamera.sr4000(), TimeOfFlightModel(), np.random.default_rng([STREAM, seed, CAMERA]))
    network, caster = YoloDetector.load(detector), depth_caster(room)
    results = []
    with TemporaryDirectory() as temporary:
        # Two headings at each place of the paper's table; here every place is one of its own.
        recording = read_stereo_recording(photograph_room(Path(temporary), room, seed, 2 * places, models)[camera - 1])
        size = (recording.width, recording.height)
        localizer = SemanticLocalizer(recording.rig, semantic_map, network, image_size=size, association="consistent")
        with DepthRenderer(scene_map, DepthCamera.sr4000(far=FAR)) as renderer:
            for k, pair in enumerate(recording.pairs[::2]):
                rng = np.random.default_rng([STREAM, seed, PLACE, k])
                found = localizer.localize(*pair.images())
                results.append(one_place(found, pair.pose, renderer, sensor, caster, rng))
    return results


def one_place(
    found: Localization,
    true_pose: np.ndarray,
    renderer: DepthRenderer,
    sensor: TimeOfFlightCamera,
    caster: WorldCaster,
    rng: np.random.Generator,
) -> dict:
    """What the semantic pose is worth at one place, and what the depth filter makes of it. true_pose: x, y, heading."""
    states = robot_states(true_pose, rng)
    depths = [sensor.capture(caster, state, rng).depth for state in states]
    starts = starts_of(found, renderer.scene_map)
    result = {"semantic_status": found.status, "starts": len(starts)}
    if found.pose is not None:
        result["semantic_m"] = float(np.hypot(found.pose.x - true_pose[0], found.pose.y - true_pose[1]))
    if not starts:
        return result | {"reached": False}
    estimate = best_start(renderer, starts, depths, seed=int(rng.integers(2**31)))
    position, rotation = pose_errors(optical_pose(estimate.state), optical_pose(states[-1]))
    degrees = float(np.rad2deg(rotation))
    return result | {
        "position_m": float(position),
        "rotation_deg": degrees,
        "status": estimate.status,
        "reached": bool(position <= REACHED[0] and degrees <= REACHED[1]),
    }


def starts_of(found: Localization, scene_map: SceneMap) -> list[Pose2D]:
    """Where the depth filter starts: the semantic pose; without one, the best of those weighed that stand on the map."""
    if found.pose is not None:
        return [found.pose]
    poses = [one.pose for one in found.alternatives[:MOST_ALTERNATIVES]]
    return [pose for pose in poses if scene_map.contains(start_state(pose)[:3], MAP_MARGIN)]


def best_start(renderer: DepthRenderer, starts: Sequence[Pose2D], depths: Sequence[np.ndarray], seed: int) -> AnnealedEstimate:
    """The last estimate of the start, `Pose2D`, that explains the depth images best: by its mean raw score."""
    best, best_score = None, -np.inf
    for start in starts:
        estimates = follow(renderer, start_state(start), depths, seed)
        if (score := mean_score(estimates)) > best_score:
            best, best_score = estimates[-1], score
    return best


def start_state(pose: Pose2D) -> np.ndarray:
    """State `(6,)` of the depth camera on a robot at a semantic pose: height, roll and pitch are those of standing."""
    return np.array([pose.x, pose.y, CAMERA_HEIGHT, 0.0, 0.0, pose.theta])


def start_covariance(covariance: np.ndarray) -> np.ndarray:
    """Covariance `(6, 6)` of `start_state`: a semantic pose's own `(3, 3)`, and how level and high a robot stands.

    Metres and radians, squared, in the order of the state.
    """
    height, level = LEVEL_SIGMA
    known = np.diag([0.0, 0.0, height**2, level**2, level**2, 0.0])
    known[np.ix_(ON_THE_FLOOR, ON_THE_FLOOR)] = covariance
    return known


def joined(
    start: np.ndarray, covariance: np.ndarray, state: np.ndarray, state_covariance: np.ndarray
) -> tuple[np.ndarray, np.ndarray, float]:
    """Two answers to one question, each weighed by its covariance: state `(6,)`, covariance `(6, 6)`, squared distance.

        K = P_0 (P_0 + P_1)^-1    x = x_0 + K (x_1 - x_0)    P = (1 - K) P_0    d^2 = (x_1 - x_0)' (P_0 + P_1)^-1 (...)

    start, covariance: what was known before the image; state, state_covariance: what the depth filter makes of the
    first image (its `error_covariance`). Differences of angles are taken on the circle; the robot stands nearly level,
    so they are rotations about its axes. d^2 is chi-squared with 6 degrees of freedom where both are right.
    """
    difference = state - start
    difference[3:] = wrap_angle(difference[3:])
    gain = covariance @ np.linalg.inv(covariance + state_covariance)
    found = start + gain @ difference
    found[3:] = wrap_angle(found[3:])
    distance = difference @ np.linalg.solve(covariance + state_covariance, difference)
    return found, (np.eye(6) - gain) @ covariance, float(distance)


def follow(
    renderer: DepthRenderer, start: np.ndarray, depths: Sequence[np.ndarray], seed: int
) -> list[AnnealedEstimate]:
    """What the depth filter makes of the images from one start, a state `(6,)`."""
    localizer = AnnealedLocalizer(renderer, seed=seed)
    localizer.initialize(start)
    return [localizer.step(depth) for depth in depths]


def mean_score(estimates: Sequence[AnnealedEstimate]) -> float:
    """Mean raw score of a run: what starts are compared by."""
    return float(np.mean([estimate.score for estimate in estimates]))


def robot_states(pose: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """True states `(FRAMES, 6)` of the depth camera on a robot that stands at x, y, heading and rolls on slowly."""
    x, y, heading = pose
    height, level = LEVEL_SIGMA
    tilt = level * rng.standard_normal((FRAMES, 2))
    headings = heading + TURN * np.arange(FRAMES)
    ahead = STEP * np.arange(FRAMES)
    z = CAMERA_HEIGHT + height * rng.standard_normal(FRAMES)
    return np.column_stack([x + ahead * np.cos(headings), y + ahead * np.sin(headings), z, tilt, headings])


def summarize(places: Sequence[dict]) -> dict[str, float]:
    """The numbers of the table."""
    known = [place for place in places if "position_m" in place]
    return {
        "places": len(places),
        "reached": sum(place["reached"] for place in places),
        "semantic_ok": sum(place["semantic_status"] == "ok" for place in places),
        "started_from_several": sum(place["starts"] > 1 for place in places),
        "median_semantic_m": float(np.median([p["semantic_m"] for p in places if "semantic_m" in p] or [np.nan])),
        "median_position_m": float(np.median([place["position_m"] for place in known] or [np.nan])),
        "median_rotation_deg": float(np.median([place["rotation_deg"] for place in known] or [np.nan])),
        "wrong_called_tracked": sum(not p["reached"] and p.get("status") == "tracked" for p in places),
    }
