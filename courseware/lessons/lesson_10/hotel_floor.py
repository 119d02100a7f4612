"""A hotel floor of boxes: rooms 101 and 102 are furnished alike, 103 is not, and a corridor joins them.

The filter gets the map. The camera sees the *world*: the map, a suitcase and two chairs that the map lacks, and noise.
"""

import functools
from collections import namedtuple
from collections.abc import Iterable, Sequence

import numpy as np

from course_lib.geometry import optical_pose
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap
from courseware.lessons.kit.box_world import box_map

CAMERA = DepthCamera.from_fov(40, 30, 75, 58, near=0.1, far=9.0)
NOISE, GRAVITY_SIGMA = 0.005, np.deg2rad(1.0)  # standard deviations, of the distance as a share of it
HEIGHT, EYE = 2.5, 1.4  # metres, of every room and of the camera above the floor
ALIKE = np.array([4.0, 0.0, 0.0])  # metres from one room to the next, so from a place in 101 to its double in 102


def in_rooms(boxes: Sequence, rooms: Iterable[int]) -> list[np.ndarray]:
    """Return copies `(2, 3)` of the boxes of room 0 for every one of these rooms."""
    return [np.add(box, room * ALIKE) for room in rooms for box in boxes]


# Opposite corners (x, y, z) in metres. The corridor is y = 0 to 1.6, the rooms are y = 1.7 to 5.7.
FLOOR_AND_CEILING = [((-0.1, -0.1, -0.1), (12.1, 5.8, 0.0)), ((-0.1, -0.1, HEIGHT), (12.1, 5.8, HEIGHT + 0.1))]
OUTER_WALLS = [  # and the two between the rooms
    ((-0.1, -0.1, 0.0), (12.1, 0.0, HEIGHT)), ((-0.1, 5.7, 0.0), (12.1, 5.8, HEIGHT)),
    ((-0.1, 0.0, 0.0), (0.0, 5.7, HEIGHT)), ((12.0, 0.0, 0.0), (12.1, 5.7, HEIGHT)),
    ((3.95, 1.7, 0.0), (4.05, 5.7, HEIGHT)), ((7.95, 1.7, 0.0), (8.05, 5.7, HEIGHT)),
]  # fmt: skip
BESIDE_A_DOOR = [((0.0, 1.6, 0.0), (2.6, 1.7, HEIGHT)), ((3.5, 1.6, 0.0), (4.0, 1.7, HEIGHT))]
ABOVE_A_DOOR, CLOSED_DOOR = ((2.6, 1.6, 2.1), (3.5, 1.7, HEIGHT)), ((2.6, 1.62, 0.0), (3.5, 1.68, 2.1))
FURNITURE_OF_101 = [  # bed, table, wardrobe, shelf, cupboard, mirror, and a picture in the corridor opposite
    ((0.05, 3.2, 0.0), (2.1, 4.8, 0.55)), ((3.1, 4.6, 0.0), (3.95, 5.7, 0.75)), ((0.05, 1.7, 0.0), (1.3, 2.3, 2.0)),
    ((1.2, 5.4, 1.3), (2.4, 5.7, 1.7)), ((0.05, 2.6, 0.0), (0.4, 3.0, 1.5)), ((3.85, 2.4, 0.6), (3.95, 3.1, 2.0)),
    ((2.7, 0.0, 1.0), (3.3, 0.15, 1.9)),
]  # fmt: skip
IN_CORRIDOR_AND_103 = [
    ((0.0, 0.0, 0.0), (0.5, 1.1, 0.9)), ((11.2, 0.9, 0.0), (12.0, 1.6, 1.9)), ((11.6, 0.0, 0.0), (12.0, 0.5, 0.5)),
    ((8.05, 4.9, 0.0), (10.4, 5.7, 2.1)), ((11.4, 2.5, 0.0), (12.0, 5.2, 1.1)), ((9.2, 3.0, 0.0), (10.2, 3.9, 0.9)),
]  # fmt: skip
FURNITURE = [*in_rooms(FURNITURE_OF_101, range(2)), *IN_CORRIDOR_AND_103]
WALLS = [*OUTER_WALLS, *in_rooms(BESIDE_A_DOOR, range(3))]
BOXES = [*FLOOR_AND_CEILING, *WALLS, *in_rooms([ABOVE_A_DOOR], range(3)), *FURNITURE]
LACKING = [((6.2, 0.1, 0.0), (6.6, 0.5, 0.7)), *in_rooms([((2.4, 4.9, 0.0), (2.8, 5.3, 0.9))], range(2))]


@functools.cache
def hotel_map(*closed: int) -> SceneMap:
    """Return the map that the filter gets. closed: rooms (0, 1, 2) whose door was shut on the day of the survey."""
    return box_map(*BOXES, *in_rooms([CLOSED_DOOR], closed))


world = functools.cache(lambda: DepthRenderer(box_map(*BOXES, *LACKING), CAMERA, exact=True))

# A camera's walk: true states `(T, 6)`, depth images `(T, H, W)` [m] with NaN where nothing is measured, and directions
# of gravity `(T, 3)` in the camera's optical frame, as its accelerometer measures them.
Recording = namedtuple("Recording", "states depths gravity")


def record(states: np.ndarray, seed: int) -> Recording:
    """Return what camera and accelerometer measure at states `(T, 6)`, with noise."""
    rng = np.random.default_rng(seed)
    depths = world().render(states) * (1 + NOISE * rng.standard_normal((len(states), *CAMERA.shape)))
    depths = np.where(np.isfinite(depths), depths, np.nan).astype(np.float32)
    down = -optical_pose(states)[:, 2, :3] + GRAVITY_SIGMA * rng.standard_normal((len(states), 3))
    return Recording(states, depths, down)


def walk(corners: Sequence[Sequence[float]], frames: int, sway: float = 1.0) -> np.ndarray:
    """Return states `(frames, 6)` along corners [x, y, yaw in degrees]. A hand sways and nods, a wagon has sway 0."""
    columns = np.asarray(corners, dtype=np.float64)
    at = np.linspace(0, len(columns) - 1, frames)
    x, y, yaw_deg = (np.interp(at, np.arange(len(columns)), column) for column in columns.T)
    step = np.arange(frames)
    roll, pitch = np.deg2rad(1.5 * sway) * np.sin(1.3 * step), np.deg2rad(8 + 2 * sway * np.sin(0.9 * step))
    return np.column_stack([x, y, EYE + 0.02 * sway * np.sin(1.7 * step), roll, pitch, np.deg2rad(yaw_deg)])


# Walks, as corners [x, y, yaw in degrees].
ON_A_WAGON = ((1.2, 0.9, 5), (2.8, 0.8, -5))
IN_THE_CORRIDOR = ((1.2, 0.9, 5), (3.6, 0.8, -5))
IN_103 = ((8.7, 2.3, 60), (9.0, 2.5, 100), (8.9, 2.6, 120))
IN_101 = ((3.3, 4.2, 200), (3.2, 3.6, 225))
IN_102 = ((7.3, 4.2, 200), (7.2, 3.6, 225))
TO_THE_LIFT = ((6.0, 0.9, 10), (8.0, 0.7, 0))
ALONG = ((1.0, 0.9, 5), (4.0, 0.8, -5), (7.5, 0.8, 5))
TO_AN_OPEN_DOOR = ((9.5, 0.8, 170), (7.5, 0.8, 178), (6.5, 0.8, 120), (6.9, 0.9, 90), (7.0, 0.9, 90))
# From beside the bed of 101 out of the door, and to the left.
OUT_OF_101 = (
    (3.3, 4.2, 200), (3.2, 3.6, 225), (3.05, 3.0, 258), (3.05, 2.2, 268),
    (3.05, 1.4, 262), (2.9, 0.9, 225), (2.6, 0.85, 180), (2.1, 0.85, 180),
)  # fmt: skip
FRAMES = 30
leaving_101 = functools.cache(lambda: record(walk(OUT_OF_101, FRAMES), seed=10_002))


def carried_away() -> Recording:
    """Record ten frames on a wagon along the corridor, then twenty in 103."""
    return record(np.concatenate([walk(ON_A_WAGON, 10, sway=0), walk(IN_103, 20, sway=0)]), 10_001)


def carried_next_door() -> Recording:
    """Record the walk out of 101. After eight frames the camera is at the same place in 102; nothing was covered."""
    return record(walk(OUT_OF_101, 32) + np.outer(np.arange(32) >= 8, [*ALIKE, 0, 0, 0]), 10_003)


def into_102() -> Recording:
    """Record a walk along the corridor to the open door of 102."""
    return record(walk(TO_AN_OPEN_DOOR, 20), 10_004)
