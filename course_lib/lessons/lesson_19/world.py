"""The finale's room, its two maps, and the robot in it: panoramas and depth images from any place.

A seed gives the room. Its two maps are stored in data/finale. The sensors see the room itself.
"""

import functools

import numpy as np

from course_lib.beyond.look_alikes.consistent import associate_consistent
from course_lib.depth_mcl.sequence import FAR
from course_lib.experiments.finale import robot_states
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
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

CLEARANCE, WALL = 0.3, 0.5  # metres that the robot needs to every footprint and to every wall, as in the experiment
PANORAMAS, DEPTH, AROUND = range(3)  # random generators of a place


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
        images = [photograph(self._photographer.render(s), self.models.camera, rng) for s in rig.camera_states()]
        return images[0], images[1]

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
