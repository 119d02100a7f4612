"""The finale's room, the robot in it, and its way from "somewhere in this room" to millimetres.

A seed gives the room. Its two maps are stored in data/finale. The sensors see the room itself.
"""

import functools
import json
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from course_lib.beyond.look_alikes.consistent import associate_consistent
from course_lib.beyond.six_dof.localizer import AnnealedEstimate
from course_lib.depth_mcl.evaluation import pose_errors
from course_lib.depth_mcl.sequence import FAR
from course_lib.geometry import optical_pose, wrap_angle
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap
from course_lib.spherical_stereo.detection.detector import YoloDetector
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.panorama import StereoRig
from course_lib.spherical_stereo.pose.localization import Localization
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap
from courseware.experiments import finale
from courseware.experiments.finale import LEVEL_SIGMA, REACHED, follow, mean_score, robot_states, start_state, starts_of
from courseware.paths import data_path
from courseware.simulation.room.depth_world import CAMERA, PLACE, STREAM, depth_caster
from courseware.simulation.room.finale_data import SEED
from courseware.simulation.room.furnishing import make_look_alike_room
from courseware.simulation.room.look_alike_recording import RecordingModels, measurement_poses, mount_of
from courseware.simulation.room.measurement_places import CAMERA_HEIGHTS
from courseware.simulation.room.scene import distance_to, footprint
from courseware.simulation.sensors.panorama_renderer import PanoramaRenderer
from courseware.simulation.sensors.panorama_rig import photograph, stand_up
from courseware.simulation.sensors.time_of_flight import TimeOfFlightCamera, TimeOfFlightModel

CLEARANCE, WALL = 0.3, 0.5  # metres that the robot needs to every footprint and to every wall, as in the experiment
PANORAMAS, DEPTH, AROUND = range(3)  # random generators of a place
FILTER_SEED = 1
_kept: dict[tuple, "Journey"] = {}


class FinaleWorld:
    """The room, its maps and the robot's sensors. Poses are `(3,)` [x, y, heading], metres and radians."""

    def __init__(self) -> None:
        self.models = RecordingModels()
        self.room = make_look_alike_room(SEED, 0, self.models.limits)
        self.footprints = [footprint(item) for item in self.room.objects]
        self.semantic_map = SemanticMap.load(data_path("finale/semantic_map.json"))
        self.scene_map = SceneMap.load(data_path("finale/map.ply"))
        upper, lower = CAMERA_HEIGHTS[1]
        self.rig = StereoRig(round(upper - lower, 6), upper)
        network = YoloDetector.load(data_path("detector"))
        self.localizer = SemanticLocalizer(self.rig, self.semantic_map, network, association=associate_consistent)
        self.renderer = DepthRenderer(self.scene_map, DepthCamera.sr4000(far=FAR))
        rng = np.random.default_rng([STREAM, SEED, CAMERA])
        self._sensor = TimeOfFlightCamera(DepthCamera.sr4000(), TimeOfFlightModel(), rng)
        self._caster = depth_caster(self.room)
        self._photographer = PanoramaRenderer(self.room, self.models.width, number_scale=1)
        self._mount = mount_of(SEED, self.models)

    def photographs(self, pose: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the upper and the lower panorama `(640, 1280, 3)` BGR from a pose."""
        rng = generator(pose, PANORAMAS)
        rig = stand_up(pose, self.rig.upper_height, self.rig.baseline, self.models.rig, rng, self._mount)
        return tuple(photograph(self._photographer.render(s), self.models.camera, rng) for s in rig.camera_states())

    def capture(self, state: np.ndarray, rng: np.random.Generator) -> np.ndarray:
        """Return one depth image `(144, 176)` from a state `(6,)` of the depth camera."""
        return self._sensor.capture(self._caster, state, rng).depth

    def depth_images(self, pose: np.ndarray) -> tuple[np.ndarray, list[np.ndarray]]:
        """Return true states `(3, 6)` of the depth camera while the robot rolls on a little, and its images."""
        rng = generator(pose, DEPTH)
        states = robot_states(pose, rng)
        return states, [self.capture(state, rng) for state in states]

    def where(self, x: float, y: float) -> str:
        """Return in words what is at a place: "free", or why nobody can stand there."""
        distances = np.array([float(distance_to(corners, [(x, y)])[0]) for corners in self.footprints])
        nearest = int(np.argmin(distances))
        name = self.room.objects[nearest].label
        if distances[nearest] == 0:
            return f"inside a {name}"
        low, high = self.room.walls.min(axis=0), self.room.walls.max(axis=0)
        if min(np.min((x, y) - low), np.min(high - (x, y))) < WALL:
            return f"nearer than {WALL} m to a wall"
        return f"{distances[nearest]:.2f} m from a {name}" if distances[nearest] < CLEARANCE else "free"


@functools.cache
def world() -> FinaleWorld:
    """Return the one world of this kernel: its windows that draw live as long."""
    return FinaleWorld()


def hidden(image: np.ndarray, share: float) -> np.ndarray:
    """Return a panorama with a share (0 to 1) of its columns hidden behind a back, symmetric about straight ahead."""
    image, width = image.copy(), image.shape[1]
    columns = round(share * width)
    start = (width - columns) // 2
    image[:, start : start + columns] = (60, 70, 85)  # BGR of a coat
    return image


def generator(pose: np.ndarray, what: int) -> np.random.Generator:
    """Return the random generator of a place, so that the same place always has the same noise."""
    x, y, heading = pose
    key = [round(100 * x), round(100 * y), round(np.rad2deg(heading)) % 360]
    return np.random.default_rng([STREAM, SEED, PLACE, what, *key])


class Journey(NamedTuple):
    """All stages at one place. Errors are (metres, degrees)."""

    pose: np.ndarray  # (3,) of the robot: x, y, heading
    images: list[np.ndarray]  # upper and lower panorama, (H, W, 3) BGR
    found: Localization
    semantic_error: tuple[float, float] | None
    states: np.ndarray  # (3, 6) of the depth camera at each image
    depths: list[np.ndarray]
    starts: list[Pose2D]  # of the depth filter: the semantic pose, or up to three alternatives
    runs: list[list[AnnealedEstimate]]  # for each start, an estimate for each depth image
    best: list[AnnealedEstimate] | None  # the run that explains its images best
    depth_error: tuple[float, float] | None  # in space, of the last estimate of the best run
    reached: bool


def plane_error(found: Pose2D, true_pose: np.ndarray) -> tuple[float, float]:
    """Return how far a pose on the floor is off: metres, degrees."""
    turned = abs(float(wrap_angle(found.theta - true_pose[2])))
    return float(np.hypot(found.x - true_pose[0], found.y - true_pose[1])), float(np.rad2deg(turned))


def state_error(state: np.ndarray, true_state: np.ndarray) -> tuple[float, float]:
    """Return how far a state `(6,)` is off: metres in space, degrees of the rotation between the two."""
    position, rotation = pose_errors(optical_pose(state), optical_pose(true_state))
    return float(position), float(np.rad2deg(rotation))


def journey(
    x: float, y: float, heading: float, hidden_share: float = 0, lens_cap: bool = False, say: Callable = lambda _: None
) -> Journey:
    """Return what happens at a place (metres, degrees). It is kept, so that a second look costs nothing.

    hidden_share: of the panoramas' columns. lens_cap: the depth camera measures nothing. say: is told of each stage.
    """
    key = (float(x), float(y), float(heading), float(hidden_share))
    if key not in _kept:
        here, pose = world(), np.array([x, y, np.deg2rad(heading)])
        say("1 of 4: photographing two panoramas")
        images = [hidden(image, hidden_share) for image in here.photographs(pose)]
        say("2 of 4: finding objects, places and the pose")
        found = here.localizer.localize(*images)
        say("3 of 4: taking depth images")
        states, depths = here.depth_images(pose)
        say("4 of 4: the filter")
        starts = starts_of(found, here.scene_map)
        runs = [follow(here.renderer, start_state(start), depths, FILTER_SEED) for start in starts]
        best = max(runs, key=mean_score, default=None)
        errors = found.pose and plane_error(found.pose, pose), best and state_error(best[-1].state, states[-1])
        reached = best is not None and bool(np.all(np.less_equal(errors[1], REACHED)))
        _kept[key] = Journey(pose, images, found, errors[0], states, depths, starts, runs, best, errors[1], reached)
    if not lens_cap:
        return _kept[key]
    dark = [np.full_like(depth, np.nan) for depth in _kept[key].depths]
    return _kept[key]._replace(depths=dark, runs=[], best=None, depth_error=None, reached=False)


def start_covariance(covariance: np.ndarray) -> np.ndarray:
    """Return the covariance `(6, 6)` of `start_state`: of a semantic pose `(3, 3)`, and of how the robot stands."""
    height, level = LEVEL_SIGMA
    result = np.diag([0.0, 0.0, height**2, level**2, level**2, 0.0])
    result[np.ix_([0, 1, 5], [0, 1, 5])] = covariance
    return result


def random_places(n: int) -> list[tuple[float, float, float]]:
    """Return the first n random places of the experiment in this room: x, y [m], heading [degrees]."""
    poses = measurement_poses(world().room, 2 * n, SEED)[::2]  # there are two headings at each place
    return [(float(x), float(y), float(np.rad2deg(heading))) for x, y, heading in poses]


def misplaced(
    places: Sequence[Journey], metres: float, degrees: float, repeats: int, rng: np.random.Generator
) -> list[bool]:
    """Start filters at every place in a random direction and turned to a side; return for each whether it arrived."""
    arrived = []
    for one in [place for place in places for _ in range(repeats)]:
        direction, side = rng.uniform(0, 2 * np.pi), rng.choice([-1.0, 1.0])
        off = [metres * np.cos(direction), metres * np.sin(direction), 0, 0, 0, side * np.deg2rad(degrees)]
        last = follow(world().renderer, one.states[0] + off, one.depths, FILTER_SEED)[-1]
        arrived.append(bool(np.all(np.less_equal(state_error(last.state, one.states[-1]), REACHED))))
    return arrived


def turn_and_look(one: Journey) -> tuple[tuple[float, float], int, bool]:
    """Turn the robot and look again until its pose is known: return metres and degrees, views, and whether it knows."""
    here = world()
    given = here.renderer, one.starts, one.pose, here.capture, generator(one.pose, AROUND)
    estimate, state, views = finale.look_around(*given)
    return state_error(estimate.state, state), views, finale.is_known(estimate)


def stored_result() -> dict:
    """Return the result of `demo finale --seeds 1-10`: forty places in ten rooms that nobody here looked at."""
    return json.loads(data_path("room/results/finale_1-10.json").read_text(encoding="utf-8"))
