"""The finale's room, both of its maps, and the robot in it: panoramas and depth images from wherever it is put.

The room comes of its seed again; its two maps are stored in data/finale. What the sensors see is the room itself.
Opened once a kernel: the windows that draw live as long.
"""

import functools
from collections.abc import Sequence

import numpy as np

from course_lib.beyond.look_alikes.consistent import associate_consistent
from course_lib.beyond.six_dof.localizer import AnnealedEstimate
from course_lib.depth_mcl.sequence import FAR
from course_lib.experiments.finale import look_around, robot_states
from course_lib.paths import data_path
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap
from course_lib.simulation.room.depth_world import CAMERA, PLACE, STREAM, depth_caster
from course_lib.simulation.room.finale_data import SEED
from course_lib.simulation.room.furnishing import make_look_alike_room
from course_lib.simulation.room.look_alike_recording import RecordingModels, mount_of
from course_lib.simulation.room.measurement_places import CAMERA_HEIGHTS
from course_lib.simulation.room.scene import distance_to, footprint
from course_lib.simulation.sensors.panorama_renderer import PanoramaRenderer
from course_lib.simulation.sensors.panorama_rig import photograph, stand_up
from course_lib.simulation.sensors.time_of_flight import TimeOfFlightCamera, TimeOfFlightModel
from course_lib.spherical_stereo.detection.detector import YoloDetector
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.panorama import StereoRig
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

CLEARANCE = 0.3  # metres that the robot needs to every footprint, as where the experiment puts it
WALL = 0.5  # and to every wall
PANORAMAS, DEPTH, AROUND = range(3)  # generators of a place
_COAT = (60, 70, 85)  # BGR, of what hides a part of a panorama: somebody's back


class FinaleWorld:
    """The room, its maps and the robot's sensors. Poses are `(3,)` [x, y, heading], metres and radians."""

    def __init__(self) -> None:
        self.models = RecordingModels()
        self.room = make_look_alike_room(SEED, 0, self.models.limits)
        self.semantic_map = SemanticMap.load(data_path("finale/semantic_map.json"))
        self.scene_map = SceneMap.load(data_path("finale/map.ply"))
        upper, lower = CAMERA_HEIGHTS[1]
        self.rig = StereoRig(round(upper - lower, 6), upper)
        network = YoloDetector.load(data_path("detector"))
        self.localizer = SemanticLocalizer(self.rig, self.semantic_map, network, association=associate_consistent)
        self.renderer = DepthRenderer(self.scene_map, DepthCamera.sr4000(far=FAR))
        self.footprints = [footprint(item) for item in self.room.objects]
        sensor = TimeOfFlightCamera(
            DepthCamera.sr4000(), TimeOfFlightModel(), np.random.default_rng([STREAM, SEED, CAMERA])
        )
        caster = depth_caster(self.room)
        self._capture = lambda state, rng: sensor.capture(caster, state, rng).depth
        self._photographer = PanoramaRenderer(self.room, self.models.width, number_scale=1)
        self._mount = mount_of(SEED, self.models)

    def photographs(self, pose: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The upper and the lower panorama `(640, 1280, 3)` BGR, as the cameras give them."""
        rng = _generator(pose, PANORAMAS)
        rig = stand_up(pose, self.rig.upper_height, self.rig.baseline, self.models.rig, rng, self._mount)
        images = [photograph(self._photographer.render(s), self.models.camera, rng) for s in rig.camera_states()]
        return images[0], images[1]

    def depth_images(self, pose: np.ndarray) -> tuple[np.ndarray, list[np.ndarray]]:
        """True states `(3, 6)` of the depth camera while the robot rolls on a little, and its images `(144, 176)`."""
        rng = _generator(pose, DEPTH)
        states = robot_states(pose, rng)
        return states, [self._capture(state, rng) for state in states]

    def look_around(self, starts: Sequence[Pose2D], pose: np.ndarray) -> tuple[AnnealedEstimate, np.ndarray, int]:
        """The experiment's `look_around` here: estimate, true state `(6,)` of the camera then, number of views."""
        rng = _generator(pose, AROUND)
        return look_around(self.renderer, starts, pose, self._capture, rng)

    def where(self, x: float, y: float) -> str:
        """What stands where the robot is put, in words: "free", or why nobody can stand there."""
        distances = np.array([float(distance_to(corners, [(x, y)])[0]) for corners in self.footprints])
        nearest = int(np.argmin(distances))
        name = self.room.objects[nearest].label
        if distances[nearest] == 0:
            return f"inside a {name}"
        low, high = self.room.walls.min(axis=0), self.room.walls.max(axis=0)
        if min(np.min((x, y) - low), np.min(high - (x, y))) < WALL:
            return f"nearer than {WALL} m to a wall"
        return f"{distances[nearest]:.2f} m from a {name}" if distances[nearest] < CLEARANCE else "free"


def hidden(image: np.ndarray, share: float) -> np.ndarray:
    """A panorama of which a share, 0 to 1, of the columns is hidden, from straight ahead to both sides alike."""
    image, width = image.copy(), image.shape[1]
    columns = round(share * width)
    start = (width - columns) // 2
    image[:, start : start + columns] = _COAT
    return image


@functools.cache
def world() -> FinaleWorld:
    """The one world of this kernel."""
    return FinaleWorld()


def _generator(pose: np.ndarray, what: int) -> np.random.Generator:
    """One place, one recording: whoever comes back finds the same noise."""
    x, y, heading = pose
    key = [round(100 * x), round(100 * y), round(np.rad2deg(heading)) % 360]
    return np.random.default_rng([STREAM, SEED, PLACE, what, *key])
